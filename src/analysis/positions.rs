//! Positions in a text: bytes, and lines with columns in UTF-16 code units, as editors and web pages count.
//!
//! Input: a text. Output: conversions in both directions. Every offset and every position is accepted: one outside of the text is
//! moved to its end, and one inside of a character to the beginning of the character.

use std::ops::Range;

use fragbuf_model::SourceSpan;

/// A position in a text. Both numbers count from 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Position {
    /// The line.
    pub line: u32,
    /// The UTF-16 code units before the position in its line.
    pub character: u32,
}

/// A part of a text.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct TextSpan {
    /// Its bytes.
    pub bytes: Range<usize>,
    /// The position of the first byte.
    pub start: Position,
    /// The position behind the last byte.
    pub end: Position,
}

/// The lines of a text.
#[derive(Clone, Debug)]
pub struct Lines<'a> {
    text: &'a str,
    /// The first byte of each line, as editors divide lines: at `\n`, `\r\n` and `\r`.
    starts: Vec<usize>,
    /// The first byte of each line, as the lexer divides them: at `\n`.
    lexed: Vec<usize>,
    /// The characters and UTF-16 code units before some bytes. A line may be as long as the text.
    marks: Vec<Mark>,
}

/// The characters and the UTF-16 code units before a byte.
#[derive(Clone, Copy, Debug, Default)]
struct Mark {
    byte: usize,
    characters: usize,
    units: usize,
}

/// The least number of bytes between two marks.
const STEP: usize = 1024;

impl<'a> Lines<'a> {
    /// Finds the lines of `text`.
    pub fn new(text: &'a str) -> Self {
        let bytes = text.as_bytes();
        let is_end = |at: usize| match bytes.get(at) {
            Some(b'\n') => true,
            Some(b'\r') => bytes.get(at + 1) != Some(&b'\n'),
            _ => false,
        };
        let ends = (0..bytes.len()).filter(|at| is_end(*at));
        let starts = std::iter::once(0).chain(ends.map(|at| at + 1)).collect();
        // The lexer skips a byte order mark.
        let first = if text.starts_with('\u{feff}') { '\u{feff}'.len_utf8() } else { 0 };
        let lexed = std::iter::once(first).chain(text.match_indices('\n').map(|(at, _)| at + 1)).collect();
        Lines { text, starts, lexed, marks: marks(text) }
    }

    /// Returns the position of a byte.
    pub fn position(&self, offset: usize) -> Position {
        let offset = self.boundary(offset);
        let line = self.starts.partition_point(|start| *start <= offset).saturating_sub(1);
        let start = self.starts.get(line).copied().unwrap_or_default();
        let character = self.before(offset).units.saturating_sub(self.before(start).units);
        Position { line: line as u32, character: character as u32 }
    }

    /// Returns the byte at a position.
    pub fn offset(&self, position: Position) -> usize {
        let Some(start) = self.starts.get(position.line as usize).copied() else { return self.text.len() };
        let next = self.starts.get(position.line as usize + 1).copied().unwrap_or(self.text.len());
        let end = start + self.text.get(start..next).unwrap_or_default().trim_end_matches(['\n', '\r']).len();
        self.of_utf16(self.before(start).units + position.character as usize).min(end)
    }

    /// Returns the part of the text with these bytes.
    pub fn span(&self, bytes: Range<usize>) -> TextSpan {
        let start = self.boundary(bytes.start);
        let end = self.boundary(bytes.end).max(start);
        TextSpan { bytes: start..end, start: self.position(start), end: self.position(end) }
    }

    /// Returns the part of the text that a span of the compiler covers.
    pub fn source_span(&self, span: &SourceSpan) -> TextSpan {
        let line = (span.line as usize).saturating_sub(1);
        let Some(start) = self.lexed.get(line).copied() else { return self.span(self.text.len()..self.text.len()) };
        let end = self.lexed.get(line + 1).map_or(self.text.len(), |next| next - 1);
        let first = self.before(start).characters + (span.column as usize).saturating_sub(1);
        let byte = |characters: usize| self.byte(characters, |mark| mark.characters).min(end);
        self.span(byte(first)..byte(first + span.length as usize))
    }

