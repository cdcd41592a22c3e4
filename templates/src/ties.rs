//! Axis `ties`: which of two fragments with equal keys is better.

use crate::vocabulary::{Capability, Parameter, ParameterType, Row, TieBreak};

pub(crate) fn rows() -> Vec<Row> {
    vec![
        Row {
            order: Some(TieBreak::Payload),
            provides: vec![Capability::TotalOrder],
            ..Row::new(
                "ties",
                "payload",
                "the one with lesser packed words: the result does not depend on the order of arrival",
                "",
            )
        },
        Row {
            order: Some(TieBreak::Attribute),
            provides: vec![Capability::TotalOrder],
            parameters: vec![Parameter {
                name: "by".into(),
                constant: "TIES_BY".into(),
                kind: ParameterType::Attribute,
                default: "0".into(),
                range: (0, u32::MAX),
                is_retry_limit: false,
                summary: "the attribute that decides, by its packed words [default: the first]".into(),
            }],
            ..Row::new(
                "ties",
                "attribute",
                "the one whose attribute has lesser packed words, then as `payload`: `attribute { by: id }`",
                "",
            )
        },
        Row {
            order: Some(TieBreak::Submission),
            requires: vec![Capability::OrderedMutualExclusion, Capability::KeepsArrival, Capability::StableSort],
            ..Row::new("ties", "submission", "the one that was submitted first", "")
        },
        Row { order: Some(TieBreak::Unordered), ..Row::new("ties", "unordered", "the one that arrived first", "") },
    ]
}
