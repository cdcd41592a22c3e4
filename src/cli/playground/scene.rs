//! The scene of a request: a generated one, or a model that a page sent.

use fragbuf_scene::{AttributeRequest, Limits, Scene};

use super::models::{ModelFile, Models};
use super::problem::Problem;
use crate::cli::view;

/// The memory of a scene with its vertices, and of a picture with its scene.
pub(super) const MEMORY: &str = "512MiB";

/// Colour of parts for which a scene gives none, as for `render`.
pub(super) const COLOR: [f32; 4] = [0.15, 0.45, 0.35, 0.4];

/// A scene that exists.
pub(super) enum RequestedScene {
    /// `builtin:NAME` with its parameters.
    Generated(String),
    Model(ModelFile),
}

impl RequestedScene {
    /// Finds a scene by its name in a request: `NAME[,parameter=value]`, or `model:HASH`. Other files are not read.
    pub(super) fn find(name: &str, models: &Models) -> Result<Self, Problem> {
        if let Some(file) = models.file(name)? {
            return Ok(RequestedScene::Model(file));
        }
        let name = format!("builtin:{name}");
        view::check(&name).map_err(|failure| Problem::request(failure.message()))?;
        Ok(RequestedScene::Generated(name))
    }

    /// Returns the value of `--scene`.
    pub(super) fn argument(&self) -> String {
        match self {
            RequestedScene::Generated(name) => name.clone(),
            RequestedScene::Model(file) => file.path(),
        }
    }

    /// Generates or reads the scene with these attributes.
    pub(super) fn open(&self, attributes: &[AttributeRequest], memory: u64) -> Result<Scene, Problem> {
        let limits = Limits { memory, reads_named_files: false };
        let scene = fragbuf_scene::open_with(&self.argument(), COLOR, attributes, &limits);
        scene.map_err(|error| Problem::input(self.shortened(&error.to_string())))
    }

    /// Returns messages in JSON with the name of a model in place of its path.
    pub(super) fn shortened_in_json(&self, messages: &str) -> String {
        match self {
            RequestedScene::Generated(_) => messages.to_owned(),
            RequestedScene::Model(file) => file.shortened_in_json(messages),
        }
    }

    /// Returns a message with the name of a model in place of its path, which is of this machine.
    fn shortened(&self, message: &str) -> String {
        match self {
            RequestedScene::Generated(_) => message.to_owned(),
            RequestedScene::Model(file) => file.shortened(message),
        }
    }
}
