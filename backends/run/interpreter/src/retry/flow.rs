//! The flow of a variable through one iteration of a loop.
//!
//! Input: the instructions of a loop and a variable. Output: the comparisons that depend on the variable and its change, if it does
//! nothing but limit the number of iterations.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

use crate::arithmetic::unary;
use crate::live::Liveness;
use crate::operation::{Op, OperandUse, Word};
use crate::scalar::Binary;

/// A loop of a program.
pub(super) struct Flow<'a> {
    pub(super) ops: &'a [Op],
    pub(super) live: &'a Liveness,
    pub(super) range: Range<usize>,
    pub(super) first_constant: Word,
    pub(super) constants: &'a [u32],
}

/// How a loop uses a variable.
#[derive(Debug, Default)]
pub(super) struct CounterUses {
    /// The changes in one iteration, apart from none.
    pub(super) steps: BTreeSet<i32>,
    /// The constants that it is set to inside of the loop.
    pub(super) resets: BTreeSet<u32>,
    pub(super) comparisons: BTreeSet<Comparison>,
    /// The jumps that leave the loop at the limit.
    pub(super) limits: BTreeSet<usize>,
}

/// A comparison of the variable with a constant.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Comparison {
    pub(super) domain: Domain,
    pub(super) constant: u32,
}

/// Where the values of a comparison wrap around.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Domain {
    Unsigned,
    Signed,
    Equality,
}

/// What a word holds that depends on the variable.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Derived {
    /// The variable at the beginning of the iteration, plus -1, 0 or 1.
    Value(i32),
    /// The result of comparisons.
    Condition,
}

/// The words that depend on the variable. Words are reused, so they differ between instructions. Where paths meet, a word may
/// hold one of several values.
type DerivedWords = BTreeSet<(Word, Derived)>;

