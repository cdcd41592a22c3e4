//! Storages in textures, written by fixed function: what depth test, stencil and targets keep, against the oracle.

use fragbuf_runtime::{Renderer, Settings, block_on};

use crate::capture::scattered;
use crate::oracle::{self, PLAIN, Words};
use crate::order::orders;
use crate::quads::{Quad, SIZE};
use crate::stage::{self, BACKGROUND, Seen, described, renderer, see, settings, shaders, technique};

/// Whole frames and scattered quads, with equal depths, the nearest plane and the farthest.
fn scenes() -> Vec<Vec<Quad>> {
    let color = |index: u32| [index as u8 * 30, 255 - index as u8 * 30, 7, 100 + index as u8];
    let flat = |depths: &[f32]| (0..).zip(depths).map(|(index, depth)| Quad::whole(*depth, color(index))).collect();
    vec![
        Vec::new(),
        flat(&[0.5, 0.5, 0.5]),
        flat(&[0.75, 1.0, 0.0, 0.0]),
        flat(&[1.0, 1.0]),
        flat(&[0.25, 0.5, 0.25, 0.75]),
        scattered(8, 3),
        scattered(8, 4),
    ]
}

/// The first of the nearest fragments in front of the far plane.
fn nearest(quads: &[Quad], x: u32, y: u32) -> Option<Quad> {
    let fragments = oracle::fragments(quads, x, y).into_iter().filter(|quad| quad.depth < 1.0);
    fragments.min_by(|a, b| a.depth.total_cmp(&b.depth))
}

fn check_nearest(seen: &Seen, quads: &[Quad], words: fn(&Quad) -> Words) {
    for (kept, (x, y)) in seen.kept.iter().zip(oracle::pixels()) {
        let expected: Vec<Words> = nearest(quads, x, y).iter().map(words).collect();
        assert_eq!(*kept, expected, "{x}, {y} of {quads:?}");
    }
}

fn check_picture(seen: &Seen, quads: &[Quad]) {
    for (pixel, (x, y)) in seen.pixels.iter().zip(oracle::pixels()) {
        let layers: Vec<Quad> = nearest(quads, x, y).into_iter().collect();
        let color = oracle::over(&layers);
        for channel in 0..3 {
            let expected = color[channel] + (1.0 - color[3]) * BACKGROUND[channel];
            assert!((f64::from(pixel[channel]) - expected).abs() <= 1.0 / 255.0, "{x}, {y} of {quads:?}");
        }
    }
}

fn each_frame(renderer: &mut Renderer, stage: &fragbuf_runtime::headless::Headless, inspect: impl Fn(&Seen, &[Quad])) {
    for scene in scenes() {
        let scene: Vec<Quad> = (0..).zip(scene).map(|(id, quad)| quad.named(id)).collect();
        for quads in orders(&scene) {
            inspect(&see(stage, renderer, &quads), &quads);
        }
    }
}

#[test]
fn the_depth_test_keeps_the_nearest_and_of_equal_ones_the_first() {
    let stage = stage::device();
    for slice in [None, Some(5)] {
        let settings = Settings { slice, ..settings() };
        let mut renderer = renderer(&stage, &shaders(&technique("z_buffer", &[]), "wgsl"), &settings).unwrap();
        each_frame(&mut renderer, &stage, |seen, quads| {
            // Every slice clears the textures for itself: afterwards they hold the last one's.
            if slice.is_none() {
                check_nearest(seen, quads, PLAIN.words);
            }
            check_picture(seen, quads);
        });
    }
}

/// One word of a fragment for each target, and no target where there is no word.
#[test]
fn a_payload_has_as_many_targets_as_words() {
    let stage = stage::device();
    let text = "buffer Wide from z_buffer {
        fragment { id: u32, color: vec4, depth: f32 }
        where |f, u| f.id != 1;
    }";
    let mut wide = renderer(&stage, &shaders(&described(text), "wgsl"), &settings()).unwrap();
    let words = |quad: &Quad| {
        let color = quad.color.map(|channel| (f32::from(channel) / 255.0).to_bits());
        [&[quad.depth.to_bits(), quad.id], &color[..]].concat()
    };
    each_frame(&mut wide, &stage, |seen, quads| {
        let admitted: Vec<Quad> = quads.iter().filter(|quad| quad.id != 1).copied().collect();
        check_nearest(seen, &admitted, words);
    });
    let text = "buffer Depth from z_buffer {
        fragment { depth: f32 }
        resolve |fragments, u| {
            let mut nearest = 0.0;
            for f in fragments { nearest = f.depth; }
            vec4(nearest, nearest, nearest, 1.0)
        }
    }";
    let mut depth = renderer(&stage, &shaders(&described(text), "wgsl"), &settings()).unwrap();
    each_frame(&mut depth, &stage, |seen, quads| {
        check_nearest(seen, quads, |quad| vec![quad.depth.to_bits()]);
        for (pixel, (x, y)) in seen.pixels.iter().zip(oracle::pixels()) {
            let expected = nearest(quads, x, y).map_or(BACKGROUND[0] as f32, |quad| quad.depth);
            assert!((pixel[0] - expected).abs() <= 1.0 / 255.0, "{x}, {y} of {quads:?}");
        }
    });
}

