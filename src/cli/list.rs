//! `fragbuf list`: what there is, computed from the rows.

use fragbuf::{Form, Generation, Registry, Request, TARGETS, TIERS, Target, generate, tier};
use fragbuf_templates::vocabulary::Technique;
use serde_json::{Map, Value, json};

use super::input::Input;
use super::output::{self, Failure};

#[derive(clap::Args)]
pub(crate) struct List {
    /// As JSON
    #[arg(long)]
    json: bool,
}

impl List {
    pub(crate) fn run(&self) -> Result<(), Failure> {
        let registry = Registry::builtin();
        let rows: Vec<Value> =
            registry.techniques().iter().map(|technique| row(technique, &registry)).collect::<Result<_, _>>()?;
        output::print(&if self.json { output::json(&Value::from(rows)) } else { table(&rows) })
    }
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
        "words_per_pixel": words(&generation),
        "geometry_passes": passes,
        "targets": tiers,
    }))
}

/// Those of the first target's plan, and what they are on targets that follow another.
fn words(generation: &Generation) -> String {
    let mut words: Vec<&str> = Vec::new();
    for planned in &generation.plans {
        if !words.contains(&planned.plan.words_per_pixel.as_str()) {
            words.push(&planned.plan.words_per_pixel);
        }
    }
    words.join(" or ")
}

/// The same as a table for people: one line per technique.
fn table(rows: &[Value]) -> String {
    let text = |value: &Value| value.as_str().map_or_else(|| value.to_string(), str::to_owned);
    let mut lines = vec![["key", "words/pixel", "geometry", "tiers", "paper", "what"].map(str::to_owned)];
    for row in rows {
        let tiers = row["targets"].as_object().map(grouped).unwrap_or_default();
        let cells = ["key", "words_per_pixel", "geometry_passes"].map(|field| text(&row[field]));
        let [key, words, passes] = cells;
        lines.push([key, words, passes, tiers, text(&row["paper"]), text(&row["summary"])]);
    }
    let widths: Vec<usize> =
        (0..5).map(|column| lines.iter().map(|line| line[column].chars().count()).max().unwrap_or(0)).collect();
    let mut out = String::new();
    for line in lines {
        for (cell, width) in line.iter().zip(&widths) {
            out.push_str(&format!("{cell:width$}  "));
        }
        out.push_str(&line[5]);
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
