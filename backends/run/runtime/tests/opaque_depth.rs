//! Transparent fragments behind opaque surfaces. With every storage, in every order, in the shader and by a depth test, the kept set is
//! the oracle's for the visible fragments. Hidden fragments use no memory and no sample, and do not affect the passes before the
//! store pass. Fragments of equal depth are visible.

use fragbuf_cpu::FragmentOrder;
use fragbuf_runtime::headless::{Headless, Offscreen};
use fragbuf_runtime::{Error, Output, PoolSize, Renderer, Settings, Shaders, Sizing, block_on};

use crate::capture::{GLASS_KEEPS, cases, glass, glass_resolve, scattered, set_uniforms};
use crate::cpu_device;
use crate::oracle::{self, PLAIN, Rules, Words};
use crate::order::orders;
use crate::quads::{Quad, SIZE, vertices};
use crate::stage::{self, BACKGROUND, FrameResult, described, render_frame, renderer, settings, shaders, technique};
use crate::translations::glsl_shaders;

/// Returns opaque surfaces: none, in front of everything, and at depths that transparent fragments have too.
fn surfaces() -> Vec<Vec<Quad>> {
    let color = |index: u8| [index * 40, 255 - index * 40, 90, 255];
    vec![
        vec![],
        vec![Quad::whole(0.0, color(1))],
        vec![Quad::whole(0.5, color(2))],
        vec![Quad::whole(0.5, color(3)).at(0, 0, 9, 16), Quad::whole(0.25, color(4)).at(4, 3, 12, 9)],
        scattered(5, 77),
    ]
}

/// Returns the depth of the nearest opaque surface at every pixel, row by row.
fn opaque_depths(opaque: &[Quad]) -> Vec<f32> {
    let nearest = |(x, y)| oracle::fragments(opaque, x, y).iter().map(|quad| quad.depth).fold(1.0, f32::min);
    oracle::pixels().map(nearest).collect()
}

/// Returns the fragments that opaque surfaces do not hide, as quads of one pixel in drawing order.
fn visible(quads: &[Quad], opaque: &[Quad]) -> Vec<Quad> {
    let depths = opaque_depths(opaque);
    let in_front = |quad: &Quad| {
        let quad = *quad;
        let pixels = oracle::pixels().zip(&depths);
        let seen = pixels.filter(move |((x, y), depth)| quad.covers(*x, *y) && quad.depth <= **depth);
        seen.map(move |((x, y), _)| quad.at(x, y, x + 1, y + 1)).collect::<Vec<Quad>>()
    };
    quads.iter().flat_map(in_front).collect()
}

/// Renders the opaque scene. Its depths are a texture of the renderer.
fn opaque_scene(stage: &Headless, quads: &[Quad], offscreen: &Offscreen) -> Renderer {
    let mut opaque = renderer(stage, &shaders(&technique("z_buffer", &[]), "wgsl"), &settings()).unwrap();
    stage::draw_over(stage, &mut opaque, quads, offscreen).unwrap();
    opaque
}

fn set_depths(stage: &Headless, renderer: &mut Renderer, opaque: &Renderer) {
    let texture = opaque.texture("depths").unwrap();
    block_on(&stage.device, renderer.set_texture("opaque", texture)).unwrap().unwrap();
}

fn offscreen(stage: &Headless) -> Offscreen {
    Offscreen::new(&stage.device, stage::FORMAT, SIZE, SIZE).unwrap()
}

/// Whether a counter counts hidden fragments.
#[derive(Clone, Copy, PartialEq)]
enum HiddenFragments {
    Counted,
    NotCounted,
}

