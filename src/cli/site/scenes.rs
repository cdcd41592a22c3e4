//! The scenes of the player.
//!
//! Input: the variants. Output: a list of generated scenes with their default parameters, and a file of triangles per scene and layout of
//! vertices, in the form of the playground's `/api/geometry`. No model of a user is read.

use std::collections::BTreeMap;

use fragbuf_scene::BUILTIN_SCENES;
use serde_json::{Value, json};

use super::{Entry, Files};
use crate::cli::output::Failure;
use crate::cli::playground::triangles;

/// Scenes of at most 4 MB; the others have more than 10. The first is shown first.
const SCENES: [&str; 5] = ["marbles", "cubes", "slabs", "layers", "slivers"];

/// The scenes, each with its files by layout.
pub(super) struct Scenes(pub(super) Vec<Value>);

impl Scenes {
    /// Generates the scenes for every layout of the variants.
    pub(super) fn of(entries: &[Entry], files: &mut Files) -> Result<Self, Failure> {
        let mut texts: BTreeMap<&str, &str> = BTreeMap::new();
        for variant in entries.iter().filter_map(|entry| entry.player["variants"].as_array()).flatten() {
            if let (Some(layout), Some(text)) = (variant["layout"].as_str(), variant["text"].as_str()) {
                texts.entry(layout).or_insert(text);
            }
        }
        let mut scenes = Vec::new();
        for name in SCENES {
            let mut paths = serde_json::Map::new();
            for (layout, text) in &texts {
                let path = files.add_content("scenes", "bin", triangles(text, name).map_err(Failure::Input)?);
                paths.insert((*layout).to_owned(), path.into());
            }
            let summary = BUILTIN_SCENES.iter().find(|scene| scene.name == name).map(|scene| scene.summary);
            // The values of a scene's parameters are their defaults: the player changes none.
            scenes.push(json!({ "name": name, "summary": summary, "parameters": [], "triangles": paths }));
        }
        Ok(Scenes(scenes))
    }
}
