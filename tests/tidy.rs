//! Tests of the tree itself: what ARCHITECTURE.md and the documentation promise about files.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use fragbuf::{Registry, TIERS};

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// Returns the files under `folder` with this extension, without build folders and bundles of others.
fn files(folder: &str, extension: &str) -> Vec<PathBuf> {
    let mut found = Vec::new();
    let mut waiting = vec![root().join(folder)];
    while let Some(path) = waiting.pop() {
        for entry in std::fs::read_dir(&path).unwrap() {
            let path = entry.unwrap().path();
            let name = path.file_name().unwrap().to_string_lossy().into_owned();
            match path.is_dir() {
                true if !["target", "node_modules", "vendor"].contains(&&*name) && !name.starts_with('.') => {
                    waiting.push(path);
                }
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
        assert!(text.starts_with("// ") && text.ends_with('\n'), "{name} has no header");
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

/// Comparing a key in code would be a special case in a shared mechanism. Strings that are also keys by accident are listed.
#[test]
fn no_code_compares_a_key() {
    const ALSO: &[(&str, &str)] = &[
        ("none", "a string of messages"),
        ("all", "the command line's name of every target and every technique"),
        ("closure", "Registry::CLOSURE"),
        ("attribute", "a part of a payload"),
        ("submission", "an order of the command line"),
        ("fail", "a field of a stencil test in the manifest"),
        ("coverage", "a field of a pass's samples in the manifest"),
        ("one", "a blend factor"),
        ("early", "a field of a depth test in the manifest"),
        ("interlock", "a feature in the manifest"),
        ("layer", "a prefix of generated names"),
        ("described", "a field of a texture in the manifest"),
    ];
    let registry = Registry::builtin();
    let chosen = |axis: &str| registry.axis(axis).is_some_and(|axis| axis.chosen);
    let rows = registry.rows().iter().filter(|row| chosen(&row.axis)).map(|row| row.key.clone());
    let keys: Vec<String> = rows.chain(registry.techniques().iter().map(|technique| technique.key.clone())).collect();
    for folder in ["src", "dsl", "codegen", "backends"] {
        for path in [files(folder, "rs"), files(folder, "mjs")].concat() {
            let shown = path.to_string_lossy();
            // Rows of experiments name techniques as data, and contain no code.
            if shown.contains("/tests/") || shown.contains("/examples/") || shown.contains("/figure/experiments/") {
                continue;
            }
            let text = read(&path);
            let code = text.split("#[cfg(test)]").next().unwrap_or("");
            for line in code.lines().filter(|line| !line.trim_start().starts_with("//")) {
                for key in keys.iter().filter(|key| ALSO.iter().all(|(word, _)| word != key)) {
                    assert!(!line.contains(&format!("\"{key}\"")), "{shown} compares the row `{key}`: {line}");
                }
            }
        }
    }
}

/// The rows of experiments are data: nothing in them decides.
#[test]
fn rows_of_experiments_are_data() {
    for path in files("src/cli/figure/experiments", "rs") {
        let text = read(&path);
        let code = text.lines().filter(|line| !line.trim_start().starts_with("//"));
        for line in code {
            let decides = ["if ", "match ", "==", "!=", ".contains(", "while "].iter().any(|word| line.contains(word));
            assert!(!decides, "{}: {line}", path.display());
        }
    }
}

/// Steps belong to rows. Devices, emitters and the checker use the lowered frame, through one cursor.
#[test]
fn only_plans_use_steps() {
    for folder in ["backends", "src"] {
        for path in
            files(folder, "rs").into_iter().filter(|path| !path.components().any(|part| part.as_os_str() == "tests"))
        {
            let text = read(&path);
            let uses_step = text.match_indices("Step::").any(|(at, _)| !text[..at].ends_with(char::is_alphanumeric));
            assert!(!uses_step, "{} uses steps", path.display());
        }
    }
    let has_table = |path: &PathBuf| read(path).contains("const SYMBOLS");
    let folders = ["templates", "dsl", "codegen", "backends", "src"];
    let tables: Vec<PathBuf> = folders.iter().flat_map(|folder| files(folder, "rs")).filter(has_table).collect();
    assert_eq!(tables.len(), 1, "one table of symbols: {tables:?}");
}

#[test]
fn files_are_short_and_have_headers() {
    for folder in ["src", "dsl", "codegen", "backends", "templates"] {
        for path in files(folder, "rs") {
            let text = read(&path);
            let code = text.split("#[cfg(test)]").next().unwrap_or("").lines().count();
            let is_test = path.to_string_lossy().contains("/tests/");
            assert!(is_test || code <= 400, "{}: {code} lines", path.display());
            assert!(is_test || text.starts_with("//!"), "{} has no header", path.display());
        }
        for path in files(folder, "mjs") {
            let text = read(&path);
            assert!(text.lines().count() <= 400, "{}", path.display());
            assert!(text.starts_with("/**\n * "), "{} has no header", path.display());
        }
    }
}

/// The host for Bevy follows manifests like the others.
#[test]
fn the_host_for_bevy_names_no_technique() {
    let registry = Registry::builtin();
    let sources = files("examples/bevy/src", "rs");
    assert!(sources.len() > 20, "{sources:?}");
    for path in sources {
        let text = read(&path);
        assert!(text.lines().count() <= 400 && text.starts_with("//!"), "{}", path.display());
        for technique in registry.techniques() {
            assert!(!text.contains(&format!("{}\"", technique.key)), "{}: {}", path.display(), technique.key);
            assert!(!text.contains(&format!(" {} {{", technique.key)), "{}: {}", path.display(), technique.key);
        }
    }
}

/// The README names every axis in the order of the registry; the guide describes their values.
#[test]
fn the_readme_names_every_axis() {
    let registry = Registry::builtin();
    let names: Vec<String> =
        registry.axes().iter().filter(|axis| axis.chosen).map(|axis| format!("`{}`", axis.key)).collect();
    let (last, others) = names.split_last().unwrap();
    let sentence = format!("The axes are {} and {last};", others.join(", "));
    let readme: Vec<String> = read(&root().join("README.md")).split_whitespace().map(str::to_owned).collect();
    assert!(readme.join(" ").contains(&sentence), "README.md should contain: {sentence}");
}

/// The guide's table of values is the output of `list --axes`. `INSTA_UPDATE=always` updates it.
#[test]
fn the_guide_has_every_value_with_what_it_does() {
    is_computed("src/guide/axes.md", &["list", "--axes"]);
}

/// Every crate has what its page in a registry shows. Crates above it are dependencies of its tests by path alone, because a version
/// would have to be published first.
#[test]
fn every_crate_can_be_published() {
    let manifests =
        ["templates", "dsl", "codegen", "backends", "examples"].iter().flat_map(|folder| files(folder, "toml"));
    let is_published = |path: &PathBuf| !read(path).contains("\npublish = false\n");
    let crates: Vec<PathBuf> = manifests.filter(|path| path.ends_with("Cargo.toml")).filter(is_published).collect();
    assert_eq!(crates.len(), 19);
    for path in crates.into_iter().chain([root().join("Cargo.toml")]) {
        let text = read(&path);
        let name = text.split("[package]\nname = \"").nth(1).and_then(|rest| rest.split('"').next()).unwrap();
        for field in
            ["description = \"", "license.workspace", "rust-version.workspace", "keywords = [", "categories = ["]
        {
            assert!(text.contains(&format!("\n{field}")), "{name}: {field}");
        }
        assert!(text.contains(&format!("\ndocumentation = \"https://docs.rs/{name}\"\n")), "{name}");
        let tests =
            text.split("\n[dev-dependencies]\n").nth(1).map_or("", |rest| rest.split("\n[").next().unwrap_or(rest));
        let versioned: Vec<&str> =
            tests.lines().filter(|line| line.starts_with("fragbuf") && !line.contains("path")).collect();
        assert!(versioned.is_empty(), "{name}: {versioned:?}");
    }
}

#[test]
fn no_file_has_a_meaningless_name() {
    const WORDS: [&str; 5] = ["utils", "util", "helpers_misc", "manager", "types_misc"];
    for folder in ["src", "dsl", "codegen", "backends", "templates", "tests", "examples"] {
        for path in files(folder, "rs") {
            let stem = path.file_stem().unwrap().to_string_lossy().into_owned();
            assert!(!WORDS.contains(&stem.as_str()), "{}", path.display());
        }
    }
}

/// The README's table of techniques is computed from `list --json`. `INSTA_UPDATE=always` updates it.
#[test]
fn the_readme_has_the_computed_table() {
    const HEAD: &str = "| technique | what a pixel keeps | words per pixel | draws | order-independent | tiers |\n";
    let path = root().join("README.md");
    let _lock = README.lock().unwrap_or_else(PoisonError::into_inner);
    let readme = read(&path);
    let start = readme.find(HEAD).expect("README.md has the table of techniques");
    let end = start + readme[start..].find("\n\n").expect("an empty line after the table") + 1;
    let table = format!("{HEAD}|---|---|---|---|---|---|\n{}", technique_rows());
    if updating() {
        std::fs::write(&path, [&readme[..start], &table, &readme[end..]].concat()).unwrap();
    }
    assert!(updating() || readme[start..end] == table, "README.md should show:\n{table}");
}

/// Returns the README's lines of all techniques.
fn technique_rows() -> String {
    let techniques: serde_json::Value = serde_json::from_str(&fragbuf(&["list", "--json"], root())).unwrap();
    let text = |value: &serde_json::Value| value.as_str().unwrap().to_owned();
    let row = |technique: &serde_json::Value| {
        let [key, summary, words, draws] =
            ["key", "summary", "words_per_pixel", "draws"].map(|field| text(&technique[field]));
        let exact = ["deterministic", "order_independent"].iter().all(|field| technique[field] == "yes");
        let targets = technique["targets"].as_object().unwrap().values().map(text);
        let mut tiers: Vec<String> = targets.filter(|tier| TIERS.contains(&tier.as_str())).collect();
        tiers.sort();
        tiers.dedup();
        let (exact, tiers) = (if exact { "yes" } else { "no" }, tiers.join(" "));
        format!("| [`{key}`](examples/techniques/{key}.md) | {summary} | {words} | {draws} | {exact} | {tiers} |\n")
    };
    techniques.as_array().unwrap().iter().map(row).collect()
}

/// The table of every column is the output of `list --markdown`. `INSTA_UPDATE=always` updates it.
#[test]
fn the_page_of_all_techniques_is_computed() {
    is_computed("examples/techniques/README.md", &["list", "--markdown"]);
}

/// Every technique has a page and an image. Pages are computed from the rows: `INSTA_UPDATE=always` updates them.
#[test]
fn every_technique_has_its_page() {
    let techniques = Registry::builtin().techniques().to_vec();
    for technique in &techniques {
        let path = format!("examples/techniques/{}.md", technique.key);
        is_computed(&path, &["show", &technique.key, "--page"]);
        assert!(
            root().join(format!("examples/gallery/{}.png", technique.key)).exists(),
            "no picture of {}",
            technique.key
        );
    }
    assert_eq!(files("examples/techniques", "md").len(), techniques.len() + 2, "a page of no technique");
}

/// The comparison with Table 1 of the k⁺-buffer paper is computed.
#[test]
fn the_comparison_with_table_1_is_computed() {
    is_computed("examples/techniques/table_1.md", &["list", "--table-1"]);
}

/// The guide's language reference is computed from the type checker's tables. `INSTA_UPDATE=always` updates it.
#[test]
fn the_guide_has_the_computed_reference() {
    is_computed("src/guide/language.md", &["language"]);
}

/// Every description in the guide's chapter on diagnostics is followed by the output of the command line. `INSTA_UPDATE=always` updates it.
#[test]
fn the_guide_shows_real_diagnostics() {
    let path = root().join("src/guide/diagnostics.md");
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("diagnostics");
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
        assert!(said.starts_with("error["), "{description} has no error: {said}");
        expected += &format!("```fragbuf\n{description}```\n{between}```text\n{}\n```\n{after}", said.trim_end());
    }
    if updating() {
        std::fs::write(&path, &expected).unwrap();
    }
    assert_eq!(read(&path), expected, "{} is out of date", path.display());
}

/// The storage in the guide equals the example.
#[test]
fn the_guide_builds_the_example() {
    let guide = read(&root().join("src/guide/extend.md"));
    let example = read(&root().join("examples/user_storage/first_k.wgsl"));
    assert!(example.ends_with(&block(&guide, "wgsl")));
}

/// Asserts that a file is what the command line prints.
fn is_computed(path: &str, arguments: &[&str]) {
    let path = root().join(path);
    let computed = fragbuf(arguments, root());
    if updating() {
        std::fs::write(&path, &computed).unwrap();
    }
    assert_eq!(read(&path), computed, "{} is out of date", path.display());
}

fn updating() -> bool {
    std::env::var("INSTA_UPDATE").is_ok_and(|update| update == "always")
}

/// Every code block in the README is computed. `INSTA_UPDATE=always` updates it.
#[test]
fn the_readme_shows_what_is_generated() {
    shows("rust", 0, |_| read(&root().join("examples/glass.fragbuf")));
    for target in ["wgsl", "glsl"] {
        // The block is one function of the generated sources.
        shows(target, 0, |block| {
            let sources = fragbuf(&["show", "examples/glass.fragbuf", "--dump", target], root());
            let name = block.split_inclusive('(').next().unwrap();
            let start = sources.find(name).unwrap_or_else(|| panic!("no function `{name}`"));
            let end = start + sources[start..].find("\n}\n").unwrap() + 3;
            sources[start..end].to_owned()
        });
    }
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR"));
    let glass = "buffer Glass from kplus_array {\n    storage: max_array;\n    sync: none;\n}\n";
    std::fs::write(folder.join("glass.fragbuf"), glass).unwrap();
    shows("text", 0, |_| {
        let diagnostics = fragbuf(&["show", "glass.fragbuf"], folder);
        format!("{}\n", diagnostics.split("\n\n").next().unwrap().trim_end())
    });
}

/// Held while a test reads or updates the README.
static README: Mutex<()> = Mutex::new(());

/// Asserts that a code block of the README, by its language and number, equals what `computed` returns for it.
fn shows(language: &str, number: usize, computed: impl Fn(&str) -> String) {
    let _lock = README.lock().unwrap_or_else(PoisonError::into_inner);
    let path = root().join("README.md");
    let readme = read(&path);
    let fence = format!("```{language}\n");
    let start = readme.match_indices(&fence).nth(number).unwrap().0 + fence.len();
    let end = start + readme[start..].find("```").unwrap();
    let computed = computed(&readme[start..end]);
    if updating() {
        std::fs::write(&path, [&readme[..start], &computed, &readme[end..]].concat()).unwrap();
    }
    assert!(updating() || readme[start..end] == computed, "README.md should show:\n{computed}");
}

/// Returns the first code block of a language.
fn block(text: &str, language: &str) -> String {
    let start = text.split(&format!("```{language}\n")).nth(1).unwrap();
    start.split("```").next().unwrap().to_owned()
}

/// Returns what the command line prints on both streams.
fn fragbuf(arguments: &[&str], folder: &Path) -> String {
    let output =
        std::process::Command::new(env!("CARGO_BIN_EXE_fragbuf")).args(arguments).current_dir(folder).output().unwrap();
    String::from_utf8([output.stdout, output.stderr].concat()).unwrap()
}

/// Names and phrases that the project no longer uses. The changelog has their replacements.
const RETIRED: &[&str] = &[
    // Phrases.
    "turned away",
    "turns away",
    "given up",
    "gives up",
    "way out",
    "ways out",
    "whoever",
    "nobody",
    "goes round",
    "for want of",
    "found no room",
    "finds no room",
    "of one's own",
    "affair",
    "by chance",
    "stands for each other",
    "stand for each other",
    "sign of life",
    "mended",
    // Names.
    "turned_away",
    "ways_out",
    "LineOrigin",
    "LineMap",
    "OwnRow",
    "RowPlaces",
    "PassText",
    "KeptText",
    "Beside",
    "beside_words",
    "is_brought",
    "Looped",
    "spin_exhausted",
    "partly_covered",
    "checked_array",
    "repeated_array",
    "storage_settle",
    "storage_survey",
    "vertex_placed",
    "Recorded::Cut",
    "codes::UNMET",
    "codes::ROW",
    "fragbuf_backends",
    "fragbuf-backends",
    "fragbuf_builder",
    "fragbuf-builder",
];

#[test]
fn retired_words_stay_out() {
    let mut found = Vec::new();
    let folders = ["src", "dsl", "codegen", "backends", "templates", "tests", "examples"];
    let of = |extension| folders.iter().flat_map(move |folder| files(folder, extension));
    let top = ["README.md", "ARCHITECTURE.md"].map(|name| root().join(name));
    for path in ["rs", "wgsl", "md", "fragbuf", "snap"].into_iter().flat_map(of).chain(top) {
        // The table of former words, for files that still have them.
        if path.ends_with("tests/tidy.rs") || path.ends_with("row/former.rs") {
            continue;
        }
        for (line, text) in (1..).zip(read(&path).lines()).filter(|(_, text)| !text.contains("former_key: Some(")) {
            let begins = |word: &str| word.bytes().all(|letter| letter.is_ascii_lowercase() || letter == b' ');
            let capital = |word: &str| format!(" {}{} ", word[..1].to_uppercase(), &word[1..]);
            let words = RETIRED.iter();
            let words = words.filter(|word| text.contains(**word) || begins(word) && text.contains(&capital(word)));
            found.extend(words.map(|word| format!("{}:{line}: {word}", path.display())));
        }
    }
    assert!(found.is_empty(), "{} retired words:\n{}", found.len(), found.join("\n"));
}

/// The folders of crates, from the bottom to the top. A crate depends on its own folder and on those below it.
const LAYERS: [&str; 7] =
    ["templates", "dsl", "codegen", "backends/emit", "backends/run", "backends/verify", "Cargo.toml"];

/// Tests may depend on crates above: a device is tested with the checker's `ReadOut`.
#[test]
fn dependencies_point_down() {
    let layer = |path: &str| LAYERS.iter().position(|layer| path.starts_with(layer));
    let workspace = read(&root().join("Cargo.toml"));
    let path_of = |name: &str| {
        let line = workspace.lines().find(|line| line.starts_with(&format!("{name} = {{ path = ")))?;
        line.split('"').nth(1).map(str::to_owned)
    };
    let mut checked = 0;
    for manifest in files("", "toml").into_iter().filter(|path| path.ends_with("Cargo.toml")) {
        let shown = manifest.strip_prefix(root()).unwrap().to_string_lossy().into_owned();
        let Some(own) = layer(&shown) else { continue };
        let text = read(&manifest);
        let dependencies = text.split("\n[dependencies]").nth(1).unwrap_or("").split("\n[").next().unwrap_or("");
        let names = dependencies.lines().filter_map(|line| line.split(['.', ' ']).next());
        for name in names.filter(|name| name.starts_with("fragbuf-")) {
            let below = path_of(name).and_then(|path| layer(&path));
            assert!(below.is_some_and(|below| below <= own), "{shown} depends on {name}, which is above it");
            checked += 1;
        }
    }
    assert!(checked > 30, "{checked} dependencies");
}

#[test]
fn the_dsl_builds_without_codegen_naga_and_wgpu() {
    let language = ["fragbuf-syntax", "fragbuf-expansion", "fragbuf-macros", "fragbuf-dsl"];
    for package in ["fragbuf-templates", "fragbuf-model"].into_iter().chain(language) {
        let tree = tree(&["--edges", "all", "-p", package]);
        let above = ["fragbuf-codegen", "naga", "wgpu"];
        assert!(above.iter().all(|name| !tree.contains(name)), "{package}:\n{tree}");
    }
}

/// Rendering on the CPU device does not depend on wgpu.
#[test]
fn drawing_needs_no_wgpu() {
    let features = ["--no-default-features", "--features", "pictures"];
    let tree = tree(&[&["--edges", "normal", "-p", "fragbuf"], &features[..]].concat());
    assert!(tree.contains("fragbuf-cpu") && !tree.contains("wgpu"), "{tree}");
}

/// Without the feature `pictures` the facade only generates.
#[test]
fn generating_needs_no_wgpu() {
    let tree = tree(&["--edges", "normal", "-p", "fragbuf", "--no-default-features"]);
    assert!(tree.contains("naga") && !tree.contains("wgpu"), "{tree}");
    // Snapshot tests use the caller's insta.
    assert!(!tree.contains("insta"), "{tree}");
}

/// Without features, and with `pictures` alone, the library and the command line compile without warnings.
#[test]
fn fewer_features_compile() {
    let target = Path::new(env!("CARGO_TARGET_TMPDIR")).parent().unwrap();
    for features in ["", "pictures"] {
        let output = std::process::Command::new(env!("CARGO"))
            .args(["check", "--offline", "--quiet", "--lib", "--bins", "--no-default-features", "--features", features])
            .current_dir(root())
            .env("CARGO_TARGET_DIR", target)
            .output()
            .unwrap();
        let text = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success() && text.is_empty(), "--features \"{features}\": {text}");
    }
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
