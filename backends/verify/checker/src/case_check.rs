//! Runs the cases of a check on several threads, and records their results in order.
//!
//! Input: a subject and its cases. Output: the report is the same as if one case had run after the other. A case whose fragments
//! and memory are those of an earlier one has the same result, and is not searched again.

use std::collections::HashMap;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::ops::ControlFlow;
use std::sync::{Arc, Mutex, PoisonError};

use crate::case::Case;
use crate::case_run::CaseRun;
use crate::case_setup::{CaseSetup, SearchOptions};
use crate::fragments::Fragment;
use crate::frame::Frame;
use crate::in_order::{run_in_order, threads};
use crate::report::{Schedule, schedule};
use crate::subject::Subject;
use crate::turn::Turns;
use crate::verdict::Report;

/// One search: a case, and how to search it.
pub(crate) struct Task {
    pub(crate) case: Case,
    pub(crate) options: SearchOptions,
    /// Whether it is the first search of its case.
    pub(crate) is_first: bool,
}

/// The searches of a check that run at the same time.
pub(crate) struct CaseCheck<'s> {
    subject: &'s Subject,
    neighbour: &'s Fragment,
    tasks: &'s [Task],
    turns: Arc<Turns>,
    begun: Mutex<HashMap<u64, Vec<Begun<'s>>>>,
}

/// A task that has begun, as far as its result depends on it.
struct Begun<'s> {
    task: usize,
    identity: Case,
    occluded: Option<(f32, Fragment)>,
    frame: Frame<'s>,
    one_by_one: bool,
}

/// The result of a task.
enum Outcome {
    Searched(Box<CaseOutcome>),
    /// The result is that of an earlier task.
    SameAs(usize),
    /// An earlier task ends the check.
    Superfluous,
    Error(String),
}

/// The result of the searches of one task.
struct CaseOutcome {
    states: usize,
    is_exhaustive: bool,
    failure: Option<Schedule>,
    has_hazard: bool,
    /// The schedule of the hazard, unless an earlier task is known to have found one.
    hazard: Option<HazardOutcome>,
}

/// The schedule of a hazard.
struct HazardOutcome {
    /// States of the search for the shortest schedule.
    states: usize,
    is_exhaustive: bool,
    /// `None`: the search has decided nothing.
    schedule: Option<Schedule>,
    /// Whether the schedule is that of a failure that is no declared hazard.
    is_failure: bool,
}

impl<'s> CaseCheck<'s> {
    /// Takes the searches in their order. `limit`: the most states of one.
    pub(crate) fn new(subject: &'s Subject, neighbour: &'s Fragment, tasks: &'s [Task], limit: usize) -> Self {
        CaseCheck { subject, neighbour, tasks, turns: Turns::new(limit, threads()), begun: Mutex::default() }
    }

    /// Runs every task until one fails, and adds the results to a report.
    pub(crate) fn run(&self, report: &mut Report, progress: &mut dyn FnMut(&str)) -> Result<(), String> {
        let mut counts: Vec<(usize, bool)> = Vec::new();
        let mut error = Ok(());
        let has_hazard = report.failure.is_some();
        run_in_order(
            self.tasks.len(),
            |number| self.outcome(number, !has_hazard),
            |number, outcome| {
                let task = &self.tasks[number];
                let outcome = match outcome {
                    None => {
                        if task.is_first {
                            progress(&task.case.description);
                            report.cases += 1;
                            report.entries.extend(task.case.k.filter(|k| !report.entries.contains(k)));
                        }
                        return ControlFlow::Continue(());
                    }
                    Some(Outcome::Superfluous) => return ControlFlow::Break(()),
                    Some(Outcome::Error(text)) => {
                        error = Err(text);
                        return ControlFlow::Break(());
                    }
                    Some(Outcome::SameAs(other)) => {
                        let (states, is_exhaustive) = counts[other];
                        CaseOutcome { states, is_exhaustive, failure: None, has_hazard: false, hazard: None }
                    }
                    Some(Outcome::Searched(outcome)) => *outcome,
                };
                counts.push((outcome.states, outcome.is_exhaustive));
                let wants_hazard = report.failure.is_none() && outcome.has_hazard && outcome.failure.is_none();
                let hazard = match outcome.hazard {
                    _ if !wants_hazard => None,
                    Some(hazard) => Some(hazard),
                    // An earlier hazard was found and then not confirmed.
                    None => self
                        .case_run(number)
                        .and_then(|run| self.search(run, number, || true))
                        .ok()
                        .and_then(|outcome| outcome.hazard),
                };
                report.states += outcome.states;
                report.is_exhaustive &= outcome.is_exhaustive;
                if let Some(failure) = outcome.failure {
                    (report.failure, report.is_declared) = (Some(failure), false);
                    return ControlFlow::Break(());
                }
                if let Some(hazard) = hazard {
                    report.states += hazard.states;
                    report.is_exhaustive &= hazard.is_exhaustive;
                    report.is_declared = hazard.schedule.is_some() && !hazard.is_failure;
                    report.failure = hazard.schedule;
                    if hazard.is_failure {
                        return ControlFlow::Break(());
                    }
                }
                ControlFlow::Continue(())
            },
        );
        error
    }

