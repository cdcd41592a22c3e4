//! Overflow rows that do not drop displaced fragments: they blend them behind the kept ones, merge them with the last, or merge the
//! closest two. Each row is compared with a model over the fragments in drawing order, on every storage that the rules allow. All
//! of them preserve the transmittance of the whole pixel, in any order.

use std::collections::BTreeSet;

use fragbuf_codegen::{Arrival, plan};
use fragbuf_cpu::FragmentOrder;
use fragbuf_model::{Draft, SourceSpan, Variant, check};
use fragbuf_runtime::headless::Offscreen;
use fragbuf_targets::target;
use fragbuf_templates::Registry;
use fragbuf_templates::vocabulary::{Capability, Feature, Row};

use crate::cpu_device;
use crate::oracle::{self, pixels};
use crate::order::{Numbers, orders};
use crate::quads::{Quad, SIZE};
use crate::stage::{self, BACKGROUND, FORMAT, draw_over, render_frame, renderer, settings, shaders};

const ROWS: [&str; 3] = ["tail_blend", "merge_last", "merge_closest"];

/// The storages that each row is legal with.
const MERGE_LAST: [&str; 5] = ["bounded_regions", "max_array", "max_heap", "revised_array", "sorted_array"];
const MERGE_CLOSEST: [&str; 1] = ["sorted_array"];
const TAIL_BLEND: [&str; 6] =
    ["bounded_regions", "depth_ranges", "max_array", "max_heap", "revised_array", "sorted_array"];

/// A fragment of a model: depth and straight colour.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Layer {
    depth: f32,
    color: [f64; 4],
}

fn layer(quad: &Quad) -> Layer {
    Layer { depth: quad.depth, color: quad.color.map(|channel| f64::from(channel) / 255.0) }
}

/// The kept fragments of a pixel, nearest first, and the premultiplied colour behind them.
#[derive(Clone, Debug, Default)]
struct Pixel {
    kept: Vec<Layer>,
    tail: [f64; 4],
}

/// Composites `near` over `far`, both straight colours.
fn over(near: [f64; 4], far: [f64; 4]) -> [f64; 4] {
    let shares = [near[3], (1.0 - near[3]) * far[3]];
    let alpha = shares[0] + shares[1];
    let channel = |at: usize| if alpha > 0.0 { (shares[0] * near[at] + shares[1] * far[at]) / alpha } else { near[at] };
    [channel(0), channel(1), channel(2), alpha]
}

impl Pixel {
    fn insert(&mut self, new: Layer) {
        let position = self.kept.partition_point(|kept| kept.depth <= new.depth);
        self.kept.insert(position, new);
    }

    fn blend_into_tail(&mut self, lost: Layer) {
        let [r, g, b, a] = lost.color;
        let old = self.tail;
        self.tail = [r * a, g * a, b * a, a];
        (0..4).for_each(|at| self.tail[at] += (1.0 - a) * old[at]);
    }

    /// Adds a fragment and applies the overflow row. At most `k` fragments are kept, or one in each of `k` depth ranges.
    fn add(&mut self, row: &str, has_ranges: bool, k: usize, new: Layer) {
        if has_ranges {
            let range = |layer: &Layer| ((f64::from(layer.depth) * 1.0e6).floor() * k as f64 / 1.0e6).floor() as usize;
            let Some(at) = self.kept.iter().position(|kept| range(kept) == range(&new)) else {
                return self.insert(new);
            };
            let old = self.kept[at];
            if new.depth < old.depth {
                self.kept[at] = new;
            }
            return self.blend_into_tail(if new.depth < old.depth { old } else { new });
        }
        self.insert(new);
        if self.kept.len() <= k {
            return;
        }
        match row {
            "tail_blend" => {
                let lost = self.kept.remove(k);
                self.blend_into_tail(lost);
            }
            "merge_last" => {
                let lost = self.kept.remove(k);
                self.kept[k - 1].color = over(self.kept[k - 1].color, lost.color);
            }
            _ => {
                let gap = |at: usize| self.kept[at + 1].depth - self.kept[at].depth;
                let closest = (0..k).rev().fold(k - 1, |best, at| if gap(at) < gap(best) { at } else { best });
                let far = self.kept.remove(closest + 1);
                self.kept[closest].color = over(self.kept[closest].color, far.color);
            }
        }
    }

    /// Returns the colour over the background.
    fn color(&self) -> [f64; 3] {
        let mut color = [0.0; 3];
        let mut through = 1.0;
        for Layer { color: [r, g, b, a], .. } in &self.kept {
            (0..3).for_each(|at| color[at] += through * a * [r, g, b][at]);
            through *= 1.0 - a;
        }
        let behind = |at: usize| self.tail[at] + (1.0 - self.tail[3]) * BACKGROUND[at];
        [0, 1, 2].map(|at| color[at] + through * behind(at))
    }
}

