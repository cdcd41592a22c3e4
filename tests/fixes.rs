//! Fixes of mistakes on the command line and of choices that do not fit: each is given as the user gave the mistake, and is sufficient.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use fragbuf::load::{Description, load};
use fragbuf::{Diagnostic, Registry};

fn fragbuf(arguments: &[&str], folder: &Path) -> Output {
    Command::new(env!("CARGO_BIN_EXE_fragbuf")).args(arguments).current_dir(folder).output().unwrap()
}

fn stderr(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

fn folder(name: &str) -> PathBuf {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join("fixes").join(name);
    let _ = std::fs::remove_dir_all(&path);
    std::fs::create_dir_all(&path).unwrap();
    path
}

fn diagnostics(description: &Description, set: &[(&str, &str)]) -> Vec<Diagnostic> {
    let set: Vec<(String, String)> =
        set.iter().map(|(name, value)| ((*name).to_owned(), (*value).to_owned())).collect();
    load(description, &set, &[], &Registry::builtin())
        .variant
        .err()
        .iter()
        .flat_map(|errors| errors.iter().cloned())
        .collect()
}

fn technique(key: &str) -> Description {
    Description::Technique(key.to_owned())
}

fn text(text: &str) -> Description {
    Description::Text { file: "case.fragbuf".to_owned(), text: text.to_owned() }
}

/// Returns the parts in backquotes.
fn codes(help: &str) -> Vec<&str> {
    help.split('`').skip(1).step_by(2).collect()
}

/// Returns the assignments of `--set a=b` parts.
fn settings<'a>(parts: &[&'a str]) -> Vec<(&'a str, &'a str)> {
    parts.iter().filter_map(|part| part.strip_prefix("--set ")?.split_once('=')).collect()
}

/// A technique has no file, and a file has no effect on what `--set` overrides: the fix is an option, which works.
#[test]
fn what_the_command_line_gives_is_changed_there() {
    for (key, set, fix) in [
        ("kplus_array", ("k", "all"), "--set k=8"),
        ("z_buffer", ("k", "8"), "--set k=1"),
        ("kb_sr", ("k", "3"), "--set k=2"),
        ("kb_ab_ll", ("k", "all"), "--set k=8"),
        ("ab_ll", ("k", "8"), "--set k=all"),
        ("kplus_array", ("sync", "none"), "--set sync=spin_lock"),
    ] {
        let errors = diagnostics(&technique(key), &[set]);
        let [error] = errors.as_slice() else { panic!("{key} {set:?}: {errors:#?}") };
        let all = codes(&error.help);
        assert!(all.contains(&fix), "{error}");
        assert!(!error.help.contains("keep "), "{error}");
        let fixed: Vec<(&str, &str)> = std::iter::once(set).chain(settings(&[fix])).collect();
        assert_eq!(diagnostics(&technique(key), &fixed[fixed.len() - 1..]), [], "{error}");
    }
    // The file is right where `--set` does not override it.
    let file = text("buffer B from kplus_array {\n    keep all;\n}");
    assert_eq!(codes(&diagnostics(&file, &[])[0].help)[0], "keep 8;");
    let file = text("buffer B from kplus_array {\n    keep 8;\n}");
    assert_eq!(codes(&diagnostics(&file, &[("k", "all")])[0].help)[0], "--set k=8");
}

#[test]
fn the_key_of_a_technique_is_no_value_of_an_axis() {
    for (axis, value, expected) in [
        ("storage", "kplus_array", "--set storage=max_array"),
        ("storage", "ab_ll", "--set storage=linked_list"),
        ("peeling", "k_peeling", "--set peeling=k_layers"),
        ("sync", "kb_ps", "--set sync=interlock"),
    ] {
        let errors = diagnostics(&technique("kplus_array"), &[(axis, value)]);
        let [error] = errors.as_slice() else { panic!("{errors:#?}") };
        assert!(error.help.starts_with(&format!("`{value}` is a technique")), "{error}");
        assert!(codes(&error.help).contains(&expected), "{error}");
    }
    let errors = diagnostics(&text("buffer B {\n    storage: kplus_array;\n    keep 8;\n}"), &[]);
    assert!(errors[0].help.contains("`storage: max_array`"), "{}", errors[0]);
    let errors = diagnostics(&technique("kplus_array"), &[("cull", "ab_ll")]);
    assert!(errors[0].help.contains("`buffer B from ab_ll`"), "{}", errors[0]);
}

