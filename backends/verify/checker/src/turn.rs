//! The turn of a search among those of one check, which run on several threads.
//!
//! Results are recorded in the order of the turns, so a search after the first failure is superfluous and ends early. At any time
//! one search at most has more than its share of the states in memory.

use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// What the searches of a check share.
#[derive(Debug)]
pub(crate) struct Turns {
    /// The least turn that ends the check.
    last: AtomicUsize,
    /// The least turn that has found a declared hazard.
    first_hazard: AtomicUsize,
    /// The states that every search may have in memory.
    share: usize,
    /// Held by the search that has more.
    large: Mutex<()>,
}

/// The turn of one search.
#[derive(Clone, Debug)]
pub(crate) struct Turn {
    turns: Arc<Turns>,
    number: usize,
}

impl Turns {
    /// Returns the turns of searches of which so many run at a time. `limit`: the most states of one.
    pub(crate) fn new(limit: usize, threads: usize) -> Arc<Self> {
        Arc::new(Turns {
            last: AtomicUsize::new(usize::MAX),
            first_hazard: AtomicUsize::new(usize::MAX),
            share: limit / threads.max(1),
            large: Mutex::new(()),
        })
    }

    /// Returns the turn of a number.
    pub(crate) fn turn(self: &Arc<Self>, number: usize) -> Turn {
        Turn { turns: Arc::clone(self), number }
    }
}

impl Turn {
    /// Ends the check after this turn.
    pub(crate) fn end_check(&self) {
        self.turns.last.fetch_min(self.number, Ordering::Relaxed);
    }

    /// Returns whether an earlier turn ends the check.
    pub(crate) fn is_superfluous(&self) -> bool {
        self.turns.last.load(Ordering::Relaxed) < self.number
    }

    /// Records that the search has found a declared hazard; returns whether no earlier turn is known to have found one.
    pub(crate) fn is_first_hazard(&self) -> bool {
        self.turns.first_hazard.fetch_min(self.number, Ordering::Relaxed) > self.number
    }
}

/// How many states a search may visit.
pub(crate) struct Allowance<'a> {
    turn: Option<&'a Turn>,
    limit: usize,
    large: Option<MutexGuard<'a, ()>>,
}

impl<'a> Allowance<'a> {
    pub(crate) fn new(turn: Option<&'a Turn>, limit: usize) -> Self {
        Allowance { turn, limit, large: None }
    }

    /// Returns whether a search that has visited so many states must end. Waits while it may not have more in memory.
    pub(crate) fn is_used_up(&mut self, states: usize) -> bool {
        if let Some(turn) = self.turn {
            if turn.is_superfluous() {
                return true;
            }
            if states > turn.turns.share && self.large.is_none() {
                self.large = Some(turn.turns.large.lock().unwrap_or_else(PoisonError::into_inner));
            }
        }
        states >= self.limit
    }
}
