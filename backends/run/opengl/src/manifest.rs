//! The part of `manifest.json` that an OpenGL host needs. The guide's chapter on the manifest defines every field.

use std::collections::BTreeMap;

use serde::Deserialize;

/// The schema that this host follows.
const SCHEMA: &str = "fragbuf-manifest/3";

#[derive(Clone, Deserialize)]
pub struct Manifest {
    schema: String,
    pub files: Vec<File>,
    #[serde(flatten)]
    plan: Plan,
    alternatives: Vec<Alternative>,
}

#[derive(Clone, Deserialize)]
pub struct File {
    pub path: String,
    pub target: String,
    pub pass: String,
    pub stage: String,
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
    pub symbols: Vec<Symbol>,
    pub features: Vec<String>,
    pub constants: BTreeMap<String, u64>,
    pub uniform_blocks: Vec<Block>,
    pub vertex_inputs: Vec<VertexInput>,
    pub resources: Vec<Resource>,
    pub exchanges: Vec<Exchange>,
    pub steps: Vec<Step>,
    pub counters: Vec<Counter>,
}

#[derive(Clone, Deserialize)]
pub struct Symbol {
    pub name: String,
    pub value: Option<u64>,
    pub default: Option<String>,
}

#[derive(Clone, Deserialize)]
pub struct Block {
    pub name: String,
    pub opengl_binding: u32,
    pub bytes: usize,
    pub fields: Vec<Field>,
}

#[derive(Clone, Deserialize)]
pub struct Field {
    pub name: String,
    pub offset: usize,
}

/// A vertex input of geometry passes.
#[derive(Clone, Deserialize)]
pub struct VertexInput {
    /// Its location.
    pub location: u32,
    /// The name of the attribute.
    pub name: String,
    /// Its type in WGSL.
    #[serde(rename = "type")]
    pub kind: String,
}

#[derive(Clone, Deserialize)]
pub struct Resource {
    pub name: String,
    pub init: serde_json::Value,
    pub opengl_binding: u32,
    pub words: String,
    pub texture: Option<Texture>,
}

#[derive(Clone, Deserialize)]
pub struct Texture {
    pub format: String,
    pub samples: String,
}

#[derive(Clone, Deserialize)]
pub struct Counter {
    pub name: String,
    pub index: usize,
}

#[derive(Clone, Deserialize)]
pub struct Step {
    #[serde(flatten)]
    pub action: Action,
    /// Pairs of resources that may be exchanged while the step runs.
    #[serde(default)]
    pub exchanged: Vec<Exchange>,
}

#[derive(Clone, Deserialize)]
#[serde(tag = "do", rename_all = "snake_case")]
pub enum Action {
    Clear { resource: String, value: u32, texel: Option<serde_json::Value> },
    Copy { from: String, to: String },
    Pass(Box<Pass>),
    Loop { max_iterations: String, end: usize },
    LoopEnd { begin: usize, until: Option<Until> },
    Host { function: String, reads: Vec<Read>, sets: Vec<String> },
}

#[derive(Clone, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Until {
    WordIsZero(String),
    NoSamples(String),
}

#[derive(Clone, Deserialize)]
pub struct Read {
    pub resource: String,
    pub first: String,
    pub count: String,
}

#[derive(Clone, Deserialize)]
pub struct Exchange {
    pub resources: [String; 2],
    pub loops: Vec<usize>,
    pub odd: bool,
}

#[derive(Clone, Deserialize)]
pub struct Pass {
    #[serde(rename = "pass")]
    pub name: String,
    pub kind: Kind,
    #[serde(default)]
    pub groups: Vec<String>,
    pub uses: BTreeMap<String, String>,
    pub state: State,
    #[serde(default)]
    pub objects: Objects,
}

#[derive(Clone, Copy, Deserialize, PartialEq)]
#[serde(rename_all = "snake_case")]
pub enum Kind {
    Geometry,
    Fullscreen,
    Compute,
}

/// The objects of the scene that a geometry pass draws.
#[derive(Clone, Default, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Objects {
    #[default]
    All,
    Boxes,
    VisibleIn(String),
}

#[derive(Clone, Deserialize)]
pub struct State {
    pub depth: Option<Depth>,
    pub stencil: Option<Stencil>,
    pub targets: Vec<Target>,
    pub samples: Option<Samples>,
}

#[derive(Clone, Deserialize)]
pub struct Depth {
    pub resource: String,
    pub compare: String,
    pub write: bool,
}

#[derive(Clone, Deserialize)]
pub struct Stencil {
    pub resource: String,
    pub compare: String,
    pub fail: String,
    pub pass: String,
    pub reference: String,
}

#[derive(Clone, Deserialize)]
pub struct Target {
    pub resource: String,
    pub blend: Blend,
}

#[derive(Clone, Deserialize)]
pub struct Blend {
    pub source: String,
    pub destination: String,
    pub operation: String,
}

#[derive(Clone, Deserialize)]
pub struct Samples {
    pub count: String,
    pub mask: String,
}

impl VertexInput {
    /// The number of 32-bit components.
    pub fn components(&self) -> usize {
        self.kind.strip_prefix("vec").and_then(|rest| rest.get(..1)?.parse().ok()).unwrap_or(1)
    }

    /// The type of a component as OpenGL names it.
    pub(crate) fn component_type(&self) -> u32 {
        match self.kind.split(['<', '>']).nth(1).unwrap_or(&self.kind) {
            "u32" => glow::UNSIGNED_INT,
            "i32" => glow::INT,
            _ => glow::FLOAT,
        }
    }
}

impl Manifest {
    /// Parses a manifest and returns the files and the plan of the target.
    pub fn parse(text: &str, target: &str) -> Result<(Vec<File>, Plan), crate::Error> {
        let manifest: Manifest =
            serde_json::from_str(text).map_err(|error| crate::Error(format!("manifest: {error}")))?;
        if manifest.schema != SCHEMA {
            return Err(crate::Error(format!("the schema `{}` is not `{SCHEMA}`", manifest.schema)));
        }
        let files: Vec<File> = manifest.files.into_iter().filter(|file| file.target == target).collect();
        if files.is_empty() {
            return Err(crate::Error(format!("the manifest has no files of the target `{target}`")));
        }
        let other = manifest.alternatives.into_iter().find(|other| other.targets.iter().any(|name| name == target));
        Ok((files, other.map_or(manifest.plan, |other| other.plan)))
    }
}
