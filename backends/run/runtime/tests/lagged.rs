//! Decisions that lag: a sequence of frames has the k of a reference on both devices, no frame waits for the device, and memory stays within
//! the budget.

use std::sync::Arc;

use fragbuf_cpu::{Code, Device, Mesh};
use fragbuf_runtime::headless::{Headless, Offscreen};
use fragbuf_runtime::{Buckets, Decisions, Output, Recorded, Renderer, Settings, block_on};
use fragbuf_templates::Registry;

use crate::allocation::{BUDGET, SIDE, constant, expected_k, fragments, scene};
use crate::drivers::draw;
use crate::drivers::scene::{Quad, first_difference, image, vertices};
use crate::stage::{BACKGROUND, FORMAT, device, renderer, shaders, technique, vertex_buffer};

const SHRINK_AFTER: u32 = 3;
/// The quads of each frame: their number jumps up and down, and stays for fewer and more than three frames.
const LAYERS: [usize; 18] = [3, 10, 2, 2, 10, 2, 4, 3, 3, 3, 1, 1, 1, 1, 6, 0, 0, 9];

/// Returns k by the rule of the documentation: larger at once; smaller once three frames in a row want less, then the greatest of them.
fn next_k(k: u32, smaller: &mut Vec<u32>, wanted: u32) -> u32 {
    if wanted >= k {
        smaller.clear();
        return wanted;
    }
    smaller.push(wanted);
    if smaller.len() < SHRINK_AFTER as usize {
        return k;
    }
    let greatest = smaller.iter().copied().max().unwrap();
    smaller.clear();
    greatest
}

/// Returns the k of every frame, from the k that each frame wants for itself.
fn sequence(wanted: &[u32]) -> Vec<u32> {
    let (mut smaller, mut k) = (Vec::new(), wanted[0]);
    let later = wanted.iter().map(|wanted| {
        k = next_k(k, &mut smaller, *wanted);
        k
    });
    [wanted[0]].into_iter().chain(later).take(wanted.len()).collect()
}

fn mesh(quads: &[Quad], inputs: &[String]) -> (Vec<u32>, Vec<u32>) {
    let inputs: Vec<&str> = inputs.iter().map(String::as_str).collect();
    let bytes = vertices(quads, [SIDE; 2], &inputs);
    let words = bytes.chunks_exact(4).map(|word| u32::from_le_bytes(word.try_into().unwrap())).collect();
    (words, (0..6 * quads.len() as u32).collect())
}

/// Waits for the commands of all frames: what they read back is there before the next frame.
fn finish(stage: &Headless) {
    stage.device.poll(wgpu::PollType::wait_indefinitely()).unwrap();
}

fn inputs(renderer: &Renderer) -> Vec<String> {
    renderer.vertex_inputs().inputs.iter().map(|input| input.name.clone()).collect()
}

const DECISIONS: Decisions = Decisions::Lagged { shrink_after: SHRINK_AFTER };

#[test]
fn both_devices_have_the_k_of_the_reference() {
    let stage = device();
    for (key, sync, percent) in [("kplus_array", "spin_lock", 100), ("mdt32_coplanar", "slot_counter", 80)] {
        let percent_text = percent.to_string();
        let set = [
            ("k", "16"),
            ("sync", sync),
            ("allocation", "predicted"),
            ("allocation.budget", "1"),
            ("allocation.hit_ratio", percent_text.as_str()),
        ];
        let variant = technique(key, &set);
        let beside = if key == "kplus_array" { 3 } else { 1 };
        let pixels = u64::from(SIDE * SIDE);
        let constant = constant(&variant);
        let bytes = |k: u32, _| pixels * 4 * (2 * u64::from(k) + beside) + constant;
        let frames: Vec<Vec<Quad>> = LAYERS.map(|count| scene(5)[..count].to_vec()).to_vec();
        let wanted: Vec<u32> = frames.iter().map(|quads| expected_k(&fragments(quads), percent, 16, bytes)).collect();
        let expected = sequence(&wanted);
        assert!(expected.windows(2).any(|pair| pair[0] > pair[1]) && expected != wanted, "{expected:?}");

        let settings = Settings { decisions: DECISIONS, ..Settings::new(FORMAT, SIDE, SIDE) };
        let mut renderer = renderer(&stage, &shaders(&variant, "wgsl"), &settings).unwrap();
        let code = Arc::new(Code::of(&variant, &Registry::builtin()).unwrap_or_else(|error| panic!("{key}: {error}")));
        let settings = fragbuf_cpu::Settings { decisions: DECISIONS, ..fragbuf_cpu::Settings::new(SIDE, SIDE) };
        let mut cpu = Device::new(code, settings).unwrap();
        for (number, (quads, k)) in frames.iter().zip(&expected).enumerate() {
            assert_eq!(renderer.is_lagged(), number > 1, "what the first frame decides is not applied before `decide`");
            let seen = draw(&stage, &mut renderer, quads, [SIDE; 2]).unwrap();
            assert_eq!(renderer.k(), Some(*k), "{key}, frame {number} of {expected:?}");
            assert_eq!(renderer.is_lagged(), number > 0);
            assert_eq!(renderer.allocated_bytes(), bytes(*k, 0), "{key}: the memory of k, and no more");
            assert!(renderer.allocated_bytes() <= BUDGET);
            let expected = image(quads, [SIDE, SIDE], Some(*k), BACKGROUND);
            assert_eq!(first_difference(&seen, &expected), None, "{key}, frame {number}, k = {k}");
            let (vertices, indices) = mesh(quads, &inputs(&renderer));
            cpu.render(&Mesh { vertices: &vertices, indices: &indices }, &|_| {}).unwrap();
            assert_eq!((cpu.k(), cpu.is_lagged(), cpu.allocated_bytes()), (Some(*k), number > 0, bytes(*k, 0)));
        }
    }
}

