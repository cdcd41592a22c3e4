//! `fragbuf list`: lists techniques and axes, computed from the registry rows.

use fragbuf::analysis;
use fragbuf::{
    Arrival, Form, Generation, Plan, Registry, Request, TARGETS, TIERS, Target, generate, tier, tier_meaning,
};
use fragbuf_templates::vocabulary::{Row, Technique};
use serde_json::{Map, Value, json};

use super::input::Input;
use super::output::{self, Failure};

#[derive(clap::Args)]
pub(crate) struct List {
    /// Print JSON
    #[arg(long)]
    json: bool,
    /// Print every column, one line per technique: tiers per target, features and papers, too
    #[arg(long, conflicts_with = "json")]
    wide: bool,
    /// Print every column as Markdown
    #[arg(long, conflicts_with_all = ["json", "wide"])]
    markdown: bool,
    /// Print Table 1 of the k⁺-buffer paper, with the computed values, as Markdown
    #[arg(long, conflicts_with_all = ["json", "wide", "markdown"])]
    table_1: bool,
    /// Print the axes with their values and options as Markdown, the default value of each axis first
    #[arg(long, conflicts_with_all = ["json", "wide", "markdown", "table_1"])]
    axes: bool,
    /// Print the effects that `render --effect` draws, with their arguments, as Markdown
    #[cfg(feature = "pictures")]
    #[arg(long, conflicts_with_all = ["json", "wide", "markdown", "table_1", "axes"])]
    effects: bool,
}

impl List {
    pub(crate) fn run(&self) -> Result<(), Failure> {
        let registry = Registry::builtin();
        if self.table_1 {
            return output::print(&super::table_1::table(&registry)?);
        }
        #[cfg(feature = "pictures")]
        if self.effects {
            return output::print(&super::effects::markdown());
        }
        if self.axes {
            return output::print(&axes(&registry));
        }
        let rows: Vec<Value> =
            registry.techniques().iter().map(|technique| row(technique, &registry)).collect::<Result<_, _>>()?;
        let cells = || rows.iter().map(cells).collect::<Vec<_>>();
        output::print(&match self {
            List { json: true, .. } => output::json(&Value::from(rows)),
            List { wide: true, .. } => table(HEADINGS, &cells()),
            List { markdown: true, .. } => markdown(&cells()),
            _ => narrow(&rows),
        })
    }
}

