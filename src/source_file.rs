//! Reads source files: descriptions, user files and WGSL files.
//!
//! Input: a path or a stream. Output: the text. A source is a regular file of at most [`MAX_BYTES`] bytes of UTF-8; anything else is an
//! error. A device or a pipe may have no end, so a path to one is not opened.

use std::fmt;
use std::fs::File;
use std::io::{Error, ErrorKind, Read, Result};
use std::path::Path;

use fragbuf_model::{Diagnostic, SourceSpan, codes};

/// The greatest size of a source file in bytes: 4 MiB.
pub const MAX_BYTES: u64 = 4 << 20;

/// The reason why a file is not text: the first bytes that are not UTF-8. [`read`] returns it inside of its error.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NotUtf8 {
    /// The line, from 1.
    pub line: u32,
    /// The column, from 1, in characters.
    pub column: u32,
    /// The byte.
    pub byte: u8,
    /// The text, with a replacement character for all that is not UTF-8.
    pub lossy: String,
}

impl NotUtf8 {
    fn of(bytes: &[u8], valid: usize) -> Self {
        let before = String::from_utf8_lossy(bytes.get(..valid).unwrap_or_default());
        let line_start = before.rfind('\n').map_or(0, |at| at + 1);
        NotUtf8 {
            line: 1 + before.matches('\n').count() as u32,
            column: 1 + before.get(line_start..).unwrap_or_default().chars().count() as u32,
            byte: bytes.get(valid).copied().unwrap_or_default(),
            lossy: String::from_utf8_lossy(bytes).into_owned(),
        }
    }

    /// Returns it from an error of [`read`].
    pub fn from_error(error: &Error) -> Option<&NotUtf8> {
        error.get_ref()?.downcast_ref()
    }

    /// Returns the diagnostic; messages call the file `file`.
    pub fn diagnostic(&self, file: &str) -> Diagnostic {
        let help = "save the file as UTF-8; editors and `iconv` convert from other encodings, such as Latin-1";
        let span = SourceSpan::new(file, self.line, self.column);
        Diagnostic::new(codes::INVALID_ENCODING, &span, format!("the byte 0x{:02x} is not UTF-8", self.byte), help)
    }
}

impl fmt::Display for NotUtf8 {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "the file is not UTF-8: byte 0x{:02x} at line {}, column {}", self.byte, self.line, self.column)
    }
}

impl std::error::Error for NotUtf8 {}

/// Reads a source file.
pub fn read(path: &Path) -> Result<String> {
    let invalid = |message: String| Error::new(ErrorKind::InvalidInput, message);
    // Before the file is opened: opening a pipe waits for its other end.
    let metadata = std::fs::metadata(path)?;
    if !metadata.is_file() {
        let kind = if metadata.is_dir() { "a folder" } else { "a device, a pipe or a socket" };
        return Err(invalid(format!("{kind} is not a source: give a regular file")));
    }
    read_text(File::open(path)?, metadata.len())
}

/// Reads a source from a stream to its end.
pub fn read_stream(stream: impl Read) -> Result<String> {
    read_text(stream, 0)
}

/// Reads a source of at least `length` bytes.
fn read_text(stream: impl Read, length: u64) -> Result<String> {
    let mut bytes = Vec::new();
    // A file may grow after its size is read.
    stream.take(MAX_BYTES + 1).read_to_end(&mut bytes)?;
    let length = length.max(bytes.len() as u64);
    if length > MAX_BYTES {
        let message = format!("a source of {length} bytes or more: it can have {MAX_BYTES}");
        return Err(Error::new(ErrorKind::InvalidInput, message));
    }
    String::from_utf8(bytes).map_err(|error| {
        let valid = error.utf8_error().valid_up_to();
        Error::new(ErrorKind::InvalidData, NotUtf8::of(error.as_bytes(), valid))
    })
}
