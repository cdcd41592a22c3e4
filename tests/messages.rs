//! Tests of messages: suggestions, warnings, their formats, and the section of the guide about each code.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use fragbuf::load::{Description, load, variant};
use fragbuf::{Diagnostic, Form, Registry, Request, Severity, TARGETS, generate, guide};
use fragbuf_model::codes;
use fragbuf_templates::COUNTERS;
use serde_json::Value;

fn fragbuf(arguments: &[&str], folder: &Path) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_fragbuf"));
    command.args(arguments).current_dir(folder).env_remove("NO_COLOR").output().unwrap()
}

fn folder(name: &str) -> PathBuf {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join("messages").join(name);
    let _ = std::fs::remove_dir_all(&path);
    std::fs::create_dir_all(&path).unwrap();
    path
}

const REQUEST: Request<'_> = Request { targets: &[&TARGETS[0]], form: Form::Program, prefix: "", group: 0 };

fn stderr(output: &Output) -> String {
    String::from_utf8(output.stderr.clone()).unwrap()
}

/// Returns the errors, or the warnings of a valid description.
fn found(text: &str) -> Vec<Diagnostic> {
    let text = Description::Text { file: "case.fragbuf".to_owned(), text: text.to_owned() };
    let found = match variant(&text, &[], &Registry::builtin()) {
        Ok(variant) => variant.warnings.clone(),
        Err(errors) => errors,
    };
    found.iter().cloned().collect()
}

/// Returns the help of the only diagnostic.
fn help(text: &str) -> String {
    let found = found(text);
    let [only] = found.as_slice() else { panic!("{text}: {found:?}") };
    only.help.clone()
}

#[test]
fn letters_in_the_wrong_order_are_suggested() {
    let with = |line: &str| format!("buffer B from ab_ll {{\n    {line}\n}}");
    for (line, nearest) in [
        ("srot: insertion;", "`sort`"),
        ("sort: insertoin;", "`insertion`"),
        ("uniform { heat: f32 } where |f, u| f.depth < u.haet;", "`heat`"),
        ("where |f| f.detph < 0.5;", "`depth`"),
        ("where |f| f.depth.sqtr() < 0.5;", "`sqrt`"),
        ("fn half(x: f32) -> f32 { 0.5 * x } where |f| hlaf(f.depth) < half(1.0);", "`half`"),
        ("where |f| { let near = f.depth; naer < near };", "`near`"),
    ] {
        let help = help(&with(line));
        assert!(help.contains(&format!("did you mean {nearest}?")), "{line}: {help}");
    }
}

#[test]
fn names_of_other_shading_languages_have_their_rust_names() {
    let with = |line: &str| format!("buffer B from kplus_array {{\n    {line}\n}}");
    for (line, expected) in [
        ("fragment { color: rgba8, depth: f32, id: i32 } ties: attribute { by: color };", "write `u32`"),
        ("fragment { color: rgba8, depth: float }", "write `f32`"),
        ("fragment { color: float4, depth: f32 }", "write `vec4`"),
        ("fragment { color: rgba, depth: f32 }", "write `rgba8`"),
        ("uniform { cut: float } where |f, u| f.depth < u.cut;", "write `f32`"),
        ("uniform { cut: mat4 } where |f, u| f.depth < u.cut.x;", "one `vec4` per column"),
        ("fn f(x: float) -> f32 { 0.5 } where |f| f.depth < 0.5;", "write `f32`"),
        ("where |f| f.depth.saturate() < 0.5;", "`f.depth.clamp(0.0, 1.0)`"),
        ("where |f| saturate(f.depth) < 0.5;", "`f.depth.clamp(0.0, 1.0)`"),
        ("where |f| smoothstep(0.1, 0.2, f.depth) < 0.5;", "t * t * (3.0 - 2.0 * t)"),
        ("where |f| mix(0.1, 0.2, f.depth) < 0.5;", "(0.1 + (0.2 - 0.1) * f.depth)"),
        ("where |f| lerp(0.1, 0.2, f.depth) < 0.5;", "(0.1 + (0.2 - 0.1) * f.depth)"),
        ("where |f| float(2) < f.depth;", "(2 as f32)"),
        ("where |f| float3(1.0, 2.0, 3.0).x < f.depth;", "`vec3(1.0, 2.0, 3.0)`"),
        ("where |f| clamp(f.depth, 0.0, 1.0) < 0.5;", "`f.depth.clamp(0.0, 1.0)`"),
        ("where |f| texture(f.depth) < 0.5;", "declare `texture { lut: 2d }`"),
        ("where |f| f.color.rgb.x < 0.5;", ".xyz()"),
        ("where |f| f.color.a < 0.5;", "`.w`"),
        ("where |f| gl_FragCoord.x < f.depth;", "position of the pixel"),
        ("where |f| f.depth < PI;", "std::f32::consts::PI"),
    ] {
        let found = found(&with(line));
        assert!(found[0].help.contains(expected), "{line}: {}", found[0]);
    }
}