impl Flow<'_> {
    /// Returns the variables that the loop adds a constant to.
    pub(super) fn candidates(&self) -> BTreeSet<Word> {
        let ops = &self.ops[self.range.clone()];
        let sum = |op: &Op| match *op {
            Op::Binary { op: Binary::Add | Binary::Subtract, to, .. } => Some(to),
            _ => None,
        };
        let sums: BTreeSet<Word> = ops.iter().filter_map(sum).collect();
        let copied = |op: &Op| match *op {
            Op::Copy { to, from, count: 1 } if sums.contains(&from) => Some(to),
            _ => None,
        };
        ops.iter().filter_map(copied).collect()
    }

    /// Returns the uses of a variable. `None`: the loop uses it for more than its limit, or something after the loop uses it.
    pub(super) fn uses(&self, variable: Word) -> Option<CounterUses> {
        let mut uses = CounterUses::default();
        let start: DerivedWords = [(variable, Derived::Value(0))].into();
        let mut known: BTreeMap<usize, DerivedWords> = BTreeMap::from([(self.range.start, start)]);
        let mut pending = vec![self.range.start];
        while let Some(at) = pending.pop() {
            let before = known.get(&at).cloned().unwrap_or_default();
            let after = self.derived_after(at, variable, before, &mut uses)?;
            for next in self.ops[at].successors(at).into_iter().flatten() {
                let is_live = |word: Word| self.live.is_live(next, word);
                if next == self.range.start {
                    self.end_iteration(variable, &after, &mut uses)?;
                } else if !self.range.contains(&next) {
                    if after.iter().any(|(word, _)| is_live(*word)) {
                        return None;
                    }
                } else {
                    let is_known = known.contains_key(&next);
                    let words = known.entry(next).or_default();
                    let count = words.len();
                    words.extend(&after);
                    if !is_known || words.len() > count {
                        pending.push(next);
                    }
                }
            }
        }
        Some(uses)
    }

    /// Records the change of the variable in an iteration. `None`: another word takes a value to the next iteration.
    fn end_iteration(&self, variable: Word, after: &DerivedWords, uses: &mut CounterUses) -> Option<()> {
        for (word, derived) in after {
            match derived {
                Derived::Value(step) if *word == variable => uses.steps.extend(Some(*step).filter(|step| *step != 0)),
                _ if self.live.is_live(self.range.start, *word) => return None,
                _ => {}
            }
        }
        Some(())
    }

    /// Returns the words that depend on the variable after an instruction. `None`: it uses one for something else, or sets the
    /// variable to anything but such a word or a constant.
    fn derived_after(
        &self,
        at: usize,
        variable: Word,
        mut derived: DerivedWords,
        uses: &mut CounterUses,
    ) -> Option<DerivedWords> {
        let (mut reads, mut sets, mut overwritten) = (false, false, BTreeSet::new());
        let mut op = self.ops[at];
        op.visit_operands(&mut |touch, first, count| {
            let words = *first..*first + count;
            match touch {
                OperandUse::Read => reads |= derived.iter().any(|(word, _)| words.contains(word)),
                OperandUse::Write => overwritten.extend(words),
                // The word may keep its value, so it still depends on the variable.
                OperandUse::WriteSome => sets |= words.contains(&variable),
            }
        });
        let results = if reads { self.results(at, &derived, uses)? } else { DerivedWords::new() };
        if sets || overwritten.contains(&variable) {
            match self.copied_constant(at) {
                Some(constant) => drop(uses.resets.insert(constant)),
                None if results.iter().any(|(word, _)| *word == variable) => {}
                None => return None,
            }
        }
        derived.retain(|(word, _)| !overwritten.contains(word));
        derived.extend(results);
        Some(derived)
    }

    /// Returns what an instruction derives from such words. `None`: it uses them for something else.
    fn results(&self, at: usize, derived: &DerivedWords, uses: &mut CounterUses) -> Option<DerivedWords> {
        let all = |word: Word| derived.iter().filter(move |(other, _)| *other == word).map(|(_, derived)| *derived);
        let is_condition = |word: Word| all(word).next().is_some() && all(word).all(|one| one == Derived::Condition);
        let is_value = |word: Word| all(word).all(|one| one != Derived::Condition);
        match self.ops[at] {
            Op::Copy { to, from, count: 1 } => Some(all(from).map(|one| (to, one)).collect()),
            Op::Unary { to, a, .. } if is_condition(a) => Some([(to, Derived::Condition)].into()),
            Op::Binary { op: Binary::And | Binary::Or, to, a, b } if is_condition(a) && is_condition(b) => {
                Some([(to, Derived::Condition)].into())
            }
            Op::Binary { op: op @ (Binary::Add | Binary::Subtract), to, a, b } => {
                let (value, constant) = match (self.constant(a), self.constant(b)) {
                    (_, Some(constant)) => (a, constant as i32),
                    (Some(constant), _) if op == Binary::Add => (b, constant as i32),
                    _ => return None,
                };
                let step = if op == Binary::Add { constant } else { constant.wrapping_neg() };
                let is_step = matches!(step, -1 | 1) && all(value).all(|one| one == Derived::Value(0));
                is_step.then(|| [(to, Derived::Value(step))].into())
            }
            Op::Binary { op, to, a, b } => {
                let domain = match op {
                    Binary::LessU | Binary::LessEqualU => Domain::Unsigned,
                    Binary::LessS | Binary::LessEqualS => Domain::Signed,
                    Binary::Equal | Binary::NotEqual => Domain::Equality,
                    _ => return None,
                };
                let constant = self.constant(a).or(self.constant(b)).filter(|_| is_value(a) && is_value(b))?;
                uses.comparisons.insert(Comparison { domain, constant });
                Some([(to, Derived::Condition)].into())
            }
            Op::JumpUnless { condition, to } if is_condition(condition) => {
                uses.limits.insert(at);
                (self.leaves(at + 1) || self.leaves(to as usize)).then(DerivedWords::new)
            }
            _ => None,
        }
    }

    fn constant(&self, word: Word) -> Option<u32> {
        self.constants.get(word.checked_sub(self.first_constant)? as usize).copied()
    }

    /// Returns the constant that an instruction copies.
    pub(super) fn copied_constant(&self, at: usize) -> Option<u32> {
        match self.ops[at] {
            Op::Copy { from, count: 1, .. } => self.constant(from),
            _ => None,
        }
    }

    /// Returns whether the loop can end otherwise than by jumps at its limits.
    pub(super) fn has_other_exit(&self, limits: &BTreeSet<usize>) -> bool {
        let (mut seen, mut pending) = (BTreeSet::new(), vec![self.range.start]);
        while let Some(at) = pending.pop() {
            if !seen.insert(at) {
                continue;
            }
            let mut successors = self.ops[at].successors(at).into_iter().flatten().peekable();
            if successors.peek().is_none() {
                return true;
            }
            for next in successors.filter(|next| !limits.contains(&at) || !self.leaves(*next)) {
                if !self.range.contains(&next) {
                    return true;
                }
                pending.push(next);
            }
        }
        false
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
