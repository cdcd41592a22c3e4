//! Tests the command line as scripts call it: arguments, exit codes, files, stdout and stderr.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use fragbuf::TARGETS;
use serde_json::Value;

fn fragbuf(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_fragbuf"))
        .args(arguments)
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .output()
        .unwrap()
}

fn folder(name: &str) -> PathBuf {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = std::fs::remove_dir_all(&path);
    path
}

fn tree(folder: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let mut files = BTreeMap::new();
    let mut waiting = vec![folder.to_owned()];
    while let Some(path) = waiting.pop() {
        for entry in std::fs::read_dir(&path).unwrap() {
            let path = entry.unwrap().path();
            match path.is_dir() {
                true => waiting.push(path),
                false => {
                    drop(files.insert(path.strip_prefix(folder).unwrap().to_owned(), std::fs::read(&path).unwrap()))
                }
            }
        }
    }
    files
}

fn generate(inputs: &[&str], out: &Path) -> Output {
    fragbuf(&[&["generate"], inputs, &["--target", "all", "--out", out.to_str().unwrap()]].concat())
}

#[test]
fn generating_everything_twice_gives_the_same_bytes() {
    let (first, second) = (folder("all-1"), folder("all-2"));
    for out in [&first, &second] {
        let output = generate(&["--all"], out);
        assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
        assert!(output.stdout.is_empty());
    }
    let files = tree(&first);
    assert!(files == tree(&second));
    assert!(files.len() > 60);
}

/// A technique that needs a feature of another target is a warning: the others are written.
#[test]
fn generating_everything_writes_what_a_target_supports() {
    for target in ["wgsl", "glsl-es", "msl"] {
        let out = folder(&format!("all-{target}"));
        let output = fragbuf(&["generate", "--all", "--target", target, "--out", out.to_str().unwrap()]);
        let warnings = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(0), "{warnings}");
        let techniques = fragbuf::Registry::builtin().techniques().to_vec();
        let (written, missing): (Vec<_>, Vec<_>) =
            techniques.iter().partition(|technique| out.join(&technique.key).exists());
        assert!(written.len() > missing.len() && !missing.is_empty());
        for technique in written {
            assert!(out.join(&technique.key).join("manifest.json").exists());
        }
        assert_eq!(warnings.lines().count(), missing.len(), "{warnings}");
        for technique in missing {
            let folder = out.join(&technique.key).display().to_string();
            assert!(warnings.lines().any(|line| line.contains(&format!("in {folder}: "))), "{warnings}");
        }
    }
    let out = folder("all-modules");
    let arguments = ["generate", "--all", "--target", "spirv", "--form", "module", "--out", out.to_str().unwrap()];
    let output = fragbuf(&arguments);
    assert_eq!(output.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&output.stderr).contains("--form program"));
    assert!(!out.exists());
}

#[test]
fn portable_wgsl_has_four_bind_groups() {
    let out = folder("groups");
    let with = |group: &str, target: &str| {
        fragbuf(&["generate", "ab_ll", "--target", target, "--group", group, "--out", out.to_str().unwrap()])
    };
    let rejected = with("4", "wgsl");
    let text = String::from_utf8_lossy(&rejected.stderr).into_owned();
    assert!(
        rejected.status.code() == Some(1) && text.contains("`group: 4` requires more than 4 bind groups"),
        "{text}"
    );
    assert!(text.contains("`--group` from 0 to 3") && !out.exists(), "{text}");
    let others = with("31", "all");
    let warnings = String::from_utf8_lossy(&others.stderr).into_owned();
    assert!(others.status.success() && warnings.lines().count() == 1, "{warnings}");
    assert!(warnings.contains("nothing written for wgsl in") && !out.join("wgsl").exists(), "{warnings}");
    assert!(with("3", "wgsl").status.success());
}

#[test]
fn the_manifest_names_every_file_and_nothing_else() {
    let out = folder("manifest");
    assert!(generate(&["ab_sb"], &out).status.success());
    let mut files = tree(&out);
    let manifest: Value = serde_json::from_slice(&files.remove(Path::new("manifest.json")).unwrap()).unwrap();
    for field in [
        "schema",
        "generator",
        "technique",
        "files",
        "steps",
        "resources",
        "constants",
        "features",
        "tier",
        "words_per_pixel",
        "counters",
    ] {
        assert!(!manifest[field].is_null(), "{field}");
    }
    let listed = manifest["files"].as_array().unwrap();
    for row in listed {
        for field in ["path", "target", "pass", "stage", "entry_point"] {
            assert!(row[field].is_string(), "{row}");
        }
    }
    let mut paths: Vec<PathBuf> = listed.iter().map(|row| row["path"].as_str().unwrap().into()).collect();
    paths.sort();
    paths.dedup();
    assert_eq!(paths, files.into_keys().collect::<Vec<_>>());
    assert_eq!(manifest["words_per_pixel"], "2f+2");
    assert_eq!(manifest["steps"].as_array().unwrap().iter().filter(|step| step["do"] == "host").count(), 1);
}

