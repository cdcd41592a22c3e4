//! Storages that lose fragments by what they are, and say so: what is lost is what they state, and nothing else.

use std::collections::BTreeMap;

use fragbuf_model::Variant;
use fragbuf_runtime::headless::Offscreen;
use fragbuf_runtime::{Output, Renderer, Room, Settings, Sizing, block_on};

use crate::capture::{compare, scattered};
use crate::oracle::{self, PLAIN, Rules, Words};
use crate::order::orders;
use crate::quads::{Quad, SIZE, vertices};
use crate::stage::{self, Seen, renderer, see, settings, shaders, technique};

/// Scenes with many equal depths, at most eight layers over a pixel.
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

/// Every scene in every order, each frame handed to `inspect`.
fn each_frame(variant: &Variant, inspect: impl Fn(&Seen, &[Quad])) {
    let stage = stage::device();
    let mut renderer = renderer(&stage, &shaders(variant, "wgsl"), &settings()).unwrap();
    for scene in scenes() {
        let scene: Vec<Quad> = (0..).zip(scene).map(|(id, quad)| quad.named(id)).collect();
        for quads in orders(&scene) {
            inspect(&see(&stage, &mut renderer, &quads), &quads);
        }
    }
}

/// One fragment for each of the k least keys, and it is one of those with that key; every other is counted.
#[test]
fn of_equal_depths_one_is_kept() {
    for (key, k) in [1, 3, 8].into_iter().flat_map(|k| [("kb_mdt32", k), ("kb_multi", k)]) {
        let variant = technique(key, &[("k", &k.to_string()), ("counters", "all")]);
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
            let turned_away = count("culled") + count("displaced") + count("equal_keys");
            assert_eq!(count("generated"), kept_in_all + turned_away, "{:?}", seen.counters);
            // Of fragments with equal keys, some may be turned away for their key before they meet an equal one.
            assert!(count("equal_keys") <= equal, "{:?}", seen.counters);
            assert!(k < 8 || count("equal_keys") == equal, "{:?}", seen.counters);
        });
    }
}

/// Where depths differ nothing is lost but what is farther, whether the host ends the loop or the bound does.
#[test]
fn rounds_that_the_host_ends_and_rounds_to_the_bound_keep_the_same() {
    let stage = stage::device();
    for (k, sizing) in [(1, Sizing::Exact), (4, Sizing::Auto), (4, Sizing::Reserve(Room::Fragments(0)))] {
        let variant = technique("kb_multi", &[("k", &k.to_string())]);
        let settings = Settings { sizing, ..settings() };
        let mut renderer = renderer(&stage, &shaders(&variant, "wgsl"), &settings).unwrap();
        let color = |index: u32| [index as u8 * 30, 200, 9, 90];
        let quad = |index: u32| Quad::whole((index + 1) as f32 / 16.0, color(index)).at(0, 0, SIZE, SIZE - index);
        let quads: Vec<Quad> = (0..8).map(quad).collect();
        for quads in orders(&quads) {
            let seen = see(&stage, &mut renderer, &quads);
            compare("rounds", &seen, &PLAIN, &quads, (renderer.k(), renderer.k()));
            assert_eq!(seen.counters.get("unsettled"), 0);
        }
    }
}

/// A loop is cut after every round that the host must hear of, and goes on where it was; k decides how many there may be.
#[test]
fn a_loop_is_cut_once_a_round() {
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
    // One fragment of a pixel after the other: the second round changes nothing.
    assert_eq!(draws(&mut exact), 2);
    let mut encoder = stage.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    let times = exact.pass_times(&mut encoder).unwrap();
    stage.queue.submit([encoder.finish()]);
    assert_eq!(times.wait(&stage.device).unwrap().iter().filter(|time| time.pass == "store").count(), 5);
    let reserve = Settings { sizing: Sizing::Reserve(Room::Fragments(0)), ..settings() };
    let mut reserved = renderer(&stage, &shaders, &reserve).unwrap();
    assert_eq!(draws(&mut reserved), 5);
    block_on(&stage.device, reserved.set_k(2)).unwrap().unwrap();
    assert_eq!(draws(&mut reserved), 3);
    let sliced = Settings { slice: Some(5), ..settings() };
    assert_eq!(draws(&mut renderer(&stage, &shaders, &sliced).unwrap()), 2 * SIZE.div_ceil(5));
}

/// The depths of `quad` in millionths, from `near` to `far`, cut into `k` ranges.
fn range(quad: &Quad, near: u64, far: u64, k: u64) -> u64 {
    let depth = (quad.depth * 1_000_000.0) as u64;
    (depth.clamp(near, far) - near) * k / (far - near)
}

/// The nearest fragment of each range, and the picture of them.
#[test]
fn of_every_range_of_depth_the_nearest_is_kept() {
    for (near, far, k) in [(0, 1_000_000, 1), (0, 1_000_000, 4), (0, 1_000_000, 7), (250_000, 500_000, 2)] {
        let text = [k, near, far].map(|number: u64| number.to_string());
        let set = [("k", &*text[0]), ("storage.near", &*text[1]), ("storage.far", &*text[2])];
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

/// With as many ranges as there are depths nothing is lost, and the picture is everybody's.
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
        compare("ranges", &see(&stage, &mut renderer, &quads), &rules, &quads, (None, None));
    }
}