/// Textures follow the frame's size, and are counted among its bytes.
#[test]
fn textures_are_as_large_as_the_frame() {
    let stage = stage::device();
    let shaders = shaders(&technique("z_buffer", &[]), "wgsl");
    let small = Settings { width: 3, height: 70, ..settings() };
    let mut renderer = renderer(&stage, &shaders, &small).unwrap();
    let counters = 4 * fragbuf_templates::COUNTERS.len() as u64;
    assert_eq!(renderer.allocated_bytes(), 4 * 2 * 3 * 70 + counters);
    assert_eq!(renderer.texture("depths").map(|texture| (texture.width(), texture.height())), Some((3, 70)));
    assert!(renderer.buffer("depths").is_none() && renderer.texture("counters").is_none());
    block_on(&stage.device, renderer.resize(SIZE, SIZE)).unwrap().unwrap();
    assert_eq!(renderer.allocated_bytes(), 4 * 2 * u64::from(SIZE * SIZE) + counters);
    let quads = scattered(8, 9);
    check_nearest(&see(&stage, &mut renderer, &quads), &quads, PLAIN.words);
}

/// The first k fragments of a pixel, in the order of drawing, and how many came too late. Quads cover whole pixels.
#[test]
fn stencil_routing_keeps_the_first() {
    let stage = stage::device();
    let variant = technique("kb_sr", &[("counters", "all")]);
    let mut renderer = renderer(&stage, &shaders(&variant, "wgsl"), &settings()).unwrap();
    for k in [4, 3, 1] {
        block_on(&stage.device, renderer.set_k(k)).unwrap().unwrap();
        each_frame(&mut renderer, &stage, |seen, quads| check_first(seen, quads, k as usize));
    }
    // More than a stencil has room for: some of them are counted.
    block_on(&stage.device, renderer.set_k(4)).unwrap().unwrap();
    let many: Vec<Quad> = (0..300).map(|index| Quad::whole(index as f32 / 300.0, [9, index as u8, 9, 9])).collect();
    let seen = see(&stage, &mut renderer, &many);
    assert_eq!(seen.counters.get("samples_exhausted"), (255 - 4) * SIZE * SIZE);
    assert!(seen.kept.iter().all(|kept| kept.len() == 4 && kept[3] == (PLAIN.words)(&many[3])));
}

/// As many words as there are targets.
#[test]
fn stencil_routing_takes_eight_words() {
    let stage = stage::device();
    let text = "buffer Wide from kb_sr { fragment { id: u32, color: vec4, depth: f32, uv: vec2 } }";
    let wide = fragbuf_syntax::parse(text, "wide.fragbuf").draft.unwrap();
    let wide = fragbuf_model::check(&wide, &fragbuf_templates::Registry::builtin()).unwrap();
    assert_eq!(wide.attributes.len(), 4);
    let refused =
        described_faults("buffer Wider from kb_sr { fragment { color: vec4, depth: f32, uv: vec2, a: u32, b: u32 } }");
    assert!(refused.contains("there are eight targets"), "{refused}");
    let made = renderer(&stage, &shaders(&wide, "wgsl"), &settings());
    assert!(
        made.is_ok_and(|renderer| renderer.texture("entries_uv_y").is_some_and(|texture| texture.sample_count() == 4))
    );
}

/// What cannot be is refused with the way out.
#[test]
fn what_fixed_function_cannot_keep_is_refused() {
    let cases = [
        ("buffer B from z_buffer { keep 8; }", "write `keep 1;`"),
        ("buffer B from z_buffer { keep 1 least |f| f.color.x; }", "depth decides which fragment is worst"),
        ("buffer B from z_buffer { sync: spin_lock; }", "`sync: fixed_function`"),
        ("buffer B from kb_sr { keep 5; }", "write `keep 4;`"),
        ("buffer B from kplus_array { sync: fixed_function; }", "leaves writers to depth test"),
    ];
    for (text, hint) in cases {
        let faults = described_faults(text);
        assert!(faults.contains(hint), "{text}: {faults}");
    }
    let variant = technique("kb_sr", &[]);
    let refusal = variant.select(fragbuf_targets::target("msl").unwrap().offers).unwrap_err();
    assert!(refusal.to_string().contains("sample mask") || refusal.to_string().contains("entry points"), "{refusal}");
}

fn described_faults(text: &str) -> String {
    let parsed = fragbuf_syntax::parse(text, "test.fragbuf");
    fragbuf_model::check(&parsed.draft.unwrap(), &fragbuf_templates::Registry::builtin()).unwrap_err().to_string()
}

fn check_first(seen: &Seen, quads: &[Quad], k: usize) {
    let (mut late, mut pixels) = (0, seen.pixels.iter());
    for (kept, (x, y)) in seen.kept.iter().zip(oracle::pixels()) {
        let fragments = oracle::fragments(quads, x, y);
        let mut first: Vec<Quad> = fragments.iter().take(k).copied().collect();
        late += fragments.len() - first.len();
        first.sort_by_key(PLAIN.words);
        assert_eq!(*kept, first.iter().map(PLAIN.words).collect::<Vec<_>>(), "{x}, {y} of {quads:?}");
        let (color, pixel) = (oracle::over(&first), pixels.next().unwrap());
        for channel in 0..3 {
            let expected = color[channel] + (1.0 - color[3]) * BACKGROUND[channel];
            assert!((f64::from(pixel[channel]) - expected).abs() <= 1.0 / 255.0, "{x}, {y} of {quads:?}");
        }
    }
    let count = |name: &str| seen.counters.get(name) as usize;
    assert_eq!(count("samples_exhausted"), late, "{quads:?}");
    // Where two triangles meet, both have a fragment, each for its own samples.
    assert!(count("generated") >= seen.kept.iter().map(Vec::len).sum::<usize>() + late);
}
