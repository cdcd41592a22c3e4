//! Simplifies `if` statements whose condition is known, or whose branches do nothing.
//!
//! Input: an `if` with its branches. Output: edits that keep the branch that is taken.

use std::ops::Range;

use super::edit::{Edit, removal};
use super::expression::{self, Expression};
use super::locals::declared;
use super::rules::Rules;
use super::syntax::{Block, Branch, Kind, Statement};
use super::values::Position;

impl Rules<'_> {
    /// Simplifies an `if` and its branches.
    pub(super) fn choice(&mut self, statement: &Range<usize>, branches: &[Branch]) {
        let conditions: Vec<Option<Expression>> =
            branches.iter().map(|branch| self.parse(branch.condition.clone())).collect();
        let decided = conditions.iter().position(|condition| self.decision(condition).is_some());
        let Some((at, taken)) = decided.and_then(|at| Some((at, self.decision(&conditions[at])?))) else {
            return self.undecided(statement, branches, &conditions);
        };
        let branch = &branches[at];
        let rest = &branches[at + 1..];
        match (at, taken, rest) {
            (0, true, _) => self.unwrap(statement, &branch.block),
            (0, false, []) => self.remove(statement),
            (0, false, [other]) if other.condition.is_empty() => self.unwrap(statement, &other.block),
            // `if false {…} else if` becomes `if`.
            (0, false, [next, ..]) => {
                self.comments_above(statement);
                self.cut(statement.start, next.condition.start - 1);
            }
            // `else if true {…}` becomes `else {…}`, and ends the chain.
            (_, true, _) => {
                self.cut(branch.condition.start - 1, branch.block.open);
                self.cut_after(branch.block.close, statement.end);
            }
            // `else if false {…}` is removed.
            (_, false, _) => self.cut_after(branches[at - 1].block.close, branch.block.close + 1),
        }
    }

    fn decision(&self, condition: &Option<Expression>) -> Option<bool> {
        self.values.boolean(condition.as_ref()?)
    }

    fn undecided(&mut self, statement: &Range<usize>, branches: &[Branch], conditions: &[Option<Expression>]) {
        let is_pure = |condition: &Option<Expression>| match condition {
            Some(condition) => self.values.is_pure(condition),
            None => false,
        };
        match branches {
            [only] if self.is_empty(&only.block) && is_pure(&conditions[0]) => return self.remove(statement),
            [.., before, last]
                if self.is_empty(&last.block)
                    && (last.condition.is_empty() || conditions.last().is_some_and(is_pure)) =>
            {
                return self.cut_after(before.block.close, statement.end);
            }
            _ => {}
        }
        for (branch, condition) in branches.iter().zip(conditions) {
            condition.iter().for_each(|condition| self.values.fold(condition, Position::WHOLE));
            self.block(&branch.block);
        }
    }

    fn is_empty(&self, block: &Block) -> bool {
        block.open + 1 == block.close
    }

    /// Replaces a statement by the statements of `block`, one of its branches.
    fn unwrap(&mut self, statement: &Range<usize>, block: &Block) {
        let has_lines = self.has_lines(statement, block);
        if !has_lines && self.is_empty(block) {
            return self.remove(statement);
        }
        if !has_lines || !self.may_move(block) {
            return self.block(block);
        }
        let (outer, open, close) =
            (self.whole_lines(statement), self.tokens[block.open].at, self.tokens[block.close].at);
        let (first, last) = (self.line_end(open), self.line_start(close));
        self.values.edits.push(removal(outer.start..first));
        let mut at = first;
        for line in self.text[first..last].split_inclusive('\n') {
            let indent = line.bytes().take(INDENT).take_while(|byte| *byte == b' ').count();
            self.values.edits.push(removal(at..at + indent));
            at += line.len();
        }
        self.values.edits.push(removal(last..outer.end));
    }

    /// Tests whether the declarations of a block can move out of it: no other declaration has their names, and the names have no other
    /// meaning around the block.
    fn may_move(&self, block: &Block) -> bool {
        let inner = block.open..block.close;
        let declared = block.statements.iter().filter_map(|inner| declared(self.tokens, inner.tokens.start));
        declared.into_iter().all(|at| {
            let name = self.tokens[at].text;
            self.locals.count(name) == 1 && self.uses(name, at).iter().all(|at| inner.contains(at))
        })
    }

    /// Tests whether the lines with the ends of the statement and the braces of the block contain nothing else except comments, so that
    /// whole lines can be removed.
    fn has_lines(&self, statement: &Range<usize>, block: &Block) -> bool {
        let line = |index: usize| self.line_start(self.tokens[index].at);
        let is_first = |index: usize| index == 0 || line(index - 1) < line(index);
        let is_last = |index: usize| index + 1 == self.tokens.len() || line(index) < line(index + 1);
        is_first(statement.start) && is_last(block.open) && is_first(block.close) && is_last(statement.end - 1)
    }

    /// Replaces `if a { return true; } return false;` by `return a;`, and the reverse by `return !a;`.
    pub(super) fn join_returns(&mut self, statement: &Statement, next: &Statement) -> bool {
        let Kind::If(branches) = &statement.kind else { return false };
        let ([branch], false) = (branches.as_slice(), self.is_first) else { return false };
        let [inner] = branch.block.statements.as_slice() else { return false };
        let values = (self.returned(inner), self.returned(next), self.parse(branch.condition.clone()));
        let (Some(value), Some(other), Some(condition)) = values else { return false };
        if value == other || self.values.boolean(&condition).is_some() {
            return false;
        }
        let has_negation = self.tokens[branch.condition.start].text == "!";
        let is_negated = !value && has_negation && matches!(condition.kind, expression::Kind::Unary(_));
        let start = branch.condition.start + usize::from(is_negated);
        let [before, after] = match condition.kind {
            _ if value || is_negated => ["return ", ";"],
            expression::Kind::Unary(_) | expression::Kind::Binary(..) => ["return !(", ");"],
            _ => ["return !", ";"],
        };
        let (whole, kept) = (
            self.values.bytes(&(statement.tokens.start..next.tokens.end)),
            self.values.bytes(&(start..branch.condition.end)),
        );
        if self.text[whole.clone()].contains("//") {
            return false;
        }
        self.values.edits.push(Edit { range: whole.start..kept.start, text: before.to_owned() });
        self.values.edits.push(Edit { range: kept.end..whole.end, text: after.to_owned() });
        true
    }

    /// Returns the Boolean literal that a statement returns.
    fn returned(&self, statement: &Statement) -> Option<bool> {
        let [keyword, value, _] = &self.tokens[statement.tokens.clone()] else { return None };
        match value.text {
            "true" | "false" if keyword.text == "return" => Some(value.text == "true"),
            _ => None,
        }
    }
}

/// The indentation of one level of blocks, in spaces.
const INDENT: usize = 4;
