//! Blocks in TOML and JSON: the manifest of a package, and a part of a manifest of passes.

use std::path::Path;
use std::process::Command;

use fragbuf::plan_json;
use serde_json::Value;

use super::{Block, folder, root};
use crate::vocabulary::planned;

/// The block names packages of this workspace, with versions and features that they have.
pub(super) fn is_a_cargo_manifest(block: &Block) {
    let folder = folder(&format!("manifest-{}", block.line));
    let package = "[package]\nname = \"block\"\nversion = \"0.0.0\"\nedition = \"2024\"\n\n[workspace]\n\n";
    std::fs::write(folder.join("Cargo.toml"), format!("{package}{}", block.text)).unwrap();
    std::fs::create_dir(folder.join("src")).unwrap();
    let checkout = folder.parent().unwrap().join("fragbuf");
    let _ = std::fs::remove_file(&checkout);
    std::os::unix::fs::symlink(root(), &checkout).unwrap();
    std::fs::write(folder.join("src/lib.rs"), "").unwrap();
    let (found, workspace) = (metadata(&folder), metadata(root()));
    let dependencies = found["packages"][0]["dependencies"].as_array().unwrap();
    assert!(!dependencies.is_empty(), "{}:{}", block.file, block.line);
    for dependency in dependencies {
        let packages = workspace["packages"].as_array().unwrap();
        let package = packages.iter().find(|package| package["name"] == dependency["name"]);
        let package = package.unwrap_or_else(|| block.fail(&format!("no package {}", dependency["name"])));
        if let Some(path) = dependency["path"].as_str() {
            // A checkout of the repository beside the crate.
            let inner = Path::new(path).strip_prefix(&checkout).unwrap();
            let manifest = root().join(inner).join("Cargo.toml");
            assert_eq!(Path::new(package["manifest_path"].as_str().unwrap()), manifest, "{dependency}");
            continue;
        }
        let requirement = dependency["req"].as_str().unwrap().trim_start_matches('^');
        assert!(package["version"].as_str().unwrap().starts_with(&format!("{requirement}.")), "{dependency}");
        for feature in dependency["features"].as_array().unwrap() {
            assert!(!package["features"][feature.as_str().unwrap()].is_null(), "{dependency}");
        }
    }
}

fn metadata(folder: &Path) -> Value {
    let arguments = ["metadata", "--no-deps", "--offline", "--format-version", "1"];
    let output = Command::new(env!("CARGO")).args(arguments).current_dir(folder).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    serde_json::from_slice(&output.stdout).unwrap()
}

/// The block has the members of an exchange in the manifest of a plan that has one, with values of the same types.
pub(super) fn is_an_exchange(block: &Block) {
    let shown: Value = serde_json::from_str(&block.text).unwrap_or_else(|error| block.fail(&error.to_string()));
    let plan = Value::Object(plan_json(&planned("f2b"), 0));
    let steps = plan["steps"].as_array().unwrap();
    let real = steps.iter().find_map(|step| step["exchanged"].get(0)).unwrap();
    let types = |value: &Value| -> Vec<(String, &str, usize)> {
        let kind = |value: &Value| match value {
            Value::Array(values) => ("array", values.len()),
            Value::Bool(_) => ("bool", 0),
            _ => ("other", 0),
        };
        let mut types: Vec<_> = value
            .as_object()
            .unwrap()
            .iter()
            .map(|(name, value)| (name.clone(), kind(value).0, kind(value).1))
            .collect();
        types.sort();
        types
    };
    assert_eq!(types(&shown), types(real), "{}:{}", block.file, block.line);
}
