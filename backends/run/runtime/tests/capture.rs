//! Compares every technique with the oracle: the kept sets are equal, word by word, and the colours within 1/255, in every drawing
//! order.
//!
//! A software driver runs the fragments of a pixel sequentially. So `kb`, which is racy by design, is exact here too; this file does
//! not test races.

use fragbuf_model::Variant;
use fragbuf_runtime::{PoolSize, Renderer, Settings, Sizing, Value, block_on};
use fragbuf_templates::vocabulary::Capability;

use crate::oracle::{self, PLAIN, Rules, Words};
use crate::order::{Numbers, orders};
use crate::quads::{Quad, SIZE};
use crate::stage::{self, BACKGROUND, FrameResult, described, render_frame, renderer, settings, shaders, technique};

const RED: [u8; 4] = [255, 0, 0, 128];
const GREEN: [u8; 4] = [0, 255, 0, 64];
const BLUE: [u8; 4] = [0, 0, 255, 200];
const WHITE: [u8; 4] = [255, 255, 255, 255];
const GREY: [u8; 4] = [128, 128, 128, 10];

/// Returns the corner cases with their names. At most eight layers cover a pixel.
pub fn cases() -> Vec<(&'static str, Vec<Quad>)> {
    let near_to_far =
        |count: u32| (0..count).map(|index| Quad::whole((index + 1) as f32 / 16.0, [index as u8 * 30, 200, 9, 90]));
    vec![
        ("nothing", Vec::new()),
        ("one layer over some pixels", vec![Quad::whole(0.5, RED).at(3, 5, 9, 6)]),
        ("full", near_to_far(4).collect()),
        ("more than fit", near_to_far(8).collect()),
        (
            "equal depths",
            vec![Quad::whole(0.5, RED), Quad::whole(0.5, GREEN), Quad::whole(0.5, BLUE), Quad::whole(0.5, GREY)],
        ),
        (
            "equal fragments",
            vec![Quad::whole(0.5, RED), Quad::whole(0.5, RED), Quad::whole(0.5, RED), Quad::whole(0.25, RED)],
        ),
        (
            "coplanar, partly over each other",
            vec![
                Quad::whole(0.5, RED).at(0, 0, 10, 10),
                Quad::whole(0.5, GREEN).at(5, 0, 16, 10),
                Quad::whole(0.5, BLUE).at(0, 5, 16, 16),
                Quad::whole(0.5, WHITE).at(7, 7, 8, 8),
            ],
        ),
        (
            "nearest and farthest",
            vec![Quad::whole(0.0, RED), Quad::whole(1.0, BLUE), Quad::whole(1.0, GREEN), Quad::whole(0.5, GREY)],
        ),
        ("scattered", scattered(8, 7)),
        ("scattered again", scattered(8, 42)),
    ]
}

pub fn scattered(count: u32, seed: u64) -> Vec<Quad> {
    let mut numbers = Numbers::seeded(seed);
    let quad = |id| {
        let (x0, y0) = (numbers.below(SIZE), numbers.below(SIZE));
        let (x1, y1) = (x0 + 1 + numbers.below(SIZE - x0), y0 + 1 + numbers.below(SIZE - y0));
        let color = std::array::from_fn(|_| numbers.below(256) as u8);
        Quad { x0, y0, x1, y1, depth: numbers.below(8) as f32 / 8.0, color, id }
    };
    (0..count).map(quad).collect()
}

/// Returns the k of the storage; `None` if it keeps all fragments and the best are selected later.
fn stored(renderer: &Renderer) -> Option<u32> {
    let all = renderer.plan().selection.provides().contains(&Capability::KeepsAll);
    renderer.k().filter(|_| !all)
}

pub fn compare(name: &str, seen: &FrameResult, rules: &Rules, quads: &[Quad], (stored, k): (Option<u32>, Option<u32>)) {
    let expected: Vec<Vec<Words>> = oracle::kept_words(rules, quads, stored);
    for (pixel, (seen, expected)) in seen.kept.iter().zip(&expected).enumerate() {
        assert_eq!(
            seen,
            expected,
            "{name}: kept by pixel {}, {} of {quads:?}",
            pixel as u32 % SIZE,
            pixel as u32 / SIZE
        );
    }
    for (pixel, (seen, expected)) in seen.pixels.iter().zip(oracle::image(rules, quads, k, BACKGROUND)).enumerate() {
        for (seen, expected) in seen.iter().zip(expected) {
            let difference = 255.0 * (f64::from(*seen) - expected).abs();
            let (x, y) = (pixel as u32 % SIZE, pixel as u32 / SIZE);
            assert!(difference <= 1.0, "{name}: colour of pixel {x}, {y} is off by {difference}/255 for {quads:?}");
        }
    }
}

/// Checks every case in every order, with the shaders of the target `wgsl`.
fn check(variant: &Variant, settings: &Settings, rules: &Rules, prepare: impl Fn(&mut Renderer)) {
    check_as("wgsl", variant, settings, rules, prepare);
}

