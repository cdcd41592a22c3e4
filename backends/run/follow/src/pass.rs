//! The passes of a manifest: what they draw, what they declare, and their fixed functions.

use std::collections::BTreeMap;

use serde::Deserialize;

/// A pass.
#[derive(Clone, Deserialize)]
pub struct Pass {
    /// Its name, by which files belong to it.
    #[serde(rename = "pass")]
    pub name: String,
    /// What it draws or dispatches.
    pub kind: Kind,
    /// Formulas for the workgroups along x, y and z.
    #[serde(default)]
    pub groups: Vec<String>,
    /// How it accesses each resource.
    pub uses: BTreeMap<String, String>,
    bindings: Vec<Binding>,
    /// The bindings of targets whose text declares something else.
    #[serde(default)]
    bindings_of: BTreeMap<String, Vec<Binding>>,
    /// Its fixed functions.
    pub state: State,
    /// The objects that it draws.
    #[serde(default)]
    pub objects: Objects,
}

/// A block, buffer or texture that the text of a pass declares.
#[derive(Clone, Deserialize)]
pub struct Binding {
    /// The name of the block or resource.
    pub name: String,
    /// The descriptor set in Vulkan.
    pub group: u32,
    /// Its number in the set.
    pub binding: u32,
    /// The binding point or texture unit in OpenGL.
    pub opengl_binding: u32,
    /// The stages that declare it.
    pub stages: Vec<String>,
    /// What it is.
    #[serde(rename = "type")]
    pub kind: BindingKind,
    /// Of a texture: `all`, `depth-only` or `stencil-only`.
    pub aspect: Option<String>,
    /// Of a texture: its sample type, as WebGPU names it.
    pub sample_type: Option<String>,
    /// Of a texture: whether it has several samples per pixel.
    #[serde(default)]
    pub multisampled: bool,
}

/// What a binding is.
#[derive(Clone, Copy, Deserialize, PartialEq)]
#[serde(rename_all = "kebab-case")]
pub enum BindingKind {
    /// A uniform block.
    Uniform,
    /// A buffer.
    Storage,
    /// A buffer that the pass only reads.
    ReadOnlyStorage,
    /// A texture, read texel by texel.
    Texture,
}

/// What a pass draws or dispatches.
#[derive(Clone, Copy, Deserialize, PartialEq)]
#[serde(rename_all = "snake_case")]
pub enum Kind {
    /// The scene.
    Geometry,
    /// A triangle that covers the frame, without vertices.
    Fullscreen,
    /// Workgroups.
    Compute,
}

/// The objects of the scene that a geometry pass draws.
#[derive(Clone, Default, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Objects {
    /// All.
    #[default]
    All,
    /// The box of each object, with an occlusion query.
    Boxes,
    /// Those for which no query of a pass counted zero samples in this frame.
    VisibleIn(String),
}

/// The fixed functions of a pass. What is `None` is off.
#[derive(Clone, Deserialize)]
pub struct State {
    /// The depth test.
    pub depth: Option<Depth>,
    /// The stencil test.
    pub stencil: Option<Stencil>,
    /// The colour targets, in the order of their locations.
    pub targets: Vec<Target>,
    /// `None`: one sample per pixel.
    pub samples: Option<Samples>,
}

/// A depth test.
#[derive(Clone, Deserialize)]
pub struct Depth {
    /// The attachment.
    pub resource: String,
    /// New against stored depth.
    pub compare: String,
    /// `false`: the attachment is read-only.
    pub write: bool,
}

/// A stencil test.
#[derive(Clone, Deserialize)]
pub struct Stencil {
    /// The attachment.
    pub resource: String,
    /// `reference` against stored stencil.
    pub compare: String,
    /// The operation if the test fails.
    pub fail: String,
    /// The operation if both tests pass.
    pub pass: String,
    /// A formula.
    pub reference: String,
}

/// A colour target.
#[derive(Clone, Deserialize)]
pub struct Target {
    /// The attachment.
    pub resource: String,
    /// `None`: off.
    pub blend: Option<Blend>,
}

/// A blend function, for colour and alpha alike.
#[derive(Clone, Deserialize, PartialEq)]
pub struct Blend {
    /// The factor of the fragment.
    pub source: String,
    /// The factor of the target.
    pub destination: String,
    /// What combines them.
    pub operation: String,
}

/// The samples of a pass.
#[derive(Clone, Deserialize)]
pub struct Samples {
    /// A formula for the samples per pixel.
    pub count: String,
    /// A formula for the samples that are written.
    pub mask: String,
}

impl Pass {
    /// What the text of a target declares.
    pub fn bindings(&self, target: &str) -> &[Binding] {
        self.bindings_of.get(target).unwrap_or(&self.bindings)
    }

    /// What the text of every target declares.
    pub(crate) fn binding_lists(&self) -> impl Iterator<Item = &[Binding]> {
        std::iter::once(&self.bindings).chain(self.bindings_of.values()).map(Vec::as_slice)
    }
}
