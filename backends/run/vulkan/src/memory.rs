//! Buffers and textures, each with memory of its own.

use std::ffi::c_void;
use std::rc::Rc;

use ash::vk;
use vk::MemoryPropertyFlags as Properties;

use crate::Error;
use crate::access::State;
use crate::context::{Context, failed};
use crate::gpu::Gpu;
use crate::names::{aspects, is_depth};

/// The memory of one resource.
pub enum Memory {
    Buffer(Buffer),
    Texture(Texture),
}

/// A buffer.
pub struct Buffer {
    gpu: Rc<Gpu>,
    pub buffer: vk::Buffer,
    memory: vk::DeviceMemory,
    pub bytes: u64,
    /// The address of memory that the host sees.
    mapped: *mut c_void,
    pub state: State,
}

/// A texture, of the size of the frame unless it is one of the description.
pub struct Texture {
    gpu: Rc<Gpu>,
    pub image: vk::Image,
    memory: vk::DeviceMemory,
    pub format: vk::Format,
    pub size: [u32; 2],
    /// Slices; 1 for a texture of two dimensions.
    pub slices: u32,
    /// Views of all aspects, of depth and of stencil.
    views: Vec<(vk::ImageAspectFlags, vk::ImageView)>,
    pub state: State,
}

/// How the host accesses a buffer.
#[derive(Clone, Copy, PartialEq)]
pub enum HostAccess {
    /// Not at all.
    None,
    /// It writes, and the device reads.
    Write,
    /// It reads, and the device writes.
    Read,
}

impl Buffer {
    /// Creates a buffer.
    pub fn new(
        gpu: &Rc<Gpu>,
        what: &str,
        bytes: u64,
        usage: vk::BufferUsageFlags,
        access: HostAccess,
    ) -> Result<Self, Error> {
        let is_storage = usage.contains(vk::BufferUsageFlags::STORAGE_BUFFER);
        let range = if is_storage { gpu.limits.max_storage_buffer_range.into() } else { u64::MAX };
        let most = gpu.most_bytes.min(range);
        if bytes > most {
            return Err(Error(format!(
                "{what} needs {bytes} bytes, and the device allows {most}: draw a smaller frame or slices of it, or keep \
                 fewer fragments"
            )));
        }
        let info = vk::BufferCreateInfo::default().size(bytes.max(4)).usage(usage);
        // SAFETY: the device exists.
        let buffer = unsafe { gpu.device.create_buffer(&info, None) }.map_err(failed(what))?;
        // From here on dropping destroys what has been created. Null handles may be destroyed.
        let mut created = Buffer {
            gpu: gpu.clone(),
            buffer,
            memory: vk::DeviceMemory::null(),
            bytes: info.size,
            mapped: std::ptr::null_mut(),
            state: State::default(),
        };
        let visible = Properties::HOST_VISIBLE | Properties::HOST_COHERENT;
        let wanted = match access {
            HostAccess::None => [Properties::DEVICE_LOCAL, Properties::empty()],
            HostAccess::Write => [visible | Properties::DEVICE_LOCAL, visible],
            HostAccess::Read => [visible | Properties::HOST_CACHED, visible],
        };
        // SAFETY: the buffer has no memory yet, and the memory is as large as it needs.
        unsafe {
            let needed = gpu.device.get_buffer_memory_requirements(buffer);
            created.memory = gpu.allocate(&needed, &wanted, what)?;
            gpu.device.bind_buffer_memory(buffer, created.memory, 0).map_err(failed(what))?;
            if access != HostAccess::None {
                let whole = (0, vk::WHOLE_SIZE, vk::MemoryMapFlags::empty());
                let mapped = gpu.device.map_memory(created.memory, whole.0, whole.1, whole.2);
                created.mapped = mapped.map_err(failed(what))?;
            }
        }
        Ok(created)
    }

