//! Parses the statements of a function into ranges of tokens.
//!
//! Input: the tokens of a function. Output: its blocks and statements, or `None` if they cannot be parsed. `expression.rs` parses
//! expressions.

use std::ops::Range;

use crate::link::token::Token;

/// A block: statements between braces.
#[derive(Debug)]
pub(super) struct Block {
    /// The token `{`.
    pub(super) open: usize,
    /// The token `}`.
    pub(super) close: usize,
    pub(super) statements: Vec<Statement>,
}

/// A statement.
#[derive(Debug)]
pub(super) struct Statement {
    pub(super) tokens: Range<usize>,
    pub(super) kind: Kind,
}

/// The kind of a statement.
#[derive(Debug)]
pub(super) enum Kind {
    /// A statement that ends with a semicolon.
    Simple,
    /// A chain of `if`, `else if`, `else`.
    If(Vec<Branch>),
    /// A loop, a switch or a bare block: the headers and the blocks.
    Other(Vec<Range<usize>>, Vec<Block>),
}

/// A branch of an `if`.
#[derive(Debug)]
pub(super) struct Branch {
    /// Tokens between `if` and `{`; empty for an `else`.
    pub(super) condition: Range<usize>,
    pub(super) block: Block,
}

/// Returns the body of a function.
pub(super) fn body(tokens: &[Token<'_>]) -> Option<Block> {
    let open = tokens.iter().position(|token| token.text == "{")?;
    let block = Parser { tokens, at: open }.block()?;
    (block.close + 1 == tokens.len()).then_some(block)
}

struct Parser<'t> {
    tokens: &'t [Token<'t>],
    at: usize,
}

impl Parser<'_> {
    fn text(&self) -> &str {
        self.tokens.get(self.at).map_or("", |token| token.text)
    }

    fn take(&mut self, text: &str) -> Option<usize> {
        let at = self.at;
        (self.text() == text).then(|| self.at += 1)?;
        Some(at)
    }

    fn block(&mut self) -> Option<Block> {
        let open = self.take("{")?;
        let mut statements = Vec::new();
        loop {
            match self.text() {
                "}" => break,
                ";" => _ = self.take(";"),
                _ => statements.push(self.statement()?),
            }
        }
        Some(Block { open, close: self.take("}")?, statements })
    }

    fn statement(&mut self) -> Option<Statement> {
        let start = self.at;
        let kind = match self.text() {
            "" | "@" => return None,
            "if" => Kind::If(self.branches()?),
            "for" | "while" => {
                self.at += 1;
                let header = self.until_brace()?;
                Kind::Other(vec![header], vec![self.block()?])
            }
            "loop" | "continuing" => {
                self.at += 1;
                Kind::Other(Vec::new(), vec![self.block()?])
            }
            "{" => Kind::Other(Vec::new(), vec![self.block()?]),
            "switch" => self.switch()?,
            _ => {
                while self.text() != ";" {
                    (!matches!(self.text(), "" | "{" | "}")).then_some(())?;
                    self.at += 1;
                }
                self.at += 1;
                Kind::Simple
            }
        };
        Some(Statement { tokens: start..self.at, kind })
    }

    fn branches(&mut self) -> Option<Vec<Branch>> {
        self.take("if")?;
        let mut branches = vec![Branch { condition: self.until_brace()?, block: self.block()? }];
        while self.take("else").is_some() {
            let is_last = self.take("if").is_none();
            let condition = self.until_brace()?;
            branches.push(Branch { condition, block: self.block()? });
            if is_last {
                break;
            }
        }
        Some(branches)
    }

    /// Parses a `switch`. Its cases are blocks; their selectors are skipped.
    fn switch(&mut self) -> Option<Kind> {
        self.at += 1;
        let header = self.until_brace()?;
        self.take("{")?;
        let mut blocks = Vec::new();
        while self.take("}").is_none() {
            self.until_brace()?;
            blocks.push(self.block()?);
        }
        Some(Kind::Other(vec![header], blocks))
    }

    fn until_brace(&mut self) -> Option<Range<usize>> {
        let start = self.at;
        while self.text() != "{" {
            (!matches!(self.text(), "" | "}")).then_some(())?;
            self.at += 1;
        }
        Some(start..self.at)
    }
}
