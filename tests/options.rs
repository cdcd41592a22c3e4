//! Tests the messages about options of the command line, and that every option is documented.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use fragbuf::Registry;
use fragbuf_model::{Format, UniformType};
use serde_json::Value;

fn fragbuf(arguments: &[&str], folder: &Path) -> Output {
    Command::new(env!("CARGO_BIN_EXE_fragbuf")).args(arguments).current_dir(folder).output().unwrap()
}

fn stderr(output: &Output) -> String {
    String::from_utf8(output.stderr.clone()).unwrap()
}

fn stdout(output: &Output) -> String {
    String::from_utf8(output.stdout.clone()).unwrap()
}

fn folder(name: &str) -> PathBuf {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join("options").join(name);
    let _ = std::fs::remove_dir_all(&path);
    std::fs::create_dir_all(&path).unwrap();
    path
}

#[test]
fn k_of_a_check_is_chosen_by_set_too_and_printed() {
    let folder = folder("k");
    let check = |more: &[&str]| {
        let output = fragbuf(&[&["check"], more, &["--fragments", "1"]].concat(), &folder);
        (output.status.code(), stdout(&output), stderr(&output))
    };
    let by_set = check(&["kplus_array", "--set", "k=2"]);
    assert_eq!(by_set, check(&["kplus_array", "--k", "2"]));
    assert!(by_set.0 == Some(0) && by_set.1.contains("(k = 2; "), "{by_set:?}");
    assert!(check(&["kplus_array"]).1.contains("(k = 1, 2, 3; "));
    let json: Value = serde_json::from_str(&check(&["kplus_array", "--json"]).1).unwrap();
    assert_eq!(json["k"], serde_json::json!([1, 2, 3]));
    // Where all fragments are kept there is no k.
    assert!(!check(&["ab_ll"]).1.contains("k = "));
    let (code, _, text) = check(&["ab_ll", "--k", "2"]);
    assert!(code == Some(0) && text.contains("`--k` has no effect"), "{text}");
    for (arguments, code, expected) in [
        (&["kb", "--set", "k=9"][..], 2, "k from 1 to 7 can be checked"),
        (&["kb", "--set", "k=2", "--k", "3"], 2, "`--k 3` and `--set k=2` differ"),
        (&["kb", "--set", "keep=4"], 1, "write `k=4`"),
        (&["kb", "--set", "k=all"], 1, "keep-mismatch"),
    ] {
        let (found, out, text) = check(arguments);
        assert!(found == Some(code) && out.is_empty() && text.contains(expected), "{arguments:?}: {text}");
    }
    // A description that keeps fewer fragments than `--k` is not checked for more.
    std::fs::write(folder.join("two.fragbuf"), "buffer Two from kplus_array { keep 2; }").unwrap();
    assert!(check(&["two.fragbuf"]).1.contains("(k = 1, 2; "));
    let (code, _, text) = check(&["two.fragbuf", "--k", "5"]);
    assert!(code == Some(1) && text.contains("k = 5 is more than the 2 fragments"), "{text}");
}

#[test]
fn changes_of_one_side_are_named_by_their_option() {
    let folder = folder("sides");
    let view = ["--scene", "builtin:cubes", "--size", "8x8", "--device", "cpu", "--out", "x.png"];
    for (option, first) in [("--set-first", 1), ("--set-second", 1), ("--set", 3)] {
        let set = ["--set", "k=3", "--set", "cull=early", option, "sort=foo"];
        let output = fragbuf(&[&["compare", "kplus_array", "kplus_heap"], &set[..], &view].concat(), &folder);
        let text = stderr(&output);
        assert!(output.status.code() == Some(1) && text.contains(&format!("{option}:{first}:1")), "{option}: {text}");
        assert!(text.contains(&format!("{first} │ sort=foo")), "{option}: {text}");
    }
}

