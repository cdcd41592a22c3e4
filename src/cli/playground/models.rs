//! The models that pages send: kept in memory, and written to a folder while a request reads them.
//!
//! Input: the bytes of a file with its name. Output: the name of a scene for later requests, `model:HASH`, which is the same for the same
//! file. A file that the model names is never read. The newest models are kept, within a budget of memory.

use std::collections::VecDeque;
use std::hash::{DefaultHasher, Hash as _, Hasher as _};
use std::path::Path;
use std::sync::{Arc, Mutex, PoisonError};

use axum::body::Bytes;
use fragbuf_scene::{Limits, load};
use serde_json::{Value, json};
use tempfile::TempDir;

use super::problem::Problem;
use super::scene::{COLOR, MEMORY};
use crate::cli::memory::budget;

/// The bytes of a model.
pub(super) const MOST_BYTES: usize = 64 << 20;

/// The bytes of all models that are kept.
const MOST_KEPT: usize = 256 << 20;

/// The letters of the name of a model.
const MOST_LETTERS: usize = 80;

/// What the name of a scene begins with if it is a model.
const PREFIX: &str = "model:";

/// The models of this server, the newest last.
#[derive(Default)]
pub(super) struct Models(Mutex<VecDeque<Model>>);

#[derive(Clone)]
struct Model {
    /// The name of the scene.
    scene: String,
    /// The name of the file, without a folder.
    file: String,
    bytes: Bytes,
    /// The model as the page lists it.
    row: Value,
}

/// A model in a folder of its own, which is deleted with this value.
pub(super) struct ModelFile {
    folder: TempDir,
    file: String,
}

impl ModelFile {
    pub(super) fn path(&self) -> String {
        self.folder.path().join(&self.file).display().to_string()
    }

    /// Returns a message with the name of the file in place of its path.
    pub(super) fn shortened(&self, message: &str) -> String {
        message.replace(&self.path(), &self.file)
    }

    /// Returns messages in JSON with the name of the file in place of its path, which may have characters that JSON escapes.
    pub(super) fn shortened_in_json(&self, messages: &str) -> String {
        let escaped = Value::from(self.path()).to_string();
        messages.replace(escaped.trim_matches('"'), &self.file)
    }
}

impl Models {
    /// Keeps a model without errors. Returns the row of its scene, with what was not read as written.
    pub(super) fn add(&self, name: &str, bytes: Bytes) -> Result<Value, Problem> {
        let file = file_name(name);
        let mut hasher = DefaultHasher::new();
        (&file, &bytes).hash(&mut hasher);
        let mut model = Model { scene: format!("{PREFIX}{:016x}", hasher.finish()), file, bytes, row: Value::Null };
        model.row = model.read()?;
        let row = model.row.clone();
        self.keep(model);
        Ok(row)
    }

    /// Returns the models that are kept, as the page lists them.
    pub(super) fn list(&self) -> Vec<Value> {
        let models = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        models.iter().map(|model| model.row.clone()).collect()
    }

    /// Returns the file of a scene; none if the name is not that of a model.
    pub(super) fn file(&self, scene: &str) -> Result<Option<ModelFile>, Problem> {
        if !scene.starts_with(PREFIX) {
            return Ok(None);
        }
        let models = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let model = models.iter().find(|model| model.scene == scene).cloned();
        // The file is written without the lock.
        drop(models);
        let model = model.ok_or_else(|| {
            Problem::input(format!("the server no longer has the model `{scene}`: open the file again"))
        })?;
        model.written().map(Some)
    }

    fn keep(&self, model: Model) {
        let mut models = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        models.retain(|kept| kept.scene != model.scene);
        models.push_back(model);
        while models.iter().map(|model| model.bytes.len()).sum::<usize>() > MOST_KEPT {
            models.pop_front();
        }
    }
}

impl Model {
    fn written(&self) -> Result<ModelFile, Problem> {
        let failed = |error: std::io::Error| Problem::server(format!("a folder for the model: {error}"));
        let folder = tempfile::tempdir().map_err(failed)?;
        std::fs::write(folder.path().join(&self.file), &self.bytes).map_err(failed)?;
        Ok(ModelFile { folder, file: self.file.clone() })
    }

    /// Reads the model, and returns its row.
    fn read(&self) -> Result<Value, Problem> {
        let memory = budget(MEMORY).map_err(Problem::server)?;
        let limits = Limits { memory: memory.left(), reads_named_files: false };
        let file = self.written()?;
        let scene = load(Path::new(&file.path()), COLOR, &limits);
        let scene = scene.map_err(|error| Problem::input(file.shortened(&error.to_string())))?;
        let warnings = scene.warnings.iter().map(|warning| file.shortened(&warning.to_string()));
        Ok(json!({
            "scene": self.scene,
            "name": self.file,
            "triangles": scene.triangles(),
            "warnings": warnings.collect::<Vec<_>>(),
        }))
    }
}

/// Returns the name of a file that any system can have: the end of the name, because its extension is the format.
fn file_name(name: &str) -> String {
    let last = name.rsplit(['/', '\\']).next().unwrap_or_default();
    let is_plain = |letter: char| letter.is_ascii_alphanumeric() || matches!(letter, '.' | '-' | '_');
    let letters: Vec<char> = last.chars().map(|letter| if is_plain(letter) { letter } else { '_' }).collect();
    let end: String = letters.iter().skip(letters.len().saturating_sub(MOST_LETTERS)).collect();
    // A name of dots alone would be a folder, and one that begins with a dot would have no extension.
    format!("{}{end}", if end.starts_with('.') || end.is_empty() { "model" } else { "" })
}

/// The models as they are shared between requests.
pub(super) type SharedModels = Arc<Models>;

#[cfg(test)]
mod tests {
    use super::file_name;

    #[test]
    fn names_of_files_stay_in_their_folder() {
        for (name, expected) in [
            ("bunny.obj", "bunny.obj"),
            ("../../etc/bunny.obj", "bunny.obj"),
            ("C:\\models\\bunny one.PLY.gz", "bunny_one.PLY.gz"),
            ("..", "model.."),
            (".obj", "model.obj"),
            ("", "model"),
            ("a\0b\n.obj", "a_b_.obj"),
            ("höhle.glb", "h_hle.glb"),
        ] {
            assert_eq!(file_name(name), expected);
        }
        let long = format!("{}.gltf", "a".repeat(1000));
        assert!(file_name(&long).len() == super::MOST_LETTERS && file_name(&long).ends_with("a.gltf"));
    }
}