    /// Writes bytes from the begin. The device must not use the buffer meanwhile.
    pub fn write(&mut self, bytes: &[u8]) {
        let count = if self.mapped.is_null() { 0 } else { bytes.len().min(self.bytes as usize) };
        // SAFETY: the mapped range has at least `count` bytes, and `&mut` excludes other accesses of the host.
        unsafe { std::ptr::copy_nonoverlapping(bytes.as_ptr(), self.mapped.cast(), count) };
    }

    /// Reads bytes from the begin. The device must not write the buffer meanwhile.
    pub fn read(&self, count: u64) -> Vec<u8> {
        let count = if self.mapped.is_null() { 0 } else { count.min(self.bytes) as usize };
        let mut bytes = vec![0; count];
        // SAFETY: the mapped range has at least `count` bytes.
        unsafe { std::ptr::copy_nonoverlapping(self.mapped.cast(), bytes.as_mut_ptr(), count) };
        bytes
    }
}

impl Drop for Buffer {
    fn drop(&mut self) {
        // SAFETY: the host has waited for all commands that use the buffer.
        unsafe {
            self.gpu.device.destroy_buffer(self.buffer, None);
            self.gpu.device.free_memory(self.memory, None);
        }
    }
}

impl Texture {
    /// Creates a texture of the first of the formats that the device has. `is_blended`: passes blend into it.
    pub fn new(
        context: &Context,
        gpu: &Rc<Gpu>,
        what: &str,
        (formats, samples, is_blended): (&[vk::Format], vk::SampleCountFlags, bool),
        size: [u32; 2],
    ) -> Result<Self, Error> {
        let kind = (formats, samples, is_blended);
        Texture::with_slices(context, gpu, what, kind, (size, None))
    }

    /// Creates a texture of three dimensions if `slices` gives their number.
    pub fn with_slices(
        context: &Context,
        gpu: &Rc<Gpu>,
        what: &str,
        (formats, samples, is_blended): (&[vk::Format], vk::SampleCountFlags, bool),
        (size, slices): ([u32; 2], Option<u32>),
    ) -> Result<Self, Error> {
        let (shape, view_type) = match slices {
            None => (vk::ImageType::TYPE_2D, vk::ImageViewType::TYPE_2D),
            Some(_) => (vk::ImageType::TYPE_3D, vk::ImageViewType::TYPE_3D),
        };
        let extent = vk::Extent3D { width: size[0], height: size[1], depth: slices.unwrap_or(1) };
        let usable = formats.iter().map(|format| usable(context, (*format, samples, is_blended), shape, extent));
        let mut problems = Vec::new();
        let format = usable.zip(formats).find_map(|(usable, format)| match usable {
            Ok(()) => Some(*format),
            Err(problem) => {
                problems.push(problem);
                None
            }
        });
        let format = format.ok_or_else(|| Error(format!("{what}: {}", problems.join("; "))))?;
        let info = vk::ImageCreateInfo::default()
            .image_type(shape)
            .format(format)
            .extent(extent)
            .mip_levels(1)
            .array_layers(1)
            .samples(samples)
            .usage(usage(format, shape));
        // SAFETY: the device supports such images.
        let image = unsafe { gpu.device.create_image(&info, None) }.map_err(failed(what))?;
        let memory = vk::DeviceMemory::null();
        let mut created = Texture {
            gpu: gpu.clone(),
            image,
            memory,
            format,
            size,
            slices: extent.depth,
            views: Vec::new(),
            state: State::default(),
        };
        // SAFETY: the image has no memory yet, and the memory is as large as it needs.
        unsafe {
            let needed = gpu.device.get_image_memory_requirements(image);
            created.memory = gpu.allocate(&needed, &[Properties::DEVICE_LOCAL, Properties::empty()], what)?;
            gpu.device.bind_image_memory(image, created.memory, 0).map_err(failed(what))?;
        }
        let (all, single) = (aspects(format), [vk::ImageAspectFlags::DEPTH, vk::ImageAspectFlags::STENCIL]);
        let single = single.into_iter().filter(|aspect| *aspect != all && all.contains(*aspect));
        for aspect in std::iter::once(all).chain(single) {
            let info = vk::ImageViewCreateInfo::default()
                .image(image)
                .view_type(view_type)
                .format(format)
                .subresource_range(whole(aspect));
            // SAFETY: the image has memory.
            let view = unsafe { gpu.device.create_image_view(&info, None) }.map_err(failed(what))?;
            created.views.push((aspect, view));
        }
        Ok(created)
    }

