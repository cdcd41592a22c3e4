//! Storages that lose fragments by design lose exactly the fragments that they declare.

use std::collections::BTreeMap;

use fragbuf_model::Variant;
use fragbuf_runtime::headless::Offscreen;
use fragbuf_runtime::{Output, PoolSize, Renderer, Settings, Sizing, block_on};

use crate::capture::{compare, scattered};
use crate::oracle::{self, PLAIN, Rules, Words};
use crate::order::{Numbers, orders};
use crate::quads::{Quad, SIZE, vertices};
use crate::stage::{self, BACKGROUND, FrameResult, render_frame, renderer, settings, shaders, technique};

/// Returns scenes with many equal depths, and at most eight layers over a pixel.
fn scenes() -> Vec<Vec<Quad>> {
    let color = |index: u32| [index as u8 * 30, 255 - index as u8 * 30, 7, 100 + index as u8];
    let flat = |depths: &[f32]| (0..).zip(depths).map(|(index, depth)| Quad::whole(*depth, color(index))).collect();
    vec![
        Vec::new(),
        flat(&[0.5, 0.5, 0.5]),
        flat(&[0.0, 1.0, 1.0, 0.0]),
        flat(&[0.25, 0.5, 0.25, 0.75, 0.5, 0.125, 0.125, 0.25]),
        flat(&[0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8]),
        scattered(8, 3),
        scattered(8, 4),
    ]
}

/// Renders every scene in every order and passes each frame to `inspect`.
fn each_frame(variant: &Variant, inspect: impl Fn(&FrameResult, &[Quad])) {
    let stage = stage::device();
    let mut renderer = renderer(&stage, &shaders(variant, "wgsl"), &settings()).unwrap();
    for scene in scenes() {
        let scene: Vec<Quad> = (0..).zip(scene).map(|(id, quad)| quad.named(id)).collect();
        for quads in orders(&scene) {
            inspect(&render_frame(&stage, &mut renderer, &quads), &quads);
        }
    }
}

/// For each of the k least keys one of its fragments is kept, and every other fragment is counted.
#[test]
fn of_equal_depths_one_is_kept() {
    let of_k = |k| [("kb_mdt32", "none", k), ("kb_mdt32", "occupancy", k), ("kb_multi", "none", k)];
    for (key, cull, k) in [1, 3, 8].into_iter().flat_map(of_k) {
        let variant = technique(key, &[("k", &k.to_string()), ("counters", "all"), ("cull", cull)]);
        each_frame(&variant, |seen, quads| {
            let (mut kept_in_all, mut equal) = (0, 0);
            for (kept, (x, y)) in seen.kept.iter().zip(oracle::pixels()) {
                let mut by_key: BTreeMap<u32, Vec<Words>> = BTreeMap::new();
                for words in oracle::kept(&PLAIN, quads, None, x, y).iter().map(PLAIN.words) {
                    by_key.entry(words[0]).or_default().push(words);
                }
                let keys: Vec<u32> = by_key.keys().copied().take(k).collect();
                assert_eq!(kept.iter().map(|words| words[0]).collect::<Vec<_>>(), keys, "{x}, {y} of {quads:?}");
                for words in kept {
                    assert!(by_key[&words[0]].contains(words), "{words:?} at {x}, {y} is no fragment of {quads:?}");
                }
                kept_in_all += kept.len() as u32;
                equal += by_key.values().map(|alike| alike.len() as u32 - 1).sum::<u32>();
            }
            let count = |name: &str| seen.counters.get(name);
            let rejected = count("culled") + count("displaced") + count("equal_keys");
            assert_eq!(count("generated"), kept_in_all + rejected, "{:?}", seen.counters);
            // A fragment may be rejected by its key before it is compared with a fragment of the same key.
            assert!(count("equal_keys") <= equal, "{:?}", seen.counters);
            assert!(k < 8 || count("equal_keys") == equal, "{:?}", seen.counters);
        });
    }
}

