//! A loop that ends when a word is zero: every end of one round is the beginning of the next.

use fragbuf_checker::{Limits, Model, Report};
use fragbuf_templates::Registry;
use fragbuf_templates::vocabulary::{Access, Element, Hazard, Pass, Repeat, Resource, Row, Step, Template, Until, Use};

use crate::subjects::{limits, report};

const REPEATED: &str = include_str!("rows/repeated.wgsl");

/// The sorted array's row with another template, whose store pass is drawn until `changed` stays zero.
fn registry(text: &str, at_most: &'static str) -> Registry {
    let old = Registry::builtin().row("storage", "sorted_array").unwrap().clone();
    let [reset, Step::Pass(store), resolve] = old.steps.as_slice() else { panic!("another row") };
    let store =
        Pass { uses: [store.uses.as_slice(), &[Use::new("changed", Access::Atomic)]].concat(), ..store.clone() };
    let round = Repeat {
        body: vec![Step::Clear { resource: "changed".to_owned(), value: 0 }, Step::Pass(store)],
        until: Until::Zero("changed".to_owned()),
        at_most: at_most.into(),
    };
    let changed = Resource::new("changed", Element::Word, "whether the pass has changed a key");
    let hazard = |name: &'static str| Hazard { name: name.into(), what: name.into(), unless: None };
    let row = Row {
        template: Some(Template::new("rows/repeated.wgsl", text.to_owned())),
        resources: old.resources.iter().cloned().chain([changed]).collect(),
        steps: vec![reset.clone(), Step::Repeat(round), resolve.clone()],
        hazards: ["equal-keys", "torn-equal-keys", "uncounted"].map(hazard).into(),
        implies: Vec::new(),
        ..old.clone()
    };
    Registry::builtin().with(row)
}

fn checked(registry: &Registry, model: Model, entries: &[u32], fragments: u32) -> Report {
    let limits = Limits { fragments: vec![fragments], entries: entries.to_vec(), ..limits(2, model) };
    report("kb", &[("sort", "insertion")], "wgsl", &limits, registry).unwrap()
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
        let report = checked(&registry(REPEATED, "8"), model, entries, fragments);
        assert!(holds(&report), "{model:?}: {:#?}", report.failure);
    }
}

/// A change that must be noticed, and whether it shows in one round already.
#[test]
fn rounds_that_end_too_early_leave_what_races_have_lost() {
    let unsaid = REPEATED.replacen(
        "    keys_store(worst_slot, pixel, entry.key);\n    changed_store(1u);",
        "    keys_store(worst_slot, pixel, entry.key);",
        1,
    );
    let kept = REPEATED.replacen("            entries_store(slot, pixel, entry);\n", "", 1);
    assert!(unsaid != REPEATED && kept != REPEATED);
    for (text, at_most) in [(REPEATED, "1"), (unsaid.as_str(), "8"), (kept.as_str(), "8")] {
        let report = checked(&registry(text, at_most), Model::Sequential, &[1, 2], 2);
        assert!(!holds(&report), "{at_most}\n{text}");
    }
}

/// As it is told elsewhere, a key that stands in a slot is written again and nothing else: two equal keys in two slots stay.
#[test]
fn equal_keys_in_two_slots_drive_a_fragment_out_for_ever() {
    let text = REPEATED.replacen("if key == entry.key && is_there {", "if false {", 1);
    let report = checked(&registry(&text, "8"), Model::Sequential, &[1, 2], 3);
    assert!(!holds(&report));
    let schedule = report.failure.unwrap();
    assert!(schedule.case.contains("drawn 2 times"), "{schedule:#?}");
    assert!(schedule.steps.len() > 10);
}
