//! Devices with fragment shader interlock, for which wgpu has no feature.
//!
//! Input: an adapter and the descriptor of its device. Output: the device, and whether `VK_EXT_fragment_shader_interlock` is
//! enabled on it. An adapter without the extension gives the same device as `request_device`; that is not an error here.

use super::adapter::ready;
use crate::{Error, Interlock};

/// Opens `adapter`, with interlock if the driver has it. Blocks.
pub fn open_device(
    adapter: &wgpu::Adapter,
    descriptor: &wgpu::DeviceDescriptor<'_>,
) -> Result<(wgpu::Device, wgpu::Queue, Interlock), Error> {
    let what = || format!("the device `{}`", adapter.get_info().name);
    let failed = |error: &dyn std::fmt::Display| Error::Internal { what: what(), message: error.to_string() };
    #[cfg(not(any(target_vendor = "apple", target_family = "wasm")))]
    if let Some(opened) = vulkan::open(adapter, descriptor) {
        let (device, queue) = opened.map_err(|error| failed(&error))?;
        return Ok((device, queue, Interlock::Enabled));
    }
    let (device, queue) = ready(adapter.request_device(descriptor))
        .ok_or_else(|| failed(&"the request did not complete"))?
        .map_err(|error| failed(&error))?;
    Ok((device, queue, Interlock::Absent))
}

/// Returns whether a device that [`open_device`] opens has interlock.
pub fn supported_interlock(adapter: &wgpu::Adapter) -> Interlock {
    #[cfg(not(any(target_vendor = "apple", target_family = "wasm")))]
    if vulkan::has_interlock(adapter) {
        return Interlock::Enabled;
    }
    #[cfg(any(target_vendor = "apple", target_family = "wasm"))]
    let _ = adapter;
    Interlock::Absent
}

#[cfg(not(any(target_vendor = "apple", target_family = "wasm")))]
#[allow(unsafe_code, reason = "only wgpu's lower layer can enable extensions that wgpu does not support")]
mod vulkan {
    use ash::{ext::fragment_shader_interlock::NAME, vk};
    use wgpu::hal::api::Vulkan;
    use wgpu::hal::vulkan::CreateDeviceCallback;

    type OpenResult = Result<(wgpu::Device, wgpu::Queue), String>;

    /// Returns whether the adapter is a Vulkan adapter with interlock.
    pub(super) fn has_interlock(adapter: &wgpu::Adapter) -> bool {
        // SAFETY: the adapter is only queried, and outlives the guard.
        let Some(hal) = (unsafe { adapter.as_hal::<Vulkan>() }) else { return false };
        if !hal.physical_device_capabilities().supports_extension(NAME) {
            return false;
        }
        let mut has = vk::PhysicalDeviceFragmentShaderInterlockFeaturesEXT::default();
        let mut query = vk::PhysicalDeviceFeatures2::default().push_next(&mut has);
        // SAFETY: the physical device belongs to this instance, and a driver with the extension fills the chained structure.
        unsafe {
            let instance = hal.shared_instance().raw_instance();
            instance.get_physical_device_features2(hal.raw_physical_device(), &mut query);
        }
        has.fragment_shader_pixel_interlock != vk::FALSE
    }

    /// Opens the device; `None` if the adapter is not a Vulkan adapter or has no interlock.
    pub(super) fn open(adapter: &wgpu::Adapter, descriptor: &wgpu::DeviceDescriptor<'_>) -> Option<OpenResult> {
        if !has_interlock(adapter) {
            return None;
        }
        // SAFETY: the adapter outlives the guard.
        let hal = unsafe { adapter.as_hal::<Vulkan>() }?;
        let mut enabled =
            vk::PhysicalDeviceFragmentShaderInterlockFeaturesEXT::default().fragment_shader_pixel_interlock(true);
        let chained = &mut enabled;
        let add: Box<CreateDeviceCallback<'_>> = Box::new(move |arguments| {
            arguments.extensions.push(NAME);
            *arguments.create_info = std::mem::take(arguments.create_info).push_next(chained);
        });
        let (features, limits) = (descriptor.required_features, &descriptor.required_limits);
        // SAFETY: the driver supports the extension and its feature, as checked above, and nothing is removed.
        let opened = unsafe { hal.open_with_callback(features, limits, &descriptor.memory_hints, Some(add)) };
        Some(opened.map_err(|error| error.to_string()).and_then(|device| {
            // SAFETY: the device was created just now from this adapter, with the features and limits of the descriptor.
            unsafe { adapter.create_device_from_hal::<Vulkan>(device, descriptor) }.map_err(|error| error.to_string())
        }))
    }
}
