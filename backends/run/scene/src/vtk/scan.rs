//! The words, lines and numbers of a legacy file, in order. Numbers are words, or big-endian bytes after the line that declares them.

use super::numbers::Kind;
use crate::error::{FileError, FilePosition};
use crate::limits::Budget;
use crate::text::{quoted, quoted_bytes};

/// A reader of a file.
#[derive(Clone)]
pub(super) struct Scan<'a> {
    bytes: &'a [u8],
    at: usize,
    /// The line of the next byte.
    line: usize,
    pub(super) is_binary: bool,
}

impl<'a> Scan<'a> {
    pub(super) fn new(bytes: &'a [u8]) -> Self {
        Scan { bytes, at: 0, line: 1, is_binary: false }
    }

    fn rest(&self) -> &'a [u8] {
        self.bytes.get(self.at..).unwrap_or_default()
    }

    /// Returns the position of the next word: its line, or in a binary file its byte.
    pub(super) fn position(&self) -> FilePosition {
        if self.is_binary {
            return FilePosition::Byte(self.at);
        }
        let space = self.rest().iter().take_while(|byte| byte.is_ascii_whitespace());
        let (length, lines) =
            space.fold((0, 0), |(length, lines), byte| (length + 1, lines + usize::from(*byte == b'\n')));
        // At the end of the file, the last line.
        FilePosition::Line(if self.at + length == self.bytes.len() { self.line } else { self.line + lines })
    }

    pub(super) fn error(&self, message: impl Into<String>) -> FileError {
        FileError::Malformed(self.position(), message.into())
    }

    /// Returns the rest of the line as text, and goes to the next line.
    pub(super) fn line(&mut self) -> String {
        let line = self.rest().split(|byte| *byte == b'\n').next().unwrap_or_default();
        self.line += usize::from(self.at + line.len() < self.bytes.len());
        self.at = (self.at + line.len() + 1).min(self.bytes.len());
        String::from_utf8_lossy(line.get(..1024).unwrap_or(line)).trim().to_owned()
    }

    /// Returns the next word; `None` at the end of the file.
    pub(super) fn word(&mut self) -> Option<&'a [u8]> {
        for byte in self.rest().iter().take_while(|byte| byte.is_ascii_whitespace()) {
            self.at += 1;
            self.line += usize::from(*byte == b'\n');
        }
        let length = self.rest().iter().take_while(|byte| !byte.is_ascii_whitespace()).count();
        let word = self.rest().get(..length).filter(|word| !word.is_empty());
        self.at += length;
        word
    }

    /// Returns the next word as text.
    pub(super) fn text(&mut self, what: &str) -> Result<String, FileError> {
        let before = self.clone();
        let word = self.word().ok_or_else(|| self.error(format!("the file ends before {what}")))?;
        let word = std::str::from_utf8(word).map_err(|_| before.error(format!("{} is no text", quoted_bytes(word))))?;
        Ok(word.to_owned())
    }

    /// Returns the next word as a count.
    pub(super) fn count(&mut self, what: &str) -> Result<usize, FileError> {
        let before = self.clone();
        let word = self.text(what)?;
        let count = word.parse::<u32>().map(|count| count as usize);
        count.map_err(|_| before.error(format!("{} is not {what}, a whole number below 4294967296", quoted(&word))))
    }

    /// Returns the next word as a type of numbers.
    pub(super) fn kind(&mut self) -> Result<Kind, FileError> {
        let before = self.clone();
        let word = self.text("a type of numbers")?;
        let unknown = || before.error(format!("{} is not a type of numbers: use float or double", quoted(&word)));
        Kind::named(&word).ok_or_else(unknown)
    }

    /// Reads numbers. Their memory is taken from the budget.
    pub(super) fn numbers(
        &mut self,
        count: usize,
        (kind, what): (Kind, &str),
        budget: &Budget,
    ) -> Result<Vec<f64>, FileError> {
        let bytes = self.block(count, kind, what)?;
        budget.take(count as u64, 8, what)?;
        if let Some(bytes) = bytes {
            return Ok(kind.numbers(bytes, true));
        }
        let mut numbers = Vec::with_capacity(count);
        for _ in 0..count {
            numbers.push(self.number(what)?);
        }
        Ok(numbers)
    }

    /// Skips numbers.
    pub(super) fn skip(&mut self, count: usize, (kind, what): (Kind, &str)) -> Result<(), FileError> {
        if self.block(count, kind, what)?.is_some() {
            return Ok(());
        }
        (0..count)
            .try_for_each(|_| self.word().map(drop).ok_or_else(|| self.error(format!("the file ends before {what}"))))
    }

    /// Checks that the rest of the file can have so many numbers. Returns the bytes of a binary file, which begin in the next line.
    fn block(&mut self, count: usize, kind: Kind, what: &str) -> Result<Option<&'a [u8]>, FileError> {
        if self.is_binary {
            self.line();
        }
        let size = if self.is_binary { kind.size() } else { 2 };
        let needed = count.saturating_mul(size);
        // The last word has no separator.
        if needed > self.rest().len() + usize::from(!self.is_binary) {
            let left = self.rest().len();
            return Err(self.error(format!("{count} numbers are declared for {what}, and {left} bytes follow")));
        }
        if !self.is_binary {
            return Ok(None);
        }
        let bytes = self.rest().get(..needed);
        self.at += needed;
        Ok(bytes)
    }

    fn number(&mut self, what: &str) -> Result<f64, FileError> {
        let before = self.clone();
        let Some(word) = self.word() else { return Err(self.error(format!("the file ends before {what}"))) };
        let number = std::str::from_utf8(word).ok().and_then(|word| word.parse().ok());
        number.ok_or_else(|| before.error(format!("{} is not a number", quoted_bytes(word))))
    }
}
