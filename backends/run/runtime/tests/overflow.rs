//! Overflow rows on every storage that can lose a fragment: the tail's colour against exact arithmetic, for several orders of
//! arrival; and `fail`, which shows an error colour instead of a wrong image.

use fragbuf_model::{Draft, SourceSpan, Variant, check};
use fragbuf_runtime::{PoolSize, Settings, Sizing};
use fragbuf_targets::target;
use fragbuf_templates::Registry;
use fragbuf_templates::vocabulary::{Capability, Feature};

use crate::order::Numbers;
use crate::quads::Quad;
use crate::stage::{BACKGROUND, device, render_frame, renderer, settings, shaders, technique};

/// The number of fragments that are kept in front of a tail.
const KEPT: usize = 3;

fn layers() -> Vec<Quad> {
    let color = |i: u32| [(i * 37 % 256) as u8, (255 - i * 29 % 256) as u8, (i * 91 % 256) as u8, (40 + i * 17) as u8];
    (0..9).map(|i| Quad::whole(0.1 + 0.08 * i as f32, color(i))).collect()
}

/// Returns the nearest fragments composited, the tail behind them as in Maule et al., and the background last.
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

/// Returns every technique that keeps the three best and supports a weighted tail.
fn with_a_tail() -> Vec<(String, Variant)> {
    let registry = Registry::builtin();
    let described = registry.techniques().iter().filter_map(|technique| {
        let span = SourceSpan::new("overflow", 1, 1);
        let mut draft = Draft::from_technique(&technique.key, &span);
        for (name, value) in [("k", "3"), ("overflow", "weighted_tail")] {
            draft.set(name, value, &span).ok()?;
        }
        let variant = check(&draft, &registry).ok()?;
        let native = [target("wgsl-native")?.provides, &[Feature::OwnEntryPoints]].concat();
        let provides = variant.select(&native).ok()?.provides();
        let keeps_best = provides.contains(&Capability::KeepsBest) || provides.contains(&Capability::SelectsBest);
        keeps_best.then(|| (technique.key.clone(), variant))
    });
    described.collect()
}

#[test]
fn the_tail_is_exact_and_independent_of_the_order() {
    let stage = device();
    let techniques = with_a_tail();
    assert!(techniques.len() >= 8, "{:?}", techniques.iter().map(|(key, _)| key).collect::<Vec<_>>());
    for (key, variant) in &techniques {
        let mut renderer = renderer(&stage, &shaders(variant, "wgsl-native"), &settings()).unwrap();
        let mut numbers = Numbers::seeded(5);
        let mut quads = layers();
        let exact = expected(quads.clone());
        let mut first: Option<Vec<[f32; 4]>> = None;
        for _ in 0..6 {
            let seen = render_frame(&stage, &mut renderer, &quads);
            for (channel, value) in exact.iter().enumerate() {
                let shown = f64::from(seen.pixels[0][channel]);
                assert!((shown - value).abs() <= 1.0 / 255.0, "{key}: {:?} instead of {exact:?}", seen.pixels[0]);
            }
            assert_eq!(
                *first.get_or_insert_with(|| seen.pixels.clone()),
                seen.pixels,
                "{key}: the image depends on the order"
            );
            for index in (1..quads.len()).rev() {
                quads.swap(index, numbers.below(index as u32 + 1) as usize);
            }
        }
    }
}

#[test]
fn fail_shows_the_error_colour_after_a_pool_overflow() {
    let stage = device();
    let settings = Settings { sizing: Sizing::Capacity(PoolSize::Fragments(256 * 4)), ..settings() };
    for key in ["ab_ll", "ab_array"] {
        let shaders = shaders(&technique(key, &[("overflow", "fail")]), "wgsl");
        let mut renderer = renderer(&stage, &shaders, &settings).unwrap();
        let shown = render_frame(&stage, &mut renderer, &layers()).pixels;
        assert!(shown.iter().all(|[r, g, b, _]| [*r, *g, *b] == [1.0, 0.0, 1.0]), "{key}: {:?}", shown[0]);
        let few = render_frame(&stage, &mut renderer, &layers()[..2]).pixels;
        assert!(few.iter().all(|[r, g, b, _]| [*r, *g, *b] != [1.0, 0.0, 1.0]), "{key}: {:?}", few[0]);
    }
}

#[test]
fn fail_ignores_displaced_fragments() {
    let stage = device();
    let shaders = shaders(&technique("kplus_array", &[("overflow", "fail"), ("k", "2")]), "wgsl");
    let mut renderer = renderer(&stage, &shaders, &settings()).unwrap();
    let shown = render_frame(&stage, &mut renderer, &layers()).pixels;
    assert!(shown.iter().all(|[r, g, b, _]| [*r, *g, *b] != [1.0, 0.0, 1.0]), "{:?}", shown[0]);
}
