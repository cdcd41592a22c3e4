//! The bindings of a pass are those of its text, in every language that tools here can read.

use std::collections::{BTreeMap, BTreeSet};
use std::process::Command;

use fragbuf::File;
use naga::{AddressSpace, ImageClass, ScalarKind, StorageAccess, TypeInner};
use serde_json::Value;

use super::{ALL, Written, bindings, passes, plans};

/// A binding in words: number, type and details.
type Declared = BTreeSet<(u64, String)>;

/// Calls `check` for every file of these targets with the bindings that the manifest gives for the file's stages.
fn for_each_file(targets: &[&str], check: &mut dyn FnMut(&Written, &File, &[&Value])) {
    for written in ALL.iter() {
        for (part, own) in plans(written) {
            for file in written.generation.files.iter().filter(|file| targets.contains(&file.target)) {
                let pass = passes(part).find(|pass| pass["pass"] == file.pass.as_str());
                let Some(pass) = pass.filter(|_| own.contains(&file.target)) else { continue };
                let stages: Vec<&str> = file.entry_points.iter().map(|(stage, _)| *stage).collect();
                let is_of_file = |binding: &&Value| {
                    let mut of = binding["stages"].as_array().unwrap().iter().filter_map(Value::as_str);
                    of.any(|stage| stages.contains(&stage) || stage == "fragment" && stages.contains(&"module"))
                };
                let listed: Vec<&Value> = bindings(pass, file.target).iter().filter(is_of_file).collect();
                check(written, file, &listed);
            }
        }
    }
}

/// What naga finds in the text: variables, and the stages whose entry points access them.
#[test]
fn wgsl_declares_what_the_manifest_lists() {
    let mut types = BTreeMap::new();
    for_each_file(&["wgsl", "wgsl-native"], &mut |written, file, listed| {
        let what = format!("{}: {}", written.name, file.path);
        let text = std::str::from_utf8(&file.bytes).unwrap();
        let options =
            naga::front::wgsl::Options { parse_doc_comments: false, capabilities: naga::valid::Capabilities::all() };
        let module = naga::front::wgsl::Frontend::new_with_options(options).parse(text).unwrap();
        let flags = naga::valid::ValidationFlags::all();
        let info = naga::valid::Validator::new(flags, naga::valid::Capabilities::all()).validate(&module).unwrap();
        let prefix = written.manifest["prefix"].as_str().unwrap();
        let mut declared = BTreeSet::new();
        for (handle, global) in module.global_variables.iter() {
            let Some(binding) = &global.binding else { continue };
            let entries = module.entry_points.iter().enumerate();
            let mut stages: BTreeSet<String> = entries
                .filter(|(index, _)| !info.get_entry_point(*index)[handle].is_empty())
                .map(|(_, entry)| format!("{:?}", entry.stage).to_lowercase())
                .collect();
            if module.entry_points.is_empty() {
                stages.insert("fragment".to_owned());
            }
            let name = global.name.clone().unwrap();
            let name = name.strip_prefix(&format!("{prefix}_")).unwrap_or(&name).to_owned();
            let kind = kind(&module, global);
            *types.entry(kind.clone()).or_insert(0) += 1;
            declared.insert((binding.group, binding.binding, name, stages, kind));
        }
        let number = |binding: &Value, name: &str| binding[name].as_u64().unwrap() as u32;
        let listed = listed.iter().map(|binding| {
            let stages = binding["stages"].as_array().unwrap().iter();
            let stages = stages.map(|stage| stage.as_str().unwrap().to_owned()).collect();
            let name = binding["name"].as_str().unwrap().to_owned();
            (number(binding, "group"), number(binding, "binding"), name, stages, type_of(binding))
        });
        assert_eq!(declared, listed.collect(), "{what}");
    });
    for kind in ["uniform", "storage", "read-only-storage", "texture depth one", "texture uint several"] {
        assert!(types.get(kind).is_some_and(|count| *count > 2), "{kind} in {types:?}");
    }
}

