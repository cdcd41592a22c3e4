//! The passes of a frame: attachments, bind groups, dispatches and draws.

use fragbuf_follow::manifest::{BindingKind, Kind, Objects, Pass};
use fragbuf_follow::{Call, Error};

use super::frame::Frame;
use super::layouts::{Attachments, sample_formula};
use super::memory::filled;
use super::names;
use super::pipelines::mask_formula;

/// What draws the scene in geometry passes.
pub trait Geometry {
    /// Draws the objects of a pass. Its bind group, its pipeline if this host has one, and its scissor rectangle are set.
    fn draw(&self, draw: &GeometryDraw<'_>, render: wgpu::RenderPass<'static>) -> Result<(), Error>;
}

/// A geometry pass that runs.
pub struct GeometryDraw<'a> {
    /// The pass.
    pub pass: &'a Pass,
    /// What the frame adds: the index of the step, and the objects to draw.
    pub call: &'a Call<'a>,
    /// Whether each object's box is drawn, with an occlusion query of the object's place among the drawn. Otherwise all draws are in
    /// query 0, if samples are counted.
    pub is_boxes: bool,
}

impl Frame<'_, '_> {
    /// Runs a pass that computes.
    pub fn dispatch(&mut self, pass: &Pass, call: &Call<'_>) -> Result<(), Error> {
        let group = self.bind_group(pass, call)?;
        let indirect = self.indirect(pass, call)?;
        let most = self.gpu.device.limits().max_compute_workgroups_per_dimension;
        let [x, y, z] = call.groups(pass, [most; 3])?;
        let pipeline = self.pipelines.compute(call.step).cloned().ok_or_else(|| no_pipeline(pass))?;
        let descriptor = wgpu::ComputePassDescriptor { label: Some(&pass.name), timestamp_writes: None };
        let mut compute = self.encoder().begin_compute_pass(&descriptor);
        compute.set_pipeline(&pipeline);
        compute.set_bind_group(group.0, &group.1, &[]);
        match indirect {
            Some(arguments) => compute.dispatch_workgroups_indirect(&arguments, 0),
            None => compute.dispatch_workgroups(x, y, z),
        }
        Ok(())
    }

    /// Runs a pass that draws.
    pub fn render(&mut self, pass: &Pass, call: &Call<'_>) -> Result<(), Error> {
        let is_boxes = matches!(pass.objects, Objects::Boxes);
        let (index, group) = self.bind_group(pass, call)?;
        let indirect = self.indirect(pass, call)?;
        let pipeline = self.pipelines.render(call.step, call.value(mask_formula(pass))?).cloned();
        let reference = pass.state.stencil.as_ref().map(|stencil| call.value(&stencil.reference)).transpose()?;
        let queries = self.queries(pass, call, is_boxes);
        let [width, height] = self.size;
        let mut render = self.begin(pass, call, queries.as_ref())?;
        if let Some(pipeline) = &pipeline {
            render.set_pipeline(pipeline);
        }
        if let Some(reference) = reference {
            render.set_stencil_reference(reference as u32);
        }
        render.set_bind_group(index, &group, &[]);
        render.set_scissor_rect(0, 0, width, height);
        if pass.kind == Kind::Geometry {
            return self.geometry.draw(&GeometryDraw { pass, call, is_boxes }, render);
        }
        pipeline.ok_or_else(|| no_pipeline(pass))?;
        match indirect {
            Some(arguments) => render.draw_indirect(&arguments, 0),
            None => render.draw(0..3, 0..1),
        }
        Ok(())
    }

    /// Creates the queries of a pass whose samples are counted.
    fn queries(&mut self, pass: &Pass, call: &Call<'_>, is_boxes: bool) -> Option<wgpu::QuerySet> {
        let count = if is_boxes { call.objects.len() as u32 } else { 1 };
        if !(call.is_queried || is_boxes) || count == 0 {
            self.queries.remove(&pass.name);
            return None;
        }
        let ty = wgpu::QueryType::Occlusion;
        let set = self.gpu.device.create_query_set(&wgpu::QuerySetDescriptor { label: None, ty, count });
        self.queries.insert(pass.name.clone(), (set.clone(), count));
        Some(set)
    }

