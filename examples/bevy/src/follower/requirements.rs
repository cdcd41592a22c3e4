//! Compares what a plan needs with what a device offers.
//!
//! Input: a device, a plan, the values of its symbols. Output: an error that names everything that the device lacks. Nothing is left out in
//! silence: a limit or a feature that this file does not know is an error.

use fragbuf_follow::manifest::{Limit, Plan};
use fragbuf_follow::{Error, Values};
use serde_json::Value;

use super::layouts::sample_formula;
use crate::TARGET;

/// The numbers of samples per pixel that every device has.
const SAMPLE_COUNTS: [u64; 2] = [1, 4];

/// Returns an error that lists everything that the device lacks.
pub fn check(device: &wgpu::Device, plan: &Plan, values: &Values) -> Result<(), Error> {
    let limits = device.limits();
    let mut lacking = Vec::new();
    for limit in &plan.limits {
        lacking.extend(unmet(&limits, limit, values)?);
    }
    lacking.extend(plan.requirements(TARGET).features.iter().filter_map(|name| missing_feature(device, name)));
    for (_, pass) in plan.passes() {
        let count = values.value(sample_formula(plan, pass), 0)?;
        if !SAMPLE_COUNTS.contains(&count) {
            lacking
                .push(format!("the pass `{}` has {count} samples per pixel, and every device has 1 and 4", pass.name));
        }
    }
    match lacking.is_empty() {
        true => Ok(()),
        false => Err(Error(format!("the device lacks what the passes need: {}", lacking.join("; ")))),
    }
}

/// Checks that a device has textures of a size.
pub fn check_size(device: &wgpu::Device, [width, height]: [u32; 2]) -> Result<(), Error> {
    let most = device.limits().max_texture_dimension_2d;
    if (1..=most).contains(&width) && (1..=most).contains(&height) {
        return Ok(());
    }
    Err(Error(format!("a frame of {width} × {height} pixels: the device draws from 1 × 1 to {most} × {most}")))
}

fn unmet(limits: &wgpu::Limits, limit: &Limit, values: &Values) -> Result<Option<String>, Error> {
    let Some(name) = &limit.webgpu else { return Ok(None) };
    let needed = match &limit.needed {
        // What depends on a symbol that a step of the frame sets is checked when memory is allocated.
        Value::String(formula) => values.value(formula, 0).unwrap_or(0),
        number => number.as_u64().unwrap_or(0),
    };
    let offered = offered(limits, name);
    let offered =
        offered.ok_or_else(|| Error(format!("the manifest has the limit `{name}`, which this host does not have")))?;
    Ok((needed > offered).then(|| format!("`{name}` is {offered}, and {needed} is needed")))
}

/// Returns the value of a limit by its name in WebGPU.
fn offered(limits: &wgpu::Limits, name: &str) -> Option<u64> {
    Some(match name {
        "maxStorageBuffersPerShaderStage" => limits.max_storage_buffers_per_shader_stage.into(),
        "maxUniformBuffersPerShaderStage" => limits.max_uniform_buffers_per_shader_stage.into(),
        "maxSampledTexturesPerShaderStage" => limits.max_sampled_textures_per_shader_stage.into(),
        "maxBindGroups" => limits.max_bind_groups.into(),
        "maxBindingsPerBindGroup" => limits.max_bindings_per_bind_group.into(),
        "maxStorageBufferBindingSize" => limits.max_storage_buffer_binding_size,
        "maxBufferSize" => limits.max_buffer_size,
        "maxUniformBufferBindingSize" => limits.max_uniform_buffer_binding_size,
        "maxTextureDimension2D" => limits.max_texture_dimension_2d.into(),
        "maxColorAttachments" => limits.max_color_attachments.into(),
        "maxColorAttachmentBytesPerSample" => limits.max_color_attachment_bytes_per_sample.into(),
        "maxVertexAttributes" => limits.max_vertex_attributes.into(),
        "maxInterStageShaderVariables" => limits.max_inter_stage_shader_variables.into(),
        "maxComputeWorkgroupsPerDimension" => limits.max_compute_workgroups_per_dimension.into(),
        "maxComputeInvocationsPerWorkgroup" => limits.max_compute_invocations_per_workgroup.into(),
        "maxComputeWorkgroupStorageSize" => limits.max_compute_workgroup_storage_size.into(),
        "maxComputeWorkgroupSizeX" => limits.max_compute_workgroup_size_x.into(),
        "maxComputeWorkgroupSizeY" => limits.max_compute_workgroup_size_y.into(),
        "maxComputeWorkgroupSizeZ" => limits.max_compute_workgroup_size_z.into(),
        _ => return None,
    })
}

/// Returns what to say about a feature of WebGPU that the device lacks. wgpu spells `float32-blendable` as `FLOAT32_BLENDABLE`.
fn missing_feature(device: &wgpu::Device, name: &str) -> Option<String> {
    let feature = wgpu::Features::from_name(&name.replace('-', "_").to_uppercase());
    let is_present = feature.is_some_and(|feature| device.features().contains(feature));
    (!is_present).then(|| format!("the feature `{name}` is missing: request it in `WgpuSettings::features`"))
}
