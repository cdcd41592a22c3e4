//! Translates the words of a manifest, which are those of WebGPU, to the types of wgpu. A word that this host does not have is an error.

use fragbuf_follow::Error;
use fragbuf_follow::manifest::{Blend, Pass, Plan};

use super::Attachments;

/// Returns a texture format.
pub fn format(name: &str) -> Result<wgpu::TextureFormat, Error> {
    Ok(match name {
        "r32uint" => wgpu::TextureFormat::R32Uint,
        "rg16uint" => wgpu::TextureFormat::Rg16Uint,
        "r32float" => wgpu::TextureFormat::R32Float,
        "rg32float" => wgpu::TextureFormat::Rg32Float,
        "rgba8unorm" => wgpu::TextureFormat::Rgba8Unorm,
        "rgba16float" => wgpu::TextureFormat::Rgba16Float,
        "depth32float" => wgpu::TextureFormat::Depth32Float,
        "depth24plus-stencil8" => wgpu::TextureFormat::Depth24PlusStencil8,
        _ => return Err(unknown("texture format", name)),
    })
}

/// Returns the sample type of a texture binding.
pub fn sample_type(name: &str) -> Result<wgpu::TextureSampleType, Error> {
    Ok(match name {
        "float" => wgpu::TextureSampleType::Float { filterable: true },
        "unfilterable-float" => wgpu::TextureSampleType::Float { filterable: false },
        "uint" => wgpu::TextureSampleType::Uint,
        "sint" => wgpu::TextureSampleType::Sint,
        "depth" => wgpu::TextureSampleType::Depth,
        _ => return Err(unknown("sample type", name)),
    })
}

/// Returns the aspect of a texture's view.
pub fn aspect(name: &str) -> Result<wgpu::TextureAspect, Error> {
    Ok(match name {
        "all" => wgpu::TextureAspect::All,
        "depth-only" => wgpu::TextureAspect::DepthOnly,
        "stencil-only" => wgpu::TextureAspect::StencilOnly,
        _ => return Err(unknown("aspect", name)),
    })
}

/// Returns the stages that declare a binding.
pub fn stages(names: &[String]) -> Result<wgpu::ShaderStages, Error> {
    names.iter().try_fold(wgpu::ShaderStages::NONE, |stages, name| match name.as_str() {
        "vertex" => Ok(stages | wgpu::ShaderStages::VERTEX),
        "fragment" => Ok(stages | wgpu::ShaderStages::FRAGMENT),
        "compute" => Ok(stages | wgpu::ShaderStages::COMPUTE),
        _ => Err(unknown("stage", name)),
    })
}

/// Returns the colour targets of a pass. `output` is the format of the caller's target.
pub fn targets(
    plan: &Plan,
    pass: &Pass,
    output: wgpu::TextureFormat,
) -> Result<Vec<Option<wgpu::ColorTargetState>>, Error> {
    let attachments = Attachments::of(plan, pass);
    if attachments.is_empty() {
        return Ok(vec![Some(placeholder())]);
    }
    let target = |(index, name): (usize, &String)| {
        let format = if name == "output" { Ok(output) } else { format_of(plan, name) }?;
        let stated = pass.state.targets.get(index);
        let blend = stated.and_then(|target| target.blend.as_ref()).map(blend).transpose()?;
        let write_mask = if stated.is_some() { wgpu::ColorWrites::ALL } else { wgpu::ColorWrites::empty() };
        Ok(Some(wgpu::ColorTargetState { format, blend, write_mask }))
    };
    attachments.colors.iter().enumerate().map(target).collect()
}

/// The target of passes that write only buffers: WebGPU has no pass without attachments.
fn placeholder() -> wgpu::ColorTargetState {
    let format = super::memory::PLACEHOLDER_FORMAT;
    wgpu::ColorTargetState { format, blend: None, write_mask: wgpu::ColorWrites::empty() }
}

/// Returns the depth and stencil tests of a pass. A fragment that fails the depth test keeps the stencil.
pub fn depth_stencil(plan: &Plan, pass: &Pass) -> Result<Option<wgpu::DepthStencilState>, Error> {
    let Some(name) = Attachments::of(plan, pass).depth else { return Ok(None) };
    let depth = pass.state.depth.as_ref();
    let compared = depth.map_or(Ok(wgpu::CompareFunction::Always), |depth| compare(&depth.compare))?;
    let face = match &pass.state.stencil {
        None => wgpu::StencilFaceState::IGNORE,
        Some(stencil) => wgpu::StencilFaceState {
            compare: compare(&stencil.compare)?,
            fail_op: operation(&stencil.fail)?,
            depth_fail_op: wgpu::StencilOperation::Keep,
            pass_op: operation(&stencil.pass)?,
        },
    };
    Ok(Some(wgpu::DepthStencilState {
        format: format_of(plan, &name)?,
        depth_write_enabled: Some(depth.is_some_and(|depth| depth.write)),
        depth_compare: Some(compared),
        stencil: wgpu::StencilState { front: face, back: face, read_mask: 255, write_mask: 255 },
        bias: wgpu::DepthBiasState::default(),
    }))
}

fn format_of(plan: &Plan, name: &str) -> Result<wgpu::TextureFormat, Error> {
    let texture = plan.resource(name).and_then(|resource| resource.texture.as_ref());
    let texture =
        texture.ok_or_else(|| Error(format!("`{name}` is attached, and it is no texture: generate again")))?;
    format(&texture.format)
}

fn blend(blend: &Blend) -> Result<wgpu::BlendState, Error> {
    let operation = match blend.operation.as_str() {
        "add" => wgpu::BlendOperation::Add,
        "min" => wgpu::BlendOperation::Min,
        "max" => wgpu::BlendOperation::Max,
        other => return Err(unknown("blend operation", other)),
    };
    let (src_factor, dst_factor) = (factor(&blend.source)?, factor(&blend.destination)?);
    let component = wgpu::BlendComponent { src_factor, dst_factor, operation };
    Ok(wgpu::BlendState { color: component, alpha: component })
}

fn factor(name: &str) -> Result<wgpu::BlendFactor, Error> {
    Ok(match name {
        "zero" => wgpu::BlendFactor::Zero,
        "one" => wgpu::BlendFactor::One,
        "one-minus-src-alpha" => wgpu::BlendFactor::OneMinusSrcAlpha,
        "one-minus-dst-alpha" => wgpu::BlendFactor::OneMinusDstAlpha,
        _ => return Err(unknown("blend factor", name)),
    })
}

fn compare(name: &str) -> Result<wgpu::CompareFunction, Error> {
    Ok(match name {
        "always" => wgpu::CompareFunction::Always,
        "less" => wgpu::CompareFunction::Less,
        "less-equal" => wgpu::CompareFunction::LessEqual,
        "equal" => wgpu::CompareFunction::Equal,
        "greater" => wgpu::CompareFunction::Greater,
        "greater-equal" => wgpu::CompareFunction::GreaterEqual,
        _ => return Err(unknown("comparison", name)),
    })
}

fn operation(name: &str) -> Result<wgpu::StencilOperation, Error> {
    Ok(match name {
        "keep" => wgpu::StencilOperation::Keep,
        "replace" => wgpu::StencilOperation::Replace,
        "decrement-clamp" => wgpu::StencilOperation::DecrementClamp,
        _ => return Err(unknown("stencil operation", name)),
    })
}

fn unknown(what: &str, name: &str) -> Error {
    Error(format!("the manifest has the {what} `{name}`, which this host does not have: use files of its version"))
}
