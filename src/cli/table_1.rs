//! `fragbuf list --table-1`: prints Table 1 of the k⁺-buffer paper, with the computed value of each cell.
//!
//! Input: the paper's rows and the registry. Output: Markdown. fragbuf's values are computed from plans.

use std::fmt::Write;

use fragbuf::vocabulary::Capability;
use fragbuf::{Arrival, Form, Plan, Registry, Request, TARGETS, Target, generate};
use fragbuf_model::{Draft, MAX_K, SourceSpan};
use fragbuf_templates::{PaperRow, TABLE_1};

use super::input::Input;
use super::output::Failure;

const HEADER: &str = "# Table 1 of the k⁺-buffer paper, with the values of fragbuf

Vasilakis, Papaioannou & Fudos 2015 (K15), Table 1. `?` marks what is illegible in the available copy. Each cell has the value of the paper
and that of the plan: `paper → plan`, or one value if they agree. Computed by `fragbuf list --table-1`.

* The paper's second figures pack two layers into one texel, because its buffers are textures and few targets are available. fragbuf
  uses buffers: the payload's formats decide the packing, and only what a shader can hold limits k.
* *Primitives in order*: the plan says `yes` if the kept fragments depend on the order of arrival, or on races.
* *k up to*: the greatest k that the rules accept, for the papers' payload.
* *Artifacts*: the plan lists the hazards that its rows declare, by name; the pages of the techniques describe each.
* *Fixed*: whether memory use is independent of the scene; the paper's column is illegible.

| technique | geometry passes | primitives in order | fragments sorted | k up to | artifacts | words per pixel | fixed |
|---|---|---|---|---|---|---|---|
";

/// Returns the table.
pub(super) fn table(registry: &Registry) -> Result<String, Failure> {
    let mut text = HEADER.to_owned();
    for row in TABLE_1 {
        line(&row, registry, &mut text)?;
    }
    Ok(text)
}

/// Writes the line of one technique.
fn line(row: &PaperRow, registry: &Registry, text: &mut String) -> Result<(), Failure> {
    let mut input = Input::read(row.key, registry)?;
    let variant = input.variant(&[], registry)?;
    let targets: Vec<&'static Target> = TARGETS.iter().collect();
    let request = Request { targets: &targets, form: Form::Program, prefix: "", group: 0 };
    let generation = generate(&variant, &request, registry).map_err(|errors| input.failure(errors))?;
    let Some(plan) = generation.plans.first().map(|planned| &planned.plan) else { return Ok(()) };
    // If plans differ, the one that needs least memory has the features that the paper assumes.
    let least = generation.plans.last().map_or(plan, |planned| &planned.plan);
    let hazards: Vec<&str> = least.hazards.iter().map(|hazard| hazard.name.as_ref()).collect();
    let cells = [
        both(row.geometry_passes, &plan.geometry_passes),
        both(row.sorted_primitives, if plan.arrival() == Arrival::Any { "no" } else { "yes" }),
        both(row.sorted_fragments, sorted(plan)),
        both(row.most, &most(row.key, registry)),
        both(row.artifacts, &hazards.join(", ")),
        both(row.words, &least.words_per_pixel),
        if least.words_per_pixel.contains('f') { "no" } else { "yes" }.to_owned(),
    ];
    let _ = writeln!(text, "| [{}]({}.md) | {} |", row.name, row.key, cells.join(" | "));
    Ok(())
}

/// Returns one cell.
fn both(paper: &str, plan: &str) -> String {
    let shown = |text: &str| if text.is_empty() { "none".to_owned() } else { text.to_owned() };
    if paper == plan { shown(plan) } else { format!("{} → {}", shown(paper), shown(plan)) }
}

/// Returns when fragments are sorted by depth: `store` if the storage keeps them sorted, else `resolve`.
fn sorted(plan: &Plan) -> &'static str {
    let gathered =
        plan.selection.rows.iter().filter(|selected| selected.row.provides.contains(&Capability::StableSort));
    let sorts =
        gathered.flat_map(|selected| &selected.row.provides).any(|capability| *capability == Capability::Sorted);
    if sorts { "resolve" } else { "store" }
}

/// Returns the greatest k that the rules accept.
fn most(key: &str, registry: &Registry) -> String {
    let accepts = |k: u32| {
        let span = SourceSpan::new(key, 1, 1);
        let mut draft = Draft::from_technique(key, &span);
        draft.set("k", &k.to_string(), &span).is_ok() && fragbuf::check(&draft, registry).is_ok()
    };
    (0..=MAX_K.ilog2()).rev().map(|power| 1 << power).find(|k| accepts(*k)).map_or("?".to_owned(), |k| k.to_string())
}
