//! The rows and their techniques.

use fragbuf_templates::Registry;
use fragbuf_templates::vocabulary::{
    Access, Blend, Capability, Compare, DepthState, Element, Feature, KeepDefault, Pass, Repeat, Resource, Row, Step,
    Technique, TextureFormat, Until,
};

pub(super) fn registry() -> Registry {
    Registry::builtin()
        .with(front_to_back())
        .with(dual())
        .with_technique(technique("f2b", KeepDefault::All, vec![("storage", "front_to_back")]))
        .with_technique(technique("dual", KeepDefault::All, vec![("storage", "dual")]))
}

fn technique(key: &str, keep: KeepDefault, choices: Vec<(&'static str, &'static str)>) -> Technique {
    Technique { key: key.to_owned(), title: "", paper: "", summary: "", keep, choices }
}

fn texture(name: &str, format: TextureFormat, summary: &'static str) -> Resource {
    Resource::new(name, Element::Texture(format), summary).by("pixel", "pixels")
}

/// Everitt 2001: each iteration draws what is behind the nearest layer of the previous one.
fn front_to_back() -> Row {
    let mut peel = Pass::geometry("peel", "peel").uses("last_depth", Access::Sampled).target("layer", Blend::Replace);
    peel.state.depth =
        Some(DepthState { resource: "next_depth".to_owned(), compare: Compare::Less, write: true, early: false });
    let blend = Pass::fullscreen("blend", "blend").uses("layer", Access::Sampled).target("output", Blend::Under);
    Row {
        resources: vec![
            texture("last_depth", TextureFormat::Depth32Float, "the depth peeled last").cleared(0),
            texture("next_depth", TextureFormat::Depth32Float, "the depth being peeled"),
            texture("layer", TextureFormat::Rgba8Unorm, "the layer being peeled"),
        ],
        steps: vec![Step::Repeat(Repeat::new(
            vec![
                Step::Clear { resource: "next_depth".to_owned(), value: 0x3f80_0000 },
                Step::Pass(peel),
                Step::Pass(blend),
                Step::Swap("last_depth".to_owned(), "next_depth".to_owned()),
            ],
            Until::NoSamples("peel".to_owned()),
            "1024",
        ))],
        provides: vec![Capability::FixedFunction, Capability::KeepsAll, Capability::Sorted],
        defaults: vec![("sync".into(), "fixed_function".into()), ("sort".into(), "none".into())],
        ..Row::new("storage", "front_to_back", "one layer per iteration", "Everitt 2001")
    }
}

/// Bavoil & Myers 2008: nearest and farthest remaining fragments, by maximum blending of (-z, z).
fn dual() -> Row {
    let first = Pass::geometry("bounds", "bounds").target("last_bounds", Blend::Max);
    let peel = Pass::geometry("peel", "peel_both")
        .uses("last_bounds", Access::Sampled)
        .uses("left", Access::Atomic)
        .target("next_bounds", Blend::Max)
        .target("front", Blend::Under)
        .target("back", Blend::Over);
    let composite = Pass::fullscreen("composite", "composite")
        .uses("front", Access::Sampled)
        .uses("back", Access::Sampled)
        .target("output", Blend::Over);
    Row {
        resources: vec![
            texture("last_bounds", TextureFormat::Rg32Float, "(-nearest, farthest) of the remaining fragments")
                .cleared(0xff80_0000),
            texture("next_bounds", TextureFormat::Rg32Float, "the same for the next iteration"),
            texture("front", TextureFormat::Rgba8Unorm, "layers from the front").cleared(0),
            texture("back", TextureFormat::Rgba8Unorm, "layers from the back").cleared(0),
            Resource::new("left", Element::Word, "fragments between the bounds in this iteration"),
        ],
        steps: vec![
            Step::Pass(first),
            Step::Repeat(Repeat::new(
                vec![
                    Step::Clear { resource: "left".to_owned(), value: 0 },
                    Step::Clear { resource: "next_bounds".to_owned(), value: 0xff80_0000 },
                    Step::Pass(peel),
                    Step::Swap("last_bounds".to_owned(), "next_bounds".to_owned()),
                ],
                Until::WordIsZero("left".to_owned()),
                "512",
            )),
            Step::Pass(composite),
        ],
        provides: vec![Capability::FixedFunction, Capability::KeepsAll, Capability::Sorted],
        needs: vec![Feature::MinMaxBlend],
        defaults: vec![("sync".into(), "fixed_function".into()), ("sort".into(), "none".into())],
        ..Row::new("storage", "dual", "two layers per iteration", "Bavoil & Myers 2008")
    }
}
