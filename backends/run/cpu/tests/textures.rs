//! Reads attachments of an earlier pass as textures: integers, floats, depth, stencil; single and multisampled.

use fragbuf_cpu::{Code, FragmentOrder};
use fragbuf_templates::vocabulary::{
    Access, Blend, Compare, Coverage, Element, Pass, Resource, Row, Samples, StencilOperation, StencilState, Step,
    TextureFormat,
};
use std::sync::Arc;

use crate::peeling_loop::depth;
use crate::stage::{FAR, SIZE, Triangle, code, device, draw, quad, sampled, storage, texture};

const DRAW_EACH: &str = "
struct Drawn {
    @location(0) whole: u32,
    @location(1) split: vec2<u32>,
    @location(2) single: f32,
    @location(3) pair: vec2<f32>,
    @location(4) bytes: vec4<f32>,
    @location(5) halves: vec4<f32>,
}

@fragment
fn draw_each(inputs: FragmentInput, @builtin(front_facing) front: bool) -> Drawn {
    let color = fragment_from_inputs(inputs).color;
    return Drawn(0x80000001u, vec2<u32>(0x10003u, 0xfedcu), color.r, vec2<f32>(-color.g, color.b), color, 4.0 * color + f32(!front));
}
";

const READ_EACH: &str = "
fn texel_of(texture: texture_2d<f32>, pixel: vec2<u32>) -> vec4<f32> {
    return textureLoad(texture, pixel, 0);
}

fn put(at: u32, value: vec4<f32>) {
    for (var index = 0u; index < 4u; index++) {
        seen_store(at + index, bitcast<u32>(value[index]));
    }
}

@compute @workgroup_size(1)
fn read_each() {
    let pixel = vec2<u32>(3u, 2u);
    put(0u, bitcast<vec4<f32>>(textureLoad(whole, pixel, 0)));
    put(4u, texel_of(single, pixel));
    put(8u, texel_of(pair, pixel));
    put(12u, texel_of(bytes, vec2<u32>(vec2<i32>(3, 2))));
    put(16u, textureLoad(halves, vec2<i32>(3, 2), 0));
    put(20u, vec4<f32>(textureLoad(depths, pixel, 0), vec3<f32>(1.0)));
    put(28u, bitcast<vec4<f32>>(textureLoad(split, pixel, 0)));
    let size = textureDimensions(depths);
    put(24u, vec4<f32>(vec2<f32>(size), f32(textureNumLevels(whole)), textureLoad(single, size - 1u, 0).r));
}
";

fn seen(count: &'static str) -> Resource {
    Resource::new("seen", Element::Word, "").by("word", count).cleared(0)
}

fn run(rows: Row, skeletons: &[(&str, &str)], keep: Option<u32>, triangles: &[Triangle]) -> Vec<u32> {
    let code: Arc<Code> = code(rows, skeletons, keep).unwrap_or_else(|error| panic!("{error}"));
    let mut device = device(&code, FragmentOrder::Submission);
    draw(&mut device, triangles);
    device.words("seen").unwrap()
}

#[test]
fn every_format_is_read_as_it_was_drawn() {
    let formats = [
        ("whole", TextureFormat::R32Uint),
        ("split", TextureFormat::Rg16Uint),
        ("single", TextureFormat::R32Float),
        ("pair", TextureFormat::Rg32Float),
        ("bytes", TextureFormat::Rgba8Unorm),
        ("halves", TextureFormat::Rgba16Float),
    ];
    let mut draw_each = Pass::geometry("draw_each", "draw_each");
    let mut read = Pass::compute("read_each", "read_each", "1", "1").uses("seen", Access::Plain);
    for (name, _) in formats {
        draw_each = draw_each.target(name, Blend::Replace);
        read = read.uses(name, Access::Sampled);
    }
    draw_each.state.depth = depth("depths", Compare::Less, true);
    let mut resources: Vec<Resource> = formats.iter().map(|(name, format)| texture(name, *format).cleared(0)).collect();
    resources.extend([texture("depths", TextureFormat::Depth32Float).cleared(FAR), seen("32")]);
    let rows = storage(resources, vec![Step::Pass(draw_each), Step::Pass(read.uses("depths", Access::Sampled))]);
    let color = [0.2, 0.4, 0.6, 0.8];
    let seen =
        run(rows, &[("draw_each", DRAW_EACH), ("read_each", READ_EACH)], None, &quad([2, 5, 1, 4], 0.625, color));
    let floats = |at: usize| -> [f32; 4] { std::array::from_fn(|index| f32::from_bits(seen[at + index])) };
    assert_eq!(seen[..4], [0x8000_0001, 0, 0, 1]);
    // Interpolation between equal corners is exact.
    assert_eq!(floats(4), [0.2, 0.0, 0.0, 1.0]);
    assert_eq!(floats(8), [-0.4, 0.6, 0.0, 1.0]);
    assert_eq!(floats(12), [51.0, 102.0, 153.0, 204.0].map(|byte: f32| byte / 255.0));
    for (seen, exact) in floats(16).into_iter().zip(color) {
        assert!((seen - 4.0 * exact).abs() < 1.0 / 512.0, "{seen}: the front of the quad is visible");
    }
    assert_eq!(floats(20), [0.625, 1.0, 1.0, 1.0]);
    assert_eq!(seen[28..], [3, 0xfedc, 0, 1], "16 bits per channel");
    assert_eq!(floats(24), [SIZE as f32, SIZE as f32, 1.0, 0.0]);
}

