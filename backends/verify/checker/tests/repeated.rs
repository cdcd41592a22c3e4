//! A loop until a word is zero: every final state of one iteration is the first state of the next. The storage with such a
//! loop keeps the nearest distinct depths if it has enough iterations.

use fragbuf_checker::{Limits, Model, Report};
use fragbuf_templates::Registry;
use fragbuf_templates::vocabulary::{Row, Step, Template, Until};

use crate::subjects::{limits, report};

/// Returns whether a row repeats passes until a word is zero.
pub(crate) fn is_repeated(row: &Row) -> bool {
    row.steps.iter().any(|step| matches!(step, Step::Repeat(repeat) if matches!(repeat.until, Until::WordIsZero(_))))
}

/// Returns the row with this many iterations, and without the hazards of too few.
pub(crate) fn with_iterations(row: Row, iterations: u32) -> Row {
    let mut row = row;
    for step in &mut row.steps {
        if let Step::Repeat(repeat) = step {
            repeat.at_most = iterations.to_string().into();
        }
    }
    row.hazards.retain(|hazard| hazard.permits.where_counted.is_none());
    let last = format!("frame.iteration == {}u", iterations - 1);
    with_text(row, |text| text.replace("frame.iteration == frame.k", &last))
}

fn with_text(row: Row, change: impl FnOnce(&str) -> String) -> Row {
    let old = row.template.as_ref().unwrap();
    Row { template: Some(Template::new(old.path.clone(), change(&old.source))), ..row }
}

fn row() -> Row {
    Registry::builtin().row("storage", "multipass_array").unwrap().clone()
}

/// Returns the row with a replacement in its template.
fn without(part: &str, instead: &str) -> Row {
    with_text(row(), |text| {
        assert_eq!(text.matches(part).count(), 1, "{part}");
        text.replace(part, instead)
    })
}

fn checked(row: Row, model: Model, entries: &[u32], fragments: u32) -> Report {
    let limits = Limits { fragments: vec![fragments], entries: entries.to_vec(), ..limits(2, model) };
    report("kb_multi", &[], "glsl", &limits, &Registry::builtin().with(row)).unwrap()
}

/// Returns whether the k nearest distinct depths are kept. No counter counts the others.
fn holds(report: &Report) -> bool {
    report.is_exhaustive && (report.failure.is_none() || report.is_declared)
}

#[test]
fn the_nearest_distinct_depths_are_kept() {
    for (model, entries, fragments) in
        [(Model::Sequential, &[1, 2][..], 3), (Model::Sequential, &[3], 2), (Model::Relaxed, &[1, 2], 2)]
    {
        let report = checked(with_iterations(row(), 8), model, entries, fragments);
        assert!(holds(&report), "{model:?}: {:#?}", report.failure);
        assert!(report.cases > 20, "{} cases", report.cases);
    }
}

/// With the row's own k + 1 iterations, races can prevent two fragments from converging. That is counted and declared.
#[test]
fn too_few_iterations_are_counted_and_declared() {
    assert!(holds(&checked(row(), Model::Sequential, &[1, 2], 2)));
    let mut undeclared = row();
    undeclared.hazards.retain(|hazard| hazard.permits.where_counted.is_none());
    assert!(!holds(&checked(undeclared, Model::Sequential, &[1], 2)));
    let uncounted = without("        count_loss(NOT_CONVERGED);\n", "");
    assert!(!holds(&checked(uncounted, Model::Sequential, &[1], 2)));
}

#[test]
fn a_loop_that_ends_too_early_loses_fragments_to_races() {
    let unmarked = without("    changed_store(1u);\n", "");
    let kept = without("                entries_store(slot, pixel, entry);\n", "");
    for (row, iterations) in [(row(), 1), (unmarked, 8), (kept, 8)] {
        assert!(!holds(&checked(with_iterations(row, iterations), Model::Sequential, &[1, 2], 2)), "{iterations}");
    }
}

/// The algorithm as published only rewrites a key that a slot already holds. Two equal fragments of three can take both
/// slots at the same time. Then neither slot is emptied, and the third fragment is lost in every iteration.
#[test]
fn equal_keys_in_two_slots_exclude_a_fragment() {
    let row = without("multipass_array_empty(pixel, slot, entry.key);", "");
    let report = checked(with_iterations(row, 8), Model::Sequential, &[2], 3);
    assert!(!holds(&report));
    let schedule = report.failure.unwrap();
    assert!(schedule.case.contains("drawn 2 times"), "{schedule:#?}");
    assert!(schedule.steps.len() > 10);
}
