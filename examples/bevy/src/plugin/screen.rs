//! Reads the depth of a camera, and writes its colours.
//!
//! Input: the depth texture of a camera, with any number of samples and reversed depth. Output: a depth per pixel that grows with distance,
//! as the passes read it, and the resolved image composited over the camera's colours.

use std::collections::BTreeMap;

/// Copies depth. Of several samples the farthest is kept, so that what is visible at a part of a pixel is stored.
const DEPTH: &str = "
@group(0) @binding(0) var depth: TEXTURE;

@vertex
fn fullscreen(@builtin(vertex_index) index: u32) -> @builtin(position) vec4<f32> {
    return vec4<f32>(f32(index / 2u) * 4.0 - 1.0, f32(index % 2u) * 4.0 - 1.0, 0.0, 1.0);
}

@fragment
fn farthest(@builtin(position) position: vec4<f32>) -> @builtin(frag_depth) f32 {
    var least = 1.0;
    for (var index = 0; index < SAMPLES; index++) {
        least = min(least, textureLoad(depth, vec2<i32>(position.xy), index));
    }
    return 1.0 - least;
}
";

/// Writes the texels of an image.
const COMPOSITE: &str = "
@group(0) @binding(0) var image: texture_2d<f32>;

@vertex
fn fullscreen(@builtin(vertex_index) index: u32) -> @builtin(position) vec4<f32> {
    return vec4<f32>(f32(index / 2u) * 4.0 - 1.0, f32(index % 2u) * 4.0 - 1.0, 0.0, 1.0);
}

@fragment
fn composite(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    return textureLoad(image, vec2<i32>(position.xy), 0);
}
";

/// The pipelines, which are created when they are needed first.
#[derive(Default)]
pub struct Screen {
    /// By the samples of the depth.
    depth: BTreeMap<u32, wgpu::RenderPipeline>,
    /// By the format and the samples of the colours.
    composite: BTreeMap<(String, u32), wgpu::RenderPipeline>,
}

impl Screen {
    /// Records the copy of a camera's depth.
    pub fn copy_depth(
        &mut self,
        device: &wgpu::Device,
        encoder: &mut wgpu::CommandEncoder,
        (depth, samples): (&wgpu::TextureView, u32),
        opaque: &wgpu::Texture,
    ) {
        let pipeline = self.depth.entry(samples).or_insert_with(|| depth_pipeline(device, samples, opaque.format()));
        let view = opaque.create_view(&wgpu::TextureViewDescriptor::default());
        let ops = wgpu::Operations { load: wgpu::LoadOp::Clear(1.0), store: wgpu::StoreOp::Store };
        let attachment =
            wgpu::RenderPassDepthStencilAttachment { view: &view, depth_ops: Some(ops), stencil_ops: None };
        let descriptor = wgpu::RenderPassDescriptor {
            label: Some("depth of opaque surfaces"),
            depth_stencil_attachment: Some(attachment),
            ..Default::default()
        };
        fullscreen(device, encoder.begin_render_pass(&descriptor), pipeline, depth);
    }

    /// Records the composition of an image, whose colours are multiplied by alpha, over the colours of a camera.
    pub fn composite(
        &mut self,
        device: &wgpu::Device,
        encoder: &mut wgpu::CommandEncoder,
        image: &wgpu::Texture,
        (target, format, samples): (wgpu::RenderPassColorAttachment<'_>, wgpu::TextureFormat, u32),
    ) {
        let key = (format!("{format:?}"), samples);
        let pipeline = self.composite.entry(key).or_insert_with(|| composite_pipeline(device, format, samples));
        let descriptor = wgpu::RenderPassDescriptor {
            label: Some("fragments over the camera"),
            color_attachments: &[Some(target)],
            ..Default::default()
        };
        let view = image.create_view(&wgpu::TextureViewDescriptor::default());
        fullscreen(device, encoder.begin_render_pass(&descriptor), pipeline, &view);
    }
}

/// Draws a triangle that covers the frame, with one texture.
fn fullscreen(
    device: &wgpu::Device,
    mut render: wgpu::RenderPass<'_>,
    pipeline: &wgpu::RenderPipeline,
    texture: &wgpu::TextureView,
) {
    let entries = [wgpu::BindGroupEntry { binding: 0, resource: wgpu::BindingResource::TextureView(texture) }];
    let layout = pipeline.get_bind_group_layout(0);
    let group =
        device.create_bind_group(&wgpu::BindGroupDescriptor { label: None, layout: &layout, entries: &entries });
    render.set_pipeline(pipeline);
    render.set_bind_group(0, &group, &[]);
    render.draw(0..3, 0..1);
}

fn depth_pipeline(device: &wgpu::Device, samples: u32, format: wgpu::TextureFormat) -> wgpu::RenderPipeline {
    let texture = if samples > 1 { "texture_depth_multisampled_2d" } else { "texture_depth_2d" };
    let text = DEPTH.replace("TEXTURE", texture).replace("SAMPLES", &samples.to_string());
    let depth = wgpu::DepthStencilState {
        format,
        depth_write_enabled: Some(true),
        depth_compare: Some(wgpu::CompareFunction::Always),
        stencil: wgpu::StencilState::default(),
        bias: wgpu::DepthBiasState::default(),
    };
    pipeline(device, (&text, "farthest"), (&[], Some(depth)), 1)
}

fn composite_pipeline(device: &wgpu::Device, format: wgpu::TextureFormat, samples: u32) -> wgpu::RenderPipeline {
    let blend = Some(wgpu::BlendState::PREMULTIPLIED_ALPHA_BLENDING);
    let target = wgpu::ColorTargetState { format, blend, write_mask: wgpu::ColorWrites::ALL };
    pipeline(device, (COMPOSITE, "composite"), (&[Some(target)], None), samples)
}

fn pipeline(
    device: &wgpu::Device,
    (text, fragment): (&str, &str),
    (targets, depth_stencil): (&[Option<wgpu::ColorTargetState>], Option<wgpu::DepthStencilState>),
    count: u32,
) -> wgpu::RenderPipeline {
    let source = wgpu::ShaderSource::Wgsl(text.into());
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor { label: Some(fragment), source });
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some(fragment),
        layout: None,
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some("fullscreen"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            buffers: &[],
        },
        primitive: wgpu::PrimitiveState::default(),
        depth_stencil,
        multisample: wgpu::MultisampleState { count, ..Default::default() },
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: Some(fragment),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            targets,
        }),
        multiview_mask: None,
        cache: None,
    })
}