#[test]
fn syntax_of_other_shading_languages_has_its_rust_syntax() {
    let with = |line: &str| format!("buffer B from kplus_array {{\n    {line}\n}}");
    for (line, expected) in [
        ("where |f| { let mut i = 0; i++; f.depth < 1.0 };", "write `i += 1`"),
        ("where |f| { let mut i = 2; i--; f.depth < 1.0 };", "write `i -= 1`"),
        ("where |f| { float x = 1.0; f.depth < x };", "declare variables with `let x = …;`"),
        ("where |f| { var x = 1.0; f.depth < x };", "declare variables with `let x = …;`"),
        ("where |f| { for (int i = 0; i < 4; i++) { } f.depth < 0.5 };", "write `for i in 0..4 { … }`"),
        ("where |f| f.depth < 1.0f;", "write the suffix `f32` or none"),
        ("uniform heat: float;", "write `uniform { heat: f32 }`"),
        ("uniform float heat;", "write `uniform { heat: f32 }`"),
        ("fragment vec3 normal;", "write `fragment { normal: vec3, depth: f32 }`"),
        ("sort = none;", "`sort: …;`"),
        ("sort none;", "`sort: …;`"),
    ] {
        let help = help(&with(line));
        assert!(help.contains(expected), "{line}: {help}");
    }
    assert_eq!(found(&with("where |f| { let x = - -f.depth; x < 0.5 };")), []);
    let ternary = found(&with("where |f| f.depth < 0.5 ? true : false;"));
    assert!(ternary[0].help.contains("`if f.depth < 0.5 { true } else { false }`"), "{ternary:?}");
}

