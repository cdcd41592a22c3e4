//! A walk over tokens, one level of brackets at a time.
//!
//! In: the tokens of one level. Out: tokens, or the place where something else stands. Nothing here reports mistakes.

use fragbuf_model::Origin;
use proc_macro2::{Delimiter, Group, Ident, Span, TokenStream, TokenTree};

use crate::report::Report;

/// The tokens of one level that are still to be read.
pub(crate) struct Cursor {
    tokens: Vec<TokenTree>,
    next: usize,
    /// What a message points at when the tokens have run out.
    end: Option<Span>,
}

impl Cursor {
    /// All of these tokens.
    pub(crate) fn new(tokens: TokenStream) -> Self {
        let tokens: Vec<TokenTree> = tokens.into_iter().collect();
        let end = tokens.last().map(TokenTree::span);
        Cursor { tokens, next: 0, end }
    }

    /// What stands inside these brackets.
    pub(crate) fn inside(group: &Group) -> Self {
        Cursor { tokens: group.stream().into_iter().collect(), next: 0, end: Some(group.span_close()) }
    }

    /// The next token, which stays.
    pub(crate) fn peek(&self) -> Option<&TokenTree> {
        self.tokens.get(self.next)
    }

    /// The token after the next.
    pub(crate) fn peek_second(&self) -> Option<&TokenTree> {
        self.tokens.get(self.next + 1)
    }

    /// How many tokens were taken.
    pub(crate) fn position(&self) -> usize {
        self.next
    }

    /// Takes the next token.
    pub(crate) fn take(&mut self) -> Option<TokenTree> {
        let token = self.tokens.get(self.next).cloned();
        self.next += usize::from(token.is_some());
        token
    }

    /// Whether nothing is left.
    pub(crate) fn is_done(&self) -> bool {
        self.next >= self.tokens.len()
    }

    /// Whether the next token is this sign.
    pub(crate) fn at_sign(&self, sign: char) -> bool {
        is_sign(self.peek(), sign)
    }

    /// Takes the next token if it is this sign.
    pub(crate) fn sign(&mut self, sign: char) -> bool {
        let found = self.at_sign(sign);
        self.next += usize::from(found);
        found
    }

    /// Whether the next token is this word.
    pub(crate) fn at_word(&self, word: &str) -> bool {
        matches!(self.peek(), Some(TokenTree::Ident(found)) if found == word)
    }

    /// Takes the next token if it is this word.
    pub(crate) fn word(&mut self, word: &str) -> bool {
        let found = self.at_word(word);
        self.next += usize::from(found);
        found
    }

    /// Takes the next token if it is any word.
    pub(crate) fn any_word(&mut self) -> Option<Ident> {
        match self.peek() {
            Some(TokenTree::Ident(word)) => {
                let word = word.clone();
                self.next += 1;
                Some(word)
            }
            _ => None,
        }
    }

    /// Takes the next token if it is `{ … }`.
    pub(crate) fn braces(&mut self) -> Option<Group> {
        match self.peek() {
            Some(TokenTree::Group(group)) if group.delimiter() == Delimiter::Brace => {
                let group = group.clone();
                self.next += 1;
                Some(group)
            }
            _ => None,
        }
    }

    /// The place of the next token, or of the end.
    pub(crate) fn origin(&self, report: &Report) -> Origin {
        report.at(self.span())
    }

    /// The span of the next token, or of the end.
    pub(crate) fn span(&self) -> Span {
        self.peek().map(TokenTree::span).or(self.end).unwrap_or_else(Span::call_site)
    }

    /// The span of what a message points at when the tokens have run out.
    pub(crate) fn end(&self) -> Span {
        self.end.unwrap_or_else(Span::call_site)
    }

    /// The next token in the words of a message.
    pub(crate) fn describe(&self) -> String {
        match self.peek() {
            None => "the end".to_string(),
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

/// Whether a token is this sign.
pub(crate) fn is_sign(token: Option<&TokenTree>, sign: char) -> bool {
    matches!(token, Some(TokenTree::Punct(punct)) if punct.as_char() == sign)
}

fn shortened(text: &str) -> String {
    if text.chars().count() <= 24 { text.to_string() } else { text.chars().take(21).chain("...".chars()).collect() }
}