/// One error for one cause, and each of its fixes is sufficient.
#[test]
fn a_storage_that_does_not_fit_is_one_error() {
    for (key, storage) in [("k_peeling", "linked_list"), ("k_peeling", "exact_regions"), ("kplus_array", "linked_list")]
    {
        let given = ("storage", storage);
        let errors = diagnostics(&technique(key), &[given]);
        let [error] = errors.as_slice() else { panic!("{key} {storage}: {errors:#?}") };
        let (single, several): (Vec<&str>, Vec<&str>) =
            error.help.split(", or ").partition(|way| !way.contains(" and "));
        assert!(!several.is_empty() || key != "k_peeling", "{error}");
        for way in several {
            let set: Vec<(&str, &str)> = std::iter::once(given).chain(settings(&codes(way))).collect();
            assert!(set.len() > 2, "{error}");
            assert_eq!(diagnostics(&technique(key), &set), [], "{way}\n{error}");
        }
        for other in single.iter().flat_map(|way| settings(&codes(way))) {
            let set: Vec<(&str, &str)> = if other.0 == given.0 { vec![other] } else { vec![given, other] };
            assert_eq!(diagnostics(&technique(key), &set), [], "{other:?}\n{error}");
        }
    }
    let errors = diagnostics(&technique("k_peeling"), &[("storage", "linked_list")]);
    let labels: Vec<&str> = errors[0].labels.iter().map(|label| label.text.as_str()).collect();
    assert!(labels.iter().any(|label| label.starts_with("`peeling: k_layers` requires")), "{labels:?}");
}

/// An error in the closure of the effect does not move other errors about the effect to the first line. What a closure with errors needs is
/// unknown, so that it may be interrupted.
#[test]
fn errors_about_an_effect_stay_at_its_closure() {
    let of = |technique: &str, closure: &str| -> Vec<(usize, String)> {
        let file = text(&format!("buffer B from {technique} {{\n\n    resolve |fragments| {{ {closure} }}\n}}"));
        let errors = diagnostics(&file, &[]).into_iter().filter(|error| error.code.name == "missing-capability");
        errors.map(|error| (error.span.line as usize, error.message)).collect()
    };
    let right = "let mut a = 0.0; for f in fragments { a += f.depth; } vec4(a, a, a, 1.0)";
    let joined = of("dual_ll", right);
    assert!(!joined.is_empty() && joined.iter().all(|(line, _)| *line == 3), "{joined:?}");
    assert_eq!(of("k_peeling", right), []);
    assert_eq!(of("k_peeling", "vec4(fragments[0].depth, 0.0, 0.0, 1.0)").len(), 1);
    for wrong in ["vec4(fragments[0].depth, 0, 0.0, 1.0)", "vec4(fragments[0].depth, 0.0 0.0, 1.0)", "nothing"] {
        assert_eq!((of("dual_ll", wrong), of("k_peeling", wrong)), (joined.clone(), Vec::new()), "{wrong}");
    }
}

