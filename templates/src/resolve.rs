//! Axis `resolve`: what is made of the kept fragments.

use crate::Registry;
use crate::vocabulary::{Fact, Row};

pub(crate) fn rows() -> Vec<Row> {
    vec![
        Row {
            template: Some(template!("resolve/over")),
            requires: vec![Fact::Sorted, Fact::Color],
            ..Row::new("resolve", "over", "colours blended front to back", "Porter & Duff 1984")
        },
        Row {
            template: Some(template!("resolve/stream")),
            requires: vec![Fact::Streams, Fact::Color],
            offers: vec![Fact::ValuesPairs],
            ..Row::new(
                "resolve",
                "stream",
                "colours blended front to back while they are handed on",
                "B06 §4.3; Porter & Duff 1984",
            )
        },
        Row::new("resolve", Registry::CLOSURE, "the description's own `resolve |fragments, u| { … }`", ""),
    ]
}
