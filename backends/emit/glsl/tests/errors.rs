//! Tests that unprintable parts are reported together, with spans, and that reserved GLSL names are never printed.
#![allow(clippy::unwrap_used, clippy::panic)]

mod support;

use fragbuf_glsl::{Dialect, Unit};
use support::{ALL, accept, print};

/// Tests that every dialect reports the expected messages.
#[track_caller]
fn expect_errors(source: &str, expected: &[&str]) {
    for dialect in ALL {
        let errors = print(source, Unit::EntryPoint("main"), dialect).unwrap_err();
        for message in expected {
            assert!(errors.iter().any(|error| error.message.contains(message)), "no `{message}` in {errors:?}");
        }
    }
}

#[test]
fn wide_integers() {
    expect_errors(
        "@group(0) @binding(0) var<storage, read_write> a: array<i64>;
        @group(0) @binding(1) var<storage, read_write> b: atomic<i64>;
        @group(0) @binding(2) var<storage, read_write> c: array<u64>;
        @compute @workgroup_size(1) fn main() {
            a[0] = a[1] + 1li;
            atomicMax(&b, 3li);
            c[0] = c[1] / c[2];
            c[3] = u64(f32(c[4]));
            c[5] = countOneBits(c[6]);
        }",
        &["i64 values", "atomics of this type", "a division of u64", "between u64", "CountOneBits of u64"],
    );
}

#[test]
fn overrides() {
    expect_errors(
        "override size: u32 = 3u;
        @group(0) @binding(0) var<storage, read_write> a: array<u32>;
        @compute @workgroup_size(1) fn main() { a[0] = size; }",
        &["an override"],
    );
}

#[test]
fn layouts_that_differ() {
    expect_errors(
        "struct Padded { @size(16) a: u32, b: u32 }
        @group(0) @binding(0) var<storage, read_write> padded: Padded;
        @compute @workgroup_size(1) fn main() { padded.a = padded.b; }",
        &["`b` at byte 16 where GLSL has byte 4"],
    );
}

#[test]
fn unknown_entry_point() {
    expect_errors("@compute @workgroup_size(1) fn other() {}", &["no entry point `main`"]);
}

#[test]
fn critical_sections_below_the_top_level() {
    expect_errors(
        "fn critical_begin() {}
        fn critical_end() {}
        fn inner() { critical_begin(); critical_end(); }
        @fragment fn main() { inner(); }",
        &["critical section outside the top level"],
    );
}

#[test]
fn whole_compare_exchange_results() {
    expect_errors(
        "@group(0) @binding(0) var<storage, read_write> a: atomic<u32>;
        @compute @workgroup_size(1) fn main() {
            var r = atomicCompareExchangeWeak(&a, 0u, 1u);
            atomicStore(&a, r.old_value);
        }",
        &["compare-exchange as a whole"],
    );
}

#[test]
fn errors_have_spans() {
    let source = "@group(0) @binding(0) var<storage, read_write> a: array<i64>;
        @compute @workgroup_size(1) fn main() { a[0] = a[1]; }";
    let errors = print(source, Unit::EntryPoint("main"), Dialect::Vulkan450).unwrap_err();
    assert!(errors.iter().any(|error| error.span.is_defined()), "{errors:?}");
}

#[test]
fn reserved_names_are_accepted_as_wgsl_names() {
    let names = include_str!("glsl_reserved.txt").split_whitespace();
    let usable: Vec<&str> =
        names.filter(|name| !naga::keywords::wgsl::RESERVED.contains(name) && !name.starts_with("gl_")).collect();
    let lets: String = usable.iter().map(|name| format!("    let {name} = a[0];\n    a[1] = {name};\n")).collect();
    let source = format!(
        "@group(0) @binding(0) var<storage, read_write> a: array<u32>;\n@compute @workgroup_size(1) fn entry() {{\n{lets}}}\n"
    );
    for dialect in ALL {
        let text = print(&source, Unit::EntryPoint("entry"), dialect).unwrap_or_else(|errors| panic!("{errors:?}"));
        accept(&text, "reserved_locals", "comp", dialect).unwrap_or_else(|message| panic!("{message}"));
    }
    let fields: String = usable.iter().map(|name| format!("    {name}: u32,\n")).collect();
    let sum: Vec<String> = usable.iter().map(|name| format!("s.{name}")).collect();
    let source = format!(
        "struct S {{\n{fields}}}\n@group(0) @binding(0) var<storage, read_write> s: S;\n@compute @workgroup_size(1) fn entry() {{ s.{} = {}; }}\n",
        usable[0],
        sum.join(" + ")
    );
    for dialect in ALL {
        let text = print(&source, Unit::EntryPoint("entry"), dialect).unwrap_or_else(|errors| panic!("{errors:?}"));
        accept(&text, "reserved_fields", "comp", dialect).unwrap_or_else(|message| panic!("{message}"));
    }
}

#[test]
fn printing_is_deterministic() {
    let source = include_str!("corpus/spin_lock.wgsl");
    let first = print(source, Unit::EntryPoint("store"), Dialect::Vulkan450).unwrap();
    assert!((0..4).all(|_| print(source, Unit::EntryPoint("store"), Dialect::Vulkan450).unwrap() == first));
}
