//! The CPU device and the software driver keep the same fragments, word for word, on quads that cover whole pixels; and
//! interleaving the fragments of a pixel changes nothing for any technique that does not say so.

use std::collections::BTreeMap;
use std::sync::Arc;

use fragbuf_targets::target;
use fragbuf_cpu::{Code, Device, Mesh, Order};
use fragbuf_model::Variant;
use fragbuf_runtime::{Room, Sizing, VertexInputs};
use fragbuf_templates::Registry;
use fragbuf_templates::vocabulary::KeepDefault;

use crate::capture::{cases, scattered};
use crate::kept;
use crate::oracle::Words;
use crate::order::orders;
use crate::quads::{Quad, SIZE, vertices};
use crate::stage::{self, renderer, see, settings, shaders, technique};

pub fn device(variant: &Variant, order: Order) -> Device {
    let code = Code::of(variant, &Registry::builtin()).unwrap_or_else(|error| panic!("{error}"));
    let settings = fragbuf_cpu::Settings { width: SIZE, height: SIZE, sizing: Sizing::Auto, order };
    Device::new(Arc::new(code), settings).unwrap()
}

fn paint(device: &mut Device, quads: &[Quad]) -> Vec<[f32; 4]> {
    let bytes = vertices(quads, &VertexInputs::of(device.plan()));
    let words: Vec<u32> = bytes.chunks_exact(4).map(|word| u32::from_le_bytes(word.try_into().unwrap())).collect();
    let indices: Vec<u32> = (0..6 * quads.len() as u32).collect();
    let picture = device.render(&Mesh { vertices: &words, indices: &indices }, &|_| {}).unwrap();
    assert!(picture.out_of_bounds.is_empty(), "{:?}", picture.out_of_bounds);
    picture.pixels
}

/// What the device keeps, and its picture.
pub fn draw(device: &mut Device, quads: &[Quad]) -> (Vec<Vec<Words>>, Vec<[f32; 4]>) {
    let pixels = paint(device, quads);
    (kept_by(device), pixels)
}

fn kept_by(device: &Device) -> Vec<Vec<Words>> {
    let names = device.plan().resources.iter().map(|planned| planned.resource.name.clone());
    let buffers: BTreeMap<String, Vec<u32>> = names.map(|name| (name.clone(), device.words(&name).unwrap())).collect();
    kept::kept(device, &buffers)
}

/// Every technique, where there is a k with four of it, or as many as it can have.
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
        // What portable WGSL cannot say is said in naga's own.
        let portable = variant.select(target("wgsl").unwrap().offers).is_ok();
        let language = if portable { "wgsl" } else { "wgsl-native" };
        let mut renderer = renderer(&stage, &shaders(&variant, language), &settings()).unwrap();
        let mut device = device(&variant, Order::Submission);
        for (name, quads) in cases() {
            for quads in orders(&quads).into_iter().take(4) {
                let seen = see(&stage, &mut renderer, &quads);
                let (kept, pixels) = draw(&mut device, &quads);
                assert_eq!(kept, seen.kept, "{key}, {name}: {quads:?}");
                for (own, theirs) in pixels.iter().zip(&seen.pixels) {
                    let background = stage::BACKGROUND;
                    for channel in 0..3 {
                        let own = f64::from(own[channel]) + (1.0 - f64::from(own[3])) * background[channel];
                        assert!((own - f64::from(theirs[channel])).abs() <= 1.0 / 255.0, "{key}, {name}");
                    }
                }
            }
        }
    }
}

#[test]
fn interleaving_changes_nothing_where_no_hazard_is_stated() {
    for (key, variant) in techniques() {
        let mut in_order = device(&variant, Order::Submission);
        if !in_order.plan().hazards.is_empty() {
            continue;
        }
        for seed in 0..4 {
            let mut shuffled = device(&variant, Order::Shuffled(seed));
            for (name, quads) in cases() {
                let (expected, seen) = (draw(&mut in_order, &quads).0, draw(&mut shuffled, &quads).0);
                assert!(expected == seen, "{key}, {name}, seed {seed}");
            }
        }
    }
}

