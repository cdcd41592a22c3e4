//! Compares storages in textures, which depth test, stencil test and targets write, with the oracle.

use fragbuf_runtime::{Renderer, Settings, block_on};

use crate::capture::scattered;
use crate::oracle::{self, PLAIN, Words};
use crate::order::orders;
use crate::quads::{Quad, SIZE};
use crate::stage::{self, BACKGROUND, FrameResult, described, render_frame, renderer, settings, shaders, technique};

/// Returns scenes of whole-frame and scattered quads, with equal depths and depths on the near and far plane.
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

/// Returns the first of the nearest fragments in front of the far plane.
fn nearest(quads: &[Quad], x: u32, y: u32) -> Option<Quad> {
    let fragments = oracle::fragments(quads, x, y).into_iter().filter(|quad| quad.depth < 1.0);
    fragments.min_by(|a, b| a.depth.total_cmp(&b.depth))
}

fn check_nearest(seen: &FrameResult, quads: &[Quad], words: fn(&Quad) -> Words) {
    for (kept, (x, y)) in seen.kept.iter().zip(oracle::pixels()) {
        let expected: Vec<Words> = nearest(quads, x, y).iter().map(words).collect();
        assert_eq!(*kept, expected, "{x}, {y} of {quads:?}");
    }
}

fn check_image(seen: &FrameResult, quads: &[Quad]) {
    for (pixel, (x, y)) in seen.pixels.iter().zip(oracle::pixels()) {
        let layers: Vec<Quad> = nearest(quads, x, y).into_iter().collect();
        let color = oracle::over(&layers);
        for channel in 0..3 {
            let expected = color[channel] + (1.0 - color[3]) * BACKGROUND[channel];
            assert!((f64::from(pixel[channel]) - expected).abs() <= 1.0 / 255.0, "{x}, {y} of {quads:?}");
        }
    }
}

fn each_frame(
    renderer: &mut Renderer,
    stage: &fragbuf_runtime::headless::Headless,
    inspect: impl Fn(&FrameResult, &[Quad]),
) {
    for scene in scenes() {
        let scene: Vec<Quad> = (0..).zip(scene).map(|(id, quad)| quad.named(id)).collect();
        for quads in orders(&scene) {
            inspect(&render_frame(stage, renderer, &quads), &quads);
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
            // Every slice clears the textures, so they hold only the last slice afterwards.
            if slice.is_none() {
                check_nearest(seen, quads, PLAIN.words);
            }
            check_image(seen, quads);
        });
    }
}

/// Each word of a fragment has a target, and a payload without words has none.
#[test]
fn a_payload_has_as_many_targets_as_words() {
    let stage = stage::device();
    let source = "buffer Wide from z_buffer {
        fragment { id: u32, color: vec4, depth: f32 }
        where |f, u| f.id != 1;
    }";
    let mut wide = renderer(&stage, &shaders(&described(source), "wgsl"), &settings()).unwrap();
    let words = |quad: &Quad| {
        let color = quad.color.map(|channel| (f32::from(channel) / 255.0).to_bits());
        [&[quad.depth.to_bits(), quad.id], &color[..]].concat()
    };
    each_frame(&mut wide, &stage, |seen, quads| {
        let admitted: Vec<Quad> = quads.iter().filter(|quad| quad.id != 1).copied().collect();
        check_nearest(seen, &admitted, words);
    });
    let source = "buffer Depth from z_buffer {
        fragment { depth: f32 }
        resolve |fragments, u| {
            let mut nearest = 0.0;
            for f in fragments { nearest = f.depth; }
            vec4(nearest, nearest, nearest, 1.0)
        }
    }";
    let mut depth = renderer(&stage, &shaders(&described(source), "wgsl"), &settings()).unwrap();
    each_frame(&mut depth, &stage, |seen, quads| {
        check_nearest(seen, quads, |quad| vec![quad.depth.to_bits()]);
        for (pixel, (x, y)) in seen.pixels.iter().zip(oracle::pixels()) {
            let expected = nearest(quads, x, y).map_or(BACKGROUND[0] as f32, |quad| quad.depth);
            assert!((pixel[0] - expected).abs() <= 1.0 / 255.0, "{x}, {y} of {quads:?}");
        }
    });
}

