//! Fixed-function operations on small draws with known results: tests, blending, samples, attributes, early tests.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

use std::sync::Mutex;
use std::sync::atomic::AtomicU32;

use fragbuf_interpreter::{Bytecode, Options};
use fragbuf_templates::vocabulary::{Blend, Compare, Coverage, StencilOperation, TextureFormat};
use naga::valid::{Capabilities, ValidationFlags, Validator};

use crate::attachment::{Attachments, ColorAttachment, DepthAttachment, StencilAttachment};
use crate::draw::{DrawError, draw};
use crate::draw_call::{DrawArguments, DrawCall};
use crate::memory::{Words, read, words};
use crate::settings::FragmentOrder;
use crate::texel::Texel;
use crate::view::View;

const SIZE: u32 = 4;
const PIXELS: usize = (SIZE * SIZE) as usize;

const COMMON: &str = "
enable primitive_index;
struct VertexOutput {
    @builtin(position) position: vec4<f32>,
    @location(0) color: vec4<f32>,
    @location(1) @interpolate(linear) straight: f32,
    @location(2) @interpolate(flat) id: u32,
}
@group(0) @binding(0) var<storage, read_write> list: array<atomic<u32>>;
@vertex fn corner(@location(0) position: vec4<f32>, @location(1) color: vec4<f32>) -> VertexOutput {
    return VertexOutput(position, color, color.r, u32(color.a * 10.0));
}
";

const PLAIN: &str = "@fragment fn main(in: VertexOutput) -> @location(0) vec4<f32> { return in.color; }";

/// The corners and colours of triangles.
type Corners = Vec<([f32; 4], [f32; 4])>;

/// Returns a triangle over the whole frame at a depth, in a colour.
fn whole(depth: f32, color: [f32; 4]) -> Corners {
    [[-1.0, 1.0], [-1.0, -3.0], [3.0, 1.0]].map(|[x, y]| ([x, y, depth, 1.0], color)).to_vec()
}

/// A draw call of one shader.
struct TestDraw<'a> {
    shader: &'a str,
    attachments: Attachments<'a>,
    list: &'a Words,
    coverage: Coverage,
}

impl TestDraw<'_> {
    fn draw(&self, corners: &Corners) -> u64 {
        self.try_draw(corners).unwrap()
    }

    fn try_draw(&self, corners: &Corners) -> Result<u64, String> {
        let shader = format!("{COMMON}{}", self.shader);
        let module =
            naga::front::wgsl::parse_str(&shader).unwrap_or_else(|error| panic!("{}", error.emit_to_string(&shader)));
        let info = Validator::new(ValidationFlags::all(), Capabilities::all()).validate(&module).unwrap();
        let program = |name: &str| Bytecode::entry_point(&module, &info, name, &Options::default()).unwrap();
        let (vertex, fragment) = (program("corner"), program("main"));
        let numbers = corners.iter().flat_map(|(position, color)| position.iter().chain(color));
        let vertices: Vec<u32> = numbers.map(|number| number.to_bits()).collect();
        let wide = Mutex::new(());
        let view = |program: &Bytecode| {
            let buffers = program.buffers.iter().map(|_| &self.list[..]).collect();
            View { buffers, textures: Vec::new(), wide: &wide }
        };
        let indices: Vec<u32> = (0..corners.len() as u32).collect();
        let call = DrawCall {
            vertex: (&vertex, view(&vertex)),
            fragment: (&fragment, view(&fragment)),
            vertices: &vertices,
            indices: Some(&indices),
            arguments: DrawArguments::once(indices.len() as u32 / 3),
            size: (SIZE, SIZE),
            rows: 0..SIZE,
            attachments: self.attachments.clone(),
            coverage: self.coverage,
            order: FragmentOrder::Submission,
            lanes: true,
            memory: 0,
        };
        match draw(&call, &|_| {}) {
            Ok(drawn) => Ok(drawn.samples),
            Err(DrawError::Shader(what)) => Err(what),
            Err(DrawError::EndlessVertex(_) | DrawError::EndlessFragment(_)) => Err("does not terminate".to_owned()),
            Err(DrawError::Shuffled(bytes)) => panic!("{bytes} bytes in the order of submission"),
        }
    }
}

fn zeros(count: usize) -> Words {
    words(&vec![0; count])
}

fn none<'a>(samples: u32) -> Attachments<'a> {
    Attachments { pixels: PIXELS, samples, mask: u32::MAX, ..Attachments::default() }
}

