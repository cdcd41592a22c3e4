//! What is displaced and not dropped: blended behind what is kept, merged with the last, or the closest two made one. Each
//! row against a model of its own over the fragments in the order of drawing, on every storage that the rules allow; and
//! the law that all of them share: as much light comes through as through every fragment, whatever the order.

use std::collections::BTreeSet;

use fragbuf_targets::target;
use fragbuf_codegen::{Arrival, plan};
use fragbuf_cpu::Order;
use fragbuf_model::{Draft, Origin, Variant, check};
use fragbuf_runtime::headless::Offscreen;
use fragbuf_templates::Registry;
use fragbuf_templates::vocabulary::{Capability, Fact, Row};

use crate::cpu_device;
use crate::oracle::{self, pixels};
use crate::order::{Numbers, orders};
use crate::quads::{Quad, SIZE};
use crate::stage::{self, BACKGROUND, FORMAT, draw_over, renderer, see, settings, shaders};

const ROWS: [&str; 3] = ["tail_blend", "merge_last", "merge_closest"];

/// A fragment as a model sees it: depth and straight colour.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Layer {
    depth: f32,
    color: [f64; 4],
}

fn layer(quad: &Quad) -> Layer {
    Layer { depth: quad.depth, color: quad.color.map(|channel| f64::from(channel) / 255.0) }
}

/// What a pixel keeps, nearest first, and the premultiplied colour behind that.
#[derive(Clone, Debug, Default)]
struct Pixel {
    kept: Vec<Layer>,
    tail: [f64; 4],
}

/// `near` over `far`, straight colours both.
fn over(near: [f64; 4], far: [f64; 4]) -> [f64; 4] {
    let shares = [near[3], (1.0 - near[3]) * far[3]];
    let alpha = shares[0] + shares[1];
    let channel = |at: usize| if alpha > 0.0 { (shares[0] * near[at] + shares[1] * far[at]) / alpha } else { near[at] };
    [channel(0), channel(1), channel(2), alpha]
}

impl Pixel {
    fn insert(&mut self, new: Layer) {
        let place = self.kept.partition_point(|kept| kept.depth <= new.depth);
        self.kept.insert(place, new);
    }

    fn displaces_into_a_tail(&mut self, lost: Layer) {
        let [r, g, b, a] = lost.color;
        let old = self.tail;
        self.tail = [r * a, g * a, b * a, a];
        (0..4).for_each(|at| self.tail[at] += (1.0 - a) * old[at]);
    }

