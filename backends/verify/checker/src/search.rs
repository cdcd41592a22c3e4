//! The parts that every search shares: the property that it checks, its steps, and what it finds.

use std::ops::Range;

use crate::state::StepError;

/// A property of states that a search checks.
pub(crate) trait Property {
    /// Returns what is wrong with memory at an instant.
    fn instant(&mut self, words: &[u32]) -> Option<String>;
    /// Returns the words that `instant` observes.
    fn watched(&self) -> Vec<Range<usize>> {
        Vec::new()
    }
    /// Returns the verdict on memory in a final state.
    fn final_state(&mut self, words: &[u32]) -> StateVerdict;
}

/// The verdict on a final state.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum StateVerdict {
    Correct,
    /// Wrong, with a description, but permitted by the declared hazards.
    Hazard(String),
    Wrong(String),
    /// The frame is not over: a loop draws the pass again.
    NextIteration,
}

/// One step: the fragment, and the number of the way in which its event is performed, or [`RUN_ON`].
pub(crate) type Step = (usize, u32);

/// A step in which a fragment runs on alone, and observes the latest writes, until it changes something or leaves its loop.
pub(crate) const RUN_ON: u32 = u32::MAX;

/// What a search found.
#[derive(Debug, Default)]
pub(crate) struct SearchResult {
    pub(crate) states: usize,
    /// Whether every state was followed and decided; false if some were beyond the limit, or a loop was too long to run to its end.
    pub(crate) is_exhaustive: bool,
    pub(crate) failure: Option<Failure>,
    /// The first wrong final state that the declared hazards permit.
    pub(crate) hazard: Option<Failure>,
    /// Memory in final states from which the pass is drawn again, and the steps that reached each first.
    pub(crate) next_iterations: Vec<(Vec<u32>, Vec<Step>)>,
}

impl SearchResult {
    /// Returns the result without a failure that decides nothing.
    pub(crate) fn decided(self) -> Self {
        match &self.failure {
            Some(failure) if failure.is_undecided() => {
                SearchResult { failure: None, hazard: None, is_exhaustive: false, ..self }
            }
            _ => self,
        }
    }

    /// Records the verdict on a final state that the steps lead to; returns the failure, if it is one.
    pub(crate) fn record(
        &mut self,
        verdict: StateVerdict,
        words: &[u32],
        steps: impl FnOnce() -> Vec<Step>,
    ) -> Option<Failure> {
        match verdict {
            StateVerdict::Correct => None,
            StateVerdict::Wrong(text) => Some(Failure { steps: steps(), kind: FailureKind::FinalState(text) }),
            StateVerdict::Hazard(text) => {
                self.hazard.get_or_insert_with(|| Failure { steps: steps(), kind: FailureKind::FinalState(text) });
                None
            }
            StateVerdict::NextIteration => {
                if !self.next_iterations.iter().any(|(known, _)| known == words) {
                    self.next_iterations.push((words.to_vec(), steps()));
                }
                None
            }
        }
    }
}

/// A failure, and the steps that lead to it.
#[derive(Clone, Debug)]
pub(crate) struct Failure {
    pub(crate) steps: Vec<Step>,
    pub(crate) kind: FailureKind,
}

impl Failure {
    /// Returns whether it decides nothing: a loop was too long to be followed.
    pub(crate) fn is_undecided(&self) -> bool {
        matches!(self.kind, FailureKind::Step(_, StepError::TooLong))
    }
}

/// What went wrong.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum FailureKind {
    /// The final state is wrong, as the property describes.
    FinalState(String),
    /// Memory is wrong at an instant, as the property describes.
    Instant(String),
    /// No fragment can run, and these wait.
    Deadlock(Vec<usize>),
    /// No steps lead from here to a final state of these.
    Livelock(Vec<usize>),
    /// A step of this fragment fails.
    Step(usize, StepError),
}
