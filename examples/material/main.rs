//! Draws transparent objects with a material shader of the host, whose last statement calls `store_fragment`.
//!
//! `cargo run --example material -- ab_sb material.png`: technique and image. The guide's chapter `material` explains it.

pub mod scene;

use std::cell::RefCell;
use std::error::Error;
use std::io::Write as _;
use std::process::ExitCode;

use fragbuf::{Form, Registry, Request, generate, parse, target};
use fragbuf_runtime::headless::{BLENDED, Choice, Offscreen, adapter, open_device};
use fragbuf_runtime::{
    Call, GeometryPass, Output, PoolSize, Recorded, Renderer, Settings, Shaders, Sizing, Value, block_on, wgpu,
};
use wgpu::util::{BufferInitDescriptor, DeviceExt};

/// The bind group of the fragment buffer; those of the host are in group 0.
const GROUP: u32 = 1;
/// The shader of the host.
const MATERIAL: &str = include_str!("material.wgsl");
/// The description keeps only fragments beyond this depth.
pub const NEAR: f32 = 0.78;
/// The colour behind the objects.
pub const BACKGROUND: wgpu::Color = wgpu::Color { r: 0.8, g: 0.8, b: 0.75, a: 1.0 };

/// The image to render, and the order in which the objects are drawn.
pub(crate) struct Picture<'a> {
    pub technique: &'a str,
    pub device: Choice,
    pub size: (u32, u32),
    pub sizing: Sizing,
    pub order: [usize; 3],
}

fn main() -> ExitCode {
    match run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            // `Result` as the type of `main` prints the `Debug` form. There is no other stream to report a failure of this one on.
            let _ = writeln!(std::io::stderr(), "error: {error}");
            ExitCode::FAILURE
        }
    }
}

fn run() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let technique = arguments.next().unwrap_or_else(|| "kplus_array".to_owned());
    let path = arguments.next().unwrap_or_else(|| "material.png".to_owned());
    let (device, size, sizing) = (Choice::Auto, (640, 480), Sizing::Auto);
    let colors = render(&Picture { technique: &technique, device, size, sizing, order: [0, 1, 2] })?;
    save(&path, size, &colors)
}

/// Renders an image: red, green, blue and alpha, linear, row by row from the top.
pub(crate) fn render(picture: &Picture<'_>) -> Result<Vec<[f32; 4]>, Box<dyn Error>> {
    let shaders = shaders(picture.technique)?;
    let (device, queue) = open(&picture.device, &shaders)?;
    let (width, height) = picture.size;
    let settings = Settings { sizing: picture.sizing, ..Settings::new(BLENDED, width, height) };
    let mut renderer = block_on(&device, Renderer::new(&device, &queue, &shaders, &settings))??;
    renderer.set_uniform("near", Value::F32(NEAR))?;
    let host = Host::new(device, queue, &renderer, picture);
    let offscreen = Offscreen::new(&host.device, BLENDED, width, height)?;
    let output = Output { view: offscreen.view(), load: wgpu::LoadOp::Clear(BACKGROUND) };
    draw_frame(&host, &mut renderer, &output)?;
    Ok(offscreen.colors(&host.device, &host.queue)?)
}

/// Generates the passes of a technique: the geometry passes as functions, the others with entry points.
fn shaders(technique: &str) -> Result<Shaders, Box<dyn Error>> {
    let text = format!("buffer Glass from {technique} {{ uniform {{ near: f32 }} where |f, u| f.depth > u.near; }}");
    let registry = Registry::builtin();
    let variant = parse(&text, "glass.fragbuf").check(&registry).map_err(|errors| errors.to_string())?;
    let request = Request { targets: &[target("wgsl").ok_or("wgsl")?], form: Form::Module, prefix: "", group: GROUP };
    let generation = generate(&variant, &request, &registry).map_err(|errors| errors.to_string())?;
    Ok(Shaders::from_generation(&generation, "wgsl", GROUP)?)
}

/// Opens a device with what the shaders need.
fn open(choice: &Choice, shaders: &Shaders) -> Result<(wgpu::Device, wgpu::Queue), Box<dyn Error>> {
    let descriptor = wgpu::DeviceDescriptor {
        required_features: shaders.features(),
        required_limits: shaders.limits(),
        ..Default::default()
    };
    let (device, queue, _) = open_device(&adapter(choice)?, &descriptor)?;
    Ok((device, queue))
}

/// The host's objects on the device.
struct Host {
    device: wgpu::Device,
    queue: wgpu::Queue,
    /// A pipeline for each geometry pass, by its name.
    pipelines: Vec<(String, wgpu::RenderPipeline)>,
    scene: wgpu::BindGroup,
    vertices: wgpu::Buffer,
    count: u32,
}

