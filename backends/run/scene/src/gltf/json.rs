//! The memory that the JSON of a model needs once it is parsed.
//!
//! A parsed value is many times larger than its text: three bytes, `{},`, become a node of some hundred bytes. So the values are
//! counted before they are parsed.

use super::locate::{GLB_HEADER, Text};
use crate::error::{FileError, FilePosition};
use crate::limits::Budget;
use crate::text::foreign_message;

/// The bytes of a JSON object once it is parsed, at most: the largest structs of the format, in a list that has doubled.
const OBJECT: u64 = 1024;

/// The bytes of a list, of a member of one, or of a member of an object.
const VALUE: u64 = 64;

/// Takes the memory of the parsed model: of its JSON, and of the copy of a GLB's binary chunk.
pub(super) fn take(bytes: &[u8], budget: &Budget) -> Result<(), FileError> {
    let Some(rest) = bytes.strip_prefix(b"glTF") else {
        return budget.take(cost(bytes), 1, "the parsed JSON");
    };
    let at = |byte: usize, message: String| FileError::Malformed(FilePosition::Byte(byte), message);
    // The version, the length of the file, the length of the JSON, and its type.
    let word = |at: usize| rest.get(at..)?.first_chunk().map(|word| u32::from_le_bytes(*word));
    if let Some(version) = word(0).filter(|version| *version != 2) {
        return Err(at(4, format!("GLB version {version}: version 2 is read")));
    }
    let (Some(length), Some(_)) = (word(4), word(8)) else {
        return Err(at(bytes.len(), format!("the header is incomplete: {} of {GLB_HEADER} bytes", bytes.len())));
    };
    if (length as usize) < GLB_HEADER || length as usize > bytes.len() {
        return Err(at(8, format!("the header declares {length} bytes, and the file has {}", bytes.len())));
    }
    let json = Text::of(bytes).json();
    budget.take(cost(json), 1, "the parsed JSON")?;
    budget.take((bytes.len() - json.len()) as u64, 1, "the binary chunk")
}

/// Returns the error about JSON that is not a model. The line is the position, so the message has the column alone.
pub(super) fn invalid(error: &gltf::json::Error) -> FileError {
    let message = foreign_message(error);
    let place = format!(" at line {} column {}", error.line(), error.column());
    let message = message.strip_suffix(&place).unwrap_or(&message);
    let what = if error.is_data() { "not a model of glTF 2" } else { "invalid JSON" };
    FileError::line(error.line().max(1), format!("column {}: {what}: {message}", error.column()))
}

/// Returns an upper bound on the memory of parsed JSON.
fn cost(json: &[u8]) -> u64 {
    let (mut bytes, mut is_string, mut is_escaped) = (json.len() as u64, false, false);
    for byte in json {
        match byte {
            _ if is_escaped => is_escaped = false,
            b'\\' if is_string => is_escaped = true,
            b'"' => is_string = !is_string,
            _ if is_string => {}
            b'{' => bytes += OBJECT,
            b'[' | b',' | b':' => bytes += VALUE,
            _ => {}
        }
    }
    bytes
}