fn target(words: &[AtomicU32], blend: Blend) -> ColorAttachment<'_> {
    ColorAttachment { words, texel: Texel::Output, blend, first: 0 }
}

/// Draws one after the other into one float attachment; returns its first pixel.
fn first(attachments: Attachments<'_>, blend: Blend, draws: &[Corners]) -> [f32; 4] {
    let (output, list) = (zeros(4 * PIXELS), zeros(64));
    let attachments = Attachments { targets: vec![target(&output, blend)], ..attachments };
    let call = TestDraw { shader: PLAIN, attachments, list: &list, coverage: Coverage::PerSample };
    for corners in draws {
        call.draw(corners);
    }
    let seen = read(&output);
    std::array::from_fn(|channel| f32::from_bits(seen[channel]))
}

const RED: [f32; 4] = [0.5, 0.0, 0.0, 0.5];
const BLUE: [f32; 4] = [0.0, 0.125, 0.25, 0.25];

#[test]
fn blending_follows_the_vocabulary() {
    let draws = [whole(0.5, RED), whole(0.5, BLUE)];
    let cases = [
        (Blend::Replace, BLUE),
        (Blend::Over, [0.375, 0.125, 0.25, 0.625]),
        (Blend::Under, [0.5, 0.0625, 0.125, 0.625]),
        (Blend::Max, [0.5, 0.125, 0.25, 0.5]),
        (Blend::Min, [0.0; 4]),
        (Blend::Add, [0.5, 0.125, 0.25, 0.75]),
    ];
    for (blend, expected) in cases {
        assert_eq!(first(none(1), blend, &draws), expected, "{blend:?}");
    }
}

#[test]
fn depth_is_compared_and_written() {
    let near_then_far = [whole(0.25, RED), whole(0.5, BLUE)];
    // The result of the second draw after a clear to 0.375, with 0.25 written by the first draw or not.
    let cases = [
        (Compare::Less, true, RED),
        (Compare::LessEqual, true, RED),
        (Compare::Less, false, RED),
        (Compare::Greater, true, BLUE),
        (Compare::GreaterEqual, false, BLUE),
        (Compare::Equal, true, [0.0; 4]),
        (Compare::Always, true, BLUE),
    ];
    for format in [TextureFormat::Depth32Float, TextureFormat::Depth24PlusStencil8] {
        for (compare, writes, expected) in cases {
            let clear = if format == TextureFormat::Depth32Float { 0.375f32.to_bits() } else { 0x60_0000 << 8 | 7 };
            let depths = words(&[clear; PIXELS]);
            let depth = Some(DepthAttachment { words: &depths, format, compare, writes });
            assert_eq!(
                first(Attachments { depth, ..none(1) }, Blend::Replace, &near_then_far),
                expected,
                "{compare:?}"
            );
            let is_written = writes && expected != [0.0; 4];
            assert_eq!(read(&depths)[0] != clear, is_written, "{compare:?} {format:?}");
            assert!(format == TextureFormat::Depth32Float || read(&depths)[0] & 0xff == 7, "the stencil is unchanged");
        }
    }
}

#[test]
fn several_attachments_get_separate_colours() {
    let (a, b, list) = (zeros(PIXELS), zeros(2 * PIXELS), zeros(64));
    let replaced = target(&a, Blend::Replace);
    let bytes = ColorAttachment { texel: Texel::Format(TextureFormat::Rgba8Unorm), ..replaced };
    let greatest = target(&b, Blend::Max);
    let pairs = ColorAttachment { texel: Texel::Format(TextureFormat::Rg32Float), ..greatest };
    let shader = "struct Out { @location(0) a: vec4<f32>, @location(1) b: vec2<f32> }
        @fragment fn main(in: VertexOutput) -> Out { return Out(in.color, vec2<f32>(-in.position.z, in.position.z)); }";
    let attachments = Attachments { targets: vec![bytes, pairs], ..none(1) };
    let call = TestDraw { shader, attachments, list: &list, coverage: Coverage::PerSample };
    assert_eq!(call.draw(&whole(0.75, [1.0, 0.0, 0.2, 1.0])), PIXELS as u64);
    assert_eq!(read(&a), vec![0xff33_00ff; PIXELS]);
    assert_eq!(read(&b)[..2], [0, 0.75f32.to_bits()], "max(0, -0.75) and max(0, 0.75)");
}

