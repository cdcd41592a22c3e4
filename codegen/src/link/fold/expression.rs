//! Parses expressions into trees over ranges of tokens.
//!
//! Input: the tokens of an expression. Output: its tree, or `None` if it cannot be parsed. A token is a single character of an
//! operator, so two adjacent tokens can form one operator.

use std::ops::Range;

use crate::link::token::{Token, TokenKind};

/// An expression and its tokens.
#[derive(Debug)]
pub(super) struct Expression {
    pub(super) tokens: Range<usize>,
    pub(super) kind: Kind,
}

/// The kind of an expression.
#[derive(Debug)]
pub(super) enum Kind {
    /// A name, a number or a type.
    Atom,
    /// A function or a type, and arguments.
    Call(Vec<Expression>),
    Parenthesised(Box<Expression>),
    /// `!x`, `-x`, `&x`, ...: the operator is the first token.
    Unary(Box<Expression>),
    Binary(&'static str, Box<Expression>, Box<Expression>),
    /// `x.member`, `x[index]`.
    Part(Box<Expression>, Option<Box<Expression>>),
}

/// Parses the whole `range`.
pub(super) fn parse(tokens: &[Token<'_>], range: Range<usize>) -> Option<Expression> {
    let mut parser = Parser { tokens: &tokens[..range.end], at: range.start };
    let expression = parser.binary(0)?;
    (parser.at == range.end).then_some(expression)
}

/// The binary operators and their precedence. Of two operators with the same first character, the longer precedes.
const OPERATORS: [(&str, usize); 18] = [
    ("||", 1),
    ("&&", 2),
    ("|", 3),
    ("^", 4),
    ("&", 5),
    ("==", 6),
    ("!=", 6),
    ("<<", 7),
    (">>", 7),
    ("<=", 6),
    (">=", 6),
    ("<", 6),
    (">", 6),
    ("+", 8),
    ("-", 8),
    ("*", 9),
    ("/", 9),
    ("%", 9),
];

struct Parser<'t> {
    tokens: &'t [Token<'t>],
    at: usize,
}

impl Parser<'_> {
    fn text(&self, at: usize) -> &str {
        self.tokens.get(at).map_or("", |token| token.text)
    }

    fn take(&mut self, text: &str) -> Option<()> {
        (self.text(self.at) == text).then(|| self.at += 1)
    }

    fn operator(&self) -> Option<(&'static str, usize)> {
        let first = self.text(self.at).as_bytes().first();
        if !first.is_some_and(|first| b"|&^=!<>+-*/%".contains(first)) {
            return None;
        }
        let touches = || self.tokens.get(self.at + 1).is_some_and(|next| next.at == self.tokens[self.at].at + 1);
        OPERATORS.into_iter().find(|(operator, _)| match operator.split_at(1) {
            (first, "") => self.text(self.at) == first,
            (first, second) => self.text(self.at) == first && self.text(self.at + 1) == second && touches(),
        })
    }

    fn binary(&mut self, minimum: usize) -> Option<Expression> {
        let mut left = self.unary()?;
        while let Some((operator, precedence)) = self.operator().filter(|(_, precedence)| *precedence > minimum) {
            self.at += operator.len();
            let right = self.binary(precedence)?;
            let tokens = left.tokens.start..right.tokens.end;
            left = Expression { tokens, kind: Kind::Binary(operator, Box::new(left), Box::new(right)) };
        }
        Some(left)
    }

    fn unary(&mut self) -> Option<Expression> {
        if matches!(self.text(self.at), "!" | "-" | "~" | "&" | "*") {
            let start = self.at;
            self.at += 1;
            let operand = self.unary()?;
            return Some(Expression { tokens: start..operand.tokens.end, kind: Kind::Unary(Box::new(operand)) });
        }
        let mut whole = self.primary()?;
        loop {
            let start = whole.tokens.start;
            let index = match self.text(self.at) {
                "." => {
                    self.at += 2;
                    None
                }
                "[" => {
                    self.at += 1;
                    let index = self.binary(0)?;
                    self.take("]")?;
                    Some(Box::new(index))
                }
                _ => return Some(whole),
            };
            whole = Expression { tokens: start..self.at, kind: Kind::Part(Box::new(whole), index) };
        }
    }

    fn primary(&mut self) -> Option<Expression> {
        let start = self.at;
        if self.take("(").is_some() {
            let inner = self.binary(0)?;
            self.take(")")?;
            return Some(Expression { tokens: start..self.at, kind: Kind::Parenthesised(Box::new(inner)) });
        }
        let first = self.tokens.get(self.at).filter(|token| token.kind != TokenKind::Sign)?;
        self.at += 1;
        if is_template(first.text) && self.text(self.at) == "<" {
            self.types()?;
        }
        let kind = if first.kind == TokenKind::Name && self.take("(").is_some() {
            Kind::Call(self.arguments()?)
        } else {
            Kind::Atom
        };
        Some(Expression { tokens: start..self.at, kind })
    }

    fn arguments(&mut self) -> Option<Vec<Expression>> {
        let mut arguments = Vec::new();
        while self.take(")").is_none() {
            arguments.push(self.binary(0)?);
            if self.take(",").is_none() {
                self.take(")")?;
                break;
            }
        }
        Some(arguments)
    }

    /// Skips `<…>` after the name of a type.
    fn types(&mut self) -> Option<()> {
        let mut depth = 0usize;
        loop {
            match self.text(self.at) {
                "" | ";" | "{" => return None,
                "<" => depth += 1,
                ">" => depth -= 1,
                _ => {}
            }
            self.at += 1;
            if depth == 0 {
                return Some(());
            }
        }
    }
}

/// Tests whether `<` after this name begins a list of types.
pub(super) fn is_template(name: &str) -> bool {
    let is_sized = |stem: &str| name.strip_prefix(stem).is_some_and(|rest| rest.starts_with(['2', '3', '4']));
    matches!(name, "array" | "bitcast" | "atomic" | "ptr") || is_sized("vec") || is_sized("mat")
}