/// With different depths only farther fragments are lost, whether the host ends the loop or the limit does.
#[test]
fn loops_that_end_on_their_condition_or_limit_keep_the_same() {
    let stage = stage::device();
    for (k, sizing) in [(1, Sizing::Exact), (4, Sizing::Auto), (4, Sizing::Reserve(PoolSize::Fragments(0)))] {
        let variant = technique("kb_multi", &[("k", &k.to_string())]);
        let settings = Settings { sizing, ..settings() };
        let mut renderer = renderer(&stage, &shaders(&variant, "wgsl"), &settings).unwrap();
        let color = |index: u32| [index as u8 * 30, 200, 9, 90];
        let quad = |index: u32| Quad::whole((index + 1) as f32 / 16.0, color(index)).at(0, 0, SIZE, SIZE - index);
        let quads: Vec<Quad> = (0..8).map(quad).collect();
        for quads in orders(&quads) {
            let seen = render_frame(&stage, &mut renderer, &quads);
            compare("iterations", &seen, &PLAIN, &quads, (renderer.k(), renderer.k()));
            assert_eq!(seen.counters.get("not_converged"), 0);
        }
    }
}

/// A frame is suspended after each iteration of a loop with an end condition, and then continues. k limits the iterations.
#[test]
fn a_frame_is_suspended_once_per_iteration() {
    let stage = stage::device();
    let variant = technique("kb_multi", &[("k", "4")]);
    let shaders = shaders(&variant, "wgsl");
    let draws = |renderer: &mut Renderer| {
        let offscreen = Offscreen::new(&stage.device, stage::FORMAT, SIZE, SIZE).unwrap();
        let output = Output { view: offscreen.view(), load: wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT) };
        let quads: Vec<Quad> = scattered(8, 3).into_iter().map(|quad| quad.at(0, 0, SIZE, SIZE)).collect();
        let bytes = vertices(&quads, renderer.vertex_inputs());
        let usage = wgpu::BufferUsages::VERTEX | wgpu::BufferUsages::COPY_DST;
        let size = bytes.len() as u64;
        let descriptor = wgpu::BufferDescriptor { label: None, size, usage, mapped_at_creation: false };
        let buffer = stage.device.create_buffer(&descriptor);
        stage.queue.write_buffer(&buffer, 0, &bytes);
        let mut count = 0;
        renderer
            .render(&output, &mut |pass, _| {
                pass.set_vertex_buffer(0, buffer.slice(..));
                pass.draw(0..48, 0..1);
                count += 1;
            })
            .unwrap();
        count
    };
    let timed = Settings { timestamps: true, ..settings() };
    let mut exact = renderer(&stage, &shaders, &timed).unwrap();
    // The driver runs the fragments of a pixel sequentially, so the second iteration changes nothing.
    assert_eq!(draws(&mut exact), 2);
    let mut encoder = stage.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    let times = exact.pass_times(&mut encoder).unwrap();
    stage.queue.submit([encoder.finish()]);
    // There are queries for every iteration.
    assert!(times.wait(&stage.device).unwrap().iter().all(|time| time.untimed == 0));
    let reserve = Settings { sizing: Sizing::Reserve(PoolSize::Fragments(0)), ..settings() };
    let mut reserved = renderer(&stage, &shaders, &reserve).unwrap();
    assert_eq!(draws(&mut reserved), 5);
    block_on(&stage.device, reserved.set_k(2)).unwrap().unwrap();
    assert_eq!(draws(&mut reserved), 3);
    let sliced = Settings { slice: Some(5), ..settings() };
    assert_eq!(draws(&mut renderer(&stage, &shaders, &sliced).unwrap()), 2 * SIZE.div_ceil(5));
}

/// Returns the range of a depth, among `k` ranges from `near` to `far` in millionths.
fn range(quad: &Quad, near: u64, far: u64, k: u64) -> u64 {
    let depth = (quad.depth * 1_000_000.0) as u64;
    (depth.clamp(near, far) - near) * k / (far - near)
}