/// Myers & Bavoil 2007: the i-th fragment of a pixel is stored in sample i; with whole-pixel coverage, at edges too.
#[test]
fn stencil_routing_sends_fragments_to_samples_one_by_one() {
    const SAMPLES: u32 = 4;
    let (routing, output, list) = (zeros(PIXELS * 4), zeros(4 * PIXELS * 4), zeros(64));
    let stencil =
        |compare, fail, pass, reference| StencilAttachment { words: &routing, compare, fail, pass, reference };
    for sample in 0..SAMPLES {
        let state = stencil(Compare::Always, StencilOperation::Keep, StencilOperation::Replace, sample + 2);
        let attachments = Attachments { stencil: Some(state), mask: 1 << sample, ..none(SAMPLES) };
        let call =
            TestDraw { shader: "@fragment fn main() {}", attachments, list: &list, coverage: Coverage::WholePixel };
        assert_eq!(call.draw(&whole(0.5, RED)), PIXELS as u64);
    }
    let state = stencil(Compare::Equal, StencilOperation::DecrementClamp, StencilOperation::DecrementClamp, 2);
    let targets = vec![target(&output, Blend::Replace)];
    let attachments = Attachments { stencil: Some(state), targets, ..none(SAMPLES) };
    let call = TestDraw { shader: PLAIN, attachments, list: &list, coverage: Coverage::WholePixel };
    // The lower left half of the frame, three times. The diagonal divides the samples of pixels.
    let half = |red: f32| -> Corners {
        [[-1.0, 1.2], [-1.0, -1.0], [1.2, -1.0]].map(|[x, y]| ([x, y, 0.5, 1.0], [red, 0.0, 0.0, 1.0])).to_vec()
    };
    for red in [0.25, 0.5, 0.75] {
        call.draw(&half(red));
    }
    let seen = read(&output);
    let red = |sample: usize, pixel: usize| f32::from_bits(seen[4 * (sample * PIXELS + pixel)]);
    let mut covered = 0;
    for pixel in 0..PIXELS {
        let stored = [0, 1, 2, 3].map(|sample| red(sample, pixel));
        assert!(stored == [0.25, 0.5, 0.75, 0.0] || stored == [0.0; 4], "pixel {pixel}: {stored:?}");
        covered += usize::from(stored[0] > 0.0);
    }
    assert!(covered > 6 && covered < PIXELS, "{covered}");
}

#[test]
fn samples_are_covered_one_by_one_and_masked() {
    // Covers everything left of x = 1.5 pixels.
    let left: Corners = [[-0.25, 5.0], [-9.0, 0.0], [-0.25, -5.0]].map(|[x, y]| ([x, y, 0.5, 1.0], RED)).to_vec();
    let shaders = [
        // Of the eight standard samples, 1, 3, 4 and 5 are left of the centre.
        (PLAIN, 8 + 4),
        (
            "struct Out { @location(0) c: vec4<f32>, @builtin(sample_mask) mask: u32 }
          @fragment fn main(in: VertexOutput) -> Out { return Out(in.color, 1u); }",
            1,
        ),
        (
            "@fragment fn main(in: VertexOutput, @builtin(sample_index) sample: u32) -> @location(0) vec4<f32> {
            if sample != 2u { discard; }
            return in.color;
          }",
            1,
        ),
    ];
    for (shader, expected) in shaders {
        let (output, list) = (zeros(4 * PIXELS * 8), zeros(64));
        let attachments = Attachments { targets: vec![target(&output, Blend::Replace)], ..none(8) };
        let call = TestDraw { shader, attachments, list: &list, coverage: Coverage::PerSample };
        let passed = call.draw(&left);
        let seen = read(&output);
        let written = (0..8 * PIXELS).filter(|texel| seen[4 * texel] != 0).count();
        assert_eq!(passed, written as u64);
        assert_eq!(written, expected * SIZE as usize, "{shader}");
    }
}

