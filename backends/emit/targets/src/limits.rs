//! The limits that a device must meet to run a plan, by their names in WebGPU, Vulkan and OpenGL.
//!
//! Input: a plan, its bind group, and the workgroups of its compute passes. Output: one [`Limit`] per limit that the plan depends on:
//! a number, or a formula over the plan's symbols. Nothing here depends on a device.

use std::collections::BTreeSet;

use fragbuf_codegen::{FIRST_BINDING, MemberSource, Plan, PlannedPass, PlannedResource};
use fragbuf_model::UniformBlock;
use fragbuf_templates::vocabulary::{Access, Element, Feature, Kind, TextureFormat};

use crate::OpenGlBindings;

/// A limit that a device must meet.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Limit {
    /// The limit of WebGPU.
    pub webgpu: Option<WebGpuLimit>,
    /// The name in Vulkan. A name that ends in `SampleCounts` is a set of bits, which must contain the bit of the needed value.
    pub vulkan: Option<&'static str>,
    /// The name in OpenGL.
    pub opengl: Option<&'static str>,
    /// The least value that is sufficient.
    pub needed: Needed,
    /// How several plans in one shader share the limit.
    pub sharing: Sharing,
}

/// A limit of WebGPU.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct WebGpuLimit {
    /// Its name.
    pub name: &'static str,
    /// Its value on a device whose program requests no other.
    pub default: u64,
}

/// The least sufficient value of a limit.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Needed {
    /// A number.
    Number(u64),
    /// A formula over the symbols of the plan.
    Formula(String),
}

/// How several plans in one shader share a limit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sharing {
    /// Their numbers add up.
    Sum,
    /// The greatest of their values counts.
    Greatest,
}

/// The workgroup of a compute pass.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Workgroup {
    /// Its invocations along x, y and z.
    pub size: [u32; 3],
    /// The bytes of its shared memory.
    pub bytes: u32,
}

impl Limit {
    /// Tests whether a WebGPU device without further requests may be too small. Formulas are not tested.
    pub fn exceeds_default(&self) -> bool {
        let default = self.webgpu.map(|webgpu| webgpu.default);
        matches!((&self.needed, default), (Needed::Number(needed), Some(default)) if *needed > default)
    }

    /// Returns the value that every OpenGL 4.5 has: Tables 23.53 to 23.70 of its specification. `None`: the limit has no name there.
    pub fn opengl_minimum(&self) -> Option<u64> {
        match self.opengl? {
            // One name with an index in OpenGL, and three names in WebGPU.
            "GL_MAX_COMPUTE_WORK_GROUP_SIZE" if self.is_of_webgpu("maxComputeWorkgroupSizeZ") => Some(64),
            opengl => OPENGL_MINIMA.iter().find(|(name, _)| *name == opengl).map(|(_, value)| *value),
        }
    }

    /// Tests whether this is the limit of WebGPU with this name.
    pub fn is_of_webgpu(&self, name: &str) -> bool {
        self.webgpu.is_some_and(|webgpu| webgpu.name == name)
    }
}

