//! A loop that ends when a word is zero: every end of one round is the beginning of the next. The storage that does so
//! keeps the nearest distinct depths, if it has rounds enough.

use fragbuf_checker::{Limits, Model, Report};
use fragbuf_templates::Registry;
use fragbuf_templates::vocabulary::{Row, Step, Template, Until};

use crate::subjects::{limits, report};

/// Whether a row's passes are repeated until a word is zero.
pub(crate) fn is_repeated(row: &Row) -> bool {
    row.steps.iter().any(|step| matches!(step, Step::Repeat(repeat) if matches!(repeat.until, Until::Zero(_))))
}

/// The row with so many rounds; what too few of them do is not stated any more.
pub(crate) fn with_rounds(row: Row, rounds: u32) -> Row {
    let mut row = row;
    for step in &mut row.steps {
        if let Step::Repeat(repeat) = step {
            repeat.at_most = rounds.to_string().into();
        }
    }
    row.hazards.retain(|hazard| hazard.permits.where_counted.is_none());
    let last = format!("frame.iteration == {}u", rounds - 1);
    with_text(row, |text| text.replace("frame.iteration == frame.k", &last))
}

fn with_text(row: Row, change: impl FnOnce(&str) -> String) -> Row {
    let old = row.template.as_ref().unwrap();
    Row { template: Some(Template::new(old.path.clone(), change(&old.text))), ..row }
}

fn row() -> Row {
    Registry::builtin().row("storage", "repeated_array").unwrap().clone()
}

/// The row without something that its template says.
fn without(part: &str, instead: &str) -> Row {
    with_text(row(), |text| {
        assert_eq!(text.matches(part).count(), 1, "{part}");
        text.replace(part, instead)
    })
}

fn checked(row: Row, model: Model, entries: &[u32], fragments: u32) -> Report {
    let limits = Limits { fragments: vec![fragments], entries: entries.to_vec(), ..limits(2, model) };
    report("kb_multi", &[], "wgsl", &limits, &Registry::builtin().with(row)).unwrap()
}

/// What is kept in the end are the k nearest distinct depths; no counter says what became of the others.
fn holds(report: &Report) -> bool {
    report.is_whole && (report.failure.is_none() || report.is_stated)
}

#[test]
fn the_nearest_distinct_depths_are_kept_in_the_end() {
    for (model, entries, fragments) in
        [(Model::Sequential, &[1, 2][..], 3), (Model::Sequential, &[3], 2), (Model::Late, &[1, 2], 2)]
    {
        let report = checked(with_rounds(row(), 8), model, entries, fragments);
        assert!(holds(&report), "{model:?}: {:#?}", report.failure);
        assert!(report.cases > 20, "{} cases", report.cases);
    }
}

/// With the row's own k + 1 rounds, races can keep two fragments from settling: it is counted, and the row says so.
#[test]
fn too_few_rounds_are_counted_and_stated() {
    assert!(holds(&checked(row(), Model::Sequential, &[1, 2], 2)));
    let mut unstated = row();
    unstated.hazards.retain(|hazard| hazard.permits.where_counted.is_none());
    assert!(!holds(&checked(unstated, Model::Sequential, &[1], 2)));
    let uncounted = without("        count_loss(UNSETTLED);\n", "");
    assert!(!holds(&checked(uncounted, Model::Sequential, &[1], 2)));
}

#[test]
fn rounds_that_end_too_early_leave_what_races_have_lost() {
    let unsaid = without("    changed_store(1u);\n", "");
    let kept = without("                entries_store(slot, pixel, entry);\n", "");
    for (row, rounds) in [(row(), 1), (unsaid, 8), (kept, 8)] {
        assert!(!holds(&checked(with_rounds(row, rounds), Model::Sequential, &[1, 2], 2)), "{rounds}");
    }
}

/// As it is told elsewhere, a key that stands in a slot is written again and nothing else. Of three fragments two that are
/// alike can take both slots at once: then nobody gives one up, and the third stays out however often it comes.
#[test]
fn equal_keys_in_two_slots_drive_a_fragment_out_for_ever() {
    let row = without("repeated_array_empty(pixel, slot, entry.key);", "");
    let report = checked(with_rounds(row, 8), Model::Sequential, &[2], 3);
    assert!(!holds(&report));
    let schedule = report.failure.unwrap();
    assert!(schedule.case.contains("drawn 2 times"), "{schedule:#?}");
    assert!(schedule.steps.len() > 10);
}
