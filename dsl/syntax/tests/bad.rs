//! Every bad description gives exactly the mistakes that its first lines announce, where they say, each with a way out.

#![allow(clippy::expect_used, reason = "a test may stop where it cannot go on")]

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

/// `code line:column`, one for each `// expect: …`.
fn expected(text: &str) -> Vec<String> {
    text.lines().map_while(|line| line.strip_prefix("// expect: ")).map(str::to_string).collect()
}

#[test]
fn every_mistake_is_found_where_it_is() {
    let all = descriptions();
    assert!(all.len() >= 40, "only {} descriptions", all.len());
    let mut wrong = Vec::new();
    for (name, text) in all {
        let parsed = parse(&text, &name);
        let found: Vec<String> = parsed
            .diagnostics
            .iter()
            .map(|found| format!("{} {}:{}", found.code.name, found.origin.line, found.origin.column))
            .collect();
        if found != expected(&text) {
            wrong.push(format!("{name} gives:\n{}\n{}", found.join("\n"), parsed.diagnostics));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n\n"));
}

#[test]
fn every_mistake_has_a_way_out() {
    for (name, text) in descriptions() {
        for found in &parse(&text, &name).diagnostics {
            assert!(found.hint.len() > 5, "{found}");
            assert!(found.message.len() > 5, "{found}");
            let line = text.lines().nth(found.origin.line as usize - 1).unwrap_or_default();
            let end = found.origin.column + found.origin.length - 1;
            assert!(end as usize <= line.chars().count().max(1), "beyond the line: {found}");
        }
    }
}

#[test]
fn every_code_of_text_and_closures_is_met() {
    let met: BTreeSet<String> = descriptions()
        .iter()
        .flat_map(|(_, text)| expected(text))
        .filter_map(|line| line.split(' ').next().map(str::to_string))
        .collect();
    let ours = codes::ALL.iter().map(|code| code.name).take_while(|name| *name != codes::MISSING_FILE.name);
    let missing: Vec<&str> = ours.filter(|name| !met.contains(*name)).collect();
    assert!(missing.is_empty(), "no bad description for {missing:?}");
}

#[test]
fn a_draft_survives_its_mistakes() {
    let text = "buffer B { fragment { depth: f32, id: u33 } keep 8 least |f| f.deep; where |f| f.depth > 0.0; }";
    let parsed = parse(text, "b");
    assert_eq!(parsed.diagnostics.iter().count(), 2, "{}", parsed.diagnostics);
    let draft = parsed.draft.expect("best effort");
    assert_eq!(draft.attributes.len(), 1);
    assert!(draft.keep.is_some_and(|keep| keep.criterion.is_none()));
    assert_eq!(draft.constraints.len(), 1);
}