/// What every OpenGL 4.5 has. The size of a workgroup is that along x and y.
const OPENGL_MINIMA: [(&str, u64); 24] = [
    ("GL_MAX_COMBINED_SHADER_OUTPUT_RESOURCES", 8),
    ("GL_MAX_SHADER_STORAGE_BUFFER_BINDINGS", 8),
    ("GL_MAX_COMBINED_SHADER_STORAGE_BLOCKS", 8),
    ("GL_MAX_FRAGMENT_SHADER_STORAGE_BLOCKS", 8),
    ("GL_MAX_COMPUTE_SHADER_STORAGE_BLOCKS", 8),
    ("GL_MAX_UNIFORM_BUFFER_BINDINGS", 84),
    ("GL_MAX_FRAGMENT_UNIFORM_BLOCKS", 14),
    ("GL_MAX_COMPUTE_UNIFORM_BLOCKS", 14),
    ("GL_MAX_COMBINED_TEXTURE_IMAGE_UNITS", 80),
    ("GL_MAX_TEXTURE_IMAGE_UNITS", 16),
    ("GL_MAX_COMPUTE_TEXTURE_IMAGE_UNITS", 16),
    ("GL_MAX_SHADER_STORAGE_BLOCK_SIZE", 1 << 27),
    ("GL_MAX_UNIFORM_BLOCK_SIZE", 16_384),
    ("GL_MAX_TEXTURE_SIZE", 16_384),
    ("GL_MAX_DRAW_BUFFERS", 8),
    ("GL_MAX_VERTEX_ATTRIBS", 16),
    ("GL_MAX_VARYING_VECTORS", 15),
    ("GL_MAX_INTEGER_SAMPLES", 1),
    ("GL_MAX_COLOR_TEXTURE_SAMPLES", 1),
    ("GL_MAX_DEPTH_TEXTURE_SAMPLES", 1),
    ("GL_MAX_COMPUTE_WORK_GROUP_COUNT", 65_535),
    ("GL_MAX_COMPUTE_WORK_GROUP_SIZE", 1024),
    ("GL_MAX_COMPUTE_WORK_GROUP_INVOCATIONS", 1024),
    ("GL_MAX_COMPUTE_SHARED_MEMORY_SIZE", 32_768),
];

/// Returns the limits of a plan whose resources are in bind group `group`.
pub fn limits(plan: &Plan, group: u32, workgroups: &[Workgroup]) -> Vec<Limit> {
    let mut limits = bindings(plan, group);
    limits.extend(sizes(plan));
    limits.extend(rendering(plan));
    limits.extend(compute(plan, workgroups));
    limits.retain(|limit| limit.needed != Needed::Number(0));
    limits
}

