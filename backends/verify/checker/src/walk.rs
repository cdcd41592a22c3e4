//! Single schedules by chance, for more fragments than all orders can be tried of.
//!
//! In: a first state, a judge and seeds. Out: the first failure. Even seeds choose any fragment at every step; odd seeds
//! give fragments priorities and lower the one that runs at a few random steps (Burckhardt et al. 2010, PCT).

use fragbuf_interpreter::Machine;

use crate::explore::{End, Failure, Found, Judge, Step, What, racing};
use crate::state::{Ground, State};

/// Steps that a walk takes at most.
const LONGEST: usize = 100_000;

/// One walk per seed.
pub(crate) fn walk(ground: &Ground<'_>, first: &State, judge: &mut dyn Judge, seeds: u32) -> Found {
    let mut found = Found::default();
    let mut machine = Machine::new(ground.program);
    for seed in 0..seeds {
        let mut walker = Walker { ground, chance: Chance::new(seed), steps: Vec::new(), by_priority: seed % 2 == 1 };
        let end = walker.run(&mut machine, first.clone(), judge);
        found.states += walker.steps.len();
        found.failure = match end {
            Err(what) => Some(Failure { steps: walker.steps, what }),
            Ok(None) => None,
            Ok(Some((end, words))) => found.note(end, &words, || walker.steps),
        };
        if found.failure.is_some() {
            break;
        }
    }
    found
}

struct Walker<'a, 'p> {
    ground: &'a Ground<'p>,
    chance: Chance,
    steps: Vec<Step>,
    by_priority: bool,
}

impl<'p> Walker<'_, 'p> {
    /// `Ok(None)`: it did not come to an end in time.
    fn run(
        &mut self,
        machine: &mut Machine<'p>,
        mut state: State,
        judge: &mut dyn Judge,
    ) -> Result<Option<(End, Vec<u32>)>, What> {
        let mut priorities: Vec<u32> = state.fragments.iter().map(|_| self.chance.below(1 << 20)).collect();
        while self.steps.len() < LONGEST {
            if let Some((one, other)) = racing(self.ground, &state) {
                return Err(What::Race(one, other));
            }
            let running = self.ground.running(&state);
            if running.is_empty() {
                let words = state.left_behind(self.ground);
                return Ok(Some((judge.end(&words), words)));
            }
            let able: Vec<usize> = running
                .iter()
                .copied()
                .filter(|at| self.ground.choices(&state, *at) > 0 && !self.ground.waits(machine, &state, *at))
                .collect();
            if able.is_empty() {
                return Err(What::Waiting(running));
            }
            let fragment = self.pick(&able, &mut priorities);
            let choice = self.chance.below(self.ground.choices(&state, fragment));
            self.steps.push((fragment, choice));
            match self.ground.step(machine, &state, fragment, choice) {
                Err(mishap) => return Err(What::Mishap(fragment, mishap)),
                Ok((next, _)) => {
                    if next.words != state.words
                        && let Some(text) = judge.instant(&next.words)
                    {
                        return Err(What::Instant(text));
                    }
                    state = next;
                }
            }
        }
        Ok(None)
    }

    fn pick(&mut self, able: &[usize], priorities: &mut [u32]) -> usize {
        if !self.by_priority {
            return able[self.chance.below(able.len() as u32) as usize];
        }
        let highest = able.iter().copied().max_by_key(|at| priorities[*at]).unwrap_or(able[0]);
        if self.chance.below(16) == 0 {
            priorities[highest] = self.chance.below(priorities[highest].max(1));
        }
        highest
    }
}

/// Numbers by chance (xorshift), the same for the same seed.
struct Chance(u64);

impl Chance {
    fn new(seed: u32) -> Self {
        Chance((u64::from(seed) + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15))
    }

    fn below(&mut self, bound: u32) -> u32 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        ((self.0 >> 33) % u64::from(bound.max(1))) as u32
    }
}
