//! The buffers and textures of a plan, and what clears and empty passes need.
//!
//! Input: a plan, the values of its symbols. Output: buffers and textures by name. A buffer that no device of these limits can have is an
//! error that names it.

use std::collections::BTreeMap;

use fragbuf_follow::manifest::{Plan, Resource, Texture};
use fragbuf_follow::{Error, Values};

use super::{Gpu, names, scoped};

/// The format of attachments that nothing is written to.
pub const PLACEHOLDER_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::R8Unorm;

/// The bytes of a buffer that clears copy from.
const PATTERN_BYTES: u64 = 1 << 20;

/// The memory of one plan.
pub struct Memory {
    gpu: Gpu,
    buffers: BTreeMap<String, wgpu::Buffer>,
    textures: BTreeMap<String, wgpu::Texture>,
    /// Buffers full of a word that is not 0.
    patterns: BTreeMap<u32, wgpu::Buffer>,
    /// Attachments that nothing is written to, by their samples per pixel.
    placeholders: BTreeMap<u32, wgpu::Texture>,
}

impl Memory {
    pub fn new(gpu: &Gpu) -> Self {
        Memory {
            gpu: gpu.clone(),
            buffers: BTreeMap::new(),
            textures: BTreeMap::new(),
            patterns: BTreeMap::new(),
            placeholders: BTreeMap::new(),
        }
    }

    /// Uses a texture of the engine.
    pub fn supply(&mut self, name: &str, texture: &wgpu::Texture) {
        self.textures.insert(name.to_owned(), texture.clone());
    }

    /// Creates every buffer and texture whose size is known and has changed. A buffer up to twice as large as needed is kept.
    pub fn allocate(&mut self, plan: &Plan, values: &Values, size: [u32; 2]) -> Result<(), Error> {
        for resource in plan.resources.iter().filter(|resource| resource.init != "external") {
            match &resource.texture {
                Some(_) if self.textures.contains_key(&resource.name) => {}
                Some(texture) => {
                    let descriptor = describe(texture, values, size)?;
                    let what = format!("the texture `{}`", resource.name);
                    let created = scoped(&self.gpu.device, &what, || self.gpu.device.create_texture(&descriptor))?;
                    self.textures.insert(resource.name.clone(), created);
                }
                None => self.allocate_buffer(resource, values)?,
            }
        }
        Ok(())
    }

    fn allocate_buffer(&mut self, resource: &Resource, values: &Values) -> Result<(), Error> {
        // A host step has yet to decide the size.
        let Ok(bytes) = values.bytes(resource) else { return Ok(()) };
        let size = bytes.max(resource.least_bytes.unwrap_or(0)).max(4).next_multiple_of(4);
        let fits = |present: &wgpu::Buffer| (size..=size.saturating_mul(2)).contains(&present.size());
        if self.buffers.get(&resource.name).is_some_and(fits) {
            return Ok(());
        }
        let limits = self.gpu.device.limits();
        let most = limits.max_storage_buffer_binding_size.min(limits.max_buffer_size);
        if size > most {
            return Err(Error(format!(
                "`{}` needs {size} bytes, and the device has buffers of {most} at most: keep fewer fragments, or draw a smaller frame",
                resource.name
            )));
        }
        let usage = wgpu::BufferUsages::STORAGE
            | wgpu::BufferUsages::INDIRECT
            | wgpu::BufferUsages::COPY_SRC
            | wgpu::BufferUsages::COPY_DST;
        let label = Some(resource.name.as_str());
        let descriptor = wgpu::BufferDescriptor { label, size, usage, mapped_at_creation: false };
        let what = format!("the buffer `{}` of {size} bytes", resource.name);
        let created = scoped(&self.gpu.device, &what, || self.gpu.device.create_buffer(&descriptor))?;
        self.buffers.insert(resource.name.clone(), created);
        Ok(())
    }

    /// The bytes of all buffers and textures, without those of the engine.
    pub fn bytes(&self, plan: &Plan) -> u64 {
        let is_own = |name: &str| plan.resource(name).is_some_and(|resource| resource.init != "external");
        let textures = self.textures.iter().filter(|(name, _)| is_own(name)).map(|(_, texture)| texture_bytes(texture));
        self.buffers.values().map(wgpu::Buffer::size).chain(textures).sum()
    }

