//! Folds expressions whose value is known, or which one operand determines.
//!
//! Input: an expression, and the declarations of the names in it. Output: edits. An operand is removed only if it has no side effects.

use std::collections::BTreeMap;
use std::ops::Range;

use super::edit::{Edit, removal};
use super::effects::built_in_has_effects;
use super::environment::{DeclarationKind, Environment};
use super::expression::{Expression, Kind};
use super::locals::Locals;
use super::substitute::{FRAME, Substitute, integer};
use crate::link::token::{Token, TokenKind};

/// The context of an expression.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) struct Position {
    /// Whether it is an operand.
    is_operand: bool,
    /// Whether a constant may replace a runtime value. Otherwise the compiler would evaluate the expression around it: it could reject a
    /// division by zero or an index out of bounds, or infer another type.
    may_be_constant: bool,
}

impl Position {
    /// An assigned or returned value, a condition, or an argument of a declared function: the context determines its type.
    pub(super) const WHOLE: Position = Position { is_operand: false, may_be_constant: true };
    /// An index, an argument of a built-in function, or the right side of `/=`.
    pub(super) const EVALUATED: Position = Position { is_operand: false, may_be_constant: false };

    fn operand(may_be_constant: bool) -> Self {
        Position { is_operand: true, may_be_constant }
    }
}

/// The expressions of one function.
pub(super) struct Values<'v> {
    pub(super) tokens: &'v [Token<'v>],
    pub(super) environment: &'v Environment<'v>,
    /// The declarations inside the function, which hide others.
    pub(super) locals: &'v Locals<'v>,
    /// Whether parentheses around a single operand are removed: only after another edit.
    pub(super) removes_parentheses: bool,
    /// Locals that are always `true` or always `false`.
    pub(super) constant_locals: BTreeMap<&'v str, bool>,
    pub(super) edits: Vec<Edit>,
}

impl<'v> Values<'v> {
    /// Adds the edits that fold an expression.
    pub(super) fn fold(&mut self, expression: &Expression, position: Position) {
        match &expression.kind {
            Kind::Atom => {
                if let Some(value) = self.constant(expression).filter(|_| position.may_be_constant) {
                    self.replace(expression, &value.to_string());
                }
            }
            Kind::Parenthesised(inner) => {
                let is_single = matches!(inner.kind, Kind::Atom | Kind::Call(_) | Kind::Part(..));
                if self.removes_parentheses && (is_single || !position.is_operand) {
                    self.keep_only(expression, inner);
                } else {
                    self.fold(inner, Position { is_operand: false, ..position });
                }
            }
            Kind::Unary(operand) => match self.boolean(operand).filter(|_| self.first(expression) == "!") {
                Some(value) => self.replace(expression, if value { "false" } else { "true" }),
                None => self.fold(operand, Position { is_operand: true, ..position }),
            },
            Kind::Part(base, index) => {
                self.fold(base, Position::operand(false));
                index.iter().for_each(|index| self.fold(index, Position::EVALUATED));
            }
            Kind::Call(arguments) => self.call(expression, arguments, position),
            Kind::Binary(operator, left, right) => self.binary(expression, operator, [left, right], position),
        }
    }

    /// Returns the value of a local that is always `true` or always `false`.
    pub(super) fn constant(&self, atom: &Expression) -> Option<bool> {
        if atom.tokens.len() > 1 { None } else { self.constant_locals.get(self.first(atom)).copied() }
    }

    /// Folds the arguments of a call, but not the call.
    pub(super) fn arguments(&mut self, name: &str, arguments: &[Expression]) {
        let is_declared = (self.environment.kind)(name) == Some(DeclarationKind::Function);
        let position = if is_declared { Position::WHOLE } else { Position::EVALUATED };
        arguments.iter().for_each(|argument| self.fold(argument, position));
    }

    /// Tests whether an expression has no side effects.
    pub(super) fn is_pure(&self, expression: &Expression) -> bool {
        expression.tokens.clone().all(|index| {
            let token = self.tokens[index];
            let is_called = self.tokens.get(index + 1).is_some_and(|next| next.text == "(");
            token.kind != TokenKind::Name || !is_called || !self.call_has_effects(token.text)
        })
    }

    fn call_has_effects(&self, name: &str) -> bool {
        (self.environment.has_effects)(name).unwrap_or_else(|| built_in_has_effects(name))
    }

    /// Returns the value of a Boolean literal.
    pub(super) fn boolean(&self, expression: &Expression) -> Option<bool> {
        match self.first(expression) {
            "true" if expression.tokens.len() == 1 => Some(true),
            "false" if expression.tokens.len() == 1 => Some(false),
            _ => None,
        }
    }

    /// Tests whether an expression is the literal `1.0`.
    pub(super) fn is_one(&self, expression: &Expression) -> bool {
        expression.tokens.len() == 1 && self.first(expression) == "1.0"
    }

    /// Returns the substitute of a name, unless a local hides it.
    pub(super) fn substitute(&self, name: &str) -> Substitute {
        if self.locals.declares(name) { Substitute::None } else { (self.environment.substitute)(name) }
    }

    /// Returns the range of bytes of some tokens.
    pub(super) fn bytes(&self, tokens: &Range<usize>) -> Range<usize> {
        let end = self.tokens[tokens.end - 1];
        self.tokens[tokens.start].at..end.at + end.text.len()
    }

