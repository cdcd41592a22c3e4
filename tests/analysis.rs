//! Tests of the analysis for editors: the same diagnostics as the command line, fixes that work, and an answer for every text and offset.

use std::path::{Path, PathBuf};

use fragbuf::analysis::{Completion, CompletionKind, Definition, Document, Found};
use fragbuf::load::{Description, load};
use fragbuf::{Diagnostic, Registry};

use crate::diagnostics::CASES;

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// Returns the descriptions in a folder, by their paths.
pub fn descriptions(folder: &str) -> Vec<(String, String)> {
    let entries = std::fs::read_dir(root().join(folder)).unwrap().map(|entry| entry.unwrap().path());
    let mut paths: Vec<PathBuf> =
        entries.filter(|path| path.extension().is_some_and(|extension| extension == "fragbuf")).collect();
    paths.sort();
    assert!(!paths.is_empty(), "{folder}");
    paths.iter().map(|path| (path.display().to_string(), std::fs::read_to_string(path).unwrap())).collect()
}

/// Every text of the tests that has diagnostics.
fn corpus() -> Vec<(String, String)> {
    let of_rules = CASES.iter().map(|(text, _)| ("case.fragbuf".to_owned(), (*text).to_owned()));
    of_rules.chain(descriptions("dsl/syntax/tests/bad")).collect()
}

/// Returns the text without `@`, and its place.
fn at(text: &str) -> (String, usize) {
    (text.replacen('@', "", 1), text.find('@').unwrap())
}

fn complete(text: &str) -> Vec<Completion> {
    let (text, offset) = at(text);
    Document::new(&text, "case.fragbuf", &Registry::builtin()).completion(offset)
}

fn labels(text: &str) -> Vec<String> {
    complete(text).into_iter().map(|completion| completion.label).collect()
}

fn hover(text: &str) -> String {
    let (text, offset) = at(text);
    let registry = Registry::builtin();
    let hover = Document::new(&text, "case.fragbuf", &registry).hover(offset);
    hover.map_or_else(|| "nothing".to_owned(), |hover| hover.markdown)
}

/// The command line prints the same diagnostics, in the same order, at the same places.
#[test]
fn diagnostics_are_those_of_the_command_line() {
    let registry = Registry::builtin();
    for (file, text) in
        corpus().into_iter().chain(descriptions("examples")).chain(descriptions("examples/user_storage"))
    {
        let document = Document::new(&text, &file, &registry).with_files();
        let found = document.diagnostics_without_fixes();
        let loaded = load(&Description::Text { file: file.clone(), text: text.clone() }, &[], &[], &registry);
        let expected: Vec<Diagnostic> = match &loaded.variant {
            Ok(variant) => variant.warnings.iter().cloned().collect(),
            Err(errors) => errors.iter().cloned().collect(),
        };
        assert_eq!(found.len(), expected.len(), "{file}");
        for (found, expected) in found.iter().zip(&expected) {
            assert_eq!(
                (found.code, &found.message, &found.help),
                (expected.code.name, &expected.message, &expected.help)
            );
            // Spans of the compiler are in characters; the same characters are covered.
            let line = text.split('\n').nth(expected.span.line as usize - 1).unwrap_or("");
            let line = if expected.span.line == 1 { line.trim_start_matches('\u{feff}') } else { line };
            let covered: String =
                line.chars().skip(expected.span.column as usize - 1).take(expected.span.length as usize).collect();
            assert_eq!(text[found.span.bytes.clone()], covered, "{file}: {expected}");
            assert_eq!(found.labels.len(), expected.labels.len());
        }
    }
}

