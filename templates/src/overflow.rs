//! Axis `overflow`: what becomes of a fragment that finds no place.

use crate::vocabulary::{Access, Element, Fact, Resource, Row, Template, Use};

pub(crate) fn rows() -> Vec<Row> {
    vec![
        row("drop", "it is dropped, and counted", "", template!("overflow/drop")),
        Row {
            resources: vec![
                Resource::new(
                    "tail",
                    Element::Word,
                    "sums over the fragments that were not kept: r, g, b, alpha, opacity",
                )
                .by("part", "5")
                .by("pixel", "pixels")
                .cleared(0),
            ],
            uses: vec![Use::new("tail", Access::Atomic)],
            calls: vec!["counters", "samples"],
            requires: vec![Fact::Color, Fact::LosesWhole, Fact::OneResolve, Fact::FragmentAtomics],
            ..row(
                "weighted_tail",
                "it counts in a mean colour behind what is kept; the same for every order of arrival",
                "Maule et al. 2013; McGuire & Bavoil 2013",
                template!("overflow/weighted_tail"),
            )
        },
        Row {
            resources: vec![
                Resource::new("failed", Element::Word, "1: a fragment found no room, or a lock was not free")
                    .cleared(0),
            ],
            uses: vec![Use::new("failed", Access::Atomic)],
            requires: vec![Fact::FragmentAtomics],
            ..row(
                "fail",
                "the whole frame is magenta if one found no room, or a lock was not free in time",
                "",
                template!("overflow/fail"),
            )
        },
    ]
}

fn row(key: &str, summary: &'static str, paper: &'static str, template: Template) -> Row {
    Row { template: Some(template), calls: vec!["counters"], ..Row::new("overflow", key, summary, paper) }
}
