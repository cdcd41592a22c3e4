//! The external textures of a description, and what supplies each: the opaque scene its depth, `--importance` the importance of pixels.
//!
//! Input: a plan and a view. Output: the names of the textures by their source.

use fragbuf::vocabulary::Row;
use fragbuf::{Plan, Registry};

use super::opaque::OpaqueScene;
use crate::cli::output::Failure;
use crate::cli::view::View;

/// The names of the external textures that a plan reads.
#[derive(Default)]
pub(super) struct ExternalTextures {
    /// Depth buffers of opaque surfaces.
    pub(super) depths: Vec<String>,
    /// Importance of pixels.
    pub(super) importance: Vec<String>,
}

impl ExternalTextures {
    /// Returns the textures of a plan. `Err`: an option that supplies one of them is missing.
    pub(super) fn of(plan: &Plan, view: &View, opaque: Option<&OpaqueScene<'_>>) -> Result<Self, Failure> {
        let mut textures = ExternalTextures::default();
        for planned in plan.resources.iter().filter(|planned| planned.is_external() && !planned.is_of_description()) {
            let names = if planned.is_opaque_depth() { &mut textures.depths } else { &mut textures.importance };
            names.push(planned.resource.name.clone());
        }
        let missing = |name: &str, source: &str| Err(Failure::Usage(missing(plan, name, source)));
        match (textures.depths.first(), textures.importance.first()) {
            (Some(name), _) if opaque.is_none() => {
                missing(name, "which an opaque scene gives: add `--opaque SCENE`, as `--opaque builtin:cubes`")
            }
            (_, Some(name)) if view.importance.is_none() => {
                missing(name, "which an image gives: add `--importance PNG`")
            }
            _ => Ok(textures),
        }
    }
}

/// Returns the message about a texture without a source: the choice that reads it, and the value that reads none.
fn missing(plan: &Plan, texture: &str, source: &str) -> String {
    let reads = |row: &&Row| row.resources.iter().any(|resource| resource.name == texture);
    let row = plan.selection.rows.iter().map(|selected| &*selected.row).find(reads);
    let what = row.map_or("the description".to_owned(), |row| format!("`{}: {}`", row.axis, row.key));
    let default = row.and_then(|row| Registry::builtin().axis(&row.axis)?.default.map(|key| (row.axis.clone(), key)));
    let other = default.map_or(String::new(), |(axis, key)| format!(", or choose `--set {axis}={key}`"));
    format!("{what} reads the external texture `{texture}`, {source}{other}")
}
