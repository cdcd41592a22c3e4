//! The variants of a technique that the player chooses from: every legal combination of a capacity for k, a sort and an overflow, as
//! portable WGSL.
//!
//! Input: a technique. Output: its variants as JSON, each with its description, its manifest and its files, or with the reason why there is
//! none. Files and manifests are divided into pieces, which `pieces` stores once. Nothing is drawn here.

use fragbuf::load::{self, Description};
use fragbuf::vocabulary::Row;
use fragbuf::{
    Form, Generation, Plan, Registry, Request, Target, generate, manifest, select, target, tier, tier_meaning,
};
use fragbuf_model::{Diagnostics, Variant};
use serde_json::{Map, Value, json};

use super::merged;
use super::pieces::Pieces;
use crate::cli::playground::DESCRIPTION;

/// The target of the passes.
const TARGET: &str = "wgsl";

/// The axes that the player chooses on.
const SORT: &str = "sort";
const OVERFLOW: &str = "overflow";

/// The largest k of variants. The player draws with any k up to it.
const CAPACITIES: [u32; 4] = [4, 8, 16, 32];

/// A combination of choices.
struct Choices<'a> {
    /// `None`: the technique keeps every fragment.
    capacity: Option<u32>,
    sort: &'a str,
    overflow: &'a str,
}

/// Returns the variants of a technique.
pub(super) fn variants(key: &str, registry: &Registry) -> Value {
    let usual = match generated(&text(key, &[]), registry) {
        Ok(generation) => generation,
        Err(reason) => return unsupported(key, reason),
    };
    let Some(plan) = usual.plans.first().map(|planned| &planned.plan) else {
        return unsupported(key, format!("`{key}` has no passes for `{TARGET}`"));
    };
    let [sort, overflow] = [SORT, OVERFLOW].map(|axis| value(plan, axis));
    let capacity = plan.variant.keep.map(|_| plan.capacity());
    let usual = Choices { capacity, sort, overflow };
    let mut table = Table { key, registry, usual, reasons: Vec::new(), pieces: Pieces::default() };
    let capacities = capacities(capacity);
    let (sorts, overflows) = (keys(registry, SORT), keys(registry, OVERFLOW));
    let mut variants = Vec::new();
    for capacity in &capacities {
        for sort in &sorts {
            variants.extend(
                overflows.iter().map(|overflow| table.variant(&Choices { capacity: *capacity, sort, overflow })),
            );
        }
    }
    json!({
        "unsupported": null,
        "usual": { "capacity": capacity, "sort": sort, "overflow": overflow },
        "capacities": capacities,
        "sorts": values(registry, SORT),
        "overflows": values(registry, OVERFLOW),
        "reasons": table.reasons,
        "variants": variants,
        "pieces": table.pieces.into_values(),
    })
}

/// Returns what the player reads of a technique that it cannot draw.
fn unsupported(key: &str, reason: String) -> Value {
    json!({ "unsupported": reason, "text": text(key, &[]), "variants": [] })
}

/// Returns the capacities to generate: those of the table, and the one of the technique.
fn capacities(usual: Option<u32>) -> Vec<Option<u32>> {
    let Some(usual) = usual else { return vec![None] };
    let mut capacities: Vec<u32> = CAPACITIES.into_iter().chain([usual]).collect();
    capacities.sort_unstable();
    capacities.dedup();
    capacities.into_iter().map(Some).collect()
}

/// Returns the values of an axis.
fn keys<'r>(registry: &'r Registry, axis: &str) -> Vec<&'r str> {
    rows(registry, axis).iter().map(|row| row.key.as_str()).collect()
}

/// Returns the values of an axis, with what they do.
fn values(registry: &Registry, axis: &str) -> Vec<Value> {
    rows(registry, axis).iter().map(|row| json!({ "key": row.key, "summary": row.summary })).collect()
}

/// Returns the rows of an axis that have a name.
fn rows<'r>(registry: &'r Registry, axis: &str) -> Vec<&'r Row> {
    let rows = registry.rows().iter().filter(|row| row.axis == axis);
    rows.filter(|row| !Registry::is_of_closures(row)).collect()
}

/// Returns the value of an axis in a plan.
fn value<'p>(plan: &'p Plan, axis: &str) -> &'p str {
    let rows = plan.selection.rows.iter().map(|selected| &selected.row);
    rows.filter(|row| row.axis == axis).map(|row| row.key.as_str()).next().unwrap_or_default()
}

