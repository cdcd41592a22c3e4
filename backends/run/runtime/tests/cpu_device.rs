//! The CPU device and the software driver keep the same fragments, word for word, on quads that cover whole pixels. Interleaving
//! the fragments of a pixel changes nothing, except for techniques with declared hazards.

use std::collections::BTreeMap;
use std::sync::Arc;

use fragbuf_cpu::{Code, Device, FragmentOrder, Mesh};
use fragbuf_model::Variant;
use fragbuf_runtime::{PoolSize, Sizing, VertexInputs};
use fragbuf_targets::target;
use fragbuf_templates::Registry;
use fragbuf_templates::vocabulary::KeepDefault;

use crate::capture::{cases, scattered};
use crate::kept;
use crate::oracle::Words;
use crate::order::orders;
use crate::quads::{Quad, SIZE, vertices};
use crate::stage::{self, render_frame, renderer, settings, shaders, technique};

pub fn device(variant: &Variant, order: FragmentOrder) -> Device {
    let code = Code::of(variant, &Registry::builtin()).unwrap_or_else(|error| panic!("{error}"));
    let settings = fragbuf_cpu::Settings { order, ..fragbuf_cpu::Settings::new(SIZE, SIZE) };
    Device::new(Arc::new(code), settings).unwrap()
}

fn paint(device: &mut Device, quads: &[Quad]) -> Vec<[f32; 4]> {
    let bytes = vertices(quads, &VertexInputs::of(device.plan()));
    let words: Vec<u32> = bytes.chunks_exact(4).map(|word| u32::from_le_bytes(word.try_into().unwrap())).collect();
    let indices: Vec<u32> = (0..6 * quads.len() as u32).collect();
    let image = device.render(&Mesh { vertices: &words, indices: &indices }, &|_| {}).unwrap();
    assert!(image.out_of_bounds.is_empty(), "{:?}", image.out_of_bounds);
    image.pixels
}

/// Renders quads and returns the kept fragments and the image.
pub fn draw(device: &mut Device, quads: &[Quad]) -> (Vec<Vec<Words>>, Vec<[f32; 4]>) {
    let pixels = paint(device, quads);
    (kept_by(device, quads), pixels)
}

fn kept_by(device: &Device, quads: &[Quad]) -> Vec<Vec<Words>> {
    let names = device.plan().resources.iter().map(|planned| planned.resource.name.clone());
    let buffers: BTreeMap<String, Vec<u32>> = names.map(|name| (name.clone(), device.words(&name).unwrap())).collect();
    kept::kept(device, &buffers, quads)
}

/// Returns every technique, with k = 4 or its greatest k if that is smaller.
fn techniques() -> Vec<(String, Variant)> {
    let registry = Registry::builtin();
    let variant = |key: &str, keep: KeepDefault| match keep {
        KeepDefault::All => technique(key, &[]),
        KeepDefault::Best(most) => technique(key, &[("k", &most.min(4).to_string())]),
    };
    registry.techniques().iter().map(|row| (row.key.clone(), variant(&row.key, row.keep))).collect()
}

#[test]
fn both_devices_keep_the_same_words() {
    let stage = stage::device();
    for (key, variant) in techniques() {
        // Techniques that portable WGSL cannot express use naga's WGSL.
        let portable = variant.select(target("wgsl").unwrap().provides).is_ok();
        let language = if portable { "wgsl" } else { "wgsl-native" };
        let mut renderer = renderer(&stage, &shaders(&variant, language), &settings()).unwrap();
        let mut device = device(&variant, FragmentOrder::Submission);
        for (name, quads) in cases() {
            for quads in orders(&quads).into_iter().take(4) {
                let seen = render_frame(&stage, &mut renderer, &quads);
                let (kept, pixels) = draw(&mut device, &quads);
                assert_eq!(kept, seen.kept, "{key}, {name}: {quads:?}");
                for (cpu, driver) in pixels.iter().zip(&seen.pixels) {
                    let background = stage::BACKGROUND;
                    for channel in 0..3 {
                        let cpu = f64::from(cpu[channel]) + (1.0 - f64::from(cpu[3])) * background[channel];
                        assert!((cpu - f64::from(driver[channel])).abs() <= 1.0 / 255.0, "{key}, {name}");
                    }
                }
            }
        }
    }
}

#[test]
fn interleaving_changes_nothing_without_declared_hazards() {
    for (key, variant) in techniques() {
        let mut in_order = device(&variant, FragmentOrder::Submission);
        if !in_order.plan().hazards.is_empty() {
            continue;
        }
        for seed in 0..4 {
            let mut shuffled = device(&variant, FragmentOrder::Shuffled(seed));
            for (name, quads) in cases() {
                let (expected, seen) = (draw(&mut in_order, &quads).0, draw(&mut shuffled, &quads).0);
                assert!(expected == seen, "{key}, {name}, seed {seed}");
            }
        }
    }
}

