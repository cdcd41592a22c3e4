//! The hazards that rows declare: each of them occurs, and no other failure does.

use fragbuf_checker::{Limits, Model, Report};
use fragbuf_templates::Registry;
use fragbuf_templates::vocabulary::{KeptFragments, Permits, Row};

use crate::subjects::{limits, report};

/// Technique, changes, storage.
type Racy = (&'static str, &'static [(&'static str, &'static str)], &'static str);

/// Every technique whose rows declare hazards that need a race, with a description that shows each of them.
const RACY: [Racy; 4] = [
    ("kb", &[], "sorted_array"),
    // An entry of several words, so that it can be torn.
    ("kb_mdt32", &[("fragment.color", "vec4")], "distinct_cascade"),
    ("kb_multi", &[("fragment.color", "vec4"), ("k", "2")], "multipass_array"),
    ("kb_mha", &[("storage.retries", "0"), ("k", "2")], "checksummed_array"),
];

fn checked((key, set, _): &Racy, model: Model, registry: &Registry) -> Report {
    let report = report(key, set, "wgsl", &limits(2, model), registry).unwrap();
    assert!(report.is_exhaustive || !report.is_declared, "{key} has states beyond the limit");
    report
}

/// Returns whether a failure under one of the models is not a declared hazard.
fn fails(racy: &Racy, registry: &Registry) -> bool {
    [Model::Sequential, Model::Relaxed].into_iter().any(|model| !checked(racy, model, registry).is_declared)
}

/// Returns the registry with a changed storage row.
fn with(key: &str, change: impl FnOnce(&mut Row)) -> Registry {
    let registry = Registry::builtin();
    let mut row = registry.row("storage", key).unwrap().clone();
    change(&mut row);
    registry.with(row)
}

#[test]
fn every_failure_matches_a_declared_hazard() {
    for racy in &RACY {
        for model in [Model::Sequential, Model::Relaxed] {
            let report = checked(racy, model, &Registry::builtin());
            assert!(report.failure.is_some() && report.is_declared, "{} {model:?}: {:#?}", racy.0, report.failure);
        }
    }
}

/// By default the check stops at two fragments. Three show no other hazards.
#[test]
fn three_fragments_show_only_declared_hazards() {
    let limits = Limits { fragments: vec![3], entries: vec![1, 2], ..limits(2, Model::Sequential) };
    let report = report("kb", &[], "wgsl", &limits, &Registry::builtin()).unwrap();
    assert!(report.is_exhaustive && report.is_declared, "{:#?}", report.failure);
    assert!(report.cases > 50 && report.states > 500_000, "{} cases, {} states", report.cases, report.states);
}

#[test]
fn a_row_with_an_undeclared_hazard_fails() {
    for racy in &RACY {
        let hazards = Registry::builtin().row("storage", racy.2).unwrap().hazards.clone();
        assert!(hazards.len() > 1);
        for hazard in hazards {
            assert!(hazard.permits.is_something(), "{} permits nothing", hazard.name);
            let registry = with(racy.2, |row| row.hazards.retain(|other| other.name != hazard.name));
            assert!(fails(racy, &registry), "{} without {}", racy.0, hazard.name);
        }
    }
}

/// The permits of a hazard count, whatever its name is. A name alone permits nothing.
#[test]
fn a_hazard_without_permits_permits_nothing() {
    let renamed = with("sorted_array", |row| {
        row.hazards.iter_mut().for_each(|hazard| hazard.name = format!("my-{}", hazard.name).into());
    });
    assert!(!fails(&RACY[0], &renamed));
    let named = with("sorted_array", |row| {
        row.hazards.iter_mut().for_each(|hazard| hazard.permits = Permits::NOTHING);
    });
    assert!(fails(&RACY[0], &named));
}

/// Groups can follow the fragments of a pixel: those that hold fragments are numbered in order, and the last of k has the rest.
#[test]
fn groups_follow_the_fragments_where_a_row_says_so() {
    let holds = |kept: KeptFragments| {
        let registry = with("adaptive_ranges", |row| row.keeps = Some(kept));
        let report = report("bad", &[("k", "2")], "wgsl", &limits(3, Model::Sequential), &registry).unwrap();
        assert!(report.is_kept_set_checked);
        report.failure.is_none()
    };
    const BUCKET: &str = "(depth_steps - nearest_steps) * 32 * OCCUPANCY_WORDS / (farthest_steps - nearest_steps + 1)";
    assert!(holds(KeptFragments::best_of_each_of_k(BUCKET)));
    // Every bucket would be a group, or the whole range one.
    assert!(!holds(KeptFragments::best_of_each(BUCKET)));
    assert!(!holds(KeptFragments::best_of_each_of_k("0 * depth_steps")));
}

/// The row's own formula decides which fragments are kept: the checker has no list of rules.
#[test]
fn the_kept_set_is_what_the_row_declares() {
    let holds = |kept: KeptFragments| {
        let registry = with("depth_ranges", |row| row.keeps = Some(kept));
        let set = [("sync", "spin_lock")];
        let report = report("depth_partition", &set, "spirv", &limits(2, Model::Sequential), &registry).unwrap();
        assert!(report.is_kept_set_checked);
        report.failure.is_none()
    };
    assert!(holds(KeptFragments::best_of_each("min(k - 1, depth_millionths * k / 1000000)")));
    assert!(!holds(KeptFragments::best_of_each("min(k, depth_millionths * (k + 1) / 1000000)")));
    assert!(!holds(KeptFragments::best_of_each("key")));
    for kept in [KeptFragments::best(), KeptFragments::worst()] {
        assert!(!holds(kept.clone()), "{kept:?}");
    }
}

/// A failure beyond the declared hazards is not excused by them.
#[test]
fn a_racy_row_that_is_wrong_beyond_its_hazards_fails() {
    let changes = [
        // Words that no fragment has.
        ("carried = resident;", "carried = packed_of_key(resident.key + 1u);"),
        // More fragments are counted than arrived.
        (
            "on_lost(pixel, carried, DISPLACED);",
            "on_lost(pixel, carried, DISPLACED); on_lost(pixel, carried, DISPLACED);",
        ),
        // A loss that no hazard permits.
        ("on_lost(pixel, carried, DISPLACED);", "on_lost(pixel, carried, POOL_EXHAUSTED);"),
    ];
    for (before, after) in changes {
        let registry = with("sorted_array", |row| {
            let template = row.template.as_mut().unwrap();
            assert!(template.source.contains(before));
            template.source = template.source.replace(before, after).into();
        });
        assert!(!checked(&RACY[0], Model::Sequential, &registry).is_declared, "{after}");
    }
}

/// Rows that merge displaced fragments into kept ones, each with a technique that supports it.
const MERGING: [(&str, &str); 2] = [("merge_last", "kplus_array"), ("merge_closest", "kb_ps")];

fn blended(overflow: &str, key: &str, registry: &Registry) -> Report {
    let set = [("overflow", overflow), ("sync", "spin_lock"), ("cull", "none")];
    report(key, &set, "spirv", &limits(2, Model::Sequential), registry).unwrap()
}

/// Returns the registry with one changed overflow row.
fn with_overflow(key: &str, change: impl FnOnce(&mut Row)) -> Registry {
    let registry = Registry::builtin();
    let mut row = registry.row("overflow", key).unwrap().clone();
    change(&mut row);
    registry.with(row)
}

fn replace(row: &mut Row, before: &str, after: &str) {
    let template = row.template.as_mut().unwrap();
    assert!(template.source.contains(before), "{before}");
    template.source = template.source.replace(before, after).into();
}

#[test]
fn a_row_that_merges_must_declare_and_do_it() {
    for (overflow, key) in MERGING {
        let registry = with_overflow(overflow, |row| row.merges = None);
        let undeclared = blended(overflow, key, &registry);
        assert!(undeclared.failure.is_some() && !undeclared.is_declared, "{overflow}");
        // Displaced fragments are dropped, which changes no word but a colour.
        let registry = with_overflow(overflow, |row| replace(row, "reason == DISPLACED", "reason == POOL_EXHAUSTED"));
        let dropped = blended(overflow, key, &registry);
        assert!(dropped.failure.is_some() && !dropped.is_declared, "{overflow}");
    }
}

/// The tail has plain words, so a fragment may access it only inside the critical section.
#[test]
fn a_tail_that_is_blended_outside_the_lock_is_a_race() {
    assert_eq!(blended("tail_blend", "kb_ps", &Registry::builtin()).failure, None);
    let registry = with_overflow("tail_blend", |row| replace(row, "reason == DISPLACED", "reason != POOL_EXHAUSTED"));
    let report = blended("tail_blend", "kb_ps", &registry);
    let failure = report.failure.filter(|_| !report.is_declared);
    let violation = failure.map(|schedule| schedule.violation).unwrap_or_default();
    assert!(violation.contains("data race"), "{violation}");
}
