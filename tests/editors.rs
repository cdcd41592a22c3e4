//! Tokenises descriptions with the TextMate grammar and VS Code's tokeniser, and compares the colours with the compiler's lists of words.

use std::collections::BTreeSet;
use std::io::Write as _;
use std::path::Path;
use std::process::{Command, Stdio};

use fragbuf::Registry;
use fragbuf_model::{Format, UniformType};
use fragbuf_syntax::{ITEMS, STATEMENTS};
use serde_json::Value;

use crate::analysis::descriptions;

/// A token: its text, and its scopes.
type Token = (String, Vec<String>);

fn tokenised(texts: &[String]) -> Vec<Vec<Token>> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/editors");
    let is_installed = folder.join("node_modules/vscode-textmate").exists();
    assert!(is_installed, "the tokeniser must be installed: run `npm ci` in tests/editors (see README)");
    let mut command = Command::new("node");
    let child = command.arg("tokenise.mjs").current_dir(folder).stdin(Stdio::piped()).stdout(Stdio::piped()).spawn();
    let mut child = child
        .unwrap_or_else(|error| panic!("Node must be installed, Debian's package is `nodejs` (see README): {error}"));
    child.stdin.take().unwrap().write_all(&serde_json::to_vec(texts).unwrap()).unwrap();
    let output = child.wait_with_output().unwrap();
    assert!(output.status.success(), "tests/editors/tokenise.mjs failed: {}", output.status);
    let found: Vec<Vec<(usize, usize, Vec<String>)>> = serde_json::from_slice(&output.stdout).unwrap();
    let tokens = texts.iter().zip(found).map(|(text, tokens)| {
        let units: Vec<u16> = text.encode_utf16().collect();
        let token = |(start, length, scopes): (usize, usize, Vec<String>)| {
            (String::from_utf16_lossy(&units[start..start + length]).trim().to_owned(), scopes)
        };
        tokens.into_iter().map(token).collect()
    });
    tokens.collect()
}

/// Returns the innermost scope.
fn scope((_, scopes): &Token) -> &str {
    scopes.last().map_or("", String::as_str)
}

#[test]
fn every_word_of_a_description_has_a_colour() {
    let mut texts: Vec<String> = ["examples", "examples/user_storage", "dsl/syntax/tests/good"]
        .iter()
        .flat_map(|folder| descriptions(folder))
        .map(|(_, text)| text)
        .collect();
    for chapter in ["describe.md", "extend.md", "peeling.md"] {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("src/guide").join(chapter);
        let text = std::fs::read_to_string(path).unwrap();
        let blocks = text.split("```fragbuf\n").skip(1).filter_map(|block| block.split("```").next());
        texts.extend(blocks.map(str::to_owned));
    }
    let registry = Registry::builtin();
    let formats = Format::ALL.map(Format::keyword).into_iter().chain(UniformType::ALL.map(UniformType::keyword));
    let formats: BTreeSet<&str> = formats.collect();
    let (mut words, mut seen) = (0, BTreeSet::new());
    for (text, tokens) in texts.iter().zip(tokenised(&texts)) {
        for (index, token) in tokens.iter().enumerate() {
            let (word, scope) = (token.0.as_str(), scope(token));
            let is_word = word.starts_with(|first: char| first.is_alphabetic() || first == '_');
            if !is_word || scope.starts_with("comment") || scope.starts_with("string") {
                continue;
            }
            words += 1;
            assert!(!scope.starts_with("meta") && scope != "source.fragbuf", "`{word}` has no colour in:\n{text}");
            let next = tokens.get(index + 1).map_or("", |(next, _)| next.as_str());
            let is_axis = registry.axis(word).is_some_and(|axis| axis.chosen);
            if scope.starts_with("variable.language.axis") {
                assert!(next == ":", "`{word}` is no axis in:\n{text}");
                seen.insert("axis");
            } else if is_axis && next == ":" {
                let is_declared = scope.starts_with("variable.");
                assert!(is_declared, "the axis `{word}` is {scope} in:\n{text}");
            }
            if scope.starts_with("storage.type") && formats.contains(word) {
                seen.insert("format");
            }
            if scope.starts_with("entity.other.inherited-class") {
                assert!(registry.technique(word).is_some(), "`{word}` is no technique in:\n{text}");
                seen.insert("technique");
            }
        }
    }
    assert!(words > 2000, "{words}");
    assert_eq!(seen.into_iter().collect::<Vec<_>>(), ["axis", "format", "technique"]);
}

/// Each word of the language has the colour of a word of the language.
#[test]
fn keywords_of_the_compiler_are_keywords_of_the_grammar() {
    let items = ["fragment { depth: f32 }", "uniform { cut: f32 }", "keep 8 least |f| f.depth;", "keep all;"];
    let more =
        ["where |f| true;", "resolve |f| { f }", "fn half(x: f32) -> f32 { x }", "sync: interlock else spin_lock;"];
    let lookups = ["texture { lut: 2d }", "image near |f| f[0].color;", "between |front, back, gap| front.color;"];
    let statements = "resolve |fragments, u| { let mut x = 0; for f in fragments { if true { break; } else { continue; } } return x; }";
    let texts: Vec<String> = items
        .iter()
        .chain(&more)
        .chain(&lookups)
        .chain(&[statements, "storage: wgsl(\"a.wgsl\");", "where |f| false;"])
        .map(|item| format!("buffer B from kb {{\n    {item}\n}}"))
        .collect();
    let found = tokenised(&texts);
    let is_keyword = |word: &str| {
        let is = |token: &Token| {
            token.0 == word && ["keyword.", "constant.language"].iter().any(|start| scope(token).starts_with(start))
        };
        found.iter().flatten().any(is)
    };
    let words = ITEMS.iter().chain(&STATEMENTS).chain(&fragbuf_syntax::KEYWORDS);
    for word in words.flat_map(|words| words.split(' ')) {
        assert!(is_keyword(word), "`{word}` is no keyword of the grammar");
    }
}

/// The grammar and the extension are data: they name what exists.
#[test]
fn the_extension_names_the_server() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/editors/vscode");
    let read = |name: &str| std::fs::read_to_string(folder.join(name)).unwrap();
    let package: Value = serde_json::from_str(&read("package.json")).unwrap();
    let _: Value = serde_json::from_str(&read("language-configuration.json")).unwrap();
    assert_eq!(package["version"], env!("CARGO_PKG_VERSION"));
    assert_eq!(package["contributes"]["grammars"][0]["scopeName"], "source.fragbuf");
    assert!(read("extension.js").contains("args: [\"lsp\"]"));
}
