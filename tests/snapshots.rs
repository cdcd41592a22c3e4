//! Snapshots of plans and sources, for one case per technique and for difficult ones.

use fragbuf::{Form, Registry, Request, TARGETS, generate, target};

use crate::cases::{checked, generated, named};

#[test]
fn plans_and_wgsl() {
    for (name, description, set) in named() {
        let variant = checked(&description, &set).unwrap_or_else(|diagnostics| panic!("{name}: {diagnostics}"));
        let generation = generated(&variant);
        for planned in &generation.plans {
            let targets: Vec<&str> = planned.targets.iter().map(|target| target.name).collect();
            insta::assert_snapshot!(format!("{name}.plan.{}", targets[0]), planned.plan);
        }
        for file in generation.files.iter().filter(|file| file.target == "wgsl") {
            let text = String::from_utf8(file.bytes.clone()).unwrap();
            insta::assert_snapshot!(format!("{name}.{}.wgsl", file.pass), text);
        }
    }
}

#[test]
fn glsl() {
    for (case, passes) in [
        ("kplus_array", ["store", "resolve"]),
        ("custom", ["store", "resolve"]),
        ("ab_sb", ["scan_blocks", "store"]),
        ("interlock_else_lock", ["store", "store"]),
        ("occupancy_early", ["limit", "store"]),
    ] {
        let (_, description, set) = named().into_iter().find(|(name, ..)| *name == case).unwrap();
        let generation = generated(&checked(&description, &set).unwrap());
        for file in generation.files.iter().filter(|file| passes.contains(&file.pass.as_str())) {
            let is_vertex = file.entry_points.iter().any(|(stage, _)| *stage == "vertex");
            if file.target.starts_with("glsl") && !is_vertex {
                let text = String::from_utf8(file.bytes.clone()).unwrap();
                insta::assert_snapshot!(format!("{case}.{}.{}", file.pass, file.target), text);
            }
        }
    }
}

/// Snapshots what an engine depends on in SPIR-V. The ids change with every version of naga.
#[test]
fn spirv_summaries() {
    let cases: [(&str, &[&str]); 2] =
        [("kplus_array", &["reset", "store", "resolve"]), ("occupancy_early", &["limit", "store"])];
    for (case, passes) in cases {
        let (_, description, set) = named().into_iter().find(|(name, ..)| *name == case).unwrap();
        let generation = generated(&checked(&description, &set).unwrap());
        let wanted = |file: &&fragbuf::File| file.target == "spirv" && passes.contains(&file.pass.as_str());
        for file in generation.files.iter().filter(wanted) {
            let name = file.path.replace('/', ".");
            insta::assert_snapshot!(format!("{case}.{name}"), summary(&file.bytes));
        }
    }
}

fn summary(bytes: &[u8]) -> String {
    let path = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join("summary.spv");
    std::fs::write(&path, bytes).unwrap();
    let output = std::process::Command::new("spirv-dis").arg("--no-color").arg(&path).output();
    let output = output.unwrap_or_else(|error| panic!("spirv-dis must be installed (see README): {error}"));
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let kept = [
        "OpCapability",
        "OpExtension",
        "OpMemoryModel",
        "OpEntryPoint",
        "OpExecutionMode",
        " Binding ",
        " DescriptorSet ",
        " Coherent",
        " Location ",
        " BuiltIn ",
        "OpMemoryBarrier",
        "OpAtomic",
    ];
    let text = String::from_utf8(output.stdout).unwrap();
    let lines = text.lines().filter(|line| kept.iter().any(|word| line.contains(word))).map(str::trim);
    lines.map(without_ids).collect::<Vec<_>>().join("\n")
}

/// `%17` says nothing; `%keys` does.
fn without_ids(line: &str) -> String {
    let words = line.split_whitespace().map(|word| {
        let is_number = word.strip_prefix('%').is_some_and(|id| id.bytes().all(|byte| byte.is_ascii_digit()));
        if is_number { "%_" } else { word }
    });
    words.collect::<Vec<_>>().join(" ")
}

#[test]
fn module_form_with_a_prefix() {
    let (_, description, set) = named().into_iter().find(|(name, ..)| *name == "kplus_array").unwrap();
    let variant = checked(&description, &set).unwrap();
    let targets = [target("wgsl").unwrap(), target("glsl").unwrap()];
    let request = Request { targets: &targets, form: Form::Module, prefix: "glass", group: 2 };
    let generation = generate(&variant, &request, &Registry::builtin()).unwrap();
    for file in generation.files.iter().filter(|file| file.pass == "store") {
        let text = String::from_utf8(file.bytes.clone()).unwrap();
        insta::assert_snapshot!(format!("module.{}", file.path.replace('/', ".")), text);
    }
}

/// What a user's own test says, of a storage of the user's own.
#[test]
fn a_line_of_a_users_test() {
    fragbuf::assert_variant_snapshot!("examples/user_storage/first_k.fragbuf", targets = ["wgsl", "glsl"]);
}

#[test]
fn a_users_test_has_a_plan_and_a_text_for_each_target() {
    let texts = fragbuf::snapshot::texts("kb", &["wgsl", "glsl", "msl"]).unwrap();
    let names: Vec<&str> = texts.iter().map(|(name, _)| name.as_str()).collect();
    assert_eq!(names, ["kb.plan", "kb.wgsl", "kb.glsl", "kb.msl"]);
    assert!(texts[0].1.starts_with("plan Kb (kb)\n") && texts[1].1.starts_with("// ==== wgsl/reset.wgsl\n"));
}

#[test]
#[should_panic(expected = "error[missing-file]")]
fn a_users_test_of_a_description_with_mistakes_fails_with_the_report() {
    let path = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join("mistaken.fragbuf");
    std::fs::write(&path, "buffer B { storage: wgsl(\"no_such.wgsl\"); }").unwrap();
    fragbuf::assert_variant_snapshot!(path.to_str().unwrap(), targets = ["wgsl"]);
}

#[test]
fn a_users_test_of_what_is_no_text_is_told() {
    let said = |description, target| fragbuf::snapshot::texts(description, &[target]).unwrap_err();
    assert!(said("kb", "spirv").contains("wgsl, wgsl-native, glsl"));
    assert!(said("no/such.fragbuf", "wgsl").contains("no/such.fragbuf"));
}

/// Attachments, their formats and clear values, and the states of passes, in a manifest.
#[test]
fn manifest_of_textures() {
    for case in ["z_buffer", "kb_sr"] {
        let (_, description, set) = named().into_iter().find(|(name, ..)| *name == case).unwrap();
        let manifest = fragbuf::manifest(&generated(&checked(&description, &set).unwrap()), 0);
        let parts = ["resources", "steps", "unsupported"].map(|part| format!("{part}: {:#}", manifest[part]));
        insta::assert_snapshot!(format!("{case}.manifest"), parts.join("\n"));
    }
}

/// The manifest of one technique; the schema is a promise.
#[test]
fn manifest() {
    let (_, description, set) = named().into_iter().find(|(name, ..)| *name == "ab_sb").unwrap();
    let generation = generated(&checked(&description, &set).unwrap());
    insta::assert_snapshot!("ab_sb.manifest", format!("{:#}", fragbuf::manifest(&generation, 0)));
    assert_eq!(generation.plans[0].targets.len(), TARGETS.len());
}
