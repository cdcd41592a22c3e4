//! Compares several samples per pixel with supersampling: the mean of one image per sample, each with one sample per pixel and with
//! the triangles moved so that the sample is at the pixel centre. Triangles have one depth and one colour, so that only coverage
//! can differ.

use std::sync::Arc;

use fragbuf_cpu::{Code, Device, Mesh};
use fragbuf_model::{Draft, SourceSpan, Variant, check};
use fragbuf_runtime::headless::{Choice, Headless, Offscreen};
use fragbuf_runtime::{Error, Output, VertexInputs};
use fragbuf_templates::Registry;
use fragbuf_templates::vocabulary::{Capability, KeepDefault};

use crate::order::{Numbers, orders};
use crate::quads::SIZE;
use crate::stage::{self, FORMAT, described, renderer, settings, shaders, technique};

/// Corners in 256ths of a pixel from the top left.
#[derive(Clone, Copy, Debug)]
struct Triangle {
    corners: [[i32; 2]; 3],
    depth: f32,
    color: [u8; 4],
}

/// Returns the standard sample positions, in 256ths of a pixel from its top left (Vulkan 1.3, Standard Sample Locations).
fn positions(samples: u32) -> &'static [[i32; 2]] {
    match samples {
        2 => &[[192, 192], [64, 64]],
        4 => &[[96, 32], [224, 96], [32, 160], [160, 224]],
        8 => &[[144, 80], [112, 176], [208, 144], [80, 48], [48, 208], [16, 112], [176, 240], [240, 16]],
        _ => panic!("{samples} samples"),
    }
}

const WHOLE: i32 = 256 * SIZE as i32;

/// Returns scenes with silhouettes, shared edges and coincident triangles. At most eight cover a pixel.
fn scenes() -> Vec<(&'static str, Vec<Triangle>)> {
    let colors = [[255, 0, 0, 128], [0, 255, 0, 64], [0, 0, 255, 200], [250, 250, 250, 30]];
    let triangle = |corners, depth, number: usize| Triangle { corners, depth, color: colors[number % 4] };
    let frame = [[0, 0], [WHOLE, 0], [WHOLE, WHOLE], [0, WHOLE]];
    // A fan around a point that is no pixel centre: two triangles share each edge, at one depth.
    let fan = |centre: [i32; 2], depth| {
        (0..4).map(move |side| triangle([centre, frame[side], frame[(side + 1) % 4]], depth, side)).collect::<Vec<_>>()
    };
    let silhouette = [[300, 410], [3700, 1200], [900, 3650]];
    let mut numbers = Numbers::seeded(3);
    let random = (0..8).map(|number| {
        let corners = std::array::from_fn(|_| [numbers.below(4096) as i32, numbers.below(4096) as i32]);
        triangle(corners, numbers.below(4) as f32 / 4.0, number)
    });
    vec![
        ("one silhouette", vec![triangle(silhouette, 0.5, 0)]),
        ("a shared edge", fan([1951, 2222], 0.5)),
        ("coincident", (0..4).map(|number| triangle(silhouette, 0.5, number)).collect()),
        ("shared edges behind a silhouette", [fan([1951, 2222], 0.5), vec![triangle(silhouette, 0.25, 2)]].concat()),
        ("random", random.collect()),
    ]
}

/// Moves triangles by 256ths of a pixel.
fn moved(triangles: &[Triangle], by: [i32; 2]) -> Vec<Triangle> {
    let corner = |[x, y]: [i32; 2]| [x + by[0], y + by[1]];
    triangles.iter().map(|triangle| Triangle { corners: triangle.corners.map(corner), ..*triangle }).collect()
}

