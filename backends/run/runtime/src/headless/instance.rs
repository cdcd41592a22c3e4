//! Creates instances of wgpu that need no window system.
//!
//! Input: wgpu's descriptor. Output: an instance that lists the same adapters. wgpu's own instance enables the Wayland extension of
//! Vulkan wherever it exists. Mesa's layer for the choice of a device then connects to a Wayland compositor, and libwayland prints an
//! error on stderr if the environment has no `XDG_RUNTIME_DIR`, as on servers and in containers.

/// Creates an instance for adapters without a window.
pub(super) fn create(descriptor: wgpu::InstanceDescriptor) -> wgpu::Instance {
    #[cfg(all(unix, not(target_vendor = "apple"), not(target_os = "android"), not(target_family = "wasm")))]
    if descriptor.backends.contains(wgpu::Backends::VULKAN)
        && let Some(instance) = vulkan::without_wayland(&descriptor)
    {
        return instance;
    }
    wgpu::Instance::new(descriptor)
}

#[cfg(all(unix, not(target_vendor = "apple"), not(target_os = "android"), not(target_family = "wasm")))]
#[allow(unsafe_code, reason = "only wgpu's lower layer can leave out an extension")]
mod vulkan {
    use ash::khr::wayland_surface;
    use wgpu::hal::api::Vulkan;
    use wgpu::hal::vulkan::{CreateInstanceCallback, Instance};

    /// Creates an instance that has only the back end Vulkan, which is the only primary one of these systems. `None` if there is no Vulkan.
    pub(super) fn without_wayland(descriptor: &wgpu::InstanceDescriptor) -> Option<wgpu::Instance> {
        let lower = wgpu::hal::InstanceDescriptor {
            name: "fragbuf",
            flags: descriptor.flags,
            memory_budget_thresholds: descriptor.memory_budget_thresholds,
            backend_options: descriptor.backend_options.clone(),
            telemetry: None,
            display: None,
        };
        let remove: Box<CreateInstanceCallback<'_>> =
            Box::new(|arguments| arguments.extensions.retain(|name| *name != wayland_surface::NAME));
        // SAFETY: wgpu requires that no extension is removed, because it assumes that those that exist are enabled. It uses this one only
        // to create surfaces of Wayland windows, after it has looked for it in this list, and this crate creates no surfaces.
        let instance = unsafe { Instance::init_with_callback(&lower, Some(remove)) }.ok()?;
        // SAFETY: the instance was created just now, and nothing else owns it.
        Some(unsafe { wgpu::Instance::from_hal::<Vulkan>(instance) })
    }
}