/// The k of the frame is the greatest that a slice wants.
#[test]
fn slices_share_the_greatest_k() {
    let stage = device();
    const ROWS: u32 = 48;
    let variant = technique("kplus_array", &[("k", "16"), ("allocation", "predicted"), ("allocation.hit_ratio", "80")]);
    let frames: Vec<Vec<Quad>> = LAYERS.map(|count| scene(7)[..count].to_vec()).to_vec();
    let wanted: Vec<u32> = frames
        .iter()
        .map(|quads| {
            let counts = fragments(quads);
            let slices = counts.chunks((SIDE * ROWS) as usize);
            slices.map(|counts| expected_k(counts, 80, 16, |_, _| 0)).max().unwrap()
        })
        .collect();
    let settings = Settings { decisions: DECISIONS, slice: Some(ROWS), ..Settings::new(FORMAT, SIDE, SIDE) };
    let mut renderer = renderer(&stage, &shaders(&variant, "wgsl"), &settings).unwrap();
    let code = Arc::new(Code::of(&variant, &Registry::builtin()).unwrap_or_else(|error| panic!("{error}")));
    let settings =
        fragbuf_cpu::Settings { decisions: DECISIONS, slice: Some(ROWS), ..fragbuf_cpu::Settings::new(SIDE, SIDE) };
    let mut cpu = Device::new(code, settings).unwrap();
    let expected = sequence(&wanted);
    for (number, (quads, k)) in frames.iter().zip(&expected).enumerate() {
        let seen = draw(&stage, &mut renderer, quads, [SIDE; 2]).unwrap();
        let (vertices, indices) = mesh(quads, &inputs(&renderer));
        cpu.render(&Mesh { vertices: &vertices, indices: &indices }, &|_| {}).unwrap();
        // In the first frame each slice uses its own k.
        if number > 0 {
            assert_eq!((renderer.k(), cpu.k()), (Some(*k), Some(*k)), "frame {number} of {expected:?}");
            let expected = image(quads, [SIDE, SIDE], Some(*k), BACKGROUND);
            assert_eq!(first_difference(&seen, &expected), None, "frame {number}, k = {k}");
        }
    }
}

/// Records a frame of the caller's own, and returns its commands and whether it waits for the host.
fn record(stage: &Headless, renderer: &mut Renderer, quads: &[Quad]) -> (wgpu::CommandBuffer, bool) {
    let names = inputs(renderer);
    let names: Vec<&str> = names.iter().map(String::as_str).collect();
    let buffer = vertex_buffer(stage, &vertices(quads, [SIDE; 2], &names));
    let offscreen = Offscreen::new(&stage.device, FORMAT, SIDE, SIDE).unwrap();
    let output = Output { view: offscreen.view(), load: wgpu::LoadOp::Clear(wgpu::Color::BLACK) };
    let mut encoder = stage.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    let frame = renderer.begin().unwrap();
    let recorded = frame.record(renderer, &mut encoder, &output, &mut |pass, _| {
        pass.set_vertex_buffer(0, buffer.slice(..));
        pass.draw(0..6 * quads.len() as u32, 0..1);
    });
    let waits = matches!(recorded.unwrap(), Recorded::Suspended(_));
    (encoder.finish(), waits)
}

