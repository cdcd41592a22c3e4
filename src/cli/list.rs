//! `fragbuf list`: what there is, computed from the rows.

use fragbuf::{Arrival, Form, Generation, Plan, Registry, Request, TARGETS, TIERS, Target, generate, tier};
use fragbuf_templates::vocabulary::{Row, Technique};
use serde_json::{Map, Value, json};

use super::input::Input;
use super::output::{self, Failure};

#[derive(clap::Args)]
pub(crate) struct List {
    /// As JSON
    #[arg(long)]
    json: bool,
    /// Table 1 of the k⁺-buffer paper with ours beside it, as Markdown
    #[arg(long, conflicts_with = "json")]
    table_1: bool,
    /// The axes and their values as Markdown: of each axis the value that stands where nothing else says one comes first
    #[arg(long, conflicts_with_all = ["json", "table_1"])]
    axes: bool,
}

impl List {
    pub(crate) fn run(&self) -> Result<(), Failure> {
        let registry = Registry::builtin();
        if self.table_1 {
            return output::print(&super::table_1::table(&registry)?);
        }
        if self.axes {
            return output::print(&axes(&registry));
        }
        let rows: Vec<Value> =
            registry.techniques().iter().map(|technique| row(technique, &registry)).collect::<Result<_, _>>()?;
        output::print(&if self.json { output::json(&Value::from(rows)) } else { table(&rows) })
    }
}

/// Every axis that a description chooses on, with the summary of each of its values.
fn axes(registry: &Registry) -> String {
    let mut text = String::from("| axis | value | |\n|---|---|---|\n");
    for axis in registry.axes().iter().filter(|axis| axis.chosen) {
        let mut rows: Vec<&Row> = registry.rows_of(axis.key).filter(|row| row.key != Registry::CLOSURE).collect();
        rows.sort_by_key(|row| axis.default != Some(row.key.as_str()));
        for (number, row) in rows.iter().enumerate() {
            let name = if number == 0 { axis.key } else { "" };
            text.push_str(&format!("| {name} | `{}` | {} |\n", row.key, row.summary));
        }
    }
    text
}

fn row(technique: &Technique, registry: &Registry) -> Result<Value, Failure> {
    let mut input = Input::read(&technique.key, registry)?;
    let variant = input.variant(&[], registry)?;
    let targets: Vec<&'static Target> = TARGETS.iter().collect();
    let request = Request { targets: &targets, form: Form::Program, prefix: "", group: 0 };
    let generation = generate(&variant, &request, registry).map_err(|faults| input.failure(faults))?;
    let mut tiers = Map::new();
    for target in TARGETS {
        let planned = generation.plans.iter().find(|planned| planned.targets.iter().any(|t| t.name == target.name));
        let refusal = generation.refusals.iter().find(|(refused, _)| refused.name == target.name);
        let verdict = match (planned, refusal) {
            (Some(planned), _) => tier(planned.plan.soundness, target).to_owned(),
            (None, Some((_, refusal))) => refusal.to_string(),
            (None, None) => continue,
        };
        tiers.insert(target.name.to_owned(), verdict.into());
    }
    let first = generation.plans.first().map(|planned| &planned.plan);
    let axes: Map<String, Value> = first
        .map(|plan| plan.selection.rows.iter().map(|s| (s.row.axis.clone(), s.row.key.clone().into())).collect())
        .unwrap_or_default();
    let passes = first.map(|plan| plan.geometry_passes.clone());
    let passes = passes.map(|text| text.parse::<u32>().map_or(Value::from(text), Value::from));
    Ok(json!({
        "key": technique.key,
        "title": technique.title,
        "paper": technique.paper,
        "summary": technique.summary,
        "axes": axes,
        "words_per_pixel": over_plans(&generation, " or ", |plan| plan.words_per_pixel.clone()),
        "bytes_per_pixel": over_plans(&generation, " or ", |plan| plan.bytes_per_pixel().to_string()),
        "geometry_passes": passes,
        "draws": over_plans(&generation, " or ", |plan| plan.draw_count().to_string()),
        "passes": over_plans(&generation, " or ", |plan| plan.pass_count().to_string()),
        "deterministic": over_plans(&generation, " or ", |plan| yes(plan.arrival() != Arrival::Race)),
        "order_independent": over_plans(&generation, " or ", |plan| yes(plan.arrival() == Arrival::Any)),
        "features": over_plans(&generation, " or ", features),
        "targets": tiers,
    }))
}

/// What the first target's plan says, and what those of targets that follow another do.
fn over_plans(generation: &Generation, or: &str, said: impl Fn(&Plan) -> String) -> String {
    let mut words: Vec<String> = Vec::new();
    for planned in &generation.plans {
        let word = said(&planned.plan);
        if !words.contains(&word) {
            words.push(word);
        }
    }
    words.join(or)
}

fn yes(is_so: bool) -> String {
    if is_so { "yes" } else { "no" }.to_owned()
}

/// What a target must offer.
fn features(plan: &Plan) -> String {
    let words: Vec<String> = plan.requires.iter().map(|capability| capability.word()).collect();
    words.join("+")
}

/// Columns of the table, and the fields that they show.
const HEADS: [&str; 12] = [
    "key",
    "words/pixel",
    "bytes/pixel",
    "geometry",
    "draws",
    "passes",
    "same every frame",
    "any order",
    "tiers",
    "needs",
    "paper",
    "what",
];
const FIELDS: [&str; 12] = [
    "key",
    "words_per_pixel",
    "bytes_per_pixel",
    "geometry_passes",
    "draws",
    "passes",
    "deterministic",
    "order_independent",
    "tiers",
    "features",
    "paper",
    "summary",
];
const LAST: usize = 11;

/// The same as a table for people: one line per technique.
fn table(rows: &[Value]) -> String {
    let text = |value: &Value| value.as_str().map_or_else(|| value.to_string(), str::to_owned);
    let mut lines = vec![HEADS.map(str::to_owned)];
    for row in rows {
        let tiers = row["targets"].as_object().map(grouped).unwrap_or_default();
        let cells = FIELDS.map(|field| if field == "tiers" { tiers.clone() } else { text(&row[field]) });
        lines.push(cells);
    }
    let widths: Vec<usize> =
        (0..LAST).map(|column| lines.iter().map(|line| line[column].chars().count()).max().unwrap_or(0)).collect();
    let mut out = String::new();
    for line in lines {
        for (cell, width) in line.iter().zip(&widths) {
            out.push_str(&format!("{cell:width$}  "));
        }
        out.push_str(&line[LAST]);
        out.push('\n');
    }
    out
}

/// `T3 glsl spirv, T4 wgsl, no msl`: targets by tier; those last that cannot express it.
fn grouped(targets: &Map<String, Value>) -> String {
    let short = |verdict: &Value| match verdict.as_str() {
        Some(tier) if TIERS.contains(&tier) => tier.to_owned(),
        _ => "no".to_owned(),
    };
    let mut verdicts: Vec<String> = targets.values().map(short).collect();
    verdicts.sort_by_key(|verdict| (verdict == "no", verdict.clone()));
    verdicts.dedup();
    if let [only] = verdicts.as_slice() {
        return only.clone();
    }
    let group = |verdict: &String| {
        let names: Vec<&str> =
            targets.iter().filter(|(_, other)| short(other) == *verdict).map(|(name, _)| name.as_str()).collect();
        format!("{verdict} {}", names.join(" "))
    };
    verdicts.iter().map(group).collect::<Vec<_>>().join(", ")
}
