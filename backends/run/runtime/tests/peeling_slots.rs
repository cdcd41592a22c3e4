//! Peeling that divides the fragments of an iteration into slots (by side, by id, by depth bucket), and buckets that follow the
//! fragments, against a model of each pixel that shares no code with the templates: image, counters and iterations.

use std::collections::{BTreeMap, BTreeSet};

use fragbuf_model::Variant;
use fragbuf_runtime::LoopEnd;

use crate::drivers::scene::{Quad, first_difference, image};
use crate::order::Numbers;
use crate::peeling::{LAYERED, SIZE, SLICES, counted, drawn_on_cpu, scene};
use crate::stage::{BACKGROUND, device, technique};

/// A fragment by the words that decide: its depth and the first word of its payload, the colour.
type Words = (u32, u32);

fn words(quad: &Quad) -> Words {
    (quad.depth.to_bits(), u32::from_le_bytes(quad.color))
}

/// Returns the quads that cover a pixel.
fn at(quads: &[Quad], pixel: u32) -> Vec<Quad> {
    let (x, y) = (pixel % SIZE[0], pixel / SIZE[0]);
    let covers = |quad: &&Quad| (quad.x[0]..quad.x[1]).contains(&x) && (quad.y[0]..quad.y[1]).contains(&y);
    quads.iter().filter(covers).copied().collect()
}

fn pixels(rows: std::ops::Range<u32>) -> impl Iterator<Item = u32> {
    rows.start * SIZE[0]..rows.end * SIZE[0]
}

/// Returns the ids of each layer, from the nearest.
fn layers(fragments: &[Quad]) -> Vec<BTreeSet<u32>> {
    let mut layers: BTreeMap<u32, BTreeSet<u32>> = BTreeMap::new();
    for (depth, id) in fragments.iter().map(words) {
        layers.entry(depth).or_default().insert(id);
    }
    layers.into_values().collect()
}

/// Returns the iterations that one side needs: half of the ids of each layer, rounded up.
fn iterations_from_one_side(fragments: &[Quad]) -> u32 {
    layers(fragments).iter().map(|ids| ids.len().div_ceil(2) as u32).sum()
}

/// Returns the iterations that peeling by ids on demand needs: one for a layer of one fragment; else one to find ids, and one for every
/// two of them.
fn iterations_on_demand(fragments: &[Quad]) -> u32 {
    let mut layers: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
    fragments.iter().map(words).for_each(|(depth, id)| layers.entry(depth).or_default().push(id));
    let of_layer = |ids: &Vec<u32>| match ids.len() {
        1 => 1,
        _ => 1 + ids.iter().collect::<BTreeSet<_>>().len().div_ceil(2) as u32,
    };
    layers.values().map(of_layer).sum()
}

/// Returns the iterations that two sides need: each takes two ids of its layer, and passes on when the layer is empty.
fn iterations_from_both_sides(fragments: &[Quad]) -> u32 {
    let mut left: Vec<u32> = layers(fragments).iter().map(|ids| ids.len() as u32).collect();
    let (mut front, mut back) = (0, left.len().saturating_sub(1));
    let mut iterations = 0;
    while left.iter().any(|count| *count > 0) {
        iterations += 1;
        let sides = if front == back { vec![front] } else { vec![front, back] };
        for side in sides {
            left[side] = left[side].saturating_sub(2);
        }
        // A side that has ended passes to the next layer that the other does not hold.
        let ended = (left[front] == 0, left[back] == 0);
        if ended.0 {
            front = (front + 1).min(back);
        }
        if ended.1 {
            back = back.saturating_sub(1).max(front);
        }
    }
    iterations
}

/// A number of iterations, from the fragments of a pixel.
type OfPixel = fn(&[Quad]) -> u32;

/// Returns the most of a pixel in these rows, at least one: every loop runs once.
fn most(quads: &[Quad], rows: std::ops::Range<u32>, of_pixel: OfPixel) -> u32 {
    pixels(rows).map(|pixel| of_pixel(&at(quads, pixel))).max().unwrap_or(0).max(1)
}

