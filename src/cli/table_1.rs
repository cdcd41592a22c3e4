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

/// The properties of a technique, each with its heading, what the paper says, and what follows from the plan.
pub(super) struct Properties {
    pub(super) key: String,
    pub(super) name: String,
    pub(super) cells: [Cell; 7],
}

/// One property.
pub(super) struct Cell {
    #[cfg_attr(not(feature = "figures"), allow(dead_code, reason = "the table of figures prints it"))]
    pub(super) heading: &'static str,
    /// `None`: the technique or the column is not in the legible part of the paper's table.
    pub(super) paper: Option<&'static str>,
    pub(super) plan: String,
}

/// Returns the table.
pub(super) fn table(registry: &Registry) -> Result<String, Failure> {
    let mut text = HEADER.to_owned();
    for row in TABLE_1 {
        let Some(properties) = properties(row.key, row.name, Some(&row), registry)? else { continue };
        let cells: Vec<String> = properties.cells.iter().map(both).collect();
        let _ = writeln!(text, "| [{}]({}.md) | {} |", properties.name, properties.key, cells.join(" | "));
    }
    Ok(text)
}

/// Returns the properties of a technique, with those of its row in the paper.
pub(super) fn properties(
    key: &str,
    name: &str,
    row: Option<&PaperRow>,
    registry: &Registry,
) -> Result<Option<Properties>, Failure> {
    let mut input = Input::read(key, registry)?;
    let variant = input.variant(&[], registry)?;
    let targets: Vec<&'static Target> = TARGETS.iter().collect();
    let request = Request { targets: &targets, form: Form::Program, prefix: "", group: 0 };
    let generation = generate(&variant, &request, registry).map_err(|errors| input.failure(errors))?;
    let Some(plan) = generation.plans.first().map(|planned| &planned.plan) else { return Ok(None) };
    // If plans differ, the one that needs least memory has the features that the paper assumes.
    let least = generation.plans.last().map_or(plan, |planned| &planned.plan);
    let hazards: Vec<&str> = least.hazards.iter().map(|hazard| hazard.name.as_ref()).collect();
    let cell = |heading, paper, plan: &str| Cell { heading, paper, plan: plan.to_owned() };
    let cells = [
        cell("geometry passes", row.map(|row| row.geometry_passes), &plan.geometry_passes),
        cell(
            "primitives in order",
            row.map(|row| row.sorted_primitives),
            if plan.arrival() == Arrival::Any { "no" } else { "yes" },
        ),
        cell("fragments sorted", row.map(|row| row.sorted_fragments), sorted(plan)),
        cell("k up to", row.map(|row| row.most), &most(key, registry)),
        cell("artifacts", row.map(|row| row.artifacts), &hazards.join(", ")),
        cell("words per pixel", row.map(|row| row.words), &least.words_per_pixel),
        cell("fixed", None, if least.words_per_pixel.contains('f') { "no" } else { "yes" }),
    ];
    Ok(Some(Properties { key: key.to_owned(), name: name.to_owned(), cells }))
}

/// Returns the text of a cell with both values, or one if they agree.
pub(super) fn both(cell: &Cell) -> String {
    let shown = |text: &str| if text.is_empty() { "none".to_owned() } else { text.to_owned() };
    match cell.paper {
        Some(paper) if paper != cell.plan => format!("{} → {}", shown(paper), shown(&cell.plan)),
        _ => shown(&cell.plan),
    }
}

/// Returns when fragments are sorted by depth: `store` if the storage keeps them sorted, else `resolve`.
fn sorted(plan: &Plan) -> &'static str {
    let mut sorts = plan.selection.rows.iter().filter(|selected| selected.row.axis == "sort");
    let sorts = sorts.any(|selected| selected.row.provides.contains(&Capability::Sorted));
    if sorts { "resolve" } else { "store" }
}

/// Returns the greatest k that the rules accept; `all`: the technique keeps every fragment, and has no k.
fn most(key: &str, registry: &Registry) -> String {
    let accepts = |k: u32| {
        let span = SourceSpan::new(key, 1, 1);
        let mut draft = Draft::from_technique(key, &span);
        draft.set("k", &k.to_string(), &span).is_ok() && fragbuf::check(&draft, registry).is_ok()
    };
    (0..=MAX_K.ilog2()).rev().map(|power| 1 << power).find(|k| accepts(*k)).map_or("all".to_owned(), |k| k.to_string())
}
