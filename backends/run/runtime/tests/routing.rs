//! Stencil routing with partially covered pixels. The expected content of every sample is computed in integers from the drawing order
//! and each triangle's coverage, and devices must match it exactly. Pixels without partial coverage hold the first k fragments. The
//! number of pixels that do not is at most the counter `partial_coverage`.

use std::collections::BTreeMap;
use std::sync::Arc;

use fragbuf_cpu::{Code, Device, Mesh};
use fragbuf_runtime::headless::Offscreen;
use fragbuf_runtime::{Counters, Output, VertexInputs};
use fragbuf_templates::Registry;
use fragbuf_templates::vocabulary::{Coverage, Row, Step};

use crate::order::Numbers;
use crate::quads::SIZE;
use crate::stage::{FORMAT, device, read_buffers, read_counters, renderer, settings, shaders, technique};
use crate::translations::glsl_shaders;

/// The resolution of corner and sample positions, per pixel.
const STEPS: i64 = 32;

/// Standard sample positions, in 32nds of a pixel (Vulkan 1.3, "Standard sample locations"; Direct3D 11 has the same).
const TWO: &[(i64, i64)] = &[(24, 24), (8, 8)];
const FOUR: &[(i64, i64)] = &[(12, 4), (28, 12), (4, 20), (20, 28)];
const EIGHT: &[(i64, i64)] = &[(18, 10), (14, 22), (26, 18), (10, 6), (6, 26), (2, 14), (22, 30), (30, 2)];
const CENTRE: &[(i64, i64)] = &[(16, 16)];

/// A triangle with corners in 32nds of a pixel from the top left, one depth and one colour.
#[derive(Clone, Copy, Debug)]
struct Triangle {
    corners: [(i64, i64); 3],
    depth: f32,
    color: [u8; 4],
}

impl Triangle {
    /// Returns a bit for each sample of a pixel that is inside. No scene has an edge through a sample.
    fn covers(&self, (x, y): (u32, u32), positions: &[(i64, i64)]) -> u32 {
        let [a, b, c] = self.corners;
        let inside = |(px, py): &(i64, i64)| {
            let at = (i64::from(x) * STEPS + px, i64::from(y) * STEPS + py);
            let side = |from: (i64, i64), to: (i64, i64)| {
                (to.0 - from.0) * (at.1 - from.1) - (to.1 - from.1) * (at.0 - from.0)
            };
            let sides = [side(a, b), side(b, c), side(c, a)];
            assert!(!sides.contains(&0), "an edge passes through a sample: {self:?}, {x}, {y}");
            sides.iter().all(|side| *side > 0) || sides.iter().all(|side| *side < 0)
        };
        positions.iter().enumerate().map(|(number, position)| u32::from(inside(position)) << number).sum()
    }

    fn words(&self) -> [u32; 2] {
        [self.depth.to_bits(), u32::from_le_bytes(self.color)]
    }
}

/// Returns a rectangle as two triangles. Its edges cut pixels at the given positions, its diagonal anywhere.
fn rectangle([x0, y0, x1, y1]: [i64; 4], number: u32) -> [Triangle; 2] {
    let (depth, color) = (0.9 - number as f32 / 64.0, [number as u8 + 1, 7, 9, 130]);
    let triangle = |corners| Triangle { corners, depth, color };
    [triangle([(x0, y0), (x0, y1), (x1, y1)]), triangle([(x0, y0), (x1, y1), (x1, y0)])]
}

/// Returns rectangles whose edges pass between the samples of a pixel: at a quarter, a half, three quarters and almost all of it; one
/// has its edges on pixel edges. No diagonal passes through a sample.
fn rectangles() -> Vec<Triangle> {
    let rectangles =
        [[71, 39, 401, 361], [0, 0, 512, 480], [137, 81, 495, 463], [81, 153, 347, 417], [33, 199, 481, 321]];
    (0..).zip(rectangles).flat_map(|(number, corners)| rectangle(corners, number)).filter(misses_samples).collect()
}

/// Returns random triangles inside the frame. Drivers may clip triangles that leave it into several, which cover pixels partially
/// along the cut.
fn random(count: u32, seed: u64) -> Vec<Triangle> {
    let mut numbers = Numbers::seeded(seed);
    let mut found = Vec::new();
    while found.len() < count as usize {
        let mut corner = || (i64::from(numbers.below(512)), i64::from(numbers.below(512)));
        let corners = [corner(), corner(), corner()];
        let number = found.len() as u32;
        let triangle = Triangle { corners, depth: 0.9 - number as f32 / 64.0, color: [number as u8 + 1, 3, 5, 99] };
        found.extend(Some(triangle).filter(misses_samples));
    }
    found
}