/// Returns the table of the axes on which descriptions choose, with a summary of each value.
fn axes(registry: &Registry) -> String {
    let chosen = || registry.axes().iter().filter(|axis| axis.chosen);
    let without = chosen().filter(|axis| axis.default.is_none()).map(|axis| format!("`{}`", axis.key));
    let without = without.collect::<Vec<_>>().join(", ");
    let mut text = format!(
        "The first value of an axis is its default, unless the technique or another choice gives one. The axis {without} has no default: \
         a description without a technique must choose. Options are given in braces with their defaults: \
         `sync: spin_lock {{ limit: 4096 }}`.\n\n| axis | value | | options |\n|---|---|---|---|\n"
    );
    for axis in chosen() {
        let mut rows: Vec<&Row> = registry.rows_of(axis.key).filter(|row| !Registry::is_of_closures(row)).collect();
        rows.sort_by_key(|row| axis.default != Some(row.key.as_str()));
        for (number, row) in rows.iter().enumerate() {
            let name = if number == 0 { axis.key } else { "" };
            let options: Vec<String> = row.parameters.iter().map(analysis::option).collect();
            text.push_str(&format!("| {name} | `{}` | {} | {} |\n", row.key, row.summary, options.join("; ")));
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
    Ok(facts(technique, &generation))
}

/// Returns a technique that was generated for every target as JSON.
pub(crate) fn facts(technique: &Technique, generation: &Generation) -> Value {
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
    json!({
        "key": technique.key,
        "title": technique.title,
        "paper": technique.paper,
        "summary": technique.summary,
        "axes": axes,
        "words_per_pixel": over_plans(generation, " or ", |plan| plan.words_per_pixel.clone()),
        "bytes_per_pixel": over_plans(generation, " or ", |plan| plan.bytes_per_pixel().to_string()),
        "geometry_passes": passes,
        "draws": over_plans(generation, " or ", |plan| plan.draw_count().to_string()),
        "passes": over_plans(generation, " or ", |plan| plan.pass_count().to_string()),
        "deterministic": over_plans(generation, " or ", |plan| yes_or_no(plan.arrival() != Arrival::Race)),
        "order_independent": over_plans(generation, " or ", |plan| yes_or_no(plan.arrival() == Arrival::Any)),
        "features": over_plans(generation, " or ", features),
        "targets": tiers,
    })
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

/// Returns the cells of a technique, in the order of [`FIELDS`].
fn cells(row: &Value) -> [String; 12] {
    let text = |value: &Value| value.as_str().map_or_else(|| value.to_string(), str::to_owned);
    let tiers = row["targets"].as_object().map(grouped).unwrap_or_default();
    FIELDS.map(|field| if field == "tiers" { tiers.clone() } else { text(&row[field]) })
}

/// Returns a table with aligned columns.
fn table<const COLUMNS: usize>(headings: [&str; COLUMNS], rows: &[[String; COLUMNS]]) -> String {
    let lines: Vec<[String; COLUMNS]> =
        std::iter::once(headings.map(str::to_owned)).chain(rows.iter().cloned()).collect();
    let width = |column: usize| lines.iter().filter_map(|line| line.get(column)).map(|cell| cell.chars().count()).max();
    let widths: Vec<usize> = (0..COLUMNS).map(|column| width(column).unwrap_or(0)).collect();
    let line = |cells: &[String; COLUMNS]| {
        let padded = cells.iter().zip(&widths).map(|(cell, width)| format!("{cell:width$}"));
        format!("{}\n", padded.collect::<Vec<_>>().join("  ").trim_end())
    };
    lines.iter().map(line).collect()
}

/// Returns the table as Markdown. The key of a technique is a link to its page in the same folder.
fn markdown(rows: &[[String; HEADINGS.len()]]) -> String {
    let line = |cells: Vec<String>| format!("| {} |\n", cells.join(" | "));
    let mut text = PAGE_HEADER.replace("TIERS", &tiers());
    text.push_str(&line(HEADINGS.map(str::to_owned).to_vec()));
    text.push_str(&line(vec!["---".to_owned(); HEADINGS.len()]).replace(' ', ""));
    for row in rows {
        let link = row.iter().take(1).map(|key| format!("[`{key}`]({key}.md)"));
        text.push_str(&line(link.chain(row.iter().skip(1).cloned()).collect()));
    }
    text
}

/// Returns the tiers with their meanings, in Markdown.
pub(crate) fn tiers() -> String {
    TIERS.map(|tier| format!("**{tier}** {}", tier_meaning(tier))).join("; ")
}

/// The text before the table of [`markdown`]; `TIERS` is what [`tiers`] returns.
const PAGE_HEADER: &str = "\
# Techniques

Computed from the registry rows by `fragbuf list --markdown`. [table_1.md](table_1.md) compares them with Table 1 of the k⁺-buffer paper.

* *words/pixel*, *bytes/pixel*: memory for the papers' payload; f is the number of fragments of a pixel, n the greatest f, k the number kept.
* *geometry*: how often the scene is drawn. *draws* and *passes* of a frame include full-screen triangles and compute passes.
* *deterministic*: races do not change the image. *order-independent*: the image does not depend on the order in which fragments
  arrive. Both hold only if the counters report that no fragment overflowed or timed out.
* *tiers*: the mechanism that makes the technique sound under concurrency, for each target. TIERS.
* *features*: what the target, and then the device, must provide.

";

/// The width of a terminal that shows the table without `--wide`.
const WIDTH: usize = 80;

/// Returns the table that fits a terminal: a line of numbers per technique, and its summary below.
fn narrow(rows: &[Value]) -> String {
    let text = |value: &Value| value.as_str().map_or_else(|| value.to_string(), str::to_owned);
    let columns = ["key", "words_per_pixel", "draws", "passes", "deterministic"];
    let numbers: Vec<[String; 6]> = rows
        .iter()
        .map(|row| {
            let [key, words, draws, passes, deterministic] = columns.map(|field| text(&row[field]));
            [key, words, draws, passes, deterministic, row["targets"].as_object().map(range).unwrap_or_default()]
        })
        .collect();
    let table = table(["key", "words/pixel", "draws", "passes", "deterministic", "tiers"], &numbers);
    let mut lines = table.lines();
    let mut out = format!("{}\n", lines.next().unwrap_or_default());
    for (line, row) in lines.zip(rows) {
        out.push_str(&format!("{line}\n{}", indented(&text(&row["summary"]))));
    }
    out.push_str("\n`fragbuf list --wide` shows the tiers per target, the features and the papers.\n");
    out
}

/// Breaks a text into indented lines.
fn indented(text: &str) -> String {
    const INDENT: &str = "    ";
    let mut lines: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        match lines.last_mut().filter(|line| line.chars().count() + 1 + word.chars().count() <= WIDTH) {
            Some(line) => line.push_str(&format!(" {word}")),
            None => lines.push(format!("{INDENT}{word}")),
        }
    }
    lines.iter().map(|line| format!("{line}\n")).collect()
}

/// Returns the best and the worst tier of the targets, with a mark if some do not support the technique: `T2-T4`, `T1 (not all)`.
fn range(targets: &Map<String, Value>) -> String {
    let mut tiers: Vec<&str> = targets.values().filter_map(Value::as_str).filter(|tier| TIERS.contains(tier)).collect();
    let mark = if tiers.len() < targets.len() { " (not all)" } else { "" };
    tiers.sort_unstable();
    match (tiers.first(), tiers.last()) {
        (Some(best), Some(worst)) if best != worst => format!("{best}-{worst}{mark}"),
        (Some(only), _) => format!("{only}{mark}"),
        (None, _) => "none".to_owned(),
    }
}

/// Groups targets by tier: `T3 glsl spirv, T4 wgsl, no msl`. Unsupported targets are last.
pub(crate) fn grouped(targets: &Map<String, Value>) -> String {
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
