//! Runs techniques in every language that this device accepts: the linked WGSL of both profiles, and the generated SPIR-V and GLSL
//! (compiled by glslang) passed through. Images and kept sets are equal bit by bit.

use std::process::Command;

use fragbuf_codegen::{EntryPoint, Form, Linking, Stage, link, plan};
use fragbuf_model::Variant;
use fragbuf_runtime::{Checks, Code, Module, Renderer, Settings, Shaders};
use fragbuf_targets::{Request, generate, target};
use fragbuf_templates::Registry;
use fragbuf_templates::vocabulary::Feature;

use crate::capture::{GLASS_KEEPS, glass, scattered, set_uniforms};
use crate::stage::{device, render_frame, renderer, settings, shaders, technique};

/// Returns the compiled files of the target `glsl-vulkan`.
pub fn glsl_shaders(variant: &Variant) -> Shaders {
    let targets = [target("glsl-vulkan").unwrap()];
    let request = Request { targets: &targets, form: Form::Program, prefix: "", group: 0 };
    let generation =
        generate(variant, &request, &Registry::builtin()).unwrap_or_else(|diagnostics| panic!("{diagnostics}"));
    let modules = generation.files.iter().map(|file| {
        let (stage, name) = file.entry_points[0].clone();
        let (stage, suffix) = match stage {
            "vertex" => (Stage::Vertex, "vert"),
            "fragment" => (Stage::Fragment, "frag"),
            _ => (Stage::Compute, "comp"),
        };
        let code = Code::SpirV(glslang(&file.bytes, suffix));
        Module { pass: file.pass.clone(), entry_points: vec![EntryPoint { name, stage }], code }
    });
    let plan = generation.plans[0].plan.clone();
    Shaders { modules: modules.collect(), functions: Vec::new(), plan, group: 0, profile: targets[0].profile }
}

/// Links a program without generating files.
fn linked(variant: &Variant, name: &str) -> Shaders {
    let (target, registry) = (target(name).unwrap(), Registry::builtin());
    let selection = variant.select(&[target.provides, &[Feature::OwnEntryPoints]].concat()).unwrap();
    let plan = plan(variant, &selection, &registry).unwrap_or_else(|diagnostics| panic!("{diagnostics}"));
    let linking = Linking { profile: target.profile, form: Form::Program, prefix: String::new(), group: 0 };
    let program = link(&plan, &linking, &registry).unwrap_or_else(|diagnostics| panic!("{diagnostics}"));
    Shaders::from_program(&plan, &program)
}

/// Compiles one stage with `glslangValidator`, which must be installed.
fn glslang(code: &[u8], stage: &str) -> Vec<u32> {
    let folder = tempfile::tempdir().unwrap();
    let (source, binary) = (folder.path().join(format!("shader.{stage}")), folder.path().join("shader.spv"));
    std::fs::write(&source, code).unwrap();
    let mut command = Command::new("glslangValidator");
    command.args(["-V", "--target-env", "vulkan1.1", "-o"]).arg(&binary).arg(&source);
    let output = command.output().expect("`glslangValidator` is needed: install the package glslang-tools");
    assert!(output.status.success(), "{}\n{}", String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(code));
    let bytes = std::fs::read(&binary).unwrap();
    bytes.chunks_exact(4).map(|word| u32::from_le_bytes(word.try_into().unwrap())).collect()
}

/// Checks that every language gives the results of portable WGSL.
fn check(variant: &Variant, prepare: impl Fn(&mut Renderer)) {
    check_in(variant, "wgsl", prepare);
}

/// Checks that every language gives the results of the WGSL of the target `first`.
fn check_in(variant: &Variant, first: &str, prepare: impl Fn(&mut Renderer)) {
    let stage = device();
    let languages = [
        (first, shaders(variant, first), Checks::Off),
        ("a linked program", linked(variant, first), Checks::Off),
        ("WGSL, checked at run time", shaders(variant, first), Checks::On),
        ("wgsl-native", shaders(variant, "wgsl-native"), Checks::Off),
        ("spirv", shaders(variant, "spirv"), Checks::Off),
        ("glsl-vulkan", glsl_shaders(variant), Checks::Off),
    ];
    let mut expected = Vec::new();
    for (index, (name, shaders, checks)) in languages.into_iter().enumerate() {
        let settings = Settings { checks, ..settings() };
        let mut renderer = renderer(&stage, &shaders, &settings).unwrap_or_else(|error| panic!("{name}: {error}"));
        prepare(&mut renderer);
        for seed in 0..4 {
            let seen = render_frame(&stage, &mut renderer, &scattered(8, seed));
            if index == 0 {
                expected.push(seen);
                continue;
            }
            let expected = &expected[seed as usize];
            assert_eq!(seen.kept, expected.kept, "{name}");
            assert_eq!(seen.counters, expected.counters, "{name}");
            assert_eq!(seen.pixels, expected.pixels, "{name}");
        }
    }
    let colors = expected.iter().flat_map(|seen| &seen.pixels);
    assert!(colors.clone().any(|color| Some(color) != colors.clone().next()), "the images are not empty");
}

#[test]
fn the_array_with_the_worst_at_slot_0() {
    check(&technique("kplus_array", &[("k", "3"), ("counters", "all")]), |_| {});
}

#[test]
fn the_sorted_array() {
    check(&technique("kb", &[("k", "3"), ("counters", "all")]), |_| {});
}

#[test]
fn the_linked_list() {
    check(&technique("ab_ll", &[("counters", "all")]), |_| {});
}

#[test]
fn exact_regions() {
    check(&technique("ab_sb", &[("counters", "all")]), |_| {});
}

#[test]
fn minima_links_ranges_and_slots_without_a_lock() {
    for key in ["kb_mdt32", "kb_ll", "kplus_array_revised", "kplus_ab_sb"] {
        check(&technique(key, &[("k", "3"), ("counters", "all")]), |_| {});
    }
    check_in(&technique("kb_mdt64", &[("k", "3"), ("counters", "all")]), "wgsl-native", |_| {});
    // The software driver has no interlock.
    check(&technique("depth_partition", &[("k", "3"), ("counters", "all"), ("sync", "spin_lock")]), |_| {});
}

#[test]
fn targets_and_textures() {
    check(&technique("z_buffer", &[("counters", "all"), ("fragment.color", "rgba16")]), |_| {});
    check(&technique("kb_sr", &[("counters", "all")]), |_| {});
}

#[test]
fn overflow_rows() {
    let set = |row| [("overflow", row), ("k", "2"), ("cull", "none"), ("counters", "all")];
    for row in ["tail_blend", "merge_last"] {
        check(&technique("kplus_array", &set(row)), |_| {});
    }
    check(&technique("kb", &[&set("merge_closest")[..], &[("sync", "spin_lock")]].concat()), |_| {});
}

#[test]
fn user_functions() {
    check(&glass("kplus_array", GLASS_KEEPS), set_uniforms);
}