    pub(super) fn first(&self, expression: &Expression) -> &'v str {
        self.tokens[expression.tokens.start].text
    }

    fn replace(&mut self, expression: &Expression, text: &str) {
        let range = self.bytes(&expression.tokens);
        self.edits.push(Edit { range, text: text.to_owned() });
    }

    /// Removes the text of `whole` before and after `part`.
    fn keep_only(&mut self, whole: &Expression, part: &Expression) {
        let (whole, part) = (self.bytes(&whole.tokens), self.bytes(&part.tokens));
        self.edits.push(removal(whole.start..part.start));
        self.edits.push(removal(part.end..whole.end));
    }

    fn call(&mut self, call: &Expression, arguments: &[Expression], position: Position) {
        let all_but = |kept: usize| arguments.iter().enumerate().filter(move |(number, _)| *number != kept);
        match (self.substitute(self.first(call)), arguments) {
            (Substitute::Literal(text), _)
                if position.may_be_constant && arguments.iter().all(|one| self.is_pure(one)) =>
            {
                self.replace(call, &text);
            }
            // A value at run time fits everywhere.
            (Substitute::FrameMember(text), _)
                if !self.locals.declares(FRAME) && arguments.iter().all(|one| self.is_pure(one)) =>
            {
                self.replace(call, &text);
            }
            (Substitute::Argument(number), _) if all_but(number).all(|(_, argument)| self.is_pure(argument)) => {
                match arguments.get(number).filter(|argument| self.fits(argument, position)) {
                    Some(argument) => self.keep_argument(call, argument, position),
                    None => self.arguments(self.first(call), arguments),
                }
            }
            (_, [no, yes, condition]) if self.is_select(call) => self.select(call, [no, yes, condition], position),
            _ => self.arguments(self.first(call), arguments),
        }
    }

    /// Tests whether an expression can replace a call that returns its value.
    fn fits(&self, expression: &Expression, position: Position) -> bool {
        if position.may_be_constant { self.has_type(expression) } else { self.is_runtime(expression) }
    }

    pub(super) fn is_select(&self, call: &Expression) -> bool {
        self.first(call) == "select" && (self.environment.kind)("select").is_none()
    }

    fn select(&mut self, call: &Expression, [no, yes, condition]: [&Expression; 3], position: Position) {
        let chosen = match self.boolean(condition) {
            Some(true) => Some((yes, no)),
            Some(false) => Some((no, yes)),
            None => None,
        };
        if let Some((kept, _)) = chosen.filter(|(kept, other)| self.is_pure(other) && self.fits(kept, position)) {
            return self.keep_argument(call, kept, position);
        }
        // With one runtime argument, the call is evaluated at runtime.
        let is_runtime = self.is_runtime(no) || self.is_runtime(yes);
        let may_be_constant = position.may_be_constant || is_runtime;
        self.fold(no, Position::EVALUATED);
        self.fold(yes, Position::EVALUATED);
        self.fold(condition, Position { is_operand: false, may_be_constant });
    }

    fn keep_argument(&mut self, call: &Expression, argument: &Expression, position: Position) {
        let is_operation = matches!(argument.kind, Kind::Binary(..) | Kind::Unary(_));
        let index = self.edits.len();
        self.keep_only(call, argument);
        if is_operation && position.is_operand {
            self.edits[index].text.push('(');
            self.edits[index + 1].text.push(')');
        }
    }

    fn binary(&mut self, whole: &Expression, operator: &str, sides: [&Expression; 2], position: Position) {
        let [left, right] = sides;
        let is_logical = matches!(operator, "&&" | "||");
        if is_logical && self.logical(whole, operator == "||", sides, position) {
            return;
        }
        if let Some(value) = self.compared(operator, left, right) {
            return self.replace(whole, &value.to_string());
        }
        match operator {
            "*" if self.is_one(right) && self.has_type(left) => self.keep_only(whole, left),
            "*" if self.is_one(left) && self.has_type(right) => self.keep_only(whole, right),
            _ => {
                let may_be_constant =
                    |other: &Expression| (is_logical && position.may_be_constant) || self.is_runtime(other);
                let divides = matches!(operator, "/" | "%" | "<<" | ">>");
                let (first, second) = (may_be_constant(right), may_be_constant(left) && !divides);
                self.fold(left, Position::operand(first));
                self.fold(right, Position::operand(second));
            }
        }
    }

    /// Folds `&&` and `||` if one side is known: the value `decisive` determines the result; otherwise the result is the other side.
    fn logical(&mut self, whole: &Expression, decisive: bool, sides: [&Expression; 2], position: Position) -> bool {
        let [left, right] = sides;
        match (self.boolean(left), self.boolean(right)) {
            (Some(value), _) if value != decisive => self.keep_only(whole, right),
            (_, Some(value)) if value != decisive => self.keep_only(whole, left),
            (Some(_), _) if position.may_be_constant => self.replace(whole, &decisive.to_string()),
            (_, Some(_)) if position.may_be_constant && self.is_pure(left) => {
                self.replace(whole, &decisive.to_string());
            }
            _ => return false,
        }
        true
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