/// A fix is tried: after its edits the diagnostic is gone.
#[test]
fn every_fix_removes_its_diagnostic() {
    let registry = Registry::builtin();
    let (mut with_fixes, mut all, mut without) = (0, 0, Vec::new());
    for (file, text) in corpus() {
        let document = Document::new(&text, &file, &registry);
        let count = |all: &[Found], one: &Found| {
            all.iter().filter(|other| (other.code, &other.message) == (one.code, &one.message)).count()
        };
        let before = document.diagnostics();
        for found in &before {
            all += 1;
            match found.fixes.is_empty() {
                true => without.push(format!("{}: {}; {}", found.code, found.message, found.help)),
                false => with_fixes += 1,
            }
            for fix in &found.fixes {
                let changed = document.with_edits(&fix.edits);
                let after = Document::new(&changed, &file, &registry).diagnostics_without_fixes();
                assert!(count(&after, found) < count(&before, found), "{file}: {found:#?}\n{changed}");
            }
        }
    }
    println!("{with_fixes} of {all} diagnostics have fixes; without:\n{}", without.join("\n"));
    assert!(with_fixes * 2 > all, "{with_fixes} of {all}");
}

#[test]
fn a_fix_is_the_change_that_the_help_names() {
    let registry = Registry::builtin();
    for (text, expected) in [
        ("buffer B from kplus_aray {\n}\n", "buffer B from kplus_array {\n}\n"),
        ("buffer B from ab_ll {\n    srot: insertion;\n}\n", "buffer B from ab_ll {\n    sort: insertion;\n}\n"),
        ("buffer B from kplus_array {\n    keep all;\n}\n", "buffer B from kplus_array {\n    keep 8;\n}\n"),
        ("buffer B from kplus_array {\n    sync: none;\n}\n", "buffer B from kplus_array {\n    sync: spin_lock;\n}\n"),
        // A choice of the technique is a new line.
        (
            "buffer B from kb {\n    keep 8 least |f| f.depth - f.color.w;\n}\n",
            "buffer B from kb {\n    keep 8 least |f| f.depth - f.color.w;\n    sort: insertion;\n}\n",
        ),
        (
            "buffer B from ab_ll {\n    where |f| f.detph < 0.5;\n}\n",
            "buffer B from ab_ll {\n    where |f| f.depth < 0.5;\n}\n",
        ),
        (
            "buffer B from ab_ll {\n    where |f| saturate(f.depth) < 0.5;\n}\n",
            "buffer B from ab_ll {\n    where |f| f.depth.clamp(0.0, 1.0) < 0.5;\n}\n",
        ),
        (
            "buffer B from ab_ll {\n    where |f| f.depth.saturate() < 0.5;\n}\n",
            "buffer B from ab_ll {\n    where |f| f.depth.clamp(0.0, 1.0) < 0.5;\n}\n",
        ),
        (
            "buffer B from ab_ll {\n    sort: insertion\n    keep all;\n}\n",
            "buffer B from ab_ll {\n    sort: insertion;\n    keep all;\n}\n",
        ),
        // Two changes that belong together, and a warning.
        (
            "buffer B from kplus_array {\n    storage: linked_list;\n    sync: slot_counter;\n    keep 6;\n}",
            "buffer B from kplus_array {\n    storage: linked_list;\n    sync: slot_counter;\n    keep all;\n    cull: none;\n}",
        ),
        (
            "buffer B from ab_ll {\n    fragment { color: rgba8, depth: f32, id: u32 }\n}\n",
            "buffer B from ab_ll {\n    fragment { color: rgba8, depth: f32 }\n}\n",
        ),
    ] {
        let document = Document::new(text, "case.fragbuf", &registry);
        let found = document.diagnostics();
        let fixed: Vec<String> =
            found.iter().flat_map(|found| &found.fixes).map(|fix| document.with_edits(&fix.edits)).collect();
        assert!(fixed.iter().any(|fixed| fixed == expected), "{text}\n{found:#?}\n{fixed:#?}");
    }
}

