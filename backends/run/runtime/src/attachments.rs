//! What a render pass is attached to, and what its attachments hold when it begins.
//!
//! In: a pass, the renderer's textures, clears that are still to be done. Out: wgpu's attachments. A clear costs no pass of
//! its own: the first pass that is attached to the texture begins with it.

use std::collections::BTreeMap;

use fragbuf_codegen::{PlannedPass, ResourceId};
use fragbuf_templates::vocabulary::Access;

use crate::texture::{OUTPUT, color_of, depth_of};
use crate::{Output, Renderer};

/// Words that textures are to be cleared to, by physical resource.
pub(crate) type Clears = BTreeMap<ResourceId, u32>;

/// The views that a pass is attached to. They must outlive its descriptor.
pub(crate) struct Attachments {
    colors: Vec<Option<(wgpu::TextureView, wgpu::Operations<wgpu::Color>)>>,
    depth_stencil: Option<DepthStencil>,
}

struct DepthStencil {
    view: wgpu::TextureView,
    depth: Option<wgpu::Operations<f32>>,
    stencil: Option<wgpu::Operations<u32>>,
}

/// Whether the caller's output has been written in this frame, and must not be cleared again.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Written {
    No,
    Yes,
}

impl Attachments {
    /// Those of `pass`, where the exchanges of the bit mask `flipped` are flipped. Clears that they begin with are taken out of
    /// `clears`.
    pub(crate) fn of(
        renderer: &Renderer,
        (pass, flipped): (&PlannedPass, u32),
        output: &Output<'_>,
        (clears, written): (&mut Clears, &mut Written),
    ) -> Self {
        let state = &pass.state;
        let mut colors = Vec::new();
        for target in &state.targets {
            if target.resource == OUTPUT {
                let load = if *written == Written::Yes { wgpu::LoadOp::Load } else { output.load };
                *written = Written::Yes;
                colors.push(Some((output.view.clone(), stored(load))));
                continue;
            }
            colors.push(texture(renderer, &target.resource, flipped).map(|(id, texture)| {
                let clear = clears.remove(&id).map(|word| color_of(texture.format(), word));
                (view(texture), stored(clear.map_or(wgpu::LoadOp::Load, wgpu::LoadOp::Clear)))
            }));
        }
        let tested = state.depth.as_ref().map(|depth| &depth.resource);
        let tested = tested.or(state.stencil.as_ref().map(|stencil| &stencil.resource));
        let only_read = state.stencil.is_none() && state.depth.as_ref().is_some_and(|depth| !depth.write);
        let mut depth_stencil = tested.and_then(|name| DepthStencil::of(renderer, (name, flipped), clears));
        if let Some(attached) = depth_stencil.as_mut().filter(|attached| only_read && attached.is_loaded()) {
            // Without operations an attachment is read alone: the caller's own texture may be read elsewhere meanwhile.
            (attached.depth, attached.stencil) = (None, None);
        }
        if colors.is_empty() && depth_stencil.is_none() {
            // WebGPU refuses a pass without attachments.
            let ops =
                wgpu::Operations { load: wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT), store: wgpu::StoreOp::Discard };
            colors.push(renderer.sized.dummy(renderer.plan(), pass).map(|view| (view, ops)));
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
    /// Whether it begins with what it holds.
    fn is_loaded(&self) -> bool {
        self.depth.is_none_or(|depth| matches!(depth.load, wgpu::LoadOp::Load))
    }

    fn of(renderer: &Renderer, (name, flipped): (&str, u32), clears: &mut Clears) -> Option<Self> {
        let (id, texture) = texture(renderer, name, flipped)?;
        Some(Self::cleared(texture, clears.remove(&id)))
    }

    /// A texture that begins with being cleared to a word, or with what it holds.
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

/// Clears what `pass` reads, and no pass has begun with clearing.
pub(crate) fn clear_sampled(
    renderer: &Renderer,
    encoder: &mut wgpu::CommandEncoder,
    (pass, flipped): (&PlannedPass, u32),
    clears: &mut Clears,
) {
    for usage in pass.uses.iter().filter(|usage| usage.access == Access::Sampled) {
        if let Some((id, _)) = texture(renderer, &usage.resource, flipped) {
            clear_now(renderer, encoder, id, clears);
        }
    }
}

/// Clears a texture by a pass of its own, if that is still to be done.
pub(crate) fn clear_now(
    renderer: &Renderer,
    encoder: &mut wgpu::CommandEncoder,
    resource: ResourceId,
    clears: &mut Clears,
) {
    let Some(texture) = renderer.sized.memory.texture(resource.0) else { return };
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

/// The physical texture that a name stands for.
fn texture<'a>(renderer: &'a Renderer, name: &str, flipped: u32) -> Option<(ResourceId, &'a wgpu::Texture)> {
    let plan = renderer.plan();
    let id = plan.frame.physical(plan.resource_id(name)?, flipped);
    Some((id, renderer.sized.memory.texture(id.0)?))
}

fn view(texture: &wgpu::Texture) -> wgpu::TextureView {
    texture.create_view(&wgpu::TextureViewDescriptor::default())
}

fn stored<V>(load: wgpu::LoadOp<V>) -> wgpu::Operations<V> {
    wgpu::Operations { load, store: wgpu::StoreOp::Store }
}
