//! The file door: text to tokens, and from a token back to its place.
//!
//! In: the text of a file. Out: tokens, or the one mistake that keeps it from being tokens. Rust's own lexer reads the
//! text; brackets are matched here first, because only so can both partners be named.

use std::str::FromStr;
use std::sync::Arc;

use fragbuf_model::{Diagnostic, Origin, codes};
use proc_macro2::{Span, TokenStream};

/// The way from a span of `text` to its place in `file`.
pub(crate) fn places(text: &str, file: &str) -> impl Fn(Span) -> Origin + use<> {
    let file: Arc<str> = file.into();
    let widths: Vec<usize> = text.lines().map(|line| line.chars().count()).collect();
    move |span: Span| {
        let (start, end) = (span.start(), span.end());
        let line = start.line.max(1);
        let stop = if end.line <= line { end.column } else { widths.get(line - 1).copied().unwrap_or(0) };
        Origin::new(file.clone(), number(line), number(start.column + 1))
            .with_length(number(stop.saturating_sub(start.column)))
    }
}

/// The tokens of `text`.
pub(crate) fn tokens(text: &str, file: &str) -> Result<TokenStream, Box<Diagnostic>> {
    if u32::try_from(text.len()).is_err() {
        let origin = Origin::new(file, 1, 1);
        let message = "the file is longer than 4 GiB";
        return Err(Box::new(Diagnostic::new(codes::UNREADABLE, &origin, message, "describe one buffer per file")));
    }
    if let Some(unmatched) = brackets(text, file) {
        return Err(Box::new(unmatched));
    }
    TokenStream::from_str(text).map_err(|error| {
        let start = error.span().start();
        let origin = Origin::new(file, number(start.line.max(1)), number(start.column + 1));
        Box::new(unreadable(&origin, character(text, start.line, start.column)))
    })
}

/// What is said where the text is no tokens.
pub(crate) fn unreadable(origin: &Origin, found: Option<char>) -> Diagnostic {
    let message = match found {
        Some(letter) => format!("`{letter}` begins nothing that can be read here"),
        None => "the text ends within a token".to_string(),
    };
    let hint = "a description has the tokens of Rust: close strings and comments, and leave out other signs";
    Diagnostic::new(codes::UNREADABLE, origin, message, hint)
}

fn character(text: &str, line: usize, column: usize) -> Option<char> {
    text.lines().nth(line.max(1) - 1)?.chars().nth(column)
}

fn number(value: usize) -> u32 {
    u32::try_from(value).unwrap_or(u32::MAX)
}

/// The first bracket without a partner.
fn brackets(text: &str, file: &str) -> Option<Diagnostic> {
    let place = |(line, column): (u32, u32)| Origin::new(file, line, column);
    let mut open: Vec<(char, (u32, u32))> = Vec::new();
    let mut scan = Scan::new(text);
    while let Some((letter, at)) = scan.next_code() {
        match letter {
            '(' | '[' | '{' => open.push((letter, at)),
            ')' | ']' | '}' => match open.pop() {
                Some((opener, _)) if partner(opener) == letter => {}
                Some((opener, opened)) => {
                    let message = format!("`{letter}` closes nothing: `{opener}` is still open");
                    let hint = format!("write `{}` here, or close it before", partner(opener));
                    let diagnostic = Diagnostic::new(codes::UNREADABLE, &place(at), message, hint);
                    return Some(diagnostic.label(&place(opened), format!("this `{opener}` is open")));
                }
                None => {
                    let message = format!("`{letter}` closes nothing");
                    return Some(Diagnostic::new(codes::UNREADABLE, &place(at), message, "leave it out"));
                }
            },
            _ => {}
        }
    }
    if let Some((what, at)) = scan.unclosed {
        let message = format!("this {what} never ends");
        return Some(Diagnostic::new(codes::UNREADABLE, &place(at), message, "close it, or leave its first sign out"));
    }
    let (opener, at) = open.pop()?;
    let message = format!("`{opener}` is never closed");
    Some(Diagnostic::new(codes::UNREADABLE, &place(at), message, format!("add the `{}`", partner(opener))))
}

fn partner(opener: char) -> char {
    match opener {
        '(' => ')',
        '[' => ']',
        _ => '}',
    }
}

/// The characters of a text that are neither in a comment nor in a string.
struct Scan<'a> {
    letters: std::iter::Peekable<std::str::Chars<'a>>,
    line: u32,
    column: u32,
    /// A string or comment that the text ends in, and where it begins.
    unclosed: Option<(&'static str, (u32, u32))>,
}

impl<'a> Scan<'a> {
    fn new(text: &'a str) -> Self {
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        Scan { letters: text.chars().peekable(), line: 1, column: 1, unclosed: None }
    }

    fn step(&mut self) -> Option<(char, (u32, u32))> {
        let letter = self.letters.next()?;
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
            let (letter, at) = self.step()?;
            match (letter, self.letters.peek()) {
                ('/', Some('/')) => while self.step().is_some_and(|(next, _)| next != '\n') {},
                ('/', Some('*')) => self.skip_block_comment(at),
                ('"', _) => self.skip_string(at),
                ('\'', _) => self.skip_character(),
                _ => return Some((letter, at)),
            }
        }
    }

    /// Rust's block comments nest.
    fn skip_block_comment(&mut self, at: (u32, u32)) {
        let mut depth = 0_u32;
        let mut before = '/';
        while let Some((letter, _)) = self.step() {
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
        while let Some((letter, _)) = self.step() {
            match letter {
                '\\' => drop(self.step()),
                '"' => return,
                _ => {}
            }
        }
        self.unclosed = Some(("string", at));
    }

    /// `'('` is a character, `'a` a label: only the former can hide a bracket.
    fn skip_character(&mut self) {
        let mut ahead = self.letters.clone();
        match (ahead.next(), ahead.next()) {
            (Some('\\'), _) => {
                self.step();
                self.step();
                while self.step().is_some_and(|(next, _)| next != '\'' && next != '\n') {}
            }
            (Some(_), Some('\'')) => {
                self.step();
                self.step();
            }
            _ => {}
        }
    }
}
