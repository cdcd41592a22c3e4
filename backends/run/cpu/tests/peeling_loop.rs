//! The loop of front-to-back peeling (Everitt 2001). The tests of the CPU device and of the wgpu runtime share this file.

use fragbuf_templates::vocabulary::{
    Access, Blend, Compare, DepthState, Element, Objects, Pass, Repeat, Resource, Step, TextureFormat, Until,
};

/// The skeleton of the peeling pass.
pub const PEEL: &str = "
@fragment
fn peel(inputs: FragmentInput) -> @location(0) vec4<f32> {
    if inputs.position.z <= last_load(pixel_index(inputs.position.xy)) {
        discard;
    }
    let color = fragment_from_inputs(inputs).color;
    drawn_atomic_add(1u);
    return vec4<f32>(color.rgb * color.a, color.a);
}
";

/// The skeleton of the pass that blends the peeled layer.
pub const BLEND: &str = "
@fragment
fn blend(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    return peeled_load(pixel_index(position.xy));
}
";

/// The far plane as a word.
const FAR: u32 = 0x3f80_0000;

pub fn depth(resource: &str, compare: Compare, write: bool) -> Option<DepthState> {
    Some(DepthState { resource: resource.to_owned(), compare, write, early: false })
}

/// Returns the resources of the loop. `drawn` counts the fragments that are not discarded.
pub fn peeling_resources() -> Vec<Resource> {
    let texture = |name, format| Resource::new(name, Element::Texture(format), "").by("pixel", "pixels");
    vec![
        texture("last", TextureFormat::Depth32Float).cleared(0),
        texture("next", TextureFormat::Depth32Float),
        texture("peeled", TextureFormat::Rgba16Float),
        Resource::new("drawn", Element::Word, "").cleared(0),
    ]
}

/// Returns a loop whose pass `name` draws the nearest fragments behind those of the last iteration, until no sample passes. The
/// layers are blended under `target`. `before` is a pass before each peeling pass.
pub fn peeling_loop(name: &str, at_most: &'static str, objects: Objects, before: Option<Pass>, target: &str) -> Repeat {
    let mut peel = Pass::geometry(name, "peel").uses("last", Access::Sampled).uses("drawn", Access::Atomic);
    peel.state.depth = depth("next", Compare::Less, true);
    let peel = Pass { objects, ..peel.target("peeled", Blend::Replace) };
    let blend = Pass::fullscreen("blend", "blend").uses("peeled", Access::Sampled).target(target, Blend::Under);
    let mut body = vec![
        Step::Clear { resource: "next".to_owned(), value: FAR },
        Step::Clear { resource: "peeled".to_owned(), value: 0 },
    ];
    body.extend(before.map(Step::Pass));
    body.extend([Step::Pass(peel), Step::Pass(blend), Step::Swap("last".to_owned(), "next".to_owned())]);
    Repeat::new(body, Until::NoSamples(name.to_owned()), at_most)
}
