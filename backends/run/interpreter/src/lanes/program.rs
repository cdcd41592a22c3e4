//! The instructions that lane machines run: those of a program without most copies of single words.
//!
//! The compiler copies a variable at each read and each assignment. A single machine stops between instructions, and the checker compares the
//! words of machines there, so its program keeps the copies. Lanes never stop, except at barriers, and only results matter.
//!
//! A result is written to the variable that it is copied to, reads of a copy become reads of the original, and what is then unused is removed.
//! Only straight lines of instructions are considered: every lane that runs the last of them has run the others.

use std::collections::BTreeMap;

use crate::bytecode::Bytecode;
use crate::live::{live_after, liveness_with};
use crate::operation::{Op, OperandUse, Word};

/// The instructions of a lane machine.
#[derive(Clone, Debug)]
pub(crate) struct LaneProgram {
    pub(crate) ops: Vec<Op>,
    /// Per instruction, that of the original program, which messages locate.
    pub(crate) origins: Vec<u32>,
}

/// The most bits of the liveness of a program. A larger program keeps its copies.
const MOST_BITS: usize = 1 << 28;

/// The longest copy that becomes copies of single words.
const SHORT: u32 = 4;

impl LaneProgram {
    pub(crate) fn of(program: &Bytecode) -> Self {
        let mut lines = Lines { ops: program.ops.clone(), origins: (0..program.ops.len() as u32).collect() };
        let words = (program.initial_words.len() - program.constants) as u32;
        if lines.ops.len().saturating_mul(words as usize) < MOST_BITS {
            lines.split_copies();
            lines.write_to_variables(words, &program.result);
            lines.read_originals();
            lines.remove_unused(words, &program.result);
        }
        LaneProgram { ops: lines.ops, origins: lines.origins }
    }
}

/// Instructions, and those of the original program that they come from.
struct Lines {
    ops: Vec<Op>,
    origins: Vec<u32>,
}

impl Lines {
    /// Replaces every instruction by some, and corrects the targets of jumps.
    fn replace(&mut self, mut replacement: impl FnMut(usize, Op) -> Vec<Op>) {
        let (mut ops, mut origins) = (Vec::with_capacity(self.ops.len()), Vec::with_capacity(self.ops.len()));
        let mut starts = Vec::with_capacity(self.ops.len() + 1);
        for (at, op) in self.ops.iter().enumerate() {
            starts.push(ops.len() as u32);
            for op in replacement(at, *op) {
                ops.push(op);
                origins.push(self.origins[at]);
            }
        }
        starts.push(ops.len() as u32);
        for op in &mut ops {
            if let Op::Jump { to } | Op::JumpUnless { to, .. } = op {
                *to = starts[*to as usize];
            }
        }
        (self.ops, self.origins) = (ops, origins);
    }

    fn split_copies(&mut self) {
        self.replace(|_, op| match op {
            // Copies that overlap keep their meaning only as one.
            Op::Copy { to, from, count: count @ 2..=SHORT } if to.abs_diff(from) >= count => {
                (0..count).map(|word| Op::Copy { to: to + word, from: from + word, count: 1 }).collect()
            }
            op => vec![op],
        });
    }

    /// Returns whether each instruction is the first of a straight line.
    fn starts(&self) -> Vec<bool> {
        let mut starts = vec![false; self.ops.len() + 1];
        for (at, op) in self.ops.iter().enumerate() {
            if let Op::Jump { to } | Op::JumpUnless { to, .. } = op {
                starts[*to as usize] = true;
                starts[at + 1] = true;
            }
        }
        starts
    }

    /// Replaces `t = …; x = t` by `x = …` where `t` has no other use.
    fn write_to_variables(&mut self, words: u32, result: &std::ops::Range<usize>) {
        let live = liveness_with(&self.ops, words, result, is_removable);
        let starts = self.starts();
        let mut is_removed = vec![false; self.ops.len()];
        for at in 0..self.ops.len() {
            let Op::Copy { to, from, count: 1 } = self.ops[at] else { continue };
            if from >= words || live_after(&self.ops, at, live.before(), words, result).contains(from) {
                continue;
            }
            if let Some(writer) = self.writer(at, &starts, &is_removed, to, from) {
                self.ops[writer].visit_operands(&mut |operand, word, _| {
                    if operand == OperandUse::Write {
                        *word = to;
                    }
                });
                is_removed[at] = true;
            }
        }
        self.replace(|at, op| if is_removed[at] { Vec::new() } else { vec![op] });
    }

