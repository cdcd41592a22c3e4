//! Mistakes of callers, files and devices. Each is an error that says what is wrong and what to do.

use std::process::Command;

use fragbuf_templates::Registry;
use fragbuf_vulkan_host::{Context, Error, Host, Object, Scene, Settings, Validation};
use serde_json::{Value, json};

use crate::hosts::numbers::Numbers;
use crate::hosts::scene::quads;
use crate::hosts::technique::{IDENTITY, variant};
use crate::stage::{Generated, context, draw};

const SIZE: [u32; 2] = [4, 4];

fn generated(key: &str, set: &[(&str, &str)]) -> Generated {
    Generated::of(&variant(key, set).unwrap(), &Registry::builtin())
}

/// Returns the message of an error.
fn message<T>(result: Result<T, Error>) -> String {
    result.err().unwrap().to_string()
}

/// Opens a host for a changed manifest and returns the message.
fn with_manifest(context: &Context, generated: &Generated, change: impl Fn(&mut Value)) -> String {
    let mut manifest: Value = serde_json::from_str(&generated.manifest).unwrap();
    change(&mut manifest);
    let changed =
        Generated { manifest: manifest.to_string(), files: generated.files.clone(), plan: generated.plan.clone() };
    message(changed.host(context, SIZE))
}

fn assert_says(message: &str, parts: &[&str]) {
    assert!(parts.iter().all(|part| message.contains(part)), "`{message}` should say {parts:?}");
}

#[test]
fn a_broken_manifest_is_an_error() {
    let context = context(Validation::On);
    let generated = generated("f2b", &[]);
    let cut = &generated.manifest[..generated.manifest.len() / 2];
    let no_file = |_: &str| Err(Error("no file".to_owned()));
    assert_says(&message(Host::new(&context, cut, &no_file, SIZE)), &["manifest:", "EOF"]);
    assert_says(&message(Host::new(&context, "[]", &no_file, SIZE)), &["manifest:"]);
    let broken = |change: &dyn Fn(&mut Value)| with_manifest(&context, &generated, change);
    assert_says(
        &broken(&|manifest| manifest["schema"] = json!("fragbuf-manifest/3")),
        &["fragbuf-manifest/3", "fragbuf-manifest/4"],
    );
    assert_says(
        &broken(&|manifest| manifest["files"] = json!([])),
        &["no files of the target `spirv`", "--target spirv"],
    );
    assert_says(&broken(&|manifest| manifest["steps"] = json!(7)), &["manifest:"]);
    assert_says(&broken(&|manifest| manifest["resources"] = json!([])), &["manifest: step", "no resource"]);
    let end = |manifest: &Value| {
        let steps = manifest["steps"].as_array().unwrap();
        steps.iter().position(|step| step["do"] == "loop_end").unwrap()
    };
    assert_says(
        &broken(&|manifest| {
            let end = end(manifest);
            manifest["steps"][end]["begin"] = json!(99);
        }),
        &["does not end the loop", "99"],
    );
    assert_says(
        &broken(&|manifest| {
            let end = end(manifest);
            manifest["steps"].as_array_mut().unwrap().truncate(end);
        }),
        &["does not end at step"],
    );
}

#[test]
fn what_a_device_lacks_is_named() {
    let context = context(Validation::On);
    let generated = generated("ab_ll", &[]);
    let lacking = |change: &dyn Fn(&mut Value)| with_manifest(&context, &generated, change);
    let extensions = json!(["VK_NV_mesh_shader", "VK_EXT_fragment_shader_interlock"]);
    assert_says(
        &lacking(&|manifest| manifest["requires"]["spirv"]["extensions"] = extensions.clone()),
        &[" lacks ", "`VK_NV_mesh_shader`", "`VK_EXT_fragment_shader_interlock`"],
    );
    assert_says(&lacking(&|manifest| manifest["requires"]["spirv"]["version"] = json!("9.0")), &["Vulkan 9.0"]);
    assert_says(&lacking(&|manifest| manifest["requires"]["spirv"]["features"] = json!(["nonsense"])), &["`nonsense`"]);
    assert_says(
        &lacking(&|manifest| {
            let limits = manifest["limits"].as_array_mut().unwrap();
            limits.push(json!({ "vulkan": "maxColorAttachments", "needed": 1000 }));
        }),
        &["`maxColorAttachments` of 1000"],
    );
}

#[test]
fn a_missing_or_foreign_file_is_named() {
    let context = context(Validation::On);
    let mut generated = generated("kplus_array", &[("k", "4")]);
    let bytes = std::mem::take(&mut generated.files[0].1);
    let path = generated.files[0].0.clone();
    assert_says(&message(generated.host(&context, SIZE)), &[&path, "no SPIR-V"]);
    generated.files[0].1 = bytes.iter().map(|byte| byte ^ 0xff).collect();
    assert_says(&message(generated.host(&context, SIZE)), &[&path]);
    generated.files[0].1 = bytes;
    generated.files[0].0 = "elsewhere".to_owned();
    assert_says(&message(generated.host(&context, SIZE)), &[&path, "no such file"]);
}

