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
        Row::new("resolve", Registry::CLOSURE, "the description's own `resolve |fragments, u| { … }`", ""),
    ]
}
