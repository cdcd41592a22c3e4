//! The attachments of a render pass, and their load operations.
//!
//! Input: a pass, the textures of the frame and the pending clears. Output: wgpu's attachments. A clear needs no extra pass: the
//! next pass with the texture as attachment begins with the clear.

use std::collections::BTreeMap;

use fragbuf_codegen::{Plan, PlannedPass, ResourceId};
use fragbuf_templates::vocabulary::Access;

use crate::draw::Output;
use crate::memory::Memory;
use crate::placeholder::PlaceholderAttachment;
use crate::texture::{OUTPUT, color_of, depth_of};

/// The words of pending clears of textures, by physical resource.
pub(crate) type Clears = BTreeMap<ResourceId, u32>;

/// The textures that a pass can have as attachments.
pub(crate) struct Textures<'a> {
    pub(crate) plan: &'a Plan,
    pub(crate) memory: &'a Memory,
    pub(crate) placeholders: &'a [PlaceholderAttachment],
}

/// The attachments of a pass. They must outlive its descriptor.
pub(crate) struct Attachments {
    colors: Vec<Option<(wgpu::TextureView, wgpu::Operations<wgpu::Color>)>>,
    depth_stencil: Option<DepthStencil>,
}

struct DepthStencil {
    view: wgpu::TextureView,
    depth: Option<wgpu::Operations<f32>>,
    stencil: Option<wgpu::Operations<u32>>,
}

/// Whether the frame has written the caller's output, which must not be cleared again then.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum OutputState {
    #[default]
    Untouched,
    Written,
}

impl Attachments {
    /// Returns the attachments of `pass`, where the exchanges of the bit mask `flipped` are flipped. Clears that the pass begins
    /// with are removed from `clears`.
    pub(crate) fn of(
        textures: &Textures<'_>,
        (pass, flipped): (&PlannedPass, u32),
        output: &Output<'_>,
        (clears, output_state): (&mut Clears, &mut OutputState),
    ) -> Self {
        let state = &pass.state;
        let mut colors = Vec::new();
        for target in &state.targets {
            if target.resource == OUTPUT {
                let load = if *output_state == OutputState::Written { wgpu::LoadOp::Load } else { output.load };
                *output_state = OutputState::Written;
                colors.push(Some((output.view.clone(), stored(load))));
                continue;
            }
            colors.push(textures.get(&target.resource, flipped).map(|(id, texture)| {
                let clear = clears.remove(&id).map(|word| color_of(texture.format(), word));
                (view(texture), stored(clear.map_or(wgpu::LoadOp::Load, wgpu::LoadOp::Clear)))
            }));
        }
        let tested = state.depth.as_ref().map(|depth| &depth.resource);
        let tested = tested.or(state.stencil.as_ref().map(|stencil| &stencil.resource));
        let only_read = state.stencil.is_none() && state.depth.as_ref().is_some_and(|depth| !depth.write);
        let mut depth_stencil = tested.and_then(|name| DepthStencil::of(textures, (name, flipped), clears));
        if let Some(attached) = depth_stencil.as_mut().filter(|attached| only_read && attached.is_loaded()) {
            // An attachment without operations is read-only, so that a shader may read an external texture in the same pass.
            (attached.depth, attached.stencil) = (None, None);
        }
        if colors.is_empty() && depth_stencil.is_none() {
            let ops =
                wgpu::Operations { load: wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT), store: wgpu::StoreOp::Discard };
            let view = PlaceholderAttachment::view(textures.placeholders, textures.plan, pass);
            colors.push(view.map(|view| (view, ops)));
        }
        Attachments { colors, depth_stencil }
    }

    pub(crate) fn colors(&self) -> Vec<Option<wgpu::RenderPassColorAttachment<'_>>> {
        let mut attachments = Vec::with_capacity(self.colors.len());
        for color in &self.colors {
            attachments.push(color.as_ref().map(|(view, ops)| wgpu::RenderPassColorAttachment {
                view,
                depth_slice: None,
                resolve_target: None,
                ops: *ops,
            }));
        }
        attachments
    }

    pub(crate) fn depth_stencil(&self) -> Option<wgpu::RenderPassDepthStencilAttachment<'_>> {
        self.depth_stencil.as_ref().map(|attached| wgpu::RenderPassDepthStencilAttachment {
            view: &attached.view,
            depth_ops: attached.depth,
            stencil_ops: attached.stencil,
        })
    }
}

impl DepthStencil {
    /// Whether the pass begins with the previous content.
    fn is_loaded(&self) -> bool {
        self.depth.is_none_or(|depth| matches!(depth.load, wgpu::LoadOp::Load))
    }

    fn of(textures: &Textures<'_>, (name, flipped): (&str, u32), clears: &mut Clears) -> Option<Self> {
        let (id, texture) = textures.get(name, flipped)?;
        Some(Self::cleared(texture, clears.remove(&id)))
    }

    /// Returns an attachment that is cleared to a word, or keeps its previous content.
    fn cleared(texture: &wgpu::Texture, clear: Option<u32>) -> Self {
        let format = texture.format();
        let depth = clear.map_or(wgpu::LoadOp::Load, |word| wgpu::LoadOp::Clear(depth_of(format, word)));
        let stencil = clear.map_or(wgpu::LoadOp::Load, |word| wgpu::LoadOp::Clear(word & 0xff));
        DepthStencil {
            view: view(texture),
            depth: format.has_depth_aspect().then_some(stored(depth)),
            stencil: format.has_stencil_aspect().then_some(stored(stencil)),
        }
    }
}

impl<'a> Textures<'a> {
    /// Records the pending clears of textures that `pass` samples.
    pub(crate) fn clear_sampled(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        (pass, flipped): (&PlannedPass, u32),
        clears: &mut Clears,
    ) {
        for usage in pass.uses.iter().filter(|usage| usage.access == Access::Sampled) {
            if let Some((id, _)) = self.get(&usage.resource, flipped) {
                self.clear_now(encoder, id, clears);
            }
        }
    }

    /// Records the pending clear of a texture, if there is one, in a pass without draws.
    pub(crate) fn clear_now(&self, encoder: &mut wgpu::CommandEncoder, resource: ResourceId, clears: &mut Clears) {
        let Some(texture) = self.memory.texture(resource.0) else { return };
        let Some(word) = clears.remove(&resource) else { return };
        let attached = match texture.format().is_depth_stencil_format() {
            true => Attachments { colors: Vec::new(), depth_stencil: Some(DepthStencil::cleared(texture, Some(word))) },
            false => {
                let load = wgpu::LoadOp::Clear(color_of(texture.format(), word));
                Attachments { colors: vec![Some((view(texture), stored(load)))], depth_stencil: None }
            }
        };
        drop(encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("fragbuf clear"),
            color_attachments: &attached.colors(),
            depth_stencil_attachment: attached.depth_stencil(),
            ..wgpu::RenderPassDescriptor::default()
        }));
    }

    /// Returns the physical texture of a name.
    fn get(&self, name: &str, flipped: u32) -> Option<(ResourceId, &'a wgpu::Texture)> {
        let id = self.plan.frame.physical(self.plan.resource_id(name)?, flipped);
        Some((id, self.memory.texture(id.0)?))
    }
}

fn view(texture: &wgpu::Texture) -> wgpu::TextureView {
    texture.create_view(&wgpu::TextureViewDescriptor::default())
}

fn stored<V>(load: wgpu::LoadOp<V>) -> wgpu::Operations<V> {
    wgpu::Operations { load, store: wgpu::StoreOp::Store }
}