fn variant(key: &str, set: &[(&str, &str)]) -> Option<Variant> {
    let span = SourceSpan::new("merging", 1, 1);
    let mut draft = Draft::from_technique(key, &span);
    for (name, value) in set {
        draft.set(name, value, &span).ok()?;
    }
    check(&draft, &Registry::builtin()).ok()
}

fn storage(variant: &Variant) -> &Row {
    &variant.choices.iter().find(|chosen| chosen.axis == "storage").unwrap().alternatives[0].row
}

/// Whether a fragment competes only with those of its depth range.
fn has_ranges(variant: &Variant) -> bool {
    storage(variant).keeps.as_ref().is_some_and(|kept| kept.group.is_some())
}

/// Returns a technique for every storage that a row is legal with, under a lock and without culling, with the storage's key.
fn with_row(row: &str, k: usize, color: &str) -> Vec<(String, Variant)> {
    let k = k.to_string();
    let set = [
        ("k", &*k),
        ("overflow", row),
        ("sync", "spin_lock"),
        ("cull", "none"),
        ("fragment.color", color),
        ("counters", "all"),
    ];
    let registry = Registry::builtin();
    let legal = registry.techniques().iter().filter_map(|technique| variant(&technique.key, &set));
    let mut storages = BTreeSet::new();
    legal
        .map(|variant| (storage(&variant).key.clone(), variant))
        .filter(|(key, _)| storages.insert(key.clone()))
        .collect()
}

#[test]
fn the_rules_allow_a_row_on_the_expected_storages() {
    let keys = |variants: Vec<(String, Variant)>| variants.into_iter().map(|(key, _)| key).collect::<BTreeSet<_>>();
    for (row, expected) in
        [("merge_last", &MERGE_LAST[..]), ("merge_closest", &MERGE_CLOSEST), ("tail_blend", &TAIL_BLEND)]
    {
        let expected: BTreeSet<String> = expected.iter().map(|key| (*key).to_owned()).collect();
        assert_eq!(keys(with_row(row, 3, "rgba8")), expected, "{row}");
    }
}

/// Returns random quads of different depths at uneven distances, none opaque.
fn scene(count: u32, seed: u64) -> Vec<Quad> {
    let mut numbers = Numbers::seeded(seed);
    let mut quad = |index: u32| {
        let (x, y) = (numbers.below(6), numbers.below(6));
        let depth = 0.03 + 0.9 * ((index * 29 % count) as f32 + numbers.below(900) as f32 / 1000.0) / count as f32;
        let mut channel = || numbers.below(256) as u8;
        let color = [channel(), channel(), channel(), channel() / 2 + 20];
        Quad::whole(depth, color).at(x, y, SIZE - numbers.below(6), SIZE - numbers.below(6))
    };
    (0..count).map(&mut quad).collect()
}

/// Returns the model of every pixel.
fn modelled(quads: &[Quad], row: &str, variant: &Variant, k: usize) -> Vec<Pixel> {
    let has_ranges = has_ranges(variant);
    let of_pixel = |(x, y)| {
        let mut pixel = Pixel::default();
        oracle::fragments(quads, x, y).iter().for_each(|quad| pixel.add(row, has_ranges, k, layer(quad)));
        pixel
    };
    pixels().map(of_pixel).collect()
}

#[test]
fn every_row_matches_its_model_on_every_storage() {
    let stage = stage::device();
    for row in ROWS {
        for (k, color) in [(1, "vec4"), (3, "vec4"), (3, "rgba16"), (4, "rgba8")] {
            for (storage, variant) in with_row(row, k, color) {
                let mut renderer = renderer(&stage, &shaders(&variant, "wgsl-native"), &settings()).unwrap();
                for quads in orders(&scene(9, 5)).into_iter().take(3) {
                    let seen = render_frame(&stage, &mut renderer, &quads);
                    let models = modelled(&quads, row, &variant, k);
                    for ((kept, shown), model) in seen.kept.iter().zip(&seen.pixels).zip(&models) {
                        let keys: Vec<u32> = kept.iter().map(|words| words[0]).collect();
                        let wanted: Vec<u32> = model.kept.iter().map(|layer| layer.depth.to_bits()).collect();
                        assert_eq!(keys, wanted, "{row}, {storage}, k = {k}, {color}: {quads:?}");
                        // Each merge rounds an rgba8 entry.
                        let roundings = if color == "rgba8" { 1.0 + (9 - k) as f64 } else { 1.0 };
                        for (shown, wanted) in shown.iter().zip(model.color()) {
                            let off = (f64::from(*shown) - wanted).abs();
                            assert!(off <= roundings / 255.0, "{row}, {storage}, k = {k}, {color}: off by {off}");
                        }
                    }
                }
            }
        }
    }
}