/// An effect that needs all fragments at once is an error where it needs them, for each reason.
#[test]
fn what_cannot_be_interrupted_is_marked() {
    let cases = [
        ("vec4(0.0, 0.0, 0.0, 1.0)", "no loop", 1),
        ("if true {\nfor f in fragments { return f.color; } } vec4(0.0, 0.0, 0.0, 1.0)", "inside of another block", 2),
        (
            "for f in fragments { return f.color; }\nfor f in fragments { return f.color; } vec4(0.0, 0.0, 0.0, 1.0)",
            "second loop",
            2,
        ),
        (
            "let mut a = 0.0;\nfor f in fragments.iter().rev() { a += f.depth; } vec4(a, a, a, 1.0)",
            "begins at the farthest",
            2,
        ),
        (
            "let mut a = 0.0;\nfor f in fragments { a += f.depth;\na -= fragments[1].depth; } vec4(a, a, a, 1.0)",
            "by its index",
            3,
        ),
        (
            "let mut a = 0.0;\nfor f in fragments { a += f.depth; }\na /= fragments.len() as f32; vec4(a, a, a, 1.0)",
            "their number",
            3,
        ),
        (
            "let mut a = 0.0;\nif a > 1.0 { return vec4(a, a, a, 1.0); }\nfor f in fragments { a += f.depth; } vec4(a, a, a, 1.0)",
            "before its loop",
            2,
        ),
    ];
    for (closure, reason, line) in cases {
        for technique in ["k_peeling", "f2b_ll", "f2b"] {
            let file = text(&format!("buffer B from {technique} {{ resolve |fragments| {{ {closure} }} }}"));
            let errors = diagnostics(&file, &[]);
            let [error] = errors.as_slice() else { panic!("{closure}: {errors:?}") };
            assert!(error.message.contains(reason), "{closure}: {error}");
            assert_eq!(error.span.line as usize, line, "{closure}: {error}");
        }
        assert_eq!(
            diagnostics(&text(&format!("buffer B from ab_ll {{ resolve |fragments| {{ {closure} }} }}")), &[]),
            [],
            "{closure}"
        );
    }
}

#[test]
fn a_user_file_is_found_by_its_path_and_its_name() {
    let folder = folder("files");
    let example = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/user_storage/first_k.wgsl");
    std::fs::copy(example, folder.join("first_k.wgsl")).unwrap();
    let inner = folder.join("inner");
    std::fs::create_dir(&inner).unwrap();
    let description = "buffer B {\n    storage: linked_list;\n    keep 8;\n    select: on_resolve;\n}\n";
    std::fs::write(folder.join("b.fragbuf"), description).unwrap();
    std::fs::write(folder.join("c.fragbuf"), "buffer C {\n    storage: first_k;\n    keep 8;\n}\n").unwrap();
    let show = |folder: &Path, description: &str, storage: &str| {
        let set = format!("storage={storage}");
        fragbuf(&["show", description, "--set", &set, "--set", "select=on_store"], folder)
    };
    // An absolute path is one relative to the current folder.
    let absolute = folder.join("first_k.wgsl").display().to_string();
    for (from, description) in [(&folder, "b.fragbuf"), (&inner, "../b.fragbuf")] {
        for path in [absolute.clone(), format!("wgsl({absolute})"), format!("wgsl(\"{absolute}\")")] {
            let output = show(from, description, &path);
            assert!(output.status.success(), "{path}: {}", stderr(&output));
            assert!(!String::from_utf8_lossy(&output.stdout).contains(folder.to_str().unwrap()), "{path}");
        }
    }
    // A name without `.wgsl`.
    let error = stderr(&show(&folder, "b.fragbuf", "first_k"));
    assert!(error.contains("for the file `first_k.wgsl`, write `--set storage=first_k.wgsl`"), "{error}");
    let error = stderr(&fragbuf(&["show", "c.fragbuf"], &folder));
    assert!(error.contains("for the file `first_k.wgsl`, write `storage: wgsl(\"first_k.wgsl\")`"), "{error}");
    let error = stderr(&show(&inner, "../b.fragbuf", "first_k"));
    assert!(!error.contains("for the file"), "{error}");
    // In a file, paths are relative to it.
    std::fs::write(
        folder.join("d.fragbuf"),
        format!("buffer D {{\n    storage: wgsl(\"{absolute}\");\n    keep 8;\n}}\n"),
    )
    .unwrap();
    let error = stderr(&fragbuf(&["show", "d.fragbuf"], &folder));
    assert!(
        error.contains("expected a path relative to the description")
            && error.contains("`storage: wgsl(\"first_k.wgsl\");`"),
        "{error}"
    );
}

