//! The fixed-function state of a pass: depth, stencil, blending, samples.

use glow::HasContext as _;

use crate::manifest::{Blend, State};
use crate::{Context, Error};

/// Sets the state of a pass. What the manifest omits is off. `value` evaluates a formula.
pub fn set(context: &Context, state: &State, value: &dyn Fn(&str) -> Result<u64, Error>) -> Result<(), Error> {
    let gl = &context.gl;
    // SAFETY: the context is current.
    unsafe {
        for capability in [glow::DEPTH_TEST, glow::STENCIL_TEST, glow::CULL_FACE, glow::SCISSOR_TEST, glow::SAMPLE_MASK]
        {
            gl.disable(capability);
        }
        gl.enable(glow::MULTISAMPLE);
        if let Some(depth) = &state.depth {
            gl.enable(glow::DEPTH_TEST);
            gl.depth_func(comparison(&depth.compare)?);
            gl.depth_mask(depth.write);
        }
        if let Some(stencil) = &state.stencil {
            gl.enable(glow::STENCIL_TEST);
            gl.stencil_mask(0xff);
            gl.stencil_func(comparison(&stencil.compare)?, value(&stencil.reference)? as i32, 0xff);
            gl.stencil_op(operation(&stencil.fail)?, glow::KEEP, operation(&stencil.pass)?);
        }
        for (index, target) in (0..).zip(&state.targets) {
            blend(gl, index, &target.blend)?;
        }
        // Coverage `whole-pixel` allows GL_MULTISAMPLE to be switched off, but without it the sample mask has no effect, and Mesa's
        // llvmpipe writes the first sample alone. So fragments at edges cover some of the samples here.
        if let Some(samples) = &state.samples {
            gl.enable(glow::SAMPLE_MASK);
            (context.sample_mask)(0, value(&samples.mask)? as u32);
        }
    }
    Ok(())
}

/// Sets the blending of one target.
fn blend(gl: &glow::Context, index: u32, blend: &Blend) -> Result<(), Error> {
    let operation = match blend.operation.as_str() {
        "add" => glow::FUNC_ADD,
        "min" => glow::MIN,
        "max" => glow::MAX,
        other => return Err(unknown("blend operation", other)),
    };
    let (source, destination) = (factor(&blend.source)?, factor(&blend.destination)?);
    // SAFETY: the context is current.
    unsafe {
        if (operation, source, destination) == (glow::FUNC_ADD, glow::ONE, glow::ZERO) {
            gl.disable_draw_buffer(glow::BLEND, index);
        } else {
            gl.enable_draw_buffer(glow::BLEND, index);
            gl.blend_equation_draw_buffer(index, operation);
            gl.blend_func_draw_buffer(index, source, destination);
        }
    }
    Ok(())
}

fn factor(name: &str) -> Result<u32, Error> {
    Ok(match name {
        "zero" => glow::ZERO,
        "one" => glow::ONE,
        "one-minus-source-alpha" => glow::ONE_MINUS_SRC_ALPHA,
        "one-minus-destination-alpha" => glow::ONE_MINUS_DST_ALPHA,
        other => return Err(unknown("blend factor", other)),
    })
}

fn comparison(name: &str) -> Result<u32, Error> {
    Ok(match name {
        "never" => glow::NEVER,
        "less" => glow::LESS,
        "equal" => glow::EQUAL,
        "less-equal" => glow::LEQUAL,
        "greater" => glow::GREATER,
        "not-equal" => glow::NOTEQUAL,
        "greater-equal" => glow::GEQUAL,
        "always" => glow::ALWAYS,
        other => return Err(unknown("comparison", other)),
    })
}

fn operation(name: &str) -> Result<u32, Error> {
    Ok(match name {
        "keep" => glow::KEEP,
        "zero" => glow::ZERO,
        "replace" => glow::REPLACE,
        "invert" => glow::INVERT,
        "increment-clamp" => glow::INCR,
        "decrement-clamp" => glow::DECR,
        "increment-wrap" => glow::INCR_WRAP,
        "decrement-wrap" => glow::DECR_WRAP,
        other => return Err(unknown("stencil operation", other)),
    })
}

fn unknown(what: &str, name: &str) -> Error {
    Error(format!("unknown {what} `{name}`"))
}
