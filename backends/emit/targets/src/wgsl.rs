//! Emits WGSL: the linked source as it is, with the comments of its templates.

use crate::emission::{Emission, File};

pub(crate) fn emit(emission: &Emission<'_>) -> Result<Vec<File>, String> {
    Ok(vec![emission.whole(".wgsl", emission.checked.pass().text.clone().into_bytes())])
}
