//! Storages in textures: depth test, stencil test and render targets decide which fragments are kept, not a shader.

use crate::conditions::{depth_key, keeps_one, word_per_target};
use crate::vocabulary::{
    Access, Blend, Capability, Compare, Condition, Coverage, DepthState, Element, Feature, Hazard, Pass, Permits,
    Repeat, Resource, Row, Samples, StencilOperation, StencilState, Step, Text, TextureFormat, Until,
};

/// Returns the row that keeps the nearest fragment by the depth test.
pub(super) fn depth_tested() -> Row {
    let depths =
        Resource::new("depths", Element::Texture(TextureFormat::Depth32Float), "depth of the fragment; 1: none");
    let entries =
        Resource::new("entries", Element::ValueTextures(TextureFormat::R32Uint), "the value words of the fragment");
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
        requires: vec![Capability::OneSample, Capability::SyncByFixedFunction],
        conditions: vec![depth_key(), keeps_one(), word_per_target()],
        needs: vec![Feature::OwnEntryPoints],
        hazards: vec![
            Hazard::new(
                "equal-keys",
                "of fragments with equal depths only the first submitted is kept; the last, where a pass wrote their depth before",
                Permits::ONE_OF_EQUAL_KEYS,
            ),
            Hazard::new("far-plane", "a fragment at a depth of exactly 1.0 is not kept", Permits::NOTHING),
            Hazard::new("uncounted", "fragments that the depth test rejects are not counted", Permits::UNCOUNTED),
        ],
        // One fragment is sorted.
        provides: vec![Capability::KeepsBest, Capability::FixedFunction, Capability::LeavesDepth, Capability::Sorted],
        defaults: vec![BY_TESTS, ARRIVAL, UNSORTED],
        ..Row::new(
            "storage",
            "depth_tested",
            "the nearest fragment by the depth test, with its words in render targets",
            "Catmull 1974; K15 §4.3 (Z-buffer)",
        )
    }
}

/// Returns the row that stores the first k fragments in the samples of a pixel by the stencil test.
pub(super) fn stencil_routed() -> Row {
    let by_sample = |name: &str, element: Element, summary: &'static str| {
        Resource::new(name, element, summary).by("sample", "capacity").by("pixel", "pixels").cleared(0)
    };
    // A fragment with partial coverage is lost or duplicated. On devices that support it, it covers all samples or
    // none.
    let samples = |mask: &'static str| {
        Some(Samples { count: "capacity".into(), mask: mask.into(), coverage: Coverage::WholePixel })
    };
    let mut route = Pass::fullscreen("route", "route").uses("routing", Access::Attachment);
    route.state.stencil = Some(StencilState {
        resource: "routing".to_owned(),
        compare: Compare::Always,
        fail: StencilOperation::Keep,
        pass: StencilOperation::Replace,
        reference: "256 - capacity + iteration".into(),
    });
    route.state.samples = samples("pow2(iteration)");
    let mut store = Pass::geometry("store", "store_routed")
        .uses("routing", Access::Attachment)
        .uses("entries", Access::Attachment)
        .target("entries", Blend::Replace);
    store.state.stencil = Some(StencilState {
        resource: "routing".to_owned(),
        compare: Compare::Equal,
        fail: StencilOperation::DecrementClamp,
        pass: StencilOperation::DecrementClamp,
        reference: "256 - capacity".into(),
    });
    store.state.samples = samples("pow2(capacity) - 1");
    let resolve = Pass::fullscreen("resolve", "resolve").uses("routing", Access::Sampled);
    Row {
        template: Some(template!("storage/stencil_routed")),
        resources: vec![
            by_sample("entries", Element::EntryTextures(TextureFormat::Rg16Uint), "the sample's fragment"),
            by_sample(
                "routing",
                Element::Texture(TextureFormat::Depth24PlusStencil8),
                "stencil: how many fragments precede the one that the sample takes; shaders read the stencil",
            ),
        ],
        steps: vec![
            Step::Repeat(Repeat::new(vec![Step::Pass(route)], Until::Times("capacity".into()), "capacity")),
            Step::Pass(store),
            Step::Pass(resolve.uses("entries", Access::Sampled).target("output", Blend::Over)),
        ],
        calls: vec!["counters"],
        provides: vec![Capability::FixedFunction],
        requires: vec![Capability::OneSample, Capability::SyncByFixedFunction],
        conditions: vec![
            depth_key(),
            Condition::new(
                "keep == 2 || keep == 4 || keep == 8",
                "a limit that is a sample count: `keep 2`, `keep 4` or `keep 8`",
                "write `keep 4;`",
            ),
            word_per_target(),
        ],
        needs: vec![Feature::SampleMask, Feature::OwnEntryPoints],
        needs_if: vec![("keep != 4".into(), Feature::SampleCounts)],
        defaults: vec![BY_TESTS, ARRIVAL],
        hazards: vec![
            Hazard::new(
                "first-k",
                "the first k fragments in submission order are kept, whatever their depth",
                Permits::NOTHING,
            ),
            Hazard::new(
                "borders",
                "if a triangle covers only some samples of a pixel, fragments may be lost or stored twice there; \
                 such fragments are counted, so at most that many pixels are wrong",
                Permits::NOTHING,
            ),
            Hazard::new(
                "many-late",
                "at most 255 - capacity fragments of a pixel that arrive too late are counted",
                Permits::NOTHING,
            ),
        ],
        ..Row::new(
            "storage",
            "stencil_routed",
            "the first k fragments, each in a sample of a multisampled target, by the stencil test",
            "Myers & Bavoil 2007; K15 §2 (KB-SR)",
        )
    }
}

/// Defaults on other axes.
const BY_TESTS: (Text, Text) = (Text::Borrowed("sync"), Text::Borrowed("fixed_function"));
const ARRIVAL: (Text, Text) = (Text::Borrowed("ties"), Text::Borrowed("unordered"));
const UNSORTED: (Text, Text) = (Text::Borrowed("sort"), Text::Borrowed("none"));
