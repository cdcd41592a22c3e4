//! Dual depth peeling (Bavoil & Myers 2008): three colour attachments, max blending, a loop until a counter is zero.

use fragbuf_cpu::FragmentOrder;
use fragbuf_frame::LoopEnd;
use fragbuf_templates::vocabulary::{Access, Blend, Element, Pass, Repeat, Resource, Row, Step, TextureFormat, Until};

use crate::stage::{built_in, code, device, different, draw, picture, scattered, stacked, storage, texture};

/// The least float: below every depth and every negated depth.
const NOTHING: u32 = 0xff7f_ffff;

const BOUNDS: &str = "
@fragment
fn bounds(inputs: FragmentInput) -> @location(0) vec2<f32> {
    return vec2<f32>(-inputs.position.z, inputs.position.z);
}
";

const PEEL_BOTH: &str = "
struct Peeled {
    @location(0) bounds: vec2<f32>,
    @location(1) front: vec4<f32>,
    @location(2) back: vec4<f32>,
}

@fragment
fn peel_both(inputs: FragmentInput) -> Peeled {
    let depth = inputs.position.z;
    let before = last_bounds_load(pixel_index(inputs.position.xy));
    var peeled = Peeled(vec2<f32>(-3.402823466e+38), vec4<f32>(), vec4<f32>());
    let color = fragment_from_inputs(inputs).color;
    let premultiplied = vec4<f32>(color.rgb * color.a, color.a);
    if depth > -before.x && depth < before.y {
        left_atomic_add(1u);
        peeled.bounds = vec2<f32>(-depth, depth);
    } else if depth == -before.x {
        peeled.front = premultiplied;
    } else if depth == before.y {
        peeled.back = premultiplied;
    }
    return peeled;
}
";

const COMPOSITE: &str = "
@fragment
fn composite(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    let pixel = pixel_index(position.xy);
    let nearer = front_load(pixel);
    return nearer + (1.0 - nearer.a) * back_load(pixel);
}
";

fn rows() -> Row {
    let peel = Pass::geometry("peel", "peel_both")
        .uses("last_bounds", Access::Sampled)
        .uses("left", Access::Atomic)
        .target("next_bounds", Blend::Max)
        .target("front", Blend::Under)
        .target("back", Blend::Over);
    let body = vec![
        Step::Clear { resource: "left".to_owned(), value: 0 },
        Step::Clear { resource: "next_bounds".to_owned(), value: NOTHING },
        Step::Pass(peel),
        Step::Swap("last_bounds".to_owned(), "next_bounds".to_owned()),
    ];
    storage(
        vec![
            texture("last_bounds", TextureFormat::Rg32Float).cleared(NOTHING),
            texture("next_bounds", TextureFormat::Rg32Float),
            texture("front", TextureFormat::Rgba16Float).cleared(0),
            texture("back", TextureFormat::Rgba16Float).cleared(0),
            Resource::new("left", Element::Word, ""),
        ],
        vec![
            Step::Pass(Pass::geometry("bounds", "bounds").target("last_bounds", Blend::Max)),
            Step::Repeat(Repeat::new(body, Until::WordIsZero("left".to_owned()), "64")),
            Step::Pass(picture("composite").uses("front", Access::Sampled).uses("back", Access::Sampled)),
        ],
    )
}

#[test]
fn peeling_two_layers_per_iteration_gives_the_image() {
    let skeletons = [("bounds", BOUNDS), ("peel_both", PEEL_BOTH), ("composite", COMPOSITE)];
    let code = code(rows(), &skeletons, None).unwrap_or_else(|error| panic!("{error}"));
    for (name, triangles) in [("stacked", stacked(14, 8)), ("scattered", scattered(9, 6))] {
        let expected = draw(&mut built_in("ab_ll"), &triangles);
        for order in [FragmentOrder::Submission, FragmentOrder::Shuffled(2)] {
            let seen = draw(&mut device(&code, order), &triangles);
            assert_eq!(different(&seen.pixels, &expected.pixels, 1.0 / 128.0), 0, "{name}, {order:?}");
            let report = &seen.loops[0];
            assert_eq!((report.until.as_str(), report.end), ("`left` is zero", LoopEnd::ConditionMet));
            assert!((2..8).contains(&report.iterations), "{name}: {report:?}");
        }
    }
}
