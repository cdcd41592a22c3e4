//! The numbers of the body of a PLY file, in order, in each of the encodings. In an ASCII body they are separated by space or line
//! ends; lines have no other meaning.
//!
//! Nothing is collected: a number is read where it is in the file, so a body needs no memory beside its file.

use super::header::{Element, Encoding, Header, Kind};
use crate::error::{FileError, FilePosition};
use crate::text::{quoted, quoted_bytes};
use crate::warnings::{FileWarnings, Message, WarningKind};

/// The least number of bytes after a binary body that a reader warns of: fewer may align the file.
const LEAST_RECORD: usize = 4;

/// Returns the number of lines that are not empty.
pub(super) fn lines(bytes: &[u8]) -> usize {
    let lines = bytes.split(|byte| matches!(byte, b'\n' | b'\r'));
    lines.filter(|line| !line.trim_ascii().is_empty()).count()
}

/// A reader of the body.
#[derive(Clone)]
pub(super) struct Body<'a> {
    encoding: Encoding,
    bytes: &'a [u8],
    /// The next byte.
    at: usize,
    /// The line of the next byte, from 1; at the end of the file, the last line.
    line: usize,
    /// The record that is read.
    record: Option<Record>,
}

/// A record of an element, for messages.
#[derive(Clone)]
struct Record {
    element: String,
    /// The number that the header declares, and its line.
    declared: (usize, usize),
    /// The number of records before it.
    before: usize,
}

impl<'a> Body<'a> {
    pub(super) fn new(header: &Header, bytes: &'a [u8]) -> Self {
        let is_empty = header.length >= bytes.len();
        let line = if is_empty { header.lines } else { header.lines + 1 };
        Body { encoding: header.encoding, bytes, at: header.length, line, record: None }
    }

    /// Begins the records of an element.
    pub(super) fn begin(&mut self, element: &Element) {
        let declared = (element.count, element.line);
        self.record = Some(Record { element: element.name.clone(), declared, before: 0 });
    }

    /// Ends a record.
    pub(super) fn end_record(&mut self) {
        if let Some(record) = &mut self.record {
            record.before += 1;
        }
    }

    /// Returns the error about a file that ends within a record.
    fn ended(&self) -> FileError {
        let Some(Record { element, declared: (count, line), before }) = &self.record else {
            return self.error("the file ends before its last element");
        };
        let element = quoted(element);
        self.error(format!(
            "the file ends before its last element: line {line} declares {count} of {element}, and the file has {before}"
        ))
    }

    /// Returns the current position.
    pub(super) fn position(&self) -> FilePosition {
        match self.encoding {
            Encoding::Ascii => FilePosition::Line(self.line),
            Encoding::Little | Encoding::Big => FilePosition::Byte(self.at),
        }
    }

    /// Returns an error at the current position.
    pub(super) fn error(&self, message: impl Into<String>) -> FileError {
        FileError::Malformed(self.position(), message.into())
    }

    /// Warns of what follows the last record: more words, or more bytes than a writer appends for alignment. `header` declares too few
    /// records, or the file is damaged.
    pub(super) fn end(&mut self, header: &Header, warnings: FileWarnings<'_>) {
        let declared = header.declared();
        let text = match self.encoding {
            Encoding::Ascii => {
                let Some(word) = self.word() else { return };
                let more = self.records_after(word);
                format!(
                    "{} follows the last element: the header declares {declared}, and the file has {more}",
                    quoted_bytes(word)
                )
            }
            Encoding::Little | Encoding::Big => {
                let rest = self.bytes.get(self.at..).unwrap_or_default();
                if rest.len() < LEAST_RECORD || rest.iter().all(|byte| *byte == 0 || byte.is_ascii_whitespace()) {
                    return;
                }
                format!("{} bytes follow the last element: the header declares {declared}", rest.len())
            }
        };
        let message = Message::new(text, "it is skipped");
        warnings.add(WarningKind::UnknownStatement, "", || (self.position(), message));
    }

    /// Returns how many lines are left, in words; `word` was the last that was read.
    fn records_after(&self, word: &[u8]) -> String {
        let start = self.at.saturating_sub(word.len());
        match lines(self.bytes.get(start..).unwrap_or_default()) {
            1 => "1 more line".to_owned(),
            count => format!("{count} more lines"),
        }
    }

    /// Reads the length of a list of numbers of type `item`. A list that the rest of the file cannot hold is an error.
    pub(super) fn length(&mut self, kind: Kind, item: Kind) -> Result<u64, FileError> {
        let value = self.scalar(kind)?;
        if value < 0.0 {
            return Err(self.error(format!("a list of length {value}")));
        }
        let rest = self.bytes.len().saturating_sub(self.at) as u64;
        let most = match self.encoding {
            // A digit and a separator, which the last number does not need.
            Encoding::Ascii => rest.div_ceil(2),
            Encoding::Little | Encoding::Big => rest / item.size(),
        };
        if value > most as f64 {
            return Err(self.error(format!("a list of {value} numbers, and {rest} bytes follow")));
        }
        Ok(value as u64)
    }

    /// Reads the next number.
    pub(super) fn scalar(&mut self, kind: Kind) -> Result<f64, FileError> {
        if self.encoding == Encoding::Ascii {
            return self.ascii_scalar(kind);
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

    fn ascii_scalar(&mut self, kind: Kind) -> Result<f64, FileError> {
        let Some(word) = self.word() else {
            return Err(self.ended());
        };
        let value: Option<f64> = std::str::from_utf8(word).ok().and_then(|word| word.parse().ok());
        let value = value.ok_or_else(|| self.error(format!("{} is not a number", quoted_bytes(word))))?;
        let is_valid = matches!(kind, Kind::F32 | Kind::F64) || value.fract() == 0.0;
        if is_valid { Ok(value) } else { Err(self.error(format!("{} is not an integer", quoted_bytes(word)))) }
    }

    /// Reads the next bytes, the least significant first.
    fn take<const N: usize>(&mut self) -> Result<[u8; N], FileError> {
        let found = self.bytes.get(self.at..).and_then(|rest| rest.first_chunk::<N>());
        let Some(mut bytes) = found.copied() else {
            return Err(self.ended());
        };
        self.at += N;
        if self.encoding == Encoding::Big {
            bytes.reverse();
        }
        Ok(bytes)
    }

    /// Skips to the next word of an ASCII body; returns its line. `None`: the body is binary.
    pub(super) fn next_line(&mut self) -> Option<usize> {
        if self.encoding != Encoding::Ascii {
            return None;
        }
        self.skip_space();
        Some(self.line)
    }

    /// Returns the line of the last word that was read.
    pub(super) fn last_line(&self) -> usize {
        self.line
    }

    fn skip_space(&mut self) {
        while let Some(byte) = self.bytes.get(self.at).filter(|byte| byte.is_ascii_whitespace()) {
            self.at += 1;
            // A carriage return and a line feed are one line end.
            let next = self.bytes.get(self.at);
            let is_end = *byte == b'\n' || (*byte == b'\r' && next != Some(&b'\n'));
            if is_end && next.is_some() {
                self.line += 1;
            }
        }
    }

    /// Returns the next word; `None` at the end of the file.
    fn word(&mut self) -> Option<&'a [u8]> {
        self.skip_space();
        let rest = self.bytes.get(self.at..)?;
        let length = rest.iter().take_while(|byte| !byte.is_ascii_whitespace()).count();
        self.at += length;
        rest.get(..length).filter(|word| !word.is_empty())
    }
}