#[test]
fn no_frame_waits_and_late_words_count_later() {
    let stage = device();
    let variant = technique("kplus_array", &[("k", "16"), ("allocation", "predicted")]);
    let settings = Settings { decisions: DECISIONS, ..Settings::new(FORMAT, SIDE, SIDE) };
    let mut renderer = renderer(&stage, &shaders(&variant, "wgsl"), &settings).unwrap();
    let quads: Vec<Quad> =
        (0..9).map(|id| Quad { x: [0, SIDE], y: [0, SIDE], depth: id as f32 / 16.0, color: [9; 4], id }).collect();
    let decide = |renderer: &mut Renderer| block_on(&stage.device, renderer.decide()).unwrap().unwrap();
    assert!(record(&stage, &mut renderer, &quads[..2]).1, "the first frame waits");
    draw(&stage, &mut renderer, &quads[..2], [SIDE; 2]).unwrap();
    decide(&mut renderer);
    assert_eq!((renderer.k(), renderer.is_lagged()), (Some(2), true));
    // The words of frames that are not submitted are not there, and do not hold up those of later frames.
    let (late, waits) = record(&stage, &mut renderer, &quads[..7]);
    assert!(!waits);
    decide(&mut renderer);
    assert_eq!(renderer.k(), Some(2));
    drop(late);
    let (commands, waits) = record(&stage, &mut renderer, &quads[..5]);
    assert!(!waits);
    stage.queue.submit([commands]);
    finish(&stage);
    decide(&mut renderer);
    assert_eq!(renderer.k(), Some(5));
    // A device that is far behind: only the words of four frames are kept, and their k counts.
    let behind: Vec<_> = (0..6).map(|number| record(&stage, &mut renderer, &quads[..6 + number / 2]).0).collect();
    for commands in behind {
        stage.queue.submit([commands]);
    }
    finish(&stage);
    decide(&mut renderer);
    assert_eq!(renderer.k(), Some(7), "frames 0 to 3 have 6 and 7 layers");
    // Another size: the next frame waits for its own decision.
    block_on(&stage.device, renderer.resize(SIDE, SIDE / 2)).unwrap().unwrap();
    assert_eq!((renderer.k(), renderer.is_lagged()), (Some(1), false));
}

/// Another renderer, or a device, continues where the first one stopped.
#[test]
fn values_pass_to_another_renderer() {
    let stage = device();
    let variant = technique("kplus_array", &[("k", "16"), ("allocation", "predicted")]);
    let make = |variant| {
        let settings = Settings { decisions: DECISIONS, ..Settings::new(FORMAT, SIDE, SIDE) };
        renderer(&stage, &shaders(variant, "wgsl"), &settings).unwrap()
    };
    let (mut first, mut second) = (make(&variant), make(&variant));
    draw(&stage, &mut first, &scene(5), [SIDE; 2]).unwrap();
    block_on(&stage.device, first.decide()).unwrap().unwrap();
    block_on(&stage.device, second.resume_lagged(first.lagged_values())).unwrap().unwrap();
    assert_eq!((second.k(), second.is_lagged()), (first.k(), true));
    let mut other = make(&technique("kplus_array", &[("k", "16")]));
    let failed = block_on(&stage.device, other.resume_lagged(first.lagged_values())).unwrap();
    assert!(failed.unwrap_err().to_string().contains("lagged values of another plan"));
    assert_eq!(other.k(), Some(16));
}

/// Pipelines follow k by buckets, and every bucket is generated once.
#[test]
fn buckets_follow_the_decisions() {
    let stage = device();
    let mut generated = Vec::new();
    let make = |capacity: u32| {
        generated.push(capacity);
        let k = capacity.to_string();
        Ok(shaders(&technique("kplus_array", &[("k", k.as_str()), ("allocation", "predicted")]), "wgsl"))
    };
    let settings = Settings { decisions: DECISIONS, ..Settings::new(FORMAT, SIDE, SIDE) };
    let made = Buckets::new(&stage.device, &stage.queue, &settings, 4, make);
    let mut buckets = block_on(&stage.device, made).unwrap().unwrap();
    let frames: Vec<Vec<Quad>> = LAYERS.map(|count| scene(5)[..count].to_vec()).to_vec();
    let wanted: Vec<u32> = frames.iter().map(|quads| fragments(quads).into_iter().max().unwrap().max(1)).collect();
    for (number, (quads, k)) in frames.iter().zip(sequence(&wanted)).enumerate() {
        block_on(&stage.device, buckets.decide(16)).unwrap().unwrap();
        let seen = draw(&stage, buckets.renderer(), quads, [SIDE; 2]).unwrap();
        let renderer = buckets.renderer();
        assert_eq!((renderer.k(), number == 0 || renderer.capacity() == k.next_power_of_two()), (Some(k), true));
        let expected = image(quads, [SIDE, SIDE], Some(k), BACKGROUND);
        assert_eq!(first_difference(&seen, &expected), None, "frame {number}, k = {k}");
    }
    drop(buckets);
    let mut once = generated.clone();
    once.sort();
    once.dedup();
    // The greatest is generated for its plan, and again once its pipelines are needed.
    assert!(generated.len() <= once.len() + 1 && once.len() > 2, "{generated:?}");
}
