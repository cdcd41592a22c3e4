//! Reads files, with gzip decompression.

use std::io::Read as _;
use std::path::Path;

use crate::error::{Error, FileError};

/// Returns the bytes of a file, decompressed.
pub(crate) fn read(path: &Path) -> Result<Vec<u8>, Error> {
    let file = path.display().to_string();
    let bytes =
        std::fs::read(path).map_err(|error| Error::Unreadable { file: file.clone(), reason: error.to_string() })?;
    if !bytes.starts_with(&[0x1f, 0x8b]) {
        return Ok(bytes);
    }
    let mut plain = Vec::new();
    flate2::read::MultiGzDecoder::new(bytes.as_slice())
        .read_to_end(&mut plain)
        .map_err(|error| FileError::whole(format!("invalid gzip data: {error}")).in_file(&file))?;
    Ok(plain)
}
