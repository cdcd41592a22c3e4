//! Axis `cull`: which fragments are turned away before they reach the storage.

use crate::conditions::{depth_key, keeps_one};
use crate::vocabulary::{
    Access, Capability, Compare, DepthState, Edit, Element, Fact, Parameter, Pass, Resource, Row, State, Step,
    TextureFormat, Use,
};

pub(crate) fn rows() -> Vec<Row> {
    vec![
        Row {
            template: Some(template!("cull/none")),
            offers: vec![Fact::CullInShader, Fact::CullsNothing],
            ..Row::new("cull", "none", "no fragment is turned away", "")
        },
        Row {
            template: Some(template!("cull/early")),
            calls: vec!["storage"],
            offers: vec![Fact::CullInShader],
            requires: vec![Fact::BoundAnyInstant],
            ..Row::new("cull", "early", "fragments worse than the worst kept one, tested before the lock", "K15 §3.2")
        },
        occupancy(),
        occupancy_early(),
        z_prepass(),
    ]
}

/// By what one pass over the scene finds out before the store pass.
fn z_prepass() -> Row {
    let prepass = Resource::new("prepass", Element::Word, "the key of the pixel's best fragment; EMPTY: it has none");
    let measure = Step::Pass(Pass::geometry("measure", "measure").uses("prepass", Access::Atomic));
    Row {
        template: Some(template!("cull/z_prepass")),
        resources: vec![prepass.by("pixel", "pixels").cleared(u32::MAX)],
        uses: vec![Use::new("prepass", Access::Read)],
        offers: vec![Fact::CullInShader],
        requires: vec![Fact::BestSuffice],
        conditions: vec![keeps_one()],
        needs: vec![Capability::FragmentAtomics],
        edits: vec![Edit::Before("store".to_owned(), vec![measure])],
        ..Row::new(
            "cull",
            "z_prepass",
            "all but the best fragment, which one pass before finds; for `keep 1`",
            "K15 §4.3",
        )
    }
}

/// By what two passes over the scene find out before the store pass.
fn occupancy() -> Row {
    let narrow = Pass::compute("narrow", "narrow", "ceil_div(width, 8)", "ceil_div(height, 8)");
    let narrow = narrow.uses("occupancy", Access::Plain);
    Row {
        template: Some(template!("cull/occupancy")),
        uses: vec![Use::new("occupancy", Access::Read)],
        offers: vec![Fact::CullInShader],
        requires: vec![Fact::BestSuffice],
        needs: vec![Capability::FragmentAtomics],
        edits: vec![before_store(narrow)],
        ..by_occupancy("occupancy", "fragments beyond the k-th occupied bucket, which two passes before find")
    }
}

/// The same by a depth test, before the shader runs; what comes through it is tested as by `early`.
fn occupancy_early() -> Row {
    let limits =
        Resource::new("limits", Element::Texture(TextureFormat::Depth32Float), "the farthest depth that may stay")
            .by("pixel", "pixels");
    let test = |compare: Compare, write: bool, early: bool| State {
        depth: Some(DepthState { resource: "limits".to_owned(), compare, write, early }),
        ..State::default()
    };
    let mut limit = Pass::fullscreen("limit", "limit").uses("occupancy", Access::Read);
    limit.state = test(Compare::Always, true, false);
    let row = by_occupancy("occupancy_early", "the same by a depth test before the shader, then as by `early`");
    Row {
        template: Some(template!("cull/early")),
        resources: [row.resources, vec![limits]].concat(),
        calls: vec!["storage"],
        // Keys are what is tested: the rasteriser's depth, which a caller's own shader may replace.
        requires: vec![Fact::BestSuffice, Fact::BoundAnyInstant, Fact::OneSample],
        conditions: vec![depth_key()],
        needs: vec![Capability::FragmentAtomics, Capability::EarlyDepth, Capability::OwnEntryPoints],
        edits: vec![before_store(limit), Edit::SetState("store".to_owned(), test(Compare::LessEqual, false, true))],
        ..row
    }
}

/// What both keep and can be told.
fn by_occupancy(key: &str, summary: &'static str) -> Row {
    let map = Resource::new(
        "occupancy",
        Element::Word,
        "the complement of the pixel's nearest key; the farthest that may stay; which buckets between are occupied",
    );
    Row {
        resources: vec![map.by("word", "OCCUPANCY_WORDS + 2").by("pixel", "pixels").cleared(0)],
        parameters: vec![Parameter::number(
            "words",
            "OCCUPANCY_WORDS",
            "max(4, capacity / 8)",
            (1, 128),
            "words of 32 buckets that the range of a pixel's keys is cut into; more than k / 32",
        )],
        least: vec![("words".into(), "k / 32 + 1".into())],
        ..Row::new("cull", key, summary, "Vasilakis & Papaioannou 2015 (C15)")
    }
}

/// The passes over the scene, and the one that makes something of what they found.
fn before_store(last: Pass) -> Edit {
    let survey = |anchor: &str| {
        Step::Pass(Pass::geometry(anchor, anchor).uses("occupancy", Access::Atomic).role("cull", "occupancy", "cull"))
    };
    let last = Step::Pass(last.role("cull", "occupancy", "cull"));
    Edit::Before("store".to_owned(), vec![survey("measure"), survey("occupy"), last])
}
