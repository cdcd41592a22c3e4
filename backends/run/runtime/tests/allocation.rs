//! Predicted k (K15 §4.2): the histogram is that of the scene's fragments, k is the one that trying every k gives, the image is that of
//! the k nearest, and the buffers stay within the budget. On the driver and on the CPU device.

use std::sync::Arc;

use fragbuf_cpu::{Code, Device, Mesh};
use fragbuf_model::Variant;
use fragbuf_runtime::headless::{Headless, Offscreen};
use fragbuf_runtime::{Error, Output, PoolSize, Renderer, Settings, Sizing, block_on};
use fragbuf_templates::Registry;

use crate::drivers::draw;
use crate::drivers::scene::{Quad, first_difference, image, vertices};
use crate::order::Numbers;
use crate::stage::{BACKGROUND, FORMAT, device, renderer, shaders, technique, vertex_buffer};

pub const SIDE: u32 = 128;
/// The budget of the descriptions: 1 MiB.
pub const BUDGET: u64 = 1 << 20;
/// Storages of k slots per pixel: technique, sync, and the words per pixel beside the entries. One counts the fragments for the histogram.
const SLOTS: [(&str, &str, u64); 4] = [
    ("kplus_array", "spin_lock", 3),
    ("mdt32_coplanar", "slot_counter", 1),
    ("kb_ps", "spin_lock", 2),
    ("kb_multi", "none", 1),
];

/// Returns quads of different depths: ten of them share one corner of the frame.
pub fn scene(seed: u64) -> Vec<Quad> {
    let mut numbers = Numbers::seeded(seed);
    let quad = |id: u32| Quad {
        x: [0, 1 + numbers.below(SIDE)],
        y: [0, 1 + numbers.below(SIDE)],
        depth: (1 + id * 7 % 10) as f32 / 16.0,
        color: std::array::from_fn(|_| numbers.below(256) as u8),
        id,
    };
    (0..10).map(quad).collect()
}

/// Returns the number of fragments of each pixel.
pub fn fragments(quads: &[Quad]) -> Vec<u32> {
    let covers =
        |quad: &Quad, x: u32, y: u32| (quad.x[0]..quad.x[1]).contains(&x) && (quad.y[0]..quad.y[1]).contains(&y);
    (0..SIDE * SIDE)
        .map(|pixel| quads.iter().filter(|quad| covers(quad, pixel % SIDE, pixel / SIDE)).count() as u32)
        .collect()
}

/// Returns the least k that keeps `percent` of the fragments, and the greatest within the budget if pixels have these constants.
pub fn expected_k(counts: &[u32], percent: u64, most: u32, bytes: impl Fn(u32, u64) -> u64) -> u32 {
    let kept = |k: u32| counts.iter().map(|count| u64::from(*count.min(&k))).sum::<u64>();
    let all = kept(u32::MAX);
    let fitting: Vec<u32> = (1..=most).filter(|k| bytes(*k, kept(*k)) <= BUDGET).collect();
    let goal = fitting.iter().copied().find(|k| kept(*k) * 100 >= all * percent);
    goal.unwrap_or(*fitting.last().unwrap())
}

fn histogram(counts: &[u32]) -> Vec<u32> {
    let mut bins = vec![0; 1025];
    counts.iter().filter(|count| **count > 0).for_each(|count| bins[*count as usize - 1] += 1);
    bins
}

fn words(stage: &Headless, renderer: &Renderer, name: &str) -> Vec<u32> {
    let mut encoder = stage.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    let words = renderer.words(name, &mut encoder).unwrap();
    stage.queue.submit([encoder.finish()]);
    words.wait(&stage.device).unwrap()
}

