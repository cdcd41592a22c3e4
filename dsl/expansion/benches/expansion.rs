//! Measures the macro: parsing, checking and emitting, over `proc_macro2`'s own tokens. In the compiler the tokens come from
//! rustc, and each call costs slightly more. Each figure is the minimum of 300 runs.
#![allow(missing_docs, clippy::unwrap_used, clippy::print_stdout, reason = "a bench prints, and fails by panicking")]

use std::time::{Duration, Instant};

use fragbuf_templates::Registry;
use proc_macro2::TokenStream;

const MINIMAL: &str = "buffer Nearest from kplus_array { keep 4; }";
const MOST_VISIBLE: &str = include_str!("../../../examples/most_visible.fragbuf");

fn minimum(mut work: impl FnMut()) -> Duration {
    let runs = (0..300).map(|_| {
        let start = Instant::now();
        work();
        start.elapsed()
    });
    runs.min().unwrap_or_default()
}

fn main() {
    println!("{:16} {:>8} {:>10} {:>10} {:>10}", "description", "tokens", "parse µs", "rows µs", "expand µs");
    for (name, source) in [("minimal", MINIMAL), ("most_visible", MOST_VISIBLE)] {
        let call: TokenStream = format!("[fragbuf_dsl] {source}").parse().unwrap();
        let parse = minimum(|| drop(fragbuf_syntax::parse(source, name)));
        let rows = minimum(|| drop(Registry::builtin()));
        let expand = minimum(|| drop(fragbuf_expansion::fragment_buffer(call.clone())));
        let tokens = count(&call);
        let [parse, rows, expand] = [parse, rows, expand].map(|time| time.as_micros());
        println!("{name:16} {tokens:>8} {parse:>10} {rows:>10} {expand:>10}");
    }
}

fn count(tokens: &TokenStream) -> usize {
    let inside = |token| match token {
        proc_macro2::TokenTree::Group(group) => 2 + count(&group.stream()),
        _ => 1,
    };
    tokens.clone().into_iter().map(inside).sum()
}