/// Checks every case in every order, with the shaders of a target.
pub fn check_as(target: &str, variant: &Variant, settings: &Settings, rules: &Rules, prepare: impl Fn(&mut Renderer)) {
    let stage = stage::device();
    let mut renderer = renderer(&stage, &shaders(variant, target), settings).unwrap();
    prepare(&mut renderer);
    for (name, quads) in cases() {
        let quads: Vec<Quad> = (0..).zip(quads).map(|(id, quad)| quad.named(id)).collect();
        for quads in orders(&quads) {
            let seen = render_frame(&stage, &mut renderer, &quads);
            compare(name, &seen, rules, &quads, (stored(&renderer), renderer.k()));
            let lost = ["pool_exhausted", "timed_out", "layers_exceeded"];
            assert!(lost.iter().all(|counter| seen.counters.get(counter) == 0), "{name}: {:?}", seen.counters);
        }
    }
}

#[test]
fn the_array_with_the_worst_at_slot_0() {
    check(&technique("kplus_array", &[("k", "4")]), &settings(), &PLAIN, |_| {});
}

#[test]
fn the_array_keeps_one() {
    check(&technique("kplus_array", &[("k", "1")]), &settings(), &PLAIN, |_| {});
}

#[test]
fn the_sorted_array() {
    check(&technique("kb", &[("k", "4")]), &settings(), &PLAIN, |_| {});
}

#[test]
fn the_sorted_array_keeps_one() {
    check(&technique("kb", &[("k", "1")]), &settings(), &PLAIN, |_| {});
}

#[test]
fn the_sorted_array_under_a_lock() {
    check(&technique("kb_ps", &[("k", "4")]), &settings(), &PLAIN, |_| {});
}

#[test]
fn the_heap() {
    check(&technique("kplus_heap", &[("k", "4")]), &settings(), &PLAIN, |_| {});
}

#[test]
fn heaps_of_few_and_many() {
    for k in ["1", "2", "3", "5", "7"] {
        check(&technique("kplus_heap", &[("k", k)]), &settings(), &PLAIN, |_| {});
    }
}

#[test]
fn the_cascade() {
    for k in ["1", "4"] {
        check(&technique("mdt32_coplanar", &[("k", k)]), &settings(), &PLAIN, |_| {});
    }
}

#[test]
fn the_array_whose_first_fragments_need_no_lock() {
    for k in ["1", "2", "4"] {
        check(&technique("kplus_array_revised", &[("k", k)]), &settings(), &PLAIN, |_| {});
    }
}

/// Portable WGSL has no 64-bit atomics.
#[test]
fn the_cascade_of_64_bits() {
    for k in ["1", "4"] {
        check_as("wgsl-native", &technique("kb_mdt64", &[("k", k)]), &settings(), &PLAIN, |_| {});
    }
}

#[test]
fn the_sorted_list() {
    for k in ["1", "4", "8"] {
        check(&technique("kb_ll", &[("k", k)]), &settings(), &PLAIN, |_| {});
    }
}

/// Tests pixels with fewer fragments than k, as many, and more; with arrays, and with heaps where allowed.
#[test]
fn regions_of_the_kept_fragments() {
    for (k, array) in [("1", "16"), ("3", "16"), ("4", "16"), ("1", "0"), ("3", "0"), ("4", "0")] {
        let set = [("k", k), ("storage.array", array)];
        let exact = Settings { sizing: Sizing::Exact, ..settings() };
        check(&technique("kplus_ab_sb", &set), &exact, &PLAIN, |_| {});
    }
    let reserved = Sizing::Reserve(PoolSize::Fragments(4 * SIZE * SIZE));
    check(&technique("kplus_ab_sb", &[("k", "4")]), &Settings { sizing: reserved, ..settings() }, &PLAIN, |_| {});
}

#[test]
fn the_fixed_array() {
    check(&technique("ab_array", &[]), &settings(), &PLAIN, |_| {});
}

#[test]
fn the_best_of_all_are_selected_on_resolve() {
    for key in ["kb_ab_array", "kb_ab_ll", "kb_ab_sb"] {
        check(&technique(key, &[("k", "3")]), &settings(), &PLAIN, |_| {});
    }
}

/// Tests one storage of each kind: the words have other addresses and equal values.
#[test]
fn every_addressing() {
    for addressing in ["tiled", "morton"] {
        for (key, k) in [
            ("kplus_array", "4"),
            ("mdt32_coplanar", "4"),
            ("kb_ll", "4"),
            ("kplus_ab_sb", "3"),
            ("ab_array", "all"),
            ("ab_ll", "all"),
            ("ab_sb", "all"),
        ] {
            check(&technique(key, &[("k", k), ("addressing", addressing)]), &settings(), &PLAIN, |_| {});
        }
    }
}

#[test]
fn the_linked_list() {
    check(&technique("ab_ll", &[]), &settings(), &PLAIN, |_| {});
}

/// Tests pages of one fragment, and of fewer, as many and more than a pixel has.
#[test]
fn the_list_of_pages() {
    for page in ["1", "2", "3", "4", "8", "9"] {
        check(&technique("ab_ll_paged", &[("storage.page", page)]), &settings(), &PLAIN, |_| {});
    }
}

