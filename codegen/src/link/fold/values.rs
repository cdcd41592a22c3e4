//! Folds expressions whose value is known, or that one operand decides.
//!
//! In: an expression, and what is known of the names in it. Out: edits. An operand is removed only if it has no side effects.

use std::ops::Range;

use super::edit::{Edit, removal};
use super::effects::built_in_has_effects;
use super::expression::{Expression, Kind, is_template};
use super::locals::Locals;
use super::substitute::{Substitute, integer};
use crate::link::token::{Token, TokenKind};

/// What is known of declarations, by name.
pub(super) struct Known<'k> {
    /// The substitute of a declaration.
    pub(super) substitute: &'k dyn Fn(&str) -> Substitute,
    /// Whether a call of a declared function does more than return a value; `None` where none is declared.
    pub(super) has_effects: &'k dyn Fn(&str) -> Option<bool>,
}

/// Where an expression stands.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Position {
    /// Nothing binds to it.
    Whole,
    /// An operator binds to it.
    Operand,
    /// Behind an operator that refuses some constants: `/`, `%`, `<<`, `>>`.
    Divisor,
}

/// The expressions of one function.
pub(super) struct Values<'v> {
    pub(super) tokens: &'v [Token<'v>],
    pub(super) known: &'v Known<'v>,
    /// What the function declares: these names hide declarations.
    pub(super) locals: &'v Locals<'v>,
    /// Whether parentheses around a single operand go, once something else has.
    pub(super) tidies: bool,
    pub(super) edits: Vec<Edit>,
}

