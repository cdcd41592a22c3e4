//! The name that stands for what a user is typing has its meaning in an editor alone: in a text it is a name like others.

#![allow(clippy::panic, reason = "a test fails by panicking")]

use fragbuf_model::codes;
use fragbuf_syntax::{PLACEHOLDER, inspect, parse};

#[test]
fn a_text_with_the_name_has_errors() {
    let name = format!("{PLACEHOLDER}_x");
    for item in [
        format!("keep 4 least |f| {name};"),
        format!("keep 4 least |f| {name}(f.depth);"),
        format!("keep 4 least |f| f.{name};"),
        format!("keep 4 least |f| f.depth.{name}();"),
        format!("keep 4 least |f| f32::{name};"),
        format!("keep 4 least |f| f32::{name}(1.0);"),
        format!("fn a(x: {name}) -> f32 {{ 1.0 }}"),
    ] {
        let text = format!("buffer Mine from kb {{ {item} }}");
        let diagnostics = parse(&text, "test.fragbuf").diagnostics;
        assert!(diagnostics.iter().any(|error| error.message.contains(PLACEHOLDER)), "{text}: {diagnostics}");
        // An editor asks what can be in its place.
        assert!(
            inspect(&text, "test.fragbuf").parsed.diagnostics.iter().all(|error| error.code != codes::UNKNOWN_NAME)
        );
    }
}
