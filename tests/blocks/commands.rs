//! Blocks with commands. Every command that runs `fragbuf` runs, in an empty folder with the files that it names.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::atomic::{AtomicUsize, Ordering};

use super::{Block, folder, read, root};

/// What a command has instead, so that it takes less time.
const SMALLER: &[(&str, &str)] =
    &[("builtin:hairball", "builtin:hairball,strands=20"), ("builtin:needles", "builtin:needles,n=20")];

/// Options of every command of a name, with values that take less time.
const OPTIONS: &[(&str, &str, &str)] = &[
    ("render", "--size", "24x18"),
    ("compare", "--size", "24x18"),
    ("check", "--fragments", "2"),
    ("site", "--technique", "kb_mdt64"),
];

/// A model for commands that name one.
const MODEL: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0.5\nf 1 2 3\n";

/// A command, and where it is.
struct Line<'a> {
    block: &'a Block,
    words: Vec<String>,
}

/// Runs the commands of the blocks.
pub(super) fn run(blocks: &[&Block]) {
    let lines: Vec<Line<'_>> = blocks.iter().flat_map(|block| lines(block)).collect();
    assert!(lines.len() >= 20, "{} commands", lines.len());
    let next = AtomicUsize::new(0);
    std::thread::scope(|scope| {
        for _ in 0..std::thread::available_parallelism().map_or(1, usize::from) {
            scope.spawn(|| {
                while let Some(line) = lines.get(next.fetch_add(1, Ordering::Relaxed)) {
                    run_line(line, next_folder());
                }
            });
        }
    });
}

fn next_folder() -> PathBuf {
    static NUMBER: AtomicUsize = AtomicUsize::new(0);
    folder(&format!("command-{}", NUMBER.fetch_add(1, Ordering::Relaxed)))
}

/// Returns the commands of a block that run here, and checks the others.
fn lines<'a>(block: &'a Block) -> Vec<Line<'a>> {
    // `check::the_guide_shows_the_output_of_its_commands` runs those whose output follows.
    if block.followed_by.as_deref() == Some("text") && block.is_in("check.md") {
        return Vec::new();
    }
    let mut lines = Vec::new();
    for command in commands(&block.text) {
        let words: Vec<&str> = command.split_whitespace().collect();
        match words.as_slice() {
            ["fragbuf", subcommand, ..] if is_synopsis(&command) => has_options(block, subcommand, &command),
            ["fragbuf", "playground", arguments @ ..] => is_of_the_playground(block, arguments),
            ["fragbuf", arguments @ ..] => lines.push(line(block, arguments)),
            ["cargo", "run", "--release", "--", arguments @ ..] => lines.push(line(block, arguments)),
            // The example runs in a test that includes it.
            ["cargo", "run", "--example", name, ..] => {
                let tests = ["tests/examples.rs", "tests/material.rs"].map(read).concat();
                assert!(tests.contains(&format!("#[path = \"../examples/{name}")), "no test runs `{command}`");
            }
            // The test `program` of the host runs it with these options and shaders.
            ["cargo", "run", "--release", "-p", "fragbuf-opengl-host", "--", arguments @ ..] => {
                is_of_the_opengl_host(block, arguments);
            }
            // `c_header::the_example_follows_the_frame` compiles and runs it, with these options.
            [
                "cc",
                "-std=c11",
                "-Wall",
                "-Wextra",
                "-Werror",
                "-pedantic",
                "-I",
                "passes",
                "examples/c/frame.c",
                "-o",
                "frame",
            ]
            | ["./frame", "640", "480"] => assert!(block.file == "examples/c/README.md"),
            // `program::the_guide_shows_what_the_program_draws` of the host runs it, with these options.
            ["cargo", "run", "-p", "fragbuf-vulkan-host", "--", "passes", "panes.png", "--validate"] => {
                assert!(block.is_in("vulkan.md"));
            }
            // `pictures` of the crate draws the same scene with these ways and this file.
            ["cargo", "run", "--manifest-path", "examples/bevy/Cargo.toml", "--", _, arguments @ ..] => {
                let is_known = |word: &&str| {
                    word.parse::<u32>().is_ok() || ["sorted", "oit"].contains(word) || root().join(word).exists()
                };
                assert!(arguments.iter().all(is_known), "{}:{}: no way `{arguments:?}`", block.file, block.line);
            }
            // `.ci/run` runs it.
            ["cargo", "test", "--locked", "--manifest-path", "examples/bevy/Cargo.toml"] => {
                assert!(read(".ci/run").lines().any(|line| line == command), "`.ci/run` does not run `{command}`");
            }
            [".ci/run"] => assert!(root().join(".ci/run").exists()),
            _ => block.fail(&format!("no test for `{command}`")),
        }
    }
    lines
}

