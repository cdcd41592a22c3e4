//! The fixed-function state of a pass: depth, stencil, blending, samples.

use fragbuf_follow::manifest::{State, Target};
use glow::HasContext as _;

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
        blend(gl, &state.targets)?;
        // Coverage `whole-pixel` allows GL_MULTISAMPLE, which is on from the start, to be switched off, but without it the sample mask has no effect, and Mesa's
        // llvmpipe writes the first sample alone. So fragments at edges cover some of the samples here.
        if let Some(samples) = &state.samples {
            gl.enable(glow::SAMPLE_MASK);
            (context.sample_mask)(0, value(&samples.mask)? as u32);
        }
    }
    Ok(())
}

/// Sets the blending of the targets. OpenGL ES 3.1 has one setting for all of them: the manifest requires an extension where they differ.
fn blend(gl: &glow::Context, targets: &[Target]) -> Result<(), Error> {
    let Some((first, others)) = targets.split_first() else {
        // SAFETY: the context is current.
        unsafe { gl.disable(glow::BLEND) };
        return Ok(());
    };
    if others.iter().all(|target| target.blend == first.blend) {
        let Some((operation, source, destination)) = equation(first)? else {
            // SAFETY: the context is current.
            unsafe { gl.disable(glow::BLEND) };
            return Ok(());
        };
        // SAFETY: the context is current.
        unsafe {
            gl.enable(glow::BLEND);
            gl.blend_equation(operation);
            gl.blend_func(source, destination);
        }
        return Ok(());
    }
    for (index, target) in (0..).zip(targets) {
        let Some((operation, source, destination)) = equation(target)? else {
            // SAFETY: the context is current.
            unsafe { gl.disable_draw_buffer(glow::BLEND, index) };
            continue;
        };
        // SAFETY: the context is current.
        unsafe {
            gl.enable_draw_buffer(glow::BLEND, index);
            gl.blend_equation_draw_buffer(index, operation);
            gl.blend_func_draw_buffer(index, source, destination);
        }
    }
    Ok(())
}

/// Returns operation, source and destination factor; `None`: blending is off.
fn equation(target: &Target) -> Result<Option<(u32, u32, u32)>, Error> {
    let Some(blend) = &target.blend else { return Ok(None) };
    let operation = match blend.operation.as_str() {
        "add" => glow::FUNC_ADD,
        "min" => glow::MIN,
        "max" => glow::MAX,
        other => return Err(unknown("blend operation", other)),
    };
    Ok(Some((operation, factor(&blend.source)?, factor(&blend.destination)?)))
}

fn factor(name: &str) -> Result<u32, Error> {
    Ok(match name {
        "zero" => glow::ZERO,
        "one" => glow::ONE,
        "one-minus-src-alpha" => glow::ONE_MINUS_SRC_ALPHA,
        "one-minus-dst-alpha" => glow::ONE_MINUS_DST_ALPHA,
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
