//! Removes statements without effect: one round over one function.
//!
//! In: a function's text, and what is known of the names in it. Out: edits. What they make possible is left to the next
//! round. Comments directly above a removed statement are removed with it.

use std::collections::BTreeMap;
use std::ops::Range;

use super::edit::Edit;
use super::expression::{self, Expression};
use super::locals::{KEYWORDS, Locals};
use super::substitute::Substitute;
use super::syntax::{self, Block, Kind, Statement};
use super::values::{Known, Position, Values};
use crate::link::token::{Token, TokenKind};

/// The edits of one round; none where the function cannot be read. `is_first`: nothing has changed so far.
pub(super) fn edits(text: &str, tokens: &[Token<'_>], known: &Known<'_>, is_first: bool) -> Vec<Edit> {
    let Some(body) = syntax::body(tokens) else { return Vec::new() };
    let locals = Locals::of(tokens);
    let values =
        Values { tokens, known, locals: &locals, tidies: !is_first, truths: BTreeMap::new(), edits: Vec::new() };
    let mut rules = Rules { text, tokens, locals: &locals, is_first, values };
    rules.block(&body);
    match body.statements.last().map(|last| last.tokens.clone()) {
        Some(last) if !is_first && last.len() == 2 && tokens[last.start].text == "return" => rules.remove(&last),
        _ => {}
    }
    rules.values.edits
}

/// The rules on one function.
pub(super) struct Rules<'r> {
    pub(super) text: &'r str,
    pub(super) tokens: &'r [Token<'r>],
    pub(super) locals: &'r Locals<'r>,
    pub(super) is_first: bool,
    pub(super) values: Values<'r>,
}

