//! The devices of all tests, and functions to render a frame of quads and to read its results back.

use std::collections::BTreeMap;
use std::sync::{LazyLock, Mutex, MutexGuard, PoisonError, TryLockError};

use fragbuf_codegen::Form;
use fragbuf_model::{Draft, SourceSpan, Variant, check};
use fragbuf_runtime::headless::{BLENDED, Choice, Headless, Offscreen};
use fragbuf_runtime::{Counters, Error, Output, Pending, Renderer, Settings, Shaders, block_on};
use fragbuf_targets::{Request, generate, target};
use fragbuf_templates::Registry;

use crate::kept;
use crate::oracle::Words;
use crate::quads::{Quad, SIZE, vertices};
use crate::samples;

/// Returns a device on the CPU's adapter: it is the same on every machine, and runs fragments in submission order. There is a device per
/// core, so that as many tests run at once; most of their time is not the driver's.
pub fn device() -> MutexGuard<'static, Headless> {
    static DEVICES: LazyLock<Vec<LazyLock<Mutex<Headless>>>> = LazyLock::new(|| {
        let cores = std::thread::available_parallelism().map_or(1, usize::from);
        std::iter::repeat_with(|| LazyLock::new((|| open(&Choice::Cpu)) as fn() -> _)).take(cores).collect()
    });
    for device in DEVICES.iter() {
        match device.try_lock() {
            Ok(device) => return device,
            // A test that failed leaves its device usable.
            Err(TryLockError::Poisoned(poisoned)) => return poisoned.into_inner(),
            Err(TryLockError::WouldBlock) => {}
        }
    }
    DEVICES[0].lock().unwrap_or_else(PoisonError::into_inner)
}

/// Returns the adapter that the environment variable `FRAGBUF_TEST_DEVICE` names, as `--device` does, or the CPU's: for tests of what
/// holds on devices that run fragments concurrently, too.
pub fn chosen_device() -> MutexGuard<'static, Headless> {
    static DEVICE: LazyLock<Mutex<Headless>> =
        LazyLock::new(|| open(&std::env::var("FRAGBUF_TEST_DEVICE").map_or(Choice::Cpu, |name| name.parse().unwrap())));
    DEVICE.lock().unwrap_or_else(PoisonError::into_inner)
}

fn open(choice: &Choice) -> Mutex<Headless> {
    let opened = Headless::open(choice, wgpu::Features::PASSTHROUGH_SHADERS);
    Mutex::new(opened.unwrap_or_else(|error| panic!("these tests need a software driver: {error}")))
}

pub const FORMAT: wgpu::TextureFormat = BLENDED;

/// The opaque background of every image.
pub const BACKGROUND: [f64; 3] = [0.2, 0.4, 0.6];

/// Returns a technique with the settings `set`, each as in `--set name=value`.
pub fn technique(key: &str, set: &[(&str, &str)]) -> Variant {
    let span = SourceSpan::new(key, 1, 1);
    let mut draft = Draft::from_technique(key, &span);
    for (name, value) in set {
        draft.set(name, value, &span).unwrap();
    }
    check(&draft, &Registry::builtin()).unwrap_or_else(|diagnostics| panic!("{diagnostics}"))
}

/// Checks a description.
pub fn described(source: &str) -> Variant {
    let parsed = fragbuf_syntax::parse(source, "test.fragbuf");
    assert!(parsed.diagnostics.is_empty(), "{}", parsed.diagnostics);
    check(&parsed.draft.unwrap(), &Registry::builtin()).unwrap_or_else(|diagnostics| panic!("{diagnostics}"))
}

/// Generates the shaders of one target.
pub fn shaders(variant: &Variant, name: &str) -> Shaders {
    let request = Request { targets: &[target(name).unwrap()], form: Form::Program, prefix: "", group: 0 };
    let generation =
        generate(variant, &request, &Registry::builtin()).unwrap_or_else(|diagnostics| panic!("{diagnostics}"));
    Shaders::from_generation(&generation, name, 0).unwrap()
}

