//! Liveness of words where a machine can stop, and the instructions in loops.
//!
//! A word is live if some path reads it before it is written. Machines that differ only in dead words behave alike, so a
//! search compares only live words.

use std::collections::BTreeMap;
use std::ops::Range;

use crate::memory::Atomic;
use crate::operation::{Op, OperandUse};

/// A set of words.
#[derive(Clone, PartialEq, Eq)]
pub(crate) struct WordSet(Vec<u64>);

impl WordSet {
    fn new(count: usize) -> Self {
        WordSet(vec![0; count.div_ceil(64)])
    }

    fn insert(&mut self, word: u32) {
        self.0[word as usize / 64] |= 1 << (word % 64);
    }

    fn remove(&mut self, word: u32) {
        self.0[word as usize / 64] &= !(1 << (word % 64));
    }

    pub(crate) fn contains(&self, word: u32) -> bool {
        self.0.get(word as usize / 64).is_some_and(|bits| bits >> (word % 64) & 1 == 1)
    }

    /// Adds the words of `other`; returns whether the set grew.
    fn extend(&mut self, other: &WordSet) -> bool {
        let mut grew = false;
        for (bits, more) in self.0.iter_mut().zip(&other.0) {
            grew |= *more & !*bits != 0;
            *bits |= more;
        }
        grew
    }

    fn ranges(&self, count: u32) -> Vec<Range<u32>> {
        let mut ranges: Vec<Range<u32>> = Vec::new();
        for word in (0..count).filter(|word| self.contains(*word)) {
            match ranges.last_mut() {
                Some(last) if last.end == word => last.end += 1,
                _ => ranges.push(word..word + 1),
            }
        }
        ranges
    }
}

/// The result of the analysis.
pub(crate) struct Liveness {
    /// The live words before every instruction that can stop a machine, constants excluded.
    pub(crate) at_stops: BTreeMap<u32, Vec<Range<u32>>>,
    /// The atomic operations whose result is dead.
    pub(crate) unread: Vec<usize>,
    /// The live words before every instruction, constants excluded.
    before: Vec<WordSet>,
}

impl Liveness {
    /// Returns the live words before every instruction.
    pub(crate) fn before(&self) -> &[WordSet] {
        &self.before
    }

    /// Returns whether a word that is no constant is live before an instruction.
    pub(crate) fn is_live(&self, at: usize, word: u32) -> bool {
        self.before.get(at).is_some_and(|live| live.contains(word))
    }
}

/// Computes liveness. `words` is the number of words before the constants; `result` is live at the end.
pub(crate) fn liveness(ops: &[Op], words: u32, result: &Range<usize>) -> Liveness {
    liveness_with(ops, words, result, Op::is_pure)
}

/// Computes liveness, given which instructions read nothing if their results are dead.
pub(crate) fn liveness_with(
    ops: &[Op],
    words: u32,
    result: &Range<usize>,
    is_removable: impl Fn(&Op) -> bool,
) -> Liveness {
    let mut before: Vec<WordSet> = vec![WordSet::new(words as usize); ops.len()];
    let mut changed = true;
    while changed {
        changed = false;
        for at in (0..ops.len()).rev() {
            let mut live = live_after(ops, at, &before, words, result);
            transfer(ops[at], words, &mut live, is_removable(&ops[at]));
            changed |= before[at].extend(&live);
        }
    }
    let stops = (0..ops.len()).filter(|at| ops[*at].can_stop());
    let unread = (0..ops.len()).filter(|at| {
        let Op::Atomic { to, words: width, .. } = ops[*at] else { return false };
        let live = live_after(ops, *at, &before, words, result);
        (to..=to + u32::from(width)).all(|word| word >= words || !live.contains(word)) || {
            let exchanges = matches!(ops[*at], Op::Atomic { function: Atomic::CompareExchange, .. });
            !exchanges && (to..to + u32::from(width)).all(|word| !live.contains(word))
        }
    });
    let unread = unread.collect();
    Liveness { unread, at_stops: stops.map(|at| (at as u32, before[at].ranges(words))).collect(), before }
}

/// Returns the live words after an instruction, from those before all of them.
pub(crate) fn live_after(ops: &[Op], at: usize, before: &[WordSet], words: u32, result: &Range<usize>) -> WordSet {
    let mut live = WordSet::new(words as usize);
    for next in ops[at].successors(at).into_iter().flatten() {
        live.extend(&before[next]);
    }
    if ops[at] == Op::End {
        (result.start..result.end).filter(|word| *word < words as usize).for_each(|word| live.insert(word as u32));
    }
    live
}

/// Changes the words that are live after an instruction to those that are live before it.
fn transfer(mut op: Op, words: u32, live: &mut WordSet, is_removable: bool) {
    if is_removable && !writes_any(&mut op, words, live) {
        return;
    }
    let mut read: Vec<u32> = Vec::new();
    op.visit_operands(&mut |touch, first, count| {
        let range = *first..*first + count;
        match touch {
            OperandUse::Write => range.filter(|word| *word < words).for_each(|word| live.remove(word)),
            OperandUse::Read => read.extend(range.filter(|word| *word < words)),
            // The other words keep their values.
            OperandUse::WriteSome => {}
        }
    });
    read.into_iter().for_each(|word| live.insert(word));
}

/// Returns whether the instruction writes a live word.
fn writes_any(op: &mut Op, words: u32, live: &WordSet) -> bool {
    let mut found = false;
    op.visit_operands(&mut |touch, first, count| {
        if touch != OperandUse::Read {
            found |= (*first..*first + count).any(|word| word < words && live.contains(word));
        }
    });
    found
}

/// Returns, per instruction, whether it is between a backward jump and its target.
pub(crate) fn in_loops(ops: &[Op]) -> Vec<bool> {
    let mut inside = vec![false; ops.len()];
    for (at, op) in ops.iter().enumerate() {
        if let Op::Jump { to } = op
            && (*to as usize) <= at
        {
            inside[*to as usize..=at].fill(true);
        }
    }
    inside
}
