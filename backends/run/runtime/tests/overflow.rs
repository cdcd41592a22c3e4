//! What becomes of fragments that find no place, on every storage that can lose one: the tail's colour against exact
//! arithmetic, for every order of arrival; and the frame that shows nothing rather than something wrong.

use fragbuf_targets::target;
use fragbuf_model::{Draft, Origin, Variant, check};
use fragbuf_runtime::{Room, Settings, Sizing};
use fragbuf_templates::Registry;
use fragbuf_templates::vocabulary::{Capability, Fact};

use crate::order::Numbers;
use crate::quads::Quad;
use crate::stage::{BACKGROUND, device, renderer, see, settings, shaders, technique};

/// Fragments that are kept in front of a tail.
const KEPT: usize = 3;

fn layers() -> Vec<Quad> {
    let color = |i: u32| [(i * 37 % 256) as u8, (255 - i * 29 % 256) as u8, (i * 91 % 256) as u8, (40 + i * 17) as u8];
    (0..9).map(|i| Quad::whole(0.1 + 0.08 * i as f32, color(i))).collect()
}

/// The nearest one over the other, the tail behind them as Maule et al. have it, the background last.
fn expected(mut quads: Vec<Quad>) -> [f64; 3] {
    quads.sort_by(|a, b| a.depth.total_cmp(&b.depth));
    let channels = |quad: &Quad| quad.color.map(|byte| f64::from(byte) / 255.0);
    let (mut color, mut transmittance) = ([0.0; 3], 1.0);
    let mut put = |front: [f64; 3], alpha: f64| {
        (0..3).for_each(|channel| color[channel] += transmittance * alpha * front[channel]);
        transmittance *= 1.0 - alpha;
    };
    let (kept, tail) = quads.split_at(KEPT);
    for [r, g, b, a] in kept.iter().map(channels) {
        put([r, g, b], a);
    }
    let alpha: f64 = tail.iter().map(|quad| channels(quad)[3]).sum();
    let mean = [0, 1, 2].map(|c| tail.iter().map(|quad| channels(quad)[c] * channels(quad)[3]).sum::<f64>() / alpha);
    put(mean, 1.0 - tail.iter().map(|quad| 1.0 - channels(quad)[3]).product::<f64>());
    put(BACKGROUND, 1.0);
    color
}

/// Every technique that keeps three and hands on the others whole, and is not racy.
fn with_a_tail() -> Vec<(String, Variant)> {
    let registry = Registry::builtin();
    let described = registry.techniques().iter().filter_map(|technique| {
        let origin = Origin::new("overflow", 1, 1);
        let mut draft = Draft::from_technique(&technique.key, &origin);
        for (name, value) in [("k", "3"), ("overflow", "weighted_tail")] {
            draft.set(name, value, &origin).ok()?;
        }
        let variant = check(&draft, &registry).ok()?;
        let native = [target("wgsl-native")?.offers, &[Capability::OwnEntryPoints]].concat();
        let offers = variant.select(&native).ok()?.offers();
        let keeps_best = offers.contains(&Fact::KeepsBest) || offers.contains(&Fact::SelectsBest);
        keeps_best.then(|| (technique.key.clone(), variant))
    });
    described.collect()
}

#[test]
fn the_tail_is_the_same_for_every_order_and_what_arithmetic_says() {
    let stage = device();
    let techniques = with_a_tail();
    assert!(techniques.len() >= 8, "{:?}", techniques.iter().map(|(key, _)| key).collect::<Vec<_>>());
    for (key, variant) in &techniques {
        let mut renderer = renderer(&stage, &shaders(variant, "wgsl-native"), &settings()).unwrap();
        let mut numbers = Numbers::seeded(5);
        let mut quads = layers();
        let wanted = expected(quads.clone());
        let mut first: Option<Vec<[f32; 4]>> = None;
        for _ in 0..6 {
            let seen = see(&stage, &mut renderer, &quads);
            for (channel, value) in wanted.iter().enumerate() {
                let shown = f64::from(seen.pixels[0][channel]);
                assert!((shown - value).abs() <= 1.0 / 255.0, "{key}: {:?}, not {wanted:?}", seen.pixels[0]);
            }
            assert_eq!(*first.get_or_insert_with(|| seen.pixels.clone()), seen.pixels, "{key}: an order shows");
            for index in (1..quads.len()).rev() {
                quads.swap(index, numbers.below(index as u32 + 1) as usize);
            }
        }
    }
}

#[test]
fn a_frame_that_lost_a_fragment_for_want_of_room_shows_nothing_else() {
    let stage = device();
    let settings = Settings { sizing: Sizing::Reserve(Room::Fragments(256 * 4)), ..settings() };
    for key in ["ab_ll", "ab_array"] {
        let shaders = shaders(&technique(key, &[("overflow", "fail")]), "wgsl");
        let mut renderer = renderer(&stage, &shaders, &settings).unwrap();
        let shown = see(&stage, &mut renderer, &layers()).pixels;
        assert!(shown.iter().all(|[r, g, b, _]| [*r, *g, *b] == [1.0, 0.0, 1.0]), "{key}: {:?}", shown[0]);
        let few = see(&stage, &mut renderer, &layers()[..2]).pixels;
        assert!(few.iter().all(|[r, g, b, _]| [*r, *g, *b] != [1.0, 0.0, 1.0]), "{key}: {:?}", few[0]);
    }
}

#[test]
fn what_better_fragments_displace_is_no_failure() {
    let stage = device();
    let shaders = shaders(&technique("kplus_array", &[("overflow", "fail"), ("k", "2")]), "wgsl");
    let mut renderer = renderer(&stage, &shaders, &settings()).unwrap();
    let shown = see(&stage, &mut renderer, &layers()).pixels;
    assert!(shown.iter().all(|[r, g, b, _]| [*r, *g, *b] != [1.0, 0.0, 1.0]), "{:?}", shown[0]);
}
