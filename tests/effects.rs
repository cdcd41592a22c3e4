//! The effects of `render --effect`: rows, descriptions and references agree, and the command draws each with its defaults.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use serde_json::Value;

use crate::browser::effects::EFFECTS;

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn fragbuf(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_fragbuf")).args(arguments).current_dir(root()).output().unwrap()
}

/// Draws an effect in a small frame on the CPU device. Returns the statistics and what is on stderr.
fn drawn(name: &str, options: &[&str]) -> (Value, String) {
    let out = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(format!("effect-{name}.png"));
    let command =
        ["render", "--effect", name, "--size", "48x27", "--device", "cpu", "--json", "--out", out.to_str().unwrap()];
    let output = fragbuf(&[&command, options].concat());
    let errors = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success(), "{name}: {errors}");
    (serde_json::from_slice(&output.stdout).unwrap(), errors)
}

/// The names that `list --effects` prints.
fn listed() -> BTreeSet<String> {
    let output = fragbuf(&["list", "--effects"]);
    let text = String::from_utf8(output.stdout).unwrap();
    let rows = text.lines().skip(2).map(|line| line.split('`').nth(1).unwrap().to_owned());
    rows.collect()
}

#[test]
fn every_effect_has_a_row_a_description_and_a_reference() {
    let files = std::fs::read_dir(root().join("examples/effects")).unwrap();
    let files: BTreeSet<String> =
        files.map(|file| file.unwrap().path().file_stem().unwrap().to_str().unwrap().to_owned()).collect();
    let references: BTreeSet<String> = EFFECTS.iter().map(|effect| effect.name.to_owned()).collect();
    assert_eq!((&listed(), &listed()), (&files, &references));
    for name in files {
        let text = std::fs::read_to_string(root().join(format!("examples/effects/{name}.fragbuf"))).unwrap();
        for head in ["// Source: ", "// Needs: ", "// Works over "] {
            assert!(text.contains(head), "{name}: {head}");
        }
    }
}

/// The defaults of an effect suffice: no warning, no loss, nothing missing.
#[test]
fn every_effect_is_drawn_with_its_defaults() {
    for name in listed() {
        let (found, errors) = drawn(&name, &[]);
        assert!(!errors.contains("warning") && !errors.contains("error"), "{name}: {errors}");
        assert_eq!(
            (&found["effect"]["name"], &found["effect"]["missing"]),
            (&name.clone().into(), &0.into()),
            "{name}"
        );
        assert_eq!(found["lost"]["total"], 0, "{name}");
    }
}

/// A k that is too small is a warning, with the number of fragments that are missing.
#[test]
fn fragments_that_an_effect_reads_and_a_buffer_does_not_keep_are_counted() {
    let storage = ["--set", "storage=cascade", "--set", "samples=one", "--set"];
    let with_k = |k| drawn("transparency", &[&storage[..], &[k]].concat());
    let (one, warned) = with_k("k=1");
    let fragments = &one["fragments"];
    let rejected = fragments["generated"].as_u64().unwrap() - fragments["stored"].as_u64().unwrap();
    assert!(rejected > 0 && one["effect"]["missing"] == rejected, "{one}");
    assert!(warned.contains(&format!("k = 1 is too small: {rejected} fragments are not kept")), "{warned}");
    let (many, warned) = with_k("k=64");
    assert!(many["effect"]["missing"] == 0 && !warned.contains("too small"), "{warned}");
}

#[test]
fn an_unknown_effect_is_an_error_with_the_nearest_name() {
    let output = fragbuf(&["render", "--effect", "transparancy", "--out", "x.png"]);
    let errors = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(2));
    assert!(errors.contains("did you mean `transparency`?"), "{errors}");
    let output = fragbuf(&["render", "kb", "--effect", "transparency", "--out", "x.png"]);
    let errors = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.code() == Some(2) && errors.contains("cannot be used with"), "{errors}");
}

/// Options of the command line replace those of the effect, also where both have a value of one name.
#[test]
fn options_replace_those_of_an_effect() {
    let image = |options: &[&str]| {
        let command =
            ["render", "--effect", "transparency", "--size", "32x18", "--device", "cpu", "--linear", "--out", "-"];
        let output = fragbuf(&[&command, options].concat());
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        output.stdout
    };
    let whole = image(&[]);
    assert!(whole != image(&["--uniform", "alpha=0.9"]) && whole != image(&["--scene=builtin:cubes"]));
    assert!(whole == image(&["--set", "storage=exact_regions"]));
}

/// The guide's table is that of `list --effects`. `INSTA_UPDATE=always` updates it.
#[test]
fn the_guide_has_every_effect_with_its_arguments() {
    let path = root().join("src/guide/effects.md");
    let guide = std::fs::read_to_string(&path).unwrap();
    let (before, rest) = guide.split_once("| effect |").unwrap();
    let (_, after) = rest.split_once("|\n\n").unwrap();
    let table = String::from_utf8(fragbuf(&["list", "--effects"]).stdout).unwrap();
    let computed = format!("{before}{table}\n{after}");
    if std::env::var("INSTA_UPDATE").is_ok_and(|update| update == "always") {
        std::fs::write(&path, &computed).unwrap();
    }
    assert!(guide == computed, "src/guide/effects.md has another table: run the test with INSTA_UPDATE=always");
}
