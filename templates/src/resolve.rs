//! Axis `resolve`: what is made of the kept fragments.

use crate::Registry;
use crate::conditions::color;
use crate::vocabulary::{Fact, Parameter, Row};

pub(crate) fn rows() -> Vec<Row> {
    vec![
        Row {
            template: Some(template!("resolve/over")),
            calls: vec!["samples"],
            requires: vec![Fact::Sorted],
            conditions: vec![color(ADD_COLOR_OR_CLOSURE)],
            parameters: vec![Parameter::number(
                "opaque",
                "OPAQUE_THOUSANDTHS",
                "0",
                (0, 1000),
                "thousandths of the light behind, and of a channel's error: blending ends when fewer pass; 0: never",
            )],
            ..Row::new("resolve", "over", "colours blended front to back", "Porter & Duff 1984; K15 §4.4")
        },
        Row {
            template: Some(template!("resolve/stream")),
            requires: vec![Fact::Streams],
            conditions: vec![color(ADD_COLOR_OR_CLOSURE)],
            offers: vec![Fact::ValuesPairs],
            ..Row::new(
                "resolve",
                "stream",
                "colours blended front to back while they are handed on",
                "B06 §4.3; Porter & Duff 1984",
            )
        },
        Row {
            template: Some(template!("resolve/complexity")),
            calls: vec!["samples"],
            parameters: vec![Parameter::number(
                "most",
                "COMPLEXITY_MOST",
                "capacity",
                (1, 4096),
                "fragments of a pixel from which on it is red",
            )],
            ..Row::new("resolve", "complexity", "how many fragments there are, as a heat map from blue to red", "")
        },
        Row {
            calls: vec!["samples"],
            ..Row::new("resolve", Registry::CLOSURE, "the description's own `resolve |fragments, u| { … }`", "")
        },
    ]
}

/// Effects on colours have a closure in their place.
const ADD_COLOR_OR_CLOSURE: &str = "add `color: rgba8` to the fragment, or write `resolve |fragments, u| { … }`";
