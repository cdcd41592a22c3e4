//! Tests that a case that is not searched has the result that a search would have.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use fragbuf_model::{Draft, SourceSpan, check};
use fragbuf_targets::TARGETS;
use fragbuf_templates::Registry;
use fragbuf_templates::vocabulary::{Capability, Row};

use super::{CaseCheck, Outcome, Task};
use crate::case::cases;
use crate::case_setup::SearchOptions;
use crate::fragments::Candidates;
use crate::frame::Frame;
use crate::model::Model;
use crate::pool_case::ample_values;
use crate::subject::{RetryLimit, Subject};

/// The most states of a search. Where there are more, equal cases visit the same.
const STATES: usize = 2000;

fn options(model: Model, one_by_one: bool) -> SearchOptions {
    SearchOptions {
        model,
        random_schedules: None,
        limit: STATES,
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
    let is_changed = |row: &&Row| ["ties", "overflow"].contains(&row.axis.as_str());
    let changes: Vec<Option<&Row>> =
        std::iter::once(None).chain(registry.rows().iter().filter(is_changed).map(Some)).collect();
    for (technique, change) in registry.techniques().iter().flat_map(|one| changes.iter().map(move |row| (one, row))) {
        let key = technique.key.as_str();
        let mut draft = Draft::from_technique(key, &span);
        if let Some(row) = change {
            draft.set(&row.axis, &row.key, &span).unwrap();
        }
        let Ok(variant) = check(&draft, &registry) else { continue };
        let subject = |target| Subject::new(&variant, target, &registry, RetryLimit::AsDeclared).ok().flatten();
        let Some(subject) = TARGETS.iter().find_map(subject) else { continue };
        if subject.plan.selection.provides().contains(&Capability::FixedFunction) {
            continue;
        }
        let mut frame = Frame::new(&subject, ample_values(&subject).unwrap()).unwrap();
        let candidates = Candidates::new(&subject, &mut frame.memory).unwrap().ok().unwrap();
        let k = subject.keeps_best().then_some(3);
        let cases = cases(&subject, &candidates, (2, k), false).unwrap().into_iter();
        let tasks: Vec<Task> = cases
            .flat_map(|case| [false, true].map(|one_by_one| (case.clone(), one_by_one)))
            .map(|(case, one_by_one)| Task { case, options: options(Model::Sequential, one_by_one), is_first: true })
            .collect();
        let checked = CaseCheck::new(&subject, &candidates.ranked[11], &tasks, STATES);
        let result = |number: usize| {
            let outcome = checked.search(checked.case_run(number).unwrap(), number, || false).unwrap();
            let violation = outcome.failure.map(|failure| failure.violation);
            (outcome.states, outcome.is_exhaustive, outcome.has_hazard, violation)
        };
        for (number, task) in tasks.iter().enumerate() {
            match checked.run_task(number, false) {
                Outcome::SameAs(other) => {
                    assert!(other < number);
                    assert_eq!(result(number), result(other), "{key}: {}", task.case.description);
                    equal += 1;
                }
                _ => searched += 1,
            }
        }
    }
    assert!(searched > 1000 && equal > 100, "{searched} cases are searched, {equal} equal one of them");
}
