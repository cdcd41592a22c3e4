//! The logical device with what a plan requires, its queue, and its memory types.

use ash::vk;
use fragbuf_follow::manifest::Requirements;

use crate::Error;
use crate::context::{Context, failed};
use crate::requirements::Features;

/// A logical device with one queue for graphics and compute.
pub struct Gpu {
    pub device: ash::Device,
    pub queue: vk::Queue,
    pub family: u32,
    pub limits: vk::PhysicalDeviceLimits,
    memory: vk::PhysicalDeviceMemoryProperties,
    /// The greatest allocation.
    pub most_bytes: u64,
}

impl Gpu {
    /// Creates a device with the features and extensions of the requirements, and no others.
    pub fn new(context: &Context, requirements: &Requirements) -> Result<Self, Error> {
        let (instance, physical) = (&context.instance, context.physical);
        // SAFETY: the device is one of the instance.
        let families = unsafe { instance.get_physical_device_queue_family_properties(physical) };
        let wanted = vk::QueueFlags::GRAPHICS | vk::QueueFlags::COMPUTE;
        let family = families.iter().position(|family| family.queue_flags.contains(wanted));
        let family =
            family.ok_or_else(|| Error(format!("`{}` has no queue for graphics and compute", context.name)))?;
        let family = family as u32;
        let queues = [vk::DeviceQueueCreateInfo::default().queue_family_index(family).queue_priorities(&[1.0])];
        let names: Vec<std::ffi::CString> =
            requirements.extensions.iter().filter_map(|name| std::ffi::CString::new(name.as_str()).ok()).collect();
        let names: Vec<*const std::ffi::c_char> = names.iter().map(|name| name.as_ptr()).collect();
        let mut features = Features::requested(&requirements.features)?;
        let mut features = features.chain(&requirements.extensions);
        let info = vk::DeviceCreateInfo::default().queue_create_infos(&queues).enabled_extension_names(&names);
        let info = info.push_next(&mut features);
        // SAFETY: `check` of `requirements` has found the features and extensions, and what `info` points to lives on.
        let device = unsafe { instance.create_device(physical, &info, None) };
        let device = device.map_err(failed("a Vulkan device"))?;
        let mut allocation = vk::PhysicalDeviceMaintenance3Properties::default();
        let mut properties = vk::PhysicalDeviceProperties2::default().push_next(&mut allocation);
        // SAFETY: the family has a queue, and the structs are those of Vulkan 1.1.
        let (queue, memory) = unsafe {
            instance.get_physical_device_properties2(physical, &mut properties);
            (device.get_device_queue(family, 0), instance.get_physical_device_memory_properties(physical))
        };
        let limits = properties.properties.limits;
        Ok(Gpu { device, queue, family, limits, memory, most_bytes: allocation.max_memory_allocation_size })
    }

    /// Allocates memory of the first type that has the first of the `wanted` properties that any type has.
    pub fn allocate(
        &self,
        needed: &vk::MemoryRequirements,
        wanted: &[vk::MemoryPropertyFlags],
        what: &str,
    ) -> Result<vk::DeviceMemory, Error> {
        let types = self.memory.memory_types_as_slice();
        let with = |flags: &vk::MemoryPropertyFlags| {
            (0..)
                .zip(types)
                .find(|(index, kind)| needed.memory_type_bits >> index & 1 == 1 && kind.property_flags.contains(*flags))
        };
        let (index, _) =
            wanted.iter().find_map(with).ok_or_else(|| Error(format!("the device has no memory for {what}")))?;
        let info = vk::MemoryAllocateInfo::default().allocation_size(needed.size).memory_type_index(index);
        // SAFETY: the type is one of the device.
        unsafe { self.device.allocate_memory(&info, None) }.map_err(failed(what))
    }
}

impl Drop for Gpu {
    fn drop(&mut self) {
        // SAFETY: every object of the device holds an `Rc` of it, and is gone. A lost device is destroyed in the same
        // way.
        unsafe {
            let _ = self.device.device_wait_idle();
            self.device.destroy_device(None);
        }
    }
}
