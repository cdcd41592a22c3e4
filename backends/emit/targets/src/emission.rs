//! The input and output of an emitter: one checked pass in, files out.

use fragbuf_codegen::Stage;
use naga::proc::{BoundsCheckPolicies, BoundsCheckPolicy};

use crate::{Checked, OpenGlBindings};

/// One pass to emit.
pub struct Emission<'a> {
    /// The checked pass.
    pub checked: &'a Checked,
    /// The target's name.
    pub target: &'static str,
    /// Prefix of every name except entry points, marker functions included.
    pub prefix: &'a str,
    /// Atomic resources whose loads are hints, or are repeated inside the critical section.
    pub rechecked: Vec<String>,
    /// The binding points of the plan in OpenGL.
    pub opengl: &'a OpenGlBindings,
    /// The order in which an interlock admits invocations.
    pub(crate) interlock: InterlockOrder,
    /// Whether run-time checks are emitted.
    pub guards: Guards,
}

/// The order in which an interlock admits the invocations of one pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum InterlockOrder {
    /// Any order.
    Any,
    /// The order of their primitives.
    Submission,
}

/// Whether code that naga writes clamps indices and bounds loops at run time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Guards {
    /// No: every statement is from a tested template, or from a closure, which cannot index.
    Off,
    /// Yes: a user file is part of the program.
    On,
}

impl Guards {
    /// Returns what naga does about an index out of bounds.
    pub(crate) fn policies(self) -> BoundsCheckPolicies {
        let policy = match self {
            Guards::Off => BoundsCheckPolicy::Unchecked,
            Guards::On => BoundsCheckPolicy::Restrict,
        };
        BoundsCheckPolicies { index: policy, buffer: policy, image_load: policy, binding_array: policy }
    }
}

/// An emitted file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct File {
    /// Path under the output folder.
    pub path: String,
    /// The target.
    pub target: &'static str,
    /// The pass.
    pub pass: String,
    /// Pairs of (`vertex`, `fragment`, `compute` or `module`) and name: entry points of the file, or functions that the caller's
    /// shader can call.
    pub entry_points: Vec<(&'static str, String)>,
    /// The content.
    pub bytes: Vec<u8>,
}

impl Emission<'_> {
    /// Returns `<target>/<pass><suffix>`.
    pub(crate) fn path(&self, suffix: &str) -> String {
        format!("{}/{}{suffix}", self.target, self.checked.pass().name)
    }

    /// Returns a file with every entry point of the pass.
    pub(crate) fn whole(&self, suffix: &str, bytes: Vec<u8>) -> File {
        let pass = self.checked.pass();
        let entries = pass.entry_points.iter().map(|entry| (stage_name(entry.stage), entry.name.clone()));
        let exports = pass.exports.iter().map(|name| ("module", name.clone()));
        self.file(self.path(suffix), entries.chain(exports).collect(), bytes)
    }

    /// Returns technique, generator, choices and algorithms as `//` comments, for languages that lose the templates' comments.
    pub(crate) fn header(&self) -> String {
        let notes = &self.checked.pass().notes;
        let lines = format!("{}\n{}", notes.generated, notes.algorithms);
        let commented: String = lines.lines().map(|line| format!("// {line}").trim_end().to_owned() + "\n").collect();
        commented + "\n"
    }

    pub(crate) fn file(&self, path: String, entry_points: Vec<(&'static str, String)>, bytes: Vec<u8>) -> File {
        File { path, target: self.target, pass: self.checked.pass().name.clone(), entry_points, bytes }
    }
}

/// Returns the name that manifests use.
pub(crate) fn stage_name(stage: Stage) -> &'static str {
    match stage {
        Stage::Vertex => "vertex",
        Stage::Fragment => "fragment",
        Stage::Compute => "compute",
    }
}

/// Returns the part of a file name before its extension.
pub(crate) fn stage_suffix(stage: Stage) -> &'static str {
    match stage {
        Stage::Vertex => "vert",
        Stage::Fragment => "frag",
        Stage::Compute => "comp",
    }
}

/// Returns naga's value.
pub(crate) fn stage_of(stage: Stage) -> naga::ShaderStage {
    match stage {
        Stage::Vertex => naga::ShaderStage::Vertex,
        Stage::Fragment => naga::ShaderStage::Fragment,
        Stage::Compute => naga::ShaderStage::Compute,
    }
}
