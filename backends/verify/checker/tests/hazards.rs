//! What rows state that may go wrong: all of it does, and nothing else.

use fragbuf_checker::{Limits, Model, Report};
use fragbuf_templates::Registry;
use fragbuf_templates::vocabulary::{Kept, Permits, Row};

use crate::subjects::{limits, report};

/// Technique, changes, storage.
type Racy = (&'static str, &'static [(&'static str, &'static str)], &'static str);

/// Every technique whose rows state hazards of races, so that each of them shows.
const STATED: [Racy; 4] = [
    ("kb", &[], "sorted_array"),
    // An entry of several words, so that it can be torn.
    ("kb_mdt32", &[("fragment.color", "vec4")], "distinct_cascade"),
    ("kb_multi", &[("fragment.color", "vec4"), ("k", "2")], "repeated_array"),
    ("kb_mha", &[("storage.retries", "0"), ("k", "2")], "checked_array"),
];

fn checked((key, set, _): &Racy, model: Model, registry: &Registry) -> Report {
    let report = report(key, set, "wgsl", &limits(2, model), registry).unwrap();
    assert!(report.is_whole || !report.is_stated, "{key} has states beyond the limit");
    report
}

/// Whether what goes wrong under one of the models is not stated.
fn fails(racy: &Racy, registry: &Registry) -> bool {
    [Model::Sequential, Model::Late].into_iter().any(|model| !checked(racy, model, registry).is_stated)
}

/// The registry with a row of the storage's that `change` has changed.
fn with(key: &str, change: impl FnOnce(&mut Row)) -> Registry {
    let registry = Registry::builtin();
    let mut row = registry.row("storage", key).unwrap().clone();
    change(&mut row);
    registry.with(row)
}

#[test]
fn whatever_goes_wrong_is_stated() {
    for racy in &STATED {
        for model in [Model::Sequential, Model::Late] {
            let report = checked(racy, model, &Registry::builtin());
            assert!(report.failure.is_some() && report.is_stated, "{} {model:?}: {:#?}", racy.0, report.failure);
        }
    }
}

/// By default no more fragments are tried than race; three do nothing that two do not.
#[test]
fn what_three_fragments_do_is_stated_too() {
    let limits = Limits { fragments: vec![3], entries: vec![1, 2], ..limits(2, Model::Sequential) };
    let report = report("kb", &[], "wgsl", &limits, &Registry::builtin()).unwrap();
    assert!(report.is_whole && report.is_stated, "{:#?}", report.failure);
    assert!(report.cases > 50 && report.states > 500_000, "{} cases, {} states", report.cases, report.states);
}

#[test]
fn a_row_that_states_fewer_hazards_than_it_has_fails() {
    for racy in &STATED {
        let hazards = Registry::builtin().row("storage", racy.2).unwrap().hazards.clone();
        assert!(hazards.len() > 1);
        for hazard in hazards {
            assert!(hazard.permits.is_something(), "{} permits nothing", hazard.name);
            let registry = with(racy.2, |row| row.hazards.retain(|other| other.name != hazard.name));
            assert!(fails(racy, &registry), "{} without {}", racy.0, hazard.name);
        }
    }
}

/// What a hazard permits is excused, whatever its name is; a name alone excuses nothing.
#[test]
fn a_hazard_that_permits_nothing_excuses_nothing() {
    let renamed = with("sorted_array", |row| {
        row.hazards.iter_mut().for_each(|hazard| hazard.name = format!("my-{}", hazard.name).into());
    });
    assert!(!fails(&STATED[0], &renamed));
    let named = with("sorted_array", |row| {
        row.hazards.iter_mut().for_each(|hazard| hazard.permits = Permits::NOTHING);
    });
    assert!(fails(&STATED[0], &named));
}

/// What stays is what the row says in its own words: the checker has no list of promises.
#[test]
fn a_row_keeps_what_it_says() {
    let holds = |kept: Kept| {
        let registry = with("depth_ranges", |row| row.keeps = Some(kept));
        let set = [("sync", "spin_lock")];
        let report = report("depth_partition", &set, "spirv", &limits(2, Model::Sequential), &registry).unwrap();
        assert!(report.is_judged);
        report.failure.is_none()
    };
    assert!(holds(Kept::best_of_each("min(k - 1, depth_millionths * k / 1000000)")));
    assert!(!holds(Kept::best_of_each("min(k, depth_millionths * (k + 1) / 1000000)")));
    assert!(!holds(Kept::best_of_each("key")));
    for kept in [Kept::best(), Kept::worst()] {
        assert!(!holds(kept.clone()), "{kept:?}");
    }
}

/// What is no hazard of the row's fails, stated hazards or not.
#[test]
fn a_racy_row_that_is_wrong_beyond_its_hazards_fails() {
    let changes = [
        // Words that no fragment has.
        ("carried = resident;", "carried = packed_of_key(resident.key + 1u);"),
        // More is counted than there is.
        (
            "on_lost(pixel, carried, DISPLACED);",
            "on_lost(pixel, carried, DISPLACED); on_lost(pixel, carried, DISPLACED);",
        ),
        // A loss that no race excuses.
        ("on_lost(pixel, carried, DISPLACED);", "on_lost(pixel, carried, POOL_EXHAUSTED);"),
    ];
    for (before, after) in changes {
        let registry = with("sorted_array", |row| {
            let template = row.template.as_mut().unwrap();
            assert!(template.text.contains(before));
            template.text = template.text.replace(before, after).into();
        });
        assert!(!checked(&STATED[0], Model::Sequential, &registry).is_stated, "{after}");
    }
}

/// Rows that merge or blend what is displaced, on a storage that can be asked for it.
const MERGING: [(&str, &str); 2] = [("merge_last", "kplus_array"), ("merge_closest", "kb_ps")];

fn blended(overflow: &str, key: &str, registry: &Registry) -> Report {
    let set = [("overflow", overflow), ("sync", "spin_lock"), ("cull", "none")];
    report(key, &set, "spirv", &limits(2, Model::Sequential), registry).unwrap()
}

/// The registry with one overflow row's text changed.
fn with_overflow(key: &str, change: impl FnOnce(&mut Row)) -> Registry {
    let registry = Registry::builtin();
    let mut row = registry.row("overflow", key).unwrap().clone();
    change(&mut row);
    registry.with(row)
}

fn replace(row: &mut Row, before: &str, after: &str) {
    let template = row.template.as_mut().unwrap();
    assert!(template.text.contains(before), "{before}");
    template.text = template.text.replace(before, after).into();
}

#[test]
fn who_merges_must_say_so_and_do_it() {
    for (overflow, key) in MERGING {
        let registry = with_overflow(overflow, |row| row.merges = None);
        let unsaid = blended(overflow, key, &registry);
        assert!(unsaid.failure.is_some() && !unsaid.is_stated, "{overflow}");
        // What is displaced is forgotten: no word but a colour tells.
        let registry = with_overflow(overflow, |row| replace(row, "reason == DISPLACED", "reason == POOL_EXHAUSTED"));
        let dropped = blended(overflow, key, &registry);
        assert!(dropped.failure.is_some() && !dropped.is_stated, "{overflow}");
    }
}

/// A tail of plain words is the critical section's: whoever gives up the lock must leave it alone.
#[test]
fn a_tail_that_is_blended_outside_the_lock_is_a_race() {
    assert_eq!(blended("tail_blend", "kb_ps", &Registry::builtin()).failure, None);
    let registry = with_overflow("tail_blend", |row| replace(row, "reason == DISPLACED", "reason != POOL_EXHAUSTED"));
    let report = blended("tail_blend", "kb_ps", &registry);
    let fault = report.failure.filter(|_| !report.is_stated).map(|schedule| schedule.fault).unwrap_or_default();
    assert!(fault.contains("race"), "{fault}");
}