#[test]
fn a_size_that_no_device_draws_is_an_error() {
    let context = context(Validation::On);
    let generated = generated("kplus_array", &[("k", "4")]);
    for size in [[0, 4], [4, 0]] {
        assert_says(&message(generated.host(&context, size)), &["one pixel at least"]);
    }
    assert_says(&message(generated.host(&context, [u32::MAX, 4])), &["at most"]);
    let mut host = generated.host(&context, SIZE).unwrap();
    assert_says(&message(host.resize([4, 1 << 20])), &["1048576", "at most"]);
    assert_says(&message(host.set_rows(Some(0))), &["0 rows"]);
    // The former size stays.
    let quads = quads(3, SIZE, &mut Numbers::seeded(1));
    assert_eq!(draw(&mut host, &quads, SIZE).unwrap().pixels.len(), 16);
}

/// A buffer beyond the device's limit is an error of the frame, and a smaller one is drawn afterwards.
#[test]
fn a_pool_that_does_not_fit_is_an_error() {
    let context = context(Validation::On);
    let generated = generated("ab_ll", &[]);
    let mut host = generated.host(&context, SIZE).unwrap();
    let quads = quads(3, SIZE, &mut Numbers::seeded(1));
    let vertices: &[u8] = &[];
    let empty = Scene { vertices, objects: &[], view_projection: IDENTITY };
    assert_says(&message(host.render(&empty, [0.0; 4])), &["`fragments`", "no value"]);
    host.set_symbol("fragments", 1 << 31).unwrap();
    assert_says(&message(host.render(&empty, [0.0; 4])), &["bytes", "slices"]);
    assert_eq!(draw(&mut host, &quads, SIZE).unwrap().lost, 0);
    // Fragments without a slot are counted.
    host.set_symbol("fragments", 1).unwrap();
    let scene = crate::hosts::scene::vertices(&quads, SIZE, &["position", "color"]);
    let objects = [Object { first: 0, count: 18, bounds: [[-1.0; 3], [1.0; 3]] }];
    let scene = Scene { vertices: &scene, objects: &objects, view_projection: IDENTITY };
    assert!(host.render(&scene, [0.0; 4]).unwrap().lost > 0);
}

#[test]
fn wrong_arguments_are_errors() {
    let context = context(Validation::On);
    let generated = generated("kplus_array", &[("k", "4"), ("opaque", "in_shader")]);
    let mut host = generated.host(&context, SIZE).unwrap();
    assert_says(&message(host.set_symbol("nonsense", 1)), &["`nonsense`", "`k`"]);
    assert_says(&message(host.set_symbol("width", 1)), &["`width`"]);
    assert_says(&message(host.set_symbol("k", 1 << 40)), &["`k` is", "set it from"]);
    assert_says(&message(host.set_uniform("nonsense", &[])), &["no uniform `nonsense`"]);
    assert_says(&message(host.set_texture("nonsense", &[])), &["no external texture `nonsense`"]);
    assert_says(&message(host.set_texture("opaque", &[0; 12])), &["64 bytes", "not 12"]);
    assert_says(&message(host.words("nonsense")), &["no resource `nonsense`"]);
    let render = |host: &mut Host<'_>, vertices: &[u8], object: Object| {
        host.render(&Scene { vertices, objects: &[object], view_projection: IDENTITY }, [0.0; 4])
    };
    let bounds = [[-1.0; 3], [1.0; 3]];
    let object = Object { first: 0, count: 3, bounds };
    assert_says(&message(render(&mut host, &[0; 30], object)), &["no whole vertices"]);
    assert_says(&message(render(&mut host, &[], object)), &["object 0", "the scene has 0"]);
    let object = Object { first: u32::MAX, count: u32::MAX, bounds };
    assert_says(&message(render(&mut host, &[], object)), &["object 0"]);
    let object = Object { first: 0, count: 0, bounds };
    assert_says(&message(render(&mut host, &[], object)), &["external texture `opaque`", "set_texture"]);
}

#[test]
fn files_in_module_form_are_rejected() {
    let context = context(Validation::On);
    let generated = generated("kplus_array", &[("k", "4")]);
    let module = |manifest: &mut Value| {
        manifest.as_object_mut().unwrap().remove("vertex_inputs");
    };
    assert_says(&with_manifest(&context, &generated, module), &["module form", "--form program"]);
}

/// The loader reads its settings when a process opens the first instance, so each case runs in a process of its own.
#[test]
fn a_missing_layer_or_driver_names_the_package() {
    let nowhere = std::env::temp_dir();
    let run = |name: &str| {
        Command::new(std::env::current_exe().unwrap())
            .args(["misuse::opening_fails", "--exact", "--ignored", "--nocapture"])
            .env(name, &nowhere)
            .env("HOME", &nowhere)
            .env("XDG_DATA_DIRS", &nowhere)
            .output()
            .unwrap()
    };
    let printed = |output: std::process::Output| String::from_utf8_lossy(&output.stdout).into_owned();
    assert_says(&printed(run("VK_LAYER_PATH")), &["VK_LAYER_KHRONOS_validation is missing", "vulkan-validationlayers"]);
    assert_says(&printed(run("VK_DRIVER_FILES")), &["mesa-vulkan-drivers"]);
}

/// Not a test of its own: the one above runs it with other settings of the loader.
#[test]
#[ignore = "run by another test"]
fn opening_fails() {
    let validation = if std::env::var("VK_LAYER_PATH").is_ok() { Validation::On } else { Validation::Off };
    let error = Context::open(&Settings { validation, ..Settings::default() }).err().map(|error| error.to_string());
    println!("{}", error.unwrap_or_default());
}