/// Compares the kept set word by word and the colours within 1/255.
fn compare(name: &str, seen: &FrameResult, rules: &Rules, in_front: &[Quad], k: Option<u32>) {
    let expected = oracle::kept_words(rules, in_front, k);
    let images = seen.pixels.iter().zip(oracle::image(rules, in_front, k, BACKGROUND));
    for ((kept, expected), (pixel, position)) in seen.kept.iter().zip(&expected).zip(images.zip(oracle::pixels())) {
        assert_eq!(kept, expected, "{name}: kept by the pixel {position:?}");
        for (seen, expected) in pixel.0.iter().zip(pixel.1) {
            let difference = 255.0 * (f64::from(*seen) - expected).abs();
            assert!(difference <= 1.0, "{name}: the colour of the pixel {position:?} is off by {difference}/255");
        }
    }
}

/// Checks every case behind every surface, in some orders. Returns the number of hidden fragments.
fn check(shaders: &Shaders, (rules, hidden): (&Rules, HiddenFragments), prepare: impl Fn(&mut Renderer)) -> u32 {
    let stage = stage::device();
    let sizing = Sizing::Reserve(PoolSize::Fragments(32 * SIZE * SIZE));
    let settings = Settings { sizing, ..settings() };
    let mut renderer = renderer(&stage, shaders, &settings).unwrap();
    prepare(&mut renderer);
    let mut occluded = 0;
    for opaque in surfaces() {
        set_depths(&stage, &mut renderer, &opaque_scene(&stage, &opaque, &offscreen(&stage)));
        for (name, quads) in cases() {
            let quads: Vec<Quad> = (0..).zip(quads).map(|(id, quad)| quad.named(id)).collect();
            for quads in orders(&quads).into_iter().take(2) {
                let seen = render_frame(&stage, &mut renderer, &quads);
                let in_front = visible(&quads, &opaque);
                compare(name, &seen, rules, &in_front, renderer.k());
                let (all, left) = (oracle::total(rules, &quads) as u32, oracle::total(rules, &in_front) as u32);
                let count = |counter: &str| seen.counters.get(counter);
                assert_eq!(count("generated"), left, "{name} behind {opaque:?}");
                let counted = if hidden == HiddenFragments::Counted { all - left } else { 0 };
                assert_eq!(count("occluded"), counted, "{name} behind {opaque:?}");
                let kept: usize = seen.kept.iter().map(Vec::len).sum();
                let lost = count("displaced") + count("culled");
                assert_eq!(seen.counters.lost(), 0, "{:?}", seen.counters);
                assert_eq!(lost + kept as u32, left, "{name} behind {opaque:?}: {:?}", seen.counters);
                occluded += all - left;
            }
        }
    }
    occluded
}

/// Techniques, with the k that they keep.
const STORAGES: [(&str, &str); 11] = [
    ("kplus_array", "4"),
    ("kplus_heap", "4"),
    ("kplus_array_revised", "4"),
    ("kplus_ab_sb", "3"),
    ("kb_ps", "4"),
    ("kb_ll", "4"),
    ("mdt32_coplanar", "4"),
    ("ab_ll", "all"),
    ("ab_sb", "all"),
    ("ab_ll_bun", "all"),
    ("ab_ll_paged", "all"),
];

#[test]
fn hidden_fragments_never_enter_a_storage() {
    for (key, k) in STORAGES {
        let set = |value| [("k", k), ("counters", "all"), ("opaque", value)];
        let in_shader =
            check(&shaders(&technique(key, &set("in_shader")), "wgsl"), (&PLAIN, HiddenFragments::Counted), |_| {});
        let early = check(
            &shaders(&technique(key, &set("early_depth")), "wgsl-native"),
            (&PLAIN, HiddenFragments::NotCounted),
            |_| {},
        );
        assert!(in_shader == early && in_shader > 10_000, "{key}: {in_shader}, {early}");
    }
    let set = [("k", "4"), ("counters", "all"), ("opaque", "in_shader")];
    check(&shaders(&technique("kb_mdt64", &set), "wgsl-native"), (&PLAIN, HiddenFragments::Counted), |_| {});
}

