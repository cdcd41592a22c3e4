//! The bytes of a model's buffers: from the GLB, a data URI, or a file in the folder of the model.

use std::path::Path;

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use gltf::Gltf;

use crate::error::{Error, FileError};
use crate::file;
use crate::limits::Budget;

/// Returns the bytes of every buffer. `blob` is the binary chunk of a GLB, which is the first buffer.
pub(super) fn read(
    model: &Gltf,
    mut blob: Option<Vec<u8>>,
    path: &Path,
    budget: &Budget,
) -> Result<Vec<Vec<u8>>, Error> {
    let file = path.display().to_string();
    let folder = path.parent().unwrap_or(Path::new(""));
    let mut buffers = Vec::new();
    for buffer in model.buffers() {
        let index = buffer.index();
        let error_at = |message: String| FileError::whole(format!("buffer {index}: {message}")).in_file(&file);
        let bytes = match buffer.source() {
            gltf::buffer::Source::Bin => match blob.take() {
                Some(blob) => blob,
                None if index == 0 => return Err(error_at("the file has no binary chunk".to_owned())),
                None => return Err(error_at("it has no URI; only buffer 0 is the binary chunk".to_owned())),
            },
            gltf::buffer::Source::Uri(uri) => match uri.strip_prefix("data:") {
                Some(data) => {
                    let (_, text) =
                        data.split_once(";base64,").ok_or_else(|| error_at("its data is not base64".to_owned()))?;
                    let length = base64::decoded_len_estimate(text.len()) as u64;
                    budget.take(length, 1, &format!("buffer {index}")).map_err(|error| error.in_file(&file))?;
                    STANDARD.decode(text).map_err(|error| error_at(format!("its data is invalid: {error}")))?
                }
                None => file::read(&folder.join(uri.replace("%20", " ")), budget)?,
            },
        };
        if bytes.len() < buffer.length() {
            return Err(error_at(format!("it has {} bytes, but declares {}", bytes.len(), buffer.length())));
        }
        buffers.push(bytes);
    }
    Ok(buffers)
}
