//! Answers what a description is: its diagnostics, and while it has no errors, its parts, its cost and its soundness on every target.

use fragbuf::analysis::Lines;
use fragbuf::vocabulary::{Capability, Kind};
use fragbuf::{
    Diagnostic, Diagnostics, Form, Plan, Registry, Request, TARGETS, Target, Variant, plan, select, tier, tier_meaning,
};
use serde::Deserialize;
use serde_json::{Value, json};

use super::description::{Folder, sentence};
use super::editor;
use super::problem::Problem;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Analyse {
    text: String,
    /// Whether to try every value of every axis.
    #[serde(default)]
    axes: bool,
}

impl Analyse {
    pub(super) fn answer(&self, folder: &Folder) -> Result<Value, Problem> {
        let registry = Registry::builtin();
        let file = folder.file();
        if let Some(errors) = folder.refused(&self.text, &file) {
            return Ok(json!({ "diagnostics": refused(&self.text, &errors), "description": null }));
        }
        let document = folder.document(&self.text, &file, &registry);
        let diagnostics = editor::diagnostics(&document);
        let Some(variant) = document.variant() else {
            return Ok(json!({ "diagnostics": diagnostics, "description": null }));
        };
        let mut description = facts(&variant, &registry)?;
        if self.axes {
            description["axes"] = editor::axes(&document).into();
        }
        Ok(json!({ "diagnostics": diagnostics, "description": description }))
    }
}

/// Returns the errors for files that are not read.
fn refused(text: &str, errors: &Diagnostics) -> Vec<Value> {
    let lines = Lines::new(text);
    let error = |error: &Diagnostic| {
        let span = lines.source_span(&error.span);
        let mut found = fragbuf::report::json(error);
        found["from"] = lines.utf16(span.bytes.start).into();
        found["to"] = lines.utf16(span.bytes.end).into();
        found["fixes"] = json!([]);
        found["file"] = Value::Null;
        found
    };
    errors.iter().map(error).collect()
}

/// The plan of a variant on the targets that select the same rows.
struct Selected {
    plan: Plan,
    targets: Vec<&'static Target>,
}

/// Returns the facts about a variant.
fn facts(variant: &Variant, registry: &Registry) -> Result<Value, Problem> {
    let request = Request { targets: &[], form: Form::Program, prefix: "", group: 0 };
    let mut plans: Vec<Selected> = Vec::new();
    let mut unsupported = Vec::new();
    for target in TARGETS {
        let selection = match select(variant, target, &request) {
            Ok(selection) => selection,
            Err(missing) => {
                unsupported.push((target, missing.to_string()));
                continue;
            }
        };
        if let Some(known) = plans.iter_mut().find(|selected| selected.plan.selection == selection) {
            known.targets.push(target);
            continue;
        }
        let plan = plan(variant, &selection, registry).map_err(|errors| Problem::input(sentence(&errors)))?;
        plans.push(Selected { plan, targets: vec![target] });
    }
    let first = plans.first().map(|selected| &selected.plan);
    let attribute = |attribute: &fragbuf_model::Attribute| {
        let format = attribute.format.value;
        json!({ "name": attribute.name.value, "format": format.keyword(), "words": format.words() })
    };
    let uniform = |uniform: &fragbuf_model::Uniform| json!({ "name": uniform.name.value, "type": uniform.kind.value.keyword(), "count": uniform.kind.value.components() });
    Ok(json!({
        "name": variant.name.value,
        "technique": variant.technique,
        "keep": variant.keep.zip(first).map(|(k, plan)| keep(k, plan)),
        "attributes": variant.attributes.iter().map(attribute).collect::<Vec<_>>(),
        "uniforms": variant.uniforms.iter().map(uniform).collect::<Vec<_>>(),
        "words_per_pixel": first.map(|plan| &plan.words_per_pixel),
        "draws": first.map(|plan| &plan.geometry_passes),
        "passes": first.map(passes),
        "external": first.map(|plan| plan.resources.iter().filter(|planned| planned.is_external()).map(|planned| &planned.resource.name).collect::<Vec<_>>()),
        "hazards": first.map(|plan| plan.hazards.iter().map(|hazard| json!({ "name": hazard.name, "description": hazard.description })).collect::<Vec<_>>()),
        "targets": targets(&plans, &unsupported),
    }))
}

/// Returns k, the greatest k, and whether iterations keep as many each, until no fragment is left.
fn keep(k: u32, plan: &Plan) -> Value {
    let repeats = plan.selection.provides().contains(&Capability::KeepsLater);
    json!({ "k": k, "capacity": plan.capacity(), "repeats": repeats })
}

fn passes(plan: &Plan) -> Vec<Value> {
    let kind = |kind: &Kind| match kind {
        Kind::Geometry => "geometry",
        Kind::Fullscreen => "fullscreen",
        Kind::Compute { .. } => "compute",
    };
    plan.passes.iter().map(|pass| json!({ "name": pass.name, "kind": kind(&pass.kind) })).collect()
}

/// Returns the tier of every target, or what it lacks, in the order of the table of targets.
fn targets(plans: &[Selected], unsupported: &[(&Target, String)]) -> Vec<Value> {
    let row = |target: &Target| {
        let selected = plans.iter().find(|selected| selected.targets.iter().any(|one| one.name == target.name));
        let tier = selected.map(|selected| tier(selected.plan.soundness, target));
        let missing = unsupported.iter().find(|(one, _)| one.name == target.name).map(|(_, missing)| missing);
        json!({
            "name": target.name,
            "tier": tier,
            "meaning": tier.map(tier_meaning),
            "unsupported": missing,
        })
    };
    TARGETS.iter().map(row).collect()
}