    /// Returns the UTF-16 code units before a byte, as an index into a string of JavaScript.
    pub fn utf16(&self, offset: usize) -> usize {
        self.before(self.boundary(offset)).units
    }

    /// Returns the byte behind this number of UTF-16 code units.
    pub fn of_utf16(&self, units: usize) -> usize {
        self.byte(units, |mark| mark.units)
    }

    /// Returns what is before a byte that begins a character.
    fn before(&self, offset: usize) -> Mark {
        let index = self.marks.partition_point(|mark| mark.byte <= offset).saturating_sub(1);
        let mark = self.marks.get(index).copied().unwrap_or_default();
        self.text.get(mark.byte..offset).unwrap_or_default().chars().fold(mark, Mark::after)
    }

    /// Returns the last byte that begins a character and has at most `most` before it.
    fn byte(&self, most: usize, count: impl Fn(&Mark) -> usize) -> usize {
        let index = self.marks.partition_point(|mark| count(mark) <= most).saturating_sub(1);
        let mut mark = self.marks.get(index).copied().unwrap_or_default();
        for letter in self.text.get(mark.byte..).unwrap_or_default().chars() {
            let next = mark.after(letter);
            if count(&next) > most {
                return mark.byte;
            }
            mark = next;
        }
        self.text.len()
    }

    /// Returns the beginning of the character at a byte, or the end of the text.
    pub fn boundary(&self, offset: usize) -> usize {
        let offset = offset.min(self.text.len());
        (0..=offset).rev().find(|at| self.text.is_char_boundary(*at)).unwrap_or_default()
    }
}

impl Mark {
    /// Returns what is before the character behind `letter`.
    fn after(self, letter: char) -> Mark {
        let Mark { byte, characters, units } = self;
        Mark { byte: byte + letter.len_utf8(), characters: characters + 1, units: units + letter.len_utf16() }
    }
}

fn marks(text: &str) -> Vec<Mark> {
    let (mut marks, mut mark) = (vec![Mark::default()], Mark::default());
    for letter in text.chars() {
        mark = mark.after(letter);
        if marks.last().is_none_or(|last| mark.byte - last.byte >= STEP) {
            marks.push(mark);
        }
    }
    marks
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(line: u32, character: u32) -> Position {
        Position { line, character }
    }

    #[test]
    fn columns_count_utf16_code_units() {
        let text = "aé𝄞b\r\nc\rd\n";
        let lines = Lines::new(text);
        let expected = [(0, at(0, 0)), (1, at(0, 1)), (3, at(0, 2)), (7, at(0, 4)), (8, at(0, 5)), (10, at(1, 0))];
        for (offset, position) in expected {
            assert_eq!(lines.position(offset), position);
            assert_eq!(lines.offset(position), offset);
        }
        assert_eq!(lines.position(12), at(2, 0), "a carriage return alone ends a line");
        assert_eq!((lines.utf16(7), lines.of_utf16(4), lines.of_utf16(3)), (4, 7, 3));
        assert_eq!((lines.utf16(usize::MAX), lines.of_utf16(usize::MAX)), (11, text.len()));
        // Inside of a character, behind a line, behind the text.
        assert_eq!((lines.position(5), lines.offset(at(0, 3))), (at(0, 2), 3));
        assert_eq!((lines.offset(at(0, 99)), lines.offset(at(99, 0))), (8, text.len()));
        assert_eq!(lines.position(usize::MAX), at(3, 0));
    }

    #[test]
    fn spans_of_the_compiler_are_in_characters() {
        let text = "\u{feff}é x\ny𝄞z";
        let lines = Lines::new(text);
        let part = |line, column, length| {
            let span = SourceSpan::new("file", line, column).with_length(length);
            text.get(lines.source_span(&span).bytes).unwrap_or("?")
        };
        assert_eq!(
            (part(1, 1, 1), part(1, 3, 1), part(2, 2, 2), part(2, 3, 9), part(7, 1, 1)),
            ("é", "x", "𝄞z", "z", "")
        );
    }
}