/// Draws in slices, whole, and in another order, and checks image, counters and iterations; `further` iterations find nothing.
fn assert_ids_are_peeled(variant: &Variant, of_pixel: OfPixel, further: u32) {
    let stage = device();
    let mut numbers = Numbers::seeded(4);
    for (seed, count) in [(3, 1), (5, 17), (7, 40), (8, 0)] {
        let mut quads = scene(seed, count);
        for slice in SLICES {
            let what = format!("{}, {count} quads, slices of {slice:?} rows", variant.name.value);
            let (seen, loops, counters) = counted(&stage, variant, &quads, slice);
            let reference = image(&quads, SIZE, None, BACKGROUND);
            assert_eq!(first_difference(&seen, &reference), None, "{what}");
            let all: usize = pixels(0..SIZE[1]).map(|pixel| at(&quads, pixel).len()).sum();
            assert_eq!([u64::from(counters.get("generated")), counters.lost()], [all as u64, 0], "{what}");
            let rows = slice.unwrap_or(SIZE[1]);
            let empty =
                |first: u32| pixels(first..(first + rows).min(SIZE[1])).all(|pixel| at(&quads, pixel).is_empty());
            let needed = |first: u32| {
                let further = if empty(first) { 0 } else { further };
                most(&quads, first..(first + rows).min(SIZE[1]), of_pixel) + further
            };
            let expected: u32 = (0..SIZE[1]).step_by(rows as usize).map(needed).sum();
            let peeled = loops.iter().find(|one| one.until.contains("remaining")).unwrap();
            assert_eq!((peeled.iterations, peeled.end), (expected, LoopEnd::ConditionMet), "{what}");
            numbers.shuffle(&mut quads);
        }
        let reference = image(&quads, SIZE, None, BACKGROUND);
        assert_eq!(first_difference(&over_background(variant, &quads), &reference), None, "on the CPU device");
    }
}

/// Draws on the CPU device, over the background.
fn over_background(variant: &Variant, quads: &[Quad]) -> Vec<[f32; 4]> {
    let over = |pixel: &[u32; 4]| {
        let [r, g, b, a] = pixel.map(f32::from_bits);
        let color = [r, g, b].into_iter().zip(BACKGROUND).map(|(color, behind)| color + (1.0 - a) * behind as f32);
        let color: Vec<f32> = color.collect();
        [color[0], color[1], color[2], 1.0]
    };
    drawn_on_cpu(variant, quads).iter().map(over).collect()
}

const EVERY_EVENT: (&str, &str) = ("counters", "all");

/// D13 §3.1.2: all fragments of equal depth, two ids per iteration; as a layer of one slot per id, and over storages that keep all.
#[test]
fn ids_of_a_layer_are_peeled_two_at_a_time() {
    assert_ids_are_peeled(&technique("f2b_2p", &[EVERY_EVENT]), iterations_from_one_side, 0);
    for key in LAYERED {
        let set = [("peeling", "id_pairs"), EVERY_EVENT, ("sort", "insertion"), ("sort.layers", "64")];
        assert_ids_are_peeled(&technique(key, &set), iterations_from_one_side, 0);
    }
}

/// D13 §5: draws are saved where layers have one fragment.
#[test]
fn ids_are_peeled_on_demand() {
    let variant = technique("f2b_1p", &[EVERY_EVENT]);
    assert_ids_are_peeled(&variant, iterations_on_demand, 0);
    let quads = many_depths(2, 30);
    let (seen, loops, counters) = counted(&device(), &variant, &quads, None);
    assert_eq!(first_difference(&seen, &image(&quads, SIZE, None, BACKGROUND)), None);
    assert_eq!((counters.lost(), loops[0].end), (0, LoopEnd::ConditionMet));
    let layers: OfPixel = |fragments| depths(fragments).len() as u32;
    assert_eq!(loops[0].iterations, most(&quads, 0..SIZE[1], layers));
}

/// The last iteration finds that nothing is left.
#[test]
fn ids_of_a_layer_are_peeled_behind_a_depth_test() {
    // The early depth test is a feature of the device.
    let native = [EVERY_EVENT];
    assert_ids_are_peeled(&technique("f2b_3p", &native), iterations_from_one_side, 1);
}

#[test]
fn ids_of_two_layers_are_peeled_from_both_sides() {
    assert_ids_are_peeled(&technique("dual_2p", &[EVERY_EVENT]), iterations_from_both_sides, 0);
    for key in ["ab_ll", "f2b_kb"] {
        let set = [("peeling", "id_pairs_both_sides"), EVERY_EVENT, ("sort", "insertion"), ("sort.layers", "64")];
        assert_ids_are_peeled(&technique(key, &set), iterations_from_both_sides, 0);
    }
}