/// Returns the type of a variable in the words of [`type_of`].
fn kind(module: &naga::Module, global: &naga::GlobalVariable) -> String {
    let samples = |multi| if multi { "several" } else { "one" };
    match (global.space, &module.types[global.ty].inner) {
        (AddressSpace::Uniform, _) => "uniform".to_owned(),
        (AddressSpace::Storage { access }, _) if access == StorageAccess::LOAD => "read-only-storage".to_owned(),
        (AddressSpace::Storage { .. }, _) => "storage".to_owned(),
        (_, TypeInner::Image { class: ImageClass::Depth { multi }, .. }) => {
            format!("texture depth {}", samples(*multi))
        }
        (_, TypeInner::Image { class: ImageClass::Sampled { kind, multi }, .. }) => {
            let scalar = match kind {
                ScalarKind::Uint => "uint",
                ScalarKind::Sint => "sint",
                _ => "float",
            };
            format!("texture {scalar} {}", samples(*multi))
        }
        other => panic!("{other:?}"),
    }
}

fn type_of(binding: &Value) -> String {
    match binding["type"].as_str().unwrap() {
        "texture" => {
            let scalar = binding["sample_type"].as_str().unwrap().trim_start_matches("unfilterable-");
            let samples = if binding["multisampled"] == true { "several" } else { "one" };
            format!("texture {scalar} {samples}")
        }
        other => other.to_owned(),
    }
}

/// The binding numbers in the layouts of GLSL, by kind: in OpenGL each kind is numbered apart.
#[test]
fn glsl_declares_what_the_manifest_lists() {
    let mut seen = 0;
    for_each_file(&["glsl", "glsl-vulkan", "glsl-es"], &mut |written, file, listed| {
        let text = std::str::from_utf8(&file.bytes).unwrap();
        let declared: Declared = text.lines().filter_map(declaration).collect();
        let number = if file.target == "glsl-vulkan" { "binding" } else { "opengl_binding" };
        let kind = |binding: &Value| match binding["type"].as_str().unwrap() {
            "uniform" => "block".to_owned(),
            "texture" => "texture".to_owned(),
            other => other.to_owned(),
        };
        let wanted: Declared =
            listed.iter().map(|binding| (binding[number].as_u64().unwrap(), kind(binding))).collect();
        assert_eq!(wanted.len(), listed.len(), "{}: {} has two bindings of one number", written.name, file.path);
        assert_eq!(declared, wanted, "{}: {}", written.name, file.path);
        seen += declared.len();
    });
    assert!(seen > 3000, "{seen} declarations");
}

/// Returns the number and the kind of a declaration with a binding.
fn declaration(line: &str) -> Option<(u64, String)> {
    let rest = line.strip_prefix("layout(")?;
    let (layout, rest) = rest.split_once(')')?;
    let number = layout.split(", ").find_map(|part| part.strip_prefix("binding = "))?.parse().ok()?;
    let kind = match (layout.contains("std140"), layout.contains("std430")) {
        (true, _) => "block",
        (_, true) if rest.contains("readonly ") => "read-only-storage",
        (_, true) => "storage",
        _ => "texture",
    };
    Some((number, kind.to_owned()))
}