/// Tests the generated SPIR-V and GLSL too, which read a depth texture in the fragment stage.
#[test]
fn every_language_reads_the_depth_buffer() {
    for (value, hidden) in [("in_shader", HiddenFragments::Counted), ("early_depth", HiddenFragments::NotCounted)] {
        let variant = technique("kplus_array", &[("k", "4"), ("counters", "all"), ("opaque", value)]);
        for shaders in [shaders(&variant, "spirv"), glsl_shaders(&variant)] {
            check(&shaders, (&PLAIN, hidden), |_| {});
        }
    }
}

#[test]
fn every_addressing_reads_the_right_texel() {
    for addressing in ["tiled", "morton"] {
        let set = [("k", "4"), ("counters", "all"), ("opaque", "in_shader"), ("addressing", addressing)];
        check(&shaders(&technique("kplus_array", &set), "wgsl"), (&PLAIN, HiddenFragments::Counted), |_| {});
    }
}

/// With a criterion other than depth, a hidden fragment may be better than a visible one, or have the same key.
#[test]
fn hidden_fragments_displace_nothing_by_any_criterion() {
    fn criterion(quad: &Quad) -> u32 {
        let bits = (quad.depth - 0.25 * quad.rgba()[3]).to_bits();
        if bits >> 31 == 0 { bits | 1 << 31 } else { !bits }
    }
    let words: fn(&Quad) -> Words =
        |quad| vec![criterion(quad), u32::from_le_bytes(quad.color), quad.depth.to_bits(), quad.id];
    let rules = Rules {
        admits: |quad| quad.depth > 0.125,
        words,
        nearer: |quad| vec![quad.depth.to_bits(), u32::from_le_bytes(quad.color), quad.id, criterion(quad)],
        resolve: glass_resolve,
    };
    for key in ["kplus_array", "kplus_ab_sb", "kb_ll", "mdt32_coplanar"] {
        for extra in ["opaque: in_shader;", "opaque: in_shader; cull: occupancy { words: 1 };"] {
            let rest = format!("{GLASS_KEEPS} sort: insertion; counters: all; {extra}");
            check(&shaders(&glass(key, &rest), "wgsl"), (&rules, HiddenFragments::Counted), set_uniforms);
        }
    }
}

/// The criterion is alpha, so that keys of hidden and visible fragments have the same range and are often equal.
#[test]
fn hidden_fragments_do_not_affect_earlier_passes() {
    fn key(quad: &Quad) -> u32 {
        quad.rgba()[3].to_bits() | 1 << 31
    }
    let rules = Rules {
        admits: |_| true,
        words: |quad| vec![key(quad), u32::from_le_bytes(quad.color), quad.depth.to_bits()],
        nearer: |quad| vec![quad.depth.to_bits(), u32::from_le_bytes(quad.color), key(quad)],
        resolve: oracle::over,
    };
    let layer = |depth: f32, red: u8, alpha: u8| Quad::whole(depth, [red, 20, 30, alpha]);
    let opaque = [Quad::whole(0.5, [9, 9, 9, 255]).at(0, 0, 12, 16)];
    // Every alpha has a hidden fragment with lesser words and a visible one; further hidden ones are between.
    let mut quads: Vec<Quad> =
        (1..=6).flat_map(|step| [layer(0.75, 1, 40 * step), layer(0.25, 200, 40 * step)]).collect();
    quads.extend((0..24).map(|step| layer(0.625, 7, 45 + 5 * step)));
    let stage = stage::device();
    for (key, extra) in [
        ("mdt32_coplanar", ""),
        ("kplus_array", "cull: occupancy { words: 1 };"),
        ("kplus_ab_sb", "cull: occupancy { words: 1 };"),
        ("mdt32_coplanar", "cull: occupancy { words: 4 };"),
    ] {
        let variant = described(&format!(
            "buffer Alpha from {key} {{ keep 4 least |f| f.color.w; sort: insertion; opaque: in_shader; {extra} }}"
        ));
        let mut renderer = renderer(&stage, &shaders(&variant, "wgsl"), &settings()).unwrap();
        set_depths(&stage, &mut renderer, &opaque_scene(&stage, &opaque, &offscreen(&stage)));
        for quads in orders(&quads).into_iter().take(6) {
            let seen = render_frame(&stage, &mut renderer, &quads);
            compare(key, &seen, &rules, &visible(&quads, &opaque), Some(4));
        }
    }
}

