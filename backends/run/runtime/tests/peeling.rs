//! Peeling: the image is that of an A-buffer, bit for bit, for every storage that can be peeled, after no more iterations than the
//! deepest pixel has groups of k fragments or layers. On the driver and on the CPU device.

use std::collections::BTreeSet;
use std::sync::Arc;

use fragbuf_cpu::{Code, Device, Mesh};
use fragbuf_model::{AxisChoice, Variant};
use fragbuf_runtime::headless::{Headless, Offscreen};
use fragbuf_runtime::{Counters, LoopEnd, LoopReport, Output, PoolSize, Settings, Shaders, Sizing};
use fragbuf_templates::Registry;
use fragbuf_templates::vocabulary::Feature;

use crate::drivers::scene::{Quad, first_difference, image, vertices};
use crate::order::Numbers;
use crate::stage::{BACKGROUND, FORMAT, device, read_counters, renderer, shaders, technique, vertex_buffer};

/// Odd on purpose, and drawn whole and in slices.
pub(crate) const SIZE: [u32; 2] = [13, 7];
pub(crate) const SLICES: [Option<u32>; 2] = [None, Some(3)];

/// A technique, changes of it, and the greatest k.
type Peeled = (&'static str, &'static [(&'static str, &'static str)], u32);

const STORAGES: [Peeled; 9] = [
    ("kplus_array", &[], 8),
    ("kplus_heap", &[], 8),
    ("kplus_array_revised", &[], 8),
    ("kb_ps", &[("sync", "spin_lock")], 8),
    ("mdt32_coplanar", &[], 8),
    ("kb_ll", &[], 8),
    ("kplus_ab_sb", &[], 8),
    ("kplus_array", &[("cull", "occupancy")], 8),
    ("kplus_array", &[("storage", "single")], 1),
];

/// Returns quads of which many have the depth of others.
pub(crate) fn scene(seed: u64, count: u32) -> Vec<Quad> {
    let mut numbers = Numbers::seeded(seed);
    let quad = |id| Quad {
        x: [numbers.below(SIZE[0]), SIZE[0]],
        y: [0, 1 + numbers.below(SIZE[1])],
        depth: [0.0, 0.25, 0.5, 1.0][numbers.below(4) as usize],
        color: std::array::from_fn(|_| numbers.below(256) as u8),
        id,
    };
    (0..count).map(quad).collect()
}

/// Gives half of the quads the depth and colour of another, so that their fragments are equal in every word.
fn with_copies(mut quads: Vec<Quad>, seed: u64) -> Vec<Quad> {
    let mut numbers = Numbers::seeded(seed);
    for at in (1..quads.len()).step_by(2) {
        let other = quads[numbers.below(at as u32) as usize];
        quads[at] = Quad { color: other.color, depth: other.depth, ..quads[at] };
    }
    quads
}

/// Returns the number of fragments of the deepest pixel in these rows.
fn deepest(quads: &[Quad], rows: std::ops::Range<u32>) -> u32 {
    let covers = |quad: &Quad, x, y| (quad.x[0]..quad.x[1]).contains(&x) && (quad.y[0]..quad.y[1]).contains(&y);
    let count = |x, y| quads.iter().filter(|quad| covers(quad, x, y)).count() as u32;
    rows.flat_map(|y| (0..SIZE[0]).map(move |x| (x, y))).map(|(x, y)| count(x, y)).max().unwrap_or(0)
}

/// Returns enough memory for the pool of a list, which no pass counts for.
pub(crate) fn sizing(variant: &Variant) -> Sizing {
    let pools = ["ordered_list", "linked_list", "paged_list", "bucket_lists", "fixed_array", "claimed_array"];
    let has_pool = variant.choices.iter().any(|chosen| pools.contains(&&*chosen.alternatives[0].row.key));
    if has_pool { Sizing::Capacity(PoolSize::Fragments(64 * SIZE[0] * SIZE[1])) } else { Sizing::Auto }
}

/// Draws on the driver; returns the pixels, the reports of loops, and the fragments counted as generated and lost.
fn drawn(
    stage: &Headless,
    variant: &Variant,
    quads: &[Quad],
    slice: Option<u32>,
) -> (Vec<[f32; 4]>, Vec<LoopReport>, [u64; 2]) {
    let (pixels, loops, counters) = counted(stage, variant, quads, slice);
    (pixels, loops, [u64::from(counters.get("generated")), counters.lost()])
}

