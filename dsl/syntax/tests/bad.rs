//! Every bad description gives exactly the errors that its first lines list, at the listed positions, each with help.

#![allow(clippy::expect_used, reason = "a test fails by panicking")]

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

use fragbuf_model::codes;
use fragbuf_syntax::parse;

fn descriptions() -> Vec<(String, String)> {
    let directory = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/bad");
    let mut paths: Vec<PathBuf> =
        fs::read_dir(directory).expect("bad/ is there").map(|entry| entry.expect("readable").path()).collect();
    paths.sort();
    let name = |path: &Path| path.file_stem().expect("a name").to_string_lossy().into_owned();
    paths.iter().map(|path| (name(path), fs::read_to_string(path).expect("readable"))).collect()
}

/// Returns `code line:column` of each `// expect: …`.
fn expected(source: &str) -> Vec<String> {
    source.lines().map_while(|line| line.strip_prefix("// expect: ")).map(str::to_string).collect()
}

#[test]
fn every_error_is_at_its_position() {
    let all = descriptions();
    assert!(all.len() >= 40, "only {} descriptions", all.len());
    let mut wrong = Vec::new();
    for (name, source) in all {
        let parsed = parse(&source, &name);
        let found: Vec<String> = parsed
            .diagnostics
            .iter()
            .map(|found| format!("{} {}:{}", found.code.name, found.span.line, found.span.column))
            .collect();
        if found != expected(&source) {
            wrong.push(format!("{name} gives:\n{}\n{}", found.join("\n"), parsed.diagnostics));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n\n"));
}

#[test]
fn every_error_has_help() {
    for (name, source) in descriptions() {
        for found in &parse(&source, &name).diagnostics {
            assert!(found.help.len() > 5, "{found}");
            assert!(found.message.len() > 5, "{found}");
            let line = source.lines().nth(found.span.line as usize - 1).unwrap_or_default();
            let end = found.span.column + found.span.length - 1;
            assert!(end as usize <= line.chars().count().max(1), "beyond the line: {found}");
        }
    }
}

#[test]
fn every_code_of_source_and_closures_occurs() {
    let found: BTreeSet<String> = descriptions()
        .iter()
        .flat_map(|(_, source)| expected(source))
        .filter_map(|line| line.split(' ').next().map(str::to_string))
        .collect();
    let codes = codes::ALL.iter().map(|code| code.name).take_while(|name| *name != codes::MISSING_FILE.name);
    let missing: Vec<&str> = codes.filter(|name| !found.contains(*name)).collect();
    assert!(missing.is_empty(), "no bad description for {missing:?}");
}

#[test]
fn a_description_with_errors_has_a_draft() {
    let source = "buffer B { fragment { depth: f32, id: u33 } keep 8 least |f| f.deep; where |f| f.depth > 0.0; }";
    let parsed = parse(source, "b");
    assert_eq!(parsed.diagnostics.iter().count(), 2, "{}", parsed.diagnostics);
    let draft = parsed.draft.expect("a draft");
    assert_eq!(draft.attributes.len(), 1);
    assert!(draft.keep.is_some_and(|keep| keep.criterion.is_none()));
    assert_eq!(draft.constraints.len(), 1);
}
