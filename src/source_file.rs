//! Reads source files: descriptions, user files and WGSL files.
//!
//! Input: a path. Output: the text. A source is a regular file of at most [`MAX_BYTES`] bytes of UTF-8; anything else is an error.
//! A device or a pipe may have no end, so it is not opened.

use std::fs::File;
use std::io::{Error, ErrorKind, Read as _, Result};
use std::path::Path;

/// The greatest size of a source file in bytes: 4 MiB.
pub const MAX_BYTES: u64 = 4 << 20;

/// Reads a source file.
pub fn read(path: &Path) -> Result<String> {
    let invalid = |message: String| Error::new(ErrorKind::InvalidInput, message);
    // Before the file is opened: opening a pipe waits for its other end.
    let metadata = std::fs::metadata(path)?;
    if !metadata.is_file() {
        let kind = if metadata.is_dir() { "a folder" } else { "a device, a pipe or a socket" };
        return Err(invalid(format!("{kind} is not a source: give a regular file")));
    }
    let mut text = String::new();
    // A file may grow after its size is read.
    let read = File::open(path)?.take(MAX_BYTES + 1).read_to_string(&mut text);
    let length = metadata.len().max(text.len() as u64);
    if length > MAX_BYTES {
        return Err(invalid(format!("a source of {length} bytes or more: it can have {MAX_BYTES}")));
    }
    match read {
        Ok(_) => Ok(text),
        Err(error) if error.kind() == ErrorKind::InvalidData => Err(Error::new(error.kind(), "the file is not UTF-8")),
        Err(error) => Err(error),
    }
}