/// Pages that leak are counted, and missing from the pool; where there are enough of them no schedule shows.
#[test]
fn leaked_pages_lose_nothing_but_room() {
    let variant = technique("ab_ll_paged", &[("counters", "all")]);
    let quads: Vec<Quad> = scattered(24, 3).into_iter().map(|quad| quad.at(0, 0, SIZE, SIZE)).collect();
    let with = |order: Order, room: u32| {
        let code = Code::of(&variant, &Registry::builtin()).unwrap();
        let sizing = Sizing::Reserve(Room::Fragments(room));
        let settings = fragbuf_cpu::Settings { width: SIZE, height: SIZE, sizing, order };
        let mut device = Device::new(Arc::new(code), settings).unwrap();
        let (kept, _) = draw(&mut device, &quads);
        let counters = fragbuf_runtime::Counters::each(&device.words("counters").unwrap()).remove(0);
        (kept, counters)
    };
    let fragments = 24 * SIZE * SIZE;
    let (expected, counters) = with(Order::Submission, fragments);
    assert_eq!((counters.get("pages_leaked"), counters.lost()), (0, 0));
    for seed in 0..4 {
        // A page for every fragment is enough for any schedule: none takes two.
        let (kept, counters) = with(Order::Shuffled(seed), 4 * fragments);
        assert!(kept == expected && counters.lost() == 0, "seed {seed}: {counters:?}");
        assert!(counters.get("pages_leaked") > 0, "seed {seed} interleaves nothing");
        let (kept, counters) = with(Order::Shuffled(seed), fragments);
        let count: usize = kept.iter().map(Vec::len).sum();
        assert_eq!(count as u64 + counters.lost(), u64::from(fragments), "seed {seed}: {counters:?}");
        assert_eq!(counters.lost(), u64::from(counters.get("pool_exhausted")), "seed {seed}");
    }
}

/// Repeated passes repair what races do, or say that they did not: where nothing was unsettled, the k least distinct keys are
/// kept, whatever the schedule.
#[test]
fn races_are_repaired_or_counted() {
    let quads: Vec<Quad> = scattered(12, 5).into_iter().map(|quad| quad.at(0, 0, SIZE, SIZE)).collect();
    let (mut settled, mut counted) = (0, 0);
    for k in [1, 4, 8] {
        let variant = technique("kb_multi", &[("k", &k.to_string())]);
        let mut keys: Vec<u32> = quads.iter().map(|quad| quad.depth.to_bits()).collect();
        keys.sort();
        keys.dedup();
        keys.truncate(k);
        for seed in 0..8 {
            let mut device = device(&variant, Order::Shuffled(seed));
            let bytes = vertices(&quads, &VertexInputs::of(device.plan()));
            let words: Vec<u32> = bytes.chunks_exact(4).map(|w| u32::from_le_bytes(w.try_into().unwrap())).collect();
            let indices: Vec<u32> = (0..6 * quads.len() as u32).collect();
            let picture = device.render(&Mesh { vertices: &words, indices: &indices }, &|_| {}).unwrap();
            if picture.counters.unwrap().get("unsettled") > 0 {
                counted += 1;
                continue;
            }
            settled += 1;
            for (pixel, kept) in kept_by(&device).into_iter().enumerate() {
                let seen: Vec<u32> = kept.iter().map(|words| words[0]).collect();
                assert_eq!(seen, keys, "k = {k}, seed {seed}, pixel {pixel}");
            }
        }
    }
    assert!(settled > 0 && counted > 0, "{settled} settled, {counted} counted");
}

/// A lock is kept by every schedule, with many fragments of a pixel in flight at a time, and no attempt is given up.
#[test]
fn locks_hold_under_any_schedule() {
    let variant = technique("kplus_array", &[("k", "8")]);
    let quads: Vec<Quad> = scattered(40, 3).into_iter().map(|quad| quad.at(0, 0, SIZE, SIZE)).collect();
    let expected = draw(&mut device(&variant, Order::Submission), &quads);
    for seed in 0..8 {
        assert!(draw(&mut device(&variant, Order::Shuffled(seed)), &quads) == expected, "seed {seed}");
    }
}

#[test]
fn without_a_lock_interleaving_loses_fragments() {
    let variant = technique("kb", &[("k", "4")]);
    let quads: Vec<Quad> = scattered(12, 5).into_iter().map(|quad| quad.at(0, 0, SIZE, SIZE)).collect();
    let expected = paint(&mut device(&variant, Order::Submission), &quads);
    let seen = paint(&mut device(&variant, Order::Shuffled(1)), &quads);
    let wrong = seen.iter().zip(&expected).filter(|(seen, expected)| seen != expected).count();
    assert!(wrong > seen.len() / 4, "{wrong} of {} pixels", seen.len());
    // The same seed is the same schedule.
    assert!(seen == paint(&mut device(&variant, Order::Shuffled(1)), &quads));
}