/// Every code has a section in the guide with its meaning, cause and fix; its example has this diagnostic, and `explain` prints it.
#[test]
fn every_code_is_explained() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let storage = std::fs::read_to_string(root.join("examples/user_storage/first_k.wgsl")).unwrap();
    let folder = folder("explained");
    for code in codes::ALL {
        let section = guide::explanation(code.name).unwrap_or_else(|| panic!("no section about {}", code.name));
        assert!(section.contains(&format!("\n\n{}\n\n*Cause:* ", code.meaning)), "{section}");
        assert!(section.contains("\n\n*Fix:* "), "{section}");
        let printed = fragbuf(&["explain", code.name], root);
        assert_eq!(String::from_utf8(printed.stdout).unwrap(), section);
        let example = |language: &str| {
            let start = section.split(&format!("```{language}\n")).nth(1)?;
            Some(start.split("```").next().unwrap().to_owned())
        };
        let description = folder.join("example.fragbuf");
        match (example("fragbuf"), example("wgsl")) {
            (Some(text), _) => std::fs::write(&description, text).unwrap(),
            (None, Some(line)) => {
                std::fs::write(folder.join("mine.wgsl"), with_line(&storage, line.trim_end())).unwrap();
                let text = "buffer B from ab_ll {\n    storage: wgsl(\"mine.wgsl\");\n    keep 8;\n}";
                std::fs::write(&description, text).unwrap();
            }
            (None, None) => {
                assert!(
                    [codes::INVALID_ENCODING, codes::UNSUPPORTED_TARGET, codes::INTERNAL, codes::UNUSED_EFFECT]
                        .contains(code),
                    "{section}"
                );
                continue;
            }
        }
        let read = Description::read(&description).unwrap();
        let registry = Registry::builtin();
        let loaded = load(&read, &[], &[], &registry).variant;
        let found = match loaded.map(|variant| (variant.warnings.clone(), generate(&variant, &REQUEST, &registry))) {
            Ok((warnings, Ok(_))) => warnings,
            Ok((_, Err(errors))) | Err(errors) => errors,
        };
        assert!(found.iter().any(|found| found.code == *code), "{section}\n{found}");
    }
    for kind in fragbuf_scene::WarningKind::ALL {
        let section = guide::explanation(kind.code()).unwrap_or_else(|| panic!("no section about {}", kind.code()));
        assert!(section.contains("*Cause:* ") && section.contains("*Fix:* "), "{section}");
    }
    let models = include_str!("../src/guide/model_warnings.md").matches("\n## ").count();
    assert_eq!(models, fragbuf_scene::WarningKind::ALL.len(), "a section about no code");
    for (name, _, meaning) in COUNTERS {
        let section = guide::explanation(name).unwrap_or_else(|| panic!("no section about {name}"));
        assert!(section.contains(&format!("\n\n{meaning}\n\n*Cause:* ")), "{section}");
        assert!(section.contains("\n\n*Fix:* "), "{section}");
        let printed = fragbuf(&["explain", name], root);
        assert_eq!(String::from_utf8(printed.stdout).unwrap(), section);
    }
    let counters = include_str!("../src/guide/counters.md").matches("\n## ").count();
    assert_eq!(counters, COUNTERS.len(), "a section about no counter");
    let list = String::from_utf8(fragbuf(&["explain"], root).stdout).unwrap();
    assert!(list.contains("\nequal_keys ") && list.contains("\ntimed_out "), "{list}");
    assert!(list.contains("\nnot-read ") && list.contains("\nmissing-attribute "), "{list}");
    let copied = fragbuf(&["explain", "warning[not-read]: x.obj:3: textures are not read"], root);
    assert!(copied.status.success());
    let near = stderr(&fragbuf(&["explain", "not-raed"], root));
    assert!(near.contains("not-read"), "{near}");
    let sections = include_str!("../src/guide/codes.md").matches("\n## ").count();
    assert_eq!(sections, codes::ALL.len(), "a section about no code");
    let unknown = fragbuf(&["explain", "unknwon-axis"], root);
    assert_eq!(unknown.status.code(), Some(2));
    assert!(stderr(&unknown).contains("did you mean `unknown-axis`?"), "{}", stderr(&unknown));
    let copied = fragbuf(&["explain", "error[unknown-axis]"], root);
    assert!(copied.status.success() && copied.stdout.starts_with(b"## `unknown-axis`"));
    let list = String::from_utf8(fragbuf(&["explain"], root).stdout).unwrap();
    // Descriptions and models share two codes.
    assert_eq!(list.lines().count(), codes::ALL.len() + models - 2 + COUNTERS.len());
}

/// Replaces the line that has the longest beginning in common with `line`.
fn with_line(source: &str, line: &str) -> String {
    let common = |other: &str| other.chars().zip(line.chars()).take_while(|(a, b)| a == b).count();
    let replaced = source.lines().max_by_key(|other| common(other)).unwrap();
    source.replace(&format!("{replaced}\n"), &format!("{line}\n"))
}

const UNUSED: &str = "\
buffer B from kplus_array {
    fragment { color: rgba8, depth: f32, id: u32, normal: octahedral }
    uniform { cut: f32, far: f32 }
    fn half(x: f32) -> f32 { 0.5 * x }
    fn quarter(x: f32) -> f32 { half(half(x)) }
    where |f, u| { let near = f.depth; let mut last = 0.0; last = 1.0; let _kept = 2.0; f.depth < u.far };
}
";