const MASKED: &str = "
struct Masked {
    @location(0) color: u32,
    @builtin(sample_mask) mask: u32,
}

@fragment
fn masked(inputs: FragmentInput, @builtin(sample_mask) covered: u32) -> Masked {
    return Masked(covered + 16u, covered & 6u);
}
";

const READ_SAMPLES: &str = "
@compute @workgroup_size(1)
fn read_samples() {
    for (var sample = 0u; sample < textureNumSamples(numbers); sample++) {
        seen_store(sample, textureLoad(numbers, vec2<u32>(1u, 1u), sample).r);
        seen_store(4u + sample, u32(round(256.0 * textureLoad(tested, vec2<u32>(1u, 1u), sample))));
    }
}
";

#[test]
fn samples_are_read_one_by_one() {
    let mut pass = Pass::geometry("masked", "masked").target("numbers", Blend::Replace);
    pass.state.depth = depth("tested", Compare::Less, true);
    pass.state.samples =
        Some(Samples { count: "capacity".into(), mask: "pow2(capacity) - 1".into(), coverage: Coverage::PerSample });
    let read = Pass::compute("read_samples", "read_samples", "1", "1")
        .uses("numbers", Access::Sampled)
        .uses("tested", Access::Sampled)
        .uses("seen", Access::Plain);
    let rows = storage(
        vec![
            sampled("numbers", TextureFormat::R32Uint).cleared(0),
            sampled("tested", TextureFormat::Depth32Float).cleared(FAR),
            seen("8"),
        ],
        vec![Step::Pass(pass), Step::Pass(read)],
    );
    // The four samples of pixel (1, 1) are at 3/8, 7/8, 1/8 and 5/8 from its left: 0 and 2 are left of the centre.
    let left = Triangle { corners: [[1.5, -40.0, 0.25], [-60.0, 1.0, 0.25], [1.5, 42.0, 0.25]], color: [1.0; 4] };
    let seen = run(rows, &[("masked", MASKED), ("read_samples", READ_SAMPLES)], Some(4), &[left]);
    assert_eq!(seen, [0, 0, 21, 0, 256, 256, 64, 256]);
}

const NOTHING: &str = "
@fragment
fn nothing() {}
";

const READ_STENCIL: &str = "
@compute @workgroup_size(1)
fn read_stencil() {
    seen_store(0u, routing_load(frame.width + 1u));
    seen_store(1u, routing_load(frame.width + 9u));
}
";

#[test]
fn a_stencil_is_read_as_integers() {
    let mut pass = Pass::geometry("nothing", "nothing");
    pass.state.stencil = Some(StencilState {
        resource: "routing".to_owned(),
        compare: Compare::Always,
        fail: StencilOperation::Keep,
        pass: StencilOperation::Replace,
        reference: "77".into(),
    });
    let read = Pass::compute("read_stencil", "read_stencil", "1", "1")
        .uses("routing", Access::Sampled)
        .uses("seen", Access::Plain);
    let routing = texture("routing", TextureFormat::Depth24PlusStencil8).cleared(0x1234_5603);
    let rows = storage(vec![routing, seen("2")], vec![Step::Pass(pass), Step::Pass(read)]);
    let skeletons = [("nothing", NOTHING), ("read_stencil", READ_STENCIL)];
    assert_eq!(run(rows, &skeletons, None, &quad([0, 4, 0, 4], 0.5, [1.0; 4])), [77, 3]);
}