#[test]
fn early_tests_precede_the_shader_and_write_before_a_discard() {
    for is_early in [false, true] {
        let (depths, list) = (words(&[0.5f32.to_bits(); PIXELS]), zeros(64));
        let depth = DepthAttachment {
            words: &depths,
            format: TextureFormat::Depth32Float,
            compare: Compare::Less,
            writes: true,
        };
        let attachments = Attachments { depth: Some(depth), is_early, ..none(1) };
        let shader =
            "@fragment fn main(in: VertexOutput) { atomicAdd(&list[0], 1u); if in.position.x < 2.0 { discard; } }";
        let call = TestDraw { shader, attachments, list: &list, coverage: Coverage::PerSample };
        call.draw(&whole(0.75, RED));
        assert_eq!(
            read(&list)[0],
            if is_early { 0 } else { PIXELS as u32 },
            "a fragment behind runs only if tests are late"
        );
        call.draw(&whole(0.25, RED));
        let expected = if is_early { 0.25f32 } else { 0.5 };
        assert_eq!(
            read(&depths)[0],
            expected.to_bits(),
            "a discarded fragment has written its depth only if tests are early"
        );
        assert_eq!(read(&depths)[3], 0.25f32.to_bits());
    }
}

#[test]
fn a_shader_may_write_its_depth() {
    let (depths, list) = (words(&[1.0f32.to_bits(); PIXELS]), zeros(64));
    let depth =
        DepthAttachment { words: &depths, format: TextureFormat::Depth32Float, compare: Compare::Less, writes: true };
    let shader = "@fragment fn main(in: VertexOutput) -> @builtin(frag_depth) f32 { return in.color.r; }";
    let attachments = Attachments { depth: Some(depth), ..none(1) };
    TestDraw { shader, attachments, list: &list, coverage: Coverage::PerSample }
        .draw(&whole(0.1, [0.625, 0.0, 0.0, 0.0]));
    assert_eq!(read(&depths)[5], 0.625f32.to_bits());
}

#[test]
fn attributes_are_interpolated_as_declared() {
    let shader =
        "@fragment fn main(in: VertexOutput, @builtin(primitive_index) index: u32, @builtin(front_facing) front: bool) {
        let at = 8u * (u32(in.position.y) * 4u + u32(in.position.x));
        atomicStore(&list[at], bitcast<u32>(in.color.r));
        atomicStore(&list[at + 1u], bitcast<u32>(in.straight));
        atomicStore(&list[at + 2u], in.id);
        atomicStore(&list[at + 3u], index);
        atomicStore(&list[at + 4u], u32(front));
        atomicStore(&list[at + 5u], bitcast<u32>(in.position.w));
    }";
    let list = zeros(8 * PIXELS);
    // w is 1 on the left and 3 on the right, red goes from 0 to 1; alpha is 4 tenths at the first corner, 7 at the others.
    let corner = |x: f32, y: f32, w: f32, red: f32, tenths: f32| {
        ([x * w, y * w, 0.5 * w, w], [red, 0.0, 0.0, 0.1 * tenths + 0.05])
    };
    let (a, b) = (corner(-1.0, 1.0, 1.0, 0.0, 4.0), corner(-1.0, -1.0, 1.0, 0.0, 7.0));
    let (c, d) = (corner(1.0, -1.0, 3.0, 1.0, 7.0), corner(1.0, 1.0, 3.0, 1.0, 7.0));
    TestDraw { shader, attachments: none(1), list: &list, coverage: Coverage::PerSample }.draw(&vec![a, b, c, a, c, d]);
    let seen = read(&list);
    for pixel in 0..PIXELS {
        let (x, y) = (pixel % 4, pixel / 4);
        let share = (x as f64 + 0.5) / 4.0;
        let inverse_w = (1.0 - share) + share / 3.0;
        let words = &seen[8 * pixel..][..6];
        let close = |word: u32, expected: f64| (f64::from(f32::from_bits(word)) - expected).abs() < 1.0e-6;
        assert!(close(words[0], share / 3.0 / inverse_w), "perspective at {x}, {y}");
        assert!(close(words[1], share), "linear at {x}, {y}");
        assert_eq!((words[2], words[4]), (4, 1), "flat and facing at {x}, {y}");
        // The first triangle is below the diagonal. The top-left rule assigns samples on it, which are not tested.
        assert!(x == y || words[3] == u32::from(x > y), "primitive at {x}, {y}");
        assert!(close(words[5], inverse_w));
    }
}

#[test]
fn a_shader_that_does_not_terminate_is_an_error() {
    let list = zeros(1);
    let shader = "@fragment fn main(in: VertexOutput) { loop { if atomicLoad(&list[0]) != 0u { break; } } }";
    let call = TestDraw { shader, attachments: none(1), list: &list, coverage: Coverage::PerSample };
    assert!(call.try_draw(&whole(0.5, RED)).unwrap_err().contains("does not terminate"));
}