/// Returns the shaders in portable WGSL, or in native WGSL if they need an early depth test.
pub(crate) fn shaders_of(variant: &Variant) -> Shaders {
    let needs_native = |chosen: &AxisChoice| chosen.alternatives[0].row.needs.contains(&Feature::EarlyDepth);
    shaders(variant, if variant.choices.iter().any(needs_native) { "wgsl-native" } else { "wgsl" })
}

/// Draws on the driver; returns the pixels, the reports of loops, and the counters.
pub(crate) fn counted(
    stage: &Headless,
    variant: &Variant,
    quads: &[Quad],
    slice: Option<u32>,
) -> (Vec<[f32; 4]>, Vec<LoopReport>, Counters) {
    let settings = Settings { slice, sizing: sizing(variant), ..Settings::new(FORMAT, SIZE[0], SIZE[1]) };
    let mut renderer = renderer(stage, &shaders_of(variant), &settings).unwrap();
    let inputs: Vec<&str> = renderer.vertex_inputs().inputs.iter().map(|input| input.name.as_str()).collect();
    let buffer = vertex_buffer(stage, &vertices(quads, SIZE, &inputs));
    let offscreen = Offscreen::new(&stage.device, FORMAT, SIZE[0], SIZE[1]).unwrap();
    let [r, g, b] = BACKGROUND;
    let output = Output { view: offscreen.view(), load: wgpu::LoadOp::Clear(wgpu::Color { r, g, b, a: 1.0 }) };
    let loops = renderer.render(&output, &mut |pass, _| {
        pass.set_vertex_buffer(0, buffer.slice(..));
        pass.draw(0..6 * quads.len() as u32, 0..1);
    });
    let loops = loops.unwrap();
    let counters = read_counters(stage, &renderer);
    let pixels = offscreen.colors(&stage.device, &stage.queue).unwrap();
    (pixels, loops, counters)
}

/// Draws on the CPU device; returns the bits of the pixels.
pub(crate) fn drawn_on_cpu(variant: &Variant, quads: &[Quad]) -> Vec<[u32; 4]> {
    let code = Arc::new(Code::of(variant, &Registry::builtin()).unwrap_or_else(|error| panic!("{error}")));
    let settings = fragbuf_cpu::Settings { sizing: sizing(variant), ..fragbuf_cpu::Settings::new(SIZE[0], SIZE[1]) };
    let mut cpu = Device::new(code, settings).unwrap();
    let inputs = ["position", "color"];
    let bytes = vertices(quads, SIZE, &inputs);
    let words: Vec<u32> = bytes.chunks_exact(4).map(|word| u32::from_le_bytes(word.try_into().unwrap())).collect();
    let indices: Vec<u32> = (0..6 * quads.len() as u32).collect();
    let picture = cpu.render(&Mesh { vertices: &words, indices: &indices }, &|_| {}).unwrap();
    picture.pixels.iter().map(|pixel| pixel.map(f32::to_bits)).collect()
}

