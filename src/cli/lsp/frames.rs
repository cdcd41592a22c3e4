//! Messages as bytes: a header with the length, an empty line, and the text.
//!
//! Input and output: a stream. A header or a text that is longer than the limits is an error before memory is allocated for it.

use std::fmt;
use std::io::{BufRead, Error, Read, Result as IoResult, Write};

use serde_json::Value;

/// The greatest length of a message in bytes: a source of 4 MiB, in which every byte is escaped.
pub(super) const MAX_BYTES: u64 = 32 << 20;

/// The greatest length of a header line in bytes, and the greatest number of lines.
const MAX_LINE: u64 = 1024;
const MAX_LINES: usize = 16;

/// The text of a message.
pub(super) type Frame = Vec<u8>;

/// The reason why the next message cannot be found.
#[derive(Debug)]
pub(super) enum FrameError {
    /// A line of a header is none, or too long.
    Header(String),
    /// No line of the header has the length.
    NoLength,
    /// The message is too long.
    TooLong(u64),
    Io(Error),
}

impl fmt::Display for FrameError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            FrameError::Header(line) => write!(f, "`{line}` is not a header: expected `Content-Length: 42`"),
            FrameError::NoLength => write!(f, "the header has no line `Content-Length: 42`"),
            FrameError::TooLong(length) => write!(f, "a message of {length} bytes: it can have {MAX_BYTES}"),
            FrameError::Io(error) => write!(f, "{error}"),
        }
    }
}

impl From<Error> for FrameError {
    fn from(error: Error) -> Self {
        FrameError::Io(error)
    }
}

/// Reads a message. `None`: the input has ended, perhaps within a message.
pub(super) fn read(input: &mut dyn BufRead) -> Result<Option<Frame>, FrameError> {
    let mut length = None;
    for _ in 0..MAX_LINES {
        let mut line = Vec::new();
        Read::take(&mut *input, MAX_LINE).read_until(b'\n', &mut line)?;
        if line.is_empty() {
            return Ok(None);
        }
        let text = String::from_utf8_lossy(&line);
        let text = text.trim_end();
        if text.is_empty() {
            return match length {
                Some(length) => read_text(input, length),
                None => Err(FrameError::NoLength),
            };
        }
        let error = || FrameError::Header(text.chars().take(80).collect());
        let (name, value) = text.split_once(':').ok_or_else(error)?;
        if name.eq_ignore_ascii_case("Content-Length") {
            length = Some(value.trim().parse::<u64>().map_err(|_| error())?);
        }
    }
    Err(FrameError::NoLength)
}

fn read_text(input: &mut dyn BufRead, length: u64) -> Result<Option<Frame>, FrameError> {
    if length > MAX_BYTES {
        return Err(FrameError::TooLong(length));
    }
    let mut text = Vec::new();
    input.take(length).read_to_end(&mut text)?;
    Ok((text.len() as u64 == length).then_some(text))
}

/// Writes a message.
pub(super) fn write(output: &mut dyn Write, message: &Value) -> IoResult<()> {
    let text = message.to_string();
    write!(output, "Content-Length: {}\r\n\r\n{text}", text.len())?;
    output.flush()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(mut bytes: &[u8]) -> String {
        match read(&mut bytes) {
            Ok(Some(frame)) => String::from_utf8_lossy(&frame).into_owned(),
            Ok(None) => "end".to_owned(),
            Err(error) => error.to_string(),
        }
    }

    #[test]
    fn a_header_has_the_length() {
        assert_eq!(found(b"Content-Length: 2\r\n\r\n{}x"), "{}");
        assert_eq!(found(b"content-type: x\ncontent-length:3\n\nabc"), "abc");
        assert_eq!(found(b""), "end");
        assert_eq!(found(b"Content-Length: 3\r\n\r\n{}"), "end");
        assert!(found(b"Content-Length: 18446744073709551615\r\n\r\n{}").starts_with("a message of 184467"));
        assert!(found(b"Content-Length: -1\r\n\r\n{}").contains("is not a header"));
        assert!(found(b"GET / HTTP/1.1\r\n\r\n").contains("is not a header"));
        assert!(found(b"\r\n").contains("no line `Content-Length"));
        assert!(found(&[b'a'; 5000]).contains("is not a header"));
    }
}
