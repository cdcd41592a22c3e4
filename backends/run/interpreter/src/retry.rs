//! Retry counters: the words of a loop that only limit how often it is repeated.
//!
//! Input: the instructions of a program and their liveness. Output: per loop, the words that are incremented and compared with
//! a constant, where the comparison only leaves the loop. Nothing else in the program depends on such a word, so two machines
//! that differ in it alone behave alike until the limit is reached. The tests `progress` of the checker cover it.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

use crate::arithmetic::unary;
use crate::live::Liveness;
use crate::operation::{Op, OperandUse, Word};
use crate::scalar::Binary;

/// The least limit of a loop whose attempts [`Bytecode::is_same_attempt`](crate::Bytecode::is_same_attempt) ignores. A loop with
/// a lower limit is short enough to be followed to its end.
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
    let loops = ops.iter().enumerate().filter_map(|(at, op)| match op {
        Op::Jump { to } if (*to as usize) <= at => Some(*to as usize..at + 1),
        _ => None,
    });
    let with_counters = loops.map(|range| {
        let analysis = LoopAnalysis { ops, live, range, first_constant, constants };
        let counters = analysis.increments().into_iter().filter(|word| analysis.only_limits(*word)).collect();
        RetryLoop { instructions: analysis.range.start as u32..analysis.range.end as u32, counters }
    });
    with_counters.filter(|one| !one.counters.is_empty()).collect()
}

struct LoopAnalysis<'a> {
    ops: &'a [Op],
    live: &'a Liveness,
    range: Range<usize>,
    first_constant: Word,
    constants: &'a [u32],
}

impl LoopAnalysis<'_> {
    /// Returns the variables that the loop increments or decrements by a constant.
    fn increments(&self) -> Vec<Word> {
        let steps = self.ops[self.range.clone()].iter().filter_map(|op| match *op {
            Op::Binary { op: Binary::Add | Binary::Subtract, to, a, b } => {
                (self.constant(a).is_some() || self.constant(b).is_some()).then_some(to)
            }
            _ => None,
        });
        let steps: Vec<Word> = steps.collect();
        let mut variables: Vec<Word> = self.ops[self.range.clone()]
            .iter()
            .filter_map(|op| match *op {
                Op::Copy { to, from, count: 1 } if steps.contains(&from) => Some(to),
                _ => None,
            })
            .collect();
        variables.sort_unstable();
        variables.dedup();
        variables
    }

    fn constant(&self, word: Word) -> Option<u32> {
        self.constants.get(word.checked_sub(self.first_constant)? as usize).copied()
    }

    /// Returns whether the loop uses a variable for nothing but its limit, and nothing after the loop uses it.
    fn only_limits(&self, variable: Word) -> bool {
        // The words that are derived from the variable before each instruction. Words are reused, so they differ.
        let mut derived: BTreeMap<usize, BTreeSet<Word>> = BTreeMap::from([(self.range.start, [variable].into())]);
        let mut pending = vec![self.range.start];
        while let Some(at) = pending.pop() {
            let before = derived.get(&at).cloned().unwrap_or_default();
            let Some(after) = self.derived_after(at, variable, before) else { return false };
            for next in self.ops[at].successors(at).into_iter().flatten() {
                if !self.range.contains(&next) {
                    if after.iter().any(|word| self.live.is_live(next, *word)) {
                        return false;
                    }
                    continue;
                }
                let is_known = derived.contains_key(&next);
                let words = derived.entry(next).or_default();
                let count = words.len();
                words.extend(&after);
                if !is_known || words.len() > count {
                    pending.push(next);
                }
            }
        }
        true
    }

    /// Returns the words that are derived from the variable after an instruction. `None`: it uses one for something else, or
    /// sets the variable to anything but such a word or a constant.
    fn derived_after(&self, at: usize, variable: Word, mut derived: BTreeSet<Word>) -> Option<BTreeSet<Word>> {
        let (mut reads, mut written) = (false, Vec::new());
        let mut op = self.ops[at];
        op.visit_operands(&mut |touch, first, count| match touch {
            OperandUse::Read => reads |= (*first..*first + count).any(|word| derived.contains(&word)),
            OperandUse::Write | OperandUse::WriteSome => written.extend(*first..*first + count),
        });
        let result = if reads { self.result(at, &derived)? } else { None };
        let sets_constant = matches!(op, Op::Copy { from, count: 1, .. } if self.constant(from).is_some());
        if written.contains(&variable) && result != Some(variable) && !sets_constant {
            return None;
        }
        written.iter().for_each(|word| {
            derived.remove(word);
        });
        derived.extend(result);
        Some(derived)
    }

    /// Returns the word that an instruction derives from such words. The outer `None`: it uses them for something else.
    fn result(&self, at: usize, derived: &BTreeSet<Word>) -> Option<Option<Word>> {
        match self.ops[at] {
            Op::Copy { to, count: 1, .. } | Op::Unary { to, .. } => Some(Some(to)),
            Op::Binary { op, to, a, b } => {
                let constant = self.constant(a).or(self.constant(b));
                let is_allowed = match op {
                    Binary::Add | Binary::Subtract => constant.is_some(),
                    Binary::LessU
                    | Binary::LessEqualU
                    | Binary::LessS
                    | Binary::LessEqualS
                    | Binary::Equal
                    | Binary::NotEqual => {
                        constant.is_some_and(|limit| (limit as i32).unsigned_abs() >= LEAST_RETRY_LIMIT)
                    }
                    Binary::And | Binary::Or => derived.contains(&a) && derived.contains(&b),
                    _ => false,
                };
                is_allowed.then_some(Some(to))
            }
            Op::JumpUnless { to, .. } => (self.leaves(at + 1) || self.leaves(to as usize)).then_some(None),
            _ => None,
        }
    }

    /// Returns whether an instruction leads out of the loop, and on the way there are only constants and jumps.
    fn leaves(&self, mut at: usize) -> bool {
        let mut known: BTreeMap<Word, u32> = BTreeMap::new();
        for _ in 0..self.range.len() {
            let value = |word: Word| self.constant(word).or_else(|| known.get(&word).copied());
            match self.ops.get(at) {
                _ if !self.range.contains(&at) => return true,
                Some(Op::Jump { to }) => at = *to as usize,
                Some(Op::JumpUnless { condition, to }) => match value(*condition) {
                    Some(0) => at = *to as usize,
                    Some(_) => at += 1,
                    None => return false,
                },
                Some(Op::Copy { to, from, count: 1 }) => match value(*from) {
                    Some(value) => {
                        known.insert(*to, value);
                        at += 1;
                    }
                    None => return false,
                },
                Some(Op::Unary { op, to, a }) => match value(*a) {
                    Some(value) => {
                        known.insert(*to, unary(*op, value));
                        at += 1;
                    }
                    None => return false,
                },
                _ => return false,
            }
        }
        false
    }
}
