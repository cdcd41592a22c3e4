//! What a program must ask of an API before it can use the text of one target: names of features and extensions.
//!
//! Input: a plan, a target, and what the text of each pass declares. Output: the names, as the API spells them. Limits are in `limits`.

use fragbuf_codegen::{Plan, PlannedPass, Stage};
use fragbuf_templates::vocabulary::{Access, Blend, Element, Feature, TextureFormat};

use crate::{Binding, BindingKind, Target};

/// The features and extensions that a device must have for one target.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Requirements {
    /// The API.
    pub api: &'static str,
    /// The least version that is sufficient: of the API, of HLSL's shader model or of Metal's language. `None`: any.
    pub version: Option<&'static str>,
    /// The features to request.
    pub features: Vec<&'static str>,
    /// The extensions to request.
    pub extensions: Vec<&'static str>,
}

/// Returns what the text of a plan requires of a target's API. `bindings`: what the text of each pass declares.
pub fn requirements(plan: &Plan, target: &Target, bindings: &[Vec<Binding>]) -> Requirements {
    let (api, version) = target.api;
    let needs = |feature| plan.requires.contains(&feature);
    let (mut features, mut extensions) = (Vec::new(), Vec::new());
    match api {
        "webgpu" => features.extend(blends_floats(plan).then_some("float32-blendable")),
        "wgpu" => features = of_wgpu(plan),
        "opengl" => {
            if needs(Feature::U64Atomics) {
                extensions.extend(["GL_ARB_gpu_shader_int64", "GL_NV_shader_atomic_int64"]);
            }
            extensions.extend(is_interlocked(plan).then_some("GL_ARB_fragment_shader_interlock"));
        }
        "opengl-es" => {
            extensions.extend(attaches_floats(plan).then_some("GL_EXT_color_buffer_float"));
            extensions.extend(blends_floats(plan).then_some("GL_EXT_float_blend"));
            extensions.extend(plan.passes.iter().any(blends_differ).then_some("GL_EXT_draw_buffers_indexed"));
        }
        "vulkan" => {
            features
                .extend(bindings.iter().any(|pass| writes_in_fragments(pass)).then_some("fragmentStoresAndAtomics"));
            features.extend(plan.passes.iter().any(blends_differ).then_some("independentBlend"));
            if needs(Feature::U64Atomics) {
                features.extend(["shaderInt64", "shaderBufferInt64Atomics"]);
                extensions.push("VK_KHR_shader_atomic_int64");
            }
            if is_interlocked(plan) {
                features.push("fragmentShaderPixelInterlock");
                extensions.push("VK_EXT_fragment_shader_interlock");
            }
        }
        _ => {}
    }
    Requirements { api, version, features, extensions }
}

/// Returns the names of wgpu's features, which WGSL with naga's extensions needs.
fn of_wgpu(plan: &Plan) -> Vec<&'static str> {
    let needs = |feature| plan.requires.contains(&feature);
    let mut features = Vec::new();
    if needs(Feature::U64Atomics) {
        features.extend(["SHADER_INT64", "SHADER_INT64_ATOMIC_ALL_OPS"]);
    }
    features.extend(needs(Feature::EarlyDepth).then_some("SHADER_EARLY_DEPTH_TEST"));
    let mut uses = plan.passes.iter().flat_map(|pass| &pass.uses);
    let is_coherent = uses.any(|usage| matches!(usage.access, Access::Coherent | Access::Hinted));
    features.extend(is_coherent.then_some("MEMORY_DECORATION_COHERENT"));
    features.extend(blends_floats(plan).then_some("FLOAT32_BLENDABLE"));
    // Every device has 1 and 4 samples.
    let counts = plan.passes.iter().filter_map(|pass| pass.samples.as_ref());
    let mut counts = counts.filter_map(|[count, _]| plan.symbols.evaluate(count, &|_| None).ok());
    features.extend(counts.any(|count| count != 1 && count != 4).then_some("TEXTURE_ADAPTER_SPECIFIC_FORMAT_FEATURES"));
    features
}

fn is_interlocked(plan: &Plan) -> bool {
    plan.requires.contains(&Feature::Interlock) || plan.requires.contains(&Feature::OrderedInterlock)
}

fn writes_in_fragments(pass: &[Binding]) -> bool {
    let is_written = |binding: &Binding| match &binding.kind {
        BindingKind::Storage { read_only, .. } => !read_only,
        BindingKind::StorageTexture { access, .. } => *access != "read-only",
        BindingKind::Uniform | BindingKind::Texture { .. } => false,
    };
    pass.iter().any(|binding| binding.stages.contains(&Stage::Fragment) && is_written(binding))
}

/// Tests whether a pass draws into a texture of floats. OpenGL ES 3.1 has only textures of integers and normalised numbers as targets.
fn attaches_floats(plan: &Plan) -> bool {
    use TextureFormat::{R32Float, Rg32Float, Rgba16Float};
    let mut targets = plan.passes.iter().flat_map(|pass| &pass.state.targets);
    targets.any(|target| {
        let element = plan.resource(&target.resource).map(|planned| planned.resource.element);
        matches!(element, Some(Element::Texture(R32Float | Rg32Float | Rgba16Float)))
    })
}

/// Tests whether a pass blends a target of 32-bit floats, which is an optional feature of WebGPU and of OpenGL ES.
fn blends_floats(plan: &Plan) -> bool {
    let mut targets = plan.passes.iter().flat_map(|pass| &pass.state.targets);
    targets.any(|target| {
        let element = plan.resource(&target.resource).map(|planned| planned.resource.element);
        let is_float = matches!(element, Some(Element::Texture(TextureFormat::R32Float | TextureFormat::Rg32Float)));
        is_float && target.blend != Blend::Replace
    })
}

fn blends_differ(pass: &PlannedPass) -> bool {
    let mut blends = pass.state.targets.iter().map(|target| target.blend);
    let first = blends.next();
    blends.any(|blend| Some(blend) != first)
}
