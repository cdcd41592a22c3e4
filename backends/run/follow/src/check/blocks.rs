//! Checks uniform blocks: the host writes no byte outside of one.

use std::collections::BTreeSet;

use crate::manifest::{Block, Plan};
use crate::uniforms::CAMERA_BYTES;

/// The greatest size of a uniform block in bytes: as much as one `vkCmdUpdateBuffer` writes, and the least value of
/// `maxUniformBufferBindingSize` in WebGPU. OpenGL promises 16,384; what a plan needs is one of its `limits`.
const MOST_BYTES: usize = 65_536;

/// The types of fields.
const TYPES: [&str; 7] = ["f32", "u32", "i32", "vec2<f32>", "vec3<f32>", "vec4<f32>", "mat4x4<f32>"];

/// Checks that every field is inside of its block, and that no two blocks have one name.
pub fn check(plan: &Plan) -> Result<(), String> {
    let mut names = BTreeSet::new();
    for block in &plan.uniform_blocks {
        if !names.insert(&block.name) {
            return Err(format!("two uniform blocks have the name `{}`", block.name));
        }
        size(block)?;
        fields(block)?;
    }
    Ok(())
}

fn size(Block { name, bytes, .. }: &Block) -> Result<(), String> {
    if *bytes > MOST_BYTES {
        return Err(format!("the uniform block `{name}` has {bytes} bytes, more than {MOST_BYTES}"));
    }
    if bytes % 4 != 0 {
        return Err(format!("the uniform block `{name}` has {bytes} bytes, which are no whole words"));
    }
    if name == "camera" && *bytes != CAMERA_BYTES {
        return Err(format!("the uniform block `camera` has {bytes} bytes, and its matrix {CAMERA_BYTES}"));
    }
    Ok(())
}

fn fields(block: &Block) -> Result<(), String> {
    for field in &block.fields {
        if !TYPES.contains(&field.kind.as_str()) {
            return Err(format!("`{}` has the type `{}`, which this host does not write", field.name, field.kind));
        }
        if field.offset.checked_add(field.bytes()).is_none_or(|end| end > block.bytes) {
            return Err(format!("`{}` is outside of the uniform block `{}`", field.name, block.name));
        }
    }
    Ok(())
}
