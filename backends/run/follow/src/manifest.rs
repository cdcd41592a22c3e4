//! The part of `manifest.json` that a host needs, as types. The guide's chapter on the manifest defines every field.
//!
//! Input: the text of a manifest, a target. Output: the files and the plan of the target. What is malformed is an
//! error here, so that no reader of a plan meets a loop without an end, a name without a resource, or a number out of
//! its range.

use std::collections::BTreeMap;

use serde::Deserialize;

use crate::uniforms::CAMERA_BYTES;
use crate::{Error, check};

pub use crate::pass::{Binding, BindingKind, Blend, Depth, Kind, Objects, Pass, Samples, State, Stencil, Target};

/// The schema that hosts follow.
const SCHEMA: &str = "fragbuf-manifest/4";

/// A manifest.
#[derive(Clone, Deserialize)]
pub struct Manifest {
    prefix: String,
    files: Vec<File>,
    conventions: Conventions,
    #[serde(default)]
    unsupported: BTreeMap<String, String>,
    #[serde(flatten)]
    plan: Plan,
    alternatives: Vec<Alternative>,
}

/// An entry point.
#[derive(Clone, Deserialize)]
pub struct File {
    /// Relative to the manifest.
    pub path: String,
    /// The target that it belongs to.
    pub target: String,
    /// The pass that it belongs to.
    pub pass: String,
    /// `vertex`, `fragment`, `compute` or `module`.
    pub stage: String,
    /// The name of the function.
    pub entry_point: String,
}

#[derive(Clone, Deserialize)]
struct Conventions {
    scissor: [String; 4],
}

#[derive(Clone, Deserialize)]
struct Alternative {
    targets: Vec<String>,
    #[serde(flatten)]
    plan: Plan,
}

/// What depends on one plan.
#[derive(Clone, Deserialize)]
pub struct Plan {
    /// What the values of formulas depend on.
    pub symbols: Vec<Symbol>,
    requires: BTreeMap<String, Requirements>,
    /// Constants of formulas.
    pub constants: BTreeMap<String, u64>,
    /// Blocks of uniforms.
    pub uniform_blocks: Vec<Block>,
    /// The inputs of a vertex in their order. Empty in module form.
    #[serde(default)]
    pub vertex_inputs: Vec<VertexInput>,
    /// Buffers and textures.
    pub resources: Vec<Resource>,
    /// Whether passes read memory of other pixels, so that a frame cannot be divided into slices.
    #[serde(default)]
    pub whole_frame: bool,
    /// Pairs of resources that swap their roles, at the end of the frame.
    pub exchanges: Vec<Exchange>,
    /// The frame.
    pub steps: Vec<Step>,
    /// Words of the resource `counters`.
    pub counters: Vec<Counter>,
    /// Limits of devices.
    pub limits: Vec<Limit>,
    /// Formulas for x, y, width and height of the rectangle that passes draw into.
    #[serde(skip)]
    pub scissor: [String; 4],
    /// What goes before every name of the text except entry points, and `_`. Empty: nothing.
    #[serde(skip)]
    pub prefix: String,
}

/// What a target requires of its API.
#[derive(Clone, Default, Deserialize)]
pub struct Requirements {
    /// The least version of the API.
    pub version: Option<String>,
    /// Names of features, as the API spells them.
    pub features: Vec<String>,
    /// Names of extensions.
    pub extensions: Vec<String>,
}

/// A limit that a device must offer.
#[derive(Clone, Deserialize)]
pub struct Limit {
    /// Its name in WebGPU. Its last letter tells the axes of a workgroup apart, which have one name in Vulkan.
    pub webgpu: Option<String>,
    /// Its name in Vulkan.
    pub vulkan: Option<String>,
    /// Its name in OpenGL.
    pub opengl: Option<String>,
    /// A number, or a formula.
    pub needed: serde_json::Value,
}

/// A symbol of formulas.
#[derive(Clone, Deserialize)]
pub struct Symbol {
    /// Its name.
    pub name: String,
    /// The time at which it gets its value.
    pub when: String,
    /// Who sets it.
    pub set_by: String,
    /// Its least value.
    pub least: u64,
    /// Its greatest value.
    pub most: u64,
    /// Its value, of a constant in the shaders.
    pub value: Option<u64>,
    /// A formula for the value of a symbol that is not set.
    pub default: Option<String>,
}

/// A uniform block.
#[derive(Clone, Deserialize)]
pub struct Block {
    /// `frame`, `uniforms` or `camera`.
    pub name: String,
    /// Its binding point in OpenGL.
    pub opengl_binding: u32,
    /// Its size.
    pub bytes: usize,
    /// Its members.
    pub fields: Vec<Field>,
}

/// A member of a uniform block.
#[derive(Clone, Deserialize)]
pub struct Field {
    /// Its name in the text.
    pub name: String,
    /// Its name in the description, of a member of `uniforms`.
    pub uniform: Option<String>,
    /// Its type in WGSL.
    #[serde(rename = "type")]
    pub kind: String,
    /// In bytes.
    pub offset: usize,
}

/// A vertex input of geometry passes.
#[derive(Clone, Debug, Deserialize)]
pub struct VertexInput {
    /// Its location.
    pub location: u32,
    /// The name of the attribute.
    pub name: String,
    /// Its type in WGSL.
    #[serde(rename = "type")]
    pub kind: String,
}

/// A counter of the frame.
#[derive(Clone, Deserialize)]
pub struct Counter {
    /// Its name.
    pub name: String,
    /// Its word in the resource `counters`.
    pub index: usize,
    /// Whether the image is or may be wrong if it is not 0.
    pub is_loss: bool,
}