impl Values<'_> {
    /// Adds what folds in an expression.
    pub(super) fn fold(&mut self, expression: &Expression, position: Position) {
        match &expression.kind {
            Kind::Atom => {}
            Kind::Parenthesised(inner) => {
                let is_single = matches!(inner.kind, Kind::Atom | Kind::Call(_) | Kind::Part(..));
                if self.tidies && (is_single || position == Position::Whole) {
                    self.keep_only(expression, inner);
                } else {
                    self.fold(inner, Position::Whole);
                }
            }
            Kind::Unary(operand) => match self.truth(operand).filter(|_| self.first(expression) == "!") {
                Some(value) => self.replace(expression, if value { "false" } else { "true" }),
                None => self.fold(operand, Position::Operand),
            },
            Kind::Part(base, index) => {
                self.fold(base, Position::Operand);
                index.iter().for_each(|index| self.fold(index, Position::Whole));
            }
            Kind::Call(arguments) => self.call(expression, arguments, position),
            Kind::Binary(operator, left, right) => self.binary(expression, operator, left, right),
        }
    }

    /// Whether evaluating it does nothing but give a value.
    pub(super) fn is_pure(&self, expression: &Expression) -> bool {
        expression.tokens.clone().all(|index| {
            let token = self.tokens[index];
            let is_called = self.tokens.get(index + 1).is_some_and(|next| next.text == "(");
            token.kind != TokenKind::Name || !is_called || !self.call_has_effects(token.text)
        })
    }

    fn call_has_effects(&self, name: &str) -> bool {
        (self.known.has_effects)(name).unwrap_or_else(|| built_in_has_effects(name))
    }

    /// The value of `true` or `false`.
    pub(super) fn truth(&self, expression: &Expression) -> Option<bool> {
        match self.first(expression) {
            "true" if expression.tokens.len() == 1 => Some(true),
            "false" if expression.tokens.len() == 1 => Some(false),
            _ => None,
        }
    }

    /// Whether it is written `1.0`.
    pub(super) fn is_one(&self, expression: &Expression) -> bool {
        expression.tokens.len() == 1 && self.first(expression) == "1.0"
    }

    /// The substitute of a name, if no local hides it.
    pub(super) fn substitute(&self, name: &str) -> Substitute {
        if self.locals.declares(name) { Substitute::None } else { (self.known.substitute)(name) }
    }

    /// The bytes of some tokens.
    pub(super) fn bytes(&self, tokens: &Range<usize>) -> Range<usize> {
        let end = self.tokens[tokens.end - 1];
        self.tokens[tokens.start].at..end.at + end.text.len()
    }

    fn first(&self, expression: &Expression) -> &str {
        self.tokens[expression.tokens.start].text
    }

    fn replace(&mut self, expression: &Expression, text: &str) {
        let range = self.bytes(&expression.tokens);
        self.edits.push(Edit { range, text: text.to_owned() });
    }

    /// Removes everything of `whole` before and behind `part`.
    fn keep_only(&mut self, whole: &Expression, part: &Expression) {
        let (whole, part) = (self.bytes(&whole.tokens), self.bytes(&part.tokens));
        self.edits.push(removal(whole.start..part.start));
        self.edits.push(removal(part.end..whole.end));
    }

    fn call(&mut self, call: &Expression, arguments: &[Expression], position: Position) {
        let all_but = |kept: usize| arguments.iter().enumerate().filter(move |(number, _)| *number != kept);
        match self.substitute(self.first(call)) {
            // A division by a constant zero does not compile.
            Substitute::Literal(text)
                if position != Position::Divisor && arguments.iter().all(|one| self.is_pure(one)) =>
            {
                return self.replace(call, &text);
            }
            Substitute::Argument(number) if all_but(number).all(|(_, argument)| self.is_pure(argument)) => {
                if let Some(argument) = arguments.get(number).filter(|argument| self.has_type(argument)) {
                    return self.keep_argument(call, argument, position);
                }
            }
            _ => {}
        }
        if let ("select", [no, yes, condition]) = (self.first(call), arguments) {
            match self.truth(condition) {
                Some(true) if self.is_pure(no) => return self.keep_argument(call, yes, position),
                Some(false) if self.is_pure(yes) => return self.keep_argument(call, no, position),
                _ => {}
            }
        }
        arguments.iter().for_each(|argument| self.fold(argument, Position::Whole));
    }

    /// Whether its type does not depend on what it is given to, as that of a bare number does.
    fn has_type(&self, expression: &Expression) -> bool {
        expression.tokens.clone().any(|index| {
            let name = self.tokens[index].text;
            let next = self.tokens.get(index + 1).map_or("", |next| next.text);
            let is_called = next == "(" && (self.known.has_effects)(name).is_some();
            self.locals.declares(name) || is_called || (is_template(name) && next == "<")
        })
    }

    fn keep_argument(&mut self, call: &Expression, argument: &Expression, position: Position) {
        let is_operation = matches!(argument.kind, Kind::Binary(..) | Kind::Unary(_));
        let at = self.edits.len();
        self.keep_only(call, argument);
        if is_operation && position != Position::Whole {
            self.edits[at].text.push('(');
            self.edits[at + 1].text.push(')');
        }
    }

    fn binary(&mut self, whole: &Expression, operator: &str, left: &Expression, right: &Expression) {
        // `true` decides `||`, and leaves `&&` to the other operand.
        let decisive = operator == "||";
        match (operator, self.truth(left), self.truth(right)) {
            ("&&" | "||", Some(value), _) if value == decisive => return self.replace(whole, &value.to_string()),
            ("&&" | "||", Some(_), _) => return self.keep_only(whole, right),
            ("&&" | "||", _, Some(value)) if value != decisive => return self.keep_only(whole, left),
            ("&&" | "||", _, Some(value)) if self.is_pure(left) => return self.replace(whole, &value.to_string()),
            _ => {}
        }
        if let Some(value) = self.compared(operator, left, right) {
            return self.replace(whole, &value.to_string());
        }
        match operator {
            "*" if self.is_one(right) => self.keep_only(whole, left),
            "*" if self.is_one(left) => self.keep_only(whole, right),
            _ => {
                let divides = matches!(operator, "/" | "%" | "<<" | ">>");
                self.fold(left, Position::Operand);
                self.fold(right, if divides { Position::Divisor } else { Position::Operand });
            }
        }
    }

    fn compared(&self, operator: &str, left: &Expression, right: &Expression) -> Option<bool> {
        let compare: fn(&u64, &u64) -> bool = match operator {
            "==" => u64::eq,
            "!=" => u64::ne,
            "<" => u64::lt,
            ">" => u64::gt,
            "<=" => u64::le,
            ">=" => u64::ge,
            _ => return None,
        };
        Some(compare(&self.number(left)?, &self.number(right)?))
    }

    fn number(&self, expression: &Expression) -> Option<u64> {
        let token = self.tokens[expression.tokens.start];
        match self.substitute(token.text) {
            _ if expression.tokens.len() > 1 => None,
            Substitute::Integer(value) => Some(value),
            _ => integer(&token),
        }
    }
}