/// The storage keeps the nearest fragment of each depth range.
#[test]
fn of_every_range_of_depth_the_nearest_is_kept() {
    for (near, far, k) in [(0, 1_000_000, 1), (0, 1_000_000, 4), (0, 1_000_000, 7), (250_000, 500_000, 2)] {
        let parameters = [k, near, far].map(|number: u64| number.to_string());
        let set = [("k", &*parameters[0]), ("storage.near", &*parameters[1]), ("storage.far", &*parameters[2])];
        each_frame(&technique("depth_partition", &set), |seen, quads| {
            let nearest = |x: u32, y: u32| {
                let mut nearest: BTreeMap<u64, Quad> = BTreeMap::new();
                for quad in oracle::kept(&PLAIN, quads, None, x, y) {
                    nearest.entry(range(&quad, near, far, k).min(k - 1)).or_insert(quad);
                }
                nearest.into_values().collect::<Vec<Quad>>()
            };
            for (kept, (x, y)) in seen.kept.iter().zip(oracle::pixels()) {
                let expected: Vec<Words> = nearest(x, y).iter().map(PLAIN.words).collect();
                assert_eq!(*kept, expected, "{x}, {y} of {quads:?}");
            }
        });
    }
}

/// With as many ranges as depths nothing is lost, and the image is complete.
#[test]
fn ranges_that_hold_one_fragment_each_lose_nothing() {
    let variant = technique("depth_partition", &[("k", "8")]);
    let rules = Rules { ..PLAIN };
    let stage = stage::device();
    let mut renderer = renderer(&stage, &shaders(&variant, "wgsl"), &settings()).unwrap();
    let quads: Vec<Quad> = (0..8)
        .map(|index| Quad::whole(index as f32 / 8.0, [index as u8 * 30, 90, 200, 80]).at(0, 0, SIZE - index, SIZE))
        .collect();
    for quads in orders(&quads) {
        compare("ranges", &render_frame(&stage, &mut renderer, &quads), &rules, &quads, (None, None));
    }
}

/// Simulates a stream of k entries: whenever it holds k + 1 fragments, it emits the nearest. Returns the fragments in composition
/// order, the number of those that are too late, and the words of the entries at the end.
fn streamed(fragments: &[Quad], k: usize) -> (Vec<Quad>, u32, Vec<Words>) {
    let (mut held, mut emitted): (Vec<Quad>, Vec<Quad>) = (Vec::new(), Vec::new());
    let mut late = 0;
    for quad in fragments {
        held.push(*quad);
        held.sort_by_key(PLAIN.words);
        if held.len() > k {
            let nearest = held.remove(0);
            late += u32::from(emitted.iter().any(|other| other.depth > nearest.depth));
            emitted.push(nearest);
        }
    }
    let kept = held.iter().map(PLAIN.words).collect();
    (emitted.into_iter().chain(held).collect(), late, kept)
}

/// Checks that the colour `seen` of a pixel is that of the composited `layers`.
fn assert_composited(seen: &[f32; 4], layers: &[Quad], what: &str) {
    let color = oracle::over(layers);
    for (channel, background) in BACKGROUND.into_iter().enumerate() {
        let expected = color[channel] + (1.0 - color[3]) * background;
        let off = 255.0 * (f64::from(seen[channel]) - expected).abs();
        assert!(off <= 1.0, "{what}: channel {channel} is off by {off}/255");
    }
}

/// In every order of arrival the image is that of the stream, and each fragment that comes too late is counted.
#[test]
fn a_stream_composites_in_the_order_of_emission() {
    for k in [1, 3, 8] {
        let variant = technique("kb_stream", &[("k", &k.to_string()), ("counters", "all")]);
        let disorder = std::cell::Cell::new(0);
        each_frame(&variant, |seen, quads| {
            let (mut late_in_all, mut emitted) = (0, 0);
            for ((kept, pixel), (x, y)) in seen.kept.iter().zip(&seen.pixels).zip(oracle::pixels()) {
                let fragments = oracle::fragments(quads, x, y);
                let (layers, late, held) = streamed(&fragments, k);
                assert_eq!(*kept, held, "{x}, {y} of {quads:?}");
                assert_composited(pixel, &layers, &format!("k = {k}, {x}, {y} of {quads:?}"));
                late_in_all += late;
                emitted += (fragments.len() - held.len()) as u32;
            }
            let count = |name: &str| seen.counters.get(name);
            assert_eq!((count("out_of_order"), count("emitted"), seen.counters.lost()), (late_in_all, emitted, 0));
            disorder.set(disorder.get() + late_in_all);
        });
        assert_eq!(disorder.get() > 0, k < 8, "eight layers are out of order for fewer than eight entries");
    }
}

