//! Runs Tint, Chromium's WGSL compiler, on portable WGSL: browsers must accept it. Results are cached by content and version.

use std::collections::BTreeSet;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use fragbuf::{File, Form, Registry, Request, generate, target};
use fragbuf_model::{Draft, SourceSpan};

use crate::cases::{checked, named};

/// The script that validates sources.
const SCRIPT: &str = include_str!("tint/validate.mjs");
/// The version of Tint.
const LOCK: &str = include_str!("tint/package-lock.json");

/// Returns the number of distinct sources in portable WGSL, and a text for each that Tint rejects.
pub fn rejected(files: &[&File]) -> (usize, Vec<String>) {
    let mut seen = BTreeSet::new();
    let distinct: Vec<&File> =
        files.iter().copied().filter(|file| file.target == "wgsl" && seen.insert(&file.bytes)).collect();
    let unknown: Vec<&File> = distinct.iter().filter(|file| !passed(file).exists()).copied().collect();
    if unknown.is_empty() {
        return (distinct.len(), Vec::new());
    }
    let sources: Vec<String> = unknown.iter().map(|file| String::from_utf8(file.bytes.clone()).unwrap()).collect();
    let mut diagnostics = Vec::new();
    for ((file, source), error) in unknown.iter().zip(&sources).zip(errors(&sources)) {
        match error {
            Some(error) => diagnostics.push(format!("{}: Tint: {error}\n{source}", file.path)),
            None => {
                std::fs::create_dir_all(folder()).unwrap();
                std::fs::write(passed(file), "").unwrap();
            }
        }
    }
    (distinct.len(), diagnostics)
}

fn folder() -> PathBuf {
    Path::new(env!("CARGO_TARGET_TMPDIR")).join("tint")
}

/// Returns the file that exists if the source of `file` is valid.
fn passed(file: &File) -> PathBuf {
    let mut hasher = DefaultHasher::new();
    (SCRIPT, LOCK, &file.bytes).hash(&mut hasher);
    folder().join(format!("{:016x}", hasher.finish()))
}

/// Returns Tint's errors for each source, in one process.
fn errors(sources: &[String]) -> Vec<Option<String>> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/tint");
    let is_installed = folder.join("node_modules/webgpu").exists();
    assert!(is_installed, "Tint must be installed: run `npm ci` in tests/tint (see README)");
    let mut command = Command::new("node");
    let child = command.arg("validate.mjs").current_dir(folder).stdin(Stdio::piped()).stdout(Stdio::piped()).spawn();
    let mut child = child
        .unwrap_or_else(|error| panic!("Node must be installed, Debian's package is `nodejs` (see README): {error}"));
    child.stdin.take().unwrap().write_all(&serde_json::to_vec(sources).unwrap()).unwrap();
    let output = child.wait_with_output().unwrap();
    assert!(output.status.success(), "tests/tint/validate.mjs failed: {}", output.status);
    let errors: Vec<Option<String>> = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(errors.len(), sources.len());
    errors
}

fn assert_valid(files: &[File]) -> usize {
    let (count, diagnostics) = rejected(&files.iter().collect::<Vec<_>>());
    assert!(diagnostics.is_empty(), "{}", diagnostics.join("\n\n"));
    count
}

fn portable<'a>(form: Form, prefix: &'a str, group: u32) -> Request<'a> {
    static WGSL: std::sync::LazyLock<Vec<&'static fragbuf::Target>> =
        std::sync::LazyLock::new(|| vec![target("wgsl").unwrap()]);
    Request { targets: &WGSL, form, prefix, group }
}

/// Returns the files of a technique; none if portable WGSL lacks a feature that it needs.
fn technique(key: &str, request: &Request<'_>) -> Vec<File> {
    let registry = Registry::builtin();
    let draft = Draft::from_technique(key, &SourceSpan::new(key, 1, 1));
    let variant = fragbuf::check(&draft, &registry).unwrap_or_else(|diagnostics| panic!("{diagnostics}"));
    generate(&variant, request, &registry).unwrap_or_else(|diagnostics| panic!("{key}: {diagnostics}")).files
}

#[test]
fn tint_accepts_every_technique_in_both_forms() {
    let registry = Registry::builtin();
    let mut files = Vec::new();
    for form in [Form::Program, Form::Module] {
        for row in registry.techniques() {
            files.extend(technique(&row.key, &portable(form, "", 0)));
            files.extend(technique(&row.key, &portable(form, "near", 1)));
        }
    }
    println!("techniques: {} sources through Tint", assert_valid(&files));
}