#[test]
fn the_depth_of_opaque_surfaces_needs_a_scene() {
    let folder = folder("opaque");
    let render = |set: &str| {
        let view = ["--scene", "builtin:cubes", "--size", "8x8", "--device", "cpu", "--out", "o.png"];
        fragbuf(&[&["render", "kplus_array", "--set", set], &view[..]].concat(), &folder)
    };
    for value in ["early_depth", "in_shader"] {
        let output = render(&format!("opaque={value}"));
        let error = stderr(&output);
        assert_eq!(output.status.code(), Some(2), "{error}");
        assert!(error.contains(&format!("`opaque: {value}` reads the external texture `opaque`")), "{error}");
        assert!(error.contains("`--opaque builtin:cubes`") && error.contains("`--set opaque=none`"), "{error}");
    }
    assert!(render("opaque=none").status.success());
}

/// Numbers have their nouns in the singular and the plural.
#[test]
fn one_is_singular() {
    let folder = folder("one");
    let render = |more: &[&str]| {
        let view =
            ["--scene", "builtin:layers,n=6", "--camera", "clip", "--size", "1x1", "--device", "cpu", "--out", "o.png"];
        stderr(&fragbuf(&[&["render"], more, &view[..]].concat(), &folder))
    };
    let error = render(&["k_peeling", "--set", "k=1", "--set", "peeling.iterations=1"]);
    assert!(error.contains("stopped at its limit of 1 iteration: "), "{error}");
    let error = render(&["k_peeling", "--set", "k=1", "--set", "peeling.iterations=2"]);
    assert!(error.contains("stopped at its limit of 2 iterations: "), "{error}");
    let error = render(&["ab_array", "--set", "sort.layers=5"]);
    assert!(error.contains("1 fragment lost: layers_exceeded"), "{error}");
    let show = |size: &str, fragments: &str| {
        let output = fragbuf(&["show", "ab_ll", "--size", size, "--fragments", fragments], &folder);
        String::from_utf8(output.stdout).unwrap()
    };
    assert!(show("16x16", "1").contains(", 1 fragment per pixel"), "{}", show("16x16", "1"));
    assert!(show("16x16", "2").contains(", 2 fragments per pixel"));
}

/// No limit has its name twice, although APIs share some names.
#[test]
fn a_limit_has_each_name_once() {
    let output = fragbuf(&["show", "kplus_array", "--size", "640x480"], &folder("limits"));
    let text = String::from_utf8(output.stdout).unwrap();
    let limits = text.lines().skip_while(|line| *line != "limits").filter(|line| line.contains("max"));
    for line in limits.clone() {
        let names: Vec<&str> = line.split([' ', ',']).filter(|word| word.starts_with("max")).collect();
        assert!(names.iter().enumerate().all(|(at, name)| !names[..at].contains(name)), "{line}");
    }
    assert!(limits.clone().count() > 1, "{text}");
}

/// Help repeats what the user gave: no name is left to fill in.
#[test]
fn help_has_the_names_of_the_command() {
    let folder = folder("names");
    let shader = "override SIZE: u32;\n@compute @workgroup_size(1)\nfn tally() { var n = SIZE; n += 1u; }\n";
    std::fs::write(folder.join("own.wgsl"), shader).unwrap();
    let error = stderr(&fragbuf(&["render", "own.wgsl", "--scene", "builtin:cubes", "--out", "o.png"], &folder));
    assert!(error.contains("`fragbuf check --wgsl own.wgsl --entry tally`"), "{error}");
    let error = stderr(&fragbuf(&["check", "--wgsl", "own.wgsl", "--entry", "tally"], &folder));
    assert!(error.contains("`--override SIZE=1`"), "{error}");
    let error = stderr(&fragbuf(&["generate", "kb", "--target", "wgsl", "--out", "-"], &folder));
    assert!(error.contains("`fragbuf show kb --dump wgsl`"), "{error}");
}