/// If no fragment comes more than k positions late, any number of them is composited in order.
#[test]
fn a_stream_of_nearly_sorted_fragments_gives_the_complete_image() {
    let stage = stage::device();
    let k = 3;
    let mut renderer = renderer(&stage, &shaders(&technique("kb_stream", &[("k", "3")]), "wgsl"), &settings()).unwrap();
    let color = |index: u32| [(index * 37 % 256) as u8, (index * 91 % 256) as u8, 40, 30 + index as u8];
    let sorted: Vec<Quad> = (0..24).map(|index| Quad::whole(index as f32 / 32.0, color(index))).collect();
    for seed in 0..16 {
        let mut numbers = Numbers::seeded(seed);
        // Each group of k + 1 is in random order, so none is more than k positions late.
        let nearly: Vec<Quad> = sorted
            .chunks(k + 1)
            .flat_map(|group| {
                let mut group = group.to_vec();
                (1..group.len()).rev().for_each(|end| group.swap(end, numbers.below(end as u32 + 1) as usize));
                group
            })
            .collect();
        let seen = render_frame(&stage, &mut renderer, &nearly);
        assert_eq!(seen.counters.get("out_of_order"), 0, "{nearly:?}");
        for pixel in &seen.pixels {
            assert_composited(pixel, &sorted, "nearly sorted");
        }
    }
    let farthest_first: Vec<Quad> = sorted.iter().rev().copied().collect();
    let seen = render_frame(&stage, &mut renderer, &farthest_first);
    // All that come after the farthest was emitted.
    assert_eq!(seen.counters.get("out_of_order"), (24 - k as u32 - 1) * SIZE * SIZE);
}

/// On a device that runs the fragments of a pixel sequentially, the k nearest are kept, and equal fragments once.
#[test]
fn a_checksummed_array_keeps_one_of_equal_fragments() {
    let red = [255, 0, 0, 128];
    let twice = |quads: &[Quad]| -> Vec<Quad> { [quads, quads].concat() };
    let equal = [Quad::whole(0.5, red), Quad::whole(0.5, [0, 255, 0, 64]), Quad::whole(0.25, red).at(0, 0, 5, 9)];
    for k in [1, 3, 8] {
        let variant = technique("kb_mha", &[("k", &k.to_string()), ("counters", "all")]);
        let stage = stage::device();
        let mut renderer = renderer(&stage, &shaders(&variant, "wgsl"), &settings()).unwrap();
        for scene in scenes().into_iter().chain([equal.to_vec(), twice(&equal), twice(&scattered(4, 5))]) {
            for quads in orders(&scene) {
                let seen = render_frame(&stage, &mut renderer, &quads);
                let mut repeated = 0;
                for ((kept, pixel), (x, y)) in seen.kept.iter().zip(&seen.pixels).zip(oracle::pixels()) {
                    let mut fragments = oracle::kept(&PLAIN, &quads, None, x, y);
                    let all = fragments.len();
                    fragments.dedup_by_key(|quad| (PLAIN.words)(quad));
                    repeated += (all - fragments.len()) as u32;
                    fragments.truncate(k);
                    assert_eq!(*kept, fragments.iter().map(PLAIN.words).collect::<Vec<_>>(), "{x}, {y} of {quads:?}");
                    assert_composited(pixel, &fragments, &format!("k = {k}, {x}, {y} of {quads:?}"));
                }
                let count = |name: &str| seen.counters.get(name);
                let kept: u32 = seen.kept.iter().map(|kept| kept.len() as u32).sum();
                assert_eq!(count("generated"), kept + count("displaced") + count("equal_keys"), "{:?}", seen.counters);
                // Some of the equal fragments may be behind k others when they come.
                assert!(count("equal_keys") <= repeated && (k < 8 || count("equal_keys") == repeated));
            }
        }
    }
}
