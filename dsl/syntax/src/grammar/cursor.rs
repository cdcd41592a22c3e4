//! A cursor over the tokens of one level of brackets.
//!
//! Input: the tokens of one level. Output: tokens, or an "expected …, found …" error at the next token.

use fragbuf_model::{SourceSpan, codes};
use proc_macro2::{Delimiter, Group, Ident, Span, TokenStream, TokenTree};

use crate::report::{Report, Stop};

/// The remaining tokens of one level.
pub(super) struct Cursor {
    tokens: Vec<TokenTree>,
    next: usize,
    /// The span that messages use after the last token.
    end: Option<Span>,
}

impl Cursor {
    /// Returns a cursor over these tokens.
    pub(super) fn new(tokens: TokenStream) -> Self {
        let tokens: Vec<TokenTree> = tokens.into_iter().collect();
        let end = tokens.last().map(TokenTree::span);
        Cursor { tokens, next: 0, end }
    }

    /// Returns a cursor over the tokens inside brackets.
    pub(super) fn inside(group: &Group) -> Self {
        Cursor { tokens: group.stream().into_iter().collect(), next: 0, end: Some(group.span_close()) }
    }

    /// Returns the next token without taking it.
    pub(super) fn peek(&self) -> Option<&TokenTree> {
        self.tokens.get(self.next)
    }

    /// Returns the token after the next without taking it.
    pub(super) fn peek_second(&self) -> Option<&TokenTree> {
        self.tokens.get(self.next + 1)
    }

    /// Returns the second token after the next without taking it.
    pub(super) fn peek_third(&self) -> Option<&TokenTree> {
        self.tokens.get(self.next + 2)
    }

    /// Returns the tokens that are not taken.
    pub(super) fn rest(&self) -> &[TokenTree] {
        self.tokens.get(self.next..).unwrap_or_default()
    }

    /// Returns the token after the second `|`, if a closure begins here.
    pub(super) fn after_parameters(&self) -> Option<&TokenTree> {
        let rest = self.tokens.get(self.next..)?;
        let mut bars = rest.iter().enumerate().filter(|(_, token)| is_punct(Some(token), '|'));
        bars.next()?;
        rest.get(bars.next()?.0 + 1)
    }

    /// Returns the number of tokens taken.
    pub(super) fn position(&self) -> usize {
        self.next
    }

    /// Takes the next token.
    pub(super) fn take(&mut self) -> Option<TokenTree> {
        let token = self.tokens.get(self.next).cloned();
        self.next += usize::from(token.is_some());
        token
    }

    /// Returns whether all tokens are taken.
    pub(super) fn is_done(&self) -> bool {
        self.next >= self.tokens.len()
    }

    /// Returns whether the next token is this punctuation character.
    pub(super) fn at_punct(&self, character: char) -> bool {
        is_punct(self.peek(), character)
    }

    /// Takes the next token if it is this punctuation character; returns whether it is.
    pub(super) fn take_punct(&mut self, character: char) -> bool {
        let found = self.at_punct(character);
        self.next += usize::from(found);
        found
    }

    /// Returns whether the next token is this keyword.
    pub(super) fn at_keyword(&self, keyword: &str) -> bool {
        matches!(self.peek(), Some(TokenTree::Ident(found)) if found == keyword)
    }

    /// Takes the next token if it is this keyword; returns whether it is.
    pub(super) fn take_keyword(&mut self, keyword: &str) -> bool {
        let found = self.at_keyword(keyword);
        self.next += usize::from(found);
        found
    }

    /// Takes the next token if it is an identifier.
    pub(super) fn take_identifier(&mut self) -> Option<Ident> {
        match self.peek() {
            Some(TokenTree::Ident(identifier)) => {
                let identifier = identifier.clone();
                self.next += 1;
                Some(identifier)
            }
            _ => None,
        }
    }

