//! The CPU device and the software driver keep the same fragments, word for word, on quads that cover whole pixels; and
//! interleaving the fragments of a pixel changes nothing for any technique that does not say so.

use std::collections::BTreeMap;
use std::sync::Arc;

use fragbuf_backends::target;
use fragbuf_cpu::{Code, Coverage, Device, Mesh, Order};
use fragbuf_model::Variant;
use fragbuf_runtime::{Sizing, VertexInputs};
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
    let settings =
        fragbuf_cpu::Settings { width: SIZE, height: SIZE, sizing: Sizing::Auto, order, coverage: Coverage::Samples };
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
    let names = device.plan().resources.iter().map(|planned| planned.resource.name.clone());
    let buffers: BTreeMap<String, Vec<u32>> = names.map(|name| (name.clone(), device.words(&name).unwrap())).collect();
    (kept::kept(device, &buffers), pixels)
}

/// Every technique, where there is a k with four of it.
fn techniques() -> Vec<(String, Variant)> {
    let registry = Registry::builtin();
    let variant = |key: &str, keep: KeepDefault| match keep {
        KeepDefault::All => technique(key, &[]),
        KeepDefault::Best(_) => technique(key, &[("k", "4")]),
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
