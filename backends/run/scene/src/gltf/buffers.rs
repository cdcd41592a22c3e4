//! The bytes of a model's buffers: from the GLB, a data URI, or a file in the folder of the model.

use std::path::Path;

use base64::Engine as _;
use base64::engine::{DecodePaddingMode, GeneralPurpose, GeneralPurposeConfig};
use gltf::Gltf;

use super::locate::Text;
use crate::error::{Error, FileError};
use crate::file;
use crate::limits::Budget;
use crate::text::quoted;

/// Returns the bytes of every buffer. `blob` is the binary chunk of a GLB, which is the first buffer.
pub(super) fn read(
    model: &Gltf,
    mut blob: Option<Vec<u8>>,
    (path, text): (&Path, Text<'_>),
    budget: &Budget,
) -> Result<Vec<Vec<u8>>, Error> {
    let file = path.display().to_string();
    let folder = path.parent().unwrap_or(Path::new(""));
    let mut buffers = Vec::new();
    for buffer in model.buffers() {
        let index = buffer.index();
        let located = |error: FileError| text.located(error.in_element("buffers", index)).in_file(&file);
        let error_at = |message: String| located(FileError::whole(format!("buffer {index}: {message}")));
        let bytes = match buffer.source() {
            gltf::buffer::Source::Bin => match blob.take() {
                Some(blob) => blob,
                None if index == 0 => return Err(error_at("the file has no binary chunk".to_owned())),
                None => return Err(error_at("it has no URI; only buffer 0 is the binary chunk".to_owned())),
            },
            gltf::buffer::Source::Uri(uri) => match uri.strip_prefix("data:") {
                Some(data) => {
                    // Decoded data is not longer than its text.
                    let length = data.len() as u64;
                    budget.take(length, 1, &format!("buffer {index}")).map_err(|error| error.in_file(&file))?;
                    data_of(data).map_err(error_at)?
                }
                None if uri.contains("://") => {
                    let message =
                        format!("{} is not downloaded: save it beside the model, and name that file", quoted(uri));
                    return Err(error_at(message));
                }
                None if !budget.reads_named_files() => {
                    let message = format!(
                        "files that the model names are not read: {}: convert the model to GLB, which holds its buffers",
                        quoted(uri)
                    );
                    return Err(error_at(message));
                }
                None => {
                    let name = String::from_utf8(percent_decoded(uri));
                    let name = name.map_err(|_| error_at("its URI is not UTF-8 after decoding".to_owned()))?;
                    file::read(&file::beside(folder, &name).map_err(located)?, budget).map_err(|error| match error {
                        Error::Unreadable { file: name, reason } => Error::Unreadable {
                            file: name,
                            reason: format!("{reason}: it is buffer {index} of {file}"),
                        },
                        other => other,
                    })?
                }
            },
        };
        if bytes.len() < buffer.length() {
            return Err(error_at(format!("it has {} bytes, but declares {}", bytes.len(), buffer.length())));
        }
        buffers.push(bytes);
    }
    Ok(buffers)
}

/// Base64 with or without its padding.
const BASE64: GeneralPurpose = GeneralPurpose::new(
    &base64::alphabet::STANDARD,
    GeneralPurposeConfig::new().with_decode_padding_mode(DecodePaddingMode::Indifferent),
);

/// Returns the bytes of a data URI without its scheme: `[TYPE][;base64],DATA`.
fn data_of(data: &str) -> Result<Vec<u8>, String> {
    let (kind, text) = data.split_once(',').ok_or("its data URI has no comma")?;
    if kind.ends_with(";base64") {
        return BASE64.decode(text).map_err(|error| format!("its data is invalid: {error}"));
    }
    Ok(percent_decoded(text))
}

/// Replaces `%` and two hexadecimal digits by the byte. A `%` without them stays.
fn percent_decoded(text: &str) -> Vec<u8> {
    let mut bytes = Vec::with_capacity(text.len());
    let mut rest = text.as_bytes();
    while let Some((byte, after)) = rest.split_first() {
        let digits = after.first_chunk::<2>().filter(|_| *byte == b'%');
        let digit = |digit: u8| char::from(digit).to_digit(16);
        match digits.and_then(|[high, low]| Some(16 * digit(*high)? + digit(*low)?)) {
            Some(decoded) => {
                bytes.push(decoded as u8);
                rest = after.get(2..).unwrap_or_default();
            }
            None => {
                bytes.push(*byte);
                rest = after;
            }
        }
    }
    bytes
}
