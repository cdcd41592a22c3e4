//! Compares what a plan needs with what the driver and this host offer.
//!
//! Input: a plan with its `limits`, by their names in OpenGL. Output: an error that names every limit that the driver
//! does not meet, or what the host does not support.

use fragbuf_follow::manifest::{Limit, Plan};
use glow::HasContext as _;
use serde_json::Value;

use crate::{Context, Error};

/// The names of limits, and the values that OpenGL and OpenGL ES ask for. Those of [`BY_DIMENSION`] have an index.
const LIMITS: [(&str, u32); 22] = [
    ("GL_MAX_COMBINED_SHADER_OUTPUT_RESOURCES", glow::MAX_COMBINED_SHADER_OUTPUT_RESOURCES),
    ("GL_MAX_SHADER_STORAGE_BUFFER_BINDINGS", glow::MAX_SHADER_STORAGE_BUFFER_BINDINGS),
    ("GL_MAX_COMBINED_SHADER_STORAGE_BLOCKS", glow::MAX_COMBINED_SHADER_STORAGE_BLOCKS),
    ("GL_MAX_FRAGMENT_SHADER_STORAGE_BLOCKS", glow::MAX_FRAGMENT_SHADER_STORAGE_BLOCKS),
    ("GL_MAX_COMPUTE_SHADER_STORAGE_BLOCKS", glow::MAX_COMPUTE_SHADER_STORAGE_BLOCKS),
    ("GL_MAX_UNIFORM_BUFFER_BINDINGS", glow::MAX_UNIFORM_BUFFER_BINDINGS),
    ("GL_MAX_FRAGMENT_UNIFORM_BLOCKS", glow::MAX_FRAGMENT_UNIFORM_BLOCKS),
    ("GL_MAX_COMPUTE_UNIFORM_BLOCKS", glow::MAX_COMPUTE_UNIFORM_BLOCKS),
    ("GL_MAX_COMBINED_TEXTURE_IMAGE_UNITS", glow::MAX_COMBINED_TEXTURE_IMAGE_UNITS),
    ("GL_MAX_TEXTURE_IMAGE_UNITS", glow::MAX_TEXTURE_IMAGE_UNITS),
    ("GL_MAX_COMPUTE_TEXTURE_IMAGE_UNITS", glow::MAX_COMPUTE_TEXTURE_IMAGE_UNITS),
    ("GL_MAX_SHADER_STORAGE_BLOCK_SIZE", glow::MAX_SHADER_STORAGE_BLOCK_SIZE),
    ("GL_MAX_UNIFORM_BLOCK_SIZE", glow::MAX_UNIFORM_BLOCK_SIZE),
    ("GL_MAX_TEXTURE_SIZE", glow::MAX_TEXTURE_SIZE),
    ("GL_MAX_DRAW_BUFFERS", glow::MAX_DRAW_BUFFERS),
    ("GL_MAX_VERTEX_ATTRIBS", glow::MAX_VERTEX_ATTRIBS),
    ("GL_MAX_VARYING_VECTORS", glow::MAX_VARYING_VECTORS),
    ("GL_MAX_INTEGER_SAMPLES", glow::MAX_INTEGER_SAMPLES),
    ("GL_MAX_COLOR_TEXTURE_SAMPLES", glow::MAX_COLOR_TEXTURE_SAMPLES),
    ("GL_MAX_DEPTH_TEXTURE_SAMPLES", glow::MAX_DEPTH_TEXTURE_SAMPLES),
    ("GL_MAX_COMPUTE_WORK_GROUP_INVOCATIONS", glow::MAX_COMPUTE_WORK_GROUP_INVOCATIONS),
    ("GL_MAX_COMPUTE_SHARED_MEMORY_SIZE", glow::MAX_COMPUTE_SHARED_MEMORY_SIZE),
];

/// Limits with a value per dimension.
const BY_DIMENSION: [(&str, u32); 2] = [
    ("GL_MAX_COMPUTE_WORK_GROUP_COUNT", glow::MAX_COMPUTE_WORK_GROUP_COUNT),
    ("GL_MAX_COMPUTE_WORK_GROUP_SIZE", glow::MAX_COMPUTE_WORK_GROUP_SIZE),
];

/// Checks every limit whose needed value is known. `value` evaluates a formula.
pub fn check(context: &Context, limits: &[Limit], value: &dyn Fn(&str) -> Result<u64, Error>) -> Result<(), Error> {
    let mut unmet = Vec::new();
    for limit in limits {
        let Some(name) = &limit.opengl else { continue };
        let needed = match &limit.needed {
            // What depends on a symbol that has no value yet is checked later: sizes of buffers when they are created,
            // workgroups when they are dispatched.
            Value::String(formula) => value(formula).unwrap_or(0),
            number => number.as_u64().unwrap_or(0),
        };
        let Some(offered) = offered(context, name, limit.webgpu.as_deref()) else {
            return Err(Error(format!("unknown limit `{name}`")));
        };
        if needed > offered {
            unmet.push(format!("{name} is {offered}, and the passes need {needed}"));
        }
    }
    if unmet.is_empty() { Ok(()) } else { Err(Error(format!("{}: {}", context.name, unmet.join("; ")))) }
}

/// Checks that no pass takes its arguments from a buffer: this host draws and dispatches with numbers of its own.
pub fn check_uses(plan: &Plan) -> Result<(), Error> {
    match plan.passes().find(|(_, pass)| pass.uses.values().any(|access| access == "indirect")) {
        None => Ok(()),
        Some((_, pass)) => Err(Error(format!(
            "the pass `{}` has arguments in a buffer (`indirect`), which this host does not support: use the host for \
             Vulkan",
            pass.name
        ))),
    }
}

/// Returns the greatest numbers of workgroups along x, y and z.
pub fn most_groups(context: &Context) -> [u32; 3] {
    // SAFETY: the context is current.
    let most = |axis| unsafe { context.gl.get_parameter_indexed_i32(glow::MAX_COMPUTE_WORK_GROUP_COUNT, axis) };
    [0, 1, 2].map(|axis| most(axis).max(0) as u32)
}

/// Returns the value of a limit on this driver. One limit of several dimensions has a name per dimension in WebGPU.
fn offered(context: &Context, name: &str, webgpu: Option<&str>) -> Option<u64> {
    let gl = &context.gl;
    let of = |table: &[(&str, u32)]| table.iter().find(|(known, _)| *known == name).map(|(_, value)| *value);
    let value = match (of(&LIMITS), of(&BY_DIMENSION)) {
        // SAFETY: the context is current.
        (Some(limit), _) => unsafe { gl.get_parameter_i64(limit) },
        (None, Some(limit)) => {
            let dimension =
                webgpu.map_or(0, |name| ["X", "Y", "Z"].iter().position(|end| name.ends_with(end)).unwrap_or(0));
            // SAFETY: the context is current.
            unsafe { gl.get_parameter_indexed_i32(limit, dimension as u32) }.into()
        }
        (None, None) => return None,
    };
    Some(value.max(0) as u64)
}
