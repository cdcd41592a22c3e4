//! Compares the printed GLSL with expected texts that are written by hand.
#![allow(clippy::unwrap_used, clippy::panic)]

mod comments;
mod control_flow;
mod evaluation_order;
mod interface;
#[path = "../support/mod.rs"]
mod support;

use fragbuf_glsl::{Dialect, Unit};
use support::{ALL, accept, function, print};

const DATA: &str = "
@group(0) @binding(0) var<storage, read_write> a: array<u32>;
@group(0) @binding(1) var<storage, read_write> locks: array<atomic<u32>>;
const LIMIT: u32 = 64u;
fn memory_fence() {}
fn is_helper_lane() -> bool { return false; }
fn bump(i: u32) -> u32 { a[i] += 1u; return a[i]; }
fn read(i: u32) -> u32 { return a[i]; }
";

/// Compares a printed function with the expected text in the OpenGL dialect, and validates the library in every dialect.
#[track_caller]
fn expect(name: &str, wgsl: &str, expected: &str) {
    let source = format!("{DATA}{wgsl}");
    for dialect in ALL {
        let text = print(&source, Unit::Library, dialect).unwrap_or_else(|errors| panic!("{errors:?}"));
        let version = match dialect {
            Dialect::Es310 => "#version 310 es\nprecision highp float;",
            _ => "#version 450",
        };
        let whole = format!("{version}\n{text}\nvoid main() {{}}\n");
        accept(&whole, &format!("golden_{name}"), "frag", dialect).unwrap_or_else(|message| panic!("{message}"));
    }
    let text = print(&source, Unit::Library, Dialect::OpenGl450).unwrap();
    assert_eq!(function(&text, name), expected.trim_start_matches('\n'), "\n{text}");
}
