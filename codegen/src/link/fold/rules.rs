//! Removes statements without effect: one iteration over one function.
//!
//! Input: the source of a function, and the declarations around it. Output: edits. Further edits that they enable follow in the next
//! iteration. Comments directly above a removed statement are removed with it.

use std::collections::BTreeMap;
use std::ops::Range;

use super::edit::Edit;
use super::environment::Environment;
use super::expression::{self, Expression};
use super::locals::{KEYWORDS, Locals};
use super::substitute::Substitute;
use super::syntax::{self, Block, Kind, Statement};
use super::values::{Position, Values};
use crate::link::token::{Token, TokenKind};

/// Returns the edits of one iteration; none if the function cannot be parsed. `is_first` is true before the first change.
pub(super) fn edits(text: &str, tokens: &[Token<'_>], environment: &Environment<'_>, is_first: bool) -> Vec<Edit> {
    let Some(body) = syntax::body(tokens) else { return Vec::new() };
    let locals = Locals::of(tokens);
    let values = Values {
        tokens,
        environment,
        locals: &locals,
        removes_parentheses: !is_first,
        constant_locals: BTreeMap::new(),
        edits: Vec::new(),
    };
    let mut rules = Rules { text, tokens, locals: &locals, is_first, values };
    rules.block(&body);
    match body.statements.last().map(|last| last.tokens.clone()) {
        Some(last) if !is_first && last.len() == 2 && tokens[last.start].text == "return" => rules.remove(&last),
        _ => {}
    }
    rules.values.edits
}

/// The state of the rules on one function.
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
            // A `continuing` block runs after every `continue`.
            let is_unreachable = |other: &&Statement| self.tokens[other.tokens.start].text != "continuing";
            let rest: Vec<&Statement> = rest.iter().filter(is_unreachable).collect();
            if let (true, Some(first), Some(last)) = (self.is_jump(statement), rest.first(), rest.last()) {
                self.remove(&(first.tokens.start..last.tokens.end));
                break;
            }
        }
    }

    /// Tests whether the statements after it in its block are unreachable.
    fn is_jump(&self, statement: &Statement) -> bool {
        let token = |number: usize| self.tokens.get(statement.tokens.start + number).map_or("", |token| token.text);
        matches!(statement.kind, Kind::Simple)
            && matches!(token(0), "return" | "break" | "continue")
            && (token(0), token(1)) != ("break", "if")
    }

    fn statement(&mut self, statement: &Statement, around: &Block) {
        match &statement.kind {
            Kind::Simple => self.simple(&statement.tokens, around),
            Kind::If(branches) => self.choice(&statement.tokens, branches),
            Kind::Other(headers, blocks) => {
                headers.iter().for_each(|header| self.header(header));
                blocks.iter().for_each(|block| self.block(block));
            }
        }
    }

    /// Folds the header of a loop or a switch: one expression, or the three parts of a `for`.
    fn header(&mut self, header: &Range<usize>) {
        let parts: Vec<usize> = header.clone().filter(|&index| self.tokens[index].text == ";").collect();
        match parts[..] {
            [first, second] => {
                if let Some(equals) = (header.start..first).find(|&index| self.tokens[index].text == "=")
                    && let Some(value) = self.parse(equals + 1..first)
                {
                    self.values.fold(&value, self.assigned(equals));
                }
                self.fold(first + 1..second);
            }
            _ => self.fold(header.clone()),
        }
    }

    fn simple(&mut self, statement: &Range<usize>, around: &Block) {
        let inner = statement.start..statement.end - 1;
        match self.tokens[statement.start].text {
            keyword if KEYWORDS.contains(&keyword) => self.declaration(statement, around),
            "return" => self.fold(inner.start + 1..inner.end),
            "break" | "continue" | "discard" => {}
            name if self.tokens[statement.start + 1].text == "(" => {
                let is_replaceable = self.values.substitute(name) != Substitute::None;
                match self.parse(inner) {
                    Some(call) if is_replaceable && self.has_pure_arguments(&call) => self.remove(statement),
                    Some(Expression { kind: expression::Kind::Call(arguments), tokens }) => {
                        // The replacement of a call may not be a valid statement, so only the arguments are folded.
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
        let Some(value) = self.parse(equals + 1..statement.end - 1) else { return };
        let scales = self.tokens[equals - 1].text == "*";
        let target = self.parse(statement.start..equals - 1).filter(|target| self.values.is_pure(target));
        if scales && target.is_some() && self.values.is_one(&value) {
            self.remove(statement);
        } else {
            self.values.fold(&value, self.assigned(equals));
        }
    }

    /// Returns the context of the value after this `=`. The compiler rejects some constants after `/=`, `%=`, `<<=` and `>>=`.
    fn assigned(&self, equals: usize) -> Position {
        match self.tokens[equals - 1].text {
            "/" | "%" | "<" | ">" => Position::EVALUATED,
            _ => Position::WHOLE,
        }
    }

    fn declaration(&mut self, statement: &Range<usize>, around: &Block) {
        let name = self.tokens[statement.start + 1];
        let equals = statement.clone().find(|&index| self.tokens[index].text == "=");
        let value = equals.and_then(|equals| self.parse(equals + 1..statement.end - 1));
        let Some(value) = value.filter(|_| name.kind == TokenKind::Name) else { return };
        let uses = self.uses(name.text, statement.start + 1);
        if uses.is_empty() && self.values.is_pure(&value) {
            return self.remove(statement);
        }
        let is_once = self.locals.count(name.text) == 1;
        let is_constant = uses.iter().all(|&at| (statement.end..around.close).contains(&at) && !self.is_changed(at));
        match self.values.boolean(&value) {
            // It is removed when no use remains.
            Some(boolean) if is_once && is_constant => _ = self.values.constant_locals.insert(name.text, boolean),
            _ => self.values.fold(&value, Position::WHOLE),
        }
    }

    /// Returns the other occurrences of a name, except as a member.
    pub(super) fn uses(&self, name: &str, declared: usize) -> Vec<usize> {
        let is_use = |index: &usize| {
            *index != declared && self.tokens[*index].text == name && self.tokens[index - 1].text != "."
        };
        (1..self.tokens.len()).filter(is_use).collect()
    }

    /// Tests whether the name at `at`, possibly in parentheses, is assigned, or a pointer to it is created.
    fn is_changed(&self, at: usize) -> bool {
        let text = |index: usize| self.tokens.get(index).map_or("", |token| token.text);
        let (mut before, mut after) = (at - 1, at + 1);
        while before > 1 && text(before) == "(" && text(after) == ")" {
            (before, after) = (before - 1, after + 1);
        }
        let assigned = text(after) == "=" && text(after + 1) != "=";
        let is_pointed_at = text(before) == "&" && text(before.wrapping_sub(1)) != "&";
        let is_combined = matches!(text(after), "&" | "|") && text(after + 1) == "=";
        assigned || is_pointed_at || is_combined
    }

    fn fold(&mut self, range: Range<usize>) {
        if let Some(expression) = self.parse(range) {
            self.values.fold(&expression, Position::WHOLE);
        }
    }

    pub(super) fn parse(&self, range: Range<usize>) -> Option<Expression> {
        if range.is_empty() { None } else { expression::parse(self.tokens, range) }
    }
}
