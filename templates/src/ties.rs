//! Axis `ties`: which of two fragments with equal keys is better.

use crate::vocabulary::{Fact, Order, Parameter, Row, Takes};

pub(crate) fn rows() -> Vec<Row> {
    vec![
        Row {
            order: Some(Order::Payload),
            ..Row::new(
                "ties",
                "payload",
                "the one with lesser packed words: the result does not depend on any order",
                "",
            )
        },
        Row {
            order: Some(Order::Attribute),
            parameters: vec![Parameter {
                name: "by".into(),
                constant: "TIES_BY".into(),
                takes: Takes::Attribute,
                default: "0".into(),
                range: (0, u32::MAX),
                summary: "the attribute that decides, by its packed words; the first if nothing is said".into(),
            }],
            ..Row::new(
                "ties",
                "attribute",
                "the one whose attribute has lesser words, then as `payload`: `attribute { by: id }`",
                "",
            )
        },
        Row {
            order: Some(Order::Submission),
            requires: vec![Fact::OrderedCritical, Fact::KeepsArrival, Fact::StableSort],
            ..Row::new("ties", "submission", "the one that was submitted first", "")
        },
        Row { order: Some(Order::Unordered), ..Row::new("ties", "unordered", "whichever came first", "") },
    ]
}
