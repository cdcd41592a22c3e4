//! Retry counters: the words of a loop that only limit how often it is repeated.
//!
//! Input: the instructions of a program and their liveness. Output: per loop, the words that begin at a constant, change by one
//! per attempt and are compared with constants, where the comparison only leaves the loop. Nothing else in the program depends on
//! such a word, so two machines that differ in it alone behave alike until the limit is reached. The tests `progress` of the
//! checker cover it.

mod flow;

use std::collections::BTreeSet;
use std::ops::Range;

use crate::live::Liveness;
use crate::operation::{Op, OperandUse, Word};

use flow::{Comparison, CounterUses, Domain, Flow};

/// The least number of attempts of a loop that [`Bytecode::is_same_attempt`](crate::Bytecode::is_same_attempt) does not
/// distinguish. A loop with fewer is short enough to be followed to its end.
pub const LEAST_RETRY_LIMIT: u32 = 32;

/// A loop with retry counters.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct RetryLoop {
    /// Its instructions.
    pub(crate) instructions: Range<u32>,
    pub(crate) counters: Vec<Word>,
}

/// Returns every loop that has a retry counter. `first_constant` is the first word of `constants`.
pub(crate) fn retry_loops(ops: &[Op], live: &Liveness, first_constant: Word, constants: &[u32]) -> Vec<RetryLoop> {
    let predecessors = predecessors(ops);
    let loops = ops.iter().enumerate().filter_map(|(at, op)| match op {
        Op::Jump { to } if (*to as usize) <= at => Some(*to as usize..at + 1),
        _ => None,
    });
    let with_counters = loops.map(|range| {
        let flow = Flow { ops, live, range: range.clone(), first_constant, constants };
        let mut limits = BTreeSet::new();
        let mut is_counter = |word: &Word| {
            let is_limit = |uses: &CounterUses| {
                initial_values(&flow, &predecessors, *word).is_some_and(|from| has_many(uses, from))
            };
            let uses = flow.uses(*word).filter(is_limit);
            limits.extend(uses.iter().flat_map(|uses| &uses.limits));
            uses.is_some()
        };
        let counters: Vec<Word> = flow.candidates().into_iter().filter(|word| is_counter(word)).collect();
        // A loop that only its counters end does not wait for anything.
        let counters = if flow.has_other_exit(&limits) { counters } else { Vec::new() };
        RetryLoop { instructions: range.start as u32..range.end as u32, counters }
    });
    with_counters.filter(|one| !one.counters.is_empty()).collect()
}

/// Returns the instructions after which each instruction runs.
fn predecessors(ops: &[Op]) -> Vec<Vec<usize>> {
    let mut predecessors = vec![Vec::new(); ops.len()];
    for (at, op) in ops.iter().enumerate() {
        for next in op.successors(at).into_iter().flatten() {
            if let Some(before) = predecessors.get_mut(next) {
                before.push(at);
            }
        }
    }
    predecessors
}

/// Returns the values of a variable when the loop begins. `None`: one is not constant.
fn initial_values(flow: &Flow<'_>, predecessors: &[Vec<usize>], variable: Word) -> Option<BTreeSet<u32>> {
    let (mut values, mut seen) = (BTreeSet::new(), BTreeSet::new());
    let mut pending = vec![flow.range.start];
    while let Some(at) = pending.pop() {
        if at == 0 {
            return None;
        }
        for &before in predecessors[at].iter().filter(|before| at != flow.range.start || !flow.range.contains(before)) {
            let mut op = flow.ops[before];
            let mut is_written = false;
            op.visit_operands(&mut |touch, first, count| {
                is_written |= touch != OperandUse::Read && (*first..*first + count).contains(&variable);
            });
            if is_written {
                values.insert(flow.copied_constant(before)?);
            } else if seen.insert(before) {
                pending.push(before);
            }
        }
    }
    Some(values)
}

/// Returns whether a counter always changes in one direction, and no comparison changes its result within
/// [`LEAST_RETRY_LIMIT`] attempts.
fn has_many(uses: &CounterUses, initial: BTreeSet<u32>) -> bool {
    let [step] = uses.steps.iter().copied().collect::<Vec<_>>()[..] else { return false };
    let initial: BTreeSet<u32> = initial.union(&uses.resets).copied().collect();
    let attempts = |comparison: &Comparison| initial.iter().map(|from| attempts(*from, step > 0, *comparison)).min();
    uses.comparisons.iter().filter_map(attempts).min().is_some_and(|least| least >= LEAST_RETRY_LIMIT)
}

/// Returns after how many steps of one the result of a comparison may change: at its constant, or where values wrap around.
fn attempts(from: u32, is_up: bool, comparison: Comparison) -> u32 {
    let distance = |to: u32| if is_up { to.wrapping_sub(from) } else { from.wrapping_sub(to) };
    let last = match (comparison.domain, is_up) {
        (Domain::Unsigned, true) => u32::MAX,
        (Domain::Unsigned, false) => 0,
        (Domain::Signed, true) => i32::MAX as u32,
        (Domain::Signed, false) => i32::MIN as u32,
        (Domain::Equality, _) => comparison.constant,
    };
    distance(comparison.constant).min(distance(last))
}