fn vertices(triangles: &[Triangle], inputs: &VertexInputs) -> Vec<f32> {
    let mut floats = Vec::new();
    for (triangle, [x, y]) in triangles.iter().flat_map(|one| one.corners.map(|corner| (one, corner))) {
        for input in &inputs.inputs {
            match input.name.as_str() {
                "position" => {
                    let half = WHOLE as f32 / 2.0;
                    floats.extend([x as f32 / half - 1.0, 1.0 - y as f32 / half, triangle.depth]);
                }
                "color" => floats.extend(triangle.color.map(|channel| f32::from(channel) / 255.0)),
                // A user's attribute of that name.
                "coverage" => floats.push(1.0),
                other => panic!("no value for the attribute `{other}`"),
            }
        }
    }
    floats
}

/// Premultiplied colours over transparency.
type Picture = Vec<[f32; 4]>;

fn on_driver(stage: &Headless, variant: &Variant, triangles: &[Triangle]) -> Result<Picture, Error> {
    let portable = variant.select(fragbuf_targets::target("wgsl").unwrap().provides).is_ok();
    let shaders = shaders(variant, if portable { "wgsl" } else { "wgsl-native" });
    let mut renderer = renderer(stage, &shaders, &settings())?;
    let floats = vertices(triangles, renderer.vertex_inputs());
    let bytes: Vec<u8> = floats.iter().flat_map(|float| float.to_le_bytes()).collect();
    let buffer = stage::vertex_buffer(stage, &bytes);
    let offscreen = Offscreen::new(&stage.device, FORMAT, SIZE, SIZE).unwrap();
    let output = Output { view: offscreen.view(), load: wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT) };
    renderer.render(&output, &mut |pass, _| {
        pass.set_vertex_buffer(0, buffer.slice(..));
        pass.draw(0..3 * triangles.len() as u32, 0..1);
    })?;
    offscreen.colors(&stage.device, &stage.queue)
}

fn on_cpu(variant: &Variant, triangles: &[Triangle]) -> Picture {
    behind(None, variant, triangles)
}

/// Renders on the CPU device, behind an opaque surface at one depth if there is one.
fn behind(opaque: Option<f32>, variant: &Variant, triangles: &[Triangle]) -> Picture {
    let code = Code::of(variant, &Registry::builtin()).unwrap_or_else(|error| panic!("{error}"));
    let settings = fragbuf_cpu::Settings::new(SIZE, SIZE);
    let mut device = Device::new(Arc::new(code), settings).unwrap();
    if let Some(depth) = opaque {
        device.set_texture("opaque", &[depth; (SIZE * SIZE) as usize]).unwrap();
    }
    let words: Vec<u32> =
        vertices(triangles, &VertexInputs::of(device.plan())).iter().map(|float| float.to_bits()).collect();
    let indices: Vec<u32> = (0..3 * triangles.len() as u32).collect();
    device.render(&Mesh { vertices: &words, indices: &indices }, &|_| {}).unwrap().pixels
}

/// Returns the mean of one image per sample.
fn supersampled(samples: u32, triangles: &[Triangle], draw: impl Fn(&[Triangle]) -> Picture) -> Picture {
    let mut sum = vec![[0.0; 4]; (SIZE * SIZE) as usize];
    for [x, y] in positions(samples) {
        let image = draw(&moved(triangles, [128 - x, 128 - y]));
        for (sum, pixel) in sum.iter_mut().zip(image) {
            sum.iter_mut().zip(pixel).for_each(|(sum, channel)| *sum += channel / samples as f32);
        }
    }
    sum
}

fn compare(what: &str, seen: &Picture, expected: &Picture) {
    for (pixel, (seen, expected)) in (0..).zip(seen.iter().zip(expected)) {
        let difference = seen.iter().zip(expected).map(|(a, b)| 255.0 * (a - b).abs()).fold(0.0, f32::max);
        let (x, y) = (pixel % SIZE, pixel / SIZE);
        assert!(difference <= 1.0, "{what}: pixel {x}, {y} is {seen:?}, supersampled {expected:?}");
    }
}