#[test]
fn the_lists_per_depth_bucket() {
    for sort in ["insertion", "bitonic"] {
        check(&technique("ab_ll_bun", &[("sort", sort)]), &settings(), &PLAIN, |_| {});
    }
}

#[test]
fn exact_regions_sized_by_the_host_step() {
    check(&technique("ab_sb", &[]), &Settings { sizing: Sizing::Exact, ..settings() }, &PLAIN, |_| {});
}

#[test]
fn exact_regions_reserved() {
    let reserved = Sizing::Reserve(PoolSize::Fragments(8 * SIZE * SIZE));
    check(&technique("ab_sb", &[]), &Settings { sizing: reserved, ..settings() }, &PLAIN, |_| {});
}

#[test]
fn k_below_the_capacity() {
    for k in [1, 2, 3, 5, 7, 8] {
        for key in ["kplus_array", "kb", "kplus_array_revised", "kb_ll", "kplus_ab_sb"] {
            let set_k = |renderer: &mut Renderer| {
                let device = renderer.device().clone();
                block_on(&device, renderer.set_k(k)).unwrap().unwrap();
                assert_eq!((renderer.k(), renderer.capacity()), (Some(k), 8));
            };
            check(&technique(key, &[("k", "5")]), &settings(), &PLAIN, set_k);
        }
    }
}

/// A description with a payload, a criterion, a constraint, uniforms and an effect.
const GLASS: &str = "
    buffer Glass from TECHNIQUE {
        fragment { color: rgba8, depth: f32, id: u32 }
        uniform { cut: f32, gain: vec4 }
        KEEP
        where |f, u| f.depth > u.cut;
        resolve |fragments, u| {
            let mut sum = Vec4::ZERO;
            let mut weight = 1.0;
            for f in fragments {
                if f.id % 2 == 0 {
                    sum += f.color * (weight * u.gain.x);
                } else {
                    sum += f.color * (weight * u.gain.w);
                }
                weight *= 0.5;
            }
            sum
        }
    }";

/// Depth − alpha / 4: an opaque fragment may be kept though a nearer one is not.
pub const GLASS_KEEPS: &str = "keep 3 least |f| f.depth - 0.25 * f.color.w;";

const GAIN: [f32; 4] = [0.25, 9.0, 9.0, 0.125];
const CUT: f32 = 0.125;

pub fn glass(technique: &str, keep: &str) -> Variant {
    described(&GLASS.replace("TECHNIQUE", technique).replace("KEEP", keep))
}

pub fn glass_resolve(kept: &[Quad]) -> [f64; 4] {
    let mut sum = [0.0; 4];
    let mut weight = 1.0;
    for quad in kept {
        let gain = f64::from(if quad.id % 2 == 0 { GAIN[0] } else { GAIN[3] });
        for (sum, channel) in sum.iter_mut().zip(quad.color) {
            *sum += f64::from(channel) / 255.0 * weight * gain;
        }
        weight *= 0.5;
    }
    sum
}

pub fn set_uniforms(renderer: &mut Renderer) {
    renderer.set_uniform("cut", Value::F32(CUT)).unwrap();
    renderer.set_uniform("gain", Value::Vec4(GAIN)).unwrap();
}

#[test]
fn a_description_with_a_criterion() {
    fn criterion(quad: &Quad) -> u32 {
        let bits = (quad.depth - 0.25 * quad.rgba()[3]).to_bits();
        if bits >> 31 == 0 { bits | 1 << 31 } else { !bits }
    }
    let rules = Rules {
        admits: |quad| quad.depth > CUT,
        words: |quad| vec![criterion(quad), u32::from_le_bytes(quad.color), quad.depth.to_bits(), quad.id],
        nearer: |quad| vec![quad.depth.to_bits(), u32::from_le_bytes(quad.color), quad.id, criterion(quad)],
        resolve: glass_resolve,
    };
    let keep = GLASS_KEEPS;
    for key in ["kplus_array", "kplus_heap", "kb_ab_ll", "kplus_array_revised", "kplus_ab_sb"] {
        check(&glass(key, keep), &settings(), &rules, set_uniforms);
    }
    // Three passes refine the three value words, and fragments are in the order of the criterion.
    check(&glass("mdt32_coplanar", &format!("{keep} sort: insertion;")), &settings(), &rules, set_uniforms);
    // The sorted array and the list are in the order of the criterion, which is not the order of depth.
    for key in ["kb", "kb_ll"] {
        check(&glass(key, &format!("{keep} sort: insertion;")), &settings(), &rules, set_uniforms);
    }
}

#[test]
fn a_description_that_keeps_all() {
    let rules = Rules {
        admits: |quad| quad.depth > CUT,
        words: |quad| vec![quad.depth.to_bits(), u32::from_le_bytes(quad.color), quad.id],
        nearer: |quad| vec![quad.depth.to_bits(), u32::from_le_bytes(quad.color), quad.id],
        resolve: glass_resolve,
    };
    for key in ["ab_ll", "ab_sb", "ab_array", "ab_ll_paged", "ab_ll_bun"] {
        check(&glass(key, ""), &settings(), &rules, set_uniforms);
    }
}