    /// Runs a task.
    fn outcome(&self, number: usize, wants_hazard: bool) -> Outcome {
        let turn = self.turns.turn(number);
        if turn.is_superfluous() {
            return Outcome::Superfluous;
        }
        let outcome = self.run_task(number, wants_hazard);
        let ends_check = match &outcome {
            Outcome::Searched(outcome) => {
                outcome.failure.is_some() || outcome.hazard.as_ref().is_some_and(|hazard| hazard.is_failure)
            }
            Outcome::Error(_) => true,
            Outcome::SameAs(_) | Outcome::Superfluous => false,
        };
        if turn.is_superfluous() {
            return Outcome::Superfluous;
        }
        if ends_check {
            turn.end_check();
        }
        outcome
    }

    fn run_task(&self, number: usize, wants_hazard: bool) -> Outcome {
        let run = match self.case_run(number) {
            Ok(run) => run,
            Err(text) => return Outcome::Error(text),
        };
        if let Some(other) = self.begin(number, &run) {
            return Outcome::SameAs(other);
        }
        match self.search(run, number, || wants_hazard && self.turns.turn(number).is_first_hazard()) {
            Ok(outcome) => Outcome::Searched(Box::new(outcome)),
            Err(text) => Outcome::Error(text),
        }
    }

    fn case_run(&self, number: usize) -> Result<CaseRun<'s>, String> {
        let Task { case, options, .. } = &self.tasks[number];
        let setup = CaseSetup::new(self.subject, case.clone(), self.neighbour, options);
        CaseRun::new(setup, options, self.turns.turn(number))
    }

    /// Searches a task. `wants_hazard`: whether the schedule of a declared hazard is wanted, if there is one.
    fn search(
        &self,
        mut run: CaseRun<'s>,
        number: usize,
        wants_hazard: impl FnOnce() -> bool,
    ) -> Result<CaseOutcome, String> {
        let options = &self.tasks[number].options;
        let result = run.run(options)?;
        let mut outcome = CaseOutcome {
            states: result.states,
            is_exhaustive: result.is_exhaustive,
            failure: result.failure.map(|(iteration, failure)| schedule(&run, iteration, &failure)),
            has_hazard: result.hazard.is_some(),
            hazard: None,
        };
        let Some((iteration, found)) = result.hazard.filter(|_| outcome.failure.is_none()) else { return Ok(outcome) };
        if !wants_hazard() {
            return Ok(outcome);
        }
        let mut hazard = HazardOutcome { states: 0, is_exhaustive: true, schedule: None, is_failure: false };
        let mut failure = Some(found);
        if options.wants_shortest && options.random_schedules.is_none() {
            let shortest = run.shortest_hazard(iteration, options.limit);
            hazard.states = shortest.states;
            hazard.is_exhaustive = !shortest.has_forgotten;
            match shortest.failure {
                Some(other) if other.is_undecided() => (failure, hazard.is_exhaustive) = (None, false),
                Some(other) => (failure, hazard.is_failure) = (Some(other), !shortest.is_found),
                None => {}
            }
        }
        hazard.schedule = failure.map(|failure| schedule(&run, iteration, &failure));
        outcome.hazard = Some(hazard);
        Ok(outcome)
    }

    /// Records that a task begins; returns an earlier one with the same result.
    fn begin(&self, number: usize, run: &CaseRun<'s>) -> Option<usize> {
        let frame = &run.iterations.first()?.frame;
        let mut hasher = DefaultHasher::new();
        frame.memory.hash(&mut hasher);
        let (identity, occluded) = (run.setup.identity(), run.setup.occluded.clone());
        let one_by_one = self.tasks[number].options.one_by_one;
        let mut begun = self.begun.lock().unwrap_or_else(PoisonError::into_inner);
        let similar = begun.entry(hasher.finish()).or_default();
        let same = similar.iter().find(|other| {
            other.identity == identity
                && other.occluded == occluded
                && other.one_by_one == one_by_one
                && other.frame.is_same(frame)
        });
        if let Some(same) = same.filter(|same| same.task < number) {
            return Some(same.task);
        }
        similar.push(Begun { task: number, identity, occluded, frame: frame.clone(), one_by_one });
        None
    }
}

#[cfg(test)]
mod tests;
