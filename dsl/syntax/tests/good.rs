//! Every good description parses without an error and is lowered to the WGSL next to it.
//!
//! `good/NAME.wgsl` is the WGSL that a person would write for `good/NAME.fragbuf`: helpers, criterion, constraints and
//! resolve, in this order, with an empty line between.

#![allow(clippy::expect_used, reason = "a test fails by panicking")]

use std::fs;
use std::path::{Path, PathBuf};

use fragbuf_model::{Draft, KeepCount, OptionValue, UserFunction};
use fragbuf_syntax::parse;

fn directory() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/good")
}

fn descriptions() -> Vec<PathBuf> {
    let mut paths: Vec<PathBuf> =
        fs::read_dir(directory()).expect("good/ is there").map(|entry| entry.expect("readable").path()).collect();
    paths.retain(|path| path.extension().is_some_and(|extension| extension == "fragbuf"));
    paths.sort();
    paths
}

fn draft(name: &str) -> Draft {
    let path = directory().join(name).with_extension("fragbuf");
    let source = fs::read_to_string(&path).expect("readable");
    let parsed = parse(&source, name);
    assert!(parsed.diagnostics.is_empty(), "{name}:\n{}", parsed.diagnostics);
    parsed.draft.expect("a draft")
}

fn functions(draft: &Draft) -> Vec<&UserFunction> {
    let criterion = draft.keep.as_ref().and_then(|keep| keep.criterion.as_ref());
    let images = draft.images.iter().map(|image| &image.function);
    let functions = draft.helpers.iter().chain(criterion).chain(&draft.constraints).chain(images);
    functions.chain(&draft.between).chain(&draft.resolve).collect()
}

#[test]
fn every_description_is_lowered_to_the_expected_wgsl() {
    let paths = descriptions();
    assert!(paths.len() >= 25, "only {} descriptions", paths.len());
    let mut wrong = Vec::new();
    for path in paths {
        let name = path.file_stem().expect("a name").to_string_lossy().into_owned();
        let draft = draft(&name);
        let wgsl: Vec<&str> = functions(&draft).into_iter().map(|function| function.wgsl.as_str()).collect();
        let expected = fs::read_to_string(path.with_extension("wgsl")).unwrap_or_default();
        if wgsl.join("\n") != expected {
            wrong.push(format!("{name} gives:\n{}", wgsl.join("\n")));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n\n"));
}

#[test]
fn every_line_has_a_span() {
    for path in descriptions() {
        let name = path.file_stem().expect("a name").to_string_lossy().into_owned();
        let source = fs::read_to_string(&path).expect("readable");
        for function in functions(&draft(&name)) {
            assert!(function.wgsl.ends_with("}\n"), "{name}: {}", function.wgsl);
            assert_eq!(function.wgsl.lines().count(), function.lines.len(), "{name}: {}", function.name);
            for span in &function.lines {
                let line = source.lines().nth(span.line as usize - 1).expect("the line exists");
                let end = span.column + span.length - 1;
                assert!(end as usize <= line.chars().count(), "{name}: {span} ends after its line");
            }
        }
    }
}

#[test]
fn spans_of_glass() {
    let draft = draft("glass");
    let resolve = draft.resolve.expect("a resolve function");
    let spans: Vec<(u32, u32)> = resolve.lines.iter().map(|span| (span.line, span.column)).collect();
    let expected =
        [(13, 13), (14, 9), (15, 9), (16, 9), (16, 9), (17, 13), (18, 13), (19, 13), (20, 9), (21, 9), (22, 5)];
    assert_eq!(spans, expected, "{}", resolve.wgsl);
}

#[test]
fn glass_as_a_draft() {
    let draft = draft("glass");
    assert_eq!(draft.name.value, "Glass");
    assert_eq!(draft.preset.map(|preset| preset.value).as_deref(), Some("kplus_array"));
    let attributes: Vec<_> =
        draft.attributes.iter().map(|row| (row.name.value.as_str(), row.format.value.keyword())).collect();
    let expected =
        [("color", "rgba8"), ("depth", "f32"), ("id", "u32"), ("normal", "octahedral"), ("velocity", "vec3")];
    assert_eq!(attributes, expected);
    let uniforms: Vec<_> =
        draft.uniforms.iter().map(|row| (row.name.value.as_str(), row.kind.value.keyword())).collect();
    assert_eq!(uniforms, [("cut", "f32"), ("eye", "vec3"), ("steps", "u32")]);
    let keep = draft.keep.expect("a keep");
    assert_eq!(keep.count.value, KeepCount::AtMost(8));
    assert_eq!(keep.criterion.expect("a criterion").rust, "| f | f . depth - 0.25 * f . color . w");
    assert_eq!(draft.constraints.len(), 2);
    assert_eq!(draft.choices.len(), 2);
}

#[test]
fn choices_as_written() {
    let draft = draft("choices");
    let axes: Vec<&str> = draft.choices.iter().map(|choice| choice.axis.value.as_str()).collect();
    assert_eq!(axes, ["storage", "sync", "ties", "resolve"]);
    let sync = &draft.choices[1].alternatives;
    let values: Vec<&str> = sync.iter().map(|alternative| alternative.value.value.as_str()).collect();
    assert_eq!(values, ["interlock", "spin_lock", "none"]);
    let options: Vec<_> =
        sync[1].options.iter().map(|(name, value)| (name.value.as_str(), value.value.clone())).collect();
    assert_eq!(options, [("limit", OptionValue::Number(4096)), ("order", OptionValue::Name("front".to_string()))]);
    assert_eq!((sync[1].value.span.line, sync[1].value.span.column, sync[1].value.span.length), (4, 26, 9));
}

#[test]
fn the_default_payload_is_not_in_the_draft() {
    let draft = draft("default_payload");
    assert!(draft.attributes.is_empty());
    let reads = draft.keep.and_then(|keep| keep.criterion).expect("a criterion").reads;
    assert_eq!(reads.attributes, ["depth", "color"]);
}

#[test]
fn reads_include_those_of_helpers() {
    let draft = draft("helpers");
    let criterion = draft.keep.and_then(|keep| keep.criterion).expect("a criterion");
    assert_eq!(criterion.reads.attributes, ["depth", "color"]);
    assert_eq!(criterion.reads.uniforms, ["cut", "gain"]);
    assert_eq!(draft.constraints[1].reads.attributes, Vec::<String>::new());
    assert_eq!(draft.constraints[1].reads.uniforms, ["gain"]);
    assert_eq!(draft.helpers[2].reads, fragbuf_model::Reads::default());
}

#[test]
fn equal_tokens_give_equal_drafts() {
    let spread = "buffer A { keep 2 least |f| f . depth\n *\n 2.0 ; }";
    let dense = "buffer A{keep 2 least|f|f.depth*2.0;}";
    assert_eq!(parse(spread, "a").draft, parse(dense, "b").draft);
}
