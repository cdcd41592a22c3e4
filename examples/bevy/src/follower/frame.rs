//! A frame that is under way: the steps that are no passes.

use std::collections::BTreeMap;

use fragbuf_follow::manifest::{Kind, Pass, Plan};
use fragbuf_follow::{Call, Device, Error, Uniforms, Values};
use serde_json::Value;

use super::drawing::Geometry;
use super::layouts::PassLayout;
use super::memory::Memory;
use super::pipelines::Pipelines;
use super::{Gpu, Output};

/// A frame, and what it records into.
pub struct Frame<'a, 'o> {
    pub gpu: &'a Gpu,
    pub plan: &'a Plan,
    pub layouts: &'a [Option<PassLayout>],
    pub pipelines: &'a Pipelines,
    pub uniforms: &'a Uniforms,
    pub memory: &'a mut Memory,
    pub size: [u32; 2],
    pub output: Output<'o>,
    pub geometry: &'a dyn Geometry,
    pub view_projection: [f32; 16],
    /// What has been recorded since the last submission.
    pub encoder: Option<wgpu::CommandEncoder>,
    /// The queries of the latest run of each pass whose samples are counted, and their number.
    pub queries: BTreeMap<String, (wgpu::QuerySet, u32)>,
}

impl Frame<'_, '_> {
    pub fn encoder(&mut self) -> &mut wgpu::CommandEncoder {
        let device = &self.gpu.device;
        self.encoder.get_or_insert_with(|| {
            device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some("fragment buffer") })
        })
    }

    /// Ends the frame. Returns what has not been submitted.
    pub fn finish(mut self) -> wgpu::CommandBuffer {
        self.encoder();
        let device = &self.gpu.device;
        let encoder = self.encoder.take();
        let encoder =
            encoder.unwrap_or_else(|| device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label: None }));
        encoder.finish()
    }

    /// Submits what has been recorded.
    pub fn submit(&mut self) {
        if let Some(encoder) = self.encoder.take() {
            (self.output.submit)(encoder.finish());
        }
    }

    /// Clears a texture by a pass without draws.
    fn clear_texture(&mut self, name: &str, texel: &Value) -> Result<(), Error> {
        let view = self.memory.texture(name)?.create_view(&wgpu::TextureViewDescriptor::default());
        let has_stencil = self.memory.texture(name)?.format().has_stencil_aspect();
        let is_depth = self.memory.texture(name)?.format().has_depth_aspect();
        let channel = |index: usize| texel.get(index).and_then(Value::as_f64).unwrap_or(0.0);
        let color = wgpu::Color { r: channel(0), g: channel(1), b: channel(2), a: channel(3) };
        let depth = texel.get("depth").and_then(Value::as_f64).unwrap_or(1.0) as f32;
        let stencil = texel.get("stencil").and_then(Value::as_u64).unwrap_or(0) as u32;
        let store = wgpu::StoreOp::Store;
        let color = wgpu::RenderPassColorAttachment {
            view: &view,
            depth_slice: None,
            resolve_target: None,
            ops: wgpu::Operations { load: wgpu::LoadOp::Clear(color), store },
        };
        let tested = wgpu::RenderPassDepthStencilAttachment {
            view: &view,
            depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(depth), store }),
            stencil_ops: has_stencil.then_some(wgpu::Operations { load: wgpu::LoadOp::Clear(stencil), store }),
        };
        let colors = [Some(color)];
        drop(self.encoder().begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("clear"),
            color_attachments: if is_depth { &[] } else { &colors },
            depth_stencil_attachment: is_depth.then_some(tested),
            ..Default::default()
        }));
        Ok(())
    }
}

impl Device for Frame<'_, '_> {
    fn clear(&mut self, resource: &str, value: u32, texel: Option<&Value>) -> Result<(), Error> {
        if let Some(texel) = texel {
            return self.clear_texture(resource, texel);
        }
        self.encoder();
        match &mut self.encoder {
            Some(encoder) => self.memory.clear_buffer(encoder, resource, value),
            None => Ok(()),
        }
    }

    fn copy(&mut self, from: &str, to: &str) -> Result<(), Error> {
        if self.plan.resource(from).is_some_and(|resource| resource.texture.is_some()) {
            let (source, target) = (self.memory.texture(from)?.clone(), self.memory.texture(to)?.clone());
            let size = source.size();
            self.encoder().copy_texture_to_texture(source.as_image_copy(), target.as_image_copy(), size);
            return Ok(());
        }
        let (source, target) = (self.memory.buffer(from)?.clone(), self.memory.buffer(to)?.clone());
        let bytes = source.size().min(target.size());
        self.encoder().copy_buffer_to_buffer(&source, 0, &target, 0, bytes);
        Ok(())
    }

    fn pass(&mut self, pass: &Pass, call: &Call<'_>) -> Result<(), Error> {
        match pass.kind {
            Kind::Compute => self.dispatch(pass, call),
            Kind::Geometry | Kind::Fullscreen => self.render(pass, call),
        }
    }

    fn words(&mut self, resource: &str, first: u64, count: u64) -> Result<Vec<u32>, Error> {
        self.read_words(resource, first, count)
    }

    fn samples(&mut self, pass: &str) -> Result<Vec<u64>, Error> {
        self.read_samples(pass)
    }

    fn allocate(&mut self, values: &Values) -> Result<(), Error> {
        self.memory.allocate(self.plan, values, self.size)
    }
}
