//! Every code block of the guide and of the READMEs is run, parsed or compared, by its language. A block of another kind is a failure.
//!
//! Pages under `examples/techniques` are computed as a whole (`tidy::every_technique_has_its_page`). Rust blocks of the guide are run
//! by rustdoc.

mod commands;
mod manifests;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use fragbuf::load::{Description, load};
use fragbuf::{Form, Registry, Request, generate, parse, target};

use crate::build_script::SCRIPT;

/// A fenced block of a Markdown file.
struct Block {
    /// The path from the root of the repository.
    file: String,
    /// The line of its fence.
    line: usize,
    /// What follows the fence.
    language: String,
    text: String,
    /// The language of the next block, if only an empty line is between them.
    followed_by: Option<String>,
}

impl Block {
    fn fail(&self, problem: &str) -> ! {
        panic!("{}:{}: {problem}\n```{}\n{}```", self.file, self.line, self.language, self.text)
    }

    /// Returns the lines that rustdoc shows, without indentation.
    fn shown(&self) -> String {
        let lines = self.text.lines().map(str::trim).filter(|line| *line != "#" && !line.starts_with("# "));
        lines.map(|line| format!("{line}\n")).collect()
    }

    fn is_in(&self, file: &str) -> bool {
        self.file == format!("src/guide/{file}")
    }
}

/// Blocks that another test compares or computes: file, language, how many it covers, and the test.
const ELSEWHERE: &[(&str, &str, usize, &str)] = &[
    ("README.md", "rust", 1, "tidy::the_readme_shows_what_is_generated"),
    ("README.md", "wgsl", 1, "tidy::the_readme_shows_what_is_generated"),
    ("README.md", "glsl", 1, "tidy::the_readme_shows_what_is_generated"),
    ("README.md", "text", 1, "tidy::the_readme_shows_what_is_generated"),
    ("src/guide/check.md", "text", 7, "check::the_guide_shows_the_output_of_its_commands"),
    ("src/guide/check.md", "wgsl", 1, "check::the_guide_shows_the_output_of_its_commands"),
    ("src/guide/memory.md", "text", 1, "predict::the_guide_shows_the_output_of_its_command"),
    ("src/guide/diagnostics.md", "fragbuf", 6, "tidy::the_guide_shows_real_diagnostics"),
    ("src/guide/diagnostics.md", "text", 6, "tidy::the_guide_shows_real_diagnostics"),
];

#[test]
fn every_block_of_a_known_kind_is_right() {
    let mut elsewhere: BTreeMap<(&str, &str), usize> = BTreeMap::new();
    let mut commands = Vec::new();
    let blocks = blocks();
    for block in &blocks {
        let rows = ELSEWHERE.iter().find(|(file, language, ..)| block.file == *file && block.language == *language);
        if let Some((file, language, ..)) = rows {
            *elsewhere.entry((file, language)).or_default() += 1;
            continue;
        }
        match block.language.as_str() {
            "" | "rust" => runs_as_a_doctest(block),
            "no_run" => is_code_that_runs(block),
            "fragbuf" if block.is_in("codes.md") => {}
            "wgsl" if block.is_in("codes.md") => {}
            "fragbuf" => is_a_description(block),
            "wgsl" => is_a_shader(block),
            "toml" => manifests::is_a_cargo_manifest(block),
            "json" => manifests::is_an_exchange(block),
            // A diagram.
            "text" if block.text.contains("─►") => {}
            "sh" => commands.push(block),
            "js" => is_a_part_of_the_example(block),
            "glsl" => is_a_material(block),
            "ignore" => is_a_part_of_a_host(block),
            _ => block.fail("no test for a block of this kind"),
        }
    }
    for (file, language, count, test) in ELSEWHERE {
        let found = elsewhere.get(&(*file, *language)).copied().unwrap_or_default();
        assert_eq!(found, *count, "{file}: blocks in `{language}`, which {test} covers");
    }
    commands::run(&commands);
}

