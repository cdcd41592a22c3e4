//! Reads files within the limits of a scene, with gzip decompression.
//!
//! Input: a path. Output: its bytes after decompression, taken from the budget. A device, a pipe or a folder is an error, because
//! it may have no end. A file that grows while it is read, or whose compressed data has no end, is read up to the limit.

use std::fs::{File, Metadata};
use std::io::{BufRead as _, BufReader, Read};
use std::path::{Path, PathBuf};

use crate::error::{Error, FileError};
use crate::limits::Budget;
use crate::text::quoted;

/// The greatest length of the name of a file in a model, in bytes.
const MAX_NAME: usize = 4096;

/// Returns the bytes of a file, decompressed.
pub(crate) fn read(path: &Path, budget: &Budget) -> Result<Vec<u8>, Error> {
    let file = path.display().to_string();
    let unreadable = |reason: String| Error::Unreadable { file: file.clone(), reason };
    let failed = |error: std::io::Error| unreadable(error.to_string());
    // Before the file is opened: opening a pipe waits for its other end.
    let metadata = std::fs::metadata(path).map_err(failed)?;
    if let Some(kind) = irregular(&metadata) {
        return Err(unreadable(format!("{kind} is not a model: give a regular file")));
    }
    budget.open(path);
    let opened = File::open(path).map_err(failed)?;
    let length = opened.metadata().map_err(failed)?.len();
    let mut reader = BufReader::new(opened);
    let is_compressed = reader.fill_buf().map_err(failed)?.starts_with(&[0x1f, 0x8b]);
    if is_compressed {
        let decoder = flate2::read::MultiGzDecoder::new(reader);
        let bytes = bounded(decoder, budget, "the decompressed file").map_err(|error| match error {
            ReadError::Io(error) => FileError::whole(format!("invalid gzip data: {error}")),
            ReadError::TooLarge(error) => error,
        });
        return bytes.map_err(|error| error.in_file(&file));
    }
    if length > budget.left() {
        return Err(budget.exceeded(length, "the file").in_file(&file));
    }
    bounded(reader, budget, "the file").map_err(|error| match error {
        ReadError::Io(error) => failed(error),
        ReadError::TooLarge(error) => error.in_file(&file),
    })
}

/// Returns the path of a file that a model names, in the model's folder.
pub(crate) fn beside(folder: &Path, name: &str) -> Result<PathBuf, FileError> {
    if name.len() > MAX_NAME {
        let message = format!("the name of a file, {}, has {} bytes: it can have {MAX_NAME}", quoted(name), name.len());
        return Err(FileError::whole(message));
    }
    Ok(folder.join(name))
}

enum ReadError {
    Io(std::io::Error),
    TooLarge(FileError),
}

/// Reads to the end, at most as many bytes as the budget has left.
fn bounded(reader: impl Read, budget: &Budget, what: &str) -> Result<Vec<u8>, ReadError> {
    let (mut bytes, left) = (Vec::new(), budget.left());
    reader.take(left.saturating_add(1)).read_to_end(&mut bytes).map_err(ReadError::Io)?;
    budget.take(bytes.len() as u64, 1, what).map_err(ReadError::TooLarge)?;
    Ok(bytes)
}

/// Returns the kind of a file that is not a regular file.
fn irregular(metadata: &Metadata) -> Option<&'static str> {
    if metadata.is_file() {
        return None;
    }
    Some(if metadata.is_dir() { "a folder" } else { "a device, a pipe or a socket" })
}
