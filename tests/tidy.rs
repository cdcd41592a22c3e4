//! The house is in order: what architecture and documentation promise about the files themselves.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use fragbuf::Registry;

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// Files under `folder` with this extension; build folders and snapshots apart.
fn files(folder: &str, extension: &str) -> Vec<PathBuf> {
    let mut found = Vec::new();
    let mut waiting = vec![root().join(folder)];
    while let Some(path) = waiting.pop() {
        for entry in std::fs::read_dir(&path).unwrap() {
            let path = entry.unwrap().path();
            let name = path.file_name().unwrap().to_string_lossy().into_owned();
            match path.is_dir() {
                true if name != "target" && !name.starts_with('.') => waiting.push(path),
                false if path.extension().is_some_and(|found| found == extension) => found.push(path),
                _ => {}
            }
        }
    }
    found.sort();
    found
}

fn read(path: &Path) -> String {
    std::fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

#[test]
fn every_template_has_a_row_and_is_plain_text() {
    let registry = Registry::builtin();
    let rows = registry.rows().iter().filter_map(|row| row.template.as_ref());
    let known: BTreeSet<&str> = rows.chain(registry.shared()).map(|template| &*template.path).collect();
    for path in files("templates", "wgsl") {
        let name = path.strip_prefix(root().join("templates")).unwrap().to_string_lossy().into_owned();
        let text = read(&path);
        assert!(known.contains(name.as_str()), "{name} has no row");
        assert!(text.is_ascii(), "{name} is not ASCII: shader compilers differ on the rest");
        assert!(text.starts_with("// ") && text.ends_with('\n'), "{name} has no head");
        assert!(
            text.lines().count() <= 200 && text.lines().all(|line| line.chars().count() <= 120),
            "{name} is too long"
        );
    }
}

#[test]
fn every_row_is_in_a_snapshot() {
    let mut seen = String::new();
    for path in files("tests/snapshots", "snap") {
        if path.to_string_lossy().contains(".plan") {
            seen.push_str(&read(&path));
        }
    }
    let registry = Registry::builtin();
    for row in registry.rows().iter().filter(|row| registry.axis(&row.axis).is_some_and(|axis| axis.chosen)) {
        let choice = format!("{}={}", row.axis, row.key);
        assert!(
            seen.contains(&format!("{choice} "))
                || seen.contains(&format!("{choice}\n"))
                || seen.contains(&format!("{choice}[")),
            "no snapshot has {choice}"
        );
    }
}

/// A key compared in code is a special case on a shared mechanism. Words that are also something else are listed.
#[test]
fn no_code_compares_a_key() {
    const ALSO: &[(&str, &str)] = &[
        ("none", "a word of messages"),
        ("all", "the command line's word for every target and every technique"),
        ("closure", "Registry::CLOSURE"),
        ("attribute", "what a payload is made of"),
        ("submission", "an order of the command line"),
        ("fail", "a field of a stencil test in the manifest"),
        ("coverage", "a field of a pass's samples in the manifest"),
        ("one", "a blend factor"),
        ("early", "a field of a depth test in the manifest"),
    ];
    let registry = Registry::builtin();
    let chosen = |axis: &str| registry.axis(axis).is_some_and(|axis| axis.chosen);
    let rows = registry.rows().iter().filter(|row| chosen(&row.axis)).map(|row| row.key.clone());
    let keys: Vec<String> = rows.chain(registry.techniques().iter().map(|technique| technique.key.clone())).collect();
    for folder in ["src", "dsl", "codegen", "backends"] {
        for path in files(folder, "rs") {
            let shown = path.to_string_lossy();
            if shown.contains("/tests/") || shown.contains("/examples/") {
                continue;
            }
            let text = read(&path);
            let code = text.split("#[cfg(test)]").next().unwrap_or("");
            for line in code.lines().filter(|line| !line.trim_start().starts_with("//")) {
                for key in keys.iter().filter(|key| ALSO.iter().all(|(word, _)| word != key)) {
                    assert!(!line.contains(&format!("\"{key}\"")), "{shown} names the row `{key}`: {line}");
                }
            }
        }
    }
}

/// Steps are what rows say; devices, printers and the checker have the lowered frame, which one cursor goes through.
#[test]
fn nothing_behind_a_plan_walks_steps() {
    for folder in ["backends", "src"] {
        for path in
            files(folder, "rs").into_iter().filter(|path| !path.components().any(|part| part.as_os_str() == "tests"))
        {
            assert!(!read(&path).contains("Step::"), "{} has steps in it", path.display());
        }
    }
    let has_table = |path: &PathBuf| read(path).contains("const SYMBOLS");
    let folders = ["templates", "dsl", "codegen", "backends", "src"];
    let tables: Vec<PathBuf> = folders.iter().flat_map(|folder| files(folder, "rs")).filter(has_table).collect();
    assert_eq!(tables.len(), 1, "one table of symbols: {tables:?}");
}

#[test]
fn files_are_short_and_have_heads() {
    for folder in ["src", "dsl", "codegen", "backends", "templates"] {
        for path in files(folder, "rs") {
            let text = read(&path);
            let code = text.split("#[cfg(test)]").next().unwrap_or("").lines().count();
            let is_test = path.to_string_lossy().contains("/tests/");
            assert!(is_test || code <= 400, "{}: {code} lines", path.display());
            assert!(is_test || text.starts_with("//!"), "{} has no head", path.display());
        }
    }
}

/// The README's table of axes is computed from the registry. `INSTA_UPDATE=always` writes it anew.
#[test]
fn the_readme_names_every_value() {
    const HEAD: &str = "| axis | what is chosen | values, the first where nothing else says one |\n";
    let (path, registry) = (root().join("README.md"), Registry::builtin());
    let mut table = format!("{HEAD}|---|---|---|\n");
    for axis in registry.axes().iter().filter(|axis| axis.chosen) {
        let mut keys: Vec<&str> = registry.rows_of(axis.key).map(|row| row.key.as_str()).collect();
        keys.retain(|key| *key != Registry::CLOSURE);
        keys.sort_by_key(|key| axis.default != Some(*key));
        table += &format!("| {} | {} | `{}` |\n", axis.key, axis.summary, keys.join("`, `"));
    }
    let readme = read(&path);
    let start = readme.find(HEAD).expect("README.md has the table of axes");
    let end = start + readme[start..].find("\n\n").expect("an empty line behind the table") + 1;
    if updating() {
        std::fs::write(&path, [&readme[..start], &table, &readme[end..]].concat()).unwrap();
    }
    assert!(read(&path).contains(&table), "README.md is out of date");
}

/// The guide's table of values is what `list --axes` computes. `INSTA_UPDATE=always` writes it anew.
#[test]
fn the_guide_has_every_value_with_what_it_does() {
    let path = root().join("src/guide/axes.md");
    let table = fragbuf(&["list", "--axes"], root());
    if updating() {
        std::fs::write(&path, &table).unwrap();
    }
    assert_eq!(read(&path), table, "{} is out of date", path.display());
}

#[test]
fn words_that_say_nothing_name_nothing() {
    const WORDS: [&str; 5] = ["utils", "util", "helpers_misc", "manager", "types_misc"];
    for folder in ["src", "dsl", "codegen", "backends", "templates", "tests", "examples"] {
        for path in files(folder, "rs") {
            let stem = path.file_stem().unwrap().to_string_lossy().into_owned();
            assert!(!WORDS.contains(&stem.as_str()), "{}", path.display());
        }
    }
}

/// The README's table of techniques is what `list` computes.
#[test]
fn the_readme_has_the_computed_table() {
    let readme = read(&root().join("README.md"));
    let table = fragbuf_table();
    assert!(readme.contains(&table), "put this into README.md:\n{table}");
}

/// Every technique has a page and a picture. The pages follow the rows: `INSTA_UPDATE=always` writes them anew.
#[test]
fn every_technique_has_its_page() {
    let techniques = Registry::builtin().techniques().to_vec();
    for technique in &techniques {
        let path = root().join(format!("examples/techniques/{}.md", technique.key));
        let page = fragbuf(&["show", &technique.key, "--page"], root());
        if updating() {
            std::fs::write(&path, &page).unwrap();
        }
        assert_eq!(read(&path), page, "{} is out of date", path.display());
        assert!(
            root().join(format!("examples/gallery/{}.png", technique.key)).exists(),
            "no picture of {}",
            technique.key
        );
    }
    assert_eq!(files("examples/techniques", "md").len(), techniques.len() + 1, "a page of no technique");
}

/// The paper's table stands beside the pages, with ours as it is computed.
#[test]
fn the_papers_table_has_ours_beside_it() {
    let path = root().join("examples/techniques/table_1.md");
    let table = fragbuf(&["list", "--table-1"], root());
    if updating() {
        std::fs::write(&path, &table).unwrap();
    }
    assert_eq!(read(&path), table, "{} is out of date", path.display());
}

/// The guide's reference of the language is what the type checker's tables say. `INSTA_UPDATE=always` writes it anew.
#[test]
fn the_guide_has_the_computed_reference() {
    let path = root().join("src/guide/language.md");
    let reference = fragbuf(&["language"], root());
    if updating() {
        std::fs::write(&path, &reference).unwrap();
    }
    assert_eq!(read(&path), reference, "{} is out of date", path.display());
}

/// Every description in the guide's chapter on refusals is followed by what the command line says of it.
#[test]
fn the_guide_shows_real_refusals() {
    let path = root().join("src/guide/refusals.md");
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("refusals");
    std::fs::create_dir_all(&folder).unwrap();
    let text = read(&path);
    let mut chapters = text.split("```fragbuf\n");
    let mut expected = chapters.next().unwrap().to_owned();
    for chapter in chapters {
        let (description, rest) = chapter.split_once("```\n").unwrap();
        let (between, rest) = rest.split_once("```text\n").unwrap();
        let (_, after) = rest.split_once("```\n").unwrap();
        std::fs::write(folder.join("glass.fragbuf"), description).unwrap();
        let said = fragbuf(&["show", "glass.fragbuf"], &folder);
        assert!(said.starts_with("error["), "{description} is no mistake: {said}");
        expected += &format!("```fragbuf\n{description}```\n{between}```text\n{}\n```\n{after}", said.trim_end());
    }
    if updating() {
        std::fs::write(&path, &expected).unwrap();
    }
    assert_eq!(read(&path), expected, "{} is out of date", path.display());
}

/// The guide's storage is the example's.
#[test]
fn the_guide_builds_the_example() {
    let guide = read(&root().join("src/guide/extend.md"));
    let example = read(&root().join("examples/own_storage/first_k.wgsl"));
    assert!(example.ends_with(&block(&guide, "wgsl")));
}

fn updating() -> bool {
    std::env::var("INSTA_UPDATE").is_ok_and(|update| update == "always")
}

/// Every block of code in the README is what a person would get.
#[test]
fn the_readme_shows_what_is_generated() {
    let readme = read(&root().join("README.md"));
    let description = read(&root().join("examples/most_visible.fragbuf"));
    assert_eq!(block(&readme, "rust"), description);
    for target in ["wgsl", "glsl"] {
        let shown = fragbuf(&["show", "examples/most_visible.fragbuf", "--dump", target], root());
        assert!(shown.contains(&block(&readme, target)), "{target}");
    }
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR"));
    let glass = "buffer Glass from kplus_array {\n    storage: max_array;\n    sync: none;\n}\n";
    std::fs::write(folder.join("glass.fragbuf"), glass).unwrap();
    assert!(fragbuf(&["show", "glass.fragbuf"], folder).starts_with(&block(&readme, "text")));
}

/// The first block of a language.
fn block(text: &str, language: &str) -> String {
    let start = text.split(&format!("```{language}\n")).nth(1).unwrap();
    start.split("```").next().unwrap().to_owned()
}

/// What the command line says, on either stream.
fn fragbuf(arguments: &[&str], folder: &Path) -> String {
    let output =
        std::process::Command::new(env!("CARGO_BIN_EXE_fragbuf")).args(arguments).current_dir(folder).output().unwrap();
    String::from_utf8([output.stdout, output.stderr].concat()).unwrap()
}

fn fragbuf_table() -> String {
    fragbuf(&["list"], root())
}

#[test]
fn the_dsl_builds_without_naga_and_wgpu() {
    let language = ["fragbuf-syntax", "fragbuf-expansion", "fragbuf-macros", "fragbuf-dsl"];
    for package in ["fragbuf-templates", "fragbuf-model"].into_iter().chain(language) {
        let tree = tree(&["--edges", "all", "-p", package]);
        assert!(!tree.contains("naga") && !tree.contains("wgpu"), "{package}:\n{tree}");
    }
}

/// Pictures on the CPU device need no wgpu either.
#[test]
fn drawing_needs_no_wgpu() {
    let features = ["--no-default-features", "--features", "pictures"];
    let tree = tree(&[&["--edges", "normal", "-p", "fragbuf"], &features[..]].concat());
    assert!(tree.contains("fragbuf-cpu") && !tree.contains("wgpu"), "{tree}");
}

/// Without the feature `pictures` the facade generates, and knows no device.
#[test]
fn generating_needs_no_wgpu() {
    let tree = tree(&["--edges", "normal", "-p", "fragbuf", "--no-default-features"]);
    assert!(tree.contains("naga") && !tree.contains("wgpu"), "{tree}");
    // Snapshots are taken by the caller's own insta.
    assert!(!tree.contains("insta"), "{tree}");
}

fn tree(arguments: &[&str]) -> String {
    let output = std::process::Command::new(env!("CARGO"))
        .args([&["tree", "--offline"], arguments].concat())
        .current_dir(root())
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap()
}