/// Whether no edge passes through a sample. The rules for edges are tested elsewhere.
fn misses_samples(triangle: &Triangle) -> bool {
    let [a, b, c] = triangle.corners;
    let positions = || TWO.iter().chain(FOUR).chain(EIGHT).chain(CENTRE);
    [(a, b), (b, c), (c, a)].into_iter().all(|(from, to)| {
        pixels().all(|(x, y)| {
            positions().all(|(px, py)| {
                let at = (i64::from(x) * STEPS + px, i64::from(y) * STEPS + py);
                (to.0 - from.0) * (at.1 - from.1) != (to.1 - from.1) * (at.0 - from.0)
            })
        })
    })
}

fn pixels() -> impl Iterator<Item = (u32, u32)> {
    crate::oracle::pixels()
}

/// The expected words of every sample with a fragment, stencil values and counters.
struct Expected {
    /// Indexed by pixel, then by sample.
    held: Vec<Vec<Option<[u32; 2]>>>,
    stencil: Vec<Vec<u32>>,
    partial_coverage: u32,
    /// The number of pixels that do not hold the first k of the fragments that touch them, each once.
    wrong: u32,
}

/// Routes triangle after triangle, sample by sample. `positions` decide coverage; a single position decides for all samples.
fn expected(triangles: &[Triangle], samples: usize, positions: &[(i64, i64)]) -> Expected {
    let free = 256 - samples as u32;
    let whole = (1u32 << samples) - 1;
    let mut found = Expected { held: Vec::new(), stencil: Vec::new(), partial_coverage: 0, wrong: 0 };
    for pixel in pixels() {
        let mut stencil: Vec<u32> = (0..samples as u32).map(|sample| free + sample).collect();
        let mut held = vec![None; samples];
        let (mut touching, mut parts) = (Vec::new(), 0);
        for triangle in triangles {
            let covered = triangle.covers(pixel, positions);
            let covered = if positions.len() == 1 { covered * whole } else { covered };
            parts += u32::from(covered != 0 && covered != whole);
            touching.extend((covered != 0).then(|| triangle.words()));
            for sample in (0..samples).filter(|sample| covered >> sample & 1 == 1) {
                if stencil[sample] == free {
                    held[sample] = Some(triangle.words());
                }
                stencil[sample] = stencil[sample].saturating_sub(1);
            }
        }
        let first: Vec<Option<[u32; 2]>> = (0..samples).map(|sample| touching.get(sample).copied()).collect();
        assert!(parts > 0 || held == first, "routing keeps the first fragments that cover whole pixels");
        found.wrong += u32::from(held != first);
        found.partial_coverage += parts;
        found.held.push(held);
        found.stencil.push(stencil);
    }
    found
}

/// Compares textures and counters of a frame with the expected ones.
fn compare(what: &str, expected: &Expected, buffers: &BTreeMap<String, Vec<u32>>, counters: &Counters) {
    for (pixel, (held, stencil)) in expected.held.iter().zip(&expected.stencil).enumerate() {
        for (sample, (held, stencil)) in held.iter().zip(stencil).enumerate() {
            let word = |name: &str| buffers[name][sample * (SIZE * SIZE) as usize + pixel];
            assert_eq!(word("routing"), *stencil, "{what}: stencil of pixel {pixel}, sample {sample}");
            if let Some(words) = held {
                let kept = [word("entries_key"), word("entries_color")];
                assert_eq!(kept, *words, "{what}: pixel {pixel}, sample {sample}");
            }
        }
    }
    assert_eq!(counters.get("partial_coverage"), expected.partial_coverage, "{what}");
    assert!(expected.wrong <= counters.get("partial_coverage"), "{what}: {} pixels are wrong", expected.wrong);
}

fn vertices(triangles: &[Triangle], inputs: &VertexInputs) -> Vec<u32> {
    let half = (STEPS * i64::from(SIZE) / 2) as f32;
    let mut words = Vec::new();
    for triangle in triangles {
        for (x, y) in triangle.corners {
            for input in &inputs.inputs {
                let values: &[f32] = match input.name.as_str() {
                    "position" => &[x as f32 / half - 1.0, 1.0 - y as f32 / half, triangle.depth],
                    "color" => &triangle.color.map(|channel| f32::from(channel) / 255.0),
                    other => panic!("no value for the attribute `{other}`"),
                };
                words.extend(values.iter().map(|value| value.to_bits()));
            }
        }
    }
    words
}

fn scenes() -> Vec<(String, Vec<Triangle>)> {
    let random = [(3, 1), (6, 2), (12, 3)].map(|(count, seed)| (format!("{count} random"), random(count, seed)));
    [("rectangles".to_owned(), rectangles())].into_iter().chain(random).collect()
}

