//! Stencil routing where triangles cover pixels in part: what every sample holds is worked out from the order of drawing and
//! each triangle's coverage, in whole numbers, and what devices keep must be exactly that. Pixels that no triangle covers
//! in part hold the first k; those that do not are no more than the counter of partly covered fragments says.

use std::collections::BTreeMap;
use std::sync::Arc;

use fragbuf_cpu::{Code, Device, Mesh, Order};
use fragbuf_runtime::headless::Offscreen;
use fragbuf_runtime::{Counters, Output, Sizing, VertexInputs};
use fragbuf_templates::Registry;
use fragbuf_templates::vocabulary::{Coverage, Row, Step};

use crate::order::Numbers;
use crate::quads::SIZE;
use crate::stage::{FORMAT, device, read_buffers, read_counters, renderer, settings, shaders, technique};
use crate::translations::glsl_shaders;

/// Steps of a corner's place in a pixel, and of samples' places.
const STEPS: i64 = 32;

/// Standard places of samples, in 32nds of a pixel (Vulkan 1.3, "Standard sample locations"; Direct3D 11 has the same).
const TWO: &[(i64, i64)] = &[(24, 24), (8, 8)];
const FOUR: &[(i64, i64)] = &[(12, 4), (28, 12), (4, 20), (20, 28)];
const EIGHT: &[(i64, i64)] = &[(18, 10), (14, 22), (26, 18), (10, 6), (6, 26), (2, 14), (22, 30), (30, 2)];
const MIDDLE: &[(i64, i64)] = &[(16, 16)];

/// Corners in 32nds of a pixel from the top left, an own depth and an own colour.
#[derive(Clone, Copy, Debug)]
struct Triangle {
    corners: [(i64, i64); 3],
    depth: f32,
    color: [u8; 4],
}

impl Triangle {
    /// The samples of a pixel that lie inside, a bit each. No scene has an edge through a sample.
    fn covers(&self, (x, y): (u32, u32), places: &[(i64, i64)]) -> u32 {
        let [a, b, c] = self.corners;
        let inside = |(px, py): &(i64, i64)| {
            let at = (i64::from(x) * STEPS + px, i64::from(y) * STEPS + py);
            let side = |from: (i64, i64), to: (i64, i64)| {
                (to.0 - from.0) * (at.1 - from.1) - (to.1 - from.1) * (at.0 - from.0)
            };
            let sides = [side(a, b), side(b, c), side(c, a)];
            assert!(!sides.contains(&0), "an edge goes through a sample: {self:?}, {x}, {y}");
            sides.iter().all(|side| *side > 0) || sides.iter().all(|side| *side < 0)
        };
        places.iter().enumerate().map(|(number, place)| u32::from(inside(place)) << number).sum()
    }

    fn words(&self) -> [u32; 2] {
        [self.depth.to_bits(), u32::from_le_bytes(self.color)]
    }
}

/// A rectangle as two triangles; its edges cut pixels where they are told to, its diagonal wherever it goes.
fn rectangle([x0, y0, x1, y1]: [i64; 4], number: u32) -> [Triangle; 2] {
    let (depth, color) = (0.9 - number as f32 / 64.0, [number as u8 + 1, 7, 9, 130]);
    let triangle = |corners| Triangle { corners, depth, color };
    [triangle([(x0, y0), (x0, y1), (x1, y1)]), triangle([(x0, y0), (x1, y1), (x1, y0)])]
}

/// Rectangles whose edges go between the samples of a pixel: a quarter, a half, three quarters of the way and nearly all;
/// one of them on the borders of pixels. Their corners are such that no diagonal meets a sample.
fn rectangles() -> Vec<Triangle> {
    let places = [[71, 39, 401, 361], [0, 0, 512, 480], [137, 81, 495, 463], [81, 153, 347, 417], [33, 199, 481, 321]];
    (0..).zip(places).flat_map(|(number, place)| rectangle(place, number)).filter(misses_samples).collect()
}

