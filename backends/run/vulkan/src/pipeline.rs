//! Pipelines, one per combination of pass, sample count and sample mask.

use std::rc::Rc;

use ash::vk;
use fragbuf_follow::manifest::{Blend, Kind, Pass, State, VertexInput};

use crate::Error;
use crate::context::failed;
use crate::gpu::Gpu;
use crate::names::{blend_factor, blend_operation, comparison, stencil_operation, vertex_format};
use crate::shaders::Shaders;

/// A pipeline, and the render pass that it draws in.
pub struct Pipeline {
    gpu: Rc<Gpu>,
    pub pipeline: vk::Pipeline,
    pub render_pass: vk::RenderPass,
}

impl Drop for Pipeline {
    fn drop(&mut self) {
        // SAFETY: the host has waited for all commands.
        unsafe {
            self.gpu.device.destroy_pipeline(self.pipeline, None);
            self.gpu.device.destroy_render_pass(self.render_pass, None);
        }
    }
}

/// Creates the pipeline of a compute pass.
pub fn compute(gpu: &Rc<Gpu>, pass: &Pass, shaders: &Shaders) -> Result<Pipeline, Error> {
    let stages = stages(shaders);
    let [stage] = stages.as_slice() else {
        return Err(Error(format!("the compute pass `{}` has {} files, not 1", pass.name, stages.len())));
    };
    let info = [vk::ComputePipelineCreateInfo::default().layout(shaders.layout).stage(*stage)];
    // SAFETY: the modules and the layout exist.
    let created = unsafe { gpu.device.create_compute_pipelines(vk::PipelineCache::null(), &info, None) };
    finished(gpu, pass, created, vk::RenderPass::null())
}

/// Creates the pipeline of a pass that draws. The render pass belongs to the pipeline.
pub fn graphics(
    gpu: &Rc<Gpu>,
    (pass, shaders): (&Pass, &Shaders),
    render_pass: vk::RenderPass,
    inputs: &[VertexInput],
    (samples, mask): (vk::SampleCountFlags, u32),
) -> Result<Pipeline, Error> {
    // Dropping it destroys the render pass.
    let mut owner = Pipeline { gpu: gpu.clone(), pipeline: vk::Pipeline::null(), render_pass };
    let (bindings, attributes) = match pass.kind {
        Kind::Geometry => vertex_layout(inputs)?,
        Kind::Fullscreen | Kind::Compute => Default::default(),
    };
    let vertices = vk::PipelineVertexInputStateCreateInfo::default()
        .vertex_binding_descriptions(&bindings)
        .vertex_attribute_descriptions(&attributes);
    let assembly = vk::PipelineInputAssemblyStateCreateInfo::default().topology(vk::PrimitiveTopology::TRIANGLE_LIST);
    let viewport = vk::PipelineViewportStateCreateInfo::default().viewport_count(1).scissor_count(1);
    let rasterization = vk::PipelineRasterizationStateCreateInfo::default()
        .polygon_mode(vk::PolygonMode::FILL)
        .cull_mode(vk::CullModeFlags::NONE)
        .line_width(1.0);
    let masks = [mask];
    let multisample =
        vk::PipelineMultisampleStateCreateInfo::default().rasterization_samples(samples).sample_mask(&masks);
    let depth_stencil = depth_stencil(&pass.state)?;
    let blends = pass.state.targets.iter().map(|target| blend(target.blend.as_ref()));
    let blends = blends.collect::<Result<Vec<_>, Error>>()?;
    let blending = vk::PipelineColorBlendStateCreateInfo::default().attachments(&blends);
    let mut dynamic = vec![vk::DynamicState::VIEWPORT, vk::DynamicState::SCISSOR];
    dynamic.extend(pass.state.stencil.as_ref().map(|_| vk::DynamicState::STENCIL_REFERENCE));
    let dynamic = vk::PipelineDynamicStateCreateInfo::default().dynamic_states(&dynamic);
    let stages = stages(shaders);
    let info = [vk::GraphicsPipelineCreateInfo::default()
        .stages(&stages)
        .vertex_input_state(&vertices)
        .input_assembly_state(&assembly)
        .viewport_state(&viewport)
        .rasterization_state(&rasterization)
        .multisample_state(&multisample)
        .depth_stencil_state(&depth_stencil)
        .color_blend_state(&blending)
        .dynamic_state(&dynamic)
        .layout(shaders.layout)
        .render_pass(render_pass)];
    // SAFETY: the modules, the layout and the render pass exist, and what `info` points to lives until the end of the
    // call.
    let created = unsafe { gpu.device.create_graphics_pipelines(vk::PipelineCache::null(), &info, None) };
    owner.render_pass = vk::RenderPass::null();
    finished(gpu, pass, created, render_pass)
}

