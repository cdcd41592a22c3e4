//! Storages in textures that depth test, stencil and targets write: no shader decides what stays.

use crate::vocabulary::{
    Access, Blend, Compare, DepthState, Element, Fact, Hazard, Pass, Resource, Row, Step, Text, TextureFormat,
};

/// The nearest fragment, by the depth test.
pub(super) fn depth_tested() -> Row {
    let depths =
        Resource::new("depths", Element::Texture(TextureFormat::Depth32Float), "depth of the fragment; 1: none");
    let entries = Resource::new(
        "entries",
        Element::BesideTextures(TextureFormat::R32Uint),
        "what the fragment carries beside its depth",
    );
    let mut store = Pass::geometry("store", "store_targets")
        .uses("depths", Access::Attachment)
        .uses("entries", Access::Attachment)
        .target("entries", Blend::Replace);
    store.state.depth =
        Some(DepthState { resource: "depths".to_owned(), compare: Compare::Less, write: true, early: false });
    Row {
        template: Some(template!("storage/depth_tested")),
        resources: vec![
            depths.by("pixel", "pixels").cleared(1.0_f32.to_bits()),
            entries.by("pixel", "pixels").cleared(0),
        ],
        steps: vec![
            Step::Pass(store),
            Step::Pass(
                Pass::fullscreen("resolve", "resolve")
                    .uses("depths", Access::Sampled)
                    .uses("entries", Access::Sampled)
                    .target("output", Blend::Over),
            ),
        ],
        requires: vec![
            Fact::DepthKey,
            Fact::LimitedToOne,
            Fact::WordPerTarget,
            Fact::LeftToTests,
            Fact::OwnEntryPoints,
        ],
        hazards: vec![
            hazard("equal-keys", "of fragments with equal depths one is kept, the first to be submitted"),
            hazard("far-plane", "a fragment at depth 1.0 exactly is not kept"),
            hazard("uncounted", "what the depth test turns away is not counted"),
        ],
        // One fragment is in order.
        offers: vec![Fact::KeepsBest, Fact::FixedFunction, Fact::Sorted],
        defaults: vec![LEFT_TO_TESTS, ARRIVAL, UNSORTED],
        ..Row::new(
            "storage",
            "depth_tested",
            "the nearest fragment, by the depth test, its words in targets",
            "Catmull 1974; K15 §4.3 (Z-buffer)",
        )
    }
}

/// Values on other axes that suit it.
const LEFT_TO_TESTS: (Text, Text) = (Text::Borrowed("sync"), Text::Borrowed("fixed_function"));
const ARRIVAL: (Text, Text) = (Text::Borrowed("ties"), Text::Borrowed("unordered"));
const UNSORTED: (Text, Text) = (Text::Borrowed("sort"), Text::Borrowed("none"));

fn hazard(name: impl Into<Text>, what: impl Into<Text>) -> Hazard {
    Hazard { name: name.into(), what: what.into(), unless: None }
}
