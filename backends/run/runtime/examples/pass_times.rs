//! Prints the milliseconds of each pass of a technique: the median of eleven frames after two warm-up frames. The scene is layers
//! over the whole frame, in an order that is not sorted by depth.
//!
//! ```text
//! cargo run -p fragbuf-runtime --example pass_times -- kplus_array wgsl 512 32 cpu
//! ```
#![allow(clippy::print_stdout, reason = "the times are its output")]

use fragbuf_codegen::Form;
use fragbuf_model::{Draft, SourceSpan, check};
use fragbuf_runtime::headless::{BLENDED, Headless, Offscreen};
use fragbuf_runtime::{Output, PoolSize, Renderer, Settings, Shaders, block_on};
use fragbuf_targets::{Request, generate, target};
use fragbuf_templates::Registry;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [key, language, size, layers, adapter] = arguments.as_slice() else {
        return Err("give a technique, a target, the frame's side, the number of layers and an adapter".into());
    };
    let (size, layers): (u32, u32) = (size.parse()?, layers.parse()?);
    let registry = Registry::builtin();
    let draft = Draft::from_technique(key, &SourceSpan::new("arguments", 1, 1));
    let variant = check(&draft, &registry).map_err(|diagnostics| diagnostics.to_string())?;
    let request =
        Request { targets: &[target(language).ok_or("no such target")?], form: Form::Program, prefix: "", group: 0 };
    let generation = generate(&variant, &request, &registry).map_err(|diagnostics| diagnostics.to_string())?;
    let shaders = Shaders::from_generation(&generation, language, 0)?;

    let headless = Headless::open(&adapter.parse()?, shaders.features())?;
    let Headless { device, queue, info, .. } = &headless;
    let settings = Settings { timestamps: true, ..Settings::new(BLENDED, size, size) };
    let mut renderer = block_on(device, Renderer::new(device, queue, &shaders, &settings))??;
    if renderer.symbol("fragments").is_some_and(|fragments| fragments > 0) {
        block_on(device, renderer.reserve(PoolSize::Fragments(size * size * layers)))??;
    }
    let screen = Offscreen::new(device, BLENDED, size, size)?;
    let vertices = sheets(device, queue, layers);
    let output = Output { view: screen.view(), load: wgpu::LoadOp::Clear(wgpu::Color::BLACK) };
    let mut frames: Vec<Vec<f64>> = Vec::new();
    let mut lost = 0;
    let mut names = Vec::new();
    for frame in 0..13 {
        renderer.render(&output, &mut |pass, _| {
            pass.set_vertex_buffer(0, vertices.slice(..));
            pass.draw(0..3 * layers, 0..1);
        })?;
        let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        let times = renderer.pass_times(&mut encoder).ok_or("the device has no timestamps")?;
        let counters = renderer.counters(&mut encoder).ok_or("the plan has no counters")?;
        queue.submit([encoder.finish()]);
        let times = times.wait(device)?;
        lost = counters.wait(device)?.lost();
        names = times.iter().map(|time| time.pass.clone()).collect();
        if frame >= 2 {
            frames.push(times.iter().map(|time| time.milliseconds).collect());
        }
    }
    println!("{key}, {language}, {size} x {size}, {layers} layers, on {}", info.name);
    for (pass, name) in names.iter().enumerate() {
        let mut times: Vec<f64> = frames.iter().filter_map(|times| times.get(pass)).copied().collect();
        times.sort_by(f64::total_cmp);
        println!("  {name:12} {:9.3} ms", times.get(times.len() / 2).unwrap_or(&0.0));
    }
    println!("  {} bytes, {lost} fragments lost", renderer.allocated_bytes());
    Ok(())
}

/// Creates a vertex buffer with one triangle per layer over the whole frame.
fn sheets(device: &wgpu::Device, queue: &wgpu::Queue, layers: u32) -> wgpu::Buffer {
    let mut bytes: Vec<u8> = Vec::new();
    for layer in 0..layers {
        // The golden ratio distributes the depths evenly.
        let depth = (0.618_034 * f64::from(layer)).fract() as f32;
        for [x, y] in [[-1.0, -1.0], [3.0, -1.0], [-1.0, 3.0]] {
            bytes
                .extend([x, y, depth, depth, 0.5, 1.0 - depth, 0.3].iter().flat_map(|value: &f32| value.to_le_bytes()));
        }
    }
    let usage = wgpu::BufferUsages::VERTEX | wgpu::BufferUsages::COPY_DST;
    let size = bytes.len() as u64;
    let descriptor = wgpu::BufferDescriptor { label: Some("sheets"), size, usage, mapped_at_creation: false };
    let buffer = device.create_buffer(&descriptor);
    queue.write_buffer(&buffer, 0, &bytes);
    buffer
}