/// Draws two scenes on both devices, and compares k, histogram, image and bytes.
fn check(key: &str, variant: &Variant, percent: u64, most: u32, bytes: impl Fn(u32, u64) -> u64) {
    let stage = device();
    let settings = Settings::new(FORMAT, SIDE, SIDE);
    let mut renderer = renderer(&stage, &shaders(variant, "wgsl"), &settings).unwrap();
    let code = Arc::new(Code::of(variant, &Registry::builtin()).unwrap_or_else(|error| panic!("{key}: {error}")));
    let mut cpu = Device::new(code, fragbuf_cpu::Settings::new(SIDE, SIDE)).unwrap();
    for seed in [1, 2] {
        let quads = scene(seed);
        let counts = fragments(&quads);
        let k = expected_k(&counts, percent, most, &bytes);
        let seen = draw(&stage, &mut renderer, &quads, [SIDE; 2]).unwrap();
        assert_eq!(words(&stage, &renderer, "histogram"), histogram(&counts), "{key}");
        assert_eq!(renderer.k(), Some(k), "{key}, {percent} %");
        assert!(renderer.allocated_bytes() <= BUDGET, "{key}: {} bytes", renderer.allocated_bytes());
        let expected = image(&quads, [SIDE, SIDE], Some(k), BACKGROUND);
        if let Some(difference) = first_difference(&seen, &expected) {
            panic!("{key}, {percent} %, k = {k}: {difference}");
        }
        let inputs: Vec<&str> = renderer.vertex_inputs().inputs.iter().map(|input| input.name.as_str()).collect();
        let bytes = vertices(&quads, [SIDE, SIDE], &inputs);
        let vertices: Vec<u32> =
            bytes.chunks_exact(4).map(|word| u32::from_le_bytes(word.try_into().unwrap())).collect();
        let indices: Vec<u32> = (0..6 * quads.len() as u32).collect();
        cpu.render(&Mesh { vertices: &vertices, indices: &indices }, &|_| {}).unwrap();
        assert_eq!((cpu.symbol("k"), cpu.words("histogram")), (Some(k.into()), Some(histogram(&counts))), "{key}");
    }
}

/// The words of the resources that do not follow k: the histogram, and the counters.
pub fn constant(variant: &Variant) -> u64 {
    let names = ["histogram", "shares", "counters", "changed"];
    let plan = shaders(variant, "wgsl").plan;
    let fixed = plan.resources.iter().filter(|planned| names.contains(&planned.resource.name.as_str()));
    fixed.map(|planned| 4 * plan.symbols.evaluate(&planned.words, &|_| None).unwrap()).sum()
}

#[test]
fn slots_per_pixel_follow_the_budget_and_the_hit_ratio() {
    for (key, sync, beside) in SLOTS {
        for percent in [100, 80, 30] {
            let percent_text = percent.to_string();
            let set = [
                ("k", "16"),
                ("sync", sync),
                ("allocation", "predicted"),
                ("allocation.budget", "1"),
                ("allocation.hit_ratio", percent_text.as_str()),
            ];
            let variant = technique(key, &set);
            let constant = constant(&variant);
            let pixels = u64::from(SIDE * SIDE);
            check(key, &variant, percent, 16, |k, _| pixels * 4 * (2 * u64::from(k) + beside) + constant);
        }
    }
}

#[test]
fn exact_regions_follow_the_budget_and_the_hit_ratio() {
    for percent in [100, 80, 30] {
        let percent_text = percent.to_string();
        let set = [
            ("k", "16"),
            ("allocation", "predicted_exact"),
            ("allocation.budget", "1"),
            ("allocation.hit_ratio", percent_text.as_str()),
        ];
        let variant = technique("kplus_ab_sb", &set);
        let constant = constant(&variant);
        let pixels = u64::from(SIDE * SIDE);
        // One more offset, and a sum per block of 1024 pixels.
        check("kplus_ab_sb", &variant, percent, 16, |_, kept| {
            8 * kept + 4 * (3 * pixels + 1 + pixels / 1024) + constant
        });
    }
}

#[test]
fn a_budget_below_one_fragment_per_pixel_is_an_error_with_its_numbers() {
    let stage = device();
    let variant = technique("kplus_array", &[("k", "8"), ("allocation", "predicted"), ("allocation.budget", "1")]);
    let settings = Settings::new(FORMAT, 512, 512);
    let mut renderer = renderer(&stage, &shaders(&variant, "wgsl"), &settings).unwrap();
    let Err(error) = draw_any(&stage, &mut renderer) else { panic!("5 words per pixel fit into 1 MiB") };
    let needed = 512 * 512 * 4 * 5 + constant(&variant);
    assert!(matches!(error, Error::Host { .. }), "{error}");
    assert!(
        error.to_string().contains(&format!("needs {needed} bytes, and the budget of `allocation` is {BUDGET}")),
        "{error}"
    );
}

/// Draws nothing in a frame of 512 × 512 pixels.
fn draw_any(stage: &Headless, renderer: &mut Renderer) -> Result<(), Error> {
    let offscreen = Offscreen::new(&stage.device, FORMAT, 512, 512)?;
    let output = Output { view: offscreen.view(), load: wgpu::LoadOp::Clear(wgpu::Color::BLACK) };
    renderer.render(&output, &mut |_, _| {})?;
    Ok(())
}