    /// Returns the view of an aspect; of all aspects for others.
    pub fn view(&self, aspect: vk::ImageAspectFlags) -> vk::ImageView {
        let view = self.views.iter().find(|(known, _)| *known == aspect).or(self.views.first());
        view.map_or(vk::ImageView::null(), |(_, view)| *view)
    }
}

impl Drop for Texture {
    fn drop(&mut self) {
        // SAFETY: the host has waited for all commands that use the image.
        unsafe {
            for (_, view) in &self.views {
                self.gpu.device.destroy_image_view(*view, None);
            }
            self.gpu.device.destroy_image(self.image, None);
            self.gpu.device.free_memory(self.memory, None);
        }
    }
}

/// Returns the only layer of an image.
pub fn whole(aspect: vk::ImageAspectFlags) -> vk::ImageSubresourceRange {
    vk::ImageSubresourceRange {
        aspect_mask: aspect,
        base_mip_level: 0,
        level_count: 1,
        base_array_layer: 0,
        layer_count: 1,
    }
}

/// Returns the usages of a texture. None of three dimensions is attached.
fn usage(format: vk::Format, shape: vk::ImageType) -> vk::ImageUsageFlags {
    if shape == vk::ImageType::TYPE_3D {
        return vk::ImageUsageFlags::SAMPLED | vk::ImageUsageFlags::TRANSFER_DST;
    }
    let attachment = match is_depth(format) {
        true => vk::ImageUsageFlags::DEPTH_STENCIL_ATTACHMENT,
        false => vk::ImageUsageFlags::COLOR_ATTACHMENT,
    };
    let copied = vk::ImageUsageFlags::TRANSFER_SRC | vk::ImageUsageFlags::TRANSFER_DST;
    attachment | vk::ImageUsageFlags::SAMPLED | copied
}

/// Returns why a device does not have such textures.
fn usable(
    context: &Context,
    (format, samples, is_blended): (vk::Format, vk::SampleCountFlags, bool),
    kind: vk::ImageType,
    vk::Extent3D { width, height, depth }: vk::Extent3D,
) -> Result<(), String> {
    let tiling = vk::ImageTiling::OPTIMAL;
    let (instance, physical) = (&context.instance, context.physical);
    let none = vk::ImageCreateFlags::empty();
    // SAFETY: the device is one of the instance.
    let (properties, features) = unsafe {
        let properties = instance.get_physical_device_image_format_properties(
            physical,
            format,
            kind,
            tiling,
            usage(format, kind),
            none,
        );
        (properties, instance.get_physical_device_format_properties(physical, format).optimal_tiling_features)
    };
    let name = format.as_raw();
    let properties = properties.map_err(|_| format!("the device has no textures of VkFormat {name}"))?;
    if is_blended && !features.contains(vk::FormatFeatureFlags::COLOR_ATTACHMENT_BLEND) {
        return Err(format!("the device does not blend VkFormat {name}"));
    }
    let most = properties.max_extent;
    if width > most.width || height > most.height || depth > most.depth {
        return Err(format!(
            "{width} × {height} pixels are more than the device allows, {} × {}: draw a smaller frame",
            most.width, most.height
        ));
    }
    if !properties.sample_counts.contains(samples) {
        return Err(format!(
            "the device has no textures of VkFormat {name} with {} samples per pixel",
            samples.as_raw()
        ));
    }
    Ok(())
}