#[test]
fn values_below_zero_have_advice_that_works() {
    let folder = folder("negative");
    let render = ["render", "kb", "--scene", "builtin:cubes", "--out", "x.png"];
    for (option, value, then) in [
        ("--camera", "-1,2", "write auto, clip, orbit"),
        ("--background", "-1,0,0,1", "each from 0 to 1"),
        ("--size", "-3x4", "write WIDTHxHEIGHT"),
        ("--uniform", "-1", "write name=value"),
    ] {
        let output = fragbuf(&[&render[..], &[option, value]].concat(), &folder);
        let advice = format!("{option}={value}");
        let text = stderr(&output);
        assert!(output.status.code() == Some(2) && text.contains(&format!("write `{advice}`")), "{text}");
        assert!(!text.contains("'-- -"), "{text}");
        let followed = fragbuf(&[&render[..], &[&advice]].concat(), &folder);
        assert!(stderr(&followed).contains(then), "{}", stderr(&followed));
    }
    let text = stderr(&fragbuf(&["check", "kb", "--k", "-1"], &folder));
    assert!(text.contains("write `--k=-1`"), "{text}");
    for (size, expected) in
        [("0x0", "1 pixel or more"), ("8x0", "1 pixel or more"), ("8", "as 640x480"), ("99999999999x1", "at most")]
    {
        let text = stderr(&fragbuf(&[&render[..], &["--size", size]].concat(), &folder));
        assert!(text.contains(expected), "{size}: {text}");
    }
}

#[test]
fn names_of_devices_and_codes_are_found_in_any_case() {
    let folder = folder("names");
    let render = ["render", "kb", "--scene", "builtin:cubes", "--size", "8x8", "--out", "x.png", "--device"];
    for device in ["cpu", "CPU", "Cpu"] {
        let output = fragbuf(&[&render[..], &[device]].concat(), &folder);
        assert_eq!((output.status.code(), stderr(&output).as_str()), (Some(0), ""), "{device}");
    }
    let near = stderr(&fragbuf(&["explain", "unkown-axis"], &folder));
    assert_eq!(near, "error: no diagnostic or counter `unkown-axis`: did you mean `unknown-axis`?\n");
    let far = stderr(&fragbuf(&["explain", "foo"], &folder));
    assert_eq!(far, "error: no diagnostic or counter `foo`: `fragbuf explain` lists the codes and counters\n");
    let slabs = ["render", "kb", "--size", "8x8", "--out", "x.png", "--scene"];
    for (scene, expected) in [
        ("builtin:slabs,n", "`n` has no value: write a whole number from 1 to 65536, as `n=16`"),
        ("builtin:slabs,n=x", "`n` has `x`: write a whole number"),
        ("builtin:slabs,m=2", "has no `m`: its parameters are n (16)"),
    ] {
        let output = fragbuf(&[&slabs[..], &[scene]].concat(), &folder);
        assert!(output.status.code() == Some(2) && stderr(&output).contains(expected), "{}", stderr(&output));
    }
}

/// No device is selected for a command that fails in any case.
#[test]
fn a_certain_failure_is_reported_before_a_device() {
    let folder = folder("device");
    let text = "buffer B from kb {\n    fragment { color: rgba8, depth: f32, id: f32 }\n    where |f| f.id > 0.0;\n}";
    std::fs::write(folder.join("id.fragbuf"), text).unwrap();
    let view = ["--scene", "builtin:cubes", "--size", "8x8", "--out", "x.png"];
    for (arguments, expected) in [
        (&["render", "kb", "--uniform", "x=1"][..], "has no uniform `x`"),
        (&["render", "id.fragbuf"], "has no `id: f32`"),
        (&["render", "kb", "--attribute", "heat=1"], "has no attribute `heat`"),
        (&["compare", "kb", "id.fragbuf"], "has no `id: f32`"),
    ] {
        let text = stderr(&fragbuf(&[arguments, &view].concat(), &folder));
        assert!(text.contains(expected) && !text.contains("rendering on"), "{arguments:?}: {text}");
    }
}

