//! Runs single random schedules, for more fragments than all interleavings can be explored of.
//!
//! Input: a first state, a property and a number of seeds. Output: the first failure. An even seed chooses any fragment at
//! every step. An odd seed gives fragments priorities and lowers that of the running one at a few random steps
//! (Burckhardt et al. 2010, PCT).

use crate::context::SearchContext;
use crate::progress::RunOn;
use crate::runner::Runner;
use crate::search::{Failure, FailureKind, Property, RUN_ON, SearchResult, StateVerdict, Step};
use crate::state::{State, StepError};

/// The most steps of a schedule.
const LONGEST: usize = 100_000;

/// Runs one schedule per seed.
pub(crate) fn walk(
    context: &SearchContext<'_>,
    first: &State,
    property: &mut dyn Property,
    seeds: u32,
) -> SearchResult {
    let mut result = SearchResult::default();
    let mut runner = Runner::new(context);
    for seed in 0..seeds {
        let mut walk = RandomWalk { context, rng: Rng::new(seed), steps: Vec::new(), by_priority: seed % 2 == 1 };
        let end = walk.run(&mut runner, first.clone(), property);
        result.states += walk.steps.len();
        result.failure = match end {
            // It decides nothing, and other schedules may fail.
            Err(FailureKind::Step(_, StepError::TooLong)) => None,
            Err(kind) => Some(Failure { steps: walk.steps, kind }),
            Ok(None) => None,
            Ok(Some((verdict, words))) => result.record(verdict, &words, || walk.steps),
        };
        if result.failure.is_some() {
            break;
        }
    }
    result
}

struct RandomWalk<'a, 'p> {
    context: &'a SearchContext<'p>,
    rng: Rng,
    steps: Vec<Step>,
    by_priority: bool,
}

impl<'p> RandomWalk<'_, 'p> {
    /// Runs the schedule; returns its final state with the verdict. `Ok(None)`: it is longer than [`LONGEST`], or a loop is
    /// too long to run to its end.
    fn run(
        &mut self,
        runner: &mut Runner<'p>,
        mut state: State,
        property: &mut dyn Property,
    ) -> Result<Option<(StateVerdict, Vec<u32>)>, FailureKind> {
        let mut priorities: Vec<u32> = state.fragments.iter().map(|_| self.rng.below(1 << 20)).collect();
        // The fragments that have come back to an earlier status since another fragment changed something.
        let mut waits = vec![false; state.fragments.len()];
        while self.steps.len() < LONGEST {
            let running = self.context.running(&state);
            if running.is_empty() {
                let words = state.final_words(self.context);
                return Ok(Some((property.final_state(&words), words)));
            }
            let able = |at: &usize| self.context.choices(&state, *at) > 0 && !waits[*at];
            let able: Vec<usize> = running.iter().copied().filter(able).collect();
            if able.is_empty() {
                let Some(next) = self.run_on(runner, &state, &running)? else { return Ok(None) };
                state = next;
                waits.fill(false);
                continue;
            }
            let fragment = self.pick(&able, &mut priorities);
            let choice = self.rng.below(self.context.choices(&state, fragment));
            self.steps.push((fragment, choice));
            let stepped = match self.context.step(runner, &state, fragment, choice) {
                Err(error) => return Err(FailureKind::Step(fragment, error)),
                Ok(stepped) => stepped,
            };
            if stepped.state.words != state.words
                && let Some(text) = property.instant(&stepped.state.words)
            {
                return Err(FailureKind::Instant(text));
            }
            match stepped.has_effect {
                true => waits.fill(false),
                false => waits[fragment] = stepped.recurs,
            }
            state = stepped.state;
        }
        Ok(None)
    }

    /// Lets the first fragment run on alone that then changes something or leaves its loop; returns the state after that.
    /// `None`: there is none, but a loop is too long to decide whether its fragment waits.
    fn run_on(
        &mut self,
        runner: &mut Runner<'p>,
        state: &State,
        running: &[usize],
    ) -> Result<Option<State>, FailureKind> {
        let mut is_decided = true;
        for &fragment in running {
            match self.context.run_on(runner, state, fragment) {
                RunOn::Moved(next) => {
                    self.steps.push((fragment, RUN_ON));
                    return Ok(Some(next));
                }
                RunOn::Waits => {}
                RunOn::TooLong => is_decided = false,
                RunOn::Failed(kind) => {
                    self.steps.push((fragment, RUN_ON));
                    return Err(kind);
                }
            }
        }
        if is_decided { Err(FailureKind::Deadlock(running.to_vec())) } else { Ok(None) }
    }

    fn pick(&mut self, able: &[usize], priorities: &mut [u32]) -> usize {
        if !self.by_priority {
            return able[self.rng.below(able.len() as u32) as usize];
        }
        let highest = able.iter().copied().max_by_key(|at| priorities[*at]).unwrap_or(able[0]);
        if self.rng.below(16) == 0 {
            priorities[highest] = self.rng.below(priorities[highest].max(1));
        }
        highest
    }
}

/// A random number generator (xorshift): equal seeds give equal numbers.
struct Rng(u64);

impl Rng {
    fn new(seed: u32) -> Self {
        Rng((u64::from(seed) + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15))
    }

    fn below(&mut self, bound: u32) -> u32 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        ((self.0 >> 33) % u64::from(bound.max(1))) as u32
    }
}
