//! A host that owns its device, its encoder and the order of its passes. It draws a chequered floor, records fragbuf's translucent
//! sheets over it, and draws a white border on top. The image is `embed.ppm`.
//!
//! ```text
//! cargo run -p fragbuf-runtime --example embed
//! ```
//!
//! The calls of fragbuf are in `main`, in about twenty lines; the other functions belong to the host.

use fragbuf_codegen::Form;
use fragbuf_model::{Draft, SourceSpan, check};
use fragbuf_runtime::headless::{BLENDED, Choice, Headless, Offscreen};
use fragbuf_runtime::{Call, Output, Recorded, Renderer, Settings, Shaders, block_on};
use fragbuf_targets::{Request, generate, target};
use fragbuf_templates::Registry;

const SIZE: u32 = 512;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let Headless { device, queue, .. } = Headless::open(&Choice::Auto, wgpu::Features::empty())?;
    let screen = Offscreen::new(&device, BLENDED, SIZE, SIZE)?;
    let floor = host_pipeline(&device, "floor");
    let border = host_pipeline(&device, "border");
    let sheets = host_sheets(&device, &queue);

    // Once: compile a technique to a plan and shaders, and create a renderer on the host's device.
    let registry = Registry::builtin();
    let variant = check(&Draft::from_technique("ab_sb", &SourceSpan::new("embed", 1, 1)), &registry)
        .map_err(|e| e.to_string())?;
    let request = Request { targets: &[target("wgsl").ok_or("wgsl")?], form: Form::Program, prefix: "", group: 0 };
    let generation = generate(&variant, &request, &registry).map_err(|diagnostics| diagnostics.to_string())?;
    let shaders = Shaders::from_generation(&generation, "wgsl", 0)?;
    let settings = Settings::new(BLENDED, SIZE, SIZE);
    let mut renderer = block_on(&device, Renderer::new(&device, &queue, &shaders, &settings))??;

    // Each frame: record the host's passes and fragbuf's into the host's encoder, in the host's order.
    let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    host_pass(&mut encoder, &screen, &floor, wgpu::LoadOp::Clear(wgpu::Color::BLACK));
    let mut frame = renderer.begin()?;
    let output = Output { view: screen.view(), load: wgpu::LoadOp::Load };
    let mut draw = |pass: &mut wgpu::RenderPass<'_>, _: &Call<'_>| {
        pass.set_vertex_buffer(0, sheets.slice(..));
        pass.draw(0..9, 0..1);
    };
    while let Recorded::Suspended(suspended) = frame.record(&renderer, &mut encoder, &output, &mut draw)? {
        let next = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        queue.submit([std::mem::replace(&mut encoder, next).finish()]);
        // A host that must not block polls `suspended.is_ready()`, or awaits.
        frame = block_on(&device, suspended.resume(&mut renderer))??;
    }
    host_pass(&mut encoder, &screen, &border, wgpu::LoadOp::Load);
    queue.submit([encoder.finish()]);

    host_save(&screen.colors(&device, &queue)?)?;
    Ok(())
}

/// Records a pass of the host over the whole screen.
fn host_pass(
    encoder: &mut wgpu::CommandEncoder,
    screen: &Offscreen,
    pipeline: &wgpu::RenderPipeline,
    load: wgpu::LoadOp<wgpu::Color>,
) {
    let ops = wgpu::Operations { load, store: wgpu::StoreOp::Store };
    let attachment =
        wgpu::RenderPassColorAttachment { view: screen.view(), depth_slice: None, resolve_target: None, ops };
    let descriptor =
        wgpu::RenderPassDescriptor { color_attachments: &[Some(attachment)], ..wgpu::RenderPassDescriptor::default() };
    let mut pass = encoder.begin_render_pass(&descriptor);
    pass.set_pipeline(pipeline);
    pass.draw(0..3, 0..1);
}

/// Creates a pipeline with a fragment shader of the host.
fn host_pipeline(device: &wgpu::Device, entry_point: &str) -> wgpu::RenderPipeline {
    let source = wgpu::ShaderSource::Wgsl(HOST_SHADERS.into());
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor { label: None, source });
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some(entry_point),
        layout: None,
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some("screen"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            buffers: &[],
        },
        primitive: wgpu::PrimitiveState::default(),
        depth_stencil: None,
        multisample: wgpu::MultisampleState::default(),
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: Some(entry_point),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            targets: &[Some(BLENDED.into())],
        }),
        multiview_mask: None,
        cache: None,
    })
}

const HOST_SHADERS: &str = "
@vertex fn screen(@builtin(vertex_index) index: u32) -> @builtin(position) vec4<f32> {
    return vec4<f32>(4.0 * vec2<f32>(vec2<u32>(index & 1u, index >> 1u)) - 1.0, 0.0, 1.0);
}
@fragment fn floor(@builtin(position) at: vec4<f32>) -> @location(0) vec4<f32> {
    let tile = vec2<u32>(at.xy) / 64u;
    return vec4<f32>(vec3<f32>(select(0.25, 0.6, (tile.x + tile.y) % 2u == 0u)), 1.0);
}
@fragment fn border(@builtin(position) at: vec4<f32>) -> @location(0) vec4<f32> {
    if all(abs(at.xy - 256.0) < vec2<f32>(240.0)) { discard; }
    return vec4<f32>(1.0);
}";

/// Creates a vertex buffer with three intersecting triangles: position and colour.
fn host_sheets(device: &wgpu::Device, queue: &wgpu::Queue) -> wgpu::Buffer {
    let colors = [[0.9, 0.1, 0.1, 0.5], [0.1, 0.8, 0.2, 0.5], [0.1, 0.2, 0.9, 0.5]];
    let mut bytes: Vec<u8> = Vec::new();
    for (sheet, color) in colors.iter().enumerate() {
        let angle = |corner: usize| (sheet as f32 + 3.0 * corner as f32) * std::f32::consts::TAU / 9.0;
        for (corner, depth) in [0.2, 0.5, 0.8].into_iter().enumerate() {
            let position = [0.85 * angle(corner).cos(), 0.85 * angle(corner).sin(), depth];
            bytes.extend(position.iter().chain(color).flat_map(|value: &f32| value.to_le_bytes()));
        }
    }
    let usage = wgpu::BufferUsages::VERTEX | wgpu::BufferUsages::COPY_DST;
    let size = bytes.len() as u64;
    let descriptor = wgpu::BufferDescriptor { label: Some("sheets"), size, usage, mapped_at_creation: false };
    let buffer = device.create_buffer(&descriptor);
    queue.write_buffer(&buffer, 0, &bytes);
    buffer
}

/// Writes the image as a portable pixmap, sRGB-encoded.
fn host_save(colors: &[[f32; 4]]) -> std::io::Result<()> {
    let mut file = format!("P6 {SIZE} {SIZE} 255\n").into_bytes();
    let encoded =
        |linear: f32| if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 };
    file.extend(colors.iter().flat_map(|[r, g, b, _]| [r, g, b]).map(|linear| (255.0 * encoded(*linear) + 0.5) as u8));
    std::fs::write("embed.ppm", file)
}
