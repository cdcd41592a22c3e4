//! Runs glslang, spirv-val and Tint on generated files. Results are cached by content and validator.

use std::collections::BTreeSet;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use fragbuf::File;

use crate::tint;

/// Validates each distinct file for which there is an external validator. Returns their number. Panics with every error.
pub fn validate<'a>(files: impl Iterator<Item = &'a File>) -> usize {
    let files: Vec<&File> = files.collect();
    let mut seen = BTreeSet::new();
    let distinct = files.iter().copied();
    let distinct: Vec<&File> = distinct
        .filter(|file| !tools(file).is_empty() && seen.insert((suffix(file), file.target, &file.bytes)))
        .collect();
    let batches = batches(&distinct);
    let (queue, diagnostics) = (Mutex::new(batches.iter()), Mutex::new(Vec::new()));
    let work = || {
        while let Some((tool, files)) = { queue.lock().unwrap().next() } {
            let found = rejected(*tool, files);
            diagnostics.lock().unwrap().extend(found);
        }
    };
    std::thread::scope(|scope| {
        scope.spawn(work);
        scope.spawn(work);
    });
    let mut diagnostics = diagnostics.into_inner().unwrap();
    let (portable, rejected) = tint::rejected(&files);
    diagnostics.extend(rejected);
    assert!(diagnostics.is_empty(), "{}", diagnostics.join("\n\n"));
    distinct.len() + portable
}

/// A program with arguments, without the file names.
#[derive(Clone, Copy, PartialEq, Hash)]
struct Tool {
    program: &'static str,
    arguments: &'static [&'static str],
    /// How many files one process checks. glslang links files of one process if it writes SPIR-V.
    files: usize,
}

const GLSL: Tool = Tool { program: "glslangValidator", arguments: &[], files: 64 };
const GLSL_TO_SPIRV: Tool = Tool { arguments: &["--target-env", "opengl"], files: 1, ..GLSL };
const VULKAN: Tool = Tool { arguments: &["-V", "--target-env", "vulkan1.1", "-o", "out.spv"], files: 1, ..GLSL };
const SPIRV: Tool = Tool { program: "spirv-val", arguments: &["--target-env", "vulkan1.1"], files: 1 };

/// Returns the validators of a file.
fn tools(file: &File) -> Vec<Tool> {
    let is_module = file.entry_points.iter().any(|(stage, _)| *stage == "module");
    match file.target {
        "glsl" if !is_module => vec![GLSL, GLSL_TO_SPIRV],
        "glsl-es" if !is_module => vec![GLSL],
        "glsl-vulkan" if !is_module => vec![VULKAN],
        "spirv" => vec![SPIRV],
        _ => Vec::new(),
    }
}

fn suffix(file: &File) -> &str {
    file.path.split_once('.').map_or("", |(_, suffix)| suffix)
}

/// Returns what is not known to be valid, as the files of each process.
fn batches<'a>(files: &[&'a File]) -> Vec<(Tool, Vec<&'a File>)> {
    let mut batches = Vec::new();
    for tool in [GLSL, GLSL_TO_SPIRV, VULKAN, SPIRV] {
        let unknown = files.iter().copied().filter(|file| tools(file).contains(&tool) && !passed(tool, file).exists());
        let unknown: Vec<&File> = unknown.collect();
        batches.extend(unknown.chunks(tool.files).map(|files| (tool, files.to_vec())));
    }
    batches
}

/// Returns the file that exists if a validator accepted `file`.
fn passed(tool: Tool, file: &File) -> PathBuf {
    let mut hasher = DefaultHasher::new();
    (tool, version(tool.program), suffix(file), &file.bytes).hash(&mut hasher);
    folder().join(format!("{:016x}", hasher.finish()))
}

fn folder() -> PathBuf {
    Path::new(env!("CARGO_TARGET_TMPDIR")).join("validated")
}

/// Runs a validator on files. Returns a message for each that it rejects.
fn rejected(tool: Tool, files: &[&File]) -> Vec<String> {
    // Two tests may validate the same file at once, so each uses its own folder.
    static COUNT: AtomicUsize = AtomicUsize::new(0);
    let work = folder().join(format!("work-{}-{}", std::process::id(), COUNT.fetch_add(1, Ordering::Relaxed)));
    std::fs::create_dir_all(&work).unwrap();
    let names: Vec<String> =
        files.iter().enumerate().map(|(index, file)| format!("{index}.{}", suffix(file))).collect();
    names.iter().zip(files).for_each(|(name, file)| std::fs::write(work.join(name), &file.bytes).unwrap());
    let result = run(tool, &names, &work).and_then(|()| match tool == VULKAN {
        // The SPIR-V that glslang writes for the Vulkan dialect must be valid, too.
        true => run(SPIRV, &["out.spv".to_owned()], &work),
        false => Ok(()),
    });
    std::fs::remove_dir_all(&work).unwrap();
    match (result, files) {
        (Ok(()), _) => {
            files.iter().for_each(|file| std::fs::write(passed(tool, file), "").unwrap());
            Vec::new()
        }
        (Err(diagnostic), [file]) => {
            vec![format!("{}: {diagnostic}\n{}", file.path, String::from_utf8_lossy(&file.bytes))]
        }
        // Each by itself, so that the message has its text.
        (Err(_), files) => files.iter().flat_map(|file| rejected(tool, &[file])).collect(),
    }
}

fn run(tool: Tool, names: &[String], folder: &Path) -> Result<(), String> {
    let Tool { program, arguments, .. } = tool;
    let output = Command::new(program).args(arguments).args(names).current_dir(folder).output();
    let output = output.unwrap_or_else(|error| panic!("{program} must be installed: {error}"));
    if output.status.success() {
        return Ok(());
    }
    let (out, err) = (String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
    Err(format!("{program} {}: {out}{err}", arguments.join(" ")))
}

fn version(program: &str) -> String {
    use std::sync::LazyLock;
    let ask = |program: &str| {
        let output = Command::new(program).arg("--version").output();
        let output = output.unwrap_or_else(|error| panic!("{program} must be installed (see README): {error}"));
        String::from_utf8_lossy(&output.stdout).into_owned()
    };
    static GLSLANG: LazyLock<Mutex<Option<String>>> = LazyLock::new(|| Mutex::new(None));
    static SPIRV: LazyLock<Mutex<Option<String>>> = LazyLock::new(|| Mutex::new(None));
    let cell = if program == "spirv-val" { &SPIRV } else { &GLSLANG };
    cell.lock().unwrap().get_or_insert_with(|| ask(program)).clone()
}