#[test]
fn completion_offers_what_the_grammar_expects() {
    let registry = Registry::builtin();
    assert_eq!(labels("buf@"), ["buffer"]);
    assert_eq!(labels("buffer B @"), ["from"]);
    assert_eq!(labels("buffer B from k@ {\n}").len(), registry.techniques().len());
    let items = labels("buffer B from ab_ll {\n    sort: none;\n    s@\n}");
    assert!(items.contains(&"sync".to_owned()) && items.contains(&"keep".to_owned()), "{items:?}");
    assert!(!items.contains(&"sort".to_owned()) && !items.contains(&"pass".to_owned()), "{items:?}");
    assert_eq!(labels("buffer B {\n    sync: spin_lock { @ };\n}"), ["limit"]);
    assert!(labels("buffer B {\n    fragment { color: @ }\n}").contains(&"rgba8".to_owned()));
    assert!(labels("buffer B {\n    uniform { cut: @").contains(&"vec3".to_owned()));
    assert_eq!(labels("buffer B {\n    keep 8 @"), ["least"]);
    assert_eq!(
        labels("buffer B {\n    fragment { depth: f32, id: u32 }\n    ties: attribute { by: @ };\n}"),
        ["depth", "id"]
    );
    assert!(labels("buffer B { // @\n}").is_empty());
}

/// The reason is the error that the compiler reports for the value.
#[test]
fn illegal_values_are_last_and_have_the_compilers_reason() {
    let found = complete("buffer B from kplus_array {\n    sync: @\n}");
    let registry = Registry::builtin();
    assert_eq!(found.len(), registry.rows_of("sync").count());
    let first_illegal = found.iter().position(|value| value.illegal.is_some()).unwrap();
    assert!(first_illegal > 0 && found[first_illegal..].iter().all(|value| value.illegal.is_some()), "{found:#?}");
    for value in &found {
        assert_eq!(value.kind, CompletionKind::Value);
        let text = format!("buffer B from kplus_array {{\n    sync: {};\n}}", value.label);
        let errors = Document::new(&text, "case.fragbuf", &registry).diagnostics_without_fixes();
        match (&value.illegal, errors.first()) {
            (Some(reason), Some(error)) => assert_eq!(*reason, format!("{}; {}", error.message, error.help)),
            (None, None) => {}
            other => panic!("{}: {other:?}", value.label),
        }
    }
}

#[test]
fn completion_in_a_closure_has_what_is_in_scope() {
    let with = |body: &str| {
        format!(
            "buffer B from ab_ll {{\n    fragment {{ color: rgba8, depth: f32 }}\n    uniform {{ cut: f32 }}\n    fn half(x: f32) -> f32 {{ 0.5 * x }}\n    {body}"
        )
    };
    let has = |body: &str, expected: &[&str], absent: &[&str]| {
        let found = labels(&with(body));
        expected.iter().for_each(|name| assert!(found.contains(&(*name).to_owned()), "{body}: no {name}: {found:?}"));
        absent.iter().for_each(|name| assert!(!found.contains(&(*name).to_owned()), "{body}: {name}"));
    };
    has("where |f, u| f.@ < 0.5;\n}", &["color", "depth"], &["cut", "let"]);
    has("where |f, u| f.de@", &["color", "depth"], &["cut"]);
    has("where |f, u| f.depth < u.@;\n}", &["cut"], &["depth"]);
    has("where |f, u| @;\n}", &["f", "u", "half", "vec3", "if"], &["depth"]);
    has("where |f, u| { let near = f.depth; @", &["near", "f", "let"], &[]);
    has("where |f, u| { let near = f.depth; near.@ < 0.5 };\n}", &["sqrt", "clamp"], &["x", "dot"]);
    has("where |f, u| f.color.@;\n}", &["x", "w", "dot", "truncate"], &["sqrt"]);
    has(
        "resolve |fragments, u| {\n        for f in fragments {\n            let c = f.@\n        }\n    }\n}",
        &["depth"],
        &[],
    );
    has("resolve |fragments, u| { fragments.@", &["len"], &["depth"]);
    has("resolve |fragments, u| { let x: @", &["f32", "Vec3"], &["half"]);
    has("resolve |fragments, u| { Vec3::@", &["splat", "ONE"], &["half"]);
}

