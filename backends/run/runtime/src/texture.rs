//! The textures of a plan on wgpu: formats, sizes, samples, and clear values from the plan's words.

use fragbuf_codegen::{Plan, PlannedResource};
use fragbuf_frame::Values;
use fragbuf_templates::vocabulary::TextureFormat;

use crate::{Error, Pending};

/// The vocabulary's name for the caller's output.
pub(crate) const OUTPUT: &str = "output";

pub(crate) fn texture_format(format: TextureFormat) -> wgpu::TextureFormat {
    match format {
        TextureFormat::R32Uint => wgpu::TextureFormat::R32Uint,
        TextureFormat::Rg16Uint => wgpu::TextureFormat::Rg16Uint,
        TextureFormat::R32Float => wgpu::TextureFormat::R32Float,
        TextureFormat::Rg32Float => wgpu::TextureFormat::Rg32Float,
        TextureFormat::Rgba8Unorm => wgpu::TextureFormat::Rgba8Unorm,
        TextureFormat::Rgba16Float => wgpu::TextureFormat::Rgba16Float,
        TextureFormat::Depth32Float => wgpu::TextureFormat::Depth32Float,
        TextureFormat::Depth24PlusStencil8 => wgpu::TextureFormat::Depth24PlusStencil8,
    }
}

/// Returns the type that a shader reads; for depth with stencil it is the stencil.
pub(crate) fn sample_type(format: TextureFormat) -> wgpu::TextureSampleType {
    match format {
        TextureFormat::R32Uint | TextureFormat::Rg16Uint | TextureFormat::Depth24PlusStencil8 => {
            wgpu::TextureSampleType::Uint
        }
        TextureFormat::Depth32Float => wgpu::TextureSampleType::Depth,
        _ => wgpu::TextureSampleType::Float { filterable: false },
    }
}

/// Creates the view that a shader reads.
pub(crate) fn sampled_view(texture: &wgpu::Texture) -> wgpu::TextureView {
    let aspect = match texture.format() {
        wgpu::TextureFormat::Depth24PlusStencil8 => wgpu::TextureAspect::StencilOnly,
        _ => wgpu::TextureAspect::All,
    };
    texture.create_view(&wgpu::TextureViewDescriptor { aspect, ..wgpu::TextureViewDescriptor::default() })
}

/// Returns the samples per pixel of a texture.
pub(crate) fn texture_samples(plan: &Plan, planned: &PlannedResource) -> Result<u32, Error> {
    let Some(length) = planned.sample_count() else { return Ok(1) };
    Ok(Values::of_code(plan).word(length, &format!("the samples of `{}`", planned.resource.name))?)
}

/// Creates a texture of the size of the frame.
pub(crate) fn create_texture(
    device: &wgpu::Device,
    plan: &Plan,
    planned: &PlannedResource,
    format: TextureFormat,
    (width, height): (u32, u32),
) -> Result<wgpu::Texture, Error> {
    let sample_count = texture_samples(plan, planned)?;
    let mut usage = wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING;
    // WebGPU cannot copy a multisampled texture to a buffer.
    if sample_count == 1 {
        usage |= wgpu::TextureUsages::COPY_SRC | wgpu::TextureUsages::COPY_DST;
    }
    Ok(device.create_texture(&wgpu::TextureDescriptor {
        label: Some(&planned.resource.name),
        size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count,
        dimension: wgpu::TextureDimension::D2,
        format: texture_format(format),
        usage,
        view_formats: &[],
    }))
}

/// Converts the word that a plan clears a colour texture to.
pub(crate) fn color_of(format: wgpu::TextureFormat, word: u32) -> wgpu::Color {
    let [r, g, b, a] = match format {
        wgpu::TextureFormat::R32Uint => [f64::from(word), 0.0, 0.0, 0.0],
        wgpu::TextureFormat::Rg16Uint => [f64::from(word & 0xffff), f64::from(word >> 16), 0.0, 0.0],
        wgpu::TextureFormat::Rgba8Unorm => word.to_le_bytes().map(|byte| f64::from(byte) / 255.0),
        // In a float format all channels get the same number.
        _ => [f64::from(f32::from_bits(word)); 4],
    };
    wgpu::Color { r, g, b, a }
}

/// Converts the word that a plan clears a depth texture to.
pub(crate) fn depth_of(format: wgpu::TextureFormat, word: u32) -> f32 {
    match format {
        wgpu::TextureFormat::Depth32Float => f32::from_bits(word),
        _ => (word >> 8) as f32 / 16_777_215.0,
    }
}

/// Records the readback of a texture's texels, row after row. Returns `None` if they cannot be copied.
pub(crate) fn read_texture(
    device: &wgpu::Device,
    encoder: &mut wgpu::CommandEncoder,
    texture: &wgpu::Texture,
) -> Option<Pending<Vec<u32>>> {
    let copies = texture.sample_count() == 1 && texture.usage().contains(wgpu::TextureUsages::COPY_SRC);
    let texel = texture.format().block_copy_size(None).filter(|_| copies)?;
    let row = (texture.width() * texel) as usize;
    let padded = (texture.width() * texel).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
    let buffer = device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("fragbuf readback"),
        size: u64::from(padded) * u64::from(texture.height()),
        usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::COPY_SRC,
        mapped_at_creation: false,
    });
    let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(padded), rows_per_image: None };
    let target = wgpu::TexelCopyBufferInfo { buffer: &buffer, layout };
    encoder.copy_texture_to_buffer(texture.as_image_copy(), target, texture.size());
    let rows = move |words: Vec<u32>| {
        words.chunks(padded as usize / 4).flat_map(|words| words.iter().copied().take(row / 4)).collect()
    };
    Some(Pending::record(device, encoder, &buffer, 0, buffer.size(), rows))
}