/// Storages in textures discard hidden fragments, keep the nearest or first of the others, and use no sample for hidden ones.
#[test]
fn hidden_fragments_use_no_target_and_no_sample() {
    let stage = stage::device();
    for (key, k) in [("z_buffer", 1), ("kb_sr", 4)] {
        let variant = technique(key, &[("k", &k.to_string()), ("counters", "all"), ("opaque", "in_shader")]);
        let mut renderer = renderer(&stage, &shaders(&variant, "wgsl"), &settings()).unwrap();
        for opaque in surfaces() {
            set_depths(&stage, &mut renderer, &opaque_scene(&stage, &opaque, &offscreen(&stage)));
            let quads: Vec<Quad> = (1..8).map(|step| Quad::whole(step as f32 / 8.0, [step * 9, 4, 5, 90])).collect();
            for quads in orders(&quads) {
                let seen = render_frame(&stage, &mut renderer, &quads);
                let in_front = visible(&quads, &opaque);
                // Where two triangles share a pixel, each has a fragment for its samples.
                let (occluded, hidden) = (seen.counters.get("occluded") as usize, 7 * 256 - in_front.len());
                assert!(if k == 1 { occluded == hidden } else { occluded >= hidden }, "{key}: {occluded} of {hidden}");
                // The first k visible fragments in submission order, or the nearest.
                let kept = |(x, y): (u32, u32)| {
                    let mut left = oracle::fragments(&in_front, x, y);
                    if k == 1 {
                        left.sort_by_key(PLAIN.words);
                    }
                    left.truncate(k);
                    let mut words: Vec<Words> = left.iter().map(PLAIN.words).collect();
                    words.sort();
                    words
                };
                assert_eq!(seen.kept, oracle::pixels().map(kept).collect::<Vec<_>>(), "{key} behind {opaque:?}");
            }
        }
    }
}

/// The host allocates for visible fragments only.
#[test]
fn counts_exclude_hidden_fragments() {
    let stage = stage::device();
    let opaque = [Quad::whole(0.5, [9, 9, 9, 255]).at(0, 0, 16, 7)];
    let quads = scattered(8, 7);
    let in_front = visible(&quads, &opaque);
    for (key, symbol, k) in [("ab_sb", "fragments", None), ("kplus_ab_sb", "kept", Some(3))] {
        for (value, language) in [("in_shader", "wgsl"), ("early_depth", "wgsl-native")] {
            let set = [("k", k.map_or("all".to_owned(), |k: u32| k.to_string())), ("opaque", value.to_owned())];
            let set: Vec<(&str, &str)> = set.iter().map(|(name, value)| (*name, value.as_str())).collect();
            let exact = Settings { sizing: Sizing::Exact, ..settings() };
            let mut renderer = renderer(&stage, &shaders(&technique(key, &set), language), &exact).unwrap();
            set_depths(&stage, &mut renderer, &opaque_scene(&stage, &opaque, &offscreen(&stage)));
            render_frame(&stage, &mut renderer, &quads);
            let kept: usize = oracle::kept_words(&PLAIN, &in_front, k).iter().map(Vec::len).sum();
            assert_eq!(renderer.symbol(symbol), Some(kept as u64), "{key}, {value}");
        }
    }
}

