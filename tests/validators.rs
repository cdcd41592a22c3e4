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
    let jobs: Vec<&File> =
        distinct.filter(|file| tool(file).is_some() && seen.insert((suffix(file), file.target, &file.bytes))).collect();
    let queue = Mutex::new(jobs.iter());
    let diagnostics = Mutex::new(Vec::new());
    let work = || {
        while let Some(file) = { queue.lock().unwrap().next() } {
            if let Err(diagnostic) = accepted(file) {
                diagnostics.lock().unwrap().push(diagnostic);
            }
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
    jobs.len() + portable
}

/// Returns the validator of a file and its arguments, without the file name.
fn tool(file: &File) -> Option<(&'static str, Vec<&'static str>)> {
    let is_module = file.entry_points.iter().any(|(stage, _)| *stage == "module");
    match file.target {
        "glsl" if !is_module => Some(("glslangValidator", vec!["--target-env", "opengl"])),
        "glsl-es" if !is_module => Some(("glslangValidator", vec![])),
        "glsl-vulkan" if !is_module => {
            Some(("glslangValidator", vec!["-V", "--target-env", "vulkan1.1", "-o", "out.spv"]))
        }
        "spirv" => Some(("spirv-val", vec!["--target-env", "vulkan1.1"])),
        _ => None,
    }
}

fn suffix(file: &File) -> &str {
    file.path.split_once('.').map_or("", |(_, suffix)| suffix)
}

fn accepted(file: &File) -> Result<(), String> {
    let Some((program, arguments)) = tool(file) else { return Ok(()) };
    let mut hasher = DefaultHasher::new();
    (program, version(program), &arguments, suffix(file), &file.bytes).hash(&mut hasher);
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("validated");
    let passed = folder.join(format!("{:016x}", hasher.finish()));
    if passed.exists() {
        return Ok(());
    }
    // Two tests may validate the same file at once, so each uses its own folder.
    static COUNT: AtomicUsize = AtomicUsize::new(0);
    let work: PathBuf = folder.join(format!("work-{:016x}-{}", hasher.finish(), COUNT.fetch_add(1, Ordering::Relaxed)));
    std::fs::create_dir_all(&work).unwrap();
    let name = format!("file.{}", suffix(file));
    std::fs::write(work.join(&name), &file.bytes).unwrap();
    let result = run(program, &arguments, &name, &work).and_then(|()| match file.target {
        // The SPIR-V that glslang writes for the Vulkan dialect must be valid, too.
        "glsl-vulkan" => run("spirv-val", &["--target-env", "vulkan1.1"], "out.spv", &work),
        _ => Ok(()),
    });
    std::fs::remove_dir_all(&work).unwrap();
    result.map_err(|diagnostic| format!("{}: {diagnostic}\n{}", file.path, String::from_utf8_lossy(&file.bytes)))?;
    std::fs::write(passed, "").unwrap();
    Ok(())
}

fn run(program: &str, arguments: &[&str], name: &str, folder: &Path) -> Result<(), String> {
    let output = Command::new(program).args(arguments).arg(name).current_dir(folder).output();
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
