//! Occupancy culling before every storage that accepts the k best only: kept sets and images do not change, and culled fragments are
//! counted.

use fragbuf_cpu::FragmentOrder;
use fragbuf_model::Variant;
use fragbuf_runtime::{PoolSize, Renderer, Settings, Sizing, block_on};

use crate::capture::{GLASS_KEEPS, cases, compare, glass, glass_resolve, scattered, set_uniforms};
use crate::cpu_device::{device, draw};
use crate::oracle::{self, PLAIN, Rules, Words};
use crate::order::{Numbers, orders};
use crate::quads::{Quad, SIZE};
use crate::stage::{self, FrameResult, render_frame, renderer, settings, shaders, technique};

/// Techniques, each with a target that supports it.
const COMPOSED: [(&str, &str); 9] = [
    ("kplus_array", "wgsl"),
    ("kplus_heap", "wgsl"),
    ("kplus_array_revised", "wgsl"),
    ("kplus_ab_sb", "wgsl"),
    ("kb_ps", "wgsl"),
    ("kb_ll", "wgsl"),
    ("mdt32_coplanar", "wgsl"),
    ("kb_mdt64", "wgsl-native"),
    ("kb_ab_ll", "wgsl"),
];

/// Returns scenes of many layers: spread out, within a few units in the last place of bucket edges, of few depths, all but one
/// equal, and scattered.
fn deep() -> Vec<(&'static str, Vec<Quad>)> {
    let mut numbers = Numbers::seeded(5);
    let mut layers = |count: u32, depth: &dyn Fn(&mut Numbers) -> f32| -> Vec<Quad> {
        let color = |index: u32| [index as u8, 255 - index as u8, 40, 60];
        (0..count).map(|index| Quad::whole(depth(&mut numbers), color(index))).collect()
    };
    let near = |bits: u32, numbers: &mut Numbers| f32::from_bits(bits - 2 + numbers.below(5));
    let ends = |quads: Vec<Quad>| {
        [vec![Quad::whole(0.5, [9, 9, 9, 9]), Quad::whole(1.0 - f32::EPSILON / 2.0, [8, 8, 8, 8])], quads].concat()
    };
    vec![
        ("spread", layers(40, &|numbers| 0.5 + numbers.below(1 << 20) as f32 / (1 << 21) as f32)),
        // There are 2^23 depths between 0.5 and 1: 2^18 for each of 32 buckets.
        (
            "at bucket edges",
            ends(layers(30, &|numbers| {
                let edge = 0.5f32.to_bits() + (numbers.below(31) + 1) * (1 << 18);
                near(edge, numbers)
            })),
        ),
        ("few depths", ends(layers(30, &|numbers| 0.5 + numbers.below(4) as f32 / 8.0))),
        ("one behind", [layers(20, &|_| 0.25), layers(1, &|_| 0.75)].concat()),
        ("scattered", scattered(30, 11)),
    ]
}

/// Compares every scene with the oracle, and returns the number of culled fragments.
fn check(variant: &Variant, language: &str, rules: &Rules, prepare: impl Fn(&mut Renderer)) -> u32 {
    let stage = stage::device();
    // Lists allocate a node for every fragment, kept or not.
    let sizing = Sizing::Capacity(PoolSize::Fragments(48 * SIZE * SIZE));
    let settings = Settings { sizing, ..settings() };
    let mut renderer = renderer(&stage, &shaders(variant, language), &settings).unwrap();
    prepare(&mut renderer);
    let mut culled = 0;
    let all = cases().into_iter().map(|(name, quads)| (name, orders(&quads).into_iter().take(3).collect()));
    let many = deep().into_iter().map(|(name, quads)| (name, orders(&quads).into_iter().take(2).collect::<Vec<_>>()));
    for (name, in_orders) in all.chain(many) {
        for quads in in_orders {
            let quads: Vec<Quad> = (0..).zip(quads).map(|(id, quad)| quad.named(id)).collect();
            let seen = k_best(render_frame(&stage, &mut renderer, &quads), renderer.k());
            compare(name, &seen, rules, &quads, (renderer.k(), renderer.k()));
            let lost = ["pool_exhausted", "timed_out", "layers_exceeded", "equal_keys"];
            assert!(lost.iter().all(|counter| seen.counters.get(counter) == 0), "{name}: {:?}", seen.counters);
            let count = |name: &str| seen.counters.get(name);
            let generated = oracle::total(rules, &quads) as u32;
            let kept: u32 = oracle::kept_words(rules, &quads, renderer.k()).iter().map(|kept| kept.len() as u32).sum();
            assert_eq!(count("generated"), generated, "{name}");
            assert_eq!(count("culled") + count("displaced") + kept, generated, "{name}: {:?}", seen.counters);
            culled += count("culled");
        }
    }
    culled
}

/// Returns the k best fragments of a storage, which holds more if the best are selected later.
fn k_best(mut seen: FrameResult, k: Option<u32>) -> FrameResult {
    seen.kept.iter_mut().for_each(|kept: &mut Vec<Words>| kept.truncate(k.map_or(usize::MAX, |k| k as usize)));
    seen
}

