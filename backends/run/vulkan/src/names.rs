//! Words of the manifest as Vulkan's values: formats, comparisons, stencil operations, blending.

use ash::vk;
use fragbuf_follow::Error;

/// Returns the formats for a texture, the first that a device has is used.
pub fn formats(name: &str) -> Result<&'static [vk::Format], Error> {
    Ok(match name {
        "r32uint" => &[vk::Format::R32_UINT],
        "rg16uint" => &[vk::Format::R16G16_UINT],
        "r32float" => &[vk::Format::R32_SFLOAT],
        "rg32float" => &[vk::Format::R32G32_SFLOAT],
        "rgba8unorm" => &[vk::Format::R8G8B8A8_UNORM],
        "rgba16float" => &[vk::Format::R16G16B16A16_SFLOAT],
        "depth32float" => &[vk::Format::D32_SFLOAT],
        "depth24plus-stencil8" => &[vk::Format::D24_UNORM_S8_UINT, vk::Format::D32_SFLOAT_S8_UINT],
        other => return Err(unknown("texture format", other)),
    })
}

/// The format of textures of a description.
pub const TEXEL_FORMATS: [vk::Format; 1] = [vk::Format::R32G32B32A32_SFLOAT];

/// Returns what a format stores.
pub fn aspects(format: vk::Format) -> vk::ImageAspectFlags {
    match format {
        vk::Format::D32_SFLOAT => vk::ImageAspectFlags::DEPTH,
        vk::Format::D24_UNORM_S8_UINT | vk::Format::D32_SFLOAT_S8_UINT => {
            vk::ImageAspectFlags::DEPTH | vk::ImageAspectFlags::STENCIL
        }
        _ => vk::ImageAspectFlags::COLOR,
    }
}

pub fn is_depth(format: vk::Format) -> bool {
    aspects(format).contains(vk::ImageAspectFlags::DEPTH)
}

pub fn is_integer(format: vk::Format) -> bool {
    [vk::Format::R32_UINT, vk::Format::R16G16_UINT].contains(&format)
}

/// Returns the bytes of a texel that the host reads or writes; of depth with stencil none.
pub fn texel_bytes(format: vk::Format) -> Option<u64> {
    match format {
        vk::Format::R32_UINT
        | vk::Format::R16G16_UINT
        | vk::Format::R32_SFLOAT
        | vk::Format::R8G8B8A8_UNORM
        | vk::Format::D32_SFLOAT => Some(4),
        vk::Format::R32G32_SFLOAT | vk::Format::R16G16B16A16_SFLOAT => Some(8),
        vk::Format::R32G32B32A32_SFLOAT => Some(16),
        _ => None,
    }
}

pub fn comparison(name: &str) -> Result<vk::CompareOp, Error> {
    Ok(match name {
        "never" => vk::CompareOp::NEVER,
        "less" => vk::CompareOp::LESS,
        "less-equal" => vk::CompareOp::LESS_OR_EQUAL,
        "equal" => vk::CompareOp::EQUAL,
        "greater" => vk::CompareOp::GREATER,
        "greater-equal" => vk::CompareOp::GREATER_OR_EQUAL,
        "always" => vk::CompareOp::ALWAYS,
        other => return Err(unknown("comparison", other)),
    })
}

pub fn stencil_operation(name: &str) -> Result<vk::StencilOp, Error> {
    Ok(match name {
        "keep" => vk::StencilOp::KEEP,
        "replace" => vk::StencilOp::REPLACE,
        "decrement-clamp" => vk::StencilOp::DECREMENT_AND_CLAMP,
        other => return Err(unknown("stencil operation", other)),
    })
}

pub fn blend_factor(name: &str) -> Result<vk::BlendFactor, Error> {
    Ok(match name {
        "zero" => vk::BlendFactor::ZERO,
        "one" => vk::BlendFactor::ONE,
        "one-minus-src-alpha" => vk::BlendFactor::ONE_MINUS_SRC_ALPHA,
        "one-minus-dst-alpha" => vk::BlendFactor::ONE_MINUS_DST_ALPHA,
        other => return Err(unknown("blend factor", other)),
    })
}

pub fn blend_operation(name: &str) -> Result<vk::BlendOp, Error> {
    Ok(match name {
        "add" => vk::BlendOp::ADD,
        "min" => vk::BlendOp::MIN,
        "max" => vk::BlendOp::MAX,
        other => return Err(unknown("blend operation", other)),
    })
}

pub fn stage(name: &str) -> Result<vk::ShaderStageFlags, Error> {
    Ok(match name {
        "vertex" => vk::ShaderStageFlags::VERTEX,
        "fragment" => vk::ShaderStageFlags::FRAGMENT,
        "compute" => vk::ShaderStageFlags::COMPUTE,
        other => return Err(unknown("shader stage", other)),
    })
}

/// Returns the format of a vertex input by its type in WGSL.
pub fn vertex_format(kind: &str) -> Result<vk::Format, Error> {
    Ok(match kind {
        "f32" => vk::Format::R32_SFLOAT,
        "u32" => vk::Format::R32_UINT,
        "i32" => vk::Format::R32_SINT,
        "vec2<f32>" => vk::Format::R32G32_SFLOAT,
        "vec3<f32>" => vk::Format::R32G32B32_SFLOAT,
        "vec4<f32>" => vk::Format::R32G32B32A32_SFLOAT,
        other => return Err(unknown("vertex input", other)),
    })
}

/// Returns the flag of a sample count.
pub fn samples(count: u64) -> Result<vk::SampleCountFlags, Error> {
    match count {
        // More need a second word of sample mask.
        1 | 2 | 4 | 8 | 16 | 32 => Ok(vk::SampleCountFlags::from_raw(count as u32)),
        other => Err(Error(format!("{other} samples per pixel: this host has powers of two up to 32"))),
    }
}

fn unknown(what: &str, name: &str) -> Error {
    Error(format!("unknown {what} `{name}`"))
}