/// A step of the frame.
#[derive(Clone, Deserialize)]
pub struct Step {
    /// What it does.
    #[serde(flatten)]
    pub action: Action,
    /// Pairs of resources that may be exchanged while the step runs.
    #[serde(default)]
    pub exchanged: Vec<Exchange>,
}

/// What a step does.
#[derive(Clone, Deserialize)]
#[serde(tag = "do", rename_all = "snake_case")]
pub enum Action {
    /// Sets every word or texel of a resource.
    Clear {
        /// The resource.
        resource: String,
        /// Of a buffer: the word.
        value: u32,
        /// Of a texture: a number per channel, or `{"depth", "stencil"}`.
        texel: Option<serde_json::Value>,
    },
    /// Copies a resource to another of the same shape.
    Copy {
        /// The source.
        from: String,
        /// The destination.
        to: String,
    },
    /// Runs a pass.
    Pass(Box<Pass>),
    /// Begins a loop.
    Loop {
        /// A formula. 0: the loop is skipped.
        max_iterations: String,
        /// The index of the step that ends it.
        end: usize,
    },
    /// Ends an iteration.
    LoopEnd {
        /// The index of the step that begins the loop.
        begin: usize,
        /// The condition that ends the loop.
        until: Option<Until>,
    },
    /// Reads words and sets symbols.
    Host {
        /// Its name.
        function: String,
        /// Its arguments, one after the other.
        reads: Vec<Read>,
        /// The symbols that get its results, in order.
        sets: Vec<String>,
    },
}

/// A condition that ends a loop.
#[derive(Clone, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Until {
    /// The first word of a resource is 0.
    WordIsZero(String),
    /// No sample passed in a pass in this iteration.
    NoSamples(String),
}

/// A range of words.
#[derive(Clone, Deserialize)]
pub struct Read {
    /// The resource.
    pub resource: String,
    /// A formula for the first word.
    pub first: String,
    /// A formula for their number.
    pub count: String,
}

/// A pair of resources that swap their roles while the finished iterations of loops, and 1 if `odd`, are an odd number.
#[derive(Clone, Deserialize)]
pub struct Exchange {
    /// The pair.
    pub resources: [String; 2],
    /// The indices of the steps that begin the loops.
    pub loops: Vec<usize>,
    /// Whether 1 is added.
    pub odd: bool,
}

pub use crate::resource::{Resource, Texture, ViewDimension};

impl Plan {
    /// What the text of a target requires of its API.
    pub fn requirements(&self, target: &str) -> Requirements {
        self.requires.get(target).cloned().unwrap_or_default()
    }

    /// The extensions that the text of a target requires.
    pub fn extensions(&self, target: &str) -> &[String] {
        self.requires.get(target).map_or(&[], |requirements| &requirements.extensions)
    }

    /// Returns a resource by its name.
    pub fn resource(&self, name: &str) -> Option<&Resource> {
        self.resources.iter().find(|resource| resource.name == name)
    }

    /// Returns the passes with the indices of their steps.
    pub fn passes(&self) -> impl Iterator<Item = (usize, &Pass)> {
        self.steps.iter().enumerate().filter_map(|(at, step)| match &step.action {
            Action::Pass(pass) => Some((at, &**pass)),
            _ => None,
        })
    }
}

impl Field {
    /// The bytes that a host writes.
    pub fn bytes(&self) -> usize {
        if self.kind == "mat4x4<f32>" { CAMERA_BYTES } else { 4 * components(&self.kind) }
    }
}

/// Returns the number of components of a type in WGSL: a scalar or a vector.
fn components(kind: &str) -> usize {
    kind.strip_prefix("vec").and_then(|rest| rest.get(..1)?.parse().ok()).unwrap_or(1)
}

impl VertexInput {
    /// The number of 32-bit components.
    pub fn components(&self) -> usize {
        components(&self.kind)
    }

    /// The type of a component: `f32`, `u32` or `i32`.
    pub fn component_type(&self) -> &str {
        self.kind.split(['<', '>']).nth(1).unwrap_or(&self.kind)
    }
}

impl Manifest {
    /// Parses a manifest and returns the files and the plan of the target.
    pub fn parse(text: &str, target: &str) -> Result<(Vec<File>, Plan), Error> {
        let version: Version = serde_json::from_str(text).map_err(malformed)?;
        if version.schema != SCHEMA {
            return Err(Error(format!(
                "the schema `{}` is not `{SCHEMA}`: use the host and the `fragbuf` of one version",
                version.schema
            )));
        }
        let manifest: Manifest = serde_json::from_str(text).map_err(malformed)?;
        let files: Vec<File> = manifest.files.into_iter().filter(|file| file.target == target).collect();
        if files.is_empty() {
            return Err(Error(match manifest.unsupported.get(target) {
                Some(reason) => format!("the target `{target}` does not have these passes: {reason}"),
                None => format!(
                    "the manifest has no files of the target `{target}`: generate them with `--target {target}`"
                ),
            }));
        }
        let other = manifest.alternatives.into_iter().find(|other| other.targets.iter().any(|name| name == target));
        let plan = other.map_or(manifest.plan, |other| other.plan);
        check::check(&plan)?;
        Ok((files, Plan { scissor: manifest.conventions.scissor, prefix: manifest.prefix, ..plan }))
    }
}

#[derive(Deserialize)]
struct Version {
    schema: String,
}

fn malformed(error: serde_json::Error) -> Error {
    Error(format!("manifest: {error}"))
}
