//! The numbers of a PLY file's body, in their order, whatever they are written in. One line of an ascii body is one record.

use std::borrow::Cow;

use super::header::{Encoding, Header, Kind};
use crate::error::{Fault, Place};

/// The body, read up to some place.
pub(super) struct Body<'a> {
    encoding: Encoding,
    bytes: &'a [u8],
    /// The next byte.
    at: usize,
    /// The line being read, from 1.
    line: usize,
    /// The words of that line that have not been read, last first.
    words: Vec<Cow<'a, str>>,
}

impl<'a> Body<'a> {
    pub(super) fn new(header: &Header, bytes: &'a [u8]) -> Self {
        Body { encoding: header.encoding, bytes, at: header.length, line: header.lines, words: Vec::new() }
    }

    /// A mistake where the body is being read.
    pub(super) fn fault(&self, message: impl Into<String>) -> Fault {
        match self.encoding {
            Encoding::Ascii => Fault::line(self.line, message),
            Encoding::Little | Encoding::Big => Fault(Place::Byte(self.at), message.into()),
        }
    }

    /// Starts the next record.
    pub(super) fn record(&mut self) -> Result<(), Fault> {
        while self.encoding == Encoding::Ascii && self.words.is_empty() {
            let Some(line) = self.next_line() else {
                return Err(self.fault("the file ends before its last element"));
            };
            self.words = line;
        }
        Ok(())
    }

    /// Nothing is left of the record.
    pub(super) fn end_record(&mut self) -> Result<(), Fault> {
        match self.words.last() {
            Some(word) => Err(self.fault(format!("`{word}` is more than the element has"))),
            None => Ok(()),
        }
    }

    /// Nothing is left of the file. What follows a binary body is let be.
    pub(super) fn end(&mut self) -> Result<(), Fault> {
        while self.encoding == Encoding::Ascii {
            match self.next_line() {
                None => break,
                Some(line) if line.is_empty() => {}
                Some(_) => return Err(self.fault("a line after the last element")),
            }
        }
        Ok(())
    }

    /// The length of a list.
    pub(super) fn length(&mut self, kind: Kind) -> Result<usize, Fault> {
        let value = self.scalar(kind)?;
        // Nothing is set aside for it: a false length runs into the end of the file.
        if value >= 0.0 { Ok(value as usize) } else { Err(self.fault(format!("a list of {value}"))) }
    }

    /// The next number.
    pub(super) fn scalar(&mut self, kind: Kind) -> Result<f64, Fault> {
        if self.encoding == Encoding::Ascii {
            let Some(word) = self.words.pop() else {
                return Err(self.fault("the line has fewer numbers than the element"));
            };
            let value: f64 = word.parse().map_err(|_| self.fault(format!("`{word}` is no number")))?;
            let whole = matches!(kind, Kind::F32 | Kind::F64) || value.fract() == 0.0;
            return if whole { Ok(value) } else { Err(self.fault(format!("`{word}` is no integer"))) };
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

    /// The next bytes, the least significant first.
    fn take<const N: usize>(&mut self) -> Result<[u8; N], Fault> {
        let found = self.bytes.get(self.at..).and_then(|rest| rest.first_chunk::<N>());
        let Some(mut bytes) = found.copied() else {
            return Err(self.fault("the file ends before its last element"));
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
