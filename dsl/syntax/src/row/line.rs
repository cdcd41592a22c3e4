//! One line of a row: a walk over its words and signs, with the place of each.

use std::sync::Arc;

use fragbuf_model::{Origin, Spanned};

/// What is left of a line, the part behind ` -- ` apart.
pub(super) struct Line<'a> {
    file: Arc<str>,
    number: u32,
    /// The whole line, for columns.
    whole: &'a str,
    /// Byte offsets of what is left.
    at: usize,
    end: usize,
    /// What stands behind ` -- `, without its final full stop.
    pub(super) summary: Option<&'a str>,
}

impl<'a> Line<'a> {
    /// The line `whole`, behind the sign that ends at byte `start`.
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

    fn place(&self, from: usize, to: usize) -> Origin {
        let column = self.whole[..from].chars().count() as u32 + 1;
        let length = self.whole[from..to].chars().count() as u32;
        Origin::new(self.file.clone(), self.number, column).with_length(length)
    }

    /// All of the line from its first sign to its last.
    pub(super) fn origin(&self) -> Origin {
        let indent = self.whole.len() - self.whole.trim_start().len();
        self.place(indent, self.whole.trim_end().len())
    }

    /// The place of what comes next: a word, a sign, or the end.
    pub(super) fn here(&mut self) -> Origin {
        self.skip_spaces();
        let length = self.word_length().max(self.whole[self.at..self.end].chars().next().map_or(0, char::len_utf8));
        self.place(self.at, self.at + length)
    }

    /// What comes next, in the words of a message.
    pub(super) fn describe(&mut self) -> String {
        self.skip_spaces();
        match self.word_length() {
            0 => self.whole[self.at..self.end].chars().next().map_or("the end".to_owned(), |sign| format!("`{sign}`")),
            length => format!("`{}`", &self.whole[self.at..self.at + length]),
        }
    }

    fn word_length(&self) -> usize {
        let rest = &self.whole[self.at..self.end];
        let inside = |letter: char| letter.is_ascii_alphanumeric() || letter == '_' || letter == '-';
        rest.find(|letter| !inside(letter)).unwrap_or(rest.len())
    }

    /// Takes a word: letters, digits, `_` and `-`.
    pub(super) fn word(&mut self) -> Option<Spanned<String>> {
        self.skip_spaces();
        let from = self.at;
        self.at += self.word_length();
        (self.at > from).then(|| Spanned::new(self.whole[from..self.at].to_owned(), self.place(from, self.at)))
    }

    /// Takes this word, if it comes next.
    pub(super) fn exactly(&mut self, word: &str) -> bool {
        self.skip_spaces();
        let found = &self.whole[self.at..self.at + self.word_length()] == word;
        self.at += if found { word.len() } else { 0 };
        found
    }

    /// Takes this sign, if it comes next.
    pub(super) fn sign(&mut self, sign: char) -> bool {
        self.skip_spaces();
        let found = self.whole[self.at..self.end].starts_with(sign);
        self.at += if found { sign.len_utf8() } else { 0 };
        found
    }

    /// Takes everything up to one of these signs outside of parentheses, or to the end.
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
        Spanned::new(text.to_owned(), self.place(from, from + text.len()))
    }

    /// Whether nothing is left.
    pub(super) fn is_done(&mut self) -> bool {
        self.skip_spaces();
        self.at >= self.end
    }
}