impl Rules<'_> {
    pub(super) fn block(&mut self, block: &Block) {
        for (index, statement) in block.statements.iter().enumerate() {
            let rest = &block.statements[index + 1..];
            if rest.first().is_some_and(|next| self.join_returns(statement, next)) {
                break;
            }
            self.statement(statement, block);
            // What continues a loop runs after every `continue`.
            let is_left_out = |other: &&Statement| self.tokens[other.tokens.start].text != "continuing";
            let rest: Vec<&Statement> = rest.iter().filter(is_left_out).collect();
            if let (true, Some(first), Some(last)) = (self.leaves(statement), rest.first(), rest.last()) {
                self.remove(&(first.tokens.start..last.tokens.end));
                break;
            }
        }
    }

    /// Whether nothing behind it in its block runs.
    fn leaves(&self, statement: &Statement) -> bool {
        let word = |number: usize| self.tokens.get(statement.tokens.start + number).map_or("", |token| token.text);
        matches!(statement.kind, Kind::Simple)
            && matches!(word(0), "return" | "break" | "continue")
            && (word(0), word(1)) != ("break", "if")
    }

    fn statement(&mut self, statement: &Statement, around: &Block) {
        match &statement.kind {
            Kind::Simple => self.simple(&statement.tokens, around),
            Kind::If(branches) => self.choice(&statement.tokens, branches),
            Kind::Other(heads, blocks) => {
                heads.iter().for_each(|head| self.head(head));
                blocks.iter().for_each(|block| self.block(block));
            }
        }
    }

    /// What stands before a loop's or a switch's brace: one expression, or a `for`'s three parts.
    fn head(&mut self, head: &Range<usize>) {
        let parts: Vec<usize> = head.clone().filter(|&index| self.tokens[index].text == ";").collect();
        match parts[..] {
            [first, second] => {
                if let Some(equals) = (head.start..first).find(|&index| self.tokens[index].text == "=")
                    && let Some(value) = self.read(equals + 1..first)
                {
                    self.values.fold(&value, self.assigned(equals));
                }
                self.fold(first + 1..second);
            }
            _ => self.fold(head.clone()),
        }
    }

    fn simple(&mut self, statement: &Range<usize>, around: &Block) {
        let inner = statement.start..statement.end - 1;
        match self.tokens[statement.start].text {
            word if KEYWORDS.contains(&word) => self.declaration(statement, around),
            "return" => self.fold(inner.start + 1..inner.end),
            "break" | "continue" | "discard" => {}
            name if self.tokens[statement.start + 1].text == "(" => {
                let does_nothing = self.values.substitute(name) != Substitute::None;
                match self.read(inner) {
                    Some(call) if does_nothing && self.has_pure_arguments(&call) => self.remove(statement),
                    Some(Expression { kind: expression::Kind::Call(arguments), tokens }) => {
                        // What takes the place of a call as a value may be no statement.
                        self.values.arguments(self.tokens[tokens.start].text, &arguments);
                    }
                    _ => {}
                }
            }
            _ => self.assignment(statement),
        }
    }

    fn has_pure_arguments(&self, call: &Expression) -> bool {
        match &call.kind {
            expression::Kind::Call(arguments) => arguments.iter().all(|argument| self.values.is_pure(argument)),
            _ => false,
        }
    }

    fn assignment(&mut self, statement: &Range<usize>) {
        let Some(equals) = statement.clone().find(|&index| self.tokens[index].text == "=") else { return };
        let Some(value) = self.read(equals + 1..statement.end - 1) else { return };
        let scales = self.tokens[equals - 1].text == "*";
        let target = self.read(statement.start..equals - 1).filter(|target| self.values.is_pure(target));
        if scales && target.is_some() && self.values.is_one(&value) {
            self.remove(statement);
        } else {
            self.values.fold(&value, self.assigned(equals));
        }
    }

    /// Where a value stands behind this `=`: `/=`, `%=`, `<<=` and `>>=` refuse some constants, as their operators do.
    fn assigned(&self, equals: usize) -> Position {
        match self.tokens[equals - 1].text {
            "/" | "%" | "<" | ">" => Position::EVALUATED,
            _ => Position::WHOLE,
        }
    }

    fn declaration(&mut self, statement: &Range<usize>, around: &Block) {
        let name = self.tokens[statement.start + 1];
        let equals = statement.clone().find(|&index| self.tokens[index].text == "=");
        let value = equals.and_then(|equals| self.read(equals + 1..statement.end - 1));
        let Some(value) = value.filter(|_| name.kind == TokenKind::Name) else { return };
        let uses = self.uses(name.text, statement.start + 1);
        if uses.is_empty() && self.values.is_pure(&value) {
            return self.remove(statement);
        }
        let is_once = self.locals.count(name.text) == 1;
        let stays = uses.iter().all(|&at| (statement.end..around.close).contains(&at) && !self.is_changed(at));
        match self.values.truth(&value) {
            // Once nothing reads it any more it is removed.
            Some(truth) if is_once && stays => _ = self.values.truths.insert(name.text, truth),
            _ => self.values.fold(&value, Position::WHOLE),
        }
    }

    /// Where else a name stands, as no member.
    pub(super) fn uses(&self, name: &str, declared: usize) -> Vec<usize> {
        let is_use = |index: &usize| {
            *index != declared && self.tokens[*index].text == name && self.tokens[index - 1].text != "."
        };
        (1..self.tokens.len()).filter(is_use).collect()
    }

    /// Whether a name is assigned to here, or a pointer to it taken; parentheses may be around it.
    fn is_changed(&self, at: usize) -> bool {
        let text = |index: usize| self.tokens.get(index).map_or("", |token| token.text);
        let (mut before, mut behind) = (at - 1, at + 1);
        while before > 1 && text(before) == "(" && text(behind) == ")" {
            (before, behind) = (before - 1, behind + 1);
        }
        let assigned = text(behind) == "=" && text(behind + 1) != "=";
        let is_pointed_at = text(before) == "&" && text(before.wrapping_sub(1)) != "&";
        let is_combined = matches!(text(behind), "&" | "|") && text(behind + 1) == "=";
        assigned || is_pointed_at || is_combined
    }

    fn fold(&mut self, range: Range<usize>) {
        if let Some(expression) = self.read(range) {
            self.values.fold(&expression, Position::WHOLE);
        }
    }

    pub(super) fn read(&self, range: Range<usize>) -> Option<Expression> {
        if range.is_empty() { None } else { expression::read(self.tokens, range) }
    }
}