impl Host {
    fn new(device: wgpu::Device, queue: wgpu::Queue, renderer: &Renderer, picture: &Picture<'_>) -> Self {
        let uniform = wgpu::BufferBindingType::Uniform;
        let entry = wgpu::BindGroupLayoutEntry {
            binding: 0,
            visibility: wgpu::ShaderStages::VERTEX_FRAGMENT,
            ty: wgpu::BindingType::Buffer { ty: uniform, has_dynamic_offset: false, min_binding_size: None },
            count: None,
        };
        let layout = wgpu::BindGroupLayoutDescriptor { label: Some("scene"), entries: &[entry] };
        let layout = device.create_bind_group_layout(&layout);
        let matrix = scene::view_projection(picture.size).to_cols_array();
        let block = buffer(&device, wgpu::BufferUsages::UNIFORM, &[&matrix[..], &scene::LIGHT].concat());
        let entries = [wgpu::BindGroupEntry { binding: 0, resource: block.as_entire_binding() }];
        let scene = wgpu::BindGroupDescriptor { label: Some("scene"), layout: &layout, entries: &entries };
        let scene = device.create_bind_group(&scene);
        let objects = scene::objects();
        let vertices = picture.order.map(|number| &objects[number][..]).concat();
        let count = vertices.len() as u32;
        let vertices = buffer(&device, wgpu::BufferUsages::VERTEX, vertices.as_flattened());
        let pipelines = renderer.geometry_passes();
        let pipelines = pipelines.map(|pass| (pass.name.clone(), pipeline(&device, renderer, &layout, pass))).collect();
        Host { device, queue, pipelines, scene, vertices, count }
    }
}

/// Creates the pipeline that draws the material in a geometry pass.
fn pipeline(
    device: &wgpu::Device,
    renderer: &Renderer,
    scene: &wgpu::BindGroupLayout,
    pass: &GeometryPass,
) -> wgpu::RenderPipeline {
    // The material calls `store_fragment`; another pass has another function with the same parameters.
    let material = MATERIAL.replace("store_fragment", &pass.function);
    let source = wgpu::ShaderSource::Wgsl(format!("{}\n{material}", pass.source).into());
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor { label: Some(&pass.name), source });
    let groups = [Some(scene), renderer.bind_group_layout(&pass.name)];
    let layout = wgpu::PipelineLayoutDescriptor { label: None, bind_group_layouts: &groups, immediate_size: 0 };
    let layout = device.create_pipeline_layout(&layout);
    let vertices = wgpu::VertexBufferLayout {
        array_stride: size_of::<scene::Vertex>() as u64,
        step_mode: wgpu::VertexStepMode::Vertex,
        attributes: &wgpu::vertex_attr_array![0 => Float32x3, 1 => Float32x3, 2 => Float32x4],
    };
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some(&pass.name),
        layout: Some(&layout),
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some("material_vertex"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            buffers: &[Some(vertices)],
        },
        primitive: wgpu::PrimitiveState::default(),
        depth_stencil: pass.depth_stencil.clone(),
        multisample: pass.multisample,
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: Some("material_fragment"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            targets: &pass.targets,
        }),
        multiview_mask: None,
        cache: None,
    })
}

/// Renders a frame, and again with a larger pool as long as fragments do not fit.
fn draw_frame(host: &Host, renderer: &mut Renderer, output: &Output<'_>) -> Result<(), Box<dyn Error>> {
    let (device, queue) = (&host.device, &host.queue);
    // A pass without a pipeline.
    let unknown = RefCell::new(None);
    let mut draw = |pass: &mut wgpu::RenderPass<'_>, call: &Call<'_>| {
        let Some((_, pipeline)) = host.pipelines.iter().find(|(name, _)| *name == call.pass.name) else {
            unknown.replace(Some(call.pass.name.clone()));
            return;
        };
        pass.set_pipeline(pipeline);
        pass.set_bind_group(0, &host.scene, &[]);
        pass.set_vertex_buffer(0, host.vertices.slice(..));
        pass.draw(0..host.count, 0..1);
    };
    loop {
        let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        let mut frame = renderer.begin()?;
        while let Recorded::Suspended(suspended) = frame.record(renderer, &mut encoder, output, &mut draw)? {
            let next = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
            queue.submit([std::mem::replace(&mut encoder, next).finish()]);
            frame = block_on(device, suspended.resume(renderer))??;
        }
        if let Some(name) = unknown.take() {
            return Err(format!("no pipeline for the pass `{name}`").into());
        }
        let counters = renderer.counters(&mut encoder).ok_or("the technique counts no losses")?;
        queue.submit([encoder.finish()]);
        let counters = counters.wait(device)?;
        let lost = counters.lost();
        match counters.get("pool_exhausted") {
            0 if lost == 0 => return Ok(()),
            0 => return Err(format!("{lost} fragments are lost").into()),
            short => {
                let fragments = u32::try_from(renderer.pool_size_after(short))?;
                block_on(device, renderer.reserve(PoolSize::Fragments(fragments)))??;
            }
        }
    }
}

/// Creates a buffer with these floats.
fn buffer(device: &wgpu::Device, usage: wgpu::BufferUsages, floats: &[f32]) -> wgpu::Buffer {
    let contents: Vec<u8> = floats.iter().flat_map(|float| float.to_le_bytes()).collect();
    device.create_buffer_init(&BufferInitDescriptor { label: None, contents: &contents, usage })
}

/// Writes a PNG with the image in sRGB.
fn save(path: &str, (width, height): (u32, u32), colors: &[[f32; 4]]) -> Result<(), Box<dyn Error>> {
    let encoded = |c: f32| if c <= 0.003_130_8 { 12.92 * c } else { 1.055 * c.powf(1.0 / 2.4) - 0.055 };
    let bytes = colors.iter().flat_map(|c| &c[..3]).map(|c| (255.0 * encoded(*c)).round() as u8).collect::<Vec<_>>();
    let mut encoder = png::Encoder::new(std::io::BufWriter::new(std::fs::File::create(path)?), width, height);
    encoder.set_color(png::ColorType::Rgb);
    encoder.write_header()?.write_image_data(&bytes)?;
    Ok(())
}
