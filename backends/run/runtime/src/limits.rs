//! The limits that a device needs for a plan, for the descriptor of the caller's device.
//!
//! Input: the plan of shaders. Output: wgpu's default limits, raised where the plan needs more. Sizes that depend on the frame keep their
//! defaults: the renderer draws a frame that exceeds them in slices.

use fragbuf_targets::{Limit, Needed, limits};

use crate::Shaders;

impl Shaders {
    /// Returns the limits that the device needs for these shaders, apart from sizes that depend on the frame. Pass them as
    /// `required_limits`; wgpu rejects the request on an adapter that has less.
    pub fn limits(&self) -> wgpu::Limits {
        let mut needed = wgpu::Limits::default();
        for limit in limits(&self.plan, self.group, &[]) {
            raise(&mut needed, &limit);
        }
        needed
    }
}

fn raise(limits: &mut wgpu::Limits, limit: &Limit) {
    let (Needed::Number(number), Some(webgpu)) = (&limit.needed, limit.webgpu) else { return };
    let number = *number;
    if webgpu.name == "maxUniformBufferBindingSize" {
        limits.max_uniform_buffer_binding_size = limits.max_uniform_buffer_binding_size.max(number);
        return;
    }
    let field = match webgpu.name {
        "maxBindGroups" => &mut limits.max_bind_groups,
        "maxBindingsPerBindGroup" => &mut limits.max_bindings_per_bind_group,
        "maxStorageBuffersPerShaderStage" => &mut limits.max_storage_buffers_per_shader_stage,
        "maxUniformBuffersPerShaderStage" => &mut limits.max_uniform_buffers_per_shader_stage,
        "maxSampledTexturesPerShaderStage" => &mut limits.max_sampled_textures_per_shader_stage,
        "maxColorAttachments" => &mut limits.max_color_attachments,
        "maxColorAttachmentBytesPerSample" => &mut limits.max_color_attachment_bytes_per_sample,
        "maxVertexAttributes" => &mut limits.max_vertex_attributes,
        "maxInterStageShaderVariables" => &mut limits.max_inter_stage_shader_variables,
        _ => return,
    };
    *field = (*field).max(u32::try_from(number).unwrap_or(u32::MAX));
}
