//! Compares every sort with the oracle, for many layers. The colour of a pixel is a checksum over the identities of its fragments in
//! order, so that any two swapped fragments change it.

use std::sync::Arc;

use fragbuf_cpu::{Code, Device, Mesh};
use fragbuf_model::Variant;
use fragbuf_runtime::{PoolSize, Settings, Sizing};
use fragbuf_templates::Registry;
use fragbuf_templates::vocabulary::Capability;

use crate::capture::{compare, scattered};
use crate::oracle::Rules;
use crate::order::Numbers;
use crate::quads::{Quad, SIZE, vertices};
use crate::stage::{described, device, render_frame, renderer, settings, shaders, technique};

/// Each step multiplies the sum and adds the next identity, so the order matters. 12 bits of it become a colour of 16 levels per
/// channel, which rounding cannot confuse.
const CHECKSUM: &str = "
    buffer Checksum from ab_ll {
        fragment { color: rgba8, depth: f32, id: u32 }
        sort: SORT;
        resolve |fragments, u| {
            let mut sum = 1;
            for f in fragments {
                sum = (sum * 33 + f.id + 1) % 65521;
            }
            vec4((sum % 16) as f32 / 15.0, (sum / 16 % 16) as f32 / 15.0, (sum / 256 % 16) as f32 / 15.0, 1.0)
        }
    }";

fn rules() -> Rules {
    fn words(quad: &Quad) -> Vec<u32> {
        vec![quad.depth.to_bits(), u32::from_le_bytes(quad.color), quad.id]
    }
    Rules {
        admits: |_| true,
        words,
        nearer: words,
        resolve: |kept| {
            let sum = kept.iter().fold(1u32, |sum, quad| (sum * 33 + quad.id + 1) % 65521);
            [sum % 16, sum / 16 % 16, sum / 256 % 16, 15].map(|level| f64::from(level) / 15.0)
        },
    }
}

/// Returns the rules of a resolve pass that holds the nearest eight layers.
fn rules_of_eight() -> Rules {
    Rules { resolve: |kept| (rules().resolve)(&kept[..kept.len().min(8)]), ..rules() }
}

/// Returns every row that sorts, and the hybrid with each of its two algorithms only.
fn sorts() -> Vec<String> {
    let registry = Registry::builtin();
    let sorts = registry.rows_of("sort").filter(|row| row.provides.contains(&Capability::Sorted));
    let mut choices: Vec<String> = sorts.map(|row| row.key.clone()).collect();
    assert!(choices.len() >= 4, "{choices:?}");
    let more = ["hybrid { insertion: 0 }", "hybrid { insertion: 4096 }", "lplus { batch: 1 }", "lplus { batch: 7 }"];
    choices.extend(more.map(str::to_owned));
    choices
}

/// Whether the parameter `layers` limits the layers of a sort.
fn is_bounded(sort: &str) -> bool {
    let key = sort.split(' ').next().unwrap();
    Registry::builtin().row("sort", key).unwrap().parameters.iter().any(|parameter| parameter.name == "layers")
}

fn with_layers(sort: &str, layers: u32) -> Variant {
    let sort = match sort.strip_suffix(" }") {
        _ if !is_bounded(sort) => sort.to_owned(),
        Some(options) => format!("{options}, layers: {layers} }}"),
        None => format!("{sort} {{ layers: {layers} }}"),
    };
    described(&CHECKSUM.replace("SORT", &sort))
}

/// Returns `count` layers over the whole frame in random order, some with equal depths, and some of those with equal colours.
fn layers(count: u32, seed: u64) -> Vec<Quad> {
    let mut numbers = Numbers::seeded(seed);
    let quad = |id| {
        let color = [numbers.below(2) as u8 * 255, 0, 0, 255];
        Quad::whole(numbers.below(1 + count / 2) as f32 / 64.0, color).named(id)
    };
    let mut quads: Vec<Quad> = (0..count).map(quad).collect();
    for index in (1..quads.len()).rev() {
        quads.swap(index, numbers.below(index as u32 + 1) as usize);
    }
    quads
}