/// The names of a limit in WebGPU, with its default there, in Vulkan and in OpenGL.
type Names = (Option<(&'static str, u64)>, &'static str, &'static str);

/// Returns a row of the table. An API with an empty name has no such limit.
fn row((webgpu, vulkan, opengl): Names, needed: impl Into<Needed>, sharing: Sharing) -> Limit {
    let name = |name: &'static str| (!name.is_empty()).then_some(name);
    let webgpu = webgpu.map(|(name, default)| WebGpuLimit { name, default });
    Limit { webgpu, vulkan: name(vulkan), opengl: name(opengl), needed: needed.into(), sharing }
}

impl From<u64> for Needed {
    fn from(number: u64) -> Self {
        Needed::Number(number)
    }
}

impl From<String> for Needed {
    fn from(formula: String) -> Self {
        Needed::Formula(formula)
    }
}

fn bindings(plan: &Plan, group: u32) -> Vec<Limit> {
    let is_buffer = |planned: &PlannedResource| !planned.is_texture() && plan.is_declared(planned);
    let is_texture = PlannedResource::is_texture;
    let buffers = |pass: &PlannedPass| used(plan, pass, &[Access::Attachment, Access::Indirect], &is_buffer);
    let textures = |pass: &PlannedPass| used(plan, pass, &[Access::Attachment], &is_texture);
    // Fragment and compute stages may read the block of the frame and the description's uniforms, a vertex stage the camera.
    let uniforms = |_: &PlannedPass| if plan.variant.uniforms.is_empty() { 1 } else { 2 };
    let outputs = |pass: &PlannedPass| if is_compute(pass) { 0 } else { buffers(pass) + targets(pass) };
    let all = u64::from(FIRST_BINDING) + plan.resources.len() as u64;
    let storage = (Some(("maxStorageBuffersPerShaderStage", 8)), "maxPerStageDescriptorStorageBuffers", "");
    let storage_blocks = ["GL_MAX_FRAGMENT_SHADER_STORAGE_BLOCKS", "GL_MAX_COMPUTE_SHADER_STORAGE_BLOCKS"];
    let uniform = (Some(("maxUniformBuffersPerShaderStage", 12)), "maxPerStageDescriptorUniformBuffers", "");
    let uniform_blocks = ["GL_MAX_FRAGMENT_UNIFORM_BLOCKS", "GL_MAX_COMPUTE_UNIFORM_BLOCKS"];
    let sampled = (Some(("maxSampledTexturesPerShaderStage", 16)), "maxPerStageDescriptorSampledImages", "");
    let units = ["GL_MAX_TEXTURE_IMAGE_UNITS", "GL_MAX_COMPUTE_TEXTURE_IMAGE_UNITS"];
    let combined = (None, "maxFragmentCombinedOutputResources", "GL_MAX_COMBINED_SHADER_OUTPUT_RESOURCES");
    let groups = (Some(("maxBindGroups", 4)), "maxBoundDescriptorSets", "");
    let numbers = (Some(("maxBindingsPerBindGroup", 1000)), "", "");
    let points = OpenGlBindings::of(plan);
    let of_opengl = |name: &'static str| (None, "", name);
    let mut limits = vec![
        row(groups, u64::from(group) + 1, Sharing::Greatest),
        row(numbers, all, Sharing::Greatest),
        row(combined, most(plan, &outputs), Sharing::Sum),
        row(of_opengl("GL_MAX_SHADER_STORAGE_BUFFER_BINDINGS"), u64::from(points.storage_buffers()), Sharing::Sum),
        row(of_opengl("GL_MAX_COMBINED_SHADER_STORAGE_BLOCKS"), most(plan, &buffers), Sharing::Sum),
        row(of_opengl("GL_MAX_UNIFORM_BUFFER_BINDINGS"), u64::from(FIRST_BINDING), Sharing::Sum),
        row(of_opengl("GL_MAX_COMBINED_TEXTURE_IMAGE_UNITS"), u64::from(points.texture_units()), Sharing::Sum),
    ];
    limits.extend(per_stage(plan, storage, storage_blocks, &buffers));
    limits.extend(per_stage(plan, uniform, uniform_blocks, &uniforms));
    limits.extend(per_stage(plan, sampled, units, &textures));
    limits
}

/// Returns the limits on what one stage may access. OpenGL has one for fragment stages and another for compute stages.
fn per_stage(
    plan: &Plan,
    names: Names,
    [fragment, compute]: [&'static str; 2],
    count: &dyn Fn(&PlannedPass) -> u64,
) -> [Limit; 3] {
    let of = |in_compute: bool| move |pass: &PlannedPass| if is_compute(pass) == in_compute { count(pass) } else { 0 };
    [
        row(names, most(plan, count), Sharing::Sum),
        row((None, "", fragment), most(plan, &of(false)), Sharing::Sum),
        row((None, "", compute), most(plan, &of(true)), Sharing::Sum),
    ]
}

/// Returns the greatest count of a pass.
fn most(plan: &Plan, count: &dyn Fn(&PlannedPass) -> u64) -> u64 {
    plan.passes.iter().map(count).max().unwrap_or(0)
}

fn is_compute(pass: &PlannedPass) -> bool {
    matches!(pass.kind, Kind::Compute { .. })
}

fn targets(pass: &PlannedPass) -> u64 {
    pass.state.targets.len() as u64
}

/// Returns the number of different resources of a kind that the shaders of a pass may access.
fn used(plan: &Plan, pass: &PlannedPass, ignored: &[Access], is_kind: &dyn Fn(&PlannedResource) -> bool) -> u64 {
    let names: BTreeSet<&str> = pass
        .uses
        .iter()
        .filter(|usage| !ignored.contains(&usage.access))
        .map(|usage| usage.resource.as_str())
        .collect();
    names.into_iter().filter_map(|name| plan.resource(name)).filter(|planned| is_kind(planned)).count() as u64
}

fn sizes(plan: &Plan) -> Vec<Limit> {
    let buffers = plan.resources.iter().filter(|planned| !planned.is_texture());
    let bytes: Vec<String> = buffers.map(|planned| format!("4 * ({})", planned.words)).collect();
    let uniforms = u64::from(UniformBlock::of(&plan.variant.uniforms).size);
    let frame = (4 * plan.fields.len() as u64).next_multiple_of(16);
    // The camera's matrix has 64 bytes.
    let block = uniforms.max(frame).max(64);
    let binding = (
        Some(("maxStorageBufferBindingSize", 134_217_728)),
        "maxStorageBufferRange",
        "GL_MAX_SHADER_STORAGE_BLOCK_SIZE",
    );
    let buffer = (Some(("maxBufferSize", 268_435_456)), "maxBufferSize", "");
    let uniform = (Some(("maxUniformBufferBindingSize", 65_536)), "maxUniformBufferRange", "GL_MAX_UNIFORM_BLOCK_SIZE");
    let texture = (Some(("maxTextureDimension2D", 8192)), "maxImageDimension2D", "GL_MAX_TEXTURE_SIZE");
    let mut limits = Vec::new();
    if let Some(greatest) = greatest(bytes) {
        limits.push(row(binding, greatest.clone(), Sharing::Greatest));
        limits.push(row(buffer, greatest, Sharing::Greatest));
    }
    limits.push(row(uniform, block, Sharing::Greatest));
    limits.push(row(texture, "max(width, height)".to_owned(), Sharing::Greatest));
    limits
}

/// Returns a formula for the greatest of the values.
fn greatest(values: Vec<String>) -> Option<String> {
    let mut different: Vec<String> = Vec::new();
    for value in values {
        if !different.contains(&value) {
            different.push(value);
        }
    }
    different.into_iter().reduce(|greatest, value| format!("max({greatest}, {value})"))
}

fn rendering(plan: &Plan) -> Vec<Limit> {
    let bytes = |pass: &PlannedPass| {
        let formats = pass.state.targets.iter().filter_map(|target| texture_of(plan.resource(&target.resource)?));
        formats.fold(0, |sum: u64, format| {
            let (bytes, alignment) = attachment_bytes(format);
            sum.next_multiple_of(alignment) + bytes
        })
    };
    let from = |is_source: &dyn Fn(&MemberSource) -> bool| {
        plan.layout.members.iter().filter(|member| is_source(&member.source)).count() as u64
    };
    let attributes = from(&|source| *source == MemberSource::Vertex);
    // WebGPU counts built-in inputs of fragment stages as one variable. Fixed sample masks are read as well.
    let reads_mask = plan.requires.contains(&Feature::SampleMask);
    let built_ins = from(&|source| matches!(source, MemberSource::FrontFacing | MemberSource::BuiltIn(_)))
        .max(u64::from(reads_mask))
        .min(1);
    let color = (Some(("maxColorAttachments", 8)), "maxColorAttachments", "GL_MAX_DRAW_BUFFERS");
    let color_bytes = (Some(("maxColorAttachmentBytesPerSample", 32)), "", "");
    let inputs = (Some(("maxVertexAttributes", 16)), "maxVertexInputAttributes", "GL_MAX_VERTEX_ATTRIBS");
    let between = (Some(("maxInterStageShaderVariables", 16)), "", "GL_MAX_VARYING_VECTORS");
    let mut limits = vec![
        row(color, most(plan, &targets), Sharing::Greatest),
        row(color_bytes, most(plan, &bytes), Sharing::Greatest),
        row(inputs, attributes + 1, Sharing::Greatest),
        row(between, attributes + built_ins, Sharing::Greatest),
    ];
    limits.extend(samples(plan));
    limits
}

/// The kinds of textures whose samples APIs limit separately.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Numeric {
    Integer,
    Float,
    Depth,
}

/// Returns the limits on the samples of multisampled textures: as attachments, and as textures that shaders read.
fn samples(plan: &Plan) -> Vec<Limit> {
    use Numeric::{Depth, Float, Integer};
    const NAMES: [(Numeric, &str, &str); 6] = [
        (Integer, "framebufferIntegerColorSampleCounts", "GL_MAX_INTEGER_SAMPLES"),
        (Integer, "sampledImageIntegerSampleCounts", "GL_MAX_COLOR_TEXTURE_SAMPLES"),
        (Float, "framebufferColorSampleCounts", "GL_MAX_COLOR_TEXTURE_SAMPLES"),
        (Float, "sampledImageColorSampleCounts", ""),
        (Depth, "framebufferDepthSampleCounts", "GL_MAX_DEPTH_TEXTURE_SAMPLES"),
        (Depth, "sampledImageDepthSampleCounts", ""),
    ];
    let of = |numeric: Numeric| {
        let textures = plan.resources.iter().filter(|planned| texture_of(planned).map(numeric_of) == Some(numeric));
        let counts = textures.filter_map(|planned| plan.symbols.evaluate(planned.sample_count()?, &|_| None).ok());
        counts.max().unwrap_or(0)
    };
    NAMES.iter().map(|(numeric, vulkan, opengl)| row((None, vulkan, opengl), of(*numeric), Sharing::Greatest)).collect()
}

fn numeric_of(format: TextureFormat) -> Numeric {
    match format {
        TextureFormat::R32Uint | TextureFormat::Rg16Uint => Numeric::Integer,
        TextureFormat::R32Float | TextureFormat::Rg32Float | TextureFormat::Rgba8Unorm | TextureFormat::Rgba16Float => {
            Numeric::Float
        }
        TextureFormat::Depth32Float | TextureFormat::Depth24PlusStencil8 => Numeric::Depth,
    }
}

/// Returns the bytes of a colour attachment, and their alignment, as WebGPU counts them.
fn attachment_bytes(format: TextureFormat) -> (u64, u64) {
    match format {
        TextureFormat::R32Uint | TextureFormat::R32Float => (4, 4),
        TextureFormat::Rg16Uint => (4, 2),
        TextureFormat::Rg32Float => (8, 4),
        TextureFormat::Rgba8Unorm => (8, 1),
        TextureFormat::Rgba16Float => (8, 2),
        TextureFormat::Depth32Float | TextureFormat::Depth24PlusStencil8 => (0, 1),
    }
}

fn compute(plan: &Plan, workgroups: &[Workgroup]) -> Vec<Limit> {
    let groups = plan.passes.iter().flat_map(|pass| &pass.groups).map(|groups| groups.to_string());
    let Some(dispatch) = greatest(groups.collect()) else { return Vec::new() };
    let most = |value: &dyn Fn(&Workgroup) -> u32| u64::from(workgroups.iter().map(value).max().unwrap_or(0));
    let invocations = |group: &Workgroup| group.size.iter().product();
    let dispatched = (
        Some(("maxComputeWorkgroupsPerDimension", 65_535)),
        "maxComputeWorkGroupCount",
        "GL_MAX_COMPUTE_WORK_GROUP_COUNT",
    );
    let side = |name: &'static str, default| {
        (Some((name, default)), "maxComputeWorkGroupSize", "GL_MAX_COMPUTE_WORK_GROUP_SIZE")
    };
    let all = (
        Some(("maxComputeInvocationsPerWorkgroup", 256)),
        "maxComputeWorkGroupInvocations",
        "GL_MAX_COMPUTE_WORK_GROUP_INVOCATIONS",
    );
    let memory = (
        Some(("maxComputeWorkgroupStorageSize", 16_384)),
        "maxComputeSharedMemorySize",
        "GL_MAX_COMPUTE_SHARED_MEMORY_SIZE",
    );
    vec![
        row(dispatched, dispatch, Sharing::Greatest),
        row(side("maxComputeWorkgroupSizeX", 256), most(&|group| group.size[0]), Sharing::Greatest),
        row(side("maxComputeWorkgroupSizeY", 256), most(&|group| group.size[1]), Sharing::Greatest),
        row(side("maxComputeWorkgroupSizeZ", 64), most(&|group| group.size[2]), Sharing::Greatest),
        row(all, most(&invocations), Sharing::Greatest),
        row(memory, most(&|group| group.bytes), Sharing::Greatest),
    ]
}

fn texture_of(planned: &PlannedResource) -> Option<TextureFormat> {
    match planned.resource.element {
        Element::Texture(format) | Element::ValueTextures(format) | Element::EntryTextures(format) => Some(format),
        Element::Texels(_) | Element::Word | Element::Word64 | Element::Entry | Element::Value => None,
    }
}