/// Textures have the frame's size, and allocated bytes include them.
#[test]
fn textures_have_the_size_of_the_frame() {
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
    check_nearest(&render_frame(&stage, &mut renderer, &quads), &quads, PLAIN.words);
}

/// The first k fragments of a pixel in drawing order are kept, and later ones are counted. Quads cover whole pixels.
#[test]
fn stencil_routing_keeps_the_first() {
    let stage = stage::device();
    let variant = technique("kb_sr", &[("counters", "all")]);
    let mut renderer = renderer(&stage, &shaders(&variant, "wgsl"), &settings()).unwrap();
    for k in [4, 3, 1] {
        block_on(&stage.device, renderer.set_k(k)).unwrap().unwrap();
        each_frame(&mut renderer, &stage, |seen, quads| check_first(seen, quads, k as usize));
    }
    // More fragments than a stencil value can count: only some of them are counted.
    block_on(&stage.device, renderer.set_k(4)).unwrap().unwrap();
    let many: Vec<Quad> = (0..300).map(|index| Quad::whole(index as f32 / 300.0, [9, index as u8, 9, 9])).collect();
    let seen = render_frame(&stage, &mut renderer, &many);
    assert_eq!(seen.counters.get("samples_exhausted"), (255 - 4) * SIZE * SIZE);
    assert!(seen.kept.iter().all(|kept| kept.len() == 4 && kept[3] == (PLAIN.words)(&many[3])));
}

/// An entry has at most as many words as there are targets.
#[test]
fn stencil_routing_takes_eight_words() {
    let stage = stage::device();
    let source = "buffer Wide from kb_sr { fragment { id: u32, color: vec4, depth: f32, uv: vec2 } }";
    let wide = fragbuf_syntax::parse(source, "wide.fragbuf").draft.unwrap();
    let wide = fragbuf_model::check(&wide, &fragbuf_templates::Registry::builtin()).unwrap();
    assert_eq!(wide.attributes.len(), 4);
    let errors =
        errors_of("buffer Wider from kb_sr { fragment { color: vec4, depth: f32, uv: vec2, a: u32, b: u32 } }");
    assert!(errors.contains("one per render target"), "{errors}");
    let renderer = renderer(&stage, &shaders(&wide, "wgsl"), &settings());
    assert!(
        renderer
            .is_ok_and(|renderer| renderer.texture("entries_uv_y").is_some_and(|texture| texture.sample_count() == 4))
    );
}

/// Unsupported descriptions are rejected with a suggested fix.
#[test]
fn descriptions_that_fixed_function_cannot_keep_are_rejected() {
    let cases = [
        ("buffer B from z_buffer { keep 8; }", "write `keep 1;`"),
        ("buffer B from z_buffer { keep 1 least |f| f.color.x; }", "depth as the key, without a criterion"),
        ("buffer B from z_buffer { sync: spin_lock; }", "`sync: fixed_function`"),
        ("buffer B from kb_sr { keep 5; }", "write `keep 4;`"),
        ("buffer B from kplus_array { sync: fixed_function; }", "choose `sync: spin_lock`"),
    ];
    for (source, help) in cases {
        let errors = errors_of(source);
        assert!(errors.contains(help), "{source}: {errors}");
    }
    let variant = technique("kb_sr", &[]);
    let missing = variant.select(fragbuf_targets::target("msl").unwrap().provides).unwrap_err();
    assert!(missing.to_string().contains("sample mask") || missing.to_string().contains("entry points"), "{missing}");
}

fn errors_of(source: &str) -> String {
    let parsed = fragbuf_syntax::parse(source, "test.fragbuf");
    fragbuf_model::check(&parsed.draft.unwrap(), &fragbuf_templates::Registry::builtin()).unwrap_err().to_string()
}

fn check_first(seen: &FrameResult, quads: &[Quad], k: usize) {
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
    // Where two triangles share a pixel, each has a fragment for its samples.
    assert!(count("generated") >= seen.kept.iter().map(Vec::len).sum::<usize>() + late);
}