#[test]
fn an_empty_image_names_the_uniforms_that_are_zero() {
    let folder = folder("empty");
    let text = "buffer B from kb {\n    uniform { near: f32, far: f32, tint: vec3 }\n    \
        where |f, u| f.depth > u.near && f.depth < u.far * u.tint.x;\n}";
    std::fs::write(folder.join("b.fragbuf"), text).unwrap();
    let render = |uniforms: &[&str]| {
        let view =
            ["render", "b.fragbuf", "--scene", "builtin:cubes", "--size", "8x8", "--device", "cpu", "--out", "x.png"];
        stderr(&fragbuf(&[&view[..], uniforms].concat(), &folder))
    };
    assert!(
        render(&[]).contains("the uniforms `near`, `far`, `tint` are 0 unless `--uniform` sets them"),
        "{}",
        render(&[])
    );
    let one = render(&["--uniform", "near=2", "--uniform", "tint=1,0,0"]);
    assert!(one.contains("constraints; the uniform `far` is 0 unless"), "{one}");
    let none = render(&["--uniform", "near=2", "--uniform", "tint=1,0,0", "--uniform", "far=3"]);
    assert!(none.contains("the image is empty: check the camera and the `where` constraints\n"), "{none}");
    let drawn = render(&["--uniform", "tint=1,0,0", "--uniform", "far=3"]);
    let unset = "warning: b.fragbuf: the uniform `near` has no value and is 0: set it with `--uniform near=NUMBER`\n";
    assert_eq!(drawn, unset);
    assert_eq!(render(&["--uniform", "tint=1,0,0", "--uniform", "far=3", "--uniform", "near=0"]), "");
}

/// An image that is empty for another reason than the camera has a warning with that reason, and the option to change.
#[test]
fn an_empty_image_has_the_reason_that_the_frame_tells() {
    let folder = folder("empty-reason");
    let render = |description: &str, options: &[&str]| {
        let view = ["--scene", "builtin:cubes", "--size", "8x8", "--device", "cpu", "--out", "x.png"];
        stderr(&fragbuf(&[&["render", description], &view[..], options].concat(), &folder))
    };
    let peeled = render("f2b", &["--set", "peeling.iterations=1"]);
    assert!(!peeled.contains("check the camera"), "{peeled}");
    assert!(peeled.contains("f2b: the image is empty, because the frame is incomplete: "), "{peeled}");
    assert!(peeled.contains("; raise the limit with `--set peeling.iterations=2` (at most 4096)\n"), "{peeled}");
    assert!(peeled.contains(" fragments lost: not_converged; `fragbuf explain not_converged` "), "{peeled}");
    let text = "buffer B from ab_ll {\n    resolve |fragments, u| Vec4::ZERO;\n}";
    std::fs::write(folder.join("clear.fragbuf"), text).unwrap();
    let clear = render("clear.fragbuf", &["--set", "counters=all"]);
    assert!(clear.contains(" met the constraints: the effect gives every pixel the alpha 0\n"), "{clear}");
    let away = render("ab_ll", &["--set", "counters=all", "--camera", "eye:0,0,900,target:0,0,1800"]);
    assert!(away.contains("the image is empty: check the camera\n"), "{away}");
}

/// Every command that reads uniforms names those that the description reads and nothing sets, once.
#[test]
fn uniforms_without_a_value_are_warnings() {
    let folder = folder("unset");
    let text = "buffer B from kb {\n    uniform { near: f32, tint: vec3, spare: vec2 }\n    \
        where |f, u| f.depth > u.near - u.tint.x;\n}";
    std::fs::write(folder.join("b.fragbuf"), text).unwrap();
    let run = |command: &[&str], options: &[&str]| {
        let scene = ["--scene", "builtin:cubes", "--size", "8x8", "--device", "cpu"];
        let output = fragbuf(&[command, &scene[..], options].concat(), &folder);
        assert!(output.status.success(), "{}", stderr(&output));
        stderr(&output)
    };
    let both = "b.fragbuf: the uniforms `near`, `tint` have no values and are 0: set them with \
        `--uniform near=NUMBER --uniform tint=X,Y,Z`\n";
    let frames = ["render", "b.fragbuf", "--out", "x.png", "--frames", "2", "--json"];
    for command in [&["predict", "b.fragbuf"][..], &["compare", "kb", "b.fragbuf", "--out", "x.png"], &frames] {
        assert_eq!(run(command, &[]).matches(both).count(), 1, "{command:?}");
        let found = run(command, &["--uniform", "near=0", "--uniform", "tint=0,0,0"]);
        assert!(!found.contains("no value"), "{command:?}: {found}");
    }
}

