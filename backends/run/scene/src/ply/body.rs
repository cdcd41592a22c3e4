//! The numbers of the body of a PLY file, in order, in each of the encodings. In an ASCII body they are separated by space or line
//! ends; lines have no other meaning.
//!
//! Nothing is collected: a number is read where it is in the file, so a body needs no memory beside its file.

use super::header::{Element, Encoding, Header, Kind, Property};
use crate::error::{FileError, FilePosition};
use crate::text::{counted, quoted, quoted_bytes};
use crate::warnings::{FileWarnings, Message, WarningKind};

/// The least number of bytes after a binary body that a reader warns of: fewer may align the file.
const LEAST_RECORD: usize = 4;

/// The greatest number of properties that a message names.
const MOST_NAMES: usize = 12;

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
    /// The first line that has another number of values than its record, with the message about it: the likely cause of later errors.
    mismatch: Option<(usize, String)>,
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
        Body { encoding: header.encoding, bytes, at: header.length, line, record: None, mismatch: None }
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

    /// Returns an error at the current position, or at the line that does not have the values of its record.
    pub(super) fn error(&self, message: impl Into<String>) -> FileError {
        let message = message.into();
        match &self.mismatch {
            Some((line, _)) if *line == self.line => FileError::Malformed(self.position(), message),
            Some((line, text)) => {
                let message = format!("{text}: values are read across lines, and line {}: {message}", self.line);
                FileError::Malformed(FilePosition::Line(*line), message)
            }
            None => FileError::Malformed(self.position(), message),
        }
    }

    /// Returns the message about the current record of an ASCII body, which began at byte `start`, if it does not have a line of its own.
    /// `properties` are those of the record.
    pub(super) fn mismatch(&mut self, (line, start): (usize, usize), properties: &[Property]) -> String {
        let is_end = |byte: &u8| matches!(byte, b'\n' | b'\r');
        let (before, rest) = self.bytes.split_at_checked(start).unwrap_or_default();
        let begin = before.iter().rposition(is_end).map_or(0, |at| at + 1);
        let end = start + rest.iter().position(is_end).unwrap_or(rest.len());
        let words = self.bytes.get(begin..end).unwrap_or_default().split(u8::is_ascii_whitespace);
        let found = counted(words.filter(|word| !word.is_empty()).count(), "value");
        let names: Vec<String> = properties.iter().map(|property| quoted(&property.name)).collect();
        let text = match properties.iter().any(|property| property.list.is_some()) || names.len() > MOST_NAMES {
            true => format!("a line has {found}, and is no vertex of {} properties", names.len()),
            false => format!("a line has {found}, and a vertex has {}: {}", names.len(), names.join(", ")),
        };
        self.mismatch.get_or_insert((line, text.clone()));
        text
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
        counted(lines(self.bytes.get(start..).unwrap_or_default()), "more line")
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
            let (numbers, bytes) = (counted(value, "number"), counted(rest, "byte"));
            let follow = if rest == 1 { "follows" } else { "follow" };
            return Err(self.error(format!("a list of {numbers}, and {bytes} {follow}")));
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

    /// Skips to the next word of an ASCII body; returns its line and its byte. `None`: the body is binary.
    pub(super) fn next_line(&mut self) -> Option<(usize, usize)> {
        if self.encoding != Encoding::Ascii {
            return None;
        }
        self.skip_space();
        Some((self.line, self.at))
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