/// The variants of a technique while they are generated.
struct Table<'a> {
    key: &'a str,
    registry: &'a Registry,
    /// What the technique chooses.
    usual: Choices<'a>,
    /// Why combinations have no passes, each once.
    reasons: Vec<String>,
    pieces: Pieces,
}

impl Table<'_> {
    fn variant(&mut self, choices: &Choices<'_>) -> Value {
        let Choices { capacity, sort, overflow } = choices;
        let text = self.text(choices);
        let variant = json!({ "capacity": capacity, "sort": sort, "overflow": overflow });
        let found = match generated(&text, self.registry) {
            Ok(generation) => self.passes(text, &generation),
            Err(reason) => json!({ "reason": self.reason(reason) }),
        };
        merged(variant, found)
    }

    /// Returns the description with the choices that differ from those of the technique.
    fn text(&self, choices: &Choices<'_>) -> String {
        let keep = choices.capacity.filter(|_| choices.capacity != self.usual.capacity);
        let keep = keep.map(|k| format!("keep {k};"));
        let changed = |axis: &str, value: &str, usual: &str| (value != usual).then(|| format!("{axis}: {value};"));
        let sort = changed(SORT, choices.sort, self.usual.sort);
        let overflow = changed(OVERFLOW, choices.overflow, self.usual.overflow);
        text(self.key, &[keep, sort, overflow].into_iter().flatten().collect::<Vec<_>>())
    }

    /// Adds the files of a variant. Returns what the player needs to draw it.
    fn passes(&mut self, text: String, generation: &Generation) -> Value {
        let Some(plan) = generation.plans.first().map(|planned| &planned.plan) else { return json!({}) };
        let files = generation.files.iter().map(|file| (file.path.clone(), self.pieces.text(file)));
        let files: Map<String, Value> = files.collect();
        let tier = target(TARGET).map(|target| tier(plan.soundness, target));
        json!({
            "text": text,
            "manifest": self.pieces.object(manifest(generation, 0)),
            "files": files,
            "keep": plan.variant.keep.map(|k| json!({ "k": k, "capacity": plan.capacity() })),
            "words_per_pixel": plan.words_per_pixel,
            "tier": tier,
            "meaning": tier.map(tier_meaning),
            "layout": layout(&plan.variant),
        })
    }

    fn reason(&mut self, reason: String) -> usize {
        let known = self.reasons.iter().position(|other| *other == reason);
        known.unwrap_or_else(|| {
            self.reasons.push(reason);
            self.reasons.len() - 1
        })
    }
}

/// Returns the description of a technique with these changes.
fn text(key: &str, changes: &[String]) -> String {
    let lines: String = changes.iter().map(|change| format!("    {change}\n")).collect();
    format!("buffer Mine from {key} {{\n{lines}}}\n")
}

/// Returns the attributes of the vertices. Descriptions with equal attributes draw the same triangles.
fn layout(variant: &Variant) -> String {
    let attributes = variant.attributes.iter();
    let names = attributes.map(|attribute| format!("{}:{}", attribute.name.value, attribute.format.value.keyword()));
    names.collect::<Vec<_>>().join(",")
}

/// Generates the passes of a description, or returns why the player cannot draw it.
fn generated(text: &str, registry: &Registry) -> Result<Generation, String> {
    let description = Description::Text { file: DESCRIPTION.to_owned(), text: text.to_owned() };
    let variant = load::variant(&description, &[], registry).map_err(|errors| first(&errors))?;
    let target = target(TARGET).ok_or_else(|| format!("there is no target `{TARGET}`"))?;
    let targets: [&'static Target; 1] = [target];
    let request = Request { targets: &targets, form: Form::Program, prefix: "", group: 0 };
    if let Err(missing) = select(&variant, target, &request) {
        return Err(format!("browsers cannot run it: {missing}"));
    }
    let generation = generate(&variant, &request, registry).map_err(|errors| first(&errors))?;
    let resources = generation.plans.iter().flat_map(|planned| &planned.plan.resources);
    match resources.filter(|planned| planned.is_external()).map(|planned| &planned.resource.name).next() {
        Some(name) => Err(format!("it reads the texture `{name}` of the host, which this page does not have")),
        None => Ok(generation),
    }
}

/// Returns the first error, with what to do.
fn first(errors: &Diagnostics) -> String {
    errors.iter().next().map_or_else(String::new, |error| format!("{}; {}", error.message, error.help))
}
