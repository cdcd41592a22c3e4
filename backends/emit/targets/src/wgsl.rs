//! WGSL is the linked text itself: what a person wrote, comments and all.

use crate::target::{Emission, File};

pub(crate) fn emit(emission: &Emission<'_>) -> Result<Vec<File>, String> {
    Ok(vec![emission.whole(".wgsl", emission.checked.pass().text.clone().into_bytes())])
}
