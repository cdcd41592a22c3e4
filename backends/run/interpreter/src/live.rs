//! Which words still matter where a machine can stop, and which instructions can come again.
//!
//! In: finished instructions. Out: per stop, the runs of words that are read before they are written on some way on.
//! Two machines that differ only in other words behave alike, so the states of a search are told apart by these alone.

use std::collections::BTreeMap;
use std::ops::Range;

use crate::operation::{Op, Touch};

/// A set of words.
#[derive(Clone, PartialEq, Eq)]
struct Words(Vec<u64>);

impl Words {
    fn new(count: usize) -> Self {
        Words(vec![0; count.div_ceil(64)])
    }

    fn insert(&mut self, word: u32) {
        self.0[word as usize / 64] |= 1 << (word % 64);
    }

    fn remove(&mut self, word: u32) {
        self.0[word as usize / 64] &= !(1 << (word % 64));
    }

    fn contains(&self, word: u32) -> bool {
        self.0[word as usize / 64] >> (word % 64) & 1 == 1
    }

    /// Whether anything was new.
    fn extend(&mut self, other: &Words) -> bool {
        let mut grew = false;
        for (own, more) in self.0.iter_mut().zip(&other.0) {
            grew |= *more & !*own != 0;
            *own |= more;
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

/// What is live.
pub(crate) struct Liveness {
    /// Before every stop, words below the constants.
    pub(crate) at_stops: BTreeMap<u32, Vec<Range<u32>>>,
    /// Atomic operations whose result nobody reads.
    pub(crate) unread: Vec<usize>,
}

/// Finds it; `words` are the words before the constants, `result` what is read after the end.
pub(crate) fn liveness(ops: &[Op], words: u32, result: &Range<usize>) -> Liveness {
    let mut before: Vec<Words> = vec![Words::new(words as usize); ops.len()];
    let mut changed = true;
    while changed {
        changed = false;
        for at in (0..ops.len()).rev() {
            let mut live = after(ops, at, &before, words, result);
            step(ops[at], words, &mut live);
            changed |= before[at].extend(&live);
        }
    }
    let stops = (0..ops.len()).filter(|at| ops[*at].is_stop());
    let unread = (0..ops.len()).filter(|at| {
        let Op::Atomic { to, words: width, .. } = ops[*at] else { return false };
        let live = after(ops, *at, &before, words, result);
        (to..=to + u32::from(width)).all(|word| word >= words || !live.contains(word)) || {
            let exchanges = matches!(ops[*at], Op::Atomic { function: crate::memory::Atomic::CompareExchange, .. });
            !exchanges && (to..to + u32::from(width)).all(|word| !live.contains(word))
        }
    });
    Liveness { unread: unread.collect(), at_stops: stops.map(|at| (at as u32, before[at].ranges(words))).collect() }
}

fn after(ops: &[Op], at: usize, before: &[Words], words: u32, result: &Range<usize>) -> Words {
    let mut live = Words::new(words as usize);
    for next in ops[at].successors(at).into_iter().flatten() {
        live.extend(&before[next]);
    }
    if ops[at] == Op::End {
        (result.start..result.end).filter(|word| *word < words as usize).for_each(|word| live.insert(word as u32));
    }
    live
}

/// From what is live after an instruction to what is live before it.
fn step(mut op: Op, words: u32, live: &mut Words) {
    if op.is_pure() && !writes_any(&mut op, words, live) {
        return;
    }
    let mut read: Vec<u32> = Vec::new();
    op.touches(&mut |touch, first, count| {
        let range = *first..*first + count;
        match touch {
            Touch::Write => range.filter(|word| *word < words).for_each(|word| live.remove(word)),
            Touch::Read => read.extend(range.filter(|word| *word < words)),
            // What is not written stays as it was.
            Touch::WriteSome => {}
        }
    });
    read.into_iter().for_each(|word| live.insert(word));
}

/// Whether the instruction writes a word that matters.
fn writes_any(op: &mut Op, words: u32, live: &Words) -> bool {
    let mut found = false;
    op.touches(&mut |touch, first, count| {
        if touch != Touch::Read {
            found |= (*first..*first + count).any(|word| word < words && live.contains(word));
        }
    });
    found
}

/// Whether each instruction lies between a jump backwards and where it goes.
pub(crate) fn loops(ops: &[Op]) -> Vec<bool> {
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