#[test]
fn what_nothing_uses_is_a_warning() {
    let found = found(UNUSED);
    let places: Vec<_> = found.iter().map(|found| (found.code.name, found.span.line, found.span.column)).collect();
    assert_eq!(
        places,
        [
            ("unused-attribute", 2, 42),
            ("unused-attribute", 2, 51),
            ("unused-uniform", 3, 15),
            ("unused-function", 4, 8),
            ("unused-function", 5, 8),
            ("unused-variable", 6, 24),
            ("unused-variable", 6, 48),
        ],
        "{found:?}"
    );
    assert!(found.iter().all(|found| found.severity() == Severity::Warning && !found.help.is_empty()));
}

/// A choice reads attributes: an effect by name, ties by an option, a user file by its WGSL. The payload of a technique is not the user's.
#[test]
fn what_a_choice_uses_is_no_warning() {
    for text in [
        "buffer B from kplus_array { }",
        "buffer B from kplus_array {\n    resolve |fragments, u| { vec4(fragments[0].depth, 0.0, 0.0, 1.0) }\n}",
        "buffer B from kplus_array {\n    fragment { color: rgba8, depth: f32 }\n}",
        "buffer B from kplus_array {\n    fragment { color: rgba8, depth: f32, id: u32 }\n    ties: attribute { by: id };\n}",
        "buffer B from kplus_array {\n    fragment { color: rgba8, depth: f32 }\n    overflow: tail_blend;\n    resolve |fragments, u| { vec4(fragments[0].depth, 0.0, 0.0, 1.0) }\n}",
    ] {
        assert_eq!(found(text).iter().filter(|found| found.severity() == Severity::Warning).count(), 0, "{text}");
    }
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples");
    for entry in std::fs::read_dir(&folder).unwrap().map(|entry| entry.unwrap().path()) {
        if entry.extension().is_some_and(|extension| extension == "fragbuf") {
            let output = fragbuf(&["show", entry.to_str().unwrap()], &folder);
            assert_eq!(stderr(&output), "", "{}", entry.display());
        }
    }
}

#[test]
fn warnings_are_printed_once_as_text_or_json() {
    let folder = folder("warned");
    std::fs::write(folder.join("glass.fragbuf"), UNUSED).unwrap();
    let output = fragbuf(&["show", "glass.fragbuf"], &folder);
    assert_eq!(output.status.code(), Some(0));
    let text = stderr(&output);
    assert_eq!(text.matches("warning[unused-").count(), 7, "{text}");
    assert!(text.contains("warning[unused-attribute]") && text.contains("glass.fragbuf:2:42"), "{text}");
    let output = fragbuf(&["show", "glass.fragbuf", "--message-format", "json"], &folder);
    let lines: Vec<Value> = stderr(&output).lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    assert_eq!(lines.len(), 7);
    let first = &lines[0];
    assert_eq!((&first["severity"], &first["code"]), (&"warning".into(), &"unused-attribute".into()));
    assert_eq!((&first["file"], &first["line"], &first["column"]), (&"glass.fragbuf".into(), &2.into(), &42.into()));
    let error = fragbuf(&["show", "kplus_aray", "--message-format", "json"], &folder);
    let error: Value = serde_json::from_str(stderr(&error).trim()).unwrap();
    assert_eq!((&error["severity"], &error["code"]), (&"error".into(), &"unknown-technique".into()));
    // The shader of module form may read attributes.
    let out = folder.join("out");
    let module = ["generate", "glass.fragbuf", "--target", "wgsl", "--form", "module", "--out", out.to_str().unwrap()];
    let text = stderr(&fragbuf(&module, &folder));
    assert!(!text.contains("unused-attribute") && text.contains("unused-uniform"), "{text}");
}