/// Sets and numbers of SPIR-V, and the capabilities that its features stand for. `spirv-dis` reads them.
#[test]
fn spirv_declares_what_the_manifest_lists_and_requires() {
    const CAPABILITIES: [(&str, &str); 3] = [
        ("Int64", "shaderInt64"),
        ("Int64Atomics", "shaderBufferInt64Atomics"),
        ("FragmentShaderPixelInterlockEXT", "fragmentShaderPixelInterlock"),
    ];
    let mut known: BTreeMap<Vec<u8>, String> = BTreeMap::new();
    let mut capabilities: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
    for_each_file(&["spirv"], &mut |written, file, listed| {
        let text = known.entry(file.bytes.clone()).or_insert_with(|| disassembled(&file.bytes));
        let decorated = |name: &str| -> BTreeMap<&str, u64> {
            let lines = text.lines().map(|line| line.split_whitespace().collect::<Vec<&str>>());
            let of_name = lines.filter(|words| words.first() == Some(&"OpDecorate") && words.get(2) == Some(&name));
            of_name.map(|words| (words[1], words[3].parse().unwrap())).collect()
        };
        let (sets, numbers) = (decorated("DescriptorSet"), decorated("Binding"));
        let declared: BTreeSet<(u64, u64)> = numbers.iter().map(|(id, number)| (sets[id], *number)).collect();
        let number = |binding: &Value, name: &str| binding[name].as_u64().unwrap();
        let wanted: BTreeSet<(u64, u64)> =
            listed.iter().map(|binding| (number(binding, "group"), number(binding, "binding"))).collect();
        assert_eq!(declared, wanted, "{}: {}", written.name, file.path);
        let own = text.lines().filter_map(|line| line.trim().strip_prefix("OpCapability "));
        capabilities.entry(written.name.clone()).or_default().extend(own.map(str::to_owned));
    });
    let mut found = BTreeSet::new();
    for written in ALL.iter() {
        let Some(capabilities) = capabilities.get(&written.name) else { continue };
        let part = plans(written).into_iter().find(|(_, targets)| targets.contains(&"spirv")).unwrap().0;
        let features: Vec<&str> =
            part["requires"]["spirv"]["features"].as_array().unwrap().iter().filter_map(Value::as_str).collect();
        for (capability, feature) in CAPABILITIES {
            assert_eq!(capabilities.contains(capability), features.contains(&feature), "{}: {feature}", written.name);
            found.extend(capabilities.get(capability));
        }
        let others = capabilities.iter().filter(|name| !CAPABILITIES.iter().any(|(known, _)| known == name));
        // What Vulkan 1.1 has without a feature.
        let others: Vec<&String> = others.filter(|name| !["Shader", "ImageQuery"].contains(&name.as_str())).collect();
        assert!(others.is_empty(), "{}: {others:?}", written.name);
    }
    assert_eq!(found.len(), CAPABILITIES.len(), "{found:?}");
}

fn disassembled(bytes: &[u8]) -> String {
    let path = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join("manifest.spv");
    std::fs::write(&path, bytes).unwrap();
    let output = Command::new("spirv-dis").arg("--no-color").arg(&path).output();
    let output = output.unwrap_or_else(|error| panic!("spirv-dis must be installed (see README): {error}"));
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap()
}

/// Extensions of OpenGL ES that are about targets, not about the text.
const OF_TARGETS: [&str; 3] = ["GL_EXT_color_buffer_float", "GL_EXT_float_blend", "GL_EXT_draw_buffers_indexed"];

/// The extensions of OpenGL are those that the text enables, and in OpenGL ES those of targets.
#[test]
fn opengl_extensions_are_those_of_the_text() {
    let mut found = BTreeSet::new();
    for written in ALL.iter() {
        for (part, targets) in plans(written) {
            for target in targets.iter().filter(|target| ["glsl", "glsl-es"].contains(target)) {
                let files = written.generation.files.iter().filter(|file| file.target == *target);
                // A library names its extensions in a comment for the shader that includes it.
                let texts: Vec<&str> = files.map(|file| std::str::from_utf8(&file.bytes).unwrap()).collect();
                let lines = texts.iter().flat_map(|text| text.lines()).filter(|line| line.contains("#extension "));
                let enabled: BTreeSet<&str> =
                    lines.filter_map(|line| line.split("#extension ").nth(1)?.split_whitespace().next()).collect();
                let listed = part["requires"][*target]["extensions"].as_array().unwrap();
                let listed = listed.iter().filter_map(Value::as_str);
                let is_of_text = |name: &&str| *target == "glsl" || !OF_TARGETS.contains(name);
                let listed: BTreeSet<&str> = listed.filter(is_of_text).collect();
                assert_eq!(enabled, listed, "{}: {target}", written.name);
                found.extend(enabled);
            }
        }
    }
    assert_eq!(found.len(), 3, "{found:?}");
}