/// Returns the number of a depth's bucket among equal parts of the range of the depths, in units of 2^-24.
fn bucket(depth: u32, depths: &BTreeSet<u32>, buckets: u64) -> u64 {
    let steps = |bits: u32| (f64::from(f32::from_bits(bits)) * f64::from(1 << 24)).floor() as u64;
    let (nearest, farthest) = (steps(*depths.first().unwrap()), steps(*depths.last().unwrap()));
    (steps(depth) - nearest) * buckets / (farthest - nearest + 1)
}

fn depths(fragments: &[Quad]) -> BTreeSet<u32> {
    fragments.iter().map(|quad| words(quad).0).collect()
}

/// Returns the iterations of four buckets: the first finds the layers, each other one stores two of every bucket.
fn iterations_of_buckets(fragments: &[Quad]) -> u32 {
    let depths = depths(fragments);
    let mut counts: BTreeMap<u64, u32> = BTreeMap::new();
    for depth in &depths {
        *counts.entry(bucket(*depth, &depths, 4)).or_default() += 1;
    }
    counts.values().map(|layers| layers.div_ceil(2) + 1).max().unwrap_or(0)
}

/// D13 §3.1.4, over storages that keep all fragments of equal depth.
#[test]
fn buckets_are_peeled_at_once() {
    for key in LAYERED {
        let set = [("peeling", "bucket_layers"), EVERY_EVENT, ("sort", "insertion"), ("sort.layers", "64")];
        assert_ids_are_peeled(&technique(key, &set), iterations_of_buckets, 0);
    }
}

/// Returns quads with many different depths.
fn many_depths(seed: u64, count: u32) -> Vec<Quad> {
    let mut numbers = Numbers::seeded(seed);
    let mut quads = scene(seed, count);
    quads.iter_mut().for_each(|quad| quad.depth = numbers.below(1 << 20) as f32 / (1 << 20) as f32);
    quads
}

/// `dual` and `bun` are exact without equal depths, and take as many iterations as the deepest pixel or bucket needs.
#[test]
fn slots_of_layers_keep_all_different_depths() {
    let stage = device();
    let half = |fragments: &[Quad]| (depths(fragments).len() as u32).div_ceil(2);
    let cases: [(&str, OfPixel); 2] = [("dual", half), ("bun", iterations_of_buckets)];
    for (key, of_pixel) in cases {
        let variant = technique(key, &[EVERY_EVENT]);
        for (seed, count) in [(1, 1), (2, 30), (3, 41)] {
            let quads = many_depths(seed, count);
            let (seen, loops, counters) = counted(&stage, &variant, &quads, None);
            assert_eq!(first_difference(&seen, &image(&quads, SIZE, None, BACKGROUND)), None, "{key}, {count} quads");
            assert_eq!((counters.lost(), loops[0].end), (0, LoopEnd::ConditionMet), "{key}, {count} quads");
            assert_eq!(loops[0].iterations, most(&quads, 0..SIZE[1], of_pixel), "{key}, {count} quads");
        }
    }
}

/// Of equal depths one is kept, the first, as software drivers run the fragments of a pixel in order. The others are counted.
#[test]
fn slots_of_layers_count_what_they_lose() {
    let stage = device();
    for key in ["dual", "bun"] {
        let variant = technique(key, &[EVERY_EVENT]);
        let quads = scene(7, 40);
        let (seen, _, counters) = counted(&stage, &variant, &quads, None);
        let lost: usize = pixels(0..SIZE[1])
            .map(|pixel| at(&quads, pixel))
            .map(|fragments| fragments.len() - depths(&fragments).len())
            .sum();
        assert_eq!((u64::from(counters.get("equal_keys")), counters.lost()), (lost as u64, lost as u64), "{key}");
        let kept = |fragments: Vec<Quad>| {
            let mut seen = BTreeSet::new();
            fragments.into_iter().filter(|quad| seen.insert(words(quad).0)).collect()
        };
        assert_eq!(first_difference(&seen, &by_pixel(&quads, kept)), None, "{key}");
    }
}