fn roomy() -> Settings {
    Settings { sizing: Sizing::Capacity(PoolSize::Fragments(64 * SIZE * SIZE)), ..settings() }
}

#[test]
fn every_sort_orders_any_number_of_layers() {
    let stage = device();
    for sort in sorts() {
        let mut renderer = renderer(&stage, &shaders(&with_layers(&sort, 64), "wgsl"), &roomy()).unwrap();
        let mut scenes: Vec<Vec<Quad>> =
            [1, 2, 3, 4, 5, 8, 15, 16, 17, 31, 32, 33, 63, 64].into_iter().map(|count| layers(count, 5)).collect();
        // Random quads: pixels have different numbers of fragments.
        scenes.extend([scattered(64, 3), scattered(64, 4), layers(64, 6), Vec::new()]);
        for quads in scenes {
            let seen = render_frame(&stage, &mut renderer, &quads);
            compare(&sort, &seen, &rules(), &quads, (None, None));
            assert_eq!(seen.counters.lost(), 0, "{sort}: {:?}", seen.counters);
        }
    }
}

#[test]
fn every_limited_sort_keeps_the_nearest_layers() {
    let stage = device();
    for sort in sorts().iter().filter(|sort| is_bounded(sort)) {
        let mut renderer = renderer(&stage, &shaders(&with_layers(sort, 8), "wgsl"), &roomy()).unwrap();
        for quads in [layers(9, 1), layers(40, 2), scattered(64, 5)] {
            let seen = render_frame(&stage, &mut renderer, &quads);
            compare(sort, &seen, &rules_of_eight(), &quads, (None, None));
            let beyond = |pixel: &Vec<_>| pixel.len().saturating_sub(8) as u32;
            assert_eq!(seen.counters.get("layers_exceeded"), seen.kept.iter().map(beyond).sum::<u32>(), "{sort}");
        }
    }
}

/// Tests more layers than the arrays of the other sorts can hold.
#[test]
fn unlimited_sorts_omit_no_layer() {
    let stage = device();
    let free: Vec<String> = sorts().into_iter().filter(|sort| !is_bounded(sort)).collect();
    assert!(!free.is_empty());
    for sort in free {
        let sizing = Sizing::Capacity(PoolSize::Fragments(200 * SIZE * SIZE));
        let settings = Settings { sizing, ..settings() };
        let mut renderer = renderer(&stage, &shaders(&with_layers(&sort, 0), "wgsl"), &settings).unwrap();
        // Many equal depths and colours, then 90 equal fragments.
        let equal = vec![Quad::whole(0.5, [9, 9, 9, 255]).named(3); 90];
        for quads in [layers(128, 1), layers(97, 2), layers(65, 3), equal] {
            let seen = render_frame(&stage, &mut renderer, &quads);
            compare(&sort, &seen, &rules(), &quads, (None, None));
            assert_eq!(seen.counters.lost(), 0, "{sort}: {:?}", seen.counters);
        }
    }
}