    /// Takes the next token if it is an identifier or a number, which may have a suffix: `2d`.
    pub(super) fn take_word(&mut self) -> Option<String> {
        let word = match self.peek() {
            Some(TokenTree::Ident(identifier)) => identifier.to_string(),
            Some(TokenTree::Literal(number)) => number.to_string(),
            _ => return None,
        };
        self.next += 1;
        Some(word)
    }

    /// Takes the next token if it is `{ … }`.
    pub(super) fn take_braces(&mut self) -> Option<Group> {
        match self.peek() {
            Some(TokenTree::Group(group)) if group.delimiter() == Delimiter::Brace => {
                let group = group.clone();
                self.next += 1;
                Some(group)
            }
            _ => None,
        }
    }

    /// Takes all tokens up to and including the next `,`.
    pub(super) fn skip_past_comma(&mut self) {
        while !self.is_done() && !self.take_punct(',') && self.take().is_some() {}
    }

    /// Reports that `what` is expected in place of the next token.
    pub(super) fn expected(&self, what: &str, help: impl Into<String>, report: &mut Report) -> Stop {
        let message = format!("expected {what}, found {}", self.describe());
        report.error(codes::UNEXPECTED_TOKEN, &self.source_span(report), message, help);
        Stop
    }

    /// Reports that `;` is missing after the last token that was taken. The next token belongs to something else.
    pub(super) fn missing_semicolon(&self, help: &str, report: &mut Report) -> Stop {
        let last = self.next.checked_sub(1).and_then(|index| self.tokens.get(index));
        let (span, after) = match last {
            Some(last) => (end_of(last), format!(" after `{}`", described_end(last))),
            None => (self.span(), String::new()),
        };
        let message = format!("expected `;`{after}, found {}", self.describe());
        report.error(codes::UNEXPECTED_TOKEN, &report.at(span), message, help);
        Stop
    }

    /// Returns the source span of the next token, or of the end.
    pub(super) fn source_span(&self, report: &Report) -> SourceSpan {
        report.at(self.span())
    }

    /// Returns the span of the next token, or of the end.
    pub(super) fn span(&self) -> Span {
        self.peek().map(TokenTree::span).or(self.end).unwrap_or_else(Span::call_site)
    }

    /// Returns the span that messages use after the last token.
    pub(super) fn end(&self) -> Span {
        self.end.unwrap_or_else(Span::call_site)
    }

    /// Returns the next token as a message names it.
    pub(super) fn describe(&self) -> String {
        match self.peek() {
            None => "the end of the input".to_string(),
            Some(TokenTree::Group(group)) => match group.delimiter() {
                Delimiter::Parenthesis => "`(`".to_string(),
                Delimiter::Brace => "`{`".to_string(),
                Delimiter::Bracket => "`[`".to_string(),
                Delimiter::None => "an expression".to_string(),
            },
            Some(token) => format!("`{}`", shortened(&token.to_string())),
        }
    }
}

/// Returns the span of the last character of a token tree: of a closing bracket, or of the token.
pub(super) fn end_of(token: &TokenTree) -> Span {
    match token {
        TokenTree::Group(group) => group.span_close(),
        other => other.span(),
    }
}

/// Returns the last token of a token tree as a message names it.
pub(super) fn described_end(token: &TokenTree) -> String {
    match token {
        TokenTree::Group(group) => match group.delimiter() {
            Delimiter::Parenthesis => ")".to_owned(),
            Delimiter::Brace => "}".to_owned(),
            Delimiter::Bracket => "]".to_owned(),
            Delimiter::None => "…".to_owned(),
        },
        token => shortened(&token.to_string()),
    }
}

/// Returns whether a token is this punctuation character.
pub(super) fn is_punct(token: Option<&TokenTree>, character: char) -> bool {
    matches!(token, Some(TokenTree::Punct(punct)) if punct.as_char() == character)
}

fn shortened(token: &str) -> String {
    if token.chars().count() <= 24 { token.to_string() } else { token.chars().take(21).chain("...".chars()).collect() }
}