    /// One fragment more, of which at most `k` are kept, or one in each of `k` ranges of depth.
    fn comes(&mut self, row: &str, has_ranges: bool, k: usize, new: Layer) {
        if has_ranges {
            let range = |layer: &Layer| ((f64::from(layer.depth) * 1.0e6).floor() * k as f64 / 1.0e6).floor() as usize;
            let Some(at) = self.kept.iter().position(|kept| range(kept) == range(&new)) else {
                return self.insert(new);
            };
            let old = self.kept[at];
            if new.depth < old.depth {
                self.kept[at] = new;
            }
            return self.displaces_into_a_tail(if new.depth < old.depth { old } else { new });
        }
        self.insert(new);
        if self.kept.len() <= k {
            return;
        }
        match row {
            "tail_blend" => {
                let lost = self.kept.remove(k);
                self.displaces_into_a_tail(lost);
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

    fn shown(&self) -> [f64; 3] {
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
    let origin = Origin::new("merging", 1, 1);
    let mut draft = Draft::from_technique(key, &origin);
    for (name, value) in set {
        draft.set(name, value, &origin).ok()?;
    }
    check(&draft, &Registry::builtin()).ok()
}

fn storage(variant: &Variant) -> &Row {
    &variant.choices.iter().find(|chosen| chosen.axis == "storage").unwrap().alternatives[0].row
}

/// Whether a fragment competes with those of its range of depth alone.
fn has_ranges(variant: &Variant) -> bool {
    storage(variant).keeps.as_ref().is_some_and(|kept| kept.group.is_some())
}

fn offers(variant: &Variant, fact: Fact) -> bool {
    let row = storage(variant);
    row.offers.contains(&fact) || row.implies.iter().any(|(_, implied)| *implied == fact)
}

/// Every technique that a row is legal with, under a lock and with nothing culled, by its storage.
fn with_row(row: &str, k: usize, color: &str) -> Vec<(String, Variant)> {
    let k = k.to_string();
    let set = [("k", &*k), ("overflow", row), ("sync", "spin_lock"), ("cull", "none"), ("fragment.color", color)];
    let registry = Registry::builtin();
    let legal = registry.techniques().iter().filter_map(|technique| variant(&technique.key, &set));
    let mut storages = BTreeSet::new();
    legal
        .map(|variant| (storage(&variant).key.clone(), variant))
        .filter(|(key, _)| storages.insert(key.clone()))
        .collect()
}

#[test]
fn the_rules_allow_what_displaces_in_turn() {
    let keys = |variants: Vec<(String, Variant)>| variants.into_iter().map(|(key, _)| key).collect::<BTreeSet<_>>();
    for (row, needed) in
        [("merge_last", Fact::CanReplace), ("merge_closest", Fact::OrderedSlots), ("tail_blend", Fact::DisplacesInTurn)]
    {
        let offering = with_row("drop", 3, "rgba8").into_iter().filter(|(_, variant)| offers(variant, needed));
        let offering = keys(offering.collect());
        assert!(!offering.is_empty(), "{row}");
        assert_eq!(keys(with_row(row, 3, "rgba8")), offering, "{row}");
    }
}

/// Quads anywhere, of different depths at uneven distances, none opaque.
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

/// The model of every pixel.
fn modelled(quads: &[Quad], row: &str, variant: &Variant, k: usize) -> Vec<Pixel> {
    let has_ranges = has_ranges(variant);
    let of_pixel = |(x, y)| {
        let mut pixel = Pixel::default();
        oracle::fragments(quads, x, y).iter().for_each(|quad| pixel.comes(row, has_ranges, k, layer(quad)));
        pixel
    };
    pixels().map(of_pixel).collect()
}

#[test]
fn every_row_does_what_its_model_does_on_every_storage() {
    let stage = stage::device();
    for row in ROWS {
        for (k, color) in [(1, "vec4"), (3, "vec4"), (3, "rgba16"), (4, "rgba8")] {
            for (storage, variant) in with_row(row, k, color) {
                let mut renderer = renderer(&stage, &shaders(&variant, "wgsl-native"), &settings()).unwrap();
                for quads in orders(&scene(9, 5)).into_iter().take(3) {
                    let seen = see(&stage, &mut renderer, &quads);
                    let models = modelled(&quads, row, &variant, k);
                    for ((kept, shown), model) in seen.kept.iter().zip(&seen.pixels).zip(&models) {
                        let keys: Vec<u32> = kept.iter().map(|words| words[0]).collect();
                        let wanted: Vec<u32> = model.kept.iter().map(|layer| layer.depth.to_bits()).collect();
                        assert_eq!(keys, wanted, "{row}, {storage}, k = {k}, {color}: {quads:?}");
                        // An entry is rounded whenever it is merged; exact floats apart.
                        let mergings = if color == "rgba8" { 1.0 + (9 - k) as f64 } else { 1.0 };
                        for (shown, wanted) in shown.iter().zip(model.shown()) {
                            let off = (f64::from(*shown) - wanted).abs();
                            assert!(off <= mergings / 255.0, "{row}, {storage}, k = {k}, {color}: off by {off}");
                        }
                    }
                }
            }
        }
    }
}

/// Of what `merge_last` keeps all but the farthest is as it came, to the bit; of what the others keep in front of a tail
/// everything is.
#[test]
fn what_does_not_merge_stays_to_the_bit() {
    let stage = stage::device();
    let k = 4;
    for (row, whole) in [("merge_last", k - 1), ("tail_blend", k)] {
        for (storage, variant) in with_row(row, k, "rgba8").into_iter().filter(|(_, variant)| !has_ranges(variant)) {
            let mut renderer = renderer(&stage, &shaders(&variant, "wgsl"), &settings()).unwrap();
            for quads in orders(&scene(12, 8)).into_iter().take(4) {
                let seen = see(&stage, &mut renderer, &quads);
                let expected = oracle::kept_words(&oracle::PLAIN, &quads, Some(k as u32));
                for (kept, wanted) in seen.kept.iter().zip(expected) {
                    let whole = whole.min(wanted.len());
                    assert_eq!(kept[..whole], wanted[..whole], "{row}, {storage}: {quads:?}");
                }
            }
        }
    }
}

/// The picture of `quads`, and how many fragments the counters call displaced.
fn shown(stage: &fragbuf_runtime::headless::Headless, variant: &Variant, quads: &[Quad]) -> (Vec<[f32; 4]>, u32) {
    let mut renderer = renderer(stage, &shaders(variant, "wgsl"), &settings()).unwrap();
    let offscreen = Offscreen::new(&stage.device, FORMAT, SIZE, SIZE).unwrap();
    draw_over(stage, &mut renderer, quads, &offscreen).unwrap();
    let counters = stage::read_counters(stage, &renderer);
    (offscreen.colors(&stage.device, &stage.queue).unwrap(), counters.get("displaced"))
}

/// Black fragments of some equal depths, of which one lets everything through: what is seen is the background, as much of
/// it as all of them let through.
#[test]
fn as_much_light_comes_through_as_through_all() {
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
                    let (pixels, displaced) = shown(&stage, &variant, &quads);
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
fn where_nothing_is_lost_the_picture_is_that_of_drop() {
    let stage = stage::device();
    let quads = scene(6, 3);
    for row in ROWS {
        for (storage, variant) in with_row(row, 6, "rgba8").into_iter().filter(|(_, variant)| !has_ranges(variant)) {
            let dropped = with_row("drop", 6, "rgba8").into_iter().find(|(key, _)| *key == storage).unwrap().1;
            assert_eq!(shown(&stage, &variant, &quads), shown(&stage, &dropped, &quads), "{row}, {storage}");
        }
    }
}

/// A plan must not promise what an order of drawing can break; and it can.
#[test]
fn plans_say_that_the_order_of_arrival_shows() {
    let stage = stage::device();
    let planned = |variant: &Variant| {
        let offers = [target("spirv").unwrap().offers, &[Capability::OwnEntryPoints]].concat();
        plan(variant, &variant.select(&offers).unwrap(), &Registry::builtin()).unwrap()
    };
    let first_and_last = |variant: &Variant| {
        let quads = scene(9, 5);
        let backwards: Vec<Quad> = quads.iter().rev().copied().collect();
        (shown(&stage, variant, &quads).0, shown(&stage, variant, &backwards).0)
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
    for (storage, variant) in with_row("drop", 3, "rgba8") {
        // A storage of 64-bit words is for other targets.
        if variant.select(target("wgsl").unwrap().offers).is_err() {
            continue;
        }
        let plan = planned(&variant);
        if offers(&variant, Fact::KeepsBest) && plan.hazards.is_empty() {
            assert_eq!(plan.arrival(), Arrival::Any, "{storage}");
            let (forwards, backwards) = first_and_last(&variant);
            assert_eq!(forwards, backwards, "{storage}");
            any += 1;
        }
    }
    assert!(any > 1, "{any} storages keep the best under a lock");
}

/// Interleaved as a GPU may, the keys and the light that comes through are the same for every schedule.
#[test]
fn schedules_change_colours_alone() {
    let quads: Vec<Quad> = scene(12, 2).into_iter().map(|quad| quad.at(0, 0, SIZE, SIZE)).collect();
    let through: f64 = quads.iter().map(|quad| 1.0 - f64::from(quad.color[3]) / 255.0).product();
    for row in ROWS {
        for (storage, variant) in with_row(row, 4, "rgba8") {
            let best: Vec<u32> = oracle::kept_words(&oracle::PLAIN, &quads, Some(4))[0].iter().map(|w| w[0]).collect();
            for seed in 0..3 {
                let (kept, pixels) = cpu_device::draw(&mut cpu_device::device(&variant, Order::Shuffled(seed)), &quads);
                for (kept, pixel) in kept.iter().zip(pixels) {
                    let off = (1.0 - f64::from(pixel[3]) - through).abs();
                    assert!(off <= 8.0 * 0.51 / 255.0, "{row}, {storage}, seed {seed}: {off}");
                    let keys: Vec<u32> = kept.iter().map(|words| words[0]).collect();
                    let promises_best = row != "merge_closest" && !has_ranges(&variant);
                    assert!(!promises_best || keys == best, "{row}, {storage}, seed {seed}: {keys:x?}");
                }
            }
        }
    }
}

/// Of pairs that are equally close the farther becomes one, in whatever order they come: the front stays to the bit.
#[test]
fn of_pairs_equally_close_the_farther_merges() {
    let stage = stage::device();
    let color = |alpha| [200, 100, 50, alpha];
    let quads: Vec<Quad> =
        [0.25, 0.5, 0.75].into_iter().zip([90, 60, 120]).map(|(d, a)| Quad::whole(d, color(a))).collect();
    for (storage, variant) in with_row("merge_closest", 2, "rgba8") {
        let mut renderer = renderer(&stage, &shaders(&variant, "wgsl"), &settings()).unwrap();
        for quads in orders(&quads) {
            let kept = see(&stage, &mut renderer, &quads).kept.swap_remove(0);
            assert_eq!(kept.iter().map(|words| words[0]).collect::<Vec<_>>(), [0.25f32.to_bits(), 0.5f32.to_bits()]);
            assert_eq!(kept[0][1], u32::from_le_bytes(color(90)), "{storage}");
            // One colour over itself is that colour: 60 + (1 - 60 / 255) * 120, in 255ths.
            assert_eq!(kept[1][1], u32::from_le_bytes(color(152)), "{storage}");
        }
    }
}

/// Of two fragments that are not seen no colour can be divided out.
#[test]
fn two_that_are_not_seen_are_one_that_is_not() {
    let stage = stage::device();
    let quads = [0.5, 0.25, 0.75].map(|depth| Quad::whole(depth, [255, 128, 9, 0]));
    for row in ROWS {
        for color in ["rgba8", "vec4"] {
            for (storage, variant) in with_row(row, 1, color) {
                for pixel in shown(&stage, &variant, &quads).0 {
                    let is_background = pixel.iter().zip(BACKGROUND).all(|(a, b)| (f64::from(*a) - b).abs() < 0.001);
                    assert!(is_background, "{row}, {storage}, {color}: {pixel:?}");
                }
            }
        }
    }
}
