//! Tests `fragbuf new`: the crate builds and runs, its description is valid for every technique, and nothing is overwritten.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use fragbuf::Registry;
use fragbuf::build::Build;

fn folder(name: &str) -> PathBuf {
    crate::render::folder(&format!("new-{name}"))
}

fn fragbuf(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_fragbuf")).args(arguments).current_dir(folder).output().unwrap()
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

/// Builds and runs the crate with cargo, on the dependencies that the tests are built with.
#[test]
fn a_new_crate_builds_and_lists_its_passes() {
    let folder = folder("cargo");
    let root = env!("CARGO_MANIFEST_DIR");
    let created = fragbuf(&folder, &["new", "my-glass", "--path", root]);
    assert_eq!(created.status.code(), Some(0), "{}", text(&created.stderr));
    let project = folder.join("my-glass");
    // The folder of the tests is inside of another workspace, and there is no network.
    let manifest = std::fs::read_to_string(project.join("Cargo.toml")).unwrap();
    std::fs::write(project.join("Cargo.toml"), manifest + "\n[workspace]\n").unwrap();
    std::fs::copy(Path::new(root).join("Cargo.lock"), project.join("Cargo.lock")).unwrap();
    let target = Path::new(env!("CARGO_TARGET_TMPDIR")).parent().unwrap();
    let run = Command::new(env!("CARGO"))
        .args(["run", "--offline", "--quiet"])
        .current_dir(&project)
        .env("CARGO_TARGET_DIR", target)
        .output()
        .unwrap();
    assert!(run.status.success(), "{}", text(&run.stderr));
    assert_eq!(text(&run.stderr), "", "no warnings");
    let lines = text(&run.stdout);
    assert!(lines.lines().any(|line| line.starts_with("store ") && line.contains("fragment")), "{lines}");
    // Two words of 4 bytes for each of 8 fragments of 1280 × 720 pixels, in two buffers.
    assert!(lines.lines().any(|line| line.ends_with("29491200 bytes")), "{lines}");
}

/// For every technique: the description is valid and without warnings, and the program compiles with the bindings of its build script, and
/// runs. The compiler runs without cargo, because the program depends on nothing.
#[test]
fn new_crates_of_every_technique_compile_and_run() {
    let folder = folder("techniques");
    for technique in Registry::builtin().techniques() {
        let (key, name) = (technique.key.as_str(), format!("of_{}", technique.key));
        let created = fragbuf(&folder, &["new", &name, "--technique", key]);
        assert_eq!(created.status.code(), Some(0), "{key}: {}", text(&created.stderr));
        assert!(created.stderr.is_empty() && text(&created.stdout).contains(&format!("`{key}`")));
        let project = folder.join(&name);
        let description = format!("{name}.fragbuf");
        let shown = fragbuf(&project, &["show", &description]);
        assert_eq!((shown.status.code(), text(&shown.stderr)), (Some(0), String::new()), "{key}");
        let script = std::fs::read_to_string(project.join("build.rs")).unwrap();
        let target = script.split_once("&[\"").and_then(|(_, rest)| rest.split_once('"')).unwrap().0;
        let build = Build::new().file(project.join(&description)).targets(&[target]);
        build.out_dir(project.join("generated")).emit().unwrap_or_else(|error| panic!("{key}: {error}"));
        let program = project.join(format!("program{}", std::env::consts::EXE_SUFFIX));
        let rustc = Command::new("rustc")
            .args(["--edition", "2024", "-D", "warnings", "-o", program.to_str().unwrap(), "src/main.rs"])
            .current_dir(&project)
            .env("OUT_DIR", project.join("generated"))
            .output()
            .unwrap();
        assert!(rustc.status.success(), "{key}: {}", text(&rustc.stderr));
        let ran = Command::new(&program).output().unwrap();
        assert!(ran.status.success() && text(&ran.stdout).lines().count() >= 2, "{key}: {}", text(&ran.stdout));
    }
}

#[test]
fn new_rejects_names_and_folders_and_overwrites_nothing() {
    let folder = folder("rejected");
    for (arguments, code, expected) in [
        (&["new", "2d"][..], 2, "a name does not begin with a digit: for example `buffer-2d`"),
        (&["new", "my glass"], 2, "for example `my-glass`"),
        (&["new", "match"], 2, "the name is reserved: for example `buffer-match`"),
        (&["new", "glass", "--technique", "kplus_aray"], 2, "did you mean `kplus_array`?"),
        (&["new", "glass", "--path", "nowhere"], 2, "give the folder of its Cargo.toml"),
    ] {
        let output = fragbuf(&folder, arguments);
        assert_eq!(output.status.code(), Some(code), "{arguments:?}: {}", text(&output.stderr));
        assert!(text(&output.stderr).contains(expected), "{arguments:?}: {}", text(&output.stderr));
    }
    assert_eq!(std::fs::read_dir(&folder).unwrap().count(), 0, "nothing is written");
    std::fs::create_dir(folder.join("glass")).unwrap();
    std::fs::write(folder.join("glass/glass.fragbuf"), "mine").unwrap();
    let output = fragbuf(&folder, &["new", "glass"]);
    assert_eq!(output.status.code(), Some(3));
    assert!(text(&output.stderr).contains("`glass` exists already"), "{}", text(&output.stderr));
    assert_eq!(std::fs::read_to_string(folder.join("glass/glass.fragbuf")).unwrap(), "mine");
    assert_eq!(std::fs::read_dir(folder.join("glass")).unwrap().count(), 1);
}

/// The published version is the default; a path is as the user gives it, seen from the crate. No other path is in the files.
#[test]
fn a_manifest_has_only_paths_that_the_user_gives() {
    let folder = folder("manifest");
    assert!(fragbuf(&folder, &["new", "plain"]).status.success());
    std::fs::create_dir(folder.join("source")).unwrap();
    std::fs::write(folder.join("source/Cargo.toml"), "[package]\nname = \"fragbuf\"\n").unwrap();
    assert!(fragbuf(&folder, &["new", "local", "--path", "source"]).status.success());
    let manifest = |name: &str| std::fs::read_to_string(folder.join(name).join("Cargo.toml")).unwrap();
    assert!(
        manifest("plain").contains("fragbuf = { version = \"0.1\", default-features = false }"),
        "{}",
        manifest("plain")
    );
    assert!(
        manifest("local").contains("fragbuf = { path = \"../source\", default-features = false }"),
        "{}",
        manifest("local")
    );
    let root = env!("CARGO_MANIFEST_DIR");
    for file in ["plain/Cargo.toml", "plain/build.rs", "plain/src/main.rs", "plain/plain.fragbuf", "local/Cargo.toml"] {
        let text = std::fs::read_to_string(folder.join(file)).unwrap();
        assert!(!text.contains(root) && !text.contains("/home") && !text.contains("/root"), "{file}: {text}");
    }
}