#[test]
fn list_is_an_array_of_techniques() {
    let output = fragbuf(&["list", "--json"]);
    let rows: Vec<Value> = serde_json::from_slice(&output.stdout).unwrap();
    let row = |key: &str| rows.iter().find(|row| row["key"] == key).unwrap();
    // The formulas of the catalogue, K15 Table 1.
    for (key, words, passes) in
        [("kb", "2k", 1), ("kplus_array", "2k+2", 1), ("ab_ll", "3f+1", 1), ("ab_sb", "2f+2", 2)]
    {
        assert_eq!(row(key)["words_per_pixel"], words, "{key}");
        assert_eq!(row(key)["geometry_passes"], passes, "{key}");
        assert!(row(key)["paper"].is_string() && row(key)["axes"]["storage"].is_string());
        assert_eq!(row(key)["targets"].as_object().unwrap().len(), TARGETS.len());
    }
    assert_eq!(row("kb")["targets"]["spirv"], "T5");
    assert_eq!(
        (&row("kplus_array")["targets"]["wgsl"], &row("kplus_array")["targets"]["glsl"]),
        (&"T4".into(), &"T3".into())
    );
    assert_eq!(row("ab_ll")["targets"]["wgsl"], "T1");
    let table = fragbuf(&["list", "--wide"]);
    let text = String::from_utf8_lossy(&table.stdout);
    assert!(table.status.success() && text.contains("kplus_array"));
    let headings = text.lines().next().unwrap();
    for heading in ["deterministic", "order-independent", "features", "summary"] {
        assert!(headings.contains(heading), "{headings}");
    }
}

#[test]
fn show_prints_every_stage() {
    for stage in ["plan", "manifest", "wgsl", "wgsl-native", "glsl", "glsl-vulkan", "glsl-es", "hlsl", "msl"] {
        let output = fragbuf(&["show", "kplus_array", "--set", "k=4", "--dump", stage]);
        assert_eq!(output.status.code(), Some(0), "{stage}");
        assert!(output.stdout.len() > 500 && output.stderr.is_empty(), "{stage}");
    }
    let json = fragbuf(&["show", "kplus_array", "--set", "sync.limit=77", "--json"]);
    let manifest: Value = serde_json::from_slice(&json.stdout).unwrap();
    assert_eq!(manifest["constants"]["SPIN_LIMIT"], 77);
}

#[test]
fn a_file_of_fifteen_lines_generates_everywhere() {
    let path = "examples/most_visible.fragbuf";
    let text = std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join(path)).unwrap();
    assert!(text.lines().count() <= 15);
    let out = folder("fifteen-lines");
    let output = generate(&[path], &out);
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    let files = tree(&out);
    for target in TARGETS {
        assert!(files.keys().any(|path| path.starts_with(target.name)), "{}", target.name);
    }
}

#[test]
fn exit_codes_classify_failures() {
    let out = folder("exit");
    let out = out.to_str().unwrap();
    let blocked = folder("blocked");
    std::fs::write(&blocked, "a file, not a folder").unwrap();
    let cases: &[(&[&str], i32)] = &[
        (&["list"], 0),
        (&["show", "kplus_aray"], 1),
        (&["show", "kplus_array", "--set", "sort=bubble"], 1),
        (&["generate", "kplus_array", "--target", "spirv", "--form", "module", "--out", out], 1),
        (&["generate", "kplus_array", "--target", "wgls", "--out", out], 2),
        (&["generate", "kplus_array", "--target", "wgsl"], 2),
        (&["generate", "--target", "wgsl", "--out", out], 2),
        (&["generate", "kb", "--target", "wgsl", "--prefix", "1a", "--out", out], 2),
        (&["show", "kb", "--dump", "cobol"], 2),
        (&["show", "no/such.fragbuf"], 3),
        (&["generate", "kb", "--target", "wgsl", "--out", blocked.to_str().unwrap()], 3),
    ];
    for (arguments, code) in cases {
        let output = fragbuf(arguments);
        assert_eq!(output.status.code(), Some(*code), "{arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
        assert_eq!(output.stderr.is_empty(), *code == 0, "{arguments:?}");
        assert!(output.stdout.is_empty() || *code == 0, "{arguments:?}");
    }
}

#[test]
fn diagnostics_of_bad_files_have_code_span_and_help() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("dsl/syntax/tests/bad");
    let mut count = 0;
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let output = fragbuf(&["show", path.to_str().unwrap()]);
        let stderr = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(1), "{}: {stderr}", path.display());
        assert!(stderr.contains("error[") && stderr.contains("help: "), "{stderr}");
        assert!(stderr.contains(&format!("{}:", path.display())), "{stderr}");
        count += 1;
    }
    assert!(count >= 40, "{count}");
}

