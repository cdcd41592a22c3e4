//! What cannot be printed comes back as errors, all at once and with a place; and names that GLSL reserves never come out.
#![allow(clippy::unwrap_used, clippy::panic)]

mod support;

use fragbuf_glsl::{Dialect, Unit};
use support::{ALL, accept, print};

#[track_caller]
fn refused(source: &str, expected: &[&str]) {
    for dialect in ALL {
        let errors = print(source, Unit::EntryPoint("main"), dialect).unwrap_err();
        for what in expected {
            assert!(errors.iter().any(|error| error.what.contains(what)), "no `{what}` in {errors:?}");
        }
    }
}

#[test]
fn wide_integers() {
    refused(
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
    refused(
        "override size: u32 = 3u;
        @group(0) @binding(0) var<storage, read_write> a: array<u32>;
        @compute @workgroup_size(1) fn main() { a[0] = size; }",
        &["an override"],
    );
}

#[test]
fn layouts_that_differ() {
    refused(
        "struct Padded { @size(16) a: u32, b: u32 }
        @group(0) @binding(0) var<storage, read_write> padded: Padded;
        @compute @workgroup_size(1) fn main() { padded.a = padded.b; }",
        &["`b` at byte 16 where GLSL has byte 4"],
    );
}

#[test]
fn unknown_entry_point() {
    refused("@compute @workgroup_size(1) fn other() {}", &["no entry point `main`"]);
}

#[test]
fn critical_sections_below_the_top_level() {
    refused(
        "fn critical_begin() {}
        fn critical_end() {}
        fn inner() { critical_begin(); critical_end(); }
        @fragment fn main() { inner(); }",
        &["critical section outside the top level"],
    );
}

#[test]
fn whole_compare_exchange_results() {
    refused(
        "@group(0) @binding(0) var<storage, read_write> a: atomic<u32>;
        @compute @workgroup_size(1) fn main() {
            var r = atomicCompareExchangeWeak(&a, 0u, 1u);
            atomicStore(&a, r.old_value);
        }",
        &["compare-exchange as a whole"],
    );
}

#[test]
fn errors_have_a_place() {
    let source = "@group(0) @binding(0) var<storage, read_write> a: array<i64>;
        @compute @workgroup_size(1) fn main() { a[0] = a[1]; }";
    let errors = print(source, Unit::EntryPoint("main"), Dialect::Vulkan450).unwrap_err();
    assert!(errors.iter().any(|error| error.span.is_defined()), "{errors:?}");
}

#[test]
fn reserved_names_are_accepted_as_wgsl_names() {
    let words = include_str!("glsl_reserved.txt").split_whitespace();
    let usable: Vec<&str> =
        words.filter(|word| !naga::keywords::wgsl::RESERVED.contains(word) && !word.starts_with("gl_")).collect();
    let lets: String = usable.iter().map(|word| format!("    let {word} = a[0];\n    a[1] = {word};\n")).collect();
    let source = format!(
        "@group(0) @binding(0) var<storage, read_write> a: array<u32>;\n@compute @workgroup_size(1) fn entry() {{\n{lets}}}\n"
    );
    for dialect in ALL {
        let text = print(&source, Unit::EntryPoint("entry"), dialect).unwrap_or_else(|errors| panic!("{errors:?}"));
        accept(&text, "reserved_locals", "comp", dialect).unwrap_or_else(|message| panic!("{message}"));
    }
    let fields: String = usable.iter().map(|word| format!("    {word}: u32,\n")).collect();
    let sum: Vec<String> = usable.iter().map(|word| format!("s.{word}")).collect();
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