#[test]
fn peeled_storages_equal_the_a_buffer_bit_for_bit() {
    let stage = device();
    let a_buffer = technique("ab_sb", &[("counters", "all"), ("sort", "insertion"), ("sort.layers", "64")]);
    let mut numbers = Numbers::seeded(9);
    for (key, more, most) in STORAGES {
        for k in [1, 3, 8].into_iter().filter(|k| *k <= most) {
            let k_text = k.to_string();
            let set: Vec<(&str, &str)> = [("k", k_text.as_str()), ("peeling", "k_layers"), ("counters", "all")]
                .into_iter()
                .chain(more.iter().copied())
                .collect();
            let variant = technique(key, &set);
            for (seed, count) in [(u64::from(k), 17), (7, 40), (8, 0)] {
                let mut quads = scene(seed, count);
                // Iterations count copies of their last fragment, so copies can only make the loop end earlier.
                let has_copies = count > 17;
                if has_copies {
                    quads = with_copies(quads, seed);
                }
                for slice in SLICES {
                    let what = format!("{key} {set:?}, {count} quads, slices of {slice:?} rows");
                    let (expected, _, [generated, _]) = drawn(&stage, &a_buffer, &quads, None);
                    let (seen, loops, counted) = drawn(&stage, &variant, &quads, slice);
                    assert!(
                        seen == expected,
                        "{what}: {:?}",
                        seen.iter().zip(&expected).find(|(one, other)| one != other)
                    );
                    let reference = image(&quads, SIZE, None, BACKGROUND);
                    assert_eq!(first_difference(&seen, &reference), None, "{what}");
                    assert_eq!(counted, [generated, 0], "{what}");
                    let rows = slice.unwrap_or(SIZE[1]);
                    let slices = (0..SIZE[1]).step_by(rows as usize);
                    let iterations: u32 = slices
                        .map(|first| deepest(&quads, first..(first + rows).min(SIZE[1])).div_ceil(k).max(1))
                        .sum();
                    let peeled = loops.iter().find(|one| one.until.contains("remaining")).unwrap();
                    assert_eq!(peeled.end, LoopEnd::ConditionMet, "{what}");
                    assert!(peeled.iterations == iterations || has_copies && peeled.iterations < iterations, "{what}");
                    // Another order of submission.
                    numbers.shuffle(&mut quads);
                }
                assert_eq!(
                    drawn_on_cpu(&variant, &quads),
                    drawn_on_cpu(&a_buffer, &quads),
                    "{key} {set:?} on the CPU device"
                );
            }
        }
    }
}

/// Returns the depths of the fragments of a pixel, each once.
fn layers_at(quads: &[Quad], x: u32, y: u32) -> BTreeSet<u32> {
    let covers = |quad: &&Quad| (quad.x[0]..quad.x[1]).contains(&x) && (quad.y[0]..quad.y[1]).contains(&y);
    quads.iter().filter(covers).map(|quad| quad.depth.to_bits()).collect()
}

/// Returns the most layers of a pixel in these rows.
fn most_layers(quads: &[Quad], rows: std::ops::Range<u32>) -> u32 {
    let pixels = rows.flat_map(|y| (0..SIZE[0]).map(move |x| (x, y)));
    pixels.map(|(x, y)| layers_at(quads, x, y).len() as u32).max().unwrap_or(0)
}

/// Storages that keep all fragments, with the techniques of D13 among them.
pub(crate) const LAYERED: [&str; 6] = ["ab_ll", "ab_array", "f2b_kb", "ab_sb", "ab_ll_paged", "ab_ll_bun"];

/// Draws in slices and whole, and checks image, counters and iterations: `per_iteration` layers in each.
fn assert_layers_are_peeled(variant: &Variant, per_iteration: u32, is_bit_exact: bool) {
    let stage = device();
    let a_buffer = technique("ab_sb", &[("counters", "all"), ("sort", "insertion"), ("sort.layers", "64")]);
    for (seed, count) in [(3, 1), (5, 17), (7, 40), (8, 0)] {
        let quads = scene(seed, count);
        for slice in SLICES {
            let what = format!("{}, {count} quads, slices of {slice:?} rows", variant.name.value);
            let (expected, _, [generated, _]) = drawn(&stage, &a_buffer, &quads, None);
            let (seen, loops, counted) = drawn(&stage, variant, &quads, slice);
            assert!(!is_bit_exact || seen == expected, "{what}");
            assert_eq!(first_difference(&seen, &image(&quads, SIZE, None, BACKGROUND)), None, "{what}");
            assert_eq!(counted, [generated, 0], "{what}");
            let rows = slice.unwrap_or(SIZE[1]);
            let slices = (0..SIZE[1]).step_by(rows as usize);
            let needed = |first| most_layers(&quads, first..(first + rows).min(SIZE[1])).div_ceil(per_iteration).max(1);
            let peeled = loops.iter().find(|one| one.until.contains("remaining")).unwrap();
            assert_eq!((peeled.iterations, peeled.end), (slices.map(needed).sum(), LoopEnd::ConditionMet), "{what}");
        }
        assert!(!is_bit_exact || drawn_on_cpu(variant, &quads) == drawn_on_cpu(&a_buffer, &quads), "on the CPU device");
    }
}