#[test]
fn the_kept_set_is_the_same_with_every_storage() {
    for (key, language) in COMPOSED {
        let culled = [("1", "1"), ("4", "1"), ("4", "4")].map(|(k, words)| {
            let set = [("k", k), ("cull", "occupancy"), ("cull.words", words), ("counters", "all")];
            check(&technique(key, &set), language, &PLAIN, |_| {})
        });
        println!("{key}: {culled:?} culled");
        assert!(culled[0] > culled[2] && culled[2] > culled[1] && culled[1] > 10_000, "{key}: {culled:?}");
    }
}

/// Fragments that fail a constraint set no bits, because nearer ones would end the range too early.
#[test]
fn constraints_and_criteria_hold_in_every_pass() {
    fn criterion(quad: &Quad) -> u32 {
        let bits = (quad.depth - 0.25 * quad.rgba()[3]).to_bits();
        if bits >> 31 == 0 { bits | 1 << 31 } else { !bits }
    }
    let words: fn(&Quad) -> Words =
        |quad| vec![criterion(quad), u32::from_le_bytes(quad.color), quad.depth.to_bits(), quad.id];
    for key in ["kplus_array", "kplus_ab_sb", "kb_ll"] {
        let extra = "sort: insertion; cull: occupancy { words: 1 }; counters: all;";
        let text = format!("{GLASS_KEEPS} {extra}");
        let rules = Rules {
            admits: |quad| quad.depth > 0.125,
            words,
            nearer: |quad| vec![quad.depth.to_bits(), u32::from_le_bytes(quad.color), quad.id, criterion(quad)],
            resolve: glass_resolve,
        };
        assert!(check(&glass(key, &text), "wgsl", &rules, set_uniforms) > 5_000, "{key}");
    }
}

#[test]
fn any_k_up_to_the_capacity_works() {
    for k in [1, 2, 3, 5, 7, 8] {
        let set_k = |renderer: &mut Renderer| {
            let device = renderer.device().clone();
            block_on(&device, renderer.set_k(k)).unwrap().unwrap();
        };
        let set = [("k", "8"), ("cull", "occupancy"), ("counters", "all")];
        check(&technique("kplus_array", &set), "wgsl", &PLAIN, set_k);
    }
}

#[test]
fn slices_cull_the_same_fragments() {
    let stage = stage::device();
    let variant = technique("kplus_array", &[("k", "4"), ("cull", "occupancy"), ("counters", "all")]);
    let quads = [deep().remove(0).1, scattered(20, 23)].concat();
    let culled = [None, Some(5)].map(|slice| {
        let settings = Settings { slice, ..settings() };
        let mut renderer = renderer(&stage, &shaders(&variant, "wgsl"), &settings).unwrap();
        let offscreen = fragbuf_runtime::headless::Offscreen::new(&stage.device, stage::FORMAT, SIZE, SIZE).unwrap();
        stage::draw_over(&stage, &mut renderer, &quads, &offscreen).unwrap();
        let pixels = offscreen.colors(&stage.device, &stage.queue).unwrap();
        (pixels, stage::read_counters(&stage, &renderer).get("culled"))
    });
    assert!(culled[0].1 > 500, "{}", culled[0].1);
    assert!(culled[0] == culled[1]);
}

/// Techniques that support culling by a depth test.
const TESTED: [&str; 6] = ["kplus_array", "kplus_heap", "kplus_ab_sb", "kb_ps", "mdt32_coplanar", "kb_mdt64"];

#[test]
fn a_drivers_depth_test_rejects_none_of_the_best() {
    let stage = stage::device();
    for key in TESTED {
        let variant = technique(key, &[("k", "4"), ("cull", "occupancy_early"), ("counters", "all")]);
        let mut renderer = renderer(&stage, &shaders(&variant, "wgsl-native"), &settings()).unwrap();
        let mut drawn = 0;
        for (name, quads) in cases().into_iter().chain(deep()) {
            for quads in orders(&quads).into_iter().take(2) {
                let seen = k_best(render_frame(&stage, &mut renderer, &quads), renderer.k());
                compare(name, &seen, &PLAIN, &quads, (renderer.k(), renderer.k()));
                drawn += oracle::total(&PLAIN, &quads) as u32 - seen.counters.get("generated");
            }
        }
        assert!(drawn > 1000, "{key}: the depth test rejected {drawn} fragments before the shader");
    }
}

#[test]
fn a_depth_test_rejects_before_the_shader() {
    for key in TESTED {
        let set = [("k", "4"), ("cull", "occupancy_early"), ("counters", "all")];
        let mut device = device(&technique(key, &set), FragmentOrder::Submission);
        let (mut seen, mut drawn) = (0, 0);
        for (name, quads) in cases().into_iter().chain(deep()) {
            for quads in orders(&quads).into_iter().take(2) {
                let kept = draw(&mut device, &quads).0;
                assert_eq!(kept, oracle::kept_words(&PLAIN, &quads, Some(4)), "{key}, {name}: {quads:?}");
                seen += device.words("counters").unwrap()[0];
                drawn += oracle::total(&PLAIN, &quads) as u32;
            }
        }
        println!("{key}: the shader runs for {seen} of {drawn}");
        assert!(seen < drawn * 3 / 4, "{key}: the shader runs for {seen} of {drawn}");
    }
}