/// Triangles anywhere in the frame: drivers may cut those that leave it into several, which cover pixels in part along the
/// cut.
fn anywhere(count: u32, seed: u64) -> Vec<Triangle> {
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

/// Whether no edge goes through a sample: there the rules for edges would decide, which are tested elsewhere.
fn misses_samples(triangle: &Triangle) -> bool {
    let [a, b, c] = triangle.corners;
    let places = || TWO.iter().chain(FOUR).chain(EIGHT).chain(MIDDLE);
    [(a, b), (b, c), (c, a)].into_iter().all(|(from, to)| {
        pixels().all(|(x, y)| {
            places().all(|(px, py)| {
                let at = (i64::from(x) * STEPS + px, i64::from(y) * STEPS + py);
                (to.0 - from.0) * (at.1 - from.1) != (to.1 - from.1) * (at.0 - from.0)
            })
        })
    })
}

fn pixels() -> impl Iterator<Item = (u32, u32)> {
    crate::oracle::pixels()
}

/// What a frame must hold: the words of every sample that holds a fragment, and what the counters must say.
struct Expected {
    /// By pixel, then by sample.
    held: Vec<Vec<Option<[u32; 2]>>>,
    stencil: Vec<Vec<u32>>,
    partly_covered: u32,
    /// Pixels that do not hold the first k of the fragments that touch them, each once.
    wrong: u32,
}

/// Routes triangle after triangle, sample by sample. `places` decide coverage; where the middle decides, for all samples.
fn expected(triangles: &[Triangle], samples: usize, places: &[(i64, i64)]) -> Expected {
    let turn = 256 - samples as u32;
    let whole = (1u32 << samples) - 1;
    let mut found = Expected { held: Vec::new(), stencil: Vec::new(), partly_covered: 0, wrong: 0 };
    for pixel in pixels() {
        let mut stencil: Vec<u32> = (0..samples as u32).map(|sample| turn + sample).collect();
        let mut held = vec![None; samples];
        let (mut touching, mut parts) = (Vec::new(), 0);
        for triangle in triangles {
            let covered = triangle.covers(pixel, places);
            let covered = if places.len() == 1 { covered * whole } else { covered };
            parts += u32::from(covered != 0 && covered != whole);
            touching.extend((covered != 0).then(|| triangle.words()));
            for sample in (0..samples).filter(|sample| covered >> sample & 1 == 1) {
                if stencil[sample] == turn {
                    held[sample] = Some(triangle.words());
                }
                stencil[sample] = stencil[sample].saturating_sub(1);
            }
        }
        let first: Vec<Option<[u32; 2]>> = (0..samples).map(|sample| touching.get(sample).copied()).collect();
        assert!(parts > 0 || held == first, "routing keeps the first of fragments that cover whole pixels");
        found.wrong += u32::from(held != first);
        found.partly_covered += parts;
        found.held.push(held);
        found.stencil.push(stencil);
    }
    found
}

/// Compares textures and counters of a frame with what they must be.
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
    assert_eq!(counters.get("partly_covered"), expected.partly_covered, "{what}");
    assert!(expected.wrong <= counters.get("partly_covered"), "{what}: {} pixels are wrong", expected.wrong);
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
    let anywhere = [(3, 1), (6, 2), (12, 3)].map(|(count, seed)| (format!("{count} anywhere"), anywhere(count, seed)));
    [("rectangles".to_owned(), rectangles())].into_iter().chain(anywhere).collect()
}

#[test]
fn scenes_have_what_is_tested() {
    assert_eq!(rectangles().len(), 10, "a diagonal meets a sample");
    for (samples, places) in [(2, TWO), (4, FOUR), (8, EIGHT)] {
        for (name, triangles) in scenes() {
            let by_sample = expected(&triangles, samples, places);
            assert!(by_sample.partly_covered > 20 && by_sample.wrong > 5, "{name}, {samples} samples");
            let by_pixel = expected(&triangles, samples, MIDDLE);
            assert_eq!((by_pixel.partly_covered, by_pixel.wrong), (0, 0), "{name}, {samples} samples");
        }
    }
}

#[test]
fn a_driver_routes_partly_covered_fragments_sample_by_sample() {
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

/// The registry with stencil routing that covers pixels as `coverage` says: the CPU device does as it is told.
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

fn drawn_by_the_cpu(
    triangles: &[Triangle],
    samples: u32,
    coverage: Coverage,
) -> (BTreeMap<String, Vec<u32>>, Counters) {
    let registry = registry(coverage);
    let origin = fragbuf_model::Origin::new("routing", 1, 1);
    let mut draft = fragbuf_model::Draft::from_technique("kb_sr", &origin);
    draft.set("k", &samples.to_string(), &origin).unwrap();
    let variant = fragbuf_model::check(&draft, &registry).unwrap();
    let code = Arc::new(Code::of(&variant, &registry).unwrap());
    let settings = fragbuf_cpu::Settings { width: SIZE, height: SIZE, sizing: Sizing::Auto, order: Order::Submission };
    let mut device = Device::new(code, settings).unwrap();
    let words = vertices(triangles, &VertexInputs::of(device.plan()));
    let indices: Vec<u32> = (0..3 * triangles.len() as u32).collect();
    let picture = device.render(&Mesh { vertices: &words, indices: &indices }, &|_| {}).unwrap();
    let names = ["routing", "entries_key", "entries_color"];
    let buffers = names.map(|name| (name.to_owned(), device.words(name).unwrap())).into_iter().collect();
    (buffers, picture.counters.unwrap())
}

/// Two and eight samples too, which the driver does not have.
#[test]
fn the_cpu_device_routes_by_sample_or_by_pixel_as_it_is_told() {
    for (samples, places) in [(2, TWO), (4, FOUR), (8, EIGHT)] {
        for (name, triangles) in scenes() {
            for (coverage, places) in [(Coverage::PerSample, places), (Coverage::WholePixel, MIDDLE)] {
                let (buffers, counters) = drawn_by_the_cpu(&triangles, samples, coverage);
                let expected = expected(&triangles, samples as usize, places);
                compare(&format!("{samples} samples, {coverage:?}, {name}"), &expected, &buffers, &counters);
            }
        }
    }
}