#[test]
fn hover_shows_rows_and_types() {
    let text = |line: &str| {
        format!("buffer B from kplus_array {{\n    fragment {{ color: rgba8, depth: f32 }}\n    {line}\n}}")
    };
    for (line, parts) in [
        ("sy@nc: spin_lock;", &["how concurrent fragments", "`interlock`"][..]),
        ("sync: spin@_lock { limit: 9 };", &["lock word per pixel", "limit"]),
        ("sync: spin_lock { lim@it: 9 };", &["16384", "times out"]),
        ("storage: max_@array;", &["K15", "Guarantees", "Memory"]),
        ("where |f| f.dep@th < 0.5;", &["depth: f32", "1 word"]),
        ("where |f| f.color.x.sq@rt() < 0.5;", &["fn sqrt(self: f32) -> f32"]),
        ("where |f| { let near@ = f.color; near.x < 0.5 };", &["near: Vec4"]),
        ("where |f| { let n = 2; let m: u32 = n; @n < m };", &["n: u32"]),
        ("fn half(x: f32) -> f32 { 0.5 * x } where |f| ha@lf(f.depth) < 0.5;", &["fn half(f32) -> f32"]),
        ("where |f| ve@c2(f.depth, 0.0).x < 0.5;", &["fn vec2(f32, f32) -> Vec2"]),
    ] {
        let found = hover(&text(line));
        parts.iter().for_each(|part| assert!(found.contains(part), "{line}: no `{part}` in: {found}"));
    }
    assert!(hover("buffer B from kplus@_array {\n}").contains("max_array"));
    assert!(hover("buffer B from ab_ll {\n    fragment { color: rgb@a8, depth: f32 }\n}").contains("8 bits"));
    assert_eq!(hover("buffer B { // sy@nc: none\n}"), "nothing");
}

#[test]
fn definitions_are_templates_files_and_declarations() {
    let registry = Registry::builtin();
    let find = |text: &str| {
        let (text, offset) = at(text);
        match Document::new(&text, "folder/case.fragbuf", &registry).definition(offset) {
            Some(Definition::Text(span)) => text[span.bytes].to_owned(),
            Some(Definition::File { path }) => path,
            Some(Definition::Template { path, source }) => {
                assert_eq!(source, std::fs::read_to_string(root().join("templates").join(&path)).unwrap());
                path
            }
            None => "nothing".to_owned(),
        }
    };
    assert_eq!(find("buffer B {\n    storage: max_@array;\n}"), "storage/max_array.wgsl");
    assert_eq!(find("buffer B {\n    storage: wgsl(\"a/mi@ne.wgsl\");\n}"), "folder/a/mine.wgsl");
    assert_eq!(find("buffer B {\n    uniform { cut: f32 }\n    where |f, u| f.depth < u.cu@t;\n}"), "cut");
    assert_eq!(find("buffer B {\n    where |f| { let near = f.depth; ne@ar < 0.5 };\n}"), "near");
    assert_eq!(find("buffer B {\n    keep @8;\n}"), "nothing");
}

#[test]
fn an_outline_has_every_item() {
    let registry = Registry::builtin();
    for (file, text) in descriptions("examples") {
        let outline = Document::new(&text, &file, &registry).outline().unwrap();
        assert!(
            text[outline.name_span.bytes.clone()] == *outline.name && outline.detail.starts_with("from "),
            "{file}"
        );
        assert!(!outline.children.is_empty(), "{file}");
        for child in &outline.children {
            let is_inside = child.span.bytes.start <= child.name_span.bytes.start
                && child.name_span.bytes.end <= child.span.bytes.end
                && child.span.bytes.end <= outline.span.bytes.end;
            assert!(is_inside, "{file}: {child:#?}");
        }
    }
}

