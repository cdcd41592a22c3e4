//! A cursor over one line of a row.
//!
//! Input: a line. Output: its names, punctuation and formulas, each with its span.

use std::sync::Arc;

use fragbuf_model::{SourceSpan, Spanned};

use super::former;

/// The remaining part of a line, without the summary after ` -- `.
pub(super) struct Line<'a> {
    file: Arc<str>,
    number: u32,
    /// The whole line, for columns.
    whole: &'a str,
    /// Byte offsets of the remaining part.
    at: usize,
    end: usize,
    /// The summary after ` -- `, without its final full stop.
    pub(super) summary: Option<&'a str>,
}

impl<'a> Line<'a> {
    /// Returns a cursor over the line `whole` from byte `start`, where the row mark ends.
    pub(super) fn new(file: &Arc<str>, number: u32, whole: &'a str, start: usize) -> Self {
        let split = whole[start..].find(" -- ").map(|at| start + at);
        let summary = split.map(|at| whole[at + 4..].trim().trim_end_matches('.'));
        let end = split.unwrap_or(whole.trim_end().len()).max(start);
        Line { file: file.clone(), number, whole, at: start, end, summary }
    }

    fn skip_spaces(&mut self) {
        let rest = &self.whole[self.at..self.end];
        self.at += rest.len() - rest.trim_start().len();
    }

    fn span_of(&self, from: usize, to: usize) -> SourceSpan {
        let column = self.whole[..from].chars().count() as u32 + 1;
        let length = self.whole[from..to].chars().count() as u32;
        SourceSpan::new(self.file.clone(), self.number, column).with_length(length)
    }

    /// Returns the span of the whole line without surrounding spaces.
    pub(super) fn span(&self) -> SourceSpan {
        let indent = self.whole.len() - self.whole.trim_start().len();
        self.span_of(indent, self.whole.trim_end().len())
    }

    /// Returns the span of the next name or character, or of the end.
    pub(super) fn here(&mut self) -> SourceSpan {
        self.skip_spaces();
        let length = self.name_length().max(self.whole[self.at..self.end].chars().next().map_or(0, char::len_utf8));
        self.span_of(self.at, self.at + length)
    }

    /// Returns the next name or character as a message names it.
    pub(super) fn describe(&mut self) -> String {
        self.skip_spaces();
        match self.name_length() {
            0 => self.whole[self.at..self.end]
                .chars()
                .next()
                .map_or_else(|| "the end of the line".to_owned(), |next| format!("`{next}`")),
            length => format!("`{}`", &self.whole[self.at..self.at + length]),
        }
    }

    fn name_length(&self) -> usize {
        let rest = &self.whole[self.at..self.end];
        let inside = |letter: char| letter.is_ascii_alphanumeric() || letter == '_' || letter == '-';
        rest.find(|letter| !inside(letter)).unwrap_or(rest.len())
    }

    /// Takes a name of letters, digits, `_` and `-`.
    pub(super) fn name(&mut self) -> Option<Spanned<String>> {
        self.skip_spaces();
        let from = self.at;
        self.at += self.name_length();
        (self.at > from).then(|| Spanned::new(self.whole[from..self.at].to_owned(), self.span_of(from, self.at)))
    }

    /// Takes this keyword if it is next; returns whether it is.
    pub(super) fn keyword(&mut self, keyword: &str) -> bool {
        self.skip_spaces();
        let found = &self.whole[self.at..self.at + self.name_length()] == keyword;
        self.at += if found { keyword.len() } else { 0 };
        found
    }

    /// Takes this character if it is next; returns whether it is.
    pub(super) fn punct(&mut self, character: char) -> bool {
        self.skip_spaces();
        let found = self.whole[self.at..self.end].starts_with(character);
        self.at += if found { character.len_utf8() } else { 0 };
        found
    }

    /// Takes everything up to one of these characters outside of parentheses, or to the end.
    pub(super) fn until(&mut self, stops: &[char]) -> Spanned<String> {
        self.skip_spaces();
        let (from, mut depth) = (self.at, 0i32);
        let rest = &self.whole[from..self.end];
        let stop = rest.char_indices().find(|(_, letter)| {
            depth += i32::from(*letter == '(') - i32::from(*letter == ')');
            depth <= 0 && stops.contains(letter)
        });
        self.at = stop.map_or(self.end, |(at, _)| from + at);
        let text = self.whole[from..self.at].trim_end();
        Spanned::new(text.to_owned(), self.span_of(from, from + text.len()))
    }

    /// As [`Self::until`], for a formula.
    pub(super) fn formula(&mut self, stops: &[char]) -> Spanned<String> {
        let text = self.until(stops);
        Spanned::new(former::formula(&text.value), text.span)
    }

    /// Returns whether nothing remains.
    pub(super) fn is_done(&mut self) -> bool {
        self.skip_spaces();
        self.at >= self.end
    }
}
