//! Storages that lose fragments by what they are, and say so: what is lost is what they state, and nothing else.

use std::collections::BTreeMap;

use fragbuf_model::Variant;

use crate::capture::{compare, scattered};
use crate::oracle::{self, PLAIN, Rules, Words};
use crate::order::orders;
use crate::quads::{Quad, SIZE};
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
    for k in [1, 3, 8] {
        let variant = technique("kb_mdt32", &[("k", &k.to_string()), ("counters", "all")]);
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
