//! `fragbuf list --table-1`: Table 1 of the k⁺-buffer paper, with a column of ours beside each of its columns.
//!
//! In: the paper's rows and the registry. Out: Markdown. Our columns are computed from plans; none is written by hand.

use std::fmt::Write;

use fragbuf::vocabulary::Fact;
use fragbuf::{Arrival, Form, Plan, Registry, Request, TARGETS, Target, generate};
use fragbuf_model::{Draft, MOST_KEPT, Origin};
use fragbuf_templates::{PaperRow, TABLE_1};

use super::input::Input;
use super::output::Failure;

const HEAD: &str = "# Table 1 of the k⁺-buffer paper, and ours beside it

Vasilakis, Papaioannou & Fudos 2015 (K15), Table 1, as far as the text at hand can be read (`?` where it cannot). Left in each cell
what the paper says, right what the plan says: `paper → ours`; one word where they agree. Computed by `fragbuf list --table-1`.

* The paper's second figures pack two layers into one texel, because its buffers are textures and targets are few. Ours are
  buffers: packing is a matter of the payload's formats, and nothing limits k but what a shader can hold.
* *Primitives in order*: ours says so where what is kept depends on the order of arrival, or on races.
* *k up to*: the greatest that the rules accept, for the papers' payload.
* *Artifacts*: ours are the hazards that the rows state, by name; the pages beside this one say what each is.
* *Fixed*: whether memory is the same whatever is drawn; the paper's column is illegible.

| technique | geometry passes | primitives in order | fragments sorted | k up to | artifacts | words per pixel | fixed |
|---|---|---|---|---|---|---|---|
";

pub(super) fn table(registry: &Registry) -> Result<String, Failure> {
    let mut text = HEAD.to_owned();
    for row in TABLE_1 {
        line(&row, registry, &mut text)?;
    }
    Ok(text)
}

fn line(row: &PaperRow, registry: &Registry, text: &mut String) -> Result<(), Failure> {
    let mut input = Input::read(row.key, registry)?;
    let variant = input.variant(&[], registry)?;
    let targets: Vec<&'static Target> = TARGETS.iter().collect();
    let request = Request { targets: &targets, form: Form::Program, prefix: "", group: 0 };
    let generation = generate(&variant, &request, registry).map_err(|faults| input.failure(faults))?;
    let Some(plan) = generation.plans.first().map(|planned| &planned.plan) else { return Ok(()) };
    // Where targets differ, the one that needs least memory has what the paper supposes.
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

fn both(paper: &str, ours: &str) -> String {
    let shown = |text: &str| if text.is_empty() { "none".to_owned() } else { text.to_owned() };
    if paper == ours { shown(ours) } else { format!("{} → {}", shown(paper), shown(ours)) }
}

/// When fragments come in the order of depth: a storage that offers it has them so when they are stored.
fn sorted(plan: &Plan) -> &'static str {
    let gathered = plan.selection.rows.iter().filter(|selected| selected.row.offers.contains(&Fact::StableSort));
    let sorts = gathered.flat_map(|selected| &selected.row.offers).any(|fact| *fact == Fact::Sorted);
    if sorts { "resolve" } else { "store" }
}

/// The greatest k that the rules accept.
fn most(key: &str, registry: &Registry) -> String {
    let accepts = |k: u32| {
        let origin = Origin::new(key, 1, 1);
        let mut draft = Draft::from_technique(key, &origin);
        draft.set("k", &k.to_string(), &origin).is_ok() && fragbuf::check(&draft, registry).is_ok()
    };
    (0..=MOST_KEPT.ilog2())
        .rev()
        .map(|power| 1 << power)
        .find(|k| accepts(*k))
        .map_or("?".to_owned(), |k| k.to_string())
}