pub fn settings() -> Settings {
    Settings::new(FORMAT, SIZE, SIZE)
}

pub fn renderer(stage: &Headless, shaders: &Shaders, settings: &Settings) -> Result<Renderer, Error> {
    block_on(&stage.device, Renderer::new(&stage.device, &stage.queue, shaders, settings))?
}

/// The results of a frame.
pub struct FrameResult {
    /// Red, green, blue and alpha, row by row from the top.
    pub pixels: Vec<[f32; 4]>,
    pub kept: Vec<Vec<Words>>,
    pub counters: Counters,
}

/// Renders `quads` in their order and reads the results back.
pub fn render_frame(stage: &Headless, renderer: &mut Renderer, quads: &[Quad]) -> FrameResult {
    let Headless { device, queue, .. } = stage;
    let offscreen = Offscreen::new(device, FORMAT, SIZE, SIZE).unwrap();
    draw_over(stage, renderer, quads, &offscreen).unwrap();
    let counters = read_counters(stage, renderer);
    let pixels = offscreen.colors(device, queue).unwrap();
    FrameResult { pixels, kept: kept::kept(renderer, &read_buffers(stage, renderer), quads), counters }
}

pub fn read_counters(stage: &Headless, renderer: &Renderer) -> Counters {
    let mut encoder = stage.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    let counters = renderer.counters(&mut encoder).unwrap();
    stage.queue.submit([encoder.finish()]);
    counters.wait(&stage.device).unwrap()
}

/// Reads all words of all resources that are not empty, by name.
pub fn read_buffers(stage: &Headless, renderer: &Renderer) -> BTreeMap<String, Vec<u32>> {
    let mut encoder = stage.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    let names: Vec<String> = renderer.plan().resources.iter().map(|planned| planned.resource.name.clone()).collect();
    let reads: Vec<_> = names.iter().map(|name| (name.clone(), renderer.words(name, &mut encoder))).collect();
    stage.queue.submit([encoder.finish()]);
    let read = |(name, words): (String, Option<Pending<Vec<u32>>>)| match (words, renderer.texture(&name)) {
        (Some(words), _) => Some((name, words.wait(&stage.device).unwrap())),
        (None, Some(texture)) => Some((name, samples::read(stage, texture))),
        (None, None) => None,
    };
    reads.into_iter().filter_map(read).collect()
}

/// Creates a vertex buffer with these bytes, which may be none.
pub fn vertex_buffer(stage: &Headless, bytes: &[u8]) -> wgpu::Buffer {
    let buffer = stage.device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("vertices"),
        size: bytes.len().max(4) as u64,
        usage: wgpu::BufferUsages::VERTEX | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    });
    stage.queue.write_buffer(&buffer, 0, bytes);
    buffer
}

/// Renders `quads` in their order over the background.
pub fn draw_over(
    stage: &Headless,
    renderer: &mut Renderer,
    quads: &[Quad],
    offscreen: &Offscreen,
) -> Result<(), Error> {
    let bytes = vertices(quads, renderer.vertex_inputs());
    draw_bytes(stage, renderer, (&bytes, 6 * quads.len() as u32), offscreen)
}

/// Renders so many vertices over the background.
pub fn draw_bytes(
    stage: &Headless,
    renderer: &mut Renderer,
    (bytes, count): (&[u8], u32),
    offscreen: &Offscreen,
) -> Result<(), Error> {
    let buffer = vertex_buffer(stage, bytes);
    let [r, g, b] = BACKGROUND;
    let output = Output { view: offscreen.view(), load: wgpu::LoadOp::Clear(wgpu::Color { r, g, b, a: 1.0 }) };
    renderer.render(&output, &mut |pass, _| {
        pass.set_vertex_buffer(0, buffer.slice(..));
        pass.draw(0..count, 0..1);
    })?;
    Ok(())
}
