//! Removes statements without effect: one round over one function.
//!
//! In: a function's text, and what is known of the names in it. Out: edits. What they make possible is left to the next
//! round. Comments directly above a removed statement are removed with it.

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
    let values = Values { tokens, known, locals: &locals, tidies: !is_first, edits: Vec::new() };
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
                if let Some(equals) = (head.start..first).find(|&index| self.tokens[index].text == "=") {
                    self.fold(equals + 1..first);
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
                    Some(call) => self.values.fold(&call, Position::Whole),
                    None => {}
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
            self.values.fold(&value, Position::Whole);
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
            Some(truth) if is_once && stays => {
                for at in uses {
                    let range = self.values.bytes(&(at..at + 1));
                    self.values.edits.push(Edit { range, text: truth.to_string() });
                }
                self.remove(statement);
            }
            _ => self.values.fold(&value, Position::Whole),
        }
    }

    /// Where else a name stands, as no member.
    pub(super) fn uses(&self, name: &str, declared: usize) -> Vec<usize> {
        let is_use = |index: &usize| {
            *index != declared && self.tokens[*index].text == name && self.tokens[index - 1].text != "."
        };
        (1..self.tokens.len()).filter(is_use).collect()
    }

    /// Whether a name is assigned to here, or a pointer to it taken.
    fn is_changed(&self, at: usize) -> bool {
        let text = |index: usize| self.tokens.get(index).map_or("", |token| token.text);
        let assigned = text(at + 1) == "=" && text(at + 2) != "=";
        let is_pointed_at = text(at - 1) == "&" && text(at.wrapping_sub(2)) != "&";
        let is_combined = matches!(text(at + 1), "&" | "|") && text(at + 2) == "=";
        assigned || is_pointed_at || is_combined
    }

    fn fold(&mut self, range: Range<usize>) {
        if let Some(expression) = self.read(range) {
            self.values.fold(&expression, Position::Whole);
        }
    }

    pub(super) fn read(&self, range: Range<usize>) -> Option<Expression> {
        if range.is_empty() { None } else { expression::read(self.tokens, range) }
    }
}
