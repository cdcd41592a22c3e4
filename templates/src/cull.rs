//! Axis `cull`: which fragments are turned away before they reach the storage.

use crate::vocabulary::{Access, Edit, Element, Fact, Parameter, Pass, Resource, Row, Step, Use};

pub(crate) fn rows() -> Vec<Row> {
    vec![
        Row { template: Some(template!("cull/none")), ..Row::new("cull", "none", "no fragment is turned away", "") },
        Row {
            template: Some(template!("cull/early")),
            calls: vec!["storage"],
            requires: vec![Fact::BoundAnyInstant],
            ..Row::new("cull", "early", "fragments worse than the worst kept one, tested before the lock", "K15 §3.2")
        },
        occupancy(),
    ]
}

/// What a pass before the store pass finds out of all fragments.
fn occupancy() -> Row {
    let narrow = Pass::compute("narrow", "narrow", "ceil_div(width, 8)", "ceil_div(height, 8)");
    Row {
        template: Some(template!("cull/occupancy")),
        resources: vec![
            Resource::new(
                "occupancy",
                Element::Word,
                "the complement of the pixel's nearest key; the farthest that may stay; which of the buckets between \
                 are occupied",
            )
            .by("word", "OCCUPANCY_WORDS + 2")
            .by("pixel", "pixels")
            .cleared(0),
        ],
        uses: vec![Use::new("occupancy", Access::Read)],
        requires: vec![Fact::FragmentAtomics, Fact::BestSuffice],
        edits: vec![Edit::Before(
            "store".to_owned(),
            vec![
                Step::Pass(Pass::geometry("measure", "measure").uses("occupancy", Access::Atomic)),
                Step::Pass(Pass::geometry("occupy", "occupy").uses("occupancy", Access::Atomic)),
                Step::Pass(narrow.uses("occupancy", Access::Plain)),
            ],
        )],
        parameters: vec![Parameter {
            name: "words".into(),
            constant: "OCCUPANCY_WORDS".into(),
            default: "max(4, capacity / 8)".into(),
            range: (1, 128),
            summary: "words of 32 buckets that the range of a pixel's keys is cut into; more than k / 32".into(),
        }],
        least: vec![("words".into(), "k / 32 + 1".into())],
        ..Row::new(
            "cull",
            "occupancy",
            "fragments beyond the k-th occupied bucket of the pixel's range, found by two passes over the scene before",
            "Vasilakis & Papaioannou 2015 (C15)",
        )
    }
}