/// Checks that the program has the options, and that its test uses the files of the examples.
fn is_of_the_opengl_host(block: &Block, arguments: &[&str]) {
    let (program, test) = ("src/main.rs", "tests/program.rs");
    let [program, test] = [program, test].map(|path| read(&format!("backends/run/opengl/{path}")));
    for argument in arguments {
        let is_known = match argument.strip_prefix("examples/opengl/") {
            Some(file) => test.contains(file),
            None => !argument.starts_with("--") || program.contains(&format!("[{argument}")),
        };
        assert!(is_known, "{}:{}: the program has no `{argument}`", block.file, block.line);
    }
}

/// Checks that the program has the options, and that the folder exists. The command runs until it is ended: `playground_requests`
/// starts it.
fn is_of_the_playground(block: &Block, arguments: &[&str]) {
    has_options(block, "playground", &arguments.join(" "));
    if let Some(folder) = arguments.first().filter(|argument| !argument.starts_with("--")) {
        assert!(root().join(folder).is_dir(), "{}:{}: there is no folder `{folder}`", block.file, block.line);
    }
}

/// Returns the commands of a text without comments. An indented line continues a command.
fn commands(text: &str) -> Vec<String> {
    let mut commands: Vec<String> = Vec::new();
    for line in text.lines().map(|line| line.split(" # ").next().unwrap_or("")) {
        match commands.last_mut() {
            Some(last) if line.starts_with(' ') => last.push_str(line),
            _ => commands.push(line.to_owned()),
        }
    }
    commands
}

/// Whether a command stands for several, with options in brackets.
fn is_synopsis(command: &str) -> bool {
    command.contains(['[', '<', '…'])
}

/// Every option of a synopsis, or of a command that does not run here, is one that the subcommand has.
fn has_options(block: &Block, subcommand: &str, synopsis: &str) {
    let (help, _) = fragbuf(&[subcommand.to_owned(), "--help".to_owned()], root());
    for option in synopsis.split(|c: char| !c.is_ascii_alphanumeric() && c != '-').filter(|word| word.starts_with("--"))
    {
        let is_known = help.split(|c: char| !c.is_ascii_alphanumeric() && c != '-').any(|word| word == option);
        assert!(is_known, "{}:{}: `{subcommand}` has no option `{option}`", block.file, block.line);
    }
}

fn line<'a>(block: &'a Block, arguments: &[&str]) -> Line<'a> {
    let mut words: Vec<String> = Vec::new();
    for argument in arguments {
        let smaller = SMALLER.iter().find(|(slow, _)| slow == argument).map(|(_, smaller)| *smaller);
        words.push(smaller.unwrap_or(argument).to_owned());
    }
    for (_, option, value) in OPTIONS.iter().filter(|(command, ..)| *command == arguments[0]) {
        match words.iter().position(|word| word == option) {
            Some(at) => words[at + 1] = (*value).to_owned(),
            None => words.extend([*option, *value].map(str::to_owned)),
        }
    }
    assert!(!words.iter().any(|word| word.contains(['"', '\'', '$', '|'])), "{words:?} needs a shell");
    Line { block, words }
}

fn run_line(line: &Line<'_>, folder: PathBuf) {
    for word in &line.words {
        let text = match word.as_str() {
            "glass.fragbuf" => {
                let chapter = read("src/guide/describe.md");
                chapter.split("let text = \"").nth(1).unwrap().split("\";").next().unwrap().to_owned()
            }
            "model.obj" => MODEL.to_owned(),
            path if path.starts_with("examples/") && root().join(path).is_file() => read(path),
            _ => continue,
        };
        let path = folder.join(word);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, text).unwrap();
    }
    let (output, success) = fragbuf(&line.words, &folder);
    let command = line.words.join(" ");
    assert!(success, "{}:{}: fragbuf {command}\n{output}", line.block.file, line.block.line);
    if let Some(at) = line.words.iter().position(|word| word == "--out") {
        assert!(folder.join(&line.words[at + 1]).exists(), "`fragbuf {command}` writes nothing");
    }
}

/// Returns what a command prints on both streams, and whether it succeeded.
fn fragbuf(arguments: &[String], folder: &Path) -> (String, bool) {
    let output = Command::new(env!("CARGO_BIN_EXE_fragbuf")).args(arguments).current_dir(folder).output().unwrap();
    let text = String::from_utf8_lossy(&[output.stdout, output.stderr].concat()).into_owned();
    (text, output.status.success())
}