/// D13 §3.1.3: fragments of equal depth are one layer.
#[test]
fn layers_of_equal_depth_equal_the_a_buffer_bit_for_bit() {
    for key in LAYERED {
        let set = [("peeling", "depth_layers"), ("counters", "all"), ("sort", "insertion"), ("sort.layers", "64")];
        assert_layers_are_peeled(&technique(key, &set), 1, true);
    }
}

/// Layers from the back are composited apart, so sums are rounded otherwise.
#[test]
fn layers_from_both_sides_equal_the_reference() {
    for key in LAYERED {
        let set = [("peeling", "both_sides"), ("counters", "all"), ("sort", "insertion"), ("sort.layers", "64")];
        assert_layers_are_peeled(&technique(key, &set), 2, false);
    }
}

/// Which of several fragments with equal depths is kept.
#[derive(Clone, Copy, PartialEq)]
enum OfEqual {
    First,
    Last,
    LeastPayload,
}

/// Without equal depths nothing is lost; of equal depths, a depth test keeps the first submitted, or the last if a pre-pass wrote their
/// depth, and a lock the least payload.
#[test]
fn front_to_back_peeling_keeps_one_of_equal_depths() {
    let stage = device();
    let single = technique("kplus_array", &[("storage", "single"), ("k", "1"), ("peeling", "front_to_back")]);
    let prepass = [("storage", "single"), ("k", "1"), ("peeling", "front_to_back"), ("cull", "z_prepass")];
    let variants = [
        (technique("f2b", &[]), OfEqual::First),
        (technique("f2b2", &[]), OfEqual::Last),
        (single, OfEqual::LeastPayload),
        (technique("kplus_array", &prepass), OfEqual::LeastPayload),
    ];
    for (variant, kept) in variants {
        for (seed, count) in [(1, 1), (2, 9), (3, 30)] {
            let mut quads = scene(seed, count);
            // A fragment on the far plane does not pass the depth test.
            quads.iter_mut().for_each(|quad| quad.depth *= 0.9);
            let (seen, loops, _) = drawn(&stage, &variant, &quads, None);
            let expected: Vec<[f64; 3]> = (0..SIZE[0] * SIZE[1])
                .map(|pixel| {
                    let (x, y) = (pixel % SIZE[0], pixel / SIZE[0]);
                    let covers =
                        |quad: &&Quad| (quad.x[0]..quad.x[1]).contains(&x) && (quad.y[0]..quad.y[1]).contains(&y);
                    let mut layers: Vec<Quad> = quads.iter().filter(covers).copied().collect();
                    match kept {
                        OfEqual::First => {}
                        OfEqual::Last => layers.reverse(),
                        OfEqual::LeastPayload => layers.sort_by_key(|quad| u32::from_le_bytes(quad.color)),
                    }
                    layers.sort_by(|one, other| one.depth.total_cmp(&other.depth));
                    layers.dedup_by_key(|quad| quad.depth.to_bits());
                    let whole = layers.iter().map(|quad| Quad { x: [0, 1], y: [0, 1], ..*quad }).collect::<Vec<_>>();
                    image(&whole, [1, 1], None, BACKGROUND)[0]
                })
                .collect();
            assert_eq!(first_difference(&seen, &expected), None, "{}, {count} quads", variant.name.value);
            let most = most_layers(&quads, 0..SIZE[1]);
            assert_eq!((loops[0].iterations, loops[0].end), (most + 1, LoopEnd::ConditionMet));
        }
    }
}

