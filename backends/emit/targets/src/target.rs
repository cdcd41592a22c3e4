//! The table of targets: the features that each has, the WGSL profile that it is generated from, and its emitter.

use fragbuf_codegen::Profile;
use fragbuf_templates::vocabulary::{Feature, Soundness};

use crate::emission::{Emission, File};
use crate::{glsl, hlsl, msl, spirv, wgsl};

/// A shader language in one dialect.
#[derive(Clone, Copy, Debug)]
pub struct Target {
    /// Its name on the command line, and the folder of its files.
    pub name: &'static str,
    /// One line for people.
    pub summary: &'static str,
    /// The API that runs it, and the least version that is sufficient: of the API, of HLSL's shader model or of Metal's language.
    pub api: (&'static str, Option<&'static str>),
    /// The WGSL profile that it is generated from.
    pub profile: Profile,
    /// Its features.
    pub provides: &'static [Feature],
    /// Whether a compare-exchange may fail although it finds the expected value.
    pub has_weak_exchange: bool,
    pub(crate) emit: fn(&Emission<'_>) -> Result<Vec<File>, String>,
}

/// The features of both dialects of desktop GLSL.
const GLSL_FEATURES: &[Feature] = &[
    Feature::FragmentAtomics,
    Feature::Fences,
    Feature::Coherent,
    Feature::Interlock,
    Feature::OrderedInterlock,
    Feature::U64Atomics,
    Feature::EarlyDepth,
    Feature::SampleMask,
    Feature::Coverage,
    Feature::Linkable,
    Feature::SampleCounts,
    Feature::BindGroups,
];

/// Every target, in the order in which files and manifests list them.
pub const TARGETS: &[Target] = &[
    Target {
        name: "wgsl",
        summary: "the WGSL standard: browsers and every wgpu back end",
        api: ("webgpu", None),
        profile: Profile::Portable,
        provides: &[Feature::FragmentAtomics, Feature::SampleMask, Feature::Coverage, Feature::Linkable],
        has_weak_exchange: true,
        emit: wgsl::emit,
    },
    Target {
        name: "wgsl-native",
        summary: "WGSL with naga's coherent buffers, 64-bit atomics and early depth tests: wgpu on native back ends",
        api: ("wgpu", None),
        profile: Profile::Native,
        provides: &[
            Feature::FragmentAtomics,
            Feature::Coherent,
            Feature::U64Atomics,
            Feature::EarlyDepth,
            Feature::SampleMask,
            Feature::Coverage,
            Feature::Linkable,
            Feature::SampleCounts,
            Feature::BindGroups,
        ],
        has_weak_exchange: true,
        emit: wgsl::emit,
    },
    Target {
        name: "glsl",
        summary: "GLSL 4.50 for OpenGL 4.5, explicit locations and bindings",
        api: ("opengl", Some("4.5")),
        profile: Profile::Native,
        provides: GLSL_FEATURES,
        has_weak_exchange: false,
        emit: glsl::emit_opengl,
    },
    Target {
        name: "glsl-vulkan",
        summary: "GLSL 4.50 for Vulkan 1.1",
        api: ("vulkan", Some("1.1")),
        profile: Profile::Native,
        provides: GLSL_FEATURES,
        has_weak_exchange: false,
        emit: glsl::emit_vulkan,
    },
    Target {
        name: "glsl-es",
        summary: "GLSL 3.10 ES for OpenGL ES 3.1, where fragment shaders may write buffers",
        api: ("opengl-es", Some("3.1")),
        profile: Profile::Native,
        provides: &[
            Feature::FragmentAtomics,
            Feature::Fences,
            Feature::Coherent,
            Feature::Linkable,
            Feature::BindGroups,
        ],
        has_weak_exchange: false,
        emit: glsl::emit_es,
    },
    Target {
        name: "spirv",
        summary: "SPIR-V 1.3 for Vulkan 1.1, one module per entry point",
        api: ("vulkan", Some("1.1")),
        profile: Profile::Native,
        provides: &[
            Feature::FragmentAtomics,
            Feature::Fences,
            Feature::Coherent,
            Feature::Interlock,
            Feature::OrderedInterlock,
            Feature::U64Atomics,
            Feature::EarlyDepth,
            Feature::SampleMask,
            Feature::Coverage,
            Feature::SampleCounts,
            Feature::BindGroups,
        ],
        has_weak_exchange: false,
        emit: spirv::emit,
    },
    Target {
        name: "hlsl",
        summary: "HLSL, shader model 6.0",
        api: ("direct3d12", Some("6.0")),
        profile: Profile::Native,
        provides: &[
            Feature::FragmentAtomics,
            Feature::Fences,
            Feature::Coherent,
            Feature::SampleMask,
            Feature::Coverage,
            Feature::Linkable,
            Feature::SampleCounts,
            Feature::BindGroups,
        ],
        has_weak_exchange: false,
        emit: hlsl::emit,
    },
    Target {
        name: "msl",
        summary: "Metal Shading Language 2.4",
        api: ("metal", Some("2.4")),
        profile: Profile::Portable,
        provides: &[Feature::FragmentAtomics, Feature::Coverage, Feature::SampleCounts, Feature::BindGroups],
        has_weak_exchange: true,
        emit: msl::emit,
    },
];

/// Returns the target of this name.
pub fn target(name: &str) -> Option<&'static Target> {
    TARGETS.iter().find(|target| target.name == name)
}

/// The soundness tiers, best first.
pub const TIERS: [&str; 5] = ["T1", "T2", "T3", "T4", "T5"];

/// Returns what a soundness tier means.
pub fn tier_meaning(tier: &str) -> &'static str {
    match tier {
        "T1" => "atomics on single objects: sound in portable WGSL",
        "T2" => "interlock: sound where the extension exists",
        "T3" => "a lock with fences: sound by the Vulkan memory model",
        "T4" => "a lock in plain WGSL: works on many GPUs and is guaranteed by none",
        _ => "racy by design",
    }
}

/// Returns the soundness tier of a variant on a target: T1 single-object atomics, T2 interlock, T3 lock with fences, T4 lock
/// without, T5 racy by design.
pub fn tier(soundness: Soundness, target: &Target) -> &'static str {
    let fenced = target.provides.contains(&Feature::Fences) && target.provides.contains(&Feature::Coherent);
    match soundness {
        Soundness::Atomics => "T1",
        Soundness::Interlock => "T2",
        Soundness::Lock if fenced => "T3",
        Soundness::Lock => "T4",
        Soundness::Racy => "T5",
    }
}