/// `messages::every_code_is_explained` compiles the first example of a section, so there is no second one.
#[test]
fn a_code_has_one_example() {
    for file in ["codes.md", "model_warnings.md", "counters.md"] {
        let text = read(&format!("src/guide/{file}"));
        for section in text.split("\n## ").skip(1) {
            assert!(section.matches("\n```").count() <= 2, "{file}: two examples:\n{section}");
        }
    }
}

/// Returns every block of the Markdown files that people write.
fn blocks() -> Vec<Block> {
    let mut blocks = Vec::new();
    let mut waiting = vec![root().to_owned()];
    while let Some(folder) = waiting.pop() {
        for path in std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()) {
            let name = path.file_name().unwrap().to_string_lossy().into_owned();
            let is_skipped = name.starts_with('.') || ["target", "node_modules", "techniques"].contains(&&*name);
            match path.is_dir() {
                true if !is_skipped => waiting.push(path),
                false if name.ends_with(".md") => blocks.extend(blocks_of(&path)),
                _ => {}
            }
        }
    }
    assert!(blocks.len() > 80, "{} blocks", blocks.len());
    blocks
}

fn blocks_of(path: &Path) -> Vec<Block> {
    let file = path.strip_prefix(root()).unwrap().to_string_lossy().into_owned();
    let text = read(&file);
    let mut lines = (1..).zip(text.lines());
    let mut blocks: Vec<Block> = Vec::new();
    let mut end = 0;
    while let Some((line, fence)) = lines.next() {
        let Some(language) = fence.trim_start().strip_prefix("```") else { continue };
        if let Some(previous) = blocks.last_mut().filter(|_| line == end + 2) {
            previous.followed_by = Some(language.to_owned());
        }
        let mut text = String::new();
        end = loop {
            let (number, line) = lines.next().unwrap_or_else(|| panic!("{file}:{line}: a block without an end"));
            if line.trim() == "```" {
                break number;
            }
            text += &format!("{line}\n");
        };
        blocks.push(Block { file: file.clone(), line, language: language.to_owned(), text, followed_by: None });
    }
    blocks
}

/// Rustdoc runs the block if its chapter is part of the crate's documentation.
fn runs_as_a_doctest(block: &Block) {
    let chapter = block.file.strip_prefix("src/").unwrap_or_else(|| block.fail("rustdoc does not see this file"));
    let modules = read("src/guide.rs");
    if !modules.contains(&format!("#[doc = include_str!(\"{chapter}\")]\npub mod ")) {
        block.fail("`src/guide.rs` does not include this chapter");
    }
}

/// A block that needs a device of the reader, or a package, is a part of code that another test runs.
fn is_code_that_runs(block: &Block) {
    runs_as_a_doctest(block);
    let code = match block.is_in("generate.md") {
        true => SCRIPT.to_owned(),
        false => read("examples/material/main.rs"),
    };
    let code: String = code.lines().map(|line| format!("{}\n", line.trim())).collect();
    if !code.contains(block.shown().trim_start_matches("// build.rs\n")) {
        block.fail("not a part of the code that runs");
    }
}

/// A material in GLSL is a file of the example, with which the test `program` of the OpenGL host draws.
fn is_a_material(block: &Block) {
    let files = ["pane.vert.glsl", "pane.frag.glsl"].map(|name| read(&format!("examples/opengl/{name}")));
    if !files.contains(&block.text) {
        block.fail("no file of the example has this text");
    }
}

/// A script is a part of the example for browsers, which `browser` runs on Dawn and in Chromium.
fn is_a_part_of_the_example(block: &Block) {
    let files = ["examples/web/knot.mjs", "examples/web/index.html"];
    if !files.iter().any(|file| read(file).contains(&block.text)) {
        block.fail("not a part of the example");
    }
}

/// The folders with the files of the host that a chapter is about, or of what hosts share.
const HOSTS: [(&str, &[&str]); 3] = [
    ("opengl.md", &["backends/run/opengl/src", "backends/run/follow/src"]),
    ("vulkan.md", &["backends/run/vulkan/src", "backends/run/follow/src"]),
    ("bevy.md", &["examples/bevy/src", "examples/bevy/src/plugin", "examples/bevy/examples"]),
];

