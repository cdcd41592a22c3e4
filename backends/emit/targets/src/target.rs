//! The targets: what each can express, which WGSL profile it is made from, and who makes it.

use fragbuf_codegen::{Profile, Stage};
use fragbuf_templates::vocabulary::{Capability, Soundness};
use naga::proc::{BoundsCheckPolicies, BoundsCheckPolicy};

use crate::{Checked, glsl, hlsl, msl, spirv, wgsl};

/// One language that files are written in.
#[derive(Clone, Copy, Debug)]
pub struct Target {
    /// The word of the command line, and the folder of its files.
    pub name: &'static str,
    /// What it is.
    pub summary: &'static str,
    /// The WGSL that it is made from.
    pub profile: Profile,
    /// What it can express.
    pub offers: &'static [Capability],
    pub(crate) emit: fn(&Emission<'_>) -> Result<Vec<File>, String>,
}

/// What an emitter gets.
pub struct Emission<'a> {
    /// The pass, checked.
    pub checked: &'a Checked,
    /// The target's name.
    pub target: &'static str,
    /// Marker functions have this before their names, and so has everything but the entry points.
    pub prefix: &'a str,
    /// Atomic resources whose loads are hints, or made again inside the critical section.
    pub rechecked: Vec<String>,
    /// In which order an interlock lets invocations in.
    pub(crate) interlock: InterlockOrder,
    /// What the text is guarded against at run time.
    pub guards: Guards,
}

/// In which order an interlock lets the invocations of one pixel in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum InterlockOrder {
    /// In any.
    Any,
    /// In that of their primitives.
    Submission,
}

/// Whether generated code holds places inside their bounds and ends every loop, where naga writes the target.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Guards {
    /// It need not: every statement is a tested template's, or one of a closure, which cannot index.
    Off,
    /// It must: a file of the user's own is part of the program.
    On,
}

impl Guards {
    /// What naga does about an index outside of its bounds.
    pub(crate) fn policies(self) -> BoundsCheckPolicies {
        let policy = match self {
            Guards::Off => BoundsCheckPolicy::Unchecked,
            Guards::On => BoundsCheckPolicy::Restrict,
        };
        BoundsCheckPolicies { index: policy, buffer: policy, image_load: policy, binding_array: policy }
    }
}

/// One file of one target.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct File {
    /// Path under the output folder.
    pub path: String,
    /// The target.
    pub target: &'static str,
    /// The pass.
    pub pass: String,
    /// (`vertex`, `fragment`, `compute` or `module`, name): entry points of the file, or functions to call from a shader
    /// of the caller's own.
    pub entry_points: Vec<(&'static str, String)>,
    /// What is in it.
    pub bytes: Vec<u8>,
}

/// What both dialects of desktop GLSL offer.
const GLSL_CAPABILITIES: &[Capability] = &[
    Capability::FragmentAtomics,
    Capability::Fences,
    Capability::Coherent,
    Capability::Interlock,
    Capability::OrderedInterlock,
    Capability::U64Atomics,
    Capability::EarlyDepth,
    Capability::SampleMask,
    Capability::Coverage,
    Capability::Linkable,
];

