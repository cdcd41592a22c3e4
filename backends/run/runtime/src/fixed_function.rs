//! The fixed-function state of a pass's pipeline: targets, depth and stencil tests, samples.
//!
//! Input: the state of a pass and the plan's textures. Output: wgpu's descriptors. This module is independent of the technique.

use fragbuf_codegen::{Plan, PlannedPass, SymbolId};
use fragbuf_templates::vocabulary::{
    Blend, ColorTarget, Compare, Element, Pass, StencilOperation, StencilState, TextureFormat,
};

use crate::Error;
use crate::placeholder::placeholder_target;
use crate::samples::multisample;
use crate::texture::{OUTPUT, texture_format};

/// The state of one pipeline.
pub(crate) struct FixedFunction {
    pub(crate) targets: Vec<Option<wgpu::ColorTargetState>>,
    pub(crate) depth_stencil: Option<wgpu::DepthStencilState>,
    pub(crate) multisample: wgpu::MultisampleState,
}

/// Returns the states of a pass: one, or one for each iteration if its sample mask depends on the iteration.
pub(crate) fn fixed_functions(
    plan: &Plan,
    pass: &PlannedPass,
    output: wgpu::TextureFormat,
    iterations: u32,
) -> Result<Vec<FixedFunction>, Error> {
    let changes = pass.samples.as_ref().is_some_and(|[_, mask]| mask.mentions(SymbolId::ITERATION));
    let states = (0..if changes { iterations } else { 1 }).map(|iteration| {
        Ok(FixedFunction {
            targets: targets(plan, pass, output),
            depth_stencil: depth_stencil(plan, pass),
            multisample: multisample(plan, pass, iteration)?,
        })
    });
    states.collect()
}

fn targets(plan: &Plan, pass: &Pass, output: wgpu::TextureFormat) -> Vec<Option<wgpu::ColorTargetState>> {
    let state = &pass.state;
    if state.targets.is_empty() && state.depth.is_none() && state.stencil.is_none() {
        return vec![Some(placeholder_target())];
    }
    let target = |target: &ColorTarget| {
        let format = match target.resource.as_str() {
            OUTPUT => output,
            name => texture_format(format_of(plan, name)?),
        };
        let blend = blend_state(target.blend);
        Some(wgpu::ColorTargetState { format, blend, write_mask: wgpu::ColorWrites::ALL })
    };
    state.targets.iter().map(target).collect()
}

fn format_of(plan: &Plan, name: &str) -> Option<TextureFormat> {
    match plan.resource(name)?.resource.element {
        Element::Texture(format) => Some(format),
        _ => None,
    }
}

fn depth_stencil(plan: &Plan, pass: &Pass) -> Option<wgpu::DepthStencilState> {
    let (depth, stencil) = (pass.state.depth.as_ref(), pass.state.stencil.as_ref());
    let name = depth.map(|depth| &depth.resource).or(stencil.map(|stencil| &stencil.resource))?;
    Some(wgpu::DepthStencilState {
        format: texture_format(format_of(plan, name)?),
        depth_write_enabled: Some(depth.is_some_and(|depth| depth.write)),
        depth_compare: Some(depth.map_or(wgpu::CompareFunction::Always, |depth| compare(depth.compare))),
        stencil: stencil.map_or_else(wgpu::StencilState::default, stencil_state),
        bias: wgpu::DepthBiasState::default(),
    })
}

fn stencil_state(state: &StencilState) -> wgpu::StencilState {
    let face = wgpu::StencilFaceState {
        compare: compare(state.compare),
        fail_op: operation(state.fail),
        // A fragment that only the depth test rejects does not change the stencil.
        depth_fail_op: wgpu::StencilOperation::Keep,
        pass_op: operation(state.pass),
    };
    wgpu::StencilState { front: face, back: face, read_mask: 0xff, write_mask: 0xff }
}

fn compare(compare: Compare) -> wgpu::CompareFunction {
    match compare {
        Compare::Always => wgpu::CompareFunction::Always,
        Compare::Less => wgpu::CompareFunction::Less,
        Compare::LessEqual => wgpu::CompareFunction::LessEqual,
        Compare::Equal => wgpu::CompareFunction::Equal,
        Compare::Greater => wgpu::CompareFunction::Greater,
        Compare::GreaterEqual => wgpu::CompareFunction::GreaterEqual,
    }
}

fn operation(operation: StencilOperation) -> wgpu::StencilOperation {
    match operation {
        StencilOperation::Keep => wgpu::StencilOperation::Keep,
        StencilOperation::Replace => wgpu::StencilOperation::Replace,
        StencilOperation::DecrementClamp => wgpu::StencilOperation::DecrementClamp,
    }
}

fn blend_state(blend: Blend) -> Option<wgpu::BlendState> {
    use wgpu::BlendFactor::{One, OneMinusDstAlpha, OneMinusSrcAlpha};
    use wgpu::BlendOperation::{Add, Max, Min};
    let (src_factor, dst_factor, operation) = match blend {
        Blend::Replace => return None,
        Blend::Over => (One, OneMinusSrcAlpha, Add),
        Blend::Under => (OneMinusDstAlpha, One, Add),
        Blend::Max => (One, One, Max),
        Blend::Min => (One, One, Min),
        Blend::Add => (One, One, Add),
    };
    let component = wgpu::BlendComponent { src_factor, dst_factor, operation };
    Some(wgpu::BlendState { color: component, alpha: component })
}