/// Returns a technique with `samples` per pixel; `None` if the rules reject it.
fn with_samples(key: &str, set: &[(&str, &str)], samples: u32) -> Option<Variant> {
    let span = SourceSpan::new(key, 1, 1);
    let mut draft = Draft::from_technique(key, &span);
    let count = samples.to_string();
    for (name, value) in set.iter().chain(&[("samples", "coverage"), ("samples.count", &count)]) {
        draft.set(name, value, &span).unwrap();
    }
    check(&draft, &Registry::builtin()).ok()
}

/// Returns every technique that supports several samples, with k large enough for all fragments of a pixel.
fn multisampled(samples: u32) -> Vec<(String, Variant, Variant)> {
    let registry = Registry::builtin();
    let all = registry.techniques().iter().filter_map(|technique_row| {
        let k: &[(&str, &str)] = match technique_row.keep {
            KeepDefault::All => &[],
            KeepDefault::Best(_) => &[("k", "8")],
        };
        let several = with_samples(&technique_row.key, k, samples)?;
        Some((technique_row.key.clone(), several, technique(&technique_row.key, k)))
    });
    all.collect()
}

/// Whether every declared hazard needs a race, so that the result is exact if fragments run sequentially.
fn is_exact_in_order(variant: &Variant) -> bool {
    let rows = variant.choices.iter().flat_map(|chosen| &chosen.alternatives);
    let mut hazards = rows.flat_map(|selected| &selected.row.hazards);
    hazards.all(|hazard| hazard.permits.needs_race)
}

#[test]
fn the_driver_matches_supersampling() {
    let stage = stage::device();
    let all = multisampled(4);
    assert!(all.len() >= 15, "{} techniques", all.len());
    let mut compared = 0;
    for (key, several, one) in all.into_iter().filter(|(_, several, _)| is_exact_in_order(several)) {
        for (name, triangles) in scenes() {
            for triangles in orders(&triangles).into_iter().take(2) {
                let seen = on_driver(&stage, &several, &triangles).unwrap();
                let expected = supersampled(4, &triangles, |moved| on_driver(&stage, &one, moved).unwrap());
                compare(&format!("{key}, {name}"), &seen, &expected);
            }
        }
        compared += 1;
    }
    assert!(compared >= 12, "{compared} techniques were compared");
}

#[test]
fn the_cpu_device_matches_supersampling() {
    for samples in [2, 4, 8] {
        for key in ["kplus_array", "mdt32_coplanar", "ab_ll", "kplus_ab_sb"] {
            let several = with_samples(key, &[], samples).unwrap();
            for (name, triangles) in scenes() {
                let seen = on_cpu(&several, &triangles);
                let expected = supersampled(samples, &triangles, |moved| on_cpu(&technique(key, &[]), moved));
                compare(&format!("{key}, {samples} samples, {name}"), &seen, &expected);
            }
        }
    }
}

/// The depth buffer of opaque surfaces has one sample, so it hides all samples of a fragment or none.
#[test]
fn opaque_surfaces_hide_every_sample() {
    const OPAQUE: f32 = 0.375;
    for samples in [2, 4, 8] {
        let variant = with_samples("kplus_array", &[("opaque", "in_shader")], samples).unwrap();
        let free = with_samples("kplus_array", &[], samples).unwrap();
        for (name, triangles) in scenes() {
            let seen: Vec<Triangle> = triangles.iter().copied().filter(|triangle| triangle.depth <= OPAQUE).collect();
            let shown = behind(Some(OPAQUE), &variant, &triangles);
            compare(&format!("{samples} samples, {name}"), &shown, &on_cpu(&free, &seen));
        }
    }
}

#[test]
fn every_sort_serves_every_sample() {
    let stage = stage::device();
    let registry = Registry::builtin();
    let sorts = registry.rows_of("sort").filter(|row| row.provides.contains(&Capability::Sorted));
    for row in sorts {
        for select in ["on_store", "on_resolve"] {
            let set: &[(&str, &str)] = &[("sort", &row.key), ("select", select), ("k", "8")];
            let (key, set) = if select == "on_store" { ("ab_ll", &set[..1]) } else { ("kb_ab_ll", set) };
            let several = with_samples(key, set, 4).unwrap();
            for (name, triangles) in scenes() {
                let seen = on_driver(&stage, &several, &triangles).unwrap();
                let one = technique(key, set);
                let expected = supersampled(4, &triangles, |moved| on_driver(&stage, &one, moved).unwrap());
                compare(&format!("{} {select}, {name}", row.key), &seen, &expected);
            }
        }
    }
}