/// Renamed flags and values: the command with the present spelling, with the former one, and the former one as help would
/// print it.
const FORMER: [(&[&str], &[&str], &str); 4] = [
    (
        &["check", "ab_ll", "--k", "1", "--fragments", "1"],
        &["check", "ab_ll", "--entries", "1", "--fragments", "1"],
        "--entries",
    ),
    (
        &["check", "ab_ll", "--fragments", "2", "--random-schedules", "1"],
        &["check", "ab_ll", "--fragments", "2", "--random", "1"],
        "--random ",
    ),
    (
        &["check", "ab_ll", "--fragments", "1", "--model", "relaxed"],
        &["check", "ab_ll", "--fragments", "1", "--model", "late"],
        "late:",
    ),
    (
        &["render", "ab_ll", "--shading", "unlit", "--scene", "builtin:cubes", "--size", "8x8", "--device", "cpu"],
        &["render", "ab_ll", "--shading", "flat", "--scene", "builtin:cubes", "--size", "8x8", "--device", "cpu"],
        "flat",
    ),
];

#[test]
fn former_flags_and_values_work_and_are_hidden() {
    let out = Path::new(env!("CARGO_TARGET_TMPDIR")).join("former.png");
    for (present, former, hidden) in FORMER {
        let run = |arguments: &[&str]| {
            let file: &[&str] = if arguments[0] == "render" { &["--out", out.to_str().unwrap()] } else { &[] };
            let output = fragbuf(&[arguments, file].concat());
            assert_eq!(output.status.code(), Some(0), "{arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
            (output.stdout, std::fs::read(&out).ok())
        };
        assert!(run(present) == run(former), "{former:?}");
        let help = fragbuf(&[present[0], "--help"]);
        let help = String::from_utf8_lossy(&help.stdout);
        assert!(help.contains("--") && !help.contains(hidden), "{hidden}: {help}");
    }
}

/// Descriptions may use former values of axes; messages and plans have the present ones.
#[test]
fn former_values_of_axes_work() {
    for (key, present, former) in [
        ("kb_mha", "storage=checksummed_array", concat!("storage=checked", "_array")),
        ("kb_multi", "storage=multipass_array", concat!("storage=repeated", "_array")),
        ("kplus_array", "opaque=early_depth", "opaque=early"),
    ] {
        let show = |set: &str| fragbuf(&["show", key, "--set", set, "--dump", "plan"]);
        let (present, former) = (show(present), show(former));
        assert_eq!(former.status.code(), Some(0), "{}", String::from_utf8_lossy(&former.stderr));
        assert!(!former.stdout.is_empty() && former.stdout == present.stdout, "{key}");
    }
}

/// Returns the greatest number of storage buffers that a generated source declares.
fn declared_buffers(folder: &Path) -> u64 {
    let files = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let sources = files.filter(|path| path.extension().is_some_and(|extension| extension == "wgsl"));
    let declared = sources.map(|path| std::fs::read_to_string(path).unwrap().matches(" var<storage").count() as u64);
    declared.max().unwrap()
}

/// The manifest lists limits, and two buffers in one shader are warned of if they exceed what every WebGPU device has.
#[test]
fn limits_of_several_buffers_in_a_shader_add_up() {
    let (near, far) = (folder("limits-near"), folder("limits-far"));
    let module = |key: &str, prefix: &str, out: &Path, others: usize| {
        let other = near.join("manifest.json");
        let group = if prefix == "near" { "1" } else { "2" };
        let mut arguments =
            vec!["generate", key, "--target", "wgsl", "--form", "module", "--prefix", prefix, "--group", group];
        for _ in 0..others {
            arguments.extend(["--with", other.to_str().unwrap()]);
        }
        arguments.extend(["--out", out.to_str().unwrap()]);
        let output = fragbuf(&arguments);
        assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
        String::from_utf8(output.stderr).unwrap()
    };
    assert_eq!(module("kplus_array", "near", &near, 0), "");
    let manifest: Value = serde_json::from_slice(&std::fs::read(near.join("manifest.json")).unwrap()).unwrap();
    let limit = |name: &str| {
        let limits = manifest["limits"].as_array().unwrap();
        limits.iter().find(|limit| limit["webgpu"] == name).unwrap_or_else(|| panic!("no {name} in {limits:?}")).clone()
    };
    let buffers = limit("maxStorageBuffersPerShaderStage")["needed"].as_u64().unwrap();
    assert_eq!(buffers, declared_buffers(&near.join("wgsl")));
    assert_eq!(limit("maxBindGroups")["needed"], 2);
    assert_eq!(limit("maxTextureDimension2D")["needed"], "max(width, height)");
    assert!(limit("maxStorageBufferBindingSize")["needed"].as_str().unwrap().contains("pixels"));
    assert_eq!(module("kplus_array", "far", &far, 1).is_empty(), 2 * buffers <= 8);
    let warning = module("kplus_array", "far", &far, 4);
    assert!(warning.contains(&format!("`maxStorageBuffersPerShaderStage` of {}", 5 * buffers)), "{warning}");
    let usage =
        fragbuf(&["generate", "kb", "--target", "wgsl", "--with", "Cargo.toml", "--out", far.to_str().unwrap()]);
    assert_eq!(usage.status.code(), Some(2), "{}", String::from_utf8_lossy(&usage.stderr));
}