/// Leaked pages are counted and missing from the pool. With enough pages no schedule changes the result.
#[test]
fn leaked_pages_only_reduce_the_pool() {
    let variant = technique("ab_ll_paged", &[("counters", "all")]);
    let quads: Vec<Quad> = scattered(24, 3).into_iter().map(|quad| quad.at(0, 0, SIZE, SIZE)).collect();
    let with = |order: FragmentOrder, size: u32| {
        let code = Code::of(&variant, &Registry::builtin()).unwrap();
        let sizing = Sizing::Capacity(PoolSize::Fragments(size));
        let settings = fragbuf_cpu::Settings { sizing, order, ..fragbuf_cpu::Settings::new(SIZE, SIZE) };
        let mut device = Device::new(Arc::new(code), settings).unwrap();
        let (kept, _) = draw(&mut device, &quads);
        let counters = fragbuf_runtime::Counters::per_slice(&device.words("counters").unwrap()).remove(0);
        (kept, counters)
    };
    let fragments = 24 * SIZE * SIZE;
    let (expected, counters) = with(FragmentOrder::Submission, fragments);
    assert_eq!((counters.get("pages_leaked"), counters.lost()), (0, 0));
    for seed in 0..4 {
        // One page per fragment is enough for any schedule, because no fragment takes two.
        let (kept, counters) = with(FragmentOrder::Shuffled(seed), 4 * fragments);
        assert!(kept == expected && counters.lost() == 0, "seed {seed}: {counters:?}");
        assert!(counters.get("pages_leaked") > 0, "seed {seed} interleaves nothing");
        let (kept, counters) = with(FragmentOrder::Shuffled(seed), fragments);
        let count: usize = kept.iter().map(Vec::len).sum();
        assert_eq!(count as u64 + counters.lost(), u64::from(fragments), "seed {seed}: {counters:?}");
        assert_eq!(counters.lost(), u64::from(counters.get("pool_exhausted")), "seed {seed}");
    }
}

/// Repeated passes repair the effects of races, or count the fragments that did not converge. If all converge, the k least
/// distinct keys are kept under every schedule.
#[test]
fn races_are_repaired_or_counted() {
    let quads: Vec<Quad> = scattered(12, 5).into_iter().map(|quad| quad.at(0, 0, SIZE, SIZE)).collect();
    let (mut converged, mut counted) = (0, 0);
    for k in [1, 4, 8] {
        let variant = technique("kb_multi", &[("k", &k.to_string())]);
        let mut keys: Vec<u32> = quads.iter().map(|quad| quad.depth.to_bits()).collect();
        keys.sort();
        keys.dedup();
        keys.truncate(k);
        for seed in 0..8 {
            let mut device = device(&variant, FragmentOrder::Shuffled(seed));
            let bytes = vertices(&quads, &VertexInputs::of(device.plan()));
            let words: Vec<u32> = bytes.chunks_exact(4).map(|w| u32::from_le_bytes(w.try_into().unwrap())).collect();
            let indices: Vec<u32> = (0..6 * quads.len() as u32).collect();
            let image = device.render(&Mesh { vertices: &words, indices: &indices }, &|_| {}).unwrap();
            if image.counters.unwrap().get("not_converged") > 0 {
                counted += 1;
                continue;
            }
            converged += 1;
            for (pixel, kept) in kept_by(&device, &quads).into_iter().enumerate() {
                let seen: Vec<u32> = kept.iter().map(|words| words[0]).collect();
                assert_eq!(seen, keys, "k = {k}, seed {seed}, pixel {pixel}");
            }
        }
    }
    assert!(converged > 0 && counted > 0, "{converged} converged, {counted} counted");
}

/// Locks exclude fragments under every schedule, with many concurrent fragments of a pixel, and none times out.
#[test]
fn locks_hold_under_any_schedule() {
    let variant = technique("kplus_array", &[("k", "8")]);
    let quads: Vec<Quad> = scattered(40, 3).into_iter().map(|quad| quad.at(0, 0, SIZE, SIZE)).collect();
    let expected = draw(&mut device(&variant, FragmentOrder::Submission), &quads);
    for seed in 0..8 {
        assert!(draw(&mut device(&variant, FragmentOrder::Shuffled(seed)), &quads) == expected, "seed {seed}");
    }
}

#[test]
fn without_a_lock_interleaving_loses_fragments() {
    let variant = technique("kb", &[("k", "4")]);
    let quads: Vec<Quad> = scattered(12, 5).into_iter().map(|quad| quad.at(0, 0, SIZE, SIZE)).collect();
    let expected = paint(&mut device(&variant, FragmentOrder::Submission), &quads);
    let seen = paint(&mut device(&variant, FragmentOrder::Shuffled(1)), &quads);
    let wrong = seen.iter().zip(&expected).filter(|(seen, expected)| seen != expected).count();
    assert!(wrong > seen.len() / 4, "{wrong} of {} pixels", seen.len());
    // The same seed is the same schedule.
    assert!(seen == paint(&mut device(&variant, FragmentOrder::Shuffled(1)), &quads));
}
