//! Tests that a case that is not searched has the result that a search would have.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use fragbuf_model::{Draft, SourceSpan, check};
use fragbuf_targets::TARGETS;
use fragbuf_templates::Registry;

use super::{CaseCheck, Outcome, Task};
use crate::case::cases;
use crate::case_setup::SearchOptions;
use crate::fragments::Candidates;
use crate::frame::Frame;
use crate::model::Model;
use crate::pool_case::ample_values;
use crate::subject::{RetryLimit, Subject};

fn options(model: Model, one_by_one: bool) -> SearchOptions {
    SearchOptions {
        model,
        random_schedules: None,
        limit: 4_000_000,
        may_time_out: false,
        one_by_one,
        is_reduced: true,
        wants_shortest: true,
    }
}

#[test]
fn an_equal_case_has_the_same_result() {
    let registry = Registry::builtin();
    let span = SourceSpan::new("test", 1, 1);
    let (mut searched, mut equal) = (0, 0);
    for (key, set) in [
        ("kb", None),
        ("kplus_array", None),
        ("kplus_heap", None),
        ("kb_ll", None),
        ("kplus_ab_sb", None),
        ("kb_stream", None),
        ("kb_multi", None),
        ("kb_ps", Some(("overflow", "tail_blend"))),
        ("kb_ps", Some(("ties", "submission"))),
    ] {
        let mut draft = Draft::from_technique(key, &span);
        for (name, value) in [("counters", "all")].into_iter().chain(set) {
            draft.set(name, value, &span).unwrap();
        }
        let sets = [&[][..], &[("sync", "interlock_ordered")], &[("cull", "none")]];
        let drafts = sets.into_iter().map(|more: &[(&str, &str)]| {
            let mut draft = draft.clone();
            for (name, value) in more {
                draft.set(name, value, &span).unwrap();
            }
            draft
        });
        // The first that is a legal description.
        let variant = drafts.filter_map(|draft| check(&draft, &registry).ok()).next().unwrap();
        let subject = |target| Subject::new(&variant, target, &registry, RetryLimit::AsDeclared).ok().flatten();
        let subject = TARGETS.iter().find_map(subject).unwrap();
        let mut frame = Frame::new(&subject, ample_values(&subject).unwrap()).unwrap();
        let candidates = Candidates::new(&subject, &mut frame.memory).unwrap().ok().unwrap();
        let tasks: Vec<Task> = [1, 2, 3]
            .into_iter()
            .flat_map(|k| cases(&subject, &candidates, (2, Some(k)), false).unwrap())
            .flat_map(|case| [false, true].map(|one_by_one| (case.clone(), one_by_one)))
            .map(|(case, one_by_one)| Task { case, options: options(Model::Sequential, one_by_one), is_first: true })
            .collect();
        let checked = CaseCheck::new(&subject, &candidates.ranked[11], &tasks, 4_000_000);
        let result = |number: usize| {
            let outcome = checked.search(checked.case_run(number).unwrap(), number, || false).unwrap();
            let violation = outcome.failure.map(|failure| failure.violation);
            (outcome.states, outcome.is_exhaustive, outcome.has_hazard, violation)
        };
        for number in 0..tasks.len() {
            match checked.run_task(number, false) {
                Outcome::SameAs(other) => {
                    assert!(other < number);
                    assert_eq!(result(number), result(other), "{key} {set:?}: {}", tasks[number].case.description);
                    equal += 1;
                }
                _ => searched += 1,
            }
        }
    }
    assert!(searched > 100 && equal > 100, "{searched} cases are searched, {equal} equal one of them");
}