    pub fn buffer(&self, name: &str) -> Result<&wgpu::Buffer, Error> {
        self.buffers.get(name).ok_or_else(|| {
            Error(format!("`{name}` has no memory, because a symbol of its size has no value: set it before the frame"))
        })
    }

    pub fn texture(&self, name: &str) -> Result<&wgpu::Texture, Error> {
        self.textures.get(name).ok_or_else(|| Error(format!("`{name}` is no texture, or has not been set")))
    }

    /// Records a clear of every word of a buffer.
    pub fn clear_buffer(&mut self, encoder: &mut wgpu::CommandEncoder, name: &str, value: u32) -> Result<(), Error> {
        let buffer = self.buffer(name)?.clone();
        if value == 0 {
            encoder.clear_buffer(&buffer, 0, None);
            return Ok(());
        }
        let device = &self.gpu.device;
        let pattern = self.patterns.entry(value).or_insert_with(|| {
            let bytes: Vec<u8> = value.to_le_bytes().repeat(PATTERN_BYTES as usize / 4);
            filled(device, wgpu::BufferUsages::COPY_SRC, &bytes)
        });
        let mut at = 0;
        while at < buffer.size() {
            let bytes = PATTERN_BYTES.min(buffer.size() - at);
            encoder.copy_buffer_to_buffer(pattern, 0, &buffer, at, bytes);
            at += bytes;
        }
        Ok(())
    }

    /// Returns an attachment for passes that write only buffers.
    pub fn placeholder(&mut self, samples: u32, [width, height]: [u32; 2]) -> wgpu::TextureView {
        let device = &self.gpu.device;
        let texture = self.placeholders.entry(samples).or_insert_with(|| {
            device.create_texture(&wgpu::TextureDescriptor {
                label: Some("no target"),
                size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
                mip_level_count: 1,
                sample_count: samples,
                dimension: wgpu::TextureDimension::D2,
                format: PLACEHOLDER_FORMAT,
                usage: wgpu::TextureUsages::RENDER_ATTACHMENT,
                view_formats: &[],
            })
        });
        texture.create_view(&wgpu::TextureViewDescriptor::default())
    }
}

/// Creates a buffer with these bytes.
pub fn filled(device: &wgpu::Device, usage: wgpu::BufferUsages, bytes: &[u8]) -> wgpu::Buffer {
    let size = (bytes.len() as u64).max(4).next_multiple_of(4);
    let descriptor = wgpu::BufferDescriptor { label: None, size, usage, mapped_at_creation: true };
    let buffer = device.create_buffer(&descriptor);
    buffer.slice(..bytes.len() as u64).get_mapped_range_mut().copy_from_slice(bytes);
    buffer.unmap();
    buffer
}

/// Describes a texture of a plan, for a frame of this size.
pub fn describe(
    texture: &Texture,
    values: &Values,
    [width, height]: [u32; 2],
) -> Result<wgpu::TextureDescriptor<'static>, Error> {
    let sample_count = u32::try_from(values.value(&texture.samples, 0)?).unwrap_or(u32::MAX);
    let mut usage = wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING;
    // WebGPU copies no texture with several samples.
    if sample_count == 1 {
        usage |= wgpu::TextureUsages::COPY_SRC | wgpu::TextureUsages::COPY_DST;
    }
    Ok(wgpu::TextureDescriptor {
        label: None,
        size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count,
        dimension: wgpu::TextureDimension::D2,
        format: names::format(&texture.format)?,
        usage,
        view_formats: &[],
    })
}

/// Returns the bytes of a texture.
pub fn texture_bytes(texture: &wgpu::Texture) -> u64 {
    // Depth with stencil has no size in WebGPU; drivers take four bytes or more.
    let texel = texture.format().block_copy_size(None).unwrap_or(4);
    u64::from(texture.width()) * u64::from(texture.height()) * u64::from(texture.sample_count()) * u64::from(texel)
}
