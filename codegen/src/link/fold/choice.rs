//! Simplifies `if` statements whose condition is known, or whose branches do nothing.
//!
//! In: an `if` with its branches. Out: edits that leave the branch that is taken.

use std::ops::Range;

use super::edit::{Edit, removal};
use super::expression::{self, Expression};
use super::locals::declared;
use super::rules::Rules;
use super::syntax::{Block, Branch, Kind, Statement};
use super::values::Position;

impl Rules<'_> {
    /// An `if` and all its branches.
    pub(super) fn choice(&mut self, statement: &Range<usize>, branches: &[Branch]) {
        let conditions: Vec<Option<Expression>> =
            branches.iter().map(|branch| self.read(branch.condition.clone())).collect();
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
                self.cut_behind(branch.block.close, statement.end);
            }
            // `else if false {…}` goes.
            (_, false, _) => self.cut_behind(branches[at - 1].block.close, branch.block.close + 1),
        }
    }

    fn decision(&self, condition: &Option<Expression>) -> Option<bool> {
        self.values.truth(condition.as_ref()?)
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
                return self.cut_behind(before.block.close, statement.end);
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

    /// Puts the statements of `block` in place of the statement that it is a branch of.
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

    /// Whether what a block declares can be declared around it: no other declaration has such a name, and no such name means
    /// anything else around the block.
    fn may_move(&self, block: &Block) -> bool {
        let inner = block.open..block.close;
        let declared = block.statements.iter().filter_map(|inner| declared(self.tokens, inner.tokens.start));
        declared.into_iter().all(|at| {
            let name = self.tokens[at].text;
            self.locals.count(name) == 1 && self.uses(name, at).iter().all(|at| inner.contains(at))
        })
    }

    /// Whether the lines of the statement and of the block's braces hold nothing else, comments apart: they are removed
    /// whole.
    fn has_lines(&self, statement: &Range<usize>, block: &Block) -> bool {
        let line = |index: usize| self.line_start(self.tokens[index].at);
        let is_first = |index: usize| index == 0 || line(index - 1) < line(index);
        let is_last = |index: usize| index + 1 == self.tokens.len() || line(index) < line(index + 1);
        is_first(statement.start) && is_last(block.open) && is_first(block.close) && is_last(statement.end - 1)
    }

    /// `if a { return true; } return false;` becomes `return a;`, and the reverse `return !a;`.
    pub(super) fn join_returns(&mut self, statement: &Statement, next: &Statement) -> bool {
        let Kind::If(branches) = &statement.kind else { return false };
        let ([branch], false) = (branches.as_slice(), self.is_first) else { return false };
        let [inner] = branch.block.statements.as_slice() else { return false };
        let values = (self.returned(inner), self.returned(next), self.read(branch.condition.clone()));
        let (Some(value), Some(other), Some(condition)) = values else { return false };
        if value == other || self.values.truth(&condition).is_some() {
            return false;
        }
        let is_denial = self.tokens[branch.condition.start].text == "!";
        let is_denied = !value && is_denial && matches!(condition.kind, expression::Kind::Unary(_));
        let start = branch.condition.start + usize::from(is_denied);
        let [before, behind] = match condition.kind {
            _ if value || is_denied => ["return ", ";"],
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
        self.values.edits.push(Edit { range: kept.end..whole.end, text: behind.to_owned() });
        true
    }

    /// What a statement returns, if it is `true` or `false`.
    fn returned(&self, statement: &Statement) -> Option<bool> {
        let [word, value, _] = &self.tokens[statement.tokens.clone()] else { return None };
        match value.text {
            "true" | "false" if word.text == "return" => Some(value.text == "true"),
            _ => None,
        }
    }
}

/// Spaces of one level of blocks.
const INDENT: usize = 4;