    /// Begins the render pass of a pass, with its attachments.
    fn begin(
        &mut self,
        pass: &Pass,
        call: &Call<'_>,
        queries: Option<&wgpu::QuerySet>,
    ) -> Result<wgpu::RenderPass<'static>, Error> {
        let attachments = Attachments::of(self.plan, pass);
        let whole = |texture: &wgpu::Texture| texture.create_view(&wgpu::TextureViewDescriptor::default());
        let mut colors = Vec::new();
        for name in &attachments.colors {
            let is_output = name == "output";
            let view =
                if is_output { self.output.view.clone() } else { whole(self.memory.texture(call.resource(name))?) };
            // The first pass that draws into the caller's target clears it.
            let clear = if is_output { self.output.clear.take() } else { None };
            colors.push((view, clear.map_or(wgpu::LoadOp::Load, wgpu::LoadOp::Clear)));
        }
        if attachments.is_empty() {
            let samples = call.value(sample_formula(self.plan, pass))? as u32;
            colors.push((self.memory.placeholder(samples, self.size), wgpu::LoadOp::Load));
        }
        let depth =
            attachments.depth.as_ref().map(|name| self.memory.texture(call.resource(name))).transpose()?.cloned();
        let depth_view = depth.as_ref().map(whole);
        let store = wgpu::StoreOp::Store;
        let color = |(view, load)| {
            let ops = wgpu::Operations { load, store };
            Some(wgpu::RenderPassColorAttachment { view, depth_slice: None, resolve_target: None, ops })
        };
        let colors: Vec<_> = colors.iter().map(|(view, load)| color((view, *load))).collect();
        let has_stencil = depth.is_some_and(|texture| texture.format().has_stencil_aspect());
        // A shader may read a texture whose attachment is read-only.
        let is_written = !attachments.is_read_only;
        let depth_stencil_attachment = depth_view.as_ref().map(|view| wgpu::RenderPassDepthStencilAttachment {
            view,
            depth_ops: is_written.then_some(wgpu::Operations { load: wgpu::LoadOp::Load, store }),
            stencil_ops: (is_written && has_stencil).then_some(wgpu::Operations { load: wgpu::LoadOp::Load, store }),
        });
        let descriptor = wgpu::RenderPassDescriptor {
            label: Some(&pass.name),
            color_attachments: &colors,
            depth_stencil_attachment,
            occlusion_query_set: queries,
            ..Default::default()
        };
        Ok(self.encoder().begin_render_pass(&descriptor).forget_lifetime())
    }

    /// Creates the bind group of a pass. Returns it behind its number.
    fn bind_group(&mut self, pass: &Pass, call: &Call<'_>) -> Result<(u32, wgpu::BindGroup), Error> {
        let layout = self.layouts.get(call.step).and_then(Option::as_ref);
        let layout = layout.ok_or_else(|| no_pipeline(pass))?;
        let mut blocks = Vec::new();
        let mut views = Vec::new();
        for binding in &layout.bindings {
            let name = call.resource(&binding.name);
            match binding.kind {
                BindingKind::Uniform => {
                    let block = self.plan.uniform_blocks.iter().find(|block| block.name == binding.name);
                    let block = block.ok_or_else(|| Error(format!("there is no uniform block `{}`", binding.name)))?;
                    let bytes = call.block(block, self.uniforms, &self.view_projection)?;
                    blocks.push(filled(&self.gpu.device, wgpu::BufferUsages::UNIFORM, &bytes));
                }
                BindingKind::Texture => {
                    let aspect = names::aspect(binding.aspect.as_deref().unwrap_or("all"))?;
                    let descriptor = wgpu::TextureViewDescriptor { aspect, ..Default::default() };
                    views.push(self.memory.texture(name)?.create_view(&descriptor));
                }
                BindingKind::Storage | BindingKind::ReadOnlyStorage => {}
            }
        }
        let (mut blocks, mut views) = (blocks.iter(), views.iter());
        let mut entries = Vec::new();
        for binding in &layout.bindings {
            let resource = match binding.kind {
                BindingKind::Uniform => blocks.next().map(wgpu::Buffer::as_entire_binding),
                BindingKind::Texture => views.next().map(wgpu::BindingResource::TextureView),
                BindingKind::Storage | BindingKind::ReadOnlyStorage => {
                    Some(self.memory.buffer(call.resource(&binding.name))?.as_entire_binding())
                }
            };
            entries.extend(resource.map(|resource| wgpu::BindGroupEntry { binding: binding.binding, resource }));
        }
        let descriptor =
            wgpu::BindGroupDescriptor { label: Some(&pass.name), layout: &layout.layout, entries: &entries };
        Ok((layout.group, self.gpu.device.create_bind_group(&descriptor)))
    }

    /// Returns the buffer with the arguments of a pass, if it has any.
    fn indirect(&self, pass: &Pass, call: &Call<'_>) -> Result<Option<wgpu::Buffer>, Error> {
        let name = pass.uses.iter().find(|(_, access)| *access == "indirect").map(|(name, _)| name);
        name.map(|name| self.memory.buffer(call.resource(name)).cloned()).transpose()
    }
}

fn no_pipeline(pass: &Pass) -> Error {
    Error(format!("the pass `{}` has no pipeline: generate the files again", pass.name))
}