/// A part of a crate is in a file of the host that the chapter is about, or of what hosts share.
fn is_a_part_of_a_host(block: &Block) {
    let Some((_, folders)) = HOSTS.iter().find(|(chapter, _)| block.is_in(chapter)) else {
        block.fail("only chapters about hosts show parts of a crate")
    };
    let files = folders.iter().flat_map(|folder| std::fs::read_dir(root().join(folder)).unwrap());
    let files = files.map(|file| file.unwrap().path());
    let mut texts = files.filter(|path| path.is_file()).filter_map(|path| std::fs::read_to_string(path).ok());
    if !texts.any(|text| text.contains(&block.text)) {
        block.fail("not a part of the host");
    }
}

/// A description is valid, also if the block shows only some of its statements.
fn is_a_description(block: &Block) {
    let text = match block.text.starts_with("buffer ") {
        true => block.text.clone(),
        false => format!("buffer B from kplus_array {{\n    fragment {{ depth: f32, heat: f32 }}\n{}}}\n", block.text),
    };
    let folder = root().join("examples/user_storage");
    let description = Description::Text { file: folder.join("block.fragbuf").display().to_string(), text };
    let registry = Registry::builtin();
    let loaded = load(&description, &[], &[], &registry).variant;
    let variant = loaded.unwrap_or_else(|errors| block.fail(&errors.to_string()));
    assert!(variant.warnings.is_empty(), "{}", variant.warnings);
    let request = Request { targets: &[target("wgsl").unwrap()], form: Form::Program, prefix: "", group: 0 };
    generate(&variant, &request, &registry).unwrap_or_else(|errors| block.fail(&errors.to_string()));
}

/// A shader is the end of a file of the examples, which is accepted as what it is: a user's storage, or a material.
fn is_a_shader(block: &Block) {
    match block.is_in("extend.md") {
        true => {
            let file = "examples/user_storage/first_k.wgsl";
            assert!(read(file).ends_with(&block.text), "{file} ends otherwise than in the guide");
            let text = "buffer FirstK { storage: wgsl(\"first_k.wgsl\"); keep 8; }".to_owned();
            let description = Description::Text { file: root().join(file).display().to_string(), text };
            let loaded = load(&description, &[], &[], &Registry::builtin()).variant;
            loaded.unwrap_or_else(|errors| block.fail(&errors.to_string()));
        }
        false if block.is_in("material.md") => {
            let material = read("examples/material/material.wgsl");
            assert!(material.ends_with(&block.text), "the material ends otherwise than in the guide");
            let registry = Registry::builtin();
            let variant = parse("buffer Glass from ab_ll { }", "glass.fragbuf").check(&registry).unwrap();
            let request = Request { targets: &[target("wgsl").unwrap()], form: Form::Module, prefix: "", group: 1 };
            let generation = generate(&variant, &request, &registry).unwrap();
            let store = generation.files.iter().find(|file| file.pass == "store").unwrap();
            let source = format!("{}\n{material}", std::str::from_utf8(&store.bytes).unwrap());
            let module =
                naga::front::wgsl::parse_str(&source).unwrap_or_else(|e| block.fail(&e.emit_to_string(&source)));
            let (flags, capabilities) = (naga::valid::ValidationFlags::all(), naga::valid::Capabilities::empty());
            let validated = naga::valid::Validator::new(flags, capabilities).validate(&module);
            validated.unwrap_or_else(|e| block.fail(&e.emit_to_string(&source)));
        }
        false => block.fail("no file of the examples has this shader"),
    }
}

fn read(path: &str) -> String {
    std::fs::read_to_string(root().join(path)).unwrap_or_else(|error| panic!("{path}: {error}"))
}

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// Returns an empty folder.
fn folder(name: &str) -> PathBuf {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join("blocks").join(name);
    let _ = std::fs::remove_dir_all(&path);
    std::fs::create_dir_all(&path).unwrap();
    path
}