#[test]
fn scenes_have_partial_coverage() {
    assert_eq!(rectangles().len(), 10, "a diagonal passes through a sample");
    for (samples, positions) in [(2, TWO), (4, FOUR), (8, EIGHT)] {
        for (name, triangles) in scenes() {
            let by_sample = expected(&triangles, samples, positions);
            assert!(by_sample.partial_coverage > 20 && by_sample.wrong > 5, "{name}, {samples} samples");
            let by_pixel = expected(&triangles, samples, CENTRE);
            assert_eq!((by_pixel.partial_coverage, by_pixel.wrong), (0, 0), "{name}, {samples} samples");
        }
    }
}

#[test]
fn a_driver_routes_partially_covered_fragments_by_sample() {
    let stage = device();
    let variant = technique("kb_sr", &[]);
    let languages = [
        ("wgsl", shaders(&variant, "wgsl")),
        ("spirv", shaders(&variant, "spirv")),
        ("glsl-vulkan", glsl_shaders(&variant)),
    ];
    for (language, shaders) in languages {
        let mut renderer = renderer(&stage, &shaders, &settings()).unwrap();
        for (name, triangles) in scenes() {
            let words = vertices(&triangles, renderer.vertex_inputs());
            let bytes: Vec<u8> = words.iter().flat_map(|word| word.to_le_bytes()).collect();
            let buffer = crate::stage::vertex_buffer(&stage, &bytes);
            let offscreen = Offscreen::new(&stage.device, FORMAT, SIZE, SIZE).unwrap();
            let output = Output { view: offscreen.view(), load: wgpu::LoadOp::Clear(wgpu::Color::BLACK) };
            let draw = &mut |pass: &mut wgpu::RenderPass<'_>, _: &fragbuf_runtime::Call<'_>| {
                pass.set_vertex_buffer(0, buffer.slice(..));
                pass.draw(0..3 * triangles.len() as u32, 0..1);
            };
            renderer.render(&output, draw).unwrap();
            let counters = read_counters(&stage, &renderer);
            let expected = expected(&triangles, 4, FOUR);
            compare(&format!("{language}, {name}"), &expected, &read_buffers(&stage, &renderer), &counters);
        }
    }
}

/// Returns the registry with stencil routing of this coverage, which the CPU device supports.
fn registry(coverage: Coverage) -> Registry {
    let registry = Registry::builtin();
    let mut row: Row = registry.row("storage", "stencil_routed").unwrap().clone();
    for step in &mut row.steps {
        if let Step::Pass(pass) = step
            && let Some(samples) = &mut pass.state.samples
        {
            samples.coverage = coverage;
        }
    }
    registry.with(row)
}

fn rendered_by_the_cpu(
    triangles: &[Triangle],
    samples: u32,
    coverage: Coverage,
) -> (BTreeMap<String, Vec<u32>>, Counters) {
    let registry = registry(coverage);
    let span = fragbuf_model::SourceSpan::new("routing", 1, 1);
    let mut draft = fragbuf_model::Draft::from_technique("kb_sr", &span);
    draft.set("k", &samples.to_string(), &span).unwrap();
    let variant = fragbuf_model::check(&draft, &registry).unwrap();
    let code = Arc::new(Code::of(&variant, &registry).unwrap());
    let settings = fragbuf_cpu::Settings::new(SIZE, SIZE);
    let mut device = Device::new(code, settings).unwrap();
    let words = vertices(triangles, &VertexInputs::of(device.plan()));
    let indices: Vec<u32> = (0..3 * triangles.len() as u32).collect();
    let image = device.render(&Mesh { vertices: &words, indices: &indices }, &|_| {}).unwrap();
    let names = ["routing", "entries_key", "entries_color"];
    let buffers = names.map(|name| (name.to_owned(), device.words(name).unwrap())).into_iter().collect();
    (buffers, image.counters.unwrap())
}

/// Tests two and eight samples too, which the driver does not support.
#[test]
fn the_cpu_device_routes_by_sample_or_by_pixel() {
    for (samples, positions) in [(2, TWO), (4, FOUR), (8, EIGHT)] {
        for (name, triangles) in scenes() {
            for (coverage, positions) in [(Coverage::PerSample, positions), (Coverage::WholePixel, CENTRE)] {
                let (buffers, counters) = rendered_by_the_cpu(&triangles, samples, coverage);
                let expected = expected(&triangles, samples as usize, positions);
                compare(&format!("{samples} samples, {coverage:?}, {name}"), &expected, &buffers, &counters);
            }
        }
    }
}