    /// Returns the instruction before `at` in its line that writes `from` and nothing else, if neither `from` nor `to` is used between.
    fn writer(&self, at: usize, starts: &[bool], is_removed: &[bool], to: Word, from: Word) -> Option<usize> {
        for before in (0..at).rev() {
            if starts[before + 1] {
                return None;
            }
            if is_removed[before] {
                continue;
            }
            let (mut writes, mut is_used) = (0, false);
            let mut is_writer = false;
            let mut op = self.ops[before];
            op.visit_operands(&mut |operand, first, count| {
                let contains = |word: Word| (*first..*first + count).contains(&word);
                if operand == OperandUse::Read {
                    is_used |= contains(from);
                    return;
                }
                writes += count;
                is_writer |= operand == OperandUse::Write && *first == from && count == 1;
                is_used |= contains(to) || (contains(from) && !is_writer);
            });
            if is_writer {
                return (writes == 1 && !is_used).then_some(before);
            }
            let mut reads_target = false;
            op.visit_operands(&mut |operand, first, count| {
                reads_target |= operand == OperandUse::Read && (*first..*first + count).contains(&to);
            });
            if is_used || reads_target {
                return None;
            }
        }
        None
    }

    /// Replaces reads of a copy by reads of the original, as long as neither changes.
    fn read_originals(&mut self) {
        let starts = self.starts();
        let mut originals: BTreeMap<Word, Word> = BTreeMap::new();
        for at in 0..self.ops.len() {
            if starts[at] {
                originals.clear();
            }
            let reads_first =
                matches!(self.ops[at], Op::Copy { .. } | Op::Pack { .. } | Op::Wide { .. } | Op::Texel { .. });
            self.ops[at].visit_operands(&mut |operand, first, count| {
                if operand != OperandUse::Read || count == 0 || (count > 1 && !reads_first) {
                    return;
                }
                let Some(original) = originals.get(first).copied() else { return };
                if (1..count).all(|word| originals.get(&(*first + word)) == Some(&(original + word))) {
                    *first = original;
                }
            });
            let mut op = self.ops[at];
            op.visit_operands(&mut |operand, first, count| {
                if operand != OperandUse::Read {
                    let written = *first..*first + count;
                    originals.retain(|copy, original| !written.contains(copy) && !written.contains(original));
                }
            });
            if let Op::Copy { to, from, count } = op
                && count <= SHORT
                && to.abs_diff(from) >= count
            {
                originals.extend((0..count).map(|word| (to + word, from + word)));
            }
        }
    }

    /// Removes instructions that only write words that nothing reads.
    fn remove_unused(&mut self, words: u32, result: &std::ops::Range<usize>) {
        let live = liveness_with(&self.ops, words, result, is_removable);
        let ops = self.ops.clone();
        self.replace(|at, mut op| {
            if !is_removable(&op) {
                return vec![op];
            }
            let after = live_after(&ops, at, live.before(), words, result);
            let mut is_read = false;
            op.visit_operands(&mut |operand, first, count| {
                is_read |= operand != OperandUse::Read && (*first..*first + count).any(|word| after.contains(word));
            });
            if is_read { vec![op] } else { Vec::new() }
        });
    }
}

/// Returns whether an instruction has no effect but its result. Loads may report an access out of bounds.
fn is_removable(op: &Op) -> bool {
    matches!(
        op,
        Op::Copy { .. }
            | Op::Unary { .. }
            | Op::Binary { .. }
            | Op::Ternary { .. }
            | Op::Wide { .. }
            | Op::Pack { .. }
            | Op::Unpack { .. }
            | Op::Index { .. }
    )
}