/// Every target, in the order in which files and manifests list them.
pub const TARGETS: &[Target] = &[
    Target {
        name: "wgsl",
        summary: "the WGSL standard: browsers and every wgpu back end",
        profile: Profile::Portable,
        offers: &[Capability::FragmentAtomics, Capability::SampleMask, Capability::Coverage, Capability::Linkable],
        emit: wgsl::emit,
    },
    Target {
        name: "wgsl-native",
        summary: "WGSL with naga's coherent buffers, 64-bit atomics and early depth tests: wgpu on native back ends",
        profile: Profile::Native,
        offers: &[
            Capability::FragmentAtomics,
            Capability::Coherent,
            Capability::U64Atomics,
            Capability::EarlyDepth,
            Capability::SampleMask,
            Capability::Coverage,
            Capability::Linkable,
        ],
        emit: wgsl::emit,
    },
    Target {
        name: "glsl",
        summary: "GLSL 4.50 for OpenGL 4.5, explicit locations and bindings",
        profile: Profile::Native,
        offers: GLSL_CAPABILITIES,
        emit: glsl::emit_opengl,
    },
    Target {
        name: "glsl-vulkan",
        summary: "GLSL 4.50 for Vulkan 1.1",
        profile: Profile::Native,
        offers: GLSL_CAPABILITIES,
        emit: glsl::emit_vulkan,
    },
    Target {
        name: "glsl-es",
        summary: "GLSL 3.10 ES for OpenGL ES 3.1, where fragment shaders may write buffers",
        profile: Profile::Native,
        offers: &[Capability::FragmentAtomics, Capability::Fences, Capability::Coherent, Capability::Linkable],
        emit: glsl::emit_es,
    },
    Target {
        name: "spirv",
        summary: "SPIR-V 1.3 for Vulkan 1.1, one module per entry point",
        profile: Profile::Native,
        offers: &[
            Capability::FragmentAtomics,
            Capability::Fences,
            Capability::Coherent,
            Capability::Interlock,
            Capability::OrderedInterlock,
            Capability::U64Atomics,
            Capability::EarlyDepth,
            Capability::SampleMask,
            Capability::Coverage,
        ],
        emit: spirv::emit,
    },
    Target {
        name: "hlsl",
        summary: "HLSL, shader model 6.0",
        profile: Profile::Native,
        offers: &[
            Capability::FragmentAtomics,
            Capability::Fences,
            Capability::Coherent,
            Capability::SampleMask,
            Capability::Coverage,
            Capability::Linkable,
        ],
        emit: hlsl::emit,
    },
    Target {
        name: "msl",
        summary: "Metal Shading Language 2.4",
        profile: Profile::Portable,
        offers: &[Capability::FragmentAtomics, Capability::Coverage],
        emit: msl::emit,
    },
];

/// The target of this name.
pub fn target(name: &str) -> Option<&'static Target> {
    TARGETS.iter().find(|target| target.name == name)
}

/// The soundness tiers, the soundest first.
pub const TIERS: [&str; 5] = ["T1", "T2", "T3", "T4", "T5"];

/// The soundness tier of a variant on a target: T1 single-object atomics, T2 interlock, T3 lock with fences, T4 lock
/// without, T5 racy by design.
pub fn tier(soundness: Soundness, target: &Target) -> &'static str {
    let fenced = target.offers.contains(&Capability::Fences) && target.offers.contains(&Capability::Coherent);
    match soundness {
        Soundness::Atomics => "T1",
        Soundness::Interlock => "T2",
        Soundness::Lock if fenced => "T3",
        Soundness::Lock => "T4",
        Soundness::Racy => "T5",
    }
}

impl Emission<'_> {
    /// `<target>/<pass><suffix>`.
    pub(crate) fn path(&self, suffix: &str) -> String {
        format!("{}/{}{suffix}", self.target, self.checked.pass().anchor)
    }

    /// A file with every entry point of the pass in it.
    pub(crate) fn whole(&self, suffix: &str, bytes: Vec<u8>) -> File {
        let pass = self.checked.pass();
        let entries = pass.entry_points.iter().map(|entry| (stage_name(entry.stage), entry.name.clone()));
        let exports = pass.exports.iter().map(|name| ("module", name.clone()));
        self.file(self.path(suffix), entries.chain(exports).collect(), bytes)
    }

    pub(crate) fn file(&self, path: String, entry_points: Vec<(&'static str, String)>, bytes: Vec<u8>) -> File {
        File { path, target: self.target, pass: self.checked.pass().anchor.clone(), entry_points, bytes }
    }
}

/// The word that manifests use.
pub(crate) fn stage_name(stage: Stage) -> &'static str {
    match stage {
        Stage::Vertex => "vertex",
        Stage::Fragment => "fragment",
        Stage::Compute => "compute",
    }
}

/// The middle of a file's name.
pub(crate) fn stage_suffix(stage: Stage) -> &'static str {
    match stage {
        Stage::Vertex => "vert",
        Stage::Fragment => "frag",
        Stage::Compute => "comp",
    }
}

/// naga's word.
pub(crate) fn stage_of(stage: Stage) -> naga::ShaderStage {
    match stage {
        Stage::Vertex => naga::ShaderStage::Vertex,
        Stage::Fragment => naga::ShaderStage::Fragment,
        Stage::Compute => naga::ShaderStage::Compute,
    }
}
