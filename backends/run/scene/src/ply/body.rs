//! The numbers of the body of a PLY file, in order, in each of the encodings. One line of an ASCII body is one record.

use std::borrow::Cow;

use super::header::{Encoding, Header, Kind};
use crate::error::{FileError, FilePosition};

/// A reader of the body.
pub(super) struct Body<'a> {
    encoding: Encoding,
    bytes: &'a [u8],
    /// The next byte.
    at: usize,
    /// The line being read, from 1.
    line: usize,
    /// The unread words of the line, last first.
    words: Vec<Cow<'a, str>>,
}

impl<'a> Body<'a> {
    pub(super) fn new(header: &Header, bytes: &'a [u8]) -> Self {
        Body { encoding: header.encoding, bytes, at: header.length, line: header.lines, words: Vec::new() }
    }

    /// Returns an error at the current position.
    pub(super) fn error(&self, message: impl Into<String>) -> FileError {
        match self.encoding {
            Encoding::Ascii => FileError::line(self.line, message),
            Encoding::Little | Encoding::Big => FileError(FilePosition::Byte(self.at), message.into()),
        }
    }

    /// Starts the next record.
    pub(super) fn record(&mut self) -> Result<(), FileError> {
        while self.encoding == Encoding::Ascii && self.words.is_empty() {
            let Some(line) = self.next_line() else {
                return Err(self.error("the file ends before its last element"));
            };
            self.words = line;
        }
        Ok(())
    }

    /// Checks that the record has no more numbers.
    pub(super) fn end_record(&mut self) -> Result<(), FileError> {
        match self.words.last() {
            Some(word) => Err(self.error(format!("`{word}` follows the last number of the element"))),
            None => Ok(()),
        }
    }

    /// Checks that the file has no more records. Bytes after a binary body are ignored.
    pub(super) fn end(&mut self) -> Result<(), FileError> {
        while self.encoding == Encoding::Ascii {
            match self.next_line() {
                None => break,
                Some(line) if line.is_empty() => {}
                Some(_) => return Err(self.error("a line follows the last element")),
            }
        }
        Ok(())
    }

    /// Reads the length of a list.
    pub(super) fn length(&mut self, kind: Kind) -> Result<usize, FileError> {
        let value = self.scalar(kind)?;
        // No memory is reserved for it: a wrong length reaches the end of the file.
        if value >= 0.0 { Ok(value as usize) } else { Err(self.error(format!("a list of length {value}"))) }
    }

    /// Reads the next number.
    pub(super) fn scalar(&mut self, kind: Kind) -> Result<f64, FileError> {
        if self.encoding == Encoding::Ascii {
            let Some(word) = self.words.pop() else {
                return Err(self.error("the line has fewer numbers than the element"));
            };
            let value: f64 = word.parse().map_err(|_| self.error(format!("`{word}` is not a number")))?;
            let is_valid = matches!(kind, Kind::F32 | Kind::F64) || value.fract() == 0.0;
            return if is_valid { Ok(value) } else { Err(self.error(format!("`{word}` is not an integer"))) };
        }
        Ok(match kind {
            Kind::I8 => i8::from_le_bytes(self.take()?).into(),
            Kind::U8 => u8::from_le_bytes(self.take()?).into(),
            Kind::I16 => i16::from_le_bytes(self.take()?).into(),
            Kind::U16 => u16::from_le_bytes(self.take()?).into(),
            Kind::I32 => i32::from_le_bytes(self.take()?).into(),
            Kind::U32 => u32::from_le_bytes(self.take()?).into(),
            Kind::F32 => f32::from_le_bytes(self.take()?).into(),
            Kind::F64 => f64::from_le_bytes(self.take()?),
        })
    }

    /// Reads the next bytes, the least significant first.
    fn take<const N: usize>(&mut self) -> Result<[u8; N], FileError> {
        let found = self.bytes.get(self.at..).and_then(|rest| rest.first_chunk::<N>());
        let Some(mut bytes) = found.copied() else {
            return Err(self.error("the file ends before its last element"));
        };
        self.at += N;
        if self.encoding == Encoding::Big {
            bytes.reverse();
        }
        Ok(bytes)
    }

    fn next_line(&mut self) -> Option<Vec<Cow<'a, str>>> {
        let rest = self.bytes.get(self.at..).filter(|rest| !rest.is_empty())?;
        let length = rest.iter().position(|byte| *byte == b'\n').map_or(rest.len(), |end| end + 1);
        self.at += length;
        self.line += 1;
        let words = rest.get(..length)?.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty());
        let mut words: Vec<Cow<'a, str>> = words.map(String::from_utf8_lossy).collect();
        words.reverse();
        Some(words)
    }
}