/// Returns the image of what `kept` leaves of each pixel's fragments.
fn by_pixel(quads: &[Quad], kept: impl Fn(Vec<Quad>) -> Vec<Quad>) -> Vec<[f64; 3]> {
    let of_pixel = |pixel| {
        let whole: Vec<Quad> =
            kept(at(quads, pixel)).into_iter().map(|quad| Quad { x: [0, 1], y: [0, 1], ..quad }).collect();
        image(&whole, [1, 1], None, BACKGROUND)[0]
    };
    pixels(0..SIZE[1]).map(of_pixel).collect()
}

/// Equal ids in a layer are one id: of such fragments one is kept, and the others are counted.
#[test]
fn equal_ids_are_counted() {
    let stage = device();
    let quad = |depth, red, green| Quad { x: [0, 5], y: [0, 3], depth, color: [red, green, 40, 128], id: 0 };
    let quads = [quad(0.5, 1, 2), quad(0.5, 9, 7), quad(0.5, 1, 2), quad(0.25, 1, 2), quad(0.5, 4, 4), quad(0.5, 1, 2)];
    for key in ["f2b_1p", "f2b_2p", "f2b_3p", "dual_2p"] {
        let (seen, _, counters) = counted(&stage, &technique(key, &[EVERY_EVENT]), &quads, None);
        assert_eq!((counters.get("equal_keys"), counters.lost()), (2 * 15, 2 * 15), "{key}");
        let kept = |fragments: Vec<Quad>| {
            let mut seen = BTreeSet::new();
            fragments.into_iter().filter(|quad| seen.insert(words(quad))).collect()
        };
        assert_eq!(first_difference(&seen, &by_pixel(&quads, kept)), None, "{key}");
    }
}

/// Ids of 0 and of all ones are ids as others, alone in a layer, several times, and together.
#[test]
fn the_least_and_the_greatest_id_are_ids() {
    let stage = device();
    let quad = |depth, color| Quad { x: [0, 5], y: [0, 3], depth, color, id: 0 };
    let (none, all, other) = ([0; 4], [255; 4], [9, 7, 40, 128]);
    let scenes: [&[[u8; 4]]; 6] =
        [&[all, all], &[none, none], &[all, none], &[all], &[none], &[none, other, all, other, all]];
    for key in ["f2b_1p", "f2b_2p", "f2b_3p", "dual_2p"] {
        for colors in scenes {
            // Another layer follows.
            let quads: Vec<Quad> =
                colors.iter().map(|color| quad(0.25, *color)).chain([quad(0.5, [1, 200, 3, 128])]).collect();
            let (seen, loops, counters) = counted(&stage, &technique(key, &[EVERY_EVENT]), &quads, None);
            let ids: BTreeSet<&[u8; 4]> = colors.iter().collect();
            let equal = 15 * (colors.len() - ids.len()) as u64;
            let what = format!("{key}, {colors:?}");
            assert_eq!((u64::from(counters.get("equal_keys")), counters.lost()), (equal, equal), "{what}");
            assert_eq!(loops[0].end, LoopEnd::ConditionMet, "{what}");
            let kept = |fragments: Vec<Quad>| {
                let mut seen = BTreeSet::new();
                fragments.into_iter().filter(|quad| seen.insert(words(quad))).collect()
            };
            assert_eq!(first_difference(&seen, &by_pixel(&quads, kept)), None, "{what}");
        }
    }
}