#[test]
fn tint_accepts_every_named_case_in_both_forms() {
    let registry = Registry::builtin();
    let mut files = Vec::new();
    for (name, description, set) in named() {
        let variant = checked(&description, &set).unwrap_or_else(|diagnostics| panic!("{name}: {diagnostics}"));
        for form in [Form::Program, Form::Module] {
            let generation = generate(&variant, &portable(form, "", 0), &registry);
            files.extend(generation.unwrap_or_else(|diagnostics| panic!("{name}: {diagnostics}")).files);
        }
    }
    println!("cases: {} sources through Tint", assert_valid(&files));
}

#[test]
fn tint_accepts_two_buffers_in_a_shader() {
    let store = |key: &str, prefix: &str, group: u32| {
        let files = technique(key, &portable(Form::Module, prefix, group));
        let bytes = files.into_iter().find(|file| file.pass == "store").unwrap().bytes;
        String::from_utf8(bytes).unwrap()
    };
    let host = "
        @fragment
        fn shade(@builtin(position) position: vec4<f32>) {
            near_store_fragment(position.xy, near_Fragment(vec4<f32>(1.0), position.z));
            all_store_fragment(position.xy, all_Fragment(vec4<f32>(1.0), position.z));
        }";
    for (near, all) in [("kplus_array", "ab_ll"), ("mdt32_coplanar", "ab_ll"), ("kb_ps", "kb_mha")] {
        let shader = format!("{}{}{host}", store(near, "near", 1), store(all, "all", 2));
        assert_eq!(errors(std::slice::from_ref(&shader)), [None], "{shader}");
    }
}

/// Operators that need parentheses: a validator that accepts them would validate nothing. The others are valid WGSL.
#[test]
fn tint_rejects_mixed_operators_and_unclosed_templates() {
    let sources = [
        "fn f(a: u32, b: u32) -> u32 { return a * b ^ a; }",
        "fn f(a: u32, b: u32) -> bool { return a < b >> 2u; }",
        "fn f(a: u32, b: u32) -> bool { return a < (b >> 2u); }",
        "fn f(a: i32) { switch a { case -1i << 2u, 8: {} default: {} } const_assert -1i << 2u < 0i; }",
    ];
    let rejected: Vec<bool> = errors(&sources.map(str::to_owned)).iter().map(Option::is_some).collect();
    assert_eq!(rejected, [true, true, false, false]);
}

/// What needs parentheses in Tint is an error at its column in user files; what Tint accepts is none.
#[test]
fn user_files_have_the_operators_of_tint() {
    const EXPRESSIONS: [&str; 16] = [
        "cursor * 2u ^ pixel",
        "cursor & 3u | pixel",
        "cursor + 1u & 7u",
        "cursor << 1u + pixel",
        "cursor + pixel << 1u",
        "u32(cursor < pixel >> 2u)",
        "u32(cursor & 1u == 1u)",
        "u32(cursor < pixel && pixel < 9u || cursor == 1u)",
        "min(u32(cursor < pixel), u32(pixel > 1u))",
        "(cursor * 2u) ^ pixel ^ 1u",
        "(cursor & 3u) | pixel",
        "cursor + pixel * 3u - 1u % 2u",
        "u32(cursor << 1u == pixel >> 2u && cursor > 1u)",
        "vec2<u32>(cursor, pixel)[cursor & 1u]",
        "u32(cursor < pixel && pixel < 9u && cursor == 1u)",
        "array<u32, 2>(cursor, ~pixel)[-1i * 0i]",
    ];
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("tint-user-files");
    std::fs::create_dir_all(&folder).unwrap();
    std::fs::write(folder.join("own.fragbuf"), "buffer Own { storage: wgsl(\"mine.wgsl\"); keep 8; }").unwrap();
    let good = include_str!("../examples/user_storage/first_k.wgsl");
    let registry = Registry::builtin();
    let line = good.lines().position(|line| line.contains("slots_load(cursor, pixel)")).unwrap() + 1;
    let line = format!("mine.wgsl:{line}:");
    let sources =
        EXPRESSIONS.map(|expression| format!("fn f(pixel: u32, cursor: u32) -> u32 {{ return {expression}; }}"));
    for (expression, tint) in EXPRESSIONS.iter().zip(errors(&sources)) {
        std::fs::write(
            folder.join("mine.wgsl"),
            good.replace("slots_load(cursor, pixel)", &format!("slots_load({expression}, pixel)")),
        )
        .unwrap();
        let description = fragbuf::load::Description::read(&folder.join("own.fragbuf")).unwrap();
        let variant = fragbuf::load::load(&description, &[], &[], &registry).variant;
        let found = variant.err().map(|found| found.to_string());
        let is_found = found.as_ref().is_some_and(|text| text.contains(&line) && text.contains("invalid-wgsl"));
        assert_eq!(is_found, tint.is_some(), "{expression}: {found:?}, Tint: {tint:?}");
    }
}