/// Reads the farthest first, and with each fragment another one: sorts that read on demand must support any access order.
#[test]
fn effects_may_read_backwards() {
    const BACK: &str = "
        let mut sum = 1;
        for (i, f) in fragments.iter().enumerate().rev() {
            sum = (sum * 33 + f.id + 1 + fragments[i / 2].id) % 65521;
        }";
    let stage = device();
    let rules = Rules {
        resolve: |kept| {
            let step = |sum: u32, index: usize| (sum * 33 + kept[index].id + 1 + kept[index / 2].id) % 65521;
            let sum = (0..kept.len()).rev().fold(1, step);
            [sum % 16, sum / 16 % 16, sum / 256 % 16, 15].map(|level| f64::from(level) / 15.0)
        },
        ..rules()
    };
    let forward = CHECKSUM.split("let mut sum").nth(1).unwrap().split("vec4").next().unwrap();
    for sort in sorts() {
        let sort_option =
            if is_bounded(&sort) && !sort.contains('{') { format!("{sort} {{ layers: 64 }}") } else { sort.clone() };
        let source = CHECKSUM.replace(&format!("let mut sum{forward}"), BACK).replace("SORT", &sort_option);
        assert!(source.contains("rev()"));
        let mut renderer = renderer(&stage, &shaders(&described(&source), "wgsl"), &roomy()).unwrap();
        // A software driver stops loops after 65,535 iterations in all, and batches of one are read again for every step back.
        for quads in [layers(1, 1), layers(30, 2), scattered(40, 5)] {
            compare(&sort, &render_frame(&stage, &mut renderer, &quads), &rules, &quads, (None, None));
        }
    }
}

/// Passes per size class resolve and count no pixel twice.
#[test]
fn passes_per_size_class_count_once() {
    let stage = device();
    for key in ["kb_ll", "kb_ab_ll"] {
        let counted = |sort: &str| {
            let set = [("k", "20"), ("counters", "all"), ("sort", sort)];
            let mut renderer = renderer(&stage, &shaders(&technique(key, &set), "wgsl"), &roomy()).unwrap();
            [layers(40, 1), scattered(64, 2)].map(|quads| {
                let seen = render_frame(&stage, &mut renderer, &quads);
                (seen.pixels, seen.counters)
            })
        };
        let expected = counted("insertion");
        assert!(expected[0].1.get("displaced") > 0);
        for sort in ["lplus", "block", "backwards_memory"] {
            assert!(counted(sort) == expected, "{key} with {sort}");
        }
    }
}

/// l⁺ sorts any number of fragments in the memory of one batch, equal depths included (K15 §4.4). On the CPU device: software drivers
/// stop loops after 65,535 iterations.
#[test]
fn a_batch_of_32_sorts_1024_fragments() {
    let variant = described(&CHECKSUM.replace("SORT", "lplus"));
    let resolve = shaders(&variant, "wgsl");
    let batch = resolve.plan.constants.iter().find(|(name, _)| name == "LPLUS_BATCH").unwrap();
    assert_eq!(batch.1, 32);
    let stage = device();
    let inputs = renderer(&stage, &resolve, &settings()).unwrap();
    let inputs = inputs.vertex_inputs();
    let code = Arc::new(Code::of(&variant, &Registry::builtin()).unwrap_or_else(|error| panic!("{error}")));
    for count in [33, 128, 1024] {
        let sizing = Sizing::Capacity(PoolSize::Fragments(count));
        let mut cpu =
            Device::new(code.clone(), fragbuf_cpu::Settings { sizing, ..fragbuf_cpu::Settings::new(1, 1) }).unwrap();
        let mut numbers = Numbers::seeded(count.into());
        // A quarter of the depths occur several times.
        let quad = |id: u32| Quad {
            depth: numbers.below(count / 2) as f32 / count as f32,
            ..Quad::whole(0.0, [1, 2, 3, 4]).named(id)
        };
        let mut quads: Vec<Quad> = (0..count).map(quad).collect();
        let bytes = vertices(&quads, inputs);
        let words: Vec<u32> = bytes.chunks_exact(4).map(|word| u32::from_le_bytes(word.try_into().unwrap())).collect();
        let indices: Vec<u32> = (0..6 * count).collect();
        let picture = cpu.render(&Mesh { vertices: &words, indices: &indices }, &|_| {}).unwrap();
        quads.sort_by_key(|quad| (rules().nearer)(quad));
        let expected = (rules().resolve)(&quads);
        for (seen, expected) in picture.pixels[0].iter().zip(expected) {
            assert!(
                (f64::from(*seen) - expected).abs() < 1.0 / 255.0,
                "{count}: {:?}, not {expected:?}",
                picture.pixels[0]
            );
        }
    }
}
