//! Axis `cull`: which fragments are rejected before they reach the storage.

use crate::conditions::{depth_key, keeps_one};
use crate::vocabulary::{
    Access, Capability, Compare, DepthState, Edit, Element, Feature, Parameter, Pass, Resource, Row, State, Step,
    TextureFormat, Use,
};

pub(crate) fn rows() -> Vec<Row> {
    vec![
        Row {
            template: Some(template!("cull/none")),
            provides: vec![Capability::CullInShader, Capability::NoCull],
            ..Row::new("cull", "none", "no fragment", "")
        },
        Row {
            template: Some(template!("cull/early")),
            calls: vec!["storage"],
            provides: vec![Capability::CullInShader],
            requires: vec![Capability::ConservativeBound],
            ..Row::new("cull", "early", "fragments worse than the worst kept one, tested before the lock", "K15 §3.2")
        },
        occupancy(),
        occupancy_early(),
        temporal(),
        z_prepass(),
        depth_prepass(),
    ]
}

/// Culls all but the nearest fragment by the depth test, after a pass over the scene that writes nothing but depth.
fn depth_prepass() -> Row {
    let test =
        |compare: Compare, write: bool| DepthState { resource: "depths".to_owned(), compare, write, early: false };
    let mut prepass = Pass::geometry("depth_prepass", "depth_prepass").uses("depths", Access::Attachment);
    prepass.state.depth = Some(test(Compare::Less, true));
    Row {
        template: Some(template!("cull/none")),
        requires: vec![Capability::LeavesDepth],
        needs: vec![Feature::OwnEntryPoints],
        edits: vec![
            Edit::Before("store".to_owned(), vec![Step::Pass(prepass)]),
            Edit::SetDepth("store".to_owned(), test(Compare::Equal, false)),
        ],
        ..Row::new(
            "cull",
            "depth_prepass",
            "all but the nearest fragment, by a depth test after a pass over the scene that writes only depth",
            "D13 §3.1.1 (F2B2)",
        )
    }
}

/// Culls by the bounds of the last frame, which one pass over the scene confirms, and saves the bounds after the store pass.
fn temporal() -> Row {
    let last =
        Resource::new("last_bounds", Element::Word, "the bound at the end of the last frame; any value is sound");
    let confirmed = Resource::new("confirmed", Element::Word, "fragments of this frame within the last bound");
    let confirm = Pass::geometry("confirm", "key_range");
    let confirm = confirm.uses("last_bounds", Access::Read).uses("confirmed", Access::Atomic);
    let save = Pass::compute("save_bounds", "occupancy_bound", "ceil_div(width, 8)", "ceil_div(height, 8)");
    let save = save.uses("last_bounds", Access::Plain).uses("keys", Access::Hinted);
    Row {
        template: Some(template!("cull/temporal")),
        resources: vec![last.by("pixel", "pixels").persistent(), confirmed.by("pixel", "pixels").cleared(0)],
        uses: vec![Use::new("last_bounds", Access::Read), Use::new("confirmed", Access::Read)],
        calls: vec!["storage"],
        provides: vec![Capability::CullInShader],
        requires: vec![Capability::AcceptsKBestOnly, Capability::ConservativeBound, Capability::KeyPerSlot],
        needs: vec![Feature::FragmentAtomics],
        edits: vec![
            Edit::Before("store".to_owned(), vec![Step::Pass(confirm)]),
            Edit::After("store".to_owned(), vec![Step::Pass(save)]),
        ],
        ..Row::new(
            "cull",
            "temporal",
            "fragments beyond the worst kept one of the last frame, if a pre-pass confirms it, and what `early` rejects",
            "K15 §6",
        )
    }
}

