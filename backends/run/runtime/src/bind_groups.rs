//! Bind groups: one per pass and combination of flipped exchanges that the pass uses.

use fragbuf_codegen::ResourceId;

use crate::frame_blocks::FrameBlocks;
use crate::layout::Binding;
use crate::memory::Memory;
use crate::pipelines::{PipelineSet, PreparedPass};
use crate::texture::sampled_view;
use crate::uniform_buffers::UniformBuffers;

/// The objects that bind groups refer to.
pub(crate) struct BindGroupSources<'a> {
    pub(crate) device: &'a wgpu::Device,
    pub(crate) pipelines: &'a PipelineSet,
    pub(crate) uniforms: &'a UniformBuffers,
    pub(crate) frame_blocks: &'a FrameBlocks,
    pub(crate) memory: &'a Memory,
}

/// Creates the bind groups of every pass, indexed by pass and by the combination of flipped exchanges.
pub(crate) fn bind_groups(sources: &BindGroupSources<'_>) -> Vec<Vec<wgpu::BindGroup>> {
    let groups = |prepared: &PreparedPass| {
        let combinations = 0..1u32 << prepared.exchanges.len();
        let flipped = |combination: u32| {
            let bit = |(bit, number): (usize, &usize)| (combination >> bit & 1) << number;
            prepared.exchanges.iter().enumerate().map(bit).sum::<u32>()
        };
        combinations.map(|combination| bind_group(sources, prepared, flipped(combination))).collect()
    };
    sources.pipelines.passes.iter().map(groups).collect()
}

/// Returns the index among the bind groups of a pass, for a mask of flipped exchanges of the frame.
pub(crate) fn combination(prepared: &PreparedPass, flipped: u32) -> usize {
    let bit = |(bit, number): (usize, &usize)| (flipped >> number & 1) << bit;
    prepared.exchanges.iter().enumerate().map(bit).sum::<u32>() as usize
}

fn bind_group(sources: &BindGroupSources<'_>, prepared: &PreparedPass, flipped: u32) -> wgpu::BindGroup {
    let BindGroupSources { device, pipelines, uniforms, frame_blocks, memory } = sources;
    let physical = |index: usize| pipelines.plan.frame.physical(ResourceId(index), flipped).0;
    let view = |binding: &Binding| match *binding {
        Binding::Texture { index, .. } => memory.texture_to_bind(physical(index)).map(sampled_view),
        _ => None,
    };
    let views: Vec<Option<wgpu::TextureView>> = prepared.bindings.iter().map(view).collect();
    let buffer = |binding: &Binding| match *binding {
        Binding::Unused | Binding::Texture { .. } => &uniforms.filler,
        Binding::Frame => &frame_blocks.buffer,
        Binding::Uniforms => &uniforms.description,
        Binding::Camera => &uniforms.camera,
        Binding::Resource { index, .. } => memory.buffer_to_bind(physical(index)).unwrap_or(&uniforms.filler),
    };
    let bindings = (0..).zip(prepared.bindings.iter().zip(&views));
    let entries: Vec<wgpu::BindGroupEntry<'_>> = bindings
        .map(|(number, (binding, view))| {
            let size = (*binding == Binding::Frame).then(|| wgpu::BufferSize::new(frame_blocks.size)).flatten();
            let buffer =
                || wgpu::BindingResource::Buffer(wgpu::BufferBinding { buffer: buffer(binding), offset: 0, size });
            let resource = view.as_ref().map_or_else(buffer, wgpu::BindingResource::TextureView);
            wgpu::BindGroupEntry { binding: number, resource }
        })
        .collect();
    device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some(&prepared.pass.name),
        layout: &prepared.layout,
        entries: &entries,
    })
}
