//! `fragbuf list`: lists techniques and axes, computed from the registry rows.

use fragbuf::{Arrival, Form, Generation, Plan, Registry, Request, TARGETS, TIERS, Target, generate, tier};
use fragbuf_templates::vocabulary::{Row, Technique};
use serde_json::{Map, Value, json};

use super::input::Input;
use super::output::{self, Failure};

#[derive(clap::Args)]
pub(crate) struct List {
    /// Print JSON
    #[arg(long)]
    json: bool,
    /// Print Table 1 of the k⁺-buffer paper, with the computed values, as Markdown
    #[arg(long, conflicts_with = "json")]
    table_1: bool,
    /// Print the axes and their values as Markdown, the default value of each axis first
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

/// Returns the table of the axes on which descriptions choose, with a summary of each value.
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

/// Returns a technique as JSON.
fn row(technique: &Technique, registry: &Registry) -> Result<Value, Failure> {
    let mut input = Input::read(&technique.key, registry)?;
    let variant = input.variant(&[], registry)?;
    let targets: Vec<&'static Target> = TARGETS.iter().collect();
    let request = Request { targets: &targets, form: Form::Program, prefix: "", group: 0 };
    let generation = generate(&variant, &request, registry).map_err(|errors| input.failure(errors))?;
    let mut tiers = Map::new();
    for target in TARGETS {
        let planned = generation.plans.iter().find(|planned| planned.targets.iter().any(|t| t.name == target.name));
        let unsupported = generation.unsupported.iter().find(|(unsupported, _)| unsupported.name == target.name);
        let verdict = match (planned, unsupported) {
            (Some(planned), _) => tier(planned.plan.soundness, target).to_owned(),
            (None, Some((_, missing))) => missing.to_string(),
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
        "deterministic": over_plans(&generation, " or ", |plan| yes_or_no(plan.arrival() != Arrival::Race)),
        "order_independent": over_plans(&generation, " or ", |plan| yes_or_no(plan.arrival() == Arrival::Any)),
        "features": over_plans(&generation, " or ", features),
        "targets": tiers,
    }))
}

/// Returns a property of the plans. Different values, of targets with different plans, are joined by `separator`.
fn over_plans(generation: &Generation, separator: &str, property: impl Fn(&Plan) -> String) -> String {
    let mut values: Vec<String> = Vec::new();
    for planned in &generation.plans {
        let value = property(&planned.plan);
        if !values.contains(&value) {
            values.push(value);
        }
    }
    values.join(separator)
}

fn yes_or_no(is_so: bool) -> String {
    if is_so { "yes" } else { "no" }.to_owned()
}

/// Returns the features that a target must provide.
fn features(plan: &Plan) -> String {
    let names: Vec<String> = plan.requires.iter().map(|feature| feature.name()).collect();
    names.join("+")
}

/// The headings of the table, and the JSON field of each column.
const HEADINGS: [&str; 12] = [
    "key",
    "words/pixel",
    "bytes/pixel",
    "geometry",
    "draws",
    "passes",
    "deterministic",
    "order-independent",
    "tiers",
    "features",
    "paper",
    "summary",
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

/// Returns the table of techniques, one line each.
fn table(rows: &[Value]) -> String {
    let text = |value: &Value| value.as_str().map_or_else(|| value.to_string(), str::to_owned);
    let mut lines = vec![HEADINGS.map(str::to_owned)];
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

/// Groups targets by tier: `T3 glsl spirv, T4 wgsl, no msl`. Unsupported targets are last.
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