/// Culls by the result of one pass over the scene before the store pass.
fn z_prepass() -> Row {
    let prepass = Resource::new("prepass", Element::Word, "the key of the pixel's best fragment; EMPTY: none");
    let key_range = Step::Pass(Pass::geometry("key_range", "key_range").uses("prepass", Access::Atomic));
    Row {
        template: Some(template!("cull/z_prepass")),
        resources: vec![prepass.by("pixel", "pixels").cleared(u32::MAX)],
        uses: vec![Use::new("prepass", Access::Read)],
        provides: vec![Capability::CullInShader],
        requires: vec![Capability::AcceptsKBestOnly],
        conditions: vec![keeps_one()],
        needs: vec![Feature::FragmentAtomics],
        edits: vec![Edit::Before("store".to_owned(), vec![key_range])],
        ..Row::new("cull", "z_prepass", "all but the best fragment, which a pre-pass finds; for `keep 1`", "K15 §4.3")
    }
}

/// Culls by the result of two passes over the scene before the store pass.
fn occupancy() -> Row {
    let bound = Pass::compute("occupancy_bound", "occupancy_bound", "ceil_div(width, 8)", "ceil_div(height, 8)");
    let bound = bound.uses("occupancy", Access::Plain);
    Row {
        template: Some(template!("cull/occupancy")),
        uses: vec![Use::new("occupancy", Access::Read)],
        provides: vec![Capability::CullInShader],
        requires: vec![Capability::AcceptsKBestOnly],
        needs: vec![Feature::FragmentAtomics],
        edits: vec![before_store(bound)],
        ..by_occupancy("occupancy", "fragments beyond the k-th occupied bucket of keys, which two pre-passes find")
    }
}

/// Culls the same fragments by a depth test before the shader runs, and tests those that pass as `early` does.
fn occupancy_early() -> Row {
    let limits =
        Resource::new("limits", Element::Texture(TextureFormat::Depth32Float), "the farthest depth that can be kept")
            .by("pixel", "pixels");
    let test = |compare: Compare, write: bool, early: bool| State {
        depth: Some(DepthState { resource: "limits".to_owned(), compare, write, early }),
        ..State::default()
    };
    let mut limit = Pass::fullscreen("limit", "limit").uses("occupancy", Access::Read);
    limit.state = test(Compare::Always, true, false);
    let row = by_occupancy("occupancy_early", "the same by an early depth test, then the `early` test");
    Row {
        template: Some(template!("cull/early")),
        resources: [row.resources, vec![limits]].concat(),
        calls: vec!["storage"],
        // The depth test tests keys, so keys must be the rasteriser's depth, which a caller's shader may replace.
        requires: vec![Capability::AcceptsKBestOnly, Capability::ConservativeBound, Capability::OneSample],
        conditions: vec![depth_key()],
        needs: vec![Feature::FragmentAtomics, Feature::EarlyDepth, Feature::OwnEntryPoints],
        edits: vec![before_store(limit), Edit::SetState("store".to_owned(), test(Compare::LessEqual, false, true))],
        ..row
    }
}

/// Returns the resources and parameters of both occupancy rows.
fn by_occupancy(key: &str, summary: &'static str) -> Row {
    let map = Resource::new(
        "occupancy",
        Element::Word,
        "the complement of the pixel's nearest key; the farthest key that can be kept; a bit per occupied bucket",
    );
    Row {
        resources: vec![map.by("word", "OCCUPANCY_WORDS + 2").by("pixel", "pixels").cleared(0)],
        parameters: vec![Parameter::number(
            "words",
            "OCCUPANCY_WORDS",
            "max(4, capacity / 8)",
            (1, 128),
            "words of 32 buckets that divide the range of a pixel's keys; more than k / 32",
        )],
        least: vec![("words".into(), "k / 32 + 1".into())],
        ..Row::new("cull", key, summary, "Vasilakis & Papaioannou 2015 (C15)")
    }
}

/// Inserts the two passes over the scene, and `last`, which evaluates them, before the store pass.
fn before_store(last: Pass) -> Edit {
    let scene_pass = |name: &str| {
        Step::Pass(Pass::geometry(name, name).uses("occupancy", Access::Atomic).implementation(
            "cull",
            "occupancy",
            "cull",
        ))
    };
    let last = Step::Pass(last.implementation("cull", "occupancy", "cull"));
    Edit::Before("store".to_owned(), vec![scene_pass("key_range"), scene_pass("occupancy_map"), last])
}