/// Without readbacks no host step runs: k is that of the description.
#[test]
fn reserved_memory_keeps_the_k_of_the_description() {
    let stage = device();
    let variant = technique("kplus_array", &[("k", "4"), ("allocation", "predicted"), ("allocation.hit_ratio", "30")]);
    let settings = Settings { sizing: Sizing::Reserve(PoolSize::Fragments(1)), ..Settings::new(FORMAT, SIDE, SIDE) };
    let mut reserved = renderer(&stage, &shaders(&variant, "wgsl"), &settings).unwrap();
    let quads = scene(3);
    let expected = image(&quads, [SIDE, SIDE], Some(4), BACKGROUND);
    assert_eq!(first_difference(&draw(&stage, &mut reserved, &quads, [SIDE; 2]).unwrap(), &expected), None);
    // The same after frames whose k a host step has set.
    let mut later = renderer(&stage, &shaders(&variant, "wgsl"), &Settings::new(FORMAT, SIDE, SIDE)).unwrap();
    draw(&stage, &mut later, &quads, [SIDE; 2]).unwrap();
    assert!(later.k() < Some(4));
    block_on(&stage.device, later.reserve(PoolSize::Fragments(1))).unwrap().unwrap();
    assert_eq!(later.k(), Some(4));
    assert_eq!(first_difference(&draw(&stage, &mut later, &quads, [SIDE; 2]).unwrap(), &expected), None);
}

/// K15 §4.3: a Z-buffer, a k-buffer and an A-buffer. Memory is that of the kept fragments.
#[test]
fn one_description_is_three_buffers() {
    let stage = device();
    let quads = scene(4);
    let counts = fragments(&quads);
    let deepest = *counts.iter().max().unwrap();
    for keep in [1, 4, 64] {
        let keep_text = keep.to_string();
        let variant = technique("unified", &[("k", keep_text.as_str())]);
        let settings = Settings::new(FORMAT, SIDE, SIDE);
        let mut renderer = renderer(&stage, &shaders(&variant, "wgsl"), &settings).unwrap();
        let seen = draw(&stage, &mut renderer, &quads, [SIDE; 2]).unwrap();
        assert_eq!(renderer.k(), Some(keep.min(deepest)));
        let kept: u32 = counts.iter().map(|count| count.min(&keep)).sum();
        assert_eq!(renderer.symbol("kept"), Some(kept.into()));
        let nearest = (keep < deepest).then_some(keep);
        assert_eq!(first_difference(&seen, &image(&quads, [SIDE, SIDE], nearest, BACKGROUND)), None, "k = {keep}");
    }
}

/// The k of a small frame would exceed the budget in a larger one.
#[test]
fn a_resized_frame_stays_within_the_budget() {
    let stage = device();
    let set = [("k", "64"), ("allocation", "predicted"), ("allocation.budget", "1")];
    let variant = technique("kplus_array", &set);
    let mut renderer = renderer(&stage, &shaders(&variant, "wgsl"), &Settings::new(FORMAT, 32, 32)).unwrap();
    let quads: Vec<Quad> = (0..40)
        .map(|id| Quad { x: [0, 32], y: [0, 32], depth: id as f32 / 64.0, color: [9, 200, 30, 40], id })
        .collect();
    let inputs: Vec<String> = renderer.vertex_inputs().inputs.iter().map(|input| input.name.clone()).collect();
    let inputs: Vec<&str> = inputs.iter().map(String::as_str).collect();
    let buffer = vertex_buffer(&stage, &vertices(&quads, [32, 32], &inputs));
    let frame = |renderer: &mut Renderer, side: u32| {
        let offscreen = Offscreen::new(&stage.device, FORMAT, side, side).unwrap();
        let output = Output { view: offscreen.view(), load: wgpu::LoadOp::Clear(wgpu::Color::BLACK) };
        let rendered = renderer.render(&output, &mut |pass, _| {
            pass.set_vertex_buffer(0, buffer.slice(..));
            pass.draw(0..6 * quads.len() as u32, 0..1);
        });
        rendered.unwrap();
    };
    frame(&mut renderer, 32);
    assert_eq!(renderer.k(), Some(40));
    block_on(&stage.device, renderer.resize(128, 128)).unwrap().unwrap();
    assert!(renderer.allocated_bytes() <= BUDGET, "{} bytes before the frame", renderer.allocated_bytes());
    frame(&mut renderer, 128);
    assert!(renderer.allocated_bytes() <= BUDGET, "{} bytes", renderer.allocated_bytes());
    assert_eq!(renderer.k(), Some(6));
}