/// An effect that reads from the farthest to the nearest and then a middle one again; with an attribute named like the coverage
/// mask.
const BOTH_WAYS: &str = "
    buffer B from ab_ll {
        fragment { color: rgba8, coverage: f32, depth: f32 }
        SAMPLES
        resolve |fragments, u| {
            let mut sum = Vec4::ZERO;
            for f in fragments.iter().rev() {
                sum = sum * 0.5 + f.color * f.coverage;
            }
            let middle = fragments[fragments.len() / 2];
            sum * 0.25 + middle.color * 0.5
        }
    }";

#[test]
fn effects_read_the_fragments_of_a_sample_in_any_order() {
    let stage = stage::device();
    let variant = |samples: &str| described(&BOTH_WAYS.replace("SAMPLES", samples));
    let (several, one) = (variant("samples: coverage;"), variant(""));
    for (name, triangles) in scenes() {
        let seen = on_driver(&stage, &several, &triangles).unwrap();
        let expected = supersampled(4, &triangles, |moved| on_driver(&stage, &one, moved).unwrap());
        compare(name, &seen, &expected);
    }
}

/// A tail weights a fragment by the samples that it covers. For a single fragment that equals supersampling.
#[test]
fn a_tail_weights_a_fragment_by_its_coverage() {
    let stage = stage::device();
    let behind = Triangle { corners: [[300, 410], [3700, 1200], [900, 3650]], depth: 0.5, color: [0, 0, 255, 200] };
    // The triangle is inside the frame, because the driver would clip it into several. Above the diagonal it covers all samples,
    // and hides the tail completely.
    let corners = [[0, 0], [WHOLE, 0], [WHOLE, WHOLE]];
    let triangles = [Triangle { corners, depth: 0.25, color: [255, 0, 0, 128] }, behind];
    let expected = supersampled(4, &triangles, |moved| on_driver(&stage, &technique("ab_ll", &[]), moved).unwrap());
    for overflow in ["weighted_tail", "tail_blend"] {
        let set = [("k", "1"), ("overflow", overflow), ("cull", "none")];
        let seen = on_driver(&stage, &with_samples("kplus_array", &set, 4).unwrap(), &triangles).unwrap();
        let mut halves = 0;
        for (pixel, (seen, expected)) in (0..SIZE * SIZE).zip(seen.iter().zip(&expected)) {
            let (x, y) = (pixel % SIZE, pixel / SIZE);
            if x <= y {
                continue;
            }
            let difference = seen.iter().zip(expected).map(|(a, b)| 255.0 * (a - b).abs()).fold(0.0, f32::max);
            assert!(difference <= 1.0, "{overflow}: pixel {x}, {y} is {seen:?}, supersampled {expected:?}");
            halves += u32::from(expected[2] > 0.02 && expected[2] < 0.35);
        }
        assert!(halves > 4, "{halves} pixels are on the edge of the tail's triangle");
    }
}

#[test]
fn sample_counts_that_a_device_lacks_are_rejected_by_name() {
    let features = wgpu::Features::PASSTHROUGH_SHADERS | wgpu::Features::TEXTURE_ADAPTER_SPECIFIC_FORMAT_FEATURES;
    let stage = Headless::open(&Choice::Cpu, features).unwrap();
    let several = with_samples("kplus_array", &[], 8).unwrap();
    let error = on_driver(&stage, &several, &scenes().remove(0).1).unwrap_err();
    assert!(matches!(&error, Error::Unsupported { what, .. } if what.contains("8 samples")), "{error}");
}
