//! Computes the properties of techniques that tables of papers state.
//!
//! Input: a table of a paper and the registry. Output: for each technique the paper's values beside those of its plan.
//! All of the latter follow from passes, resources, capabilities and hazards of the plan, apart from the number of
//! iterations, which is that of the row.

use fragbuf::vocabulary::{Capability, Element, Equivalence, FormulaError, Kind, Permits, Polynomial, Side, Soundness};
use fragbuf::{Arrival, Form, Plan, Registry, Request, TARGETS, Target, generate};
use fragbuf_codegen::{Action, PlannedResource};
use fragbuf_model::{Draft, MAX_K, SourceSpan};
use fragbuf_templates::{PaperRow, PaperTable, Property};

use super::input::Input;
use super::output::Failure;

/// The properties of a technique, each with its heading, what the paper says, and what follows from the plan.
pub(super) struct Properties {
    pub(super) key: String,
    pub(super) name: String,
    /// One per column of the table.
    pub(super) cells: Vec<Cell>,
}

/// One property.
#[cfg_attr(not(feature = "figures"), allow(dead_code, reason = "figures print heading and reason"))]
pub(super) struct Cell {
    pub(super) heading: &'static str,
    /// `None`: the technique or the column is not in the legible part of the paper's table.
    pub(super) paper: Option<&'static str>,
    pub(super) plan: String,
    /// Why the plan has another value, if the table says so.
    pub(super) reason: Option<&'static str>,
}

/// Returns the properties of a technique, with those of its row in the table if it has one. `None`: no target supports
/// it.
pub(super) fn properties(
    (key, name): (&str, &str),
    table: &PaperTable,
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
    let technique = Technique { key, row: table.rows.iter().find(|row| row.key == key), plan, least, registry };
    let cell = |(number, column): (usize, &fragbuf_templates::Column)| Cell {
        heading: column.heading,
        paper: technique.row.and_then(|row| row.cells.get(number).copied()),
        plan: technique.value(column.property),
        reason: technique.reason(column.property),
    };
    let cells = table.columns.iter().enumerate().map(cell).collect();
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

/// A technique with two of its plans.
struct Technique<'a> {
    key: &'a str,
    row: Option<&'a PaperRow>,
    plan: &'a Plan,
    /// The plan that needs least memory.
    least: &'a Plan,
    registry: &'a Registry,
}

impl Technique<'_> {
    fn reason(&self, property: Property) -> Option<&'static str> {
        let mut reasons = self.row?.reasons.iter();
        reasons.find(|(of, _)| *of == property).map(|(_, reason)| *reason)
    }

    /// Returns the formula of the number of iterations, if the frame has a loop with one.
    fn iterations(&self) -> Option<&'static str> {
        self.row.map(|row| row.iterations).filter(|iterations| !iterations.is_empty())
    }

    fn value(&self, property: Property) -> String {
        let yes_or_no = |is_so: bool| if is_so { "yes" } else { "no" }.to_owned();
        let (plan, least) = (self.plan, self.least);
        match property {
            Property::GeometryPasses => plan.geometry_passes.clone(),
            Property::PrimitivesInOrder => yes_or_no(plan.arrival() != Arrival::Any),
            Property::PrimitivesByDepth => yes_or_no(depends_on_order_of_depths(plan)),
            Property::FragmentsSorted => if resolve_sorts(plan) { "resolve" } else { "store" }.to_owned(),
            Property::ResolveSorts => yes_or_no(resolve_sorts(plan)),
            Property::MostK => most(self.key, self.registry),
            Property::Artifacts => {
                let hazards: Vec<&str> = least.hazards.iter().map(|hazard| hazard.name.as_ref()).collect();
                hazards.join(", ")
            }
            Property::Words => least.words_per_pixel.clone(),
            Property::FixedMemory => yes_or_no(!least.words_per_pixel.contains('f')),
            Property::FragmentsPerIteration => entries_per_pixel(least).to_string(),
            Property::PassesPerIteration => match self.iterations() {
                Some(_) => passes(plan).1.to_string(),
                None => plan.geometry_passes.clone(),
            },
            Property::TotalPasses => match self.iterations() {
                Some(iterations) => total(passes(plan), iterations),
                None => plan.geometry_passes.clone(),
            },
            Property::KeepsEqualDepths => match one_of(plan) {
                Equivalence::None => "yes",
                Equivalence::Fragments => "if they differ",
                Equivalence::Ids => "by ids",
                Equivalence::Keys => "no",
            }
            .to_owned(),
            Property::HitRatio => hit_ratio(plan).to_owned(),
        }
    }
}

/// Returns whether the resolve pass sorts fragments.
fn resolve_sorts(plan: &Plan) -> bool {
    let mut sorts = plan.selection.rows.iter().filter(|selected| selected.row.axis == "sort");
    sorts.any(|selected| selected.row.provides.contains(&Capability::Sorted))
}