/// `merge_last` does not change a bit of the kept fragments except for the farthest, and `tail_blend` of none.
#[test]
fn unmerged_fragments_stay_bit_identical() {
    let stage = stage::device();
    let k = 4;
    for (row, unmerged) in [("merge_last", k - 1), ("tail_blend", k)] {
        for (storage, variant) in with_row(row, k, "rgba8").into_iter().filter(|(_, variant)| !has_ranges(variant)) {
            let mut renderer = renderer(&stage, &shaders(&variant, "wgsl"), &settings()).unwrap();
            for quads in orders(&scene(12, 8)).into_iter().take(4) {
                let seen = render_frame(&stage, &mut renderer, &quads);
                let expected = oracle::kept_words(&oracle::PLAIN, &quads, Some(k as u32));
                for (kept, wanted) in seen.kept.iter().zip(expected) {
                    let unmerged = unmerged.min(wanted.len());
                    assert_eq!(kept[..unmerged], wanted[..unmerged], "{row}, {storage}: {quads:?}");
                }
            }
        }
    }
}

/// Returns the image of `quads` and the number of displaced fragments.
fn rendered(stage: &fragbuf_runtime::headless::Headless, variant: &Variant, quads: &[Quad]) -> (Vec<[f32; 4]>, u32) {
    let mut renderer = renderer(stage, &shaders(variant, "wgsl"), &settings()).unwrap();
    let offscreen = Offscreen::new(&stage.device, FORMAT, SIZE, SIZE).unwrap();
    draw_over(stage, &mut renderer, quads, &offscreen).unwrap();
    let counters = stage::read_counters(stage, &renderer);
    (offscreen.colors(&stage.device, &stage.queue).unwrap(), counters.get("displaced"))
}

/// Black fragments, some of equal depth and one fully transparent: the image is the background times the transmittance of all.
#[test]
fn the_transmittance_is_that_of_all_fragments() {
    let stage = stage::device();
    let alphas = [30, 80, 0, 140, 55, 200, 11, 90];
    let depths = [0.5, 0.25, 0.25, 0.75, 0.5, 0.5, 0.125, 0.75];
    let quads: Vec<Quad> =
        depths.into_iter().zip(alphas).map(|(depth, alpha)| Quad::whole(depth, [0, 0, 0, alpha])).collect();
    let through: f64 = alphas.iter().map(|alpha| 1.0 - f64::from(*alpha) / 255.0).product();
    for row in ROWS {
        for (k, color, rounding) in
            [(1, "rgba8", 8.0 * 0.51 / 255.0), (3, "rgba8", 5.0 * 0.51 / 255.0), (2, "rgba16", 0.0)]
        {
            for (storage, variant) in with_row(row, k, color) {
                for quads in orders(&quads).into_iter().take(8) {
                    let (pixels, displaced) = rendered(&stage, &variant, &quads);
                    let lost = if has_ranges(&variant) { displaced } else { (8 - k as u32) * SIZE * SIZE };
                    assert_eq!(displaced, lost, "{row}, {storage}");
                    for pixel in pixels {
                        for (channel, background) in pixel.iter().zip(BACKGROUND) {
                            let off = (f64::from(*channel) - through * background).abs();
                            let most = rounding * background + 1.0 / 1000.0;
                            assert!(off <= most, "{row}, {storage}, k = {k}, {color}: {pixel:?}, {through}");
                        }
                    }
                }
            }
        }
    }
}

#[test]
fn without_overflow_the_image_equals_that_of_drop() {
    let stage = stage::device();
    let quads = scene(6, 3);
    for row in ROWS {
        for (storage, variant) in with_row(row, 6, "rgba8").into_iter().filter(|(_, variant)| !has_ranges(variant)) {
            let dropped = with_row("drop", 6, "rgba8").into_iter().find(|(key, _)| *key == storage).unwrap().1;
            assert_eq!(rendered(&stage, &variant, &quads), rendered(&stage, &dropped, &quads), "{row}, {storage}");
        }
    }
}