/// What a limit of iterations leaves is counted.
#[test]
fn fragments_that_slots_leave_are_counted() {
    let stage = device();
    let quads = scene(3, 21);
    // Ids of a pixel from the nearest layer on, by their place in it and the number of its ids.
    let left = |is_left: &dyn Fn(usize, usize, usize) -> bool| -> u64 {
        let of_pixel = |pixel| {
            let layers = layers(&at(&quads, pixel));
            let ids = layers.iter().enumerate().flat_map(|(layer, ids)| (0..ids.len()).map(move |id| (layer, id)));
            ids.filter(|(layer, id)| is_left(*layer, *id, layers[*layer].len())).count() as u64
        };
        pixels(0..SIZE[1]).map(of_pixel).sum()
    };
    let between = |id: usize, ids: usize| id >= 1 && id + 1 < ids;
    // Two iterations on demand store two fragments: of one layer, or of two if the first has one fragment.
    let on_demand =
        |pixel| layers(&at(&quads, pixel)).iter().map(|ids| ids.len() as u64).sum::<u64>().saturating_sub(2);
    let on_demand = pixels(0..SIZE[1]).map(on_demand).sum();
    let cases = [
        ("f2b_2p", "1", left(&|layer, id, ids| layer > 0 || between(id, ids))),
        // The last iteration only counts.
        ("f2b_3p", "2", left(&|layer, id, ids| layer > 0 || between(id, ids))),
        ("f2b_2p", "1024", 0),
        // One fragment of a new layer stays, and all others are counted.
        ("f2b_1p", "1", left(&|layer, id, _| layer > 0 || id > 0)),
        ("f2b_1p", "2", on_demand),
    ];
    assert!(cases[0].2 > 0);
    for (key, iterations, expected) in cases {
        let variant = technique(key, &[EVERY_EVENT, ("peeling.iterations", iterations)]);
        let (_, loops, counters) = counted(&stage, &variant, &quads, None);
        assert_eq!(counters.lost(), expected, "{key}, {iterations} iterations");
        assert_eq!(loops[0].end == LoopEnd::LimitReached, expected > 0, "{key}, {iterations} iterations");
    }
    // The first iteration of buckets stores nothing.
    let all: usize = pixels(0..SIZE[1]).map(|pixel| at(&quads, pixel).len()).sum();
    let set = [("peeling", "bucket_layers"), ("peeling.iterations", "1"), EVERY_EVENT];
    assert_eq!(counted(&stage, &technique("ab_ll", &set), &quads, None).2.lost(), all as u64);
}

/// Returns the fragments that adaptive ranges keep: buckets that hold fragments are parts, the k-th takes the rest, and each part keeps
/// the first of its nearest. Also returns how many are displaced, and how many equal the kept one of their part.
fn in_parts(fragments: Vec<Quad>, k: usize) -> (Vec<Quad>, [u64; 2]) {
    let depths = depths(&fragments);
    let marked: BTreeSet<u64> = depths.iter().map(|depth| bucket(*depth, &depths, 128)).collect();
    let part = |quad: &Quad| {
        let bucket = bucket(words(quad).0, &depths, 128);
        marked.iter().position(|other| *other == bucket).unwrap().min(k - 1)
    };
    let mut kept: BTreeMap<usize, Quad> = BTreeMap::new();
    for quad in &fragments {
        let nearest = kept.entry(part(quad)).or_insert(*quad);
        if words(quad).0 < words(nearest).0 {
            *nearest = *quad;
        }
    }
    let equals = |quad: &&Quad| words(&kept[&part(quad)]).0 == words(quad).0;
    let equal = fragments.iter().filter(equals).count() - kept.len();
    let displaced = fragments.len() - kept.len() - equal;
    (kept.into_values().collect(), [displaced as u64, equal as u64])
}

/// Returns quads over the whole frame at the centres of forty buckets of 128, some twice.
fn many_in_parts() -> Vec<Quad> {
    let mut quads = many_depths(6, 50);
    for (at, quad) in quads.iter_mut().enumerate() {
        let bucket = [(at % 40) * 3, 127][usize::from(at == 49)];
        *quad = Quad { x: [0, SIZE[0]], y: [0, SIZE[1]], depth: (bucket as f32 + 0.5) / 128.0, ..*quad };
    }
    quads
}

#[test]
fn adaptive_ranges_keep_the_nearest_of_each_part() {
    let stage = device();
    for (k, quads) in [
        ("40", many_in_parts()),
        ("32", many_depths(2, 40)),
        ("4", many_depths(3, 40)),
        ("3", scene(7, 40)),
        ("1", scene(5, 17)),
    ] {
        let variant = technique("bad", &[("k", k), EVERY_EVENT]);
        let k: usize = k.parse().unwrap();
        let (seen, _, counters) = counted(&stage, &variant, &quads, None);
        assert_eq!(first_difference(&seen, &by_pixel(&quads, |fragments| in_parts(fragments, k).0)), None, "k = {k}");
        let expected = pixels(0..SIZE[1]).map(|pixel| in_parts(at(&quads, pixel), k).1);
        let expected = expected.fold([0, 0], |sum, next| [sum[0] + next[0], sum[1] + next[1]]);
        let counted = [counters.get("displaced"), counters.get("equal_keys")].map(u64::from);
        assert_eq!(counted, expected, "k = {k}");
        let reference = by_pixel(&quads, |fragments| in_parts(fragments, k).0);
        assert_eq!(
            first_difference(&over_background(&variant, &quads), &reference),
            None,
            "k = {k}, on the CPU device"
        );
    }
}