#[test]
fn messages_have_colours_on_request() {
    let folder = folder("colours");
    let said = |arguments: &[&str]| stderr(&fragbuf(&[&["show", "kplus_aray"], arguments].concat(), &folder));
    let plain = said(&[]);
    assert!(!plain.contains('\x1b'), "stderr is no terminal: {plain}");
    assert_eq!(said(&["--message-color", "never"]), plain);
    let colored = said(&["--message-color", "always"]);
    assert!(colored.contains("\x1b[1;31merror[unknown-technique]"), "{colored:?}");
    let mut without = colored.clone();
    while let Some(start) = without.find('\x1b') {
        let end = start + without[start..].find('m').unwrap();
        without.replace_range(start..=end, "");
    }
    assert_eq!(without, plain);
}

#[test]
fn a_file_that_is_not_utf8_has_a_code_and_a_place() {
    let folder = folder("encoding");
    std::fs::write(folder.join("latin1.fragbuf"), b"buffer B from ab_ll {\n    // caf\xe9\n}\n").unwrap();
    let output = fragbuf(&["show", "latin1.fragbuf"], &folder);
    let text = stderr(&output);
    assert_eq!(output.status.code(), Some(1), "{text}");
    assert!(text.contains("error[invalid-encoding]: the byte 0xe9") && text.contains("latin1.fragbuf:2:11"), "{text}");
    std::fs::write(folder.join("mine.wgsl"), b"//: storage -- f\xfcr\n").unwrap();
    std::fs::write(folder.join("own.fragbuf"), "buffer B from ab_ll {\n    storage: wgsl(\"mine.wgsl\");\n}").unwrap();
    let text = stderr(&fragbuf(&["show", "own.fragbuf"], &folder));
    assert!(text.contains("error[invalid-encoding]: the byte 0xfc") && text.contains("mine.wgsl:1:17"), "{text}");
    let wgsl = fragbuf(&["check", "--wgsl", "mine.wgsl", "--entry", "main"], &folder);
    assert!(stderr(&wgsl).contains("mine.wgsl:1:17") && wgsl.status.code() == Some(1), "{}", stderr(&wgsl));
}

#[test]
fn arguments_that_are_nearly_right_have_suggestions() {
    let folder = folder("arguments");
    let render = ["render", "kb", "--out", "x.png"];
    for (arguments, expected) in [
        (vec!["generate", "kb", "--target", "glls", "--out", "x"], "no target `glls`: did you mean `glsl`?"),
        (vec!["show", "kb", "--dump", "wglsl"], "no stage `wglsl`: did you mean `wgsl`?"),
        (vec!["check", "kb", "--target", "spriv"], "no target `spriv`: did you mean `spirv`?"),
        ([&render[..], &["--scene", "cubes"]].concat(), "did you mean the scene `builtin:cubes`?"),
        ([&render[..], &["--scene", "marbels,n=3"]].concat(), "did you mean the scene `builtin:marbles`?"),
        ([&render[..], &["--scene", "builtin:marbels"]].concat(), "did you mean `builtin:marbles`?"),
        (
            [&render[..], &["--scene", "builtin:cubes", "--uniform", "strength"]].concat(),
            "a uniform of the description",
        ),
        (
            vec!["render", "kb", "--scene", "builtin:cubes", "--out", "x.jpg"],
            "images are written as PNG: write `x.png`",
        ),
        (
            [&["render", "kb", "--out", "-"], &["--scene", "builtin:cubes", "--json"][..]].concat(),
            "both write to stdout",
        ),
        (vec!["compare", "kb", "ab_ll", "--scene", "builtin:cubes", "--out", "-"], "prints measurements on stdout"),
    ] {
        let output = fragbuf(&arguments, &folder);
        let text = stderr(&output);
        assert!(output.status.code() == Some(2) && text.contains(expected), "{arguments:?}: {text}");
    }
    assert_eq!(std::fs::read_dir(&folder).unwrap().count(), 0, "nothing is written");
}

#[test]
fn an_image_goes_to_stdout() {
    let folder = folder("stdout");
    let view = ["--scene", "builtin:cubes", "--size", "16x8", "--device", "cpu"];
    let to = |out: &str| fragbuf(&[&["render", "kplus_array", "--out", out], &view[..]].concat(), &folder);
    let (written, printed) = (to("image.PNG"), to("-"));
    assert!(written.status.success() && printed.status.success(), "{}", stderr(&printed));
    assert!(printed.stdout.starts_with(b"\x89PNG"));
    assert_eq!(printed.stdout, std::fs::read(folder.join("image.PNG")).unwrap());
}

