//! Manifests: against their JSON Schema, against the text that they describe, and against what APIs promise.

mod schema;
mod text;
mod values;

use std::sync::LazyLock;

use fragbuf::vocabulary::Formula;
use fragbuf::{Form, Generation, Registry, Request, TARGETS, Target, generate, manifest};
use serde_json::Value;

use crate::cases::{checked, named};

/// A generation of a case for all targets, and its manifest.
struct Written {
    name: String,
    generation: Generation,
    manifest: Value,
}

/// Every case in both forms; modules with a prefix and another bind group.
static ALL: LazyLock<Vec<Written>> = LazyLock::new(|| {
    let targets: Vec<&'static Target> = TARGETS.iter().collect();
    let registry = Registry::builtin();
    let mut all = Vec::new();
    for (name, description, set) in named() {
        let variant = checked(&description, &set).unwrap_or_else(|diagnostics| panic!("{name}: {diagnostics}"));
        for (form, prefix, group) in [(Form::Program, "", 0), (Form::Module, "glass", 2)] {
            let request = Request { targets: &targets, form, prefix, group };
            let generation =
                generate(&variant, &request, &registry).unwrap_or_else(|errors| panic!("{name}: {errors}"));
            // Techniques of fixed function have no module.
            if !generation.plans.is_empty() {
                let manifest = manifest(&generation, group);
                all.push(Written { name: format!("{name}, {form:?}"), generation, manifest });
            }
        }
    }
    all
});

/// Returns the parts of a manifest that depend on one plan, each with its targets.
fn plans(written: &Written) -> Vec<(&Value, Vec<&str>)> {
    let alternatives = written.manifest["alternatives"].as_array().unwrap();
    let parts = std::iter::once(&written.manifest).chain(alternatives);
    let targets =
        written.generation.plans.iter().map(|planned| planned.targets.iter().map(|target| target.name).collect());
    parts.zip(targets).collect()
}

/// Returns the passes of a part.
fn passes(part: &Value) -> impl Iterator<Item = &Value> {
    part["steps"].as_array().unwrap().iter().filter(|step| step["do"] == "pass")
}

/// Returns what the text of a pass declares for a target, as the manifest says it.
fn bindings<'m>(pass: &'m Value, target: &str) -> &'m Vec<Value> {
    let of_target = pass["bindings_of"].get(target);
    of_target.unwrap_or(&pass["bindings"]).as_array().unwrap()
}

/// Returns the value of a formula over symbols with these values, or else with their own.
fn evaluated(part: &Value, formula: &Value, given: &[(&str, u64)]) -> u64 {
    let text = formula.as_str().unwrap_or_else(|| panic!("{formula} is no formula"));
    let symbol = |name: &str| {
        let known = given.iter().find(|(known, _)| *known == name).map(|(_, value)| *value);
        known.or_else(|| part["constants"][name].as_u64()).or_else(|| {
            let stated = part["symbols"].as_array()?.iter().find(|symbol| symbol["name"] == name)?;
            stated["value"].as_u64().or_else(|| Some(evaluated(part, stated.get("default")?, given)))
        })
    };
    Formula::from(text.to_owned()).evaluate(&symbol).unwrap_or_else(|error| panic!("{text}: {error}"))
}