/// Every value of every axis, with the reason of the compiler, and edits that choose it.
#[test]
fn axes_have_their_values() {
    let registry = Registry::builtin();
    let text = "buffer B from kplus_array {\n    sync: interlock else spin_lock;\n}\n";
    let document = Document::new(text, "case.fragbuf", &registry);
    let axes = document.axes();
    assert_eq!(axes.len(), registry.axes().iter().filter(|axis| axis.chosen).count());
    for axis in &axes {
        for value in &axis.values {
            let changed = document.with_edits(&value.edits);
            assert!(changed.contains(&format!("{}: {};", axis.axis, value.key)), "{changed}");
            let errors = Document::new(&changed, "case.fragbuf", &registry).diagnostics_without_fixes();
            let is_legal = errors.iter().all(|error| error.severity != fragbuf::Severity::Error);
            assert_eq!(is_legal, value.illegal.is_none(), "{}: {}: {errors:#?}", axis.axis, value.key);
        }
    }
    let sync = axes.iter().find(|axis| axis.axis == "sync").unwrap();
    assert_eq!(sync.current, ["interlock", "spin_lock"]);
}

/// A user types a text from its beginning to its end. Every request has an answer for every beginning.
#[test]
fn every_beginning_of_a_text_has_answers() {
    let registry = Registry::builtin();
    for (file, text) in descriptions("examples") {
        for (offset, _) in text.char_indices() {
            let document = Document::new(&text[..offset], &file, &registry);
            document.diagnostics_without_fixes();
            document.hover(offset);
            document.definition(offset);
            document.outline();
            // Trying every value of an axis takes longer.
            if offset % 7 == 0 {
                document.completion(offset);
            }
        }
    }
}

/// The time of an answer grows with the text, and not with its square: this text has a hundred thousand blocks in an unfinished item.
#[test]
fn an_item_of_many_blocks_has_answers() {
    let (registry, text) = (Registry::builtin(), format!("buffer B {{ keep {}", "{}".repeat(100_000)));
    let document = Document::new(&text, "long.fragbuf", &registry);
    document.hover(text.len());
    document.completion(text.len());
    document.diagnostics();
}

/// Texts that no one writes, and offsets that are in no text.
#[test]
fn every_text_and_offset_has_answers() {
    let registry = Registry::builtin();
    let mut state = 0x9e37_79b9_u32;
    let mut random = |most: usize| {
        state ^= state << 13;
        state ^= state >> 17;
        state ^= state << 5;
        state as usize % most.max(1)
    };
    let parts: Vec<&str> = "buffer B from kb { } ( ) [ ] | , ; : :: . .. \" ' /* */ // \n é 𝄞 \u{feff} \\ # keep 8 least |f| f.depth where fn \
        resolve sync spin_lock else limit fragment uniform color rgba8 wgsl(\"a.wgsl\") let for in if 0.5 1e9 -> < \0 \r\n"
        .split(' ')
        .collect();
    for _ in 0..300 {
        let text: String = (0..random(40)).flat_map(|_| [parts[random(parts.len())], [" ", ""][random(2)]]).collect();
        let document = Document::new(&text, "case.fragbuf", &registry);
        let found = document.diagnostics();
        assert!(found.iter().all(|found| text.get(found.span.bytes.clone()).is_some()), "{text:?}");
        for offset in [random(text.len() + 1), random(text.len() + 1), text.len(), usize::MAX] {
            document.hover(offset);
            document.definition(offset);
            let valid = |completion: &Completion| text.get(completion.edit.span.bytes.clone()).is_some();
            assert!(document.completion(offset).iter().all(valid), "{text:?}");
        }
        document.outline();
    }
    let long = "a ".repeat(3 << 20);
    let document = Document::new(&long, "case.fragbuf", &registry);
    assert_eq!(document.diagnostics().len(), 1);
    assert!(document.hover(9).is_none() && document.completion(9).is_empty() && document.outline().is_none());
}