/// A target that does not support the description is an error, which names targets that do.
#[test]
fn a_target_without_support_is_an_error() {
    let folder = folder("support");
    for arguments in [
        &["show", "kb_mdt64", "--dump", "glsl-es"][..],
        &["generate", "kb_mdt64", "--target", "glsl-es,wgsl", "--out", "out"],
    ] {
        let output = fragbuf(arguments, &folder);
        let text = stderr(&output);
        assert!(output.status.code() == Some(1) && output.stdout.is_empty(), "{arguments:?}: {text}");
        assert!(text.contains("error[unsupported-target]") && text.contains("glsl-es"), "{text}");
        assert!(text.contains("choose a target that supports it (") && text.contains("spirv"), "{text}");
    }
    assert!(!folder.join("out").exists());
    // The help names what works alone: no target supports modules with render targets of their own.
    let module = ["generate", "z_buffer", "--target", "wgsl", "--form", "module", "--out", "out"];
    let text = stderr(&fragbuf(&module, &folder));
    assert!(text.contains("choose `--form program`") && !text.contains("a target that supports it"), "{text}");
    let separate = ["generate", "kplus_array", "--target", "spirv", "--form", "module", "--out", "out"];
    let text = stderr(&fragbuf(&separate, &folder));
    assert!(text.contains("supports it (wgsl") && text.contains("`--form program`"), "{text}");
    assert!(!text.contains("--group"), "{text}");
}

#[test]
fn files_of_an_earlier_run_are_reported_and_removed() {
    let folder = folder("stale");
    let out = folder.join("out");
    let generate = |target: &str, more: &[&str]| {
        let arguments = ["generate", "kb", "--target", target, "--out", out.to_str().unwrap()];
        let output = fragbuf(&[&arguments, more].concat(), &folder);
        assert!(output.status.success(), "{}", stderr(&output));
        stderr(&output)
    };
    assert_eq!(generate("wgsl,glsl", &[]), "");
    assert_eq!(generate("wgsl,glsl", &[]), "", "every file is written again");
    std::fs::write(out.join("glsl/notes.txt"), "mine").unwrap();
    let warning = generate("wgsl", &[]);
    assert!(warning.contains("files of earlier runs") && warning.contains("--clean"), "{warning}");
    assert!(out.join("glsl").is_dir());
    // The manifest still lists them.
    assert_eq!(generate("wgsl", &["--clean"]), "");
    assert_eq!(std::fs::read_dir(out.join("glsl")).unwrap().count(), 1);
    assert_eq!(generate("wgsl,glsl", &[]), "");
    assert_eq!(generate("wgsl", &["--clean"]), "");
    let left: Vec<_> = std::fs::read_dir(out.join("glsl")).unwrap().map(|entry| entry.unwrap().file_name()).collect();
    assert_eq!(left, ["notes.txt"], "only listed files are removed");
    assert_eq!(generate("glsl", &["--clean"]), "");
    assert!(!out.join("wgsl").exists());
}

#[test]
fn the_list_fits_a_terminal() {
    let folder = folder("list");
    let list = String::from_utf8(fragbuf(&["list"], &folder).stdout).unwrap();
    let long: Vec<&str> = list.lines().filter(|line| line.chars().count() > 80).collect();
    assert!(long.is_empty(), "{long:?}");
    for technique in Registry::builtin().techniques() {
        assert!(list.lines().any(|line| line.starts_with(&format!("{} ", technique.key))), "{list}");
    }
    let wide = String::from_utf8(fragbuf(&["list", "--wide"], &folder).stdout).unwrap();
    assert_eq!(wide.lines().count(), 1 + Registry::builtin().techniques().len());
    assert_eq!(fragbuf(&["list", "--wide", "--json"], &folder).status.code(), Some(2));
}

