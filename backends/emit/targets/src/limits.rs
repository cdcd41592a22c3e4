//! The limits that a device must meet to run a plan, by their names in WebGPU, Vulkan and OpenGL.
//!
//! Input: a plan, its bind group, and the workgroups of its compute passes. Output: one [`Limit`] per limit that the plan depends on:
//! a number, or a formula over the plan's symbols. Nothing here depends on a device.

use std::collections::BTreeSet;

use fragbuf_codegen::{FIRST_BINDING, Plan, PlannedPass, PlannedResource};
use fragbuf_model::UniformBlock;
use fragbuf_templates::vocabulary::{Access, Element, TextureFormat};

/// A limit that a device must meet.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Limit {
    /// The name in WebGPU.
    pub webgpu: &'static str,
    /// The limit of a WebGPU device whose program requests no other.
    pub webgpu_default: u64,
    /// The name in Vulkan.
    pub vulkan: Option<&'static str>,
    /// The name in OpenGL.
    pub opengl: Option<&'static str>,
    /// The least value that is sufficient.
    pub needed: Needed,
    /// How several plans in one shader share the limit.
    pub sharing: Sharing,
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
        matches!(self.needed, Needed::Number(needed) if needed > self.webgpu_default)
    }
}

/// Returns the limits of a plan whose resources are in bind group `group`.
pub fn limits(plan: &Plan, group: u32, workgroups: &[Workgroup]) -> Vec<Limit> {
    let mut limits = bindings(plan, group);
    limits.extend(sizes(plan));
    limits.extend(rendering(plan));
    limits.extend(compute(plan, workgroups));
    limits.retain(|limit| limit.needed != Needed::Number(0));
    limits
}

