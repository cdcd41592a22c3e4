//! The lexer of the file front end.
//!
//! Input: the source of a file. Output: tokens and their spans, or one error. Rust's lexer produces the tokens. Brackets are
//! matched here first, so that an error can point to both brackets.

use std::str::FromStr;
use std::sync::Arc;

use fragbuf_model::{Diagnostic, SourceSpan, codes};
use proc_macro2::{Span, TokenStream};

/// Returns a function from token spans of `source` to source spans in `file`.
pub(crate) fn locator(source: &str, file: &str) -> impl Fn(Span) -> SourceSpan + use<> {
    let file: Arc<str> = file.into();
    let widths: Vec<usize> = source.lines().map(|line| line.chars().count()).collect();
    move |span: Span| {
        let (start, end) = (span.start(), span.end());
        let line = start.line.max(1);
        let stop = if end.line <= line { end.column } else { widths.get(line - 1).copied().unwrap_or(0) };
        SourceSpan::new(file.clone(), number(line), number(start.column + 1))
            .with_length(number(stop.saturating_sub(start.column)))
    }
}

/// Returns the tokens of `source`.
pub(crate) fn tokens(source: &str, file: &str) -> Result<TokenStream, Box<Diagnostic>> {
    if u32::try_from(source.len()).is_err() {
        let span = SourceSpan::new(file, 1, 1);
        let message = "the file is longer than 4 GiB";
        return Err(Box::new(Diagnostic::new(codes::INVALID_TOKEN, &span, message, "describe one buffer per file")));
    }
    if let Some(unmatched) = match_brackets(source, file) {
        return Err(Box::new(unmatched));
    }
    TokenStream::from_str(source).map_err(|error| {
        let start = error.span().start();
        let span = SourceSpan::new(file, number(start.line.max(1)), number(start.column + 1));
        Box::new(invalid_token(&span, character(source, start.line, start.column)))
    })
}

/// Returns the error for a character that starts no token, or for a source that ends within one.
pub(crate) fn invalid_token(span: &SourceSpan, found: Option<char>) -> Diagnostic {
    let message = match found {
        Some(letter) => format!("unexpected character `{letter}`"),
        None => "the source ends within a token".to_string(),
    };
    let help = "a description consists of Rust tokens: close strings and comments, and remove other characters";
    Diagnostic::new(codes::INVALID_TOKEN, span, message, help)
}

fn character(source: &str, line: usize, column: usize) -> Option<char> {
    source.lines().nth(line.max(1) - 1)?.chars().nth(column)
}

fn number(value: usize) -> u32 {
    u32::try_from(value).unwrap_or(u32::MAX)
}

/// Returns an error at the first bracket without a partner.
fn match_brackets(source: &str, file: &str) -> Option<Diagnostic> {
    let span = |(line, column): (u32, u32)| SourceSpan::new(file, line, column);
    let mut open: Vec<(char, (u32, u32))> = Vec::new();
    let mut scan = Scan::new(source);
    while let Some((letter, at)) = scan.next_code() {
        match letter {
            '(' | '[' | '{' => open.push((letter, at)),
            ')' | ']' | '}' => match open.pop() {
                Some((opener, _)) if partner(opener) == letter => {}
                Some((opener, opened)) => {
                    let message = format!("mismatched closing delimiter `{letter}`");
                    let help = format!("write `{}` here, or close `{opener}` before", partner(opener));
                    let diagnostic = Diagnostic::new(codes::INVALID_TOKEN, &span(at), message, help);
                    return Some(diagnostic.label(&span(opened), format!("unclosed delimiter `{opener}`")));
                }
                None => {
                    let message = format!("unexpected closing delimiter `{letter}`");
                    return Some(Diagnostic::new(codes::INVALID_TOKEN, &span(at), message, "remove it"));
                }
            },
            _ => {}
        }
    }
    if let Some((what, at)) = scan.unclosed {
        let message = format!("unterminated {what}");
        return Some(Diagnostic::new(
            codes::INVALID_TOKEN,
            &span(at),
            message,
            "close it, or remove its opening characters",
        ));
    }
    let (opener, at) = open.pop()?;
    let message = format!("unclosed delimiter `{opener}`");
    Some(Diagnostic::new(codes::INVALID_TOKEN, &span(at), message, format!("add the `{}`", partner(opener))))
}

fn partner(opener: char) -> char {
    match opener {
        '(' => ')',
        '[' => ']',
        _ => '}',
    }
}

/// An iterator over the characters that are neither in a comment nor in a string.
struct Scan<'a> {
    characters: std::iter::Peekable<std::str::Chars<'a>>,
    line: u32,
    column: u32,
    /// The string or comment in which the source ends, and its start.
    unclosed: Option<(&'static str, (u32, u32))>,
}

impl<'a> Scan<'a> {
    fn new(source: &'a str) -> Self {
        let source = source.strip_prefix('\u{feff}').unwrap_or(source);
        Scan { characters: source.chars().peekable(), line: 1, column: 1, unclosed: None }
    }

    fn advance(&mut self) -> Option<(char, (u32, u32))> {
        let letter = self.characters.next()?;
        let at = (self.line, self.column);
        if letter == '\n' {
            self.line = self.line.saturating_add(1);
            self.column = 1;
        } else {
            self.column = self.column.saturating_add(1);
        }
        Some((letter, at))
    }

    fn next_code(&mut self) -> Option<(char, (u32, u32))> {
        loop {
            let (letter, at) = self.advance()?;
            match (letter, self.characters.peek()) {
                ('/', Some('/')) => while self.advance().is_some_and(|(next, _)| next != '\n') {},
                ('/', Some('*')) => self.skip_block_comment(at),
                ('"', _) => self.skip_string(at),
                ('\'', _) => self.skip_character(),
                _ => return Some((letter, at)),
            }
        }
    }

    /// Skips a block comment. Rust's block comments nest.
    fn skip_block_comment(&mut self, at: (u32, u32)) {
        let mut depth = 0_u32;
        let mut before = '/';
        while let Some((letter, _)) = self.advance() {
            match (before, letter) {
                ('/', '*') => (depth, before) = (depth.saturating_add(1), ' '),
                ('*', '/') if depth <= 1 => return,
                ('*', '/') => (depth, before) = (depth - 1, ' '),
                _ => before = letter,
            }
        }
        self.unclosed = Some(("comment", at));
    }

    fn skip_string(&mut self, at: (u32, u32)) {
        while let Some((letter, _)) = self.advance() {
            match letter {
                '\\' => drop(self.advance()),
                '"' => return,
                _ => {}
            }
        }
        self.unclosed = Some(("string", at));
    }

    /// Skips a character literal such as `'('`, but not a label such as `'a`.
    fn skip_character(&mut self) {
        let mut ahead = self.characters.clone();
        match (ahead.next(), ahead.next()) {
            (Some('\\'), _) => {
                self.advance();
                self.advance();
                while self.advance().is_some_and(|(next, _)| next != '\'' && next != '\n') {}
            }
            (Some(_), Some('\'')) => {
                self.advance();
                self.advance();
            }
            _ => {}
        }
    }
}