#[test]
fn the_cpu_device_keeps_the_same_words() {
    for (key, k) in [("kplus_array", "4"), ("ab_sb", "all"), ("mdt32_coplanar", "4"), ("z_buffer", "1"), ("kb_sr", "8")]
    {
        // Storages in textures use the depth and stencil test themselves.
        let values =
            if ["z_buffer", "kb_sr"].contains(&key) { &["in_shader"][..] } else { &["in_shader", "early_depth"] };
        for value in values {
            let variant = technique(key, &[("k", k), ("counters", "all"), ("opaque", value)]);
            for order in [FragmentOrder::Submission, FragmentOrder::Shuffled(3)] {
                let mut device = cpu_device::device(&variant, order);
                for opaque in surfaces() {
                    device.set_texture("opaque", &opaque_depths(&opaque)).unwrap();
                    let quads: Vec<Quad> = scattered(8, 5).into_iter().filter(|quad| quad.depth > 0.0).collect();
                    let quads: Vec<Quad> = (1..)
                        .zip(quads)
                        .map(|(step, quad)| Quad { depth: step as f32 / 8.0 - 0.125, ..quad })
                        .collect();
                    let (kept, _) = cpu_device::draw(&mut device, &quads);
                    let in_front = visible(&quads, &opaque);
                    let most = k.parse().ok();
                    assert_eq!(kept, oracle::kept_words(&PLAIN, &in_front, most), "{key}, {value} behind {opaque:?}");
                    let counters = fragbuf_runtime::Counters::sum(&device.words("counters").unwrap());
                    let hidden = oracle::total(&PLAIN, &quads) - oracle::total(&PLAIN, &in_front);
                    let seen = if *value == "early_depth" { 0 } else { hidden };
                    assert_eq!(counters.get("occluded") as usize, seen, "{key}, {value} behind {opaque:?}");
                }
            }
        }
    }
}

#[test]
fn the_cpu_device_reports_a_missing_depth_texture() {
    let variant = technique("kplus_array", &[("opaque", "in_shader")]);
    let mut device = cpu_device::device(&variant, FragmentOrder::Submission);
    let mesh = fragbuf_cpu::Mesh { vertices: &[], indices: &[] };
    let error = device.render(&mesh, &|_| {}).unwrap_err().to_string();
    assert!(error.contains("`opaque`") && error.contains("Device::set_texture"), "{error}");
    let error = device.set_texture("opaque", &[1.0; 7]).unwrap_err().to_string();
    assert!(error.contains("16 x 16") && error.contains('7'), "{error}");
    let error = device.set_texture("keys", &[1.0; 256]).unwrap_err().to_string();
    assert!(error.contains("left to the plan"), "{error}");
    device.set_texture("opaque", &[1.0; 256]).unwrap();
    device.render(&mesh, &|_| {}).unwrap();
}

/// Renders the transparent image over the opaque one. Slices read their rows of the depth buffer.
#[test]
fn images_are_rendered_over_opaque_surfaces() {
    let stage = stage::device();
    let quads = scattered(8, 42);
    for (value, language) in [("in_shader", "wgsl"), ("early_depth", "wgsl-native")] {
        for slice in [None, Some(5)] {
            let settings = Settings { slice, ..settings() };
            let set = [("k", "8"), ("opaque", value)];
            let mut renderer =
                renderer(&stage, &shaders(&technique("kplus_array", &set), language), &settings).unwrap();
            for opaque in surfaces() {
                let target = offscreen(&stage);
                let drawn = opaque_scene(&stage, &opaque, &target);
                set_depths(&stage, &mut renderer, &drawn);
                draw_on(&stage, &mut renderer, &quads, &target);
                let pixels = target.colors(&stage.device, &stage.queue).unwrap();
                let in_front = visible(&quads, &opaque);
                let behind = oracle::image(&PLAIN, &nearest(&opaque), Some(1), BACKGROUND);
                for ((seen, behind), (x, y)) in pixels.iter().zip(behind).zip(oracle::pixels()) {
                    let over = oracle::image(&PLAIN, &oracle::fragments(&in_front, x, y), Some(8), behind);
                    let over = over[(y * SIZE + x) as usize];
                    for (seen, expected) in seen.iter().zip(over) {
                        let difference = 255.0 * (f64::from(*seen) - expected).abs();
                        assert!(
                            difference <= 1.0,
                            "{value} {slice:?}: {x}, {y} is off by {difference}/255 of {opaque:?}"
                        );
                    }
                }
            }
        }
    }
}