/// A value that an option takes only behind `=` is explained, wherever the parser found that it is one too many.
#[test]
fn a_value_without_its_equals_sign_is_explained() {
    let folder = folder("equals");
    let scene = ["--scene", "builtin:cubes", "--device", "cpu"];
    for (before, after, tip) in [
        (&["render", "ab_ll", "--out", "x.png"][..], &["--presort", "farthest"][..], "--presort=farthest"),
        (&["render", "--presort", "farthest", "ab_ll"], &["--out", "x.png"], "--presort=farthest"),
        (&["predict", "kplus_array"], &["--coplanarity", "heat.png"], "--coplanarity=heat.png"),
        (&["predict", "--coplanarity", "heat.png"], &["kplus_array"], "--coplanarity=heat.png"),
    ] {
        let output = fragbuf(&[before, &scene[..], after].concat(), &folder);
        let (option, value) = tip.split_once('=').unwrap();
        assert_eq!(output.status.code(), Some(2));
        let expected = format!("to give `{value}` to `{option}`, write `{tip}`");
        assert!(stderr(&output).contains(&expected), "{}", stderr(&output));
    }
    let other = stderr(&fragbuf(&[&["render", "ab_ll", "kb", "--presort"], &scene[..]].concat(), &folder));
    assert!(!other.contains("to give"), "{other}");
}

/// Files for other targets are no waste: the warning says how to keep them. `--clean` removes folders that become empty.
#[test]
fn files_for_other_targets_can_be_kept() {
    let folder = folder("targets");
    let generate = |arguments: &[&str]| {
        let output = fragbuf(&[&["generate"], arguments, &["--out", "out"]].concat(), &folder);
        assert!(output.status.success(), "{}", stderr(&output));
        stderr(&output)
    };
    generate(&["kb", "--target", "wgsl,spirv"]);
    let warning = generate(&["kb", "--target", "glsl"]);
    assert!(warning.contains("those for wgsl, spirv are complete only if"), "{warning}");
    assert!(warning.contains("`--target wgsl,glsl,spirv`, or each in its own folder"), "{warning}");
    assert_eq!(generate(&["kb", "--target", "wgsl,glsl,spirv"]), "");
    // Other files of the same target.
    let warning =
        generate(&["ab_ll", "--target", "wgsl,glsl,spirv", "--form", "program", "--set", "sort=backwards_memory"]);
    assert!(!warning.contains("complete only if"), "{warning}");
    generate(&["kb", "--target", "wgsl,glsl,spirv", "--clean"]);
    // A technique that no target of the run supports.
    let unsupported = folder.join("out/kb_mdt64");
    for notes in [None, Some("mine")] {
        generate(&["--all", "--target", "glsl"]);
        assert!(unsupported.join("manifest.json").exists());
        notes.iter().for_each(|text| std::fs::write(unsupported.join("notes.txt"), text).unwrap());
        let warning = generate(&["--all", "--target", "glsl-es"]);
        let begin = format!("warning: {} has ", Path::new("out").join("kb_mdt64").display());
        assert!(warning.lines().any(|line| line.starts_with(&begin)), "{warning}");
        assert!(unsupported.join("manifest.json").exists(), "nothing is removed without `--clean`");
        generate(&["--all", "--target", "glsl-es", "--clean"]);
        let left = std::fs::read_dir(&unsupported).map(|left| left.map(|entry| entry.unwrap().file_name()).collect());
        let left: Vec<_> = left.unwrap_or_default();
        assert_eq!(left, notes.iter().map(|_| "notes.txt").collect::<Vec<_>>(), "only listed files are removed");
        assert_eq!(unsupported.exists(), notes.is_some());
    }
    assert!(folder.join("out/ab_ll/manifest.json").exists());
}

