//! Templates that are wrong on purpose: errors of the papers, and common errors. Each must fail, with a schedule that
//! includes the wrong line.

use fragbuf_checker::{Model, Report};
use fragbuf_templates::Registry;
use fragbuf_templates::vocabulary::{Access, Element, Resource, Row, Step, Template, Use};

use crate::subjects::{limits, report};

const REPLACE: &str = include_str!("rows/replace_then_find.wgsl");
const COUNTER: &str = include_str!("rows/counter_before_insert.wgsl");
const TWO_WORDS: &str = include_str!("rows/two_word_bound.wgsl");
const REVISED: &str = include_str!("rows/revised_array.wgsl");
const PRINTED: &str = include_str!("rows/revised_sync.wgsl");
const CORRECTED: &str = include_str!("rows/corrected_sync.wgsl");

/// Returns the registry with another template for one row, and a change to how its passes access memory.
fn with(
    registry: Registry,
    axis: &str,
    key: &str,
    path: &'static str,
    text: &'static str,
    change: fn(&mut Row),
) -> Registry {
    let old = registry.row(axis, key).unwrap();
    let mut row = Row { template: Some(Template::new(path, text)), ..old.clone() };
    change(&mut row);
    registry.with(row)
}

fn checked(registry: &Registry, target: &str, model: Model) -> Report {
    report("kplus_array", &[], target, &limits(3, model), registry).unwrap()
}

/// Makes every use of a resource atomic.
fn atomic(row: &mut Row, resource: &str) {
    for step in &mut row.steps {
        if let Step::Pass(pass) = step {
            let is_one = |usage: &&mut Use| {
                usage.resource == resource && matches!(usage.access, Access::Coherent | Access::Hinted)
            };
            for usage in pass.uses.iter_mut().filter(is_one) {
                usage.access = Access::Atomic;
            }
        }
    }
}

#[test]
fn a_lock_is_not_enough_for_words_that_are_not_coherent() {
    let registry = Registry::builtin();
    let mut row = registry.row("storage", "max_array").unwrap().clone();
    for step in &mut row.steps {
        if let Step::Pass(pass) = step {
            for usage in pass.uses.iter_mut().filter(|usage| usage.access == Access::Coherent) {
                usage.access = Access::Plain;
            }
        }
    }
    let registry = registry.with(row);
    assert_eq!(checked(&registry, "spirv", Model::Sequential).failure, None);
    assert!(checked(&registry, "spirv", Model::Relaxed).failure.is_some());
}

fn assert_fails_at(report: &Report, text: &str, path: &str, statement: &str) {
    let schedule = report.failure.as_ref().expect("a failure");
    let line = text.lines().position(|line| line.contains(statement)).unwrap() + 1;
    let location = format!("{path}:{line}");
    assert!(schedule.steps.iter().any(|step| step.location == location), "no step at {location} in {schedule:#?}");
}

#[test]
fn slot_zero_replaced_before_the_new_worst_is_found() {
    let registry = with(Registry::builtin(), "storage", "max_array", "rows/replace_then_find.wgsl", REPLACE, |_| {});
    let report = checked(&registry, "wgsl", Model::Sequential);
    // The write is in a function of the template; its caller is the next line of the trace.
    assert_fails_at(&report, REPLACE, "rows/replace_then_find.wgsl", "keys_store(slot, pixel, entry.key);");
    assert!(report.failure.unwrap().violation.contains("storage_bound"));
}

#[test]
fn a_counter_that_is_full_too_early() {
    let registry =
        with(Registry::builtin(), "storage", "max_array", "rows/counter_before_insert.wgsl", COUNTER, |row| {
            atomic(row, "kept_counts");
        });
    let report = checked(&registry, "wgsl", Model::Sequential);
    assert_fails_at(&report, COUNTER, "rows/counter_before_insert.wgsl", "kept_counts_store(pixel, frame.k);");
}

#[test]
fn a_bound_of_two_words_is_read_torn() {
    let registry = with(Registry::builtin(), "storage", "max_array", "rows/two_word_bound.wgsl", TWO_WORDS, |row| {
        let halves = Resource::new("halves", Element::Word, "the key of slot 0").by("half", "2").by("pixel", "pixels");
        row.resources.push(halves);
        for step in &mut row.steps {
            if let Step::Pass(pass) = step {
                let access = if pass.name == "store" { Access::Atomic } else { Access::Plain };
                pass.uses.push(Use::new("halves", access));
            }
        }
    });
    let report = checked(&registry, "wgsl", Model::Sequential);
    assert_fails_at(&report, TWO_WORDS, "rows/two_word_bound.wgsl", "halves_store(0u, pixel, entry.key >> 16u);");
}

/// A row that stores its bound like the other keys: a plain word where the language can mix plain and atomic accesses.
#[test]
fn a_bound_that_is_not_published_is_a_data_race() {
    let published = Registry::builtin().row("storage", "max_array").unwrap().template.clone().unwrap().source;
    for (old, new) in [("keys_publish(", "keys_store("), ("keys_hint(", "keys_load(")] {
        assert!(published.contains(old), "{old}");
        let mut row = Registry::builtin().row("storage", "max_array").unwrap().clone();
        row.template = Some(Template::new("storage/max_array.wgsl", published.replace(old, new)));
        let registry = Registry::builtin().with(row);
        for model in [Model::Sequential, Model::Relaxed] {
            for target in ["spirv", "glsl", "glsl-vulkan", "glsl-es"] {
                let violation = checked(&registry, target, model).failure.expect(target).violation;
                assert!(
                    violation.starts_with("data race on keys[slot 0, pixel 0]"),
                    "{target}, {model:?}: {violation}"
                );
            }
            // WGSL declares the words atomic.
            assert_eq!(checked(&registry, "wgsl", Model::Sequential).failure, None);
        }
    }
}

fn revised(sync: &'static str) -> Registry {
    let registry = with(Registry::builtin(), "storage", "max_array", "rows/revised_array.wgsl", REVISED, |row| {
        atomic(row, "kept_counts");
        atomic(row, "keys");
    });
    with(registry, "sync", "spin_lock", "rows/revised_sync.wgsl", sync, |_| {})
}

#[test]
fn the_second_algorithm_of_the_k_plus_buffer_loses_fragments_as_printed() {
    let report = checked(&revised(PRINTED), "wgsl", Model::Sequential);
    assert_fails_at(&report, PRINTED, "rows/revised_sync.wgsl", "let reserved = kept_counts_atomic_add(pixel, 1u);");
}

#[test]
fn the_corrected_second_algorithm_holds() {
    // Under the relaxed model, waiting for several words takes many states. With two entries there is one word to wait for.
    let two_entries = fragbuf_checker::Limits { entries: vec![1, 2], ..limits(3, Model::Relaxed) };
    for (target, limits) in [("wgsl", limits(3, Model::Sequential)), ("spirv", two_entries)] {
        let report = report("kplus_array", &[], target, &limits, &revised(CORRECTED)).unwrap();
        assert!(report.is_exhaustive);
        let failure = report.failure.map(|schedule| (schedule.case, schedule.violation, schedule.steps.len()));
        assert_eq!(failure, None, "{target}");
    }
}