/// A plan declares an image as order-dependent if a drawing order can change it, and only then.
#[test]
fn plans_declare_whether_the_order_of_arrival_matters() {
    let stage = stage::device();
    let planned = |variant: &Variant| {
        let provides = [target("spirv").unwrap().provides, &[Feature::OwnEntryPoints]].concat();
        plan(variant, &variant.select(&provides).unwrap(), &Registry::builtin()).unwrap()
    };
    let first_and_last = |variant: &Variant| {
        let quads = scene(9, 5);
        let backwards: Vec<Quad> = quads.iter().rev().copied().collect();
        (rendered(&stage, variant, &quads).0, rendered(&stage, variant, &backwards).0)
    };
    for row in ROWS {
        for (storage, variant) in with_row(row, 3, "rgba8") {
            assert_eq!(planned(&variant).arrival(), Arrival::Race, "{row}, {storage}");
            let (forwards, backwards) = first_and_last(&variant);
            assert_ne!(forwards, backwards, "{row}, {storage}");
        }
        let set = [("overflow", row), ("cull", "none"), ("sync", "interlock_ordered"), ("k", "3")];
        assert_eq!(planned(&variant("kb_ps", &set).unwrap()).arrival(), Arrival::Submission, "{row}");
    }
    let mut any = 0;
    for (key, variant) in with_row("drop", 3, "rgba8") {
        // A storage of 64-bit words needs other targets.
        if variant.select(target("wgsl").unwrap().provides).is_err() {
            continue;
        }
        let plan = planned(&variant);
        if storage(&variant).may_provide(Capability::KeepsBest) && plan.hazards.is_empty() {
            assert_eq!(plan.arrival(), Arrival::Any, "{key}");
            let (forwards, backwards) = first_and_last(&variant);
            assert_eq!(forwards, backwards, "{key}");
            any += 1;
        }
    }
    assert!(any > 1, "{any} storages keep the best under a lock");
}

/// Under every schedule keys and transmittance are the same.
#[test]
fn schedules_change_only_colours() {
    let quads: Vec<Quad> = scene(12, 2).into_iter().map(|quad| quad.at(0, 0, SIZE, SIZE)).collect();
    let through: f64 = quads.iter().map(|quad| 1.0 - f64::from(quad.color[3]) / 255.0).product();
    for row in ROWS {
        for (storage, variant) in with_row(row, 4, "rgba8") {
            let best: Vec<u32> = oracle::kept_words(&oracle::PLAIN, &quads, Some(4))[0].iter().map(|w| w[0]).collect();
            for seed in 0..3 {
                let (kept, pixels) =
                    cpu_device::draw(&mut cpu_device::device(&variant, FragmentOrder::Shuffled(seed)), &quads);
                for (kept, pixel) in kept.iter().zip(pixels) {
                    let off = (1.0 - f64::from(pixel[3]) - through).abs();
                    assert!(off <= 8.0 * 0.51 / 255.0, "{row}, {storage}, seed {seed}: {off}");
                    let keys: Vec<u32> = kept.iter().map(|words| words[0]).collect();
                    let keeps_best = row != "merge_closest" && !has_ranges(&variant);
                    assert!(!keeps_best || keys == best, "{row}, {storage}, seed {seed}: {keys:x?}");
                }
            }
        }
    }
}

/// Of equally close pairs the farther merges, in any order of arrival: the front fragment stays bit-identical.
#[test]
fn of_equally_close_pairs_the_farther_merges() {
    let stage = stage::device();
    let color = |alpha| [200, 100, 50, alpha];
    let quads: Vec<Quad> =
        [0.25, 0.5, 0.75].into_iter().zip([90, 60, 120]).map(|(d, a)| Quad::whole(d, color(a))).collect();
    for (storage, variant) in with_row("merge_closest", 2, "rgba8") {
        let mut renderer = renderer(&stage, &shaders(&variant, "wgsl"), &settings()).unwrap();
        for quads in orders(&quads) {
            let kept = render_frame(&stage, &mut renderer, &quads).kept.swap_remove(0);
            assert_eq!(kept.iter().map(|words| words[0]).collect::<Vec<_>>(), [0.25f32.to_bits(), 0.5f32.to_bits()]);
            assert_eq!(kept[0][1], u32::from_le_bytes(color(90)), "{storage}");
            // A colour over itself keeps its value. The alpha is 60 + (1 - 60 / 255) * 120, in 255ths.
            assert_eq!(kept[1][1], u32::from_le_bytes(color(152)), "{storage}");
        }
    }
}

/// Merging two fully transparent fragments must not divide by zero.
#[test]
fn two_transparent_fragments_merge_into_a_transparent_one() {
    let stage = stage::device();
    let quads = [0.5, 0.25, 0.75].map(|depth| Quad::whole(depth, [255, 128, 9, 0]));
    for row in ROWS {
        for color in ["rgba8", "vec4"] {
            for (storage, variant) in with_row(row, 1, color) {
                for pixel in rendered(&stage, &variant, &quads).0 {
                    let is_background = pixel.iter().zip(BACKGROUND).all(|(a, b)| (f64::from(*a) - b).abs() < 0.001);
                    assert!(is_background, "{row}, {storage}, {color}: {pixel:?}");
                }
            }
        }
    }
}