/// Buffers in one shader need different names, and different bindings.
#[test]
fn buffers_of_one_shader_have_different_names() {
    let folder = folder("names-of-buffers");
    let generate = |form: &str, prefix: &str, group: &str, with: &[&str], out: &str| {
        let arguments = ["generate", "kb", "--target", "wgsl", "--form", form, "--prefix", prefix, "--group", group];
        fragbuf(&[&arguments, with, &["--out", out]].concat(), &folder)
    };
    assert!(generate("module", "near", "1", &[], "near").status.success());
    let manifest: Value = serde_json::from_slice(&std::fs::read(folder.join("near/manifest.json")).unwrap()).unwrap();
    assert_eq!(manifest["prefix"], "near");
    let with = ["--with", "near/manifest.json"];
    for (form, prefix, group, expected) in [
        ("module", "near", "1", "also has the prefix `near` and the bind group 1"),
        ("program", "near", "1", "also has the prefix `near` and the bind group 1"),
        ("module", "near", "2", "also has the prefix `near`, so both declare"),
    ] {
        let output = generate(form, prefix, group, &with, "far");
        let text = stderr(&output);
        assert!(output.status.code() == Some(2) && text.contains(expected), "{prefix} {group}: {text}");
        assert!(!folder.join("far").exists(), "nothing is written");
    }
    let output = generate("module", "far", "1", &with, "far");
    assert!(output.status.success() && stderr(&output).contains("also has the bind group 1"), "{}", stderr(&output));
    let output = generate("module", "far", "2", &with, "far");
    assert_eq!((output.status.code(), stderr(&output).as_str()), (Some(0), ""));
    // OpenGL has no groups.
    let glsl =
        ["generate", "kb", "--target", "glsl", "--form", "module", "--prefix", "far", "--group", "2", "--out", "glsl"];
    let output = fragbuf(&[&glsl[..], &with[..]].concat(), &folder);
    let text = stderr(&output);
    assert!(output.status.success() && text.contains("`glShaderStorageBlockBinding`"), "{text}");
}

/// The README's synopsis has every option of every command.
#[test]
fn the_readme_has_every_option() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let readme = std::fs::read_to_string(root.join("README.md")).unwrap();
    let synopsis = readme.split("\n## Use\n").nth(1).unwrap().split("```").nth(1).unwrap();
    let of = |command: &str| -> String {
        let lines = synopsis.split("\nfragbuf ").filter(|line| line.starts_with(command));
        lines.collect::<Vec<_>>().join("\n")
    };
    let mut count = 0;
    for command in [
        "new",
        "list",
        "show",
        "check",
        "language",
        "explain",
        "generate",
        "render",
        "compare",
        "devices",
        "predict",
        "completions",
    ] {
        let help = stdout(&fragbuf(&[command, "--help"], root));
        let options = help.lines().filter_map(|line| line.trim_start().trim_start_matches("-h, ").strip_prefix("--"));
        for option in options.map(|line| line.split([' ', '=', '[']).next().unwrap()) {
            let is_of_every_command = ["help", "message-format", "message-color"].contains(&option);
            // `compare` has the options of `render`.
            let text = if command == "compare" { of("compare") + &of("render") } else { of(command) };
            assert!(is_of_every_command || text.contains(&format!("--{option}")), "{command} --{option}: {text}");
            count += 1;
        }
    }
    assert!(count > 60, "{count}");
}

/// The guide lists every item, format, type and axis of the language.
#[test]
fn the_guide_describes_every_item() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let guide = std::fs::read_to_string(root.join("src/guide/describe.md")).unwrap();
    let items = guide.split("\n# Every item\n").nth(1).unwrap().split("\n# ").next().unwrap();
    let keywords =
        ["buffer", "from", "fragment", "uniform", "keep", "all", "least", "where", "resolve", "fn", "else", "wgsl("];
    for word in
        keywords.into_iter().chain(Format::ALL.map(Format::keyword)).chain(UniformType::ALL.map(UniformType::keyword))
    {
        assert!(items.contains(word), "{word}");
    }
    for axis in Registry::builtin().axes().iter().filter(|axis| axis.chosen) {
        assert!(items.contains(&format!("`{}`", axis.key)), "{}", axis.key);
    }
    let axes = stdout(&fragbuf(&["list", "--axes"], root));
    assert!(axes.contains("The axis `storage` has no default"), "{axes}");
    for row in Registry::builtin().rows().iter().filter(|row| axes.contains(&format!("| `{}` |", row.key))) {
        for parameter in &row.parameters {
            assert!(
                axes.contains(&format!("`{}: {}`", parameter.name, parameter.default)),
                "{} {}",
                row.key,
                parameter.name
            );
        }
    }
}