fn finished(
    gpu: &Rc<Gpu>,
    pass: &Pass,
    created: Result<Vec<vk::Pipeline>, (Vec<vk::Pipeline>, vk::Result)>,
    render_pass: vk::RenderPass,
) -> Result<Pipeline, Error> {
    let (pipelines, result) = match created {
        Ok(pipelines) => (pipelines, Ok(())),
        Err((pipelines, error)) => (pipelines, Err(error)),
    };
    // A pipeline that was not created is null, which may be destroyed.
    let pipeline = pipelines.first().copied().unwrap_or_default();
    let pipeline = Pipeline { gpu: gpu.clone(), pipeline, render_pass };
    result.map_err(failed(&format!("the pipeline of the pass `{}`", pass.name)))?;
    Ok(pipeline)
}

fn stages(shaders: &Shaders) -> Vec<vk::PipelineShaderStageCreateInfo<'_>> {
    let stages = shaders.stages.iter().map(|stage| {
        vk::PipelineShaderStageCreateInfo::default().stage(stage.stage).module(stage.module).name(&stage.entry_point)
    });
    stages.collect()
}

/// Returns the bytes of a vertex whose inputs lie one after the other.
pub fn vertex_bytes(inputs: &[VertexInput]) -> usize {
    inputs.iter().map(|input| 4 * input.components()).sum()
}

/// Returns one binding with the inputs of a vertex, and their places.
fn vertex_layout(
    inputs: &[VertexInput],
) -> Result<(Vec<vk::VertexInputBindingDescription>, Vec<vk::VertexInputAttributeDescription>), Error> {
    let mut offset = 0;
    let mut attributes = Vec::with_capacity(inputs.len());
    for input in inputs {
        attributes.push(
            vk::VertexInputAttributeDescription::default()
                .location(input.location)
                .format(vertex_format(&input.kind)?)
                .offset(offset),
        );
        offset += 4 * input.components() as u32;
    }
    Ok((vec![vk::VertexInputBindingDescription::default().stride(offset)], attributes))
}

/// Returns the depth and stencil tests. A test that is omitted passes and writes nothing.
fn depth_stencil(state: &State) -> Result<vk::PipelineDepthStencilStateCreateInfo<'static>, Error> {
    let mut info = vk::PipelineDepthStencilStateCreateInfo::default();
    if let Some(depth) = &state.depth {
        info = info.depth_test_enable(true).depth_write_enable(depth.write);
        info = info.depth_compare_op(comparison(&depth.compare)?);
    }
    if let Some(stencil) = &state.stencil {
        let face = vk::StencilOpState {
            fail_op: stencil_operation(&stencil.fail)?,
            pass_op: stencil_operation(&stencil.pass)?,
            depth_fail_op: vk::StencilOp::KEEP,
            compare_op: comparison(&stencil.compare)?,
            compare_mask: 0xff,
            write_mask: 0xff,
            reference: 0,
        };
        info = info.stencil_test_enable(true).front(face).back(face);
    }
    Ok(info)
}

fn blend(blend: Option<&Blend>) -> Result<vk::PipelineColorBlendAttachmentState, Error> {
    let state = vk::PipelineColorBlendAttachmentState::default().color_write_mask(vk::ColorComponentFlags::RGBA);
    let Some(blend) = blend else { return Ok(state) };
    let (source, destination) = (blend_factor(&blend.source)?, blend_factor(&blend.destination)?);
    let operation = blend_operation(&blend.operation)?;
    Ok(state
        .blend_enable(true)
        .src_color_blend_factor(source)
        .dst_color_blend_factor(destination)
        .color_blend_op(operation)
        .src_alpha_blend_factor(source)
        .dst_alpha_blend_factor(destination)
        .alpha_blend_op(operation))
}