/// What a limit of iterations leaves is counted, for every kind of peeling.
#[test]
fn layers_beyond_the_last_iteration_are_counted() {
    let stage = device();
    let quads = scene(3, 21);
    let limited = |more: &[(&'static str, &'static str)], key: &str| {
        technique(key, &[more, &[("peeling.iterations", "2"), ("counters", "all")]].concat())
    };
    let layers = |pixel: u32| layers_at(&quads, pixel % SIZE[0], pixel / SIZE[0]);
    let fragments = |pixel: u32, layer: &dyn Fn(usize, usize) -> bool| {
        let known: Vec<u32> = layers(pixel).into_iter().collect();
        let (x, y) = (pixel % SIZE[0], pixel / SIZE[0]);
        let covers = |quad: &&Quad| (quad.x[0]..quad.x[1]).contains(&x) && (quad.y[0]..quad.y[1]).contains(&y);
        let at = |quad: &Quad| known.iter().position(|depth| *depth == quad.depth.to_bits()).unwrap();
        quads.iter().filter(covers).filter(|quad| layer(at(quad), known.len())).count() as u64
    };
    let sum = |layer: &dyn Fn(usize, usize) -> bool| (0..SIZE[0] * SIZE[1]).map(|pixel| fragments(pixel, layer)).sum();
    let single = [("storage", "single"), ("k", "1"), ("peeling", "front_to_back")];
    let cases: [(Variant, u64); 3] = [
        (limited(&[], "f2b_ll"), sum(&|layer, _| layer >= 2)),
        (limited(&[], "dual_ll"), sum(&|layer, count| layer >= 2 && layer + 2 < count)),
        // The second iteration only counts, and the first keeps one fragment of a layer.
        (limited(&single, "kplus_array"), sum(&|layer, _| layer >= 1)),
    ];
    for (variant, expected) in cases {
        let (_, loops, [_, lost]) = drawn(&stage, &variant, &quads, None);
        let end = if expected > 0 { LoopEnd::LimitReached } else { LoopEnd::ConditionMet };
        assert_eq!((lost, loops[0].end), (expected, end), "{}", variant.name.value);
    }
}

/// More copies than all iterations could keep are counted.
#[test]
fn copies_beyond_the_last_iteration_are_counted() {
    let stage = device();
    let variant = technique("k_peeling", &[("k", "2"), ("peeling.iterations", "3"), ("counters", "all")]);
    let quad = Quad { x: [0, SIZE[0]], y: [0, SIZE[1]], depth: 0.5, color: [9, 90, 200, 20], id: 0 };
    let (seen, _, [generated, lost]) = drawn(&stage, &variant, &[quad; 12], None);
    // Two are kept, and six are composited as copies of them.
    assert_eq!(first_difference(&seen, &image(&[quad; 8], SIZE, None, BACKGROUND)), None);
    let pixels = u64::from(SIZE[0] * SIZE[1]);
    assert_eq!((generated, lost), (12 * pixels, 4 * pixels));
}

/// Blending stops at the same fragment as in an A-buffer.
#[test]
fn opacity_ends_where_it_does_in_an_a_buffer() {
    let stage = device();
    let quads = scene(5, 40);
    let opaque = ("resolve.opaque", "400");
    let a_buffer = technique("ab_sb", &[opaque, ("sort", "insertion"), ("sort.layers", "64")]);
    let peeled = technique("k_peeling", &[opaque, ("k", "2")]);
    let (expected, ..) = drawn(&stage, &a_buffer, &quads, None);
    let (all, ..) = drawn(&stage, &technique("ab_sb", &[("sort.layers", "64")]), &quads, None);
    assert!(expected != all, "the threshold has no effect");
    let (seen, ..) = drawn(&stage, &peeled, &quads, None);
    assert!(seen == expected);
}

/// A limit of iterations is a loss with a number: the nearest fragments are kept, and the others counted.
#[test]
fn fragments_beyond_the_last_iteration_are_counted() {
    let stage = device();
    let variant = technique("k_peeling", &[("k", "2"), ("peeling.iterations", "3"), ("counters", "all")]);
    let quads = scene(3, 21);
    let (seen, loops, [_, lost]) = drawn(&stage, &variant, &quads, None);
    let reference = image(&quads, SIZE, Some(6), BACKGROUND);
    assert_eq!(first_difference(&seen, &reference), None);
    assert_eq!((loops[0].iterations, loops[0].end), (3, LoopEnd::LimitReached));
    let beyond: u32 = (0..SIZE[0] * SIZE[1])
        .map(|pixel| {
            let (x, y) = (pixel % SIZE[0], pixel / SIZE[0]);
            let covers = |quad: &&Quad| (quad.x[0]..quad.x[1]).contains(&x) && (quad.y[0]..quad.y[1]).contains(&y);
            (quads.iter().filter(covers).count() as u32).saturating_sub(6)
        })
        .sum();
    assert!(beyond > 0);
    assert_eq!(lost, u64::from(beyond));
}