#[test]
fn completions_and_manual_pages_have_every_command() {
    let folder = folder("manual");
    for shell in ["bash", "elvish", "fish", "powershell", "zsh"] {
        let output = fragbuf(&["completions", shell], &folder);
        let script = String::from_utf8(output.stdout).unwrap();
        assert!(output.status.success() && script.contains("render") && script.contains("random-schedules"), "{shell}");
    }
    let page = String::from_utf8(fragbuf(&["man"], &folder).stdout).unwrap();
    assert!(page.contains(".TH fragbuf 1") && page.contains("render"), "{page}");
    assert!(fragbuf(&["man", "--out", "pages"], &folder).status.success());
    for page in ["fragbuf.1", "fragbuf-render.1", "fragbuf-explain.1"] {
        assert!(folder.join("pages").join(page).is_file(), "no {page}");
    }
}

/// An unsupported target is reported at what requires the feature, and every fix works: other targets, and alternatives after `else`.
#[test]
fn an_unsupported_target_points_to_its_cause() {
    let folder = folder("cause");
    let write = |items: &str, technique: &str| {
        std::fs::write(folder.join("b.fragbuf"), format!("buffer B from {technique} {{\n    {items}\n}}\n")).unwrap();
    };
    let show = |arguments: &[&str]| fragbuf(&[&["show", "b.fragbuf"], arguments].concat(), &folder);
    // An axis: the choice, and the value after `else` that makes it work.
    write("sync: interlock;", "kplus_array");
    let text = stderr(&show(&["--dump", "wgsl"]));
    assert!(text.contains("b.fragbuf:2:11") && text.contains("`sync: interlock else spin_lock;`"), "{text}");
    write("sync: interlock else spin_lock;", "kplus_array");
    assert!(show(&["--dump", "wgsl"]).status.success());
    // The count of fragments: no axis is named, because another value does not help.
    write("keep 8;", "kb_sr");
    let text = stderr(&show(&["--dump", "wgsl"]));
    assert!(text.contains("b.fragbuf:2:10") && text.contains("choose a target that supports it ("), "{text}");
    let output = fragbuf(&["check", "b.fragbuf", "--target", "wgsl"], &folder);
    let text = stderr(&output);
    assert!(
        output.status.code() == Some(1) && text.contains("b.fragbuf:2:10") && text.contains("wgsl: `storage"),
        "{text}"
    );
    // The preset.
    write("keep 8;", "kb_mdt64");
    let text = stderr(&show(&["--dump", "wgsl"]));
    assert!(text.contains("b.fragbuf:1:15") && !text.contains("add an `else`"), "{text}");
    // A technique has no file: the change is an option, which works.
    let text = stderr(&fragbuf(&["check", "kplus_array", "--target", "wgsl", "--set", "sync=interlock"], &folder));
    assert!(text.contains("--set:1:1") && text.contains("--set \"sync=interlock else spin_lock\""), "{text}");
    let followed = ["show", "kplus_array", "--dump", "wgsl", "--set", "sync=interlock else spin_lock"];
    assert!(fragbuf(&followed, &folder).status.success());
}

/// An option of another command is named with its commands, and the value of a uniform with the commands that set it.
#[test]
fn an_option_of_another_command_is_named() {
    let folder = folder("commands");
    let text = stderr(&fragbuf(&["check", "kb", "--uniform", "cut=1"], &folder));
    assert!(text.contains("`--uniform` is an option of `render`, `compare`"), "{text}");
    assert!(!text.contains("a similar argument") && !text.contains("-- --uniform"), "{text}");
    let text = stderr(&fragbuf(&["check", "kb", "--set", "uniform.cut=1"], &folder));
    assert!(text.contains("sets it in `render` and `compare`, and `check` chooses values itself"), "{text}");
}

/// The plan counts words in the singular and the plural.
#[test]
fn one_word_of_a_plan_is_singular() {
    let plan = String::from_utf8(fragbuf(&["show", "kplus_array", "--dump", "plan"], &folder("plan")).stdout).unwrap();
    assert!(!plan.contains("(1 words)") && plan.contains(" words)"), "{plan}");
}