/// Returns whether the image depends on the order in which fragments of different depths arrive.
fn depends_on_order_of_depths(plan: &Plan) -> bool {
    let keeps_best = plan.selection.kept().is_some_and(|kept| kept.side == Side::Best);
    let shows_order = |permits: &Permits| permits.order_dependent || permits.needs_race && permits.shows();
    !keeps_best
        || plan.selection.merges().is_some()
        || plan.soundness == Soundness::Racy
        || plan.hazards.iter().any(|hazard| shows_order(&hazard.permits))
}

/// Returns which fragments of equal depths are one to the plan, according to its hazards.
fn one_of(plan: &Plan) -> Equivalence {
    plan.hazards.iter().map(|hazard| hazard.permits.one_of).max().unwrap_or_default()
}

/// Returns R_h by D depths and f fragments of a pixel, for ids that differ.
fn hit_ratio(plan: &Plan) -> &'static str {
    let provides = plan.selection.provides();
    let keeps_all = provides.contains(&Capability::KeepsAll) || provides.contains(&Capability::KeepsLater);
    match (one_of(plan) == Equivalence::Keys, keeps_all) {
        (false, true) => "1",
        (true, true) => "D / f",
        (false, false) => "k / f to 1",
        (true, false) => "0 to min(k, D) / f",
    }
}

/// Returns how often the scene is drawn outside of loops, and in an iteration of the outermost loop.
pub(super) fn passes(plan: &Plan) -> (u64, u64) {
    let (mut outside, mut inside, mut depth) = (0, 0, 0_u32);
    for command in &plan.frame.commands {
        match command.action {
            Action::Loop(_) => depth += 1,
            Action::LoopEnd(_) => depth = depth.saturating_sub(1),
            Action::Pass(id) if plan.passes[id.0].kind == Kind::Geometry => match depth {
                0 => outside += 1,
                _ => inside += 1,
            },
            _ => {}
        }
    }
    (outside, inside)
}

/// Returns the formula of the draws of a frame.
fn total((outside, inside): (u64, u64), iterations: &str) -> String {
    let (formula, more) = match iterations.rsplit_once(" + ") {
        Some((formula, number)) => (formula, number.parse().unwrap_or(0)),
        None => (iterations, 0),
    };
    let all = if inside == 1 { formula.to_owned() } else { format!("{inside} * {formula}") };
    match inside * more + outside {
        0 => all,
        rest => format!("{all} + {rest}"),
    }
}

/// Returns the fragments of a pixel that memory has room for, in the notation of [`Plan::words_per_pixel`].
fn entries_per_pixel(plan: &Plan) -> Polynomial {
    let mut total = Polynomial::default();
    let mut counted: Vec<&str> = Vec::new();
    for planned in &plan.resources {
        // One of several textures stands for all words of its fragments.
        let name = planned.part.as_ref().map_or(planned.resource.name.as_str(), |part| &part.of);
        let has_fragments =
            planned.part.is_some() || matches!(planned.resource.element, Element::Entry | Element::Value);
        if has_fragments && !counted.contains(&name) {
            counted.push(name);
            total = total.plus(&entries(planned, plan).unwrap_or_default(), 1);
        }
    }
    let by = |name: &str, symbol: &str| total.coefficient(name).times(&Polynomial::symbol(symbol));
    let per_pixel = total.coefficient("pixels").plus(&by("fragments", "f"), 1).plus(&by("kept", "f_k"), 1);
    let of_capacity = per_pixel.coefficient(CAPACITY);
    per_pixel
        .plus(&of_capacity.times(&Polynomial::symbol(CAPACITY)), -1)
        .plus(&of_capacity.times(&Polynomial::symbol("k")), 1)
}

/// The symbol of the greatest k that generated code supports.
const CAPACITY: &str = "capacity";

/// Returns the fragments that a resource has room for.
fn entries(planned: &PlannedResource, plan: &Plan) -> Result<Polynomial, FormulaError> {
    let number = |name: &str| match name {
        "entry_words" | "value_words" => Some(1),
        CAPACITY => None,
        other => plan.symbols.number_of(other),
    };
    planned.words.formula().read()?.polynomial(&number)
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn draws_follow_from_iterations() {
        assert_eq!(total((0, 1), "D"), "D");
        assert_eq!(total((0, 2), "D + 1"), "2 * D + 2");
        assert_eq!(total((1, 1), "ceil_div(D, 2)"), "ceil_div(D, 2) + 1");
        assert_eq!(total((1, 3), "D * ceil_div(c, 2) + 1"), "3 * D * ceil_div(c, 2) + 4");
    }
}