/// Returns a row of the table.
fn row(
    webgpu: &'static str,
    webgpu_default: u64,
    (vulkan, opengl): (&'static str, &'static str),
    needed: impl Into<Needed>,
    sharing: Sharing,
) -> Limit {
    let name = |name: &'static str| (!name.is_empty()).then_some(name);
    Limit { webgpu, webgpu_default, vulkan: name(vulkan), opengl: name(opengl), needed: needed.into(), sharing }
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
    let is_buffer = |planned: &PlannedResource| texture_of(planned).is_none();
    let buffers = |pass: &PlannedPass| used(plan, pass, &[Access::Attachment, Access::Indirect], &is_buffer);
    let textures = |pass: &PlannedPass| used(plan, pass, &[Access::Attachment], &|planned| !is_buffer(planned));
    let most = |count: &dyn Fn(&PlannedPass) -> u64| plan.passes.iter().map(count).max().unwrap_or(0);
    // Every stage may read the block of the frame and the description's uniforms; a vertex stage also reads the camera.
    let uniforms = if plan.variant.uniforms.is_empty() { 1 } else { 2 };
    let all = u64::from(FIRST_BINDING) + plan.resources.len() as u64;
    let storage = ("maxPerStageDescriptorStorageBuffers", "GL_MAX_FRAGMENT_SHADER_STORAGE_BLOCKS");
    let sampled = ("maxPerStageDescriptorSampledImages", "GL_MAX_TEXTURE_IMAGE_UNITS");
    let blocks = ("maxPerStageDescriptorUniformBuffers", "GL_MAX_FRAGMENT_UNIFORM_BLOCKS");
    let groups = ("maxBoundDescriptorSets", "");
    vec![
        row("maxBindGroups", 4, groups, u64::from(group) + 1, Sharing::Greatest),
        row("maxBindingsPerBindGroup", 1000, ("", ""), all, Sharing::Greatest),
        row("maxStorageBuffersPerShaderStage", 8, storage, most(&buffers), Sharing::Sum),
        row("maxUniformBuffersPerShaderStage", 12, blocks, uniforms, Sharing::Sum),
        row("maxSampledTexturesPerShaderStage", 16, sampled, most(&textures), Sharing::Sum),
    ]
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
    let buffers = plan.resources.iter().filter(|planned| texture_of(planned).is_none());
    let bytes: Vec<String> = buffers.map(|planned| format!("4 * ({})", planned.words)).collect();
    let uniforms = u64::from(UniformBlock::of(&plan.variant.uniforms).size);
    let frame = (4 * plan.fields.len() as u64).next_multiple_of(16);
    // The camera's matrix has 64 bytes.
    let block = uniforms.max(frame).max(64);
    let binding = ("maxStorageBufferRange", "GL_MAX_SHADER_STORAGE_BLOCK_SIZE");
    let uniform = ("maxUniformBufferRange", "GL_MAX_UNIFORM_BLOCK_SIZE");
    let texture = ("maxImageDimension2D", "GL_MAX_TEXTURE_SIZE");
    let mut limits = Vec::new();
    if let Some(greatest) = greatest(bytes) {
        limits.push(row("maxStorageBufferBindingSize", 134_217_728, binding, greatest.clone(), Sharing::Greatest));
        limits.push(row("maxBufferSize", 268_435_456, ("", ""), greatest, Sharing::Greatest));
    }
    limits.push(row("maxUniformBufferBindingSize", 65_536, uniform, block, Sharing::Greatest));
    limits.push(row("maxTextureDimension2D", 8192, texture, "max(width, height)".to_owned(), Sharing::Greatest));
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
    let targets = |pass: &PlannedPass| pass.state.targets.len() as u64;
    let bytes = |pass: &PlannedPass| {
        let formats = pass.state.targets.iter().filter_map(|target| texture_of(plan.resource(&target.resource)?));
        formats.fold(0, |sum: u64, format| {
            let (bytes, alignment) = attachment_bytes(format);
            sum.next_multiple_of(alignment) + bytes
        })
    };
    let most = |count: &dyn Fn(&PlannedPass) -> u64| plan.passes.iter().map(count).max().unwrap_or(0);
    let attributes = plan.variant.attributes.iter().filter(|attribute| attribute.name.value != "depth").count() as u64;
    let color = ("maxColorAttachments", "GL_MAX_DRAW_BUFFERS");
    let inputs = ("maxVertexInputAttributes", "GL_MAX_VERTEX_ATTRIBS");
    vec![
        row("maxColorAttachments", 8, color, most(&targets), Sharing::Greatest),
        row("maxColorAttachmentBytesPerSample", 32, ("", ""), most(&bytes), Sharing::Greatest),
        row("maxVertexAttributes", 16, inputs, attributes + 1, Sharing::Greatest),
        row("maxInterStageShaderVariables", 16, ("", ""), attributes, Sharing::Greatest),
    ]
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
    let dispatched = ("maxComputeWorkGroupCount", "GL_MAX_COMPUTE_WORK_GROUP_COUNT");
    let side = ("maxComputeWorkGroupSize", "GL_MAX_COMPUTE_WORK_GROUP_SIZE");
    let all = ("maxComputeWorkGroupInvocations", "GL_MAX_COMPUTE_WORK_GROUP_INVOCATIONS");
    let memory = ("maxComputeSharedMemorySize", "GL_MAX_COMPUTE_SHARED_MEMORY_SIZE");
    let invocations = |group: &Workgroup| group.size.iter().product();
    vec![
        row("maxComputeWorkgroupsPerDimension", 65_535, dispatched, dispatch, Sharing::Greatest),
        row("maxComputeWorkgroupSizeX", 256, side, most(&|group| group.size[0]), Sharing::Greatest),
        row("maxComputeWorkgroupSizeY", 256, side, most(&|group| group.size[1]), Sharing::Greatest),
        row("maxComputeWorkgroupSizeZ", 64, side, most(&|group| group.size[2]), Sharing::Greatest),
        row("maxComputeInvocationsPerWorkgroup", 256, all, most(&invocations), Sharing::Greatest),
        row("maxComputeWorkgroupStorageSize", 16_384, memory, most(&|group| group.bytes), Sharing::Greatest),
    ]
}

fn texture_of(planned: &PlannedResource) -> Option<TextureFormat> {
    match planned.resource.element {
        Element::Texture(format) | Element::ValueTextures(format) | Element::EntryTextures(format) => Some(format),
        Element::Word | Element::Word64 | Element::Entry | Element::Value => None,
    }
}