/// Returns the fragments that the depth test keeps: the first of the nearest, in front of the far plane.
fn nearest(quads: &[Quad]) -> Vec<Quad> {
    let first = |(x, y)| {
        let fragments = oracle::fragments(quads, x, y).into_iter().filter(|quad| quad.depth < 1.0);
        let nearest = fragments.min_by(|a, b| a.depth.total_cmp(&b.depth))?;
        Some(nearest.at(x, y, x + 1, y + 1))
    };
    oracle::pixels().filter_map(first).collect()
}

/// Renders over the content of the target.
fn draw_on(stage: &Headless, renderer: &mut Renderer, quads: &[Quad], target: &Offscreen) {
    let bytes = vertices(quads, renderer.vertex_inputs());
    let buffer = stage::vertex_buffer(stage, &bytes);
    let output = Output { view: target.view(), load: wgpu::LoadOp::Load };
    let drawn = renderer.render(&output, &mut |pass, _| {
        pass.set_vertex_buffer(0, buffer.slice(..));
        pass.draw(0..6 * quads.len() as u32, 0..1);
    });
    drawn.unwrap();
}

fn depth_texture(
    stage: &Headless,
    (width, height): (u32, u32),
    format: wgpu::TextureFormat,
    usage: wgpu::TextureUsages,
) -> wgpu::Texture {
    stage.device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage,
        view_formats: &[],
    })
}

#[test]
fn a_missing_or_mismatched_texture_is_reported() {
    use wgpu::TextureFormat::{Depth24Plus, Depth32Float};
    use wgpu::TextureUsages as Usages;
    let stage = stage::device();
    let new = |value, language| {
        renderer(&stage, &shaders(&technique("kplus_array", &[("opaque", value)]), language), &settings()).unwrap()
    };
    for (value, language, usage) in
        [("in_shader", "wgsl", Usages::TEXTURE_BINDING), ("early_depth", "wgsl-native", Usages::RENDER_ATTACHMENT)]
    {
        let mut renderer = new(value, language);
        assert!(renderer.texture("opaque").is_none());
        let error = renderer.begin().unwrap_err().to_string();
        assert!(error.contains("the texture `opaque` must be set") && error.contains("set_texture"), "{error}");
        let other = if usage == Usages::TEXTURE_BINDING { Usages::RENDER_ATTACHMENT } else { Usages::TEXTURE_BINDING };
        let wrong = [
            (depth_texture(&stage, (15, 16), Depth32Float, usage), "15 x 16"),
            (depth_texture(&stage, (SIZE, SIZE), Depth24Plus, usage), "Depth24Plus"),
            (depth_texture(&stage, (SIZE, SIZE), Depth32Float, other), "with the usages"),
        ];
        for (texture, part) in wrong {
            let error = block_on(&stage.device, renderer.set_texture("opaque", &texture)).unwrap().unwrap_err();
            assert!(matches!(error, Error::BadValue { .. }) && error.to_string().contains(part), "{error}");
        }
        let right = depth_texture(&stage, (SIZE, SIZE), Depth32Float, usage);
        for (name, part) in [("keys", "an external texture"), ("nothing", "nothing")] {
            let error = block_on(&stage.device, renderer.set_texture(name, &right)).unwrap().unwrap_err();
            assert!(error.to_string().contains(part), "{error}");
        }
        block_on(&stage.device, renderer.set_texture("opaque", &right)).unwrap().unwrap();
        renderer.begin().unwrap();
        // An external texture does not count as allocated memory.
        let bytes = new("none", "wgsl").allocated_bytes();
        assert_eq!(renderer.allocated_bytes(), bytes);
        block_on(&stage.device, renderer.resize(8, 8)).unwrap().unwrap();
        assert!(renderer.begin().is_err());
    }
}
