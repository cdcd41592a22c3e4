//! The pipelines of a plan in program form, and of the passes over the frame in module form.
//!
//! Input: a plan, its files, the layouts of its passes. Output: pipelines by the index of the step and the sample mask. A geometry pass in
//! module form has none here, because its shader is the engine's.

use std::collections::BTreeMap;

use fragbuf_follow::manifest::{Action, File, Kind, Pass, Plan, VertexInput};
use fragbuf_follow::{Error, Values};

use super::layouts::{PassLayout, sample_formula};
use super::{names, scoped};
use crate::Passes;

/// The pipelines of a plan.
pub struct Pipelines {
    render: BTreeMap<(usize, u64), wgpu::RenderPipeline>,
    compute: BTreeMap<usize, wgpu::ComputePipeline>,
}

/// What all pipelines of a plan are created from.
pub struct Source<'a> {
    pub device: &'a wgpu::Device,
    pub plan: &'a Plan,
    pub values: &'a Values,
    pub files: &'a [File],
    pub passes: &'a Passes,
    pub layouts: &'a [Option<PassLayout>],
    /// The format of the caller's target.
    pub output: wgpu::TextureFormat,
}

/// The shaders of a pass.
struct Shaders<'a> {
    module: wgpu::ShaderModule,
    entry_points: BTreeMap<&'a str, &'a str>,
    layout: wgpu::PipelineLayout,
}

impl Pipelines {
    /// Creates all pipelines.
    pub fn new(source: &Source<'_>) -> Result<Self, Error> {
        let mut pipelines = Pipelines { render: BTreeMap::new(), compute: BTreeMap::new() };
        for (step, pass) in source.plan.passes() {
            let Some(shaders) = source.shaders(step, pass)? else { continue };
            if pass.kind == Kind::Compute {
                pipelines.compute.insert(step, source.compute(pass, &shaders)?);
                continue;
            }
            for mask in source.masks(step, pass)? {
                pipelines.render.insert((step, mask), source.render(pass, &shaders, mask)?);
            }
        }
        Ok(pipelines)
    }

    /// Returns the pipeline of a pass that draws, if this host has created it.
    pub fn render(&self, step: usize, mask: u64) -> Option<&wgpu::RenderPipeline> {
        self.render.get(&(step, mask))
    }

    /// Returns the pipeline of a pass that computes.
    pub fn compute(&self, step: usize) -> Option<&wgpu::ComputePipeline> {
        self.compute.get(&step)
    }
}

/// Returns the formula for the mask of the samples that a pass writes.
pub fn mask_formula(pass: &Pass) -> &str {
    pass.state.samples.as_ref().map_or("4294967295", |samples| &samples.mask)
}

impl Source<'_> {
    /// Compiles the file of a pass. `None`: it is a function for the shader of the engine.
    fn shaders(&self, step: usize, pass: &Pass) -> Result<Option<Shaders<'_>>, Error> {
        let of_pass = || self.files.iter().filter(|file| file.pass == pass.name);
        let file =
            of_pass().next().ok_or_else(|| Error(format!("the manifest has no file of the pass `{}`", pass.name)))?;
        if file.stage == "module" {
            return Ok(None);
        }
        let text = self.passes.file(&file.path)?;
        let source = wgpu::ShaderSource::Wgsl(text.into());
        let descriptor = wgpu::ShaderModuleDescriptor { label: Some(&file.path), source };
        let module = scoped(self.device, &file.path, || self.device.create_shader_module(descriptor))?;
        let layout = self.layouts.get(step).and_then(Option::as_ref);
        let layout = layout.ok_or_else(|| Error(format!("the pass `{}` has no layout", pass.name)))?;
        let mut groups = vec![None; layout.group as usize];
        groups.push(Some(&layout.layout));
        let descriptor =
            wgpu::PipelineLayoutDescriptor { label: Some(&pass.name), bind_group_layouts: &groups, immediate_size: 0 };
        let layout = scoped(self.device, &pass.name, || self.device.create_pipeline_layout(&descriptor))?;
        let entry_points = of_pass().map(|file| (file.stage.as_str(), file.entry_point.as_str())).collect();
        Ok(Some(Shaders { module, entry_points, layout }))
    }

    fn compute(&self, pass: &Pass, shaders: &Shaders<'_>) -> Result<wgpu::ComputePipeline, Error> {
        let descriptor = wgpu::ComputePipelineDescriptor {
            label: Some(&pass.name),
            layout: Some(&shaders.layout),
            module: &shaders.module,
            entry_point: shaders.entry_points.get("compute").copied(),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            cache: None,
        };
        scoped(self.device, &what(pass), || self.device.create_compute_pipeline(&descriptor))
    }

    fn render(&self, pass: &Pass, shaders: &Shaders<'_>, mask: u64) -> Result<wgpu::RenderPipeline, Error> {
        let attributes = attributes(&self.plan.vertex_inputs);
        let vertices = wgpu::VertexBufferLayout {
            array_stride: stride(&self.plan.vertex_inputs) as u64,
            step_mode: wgpu::VertexStepMode::Vertex,
            attributes: &attributes,
        };
        let count = self.values.value(sample_formula(self.plan, pass), 0)?;
        let (targets, is_geometry) = (names::targets(self.plan, pass, self.output)?, pass.kind == Kind::Geometry);
        let descriptor = wgpu::RenderPipelineDescriptor {
            label: Some(&pass.name),
            layout: Some(&shaders.layout),
            vertex: wgpu::VertexState {
                module: &shaders.module,
                entry_point: shaders.entry_points.get("vertex").copied(),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                buffers: if is_geometry { std::slice::from_ref(&vertices) } else { &[] },
            },
            primitive: wgpu::PrimitiveState::default(),
            depth_stencil: names::depth_stencil(self.plan, pass)?,
            multisample: wgpu::MultisampleState { count: count as u32, mask, alpha_to_coverage_enabled: false },
            fragment: Some(wgpu::FragmentState {
                module: &shaders.module,
                entry_point: shaders.entry_points.get("fragment").copied(),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                targets: &targets,
            }),
            multiview_mask: None,
            cache: None,
        };
        scoped(self.device, &what(pass), || self.device.create_render_pipeline(&descriptor))
    }

    /// Returns the sample masks of a pass in all iterations of the loop around it: a mask is part of a pipeline.
    fn masks(&self, step: usize, pass: &Pass) -> Result<Vec<u64>, Error> {
        let around = self.plan.steps.iter().take(step).rev().find_map(|before| match &before.action {
            Action::Loop { max_iterations, end } if *end > step => Some(max_iterations),
            _ => None,
        });
        let most = around.filter(|_| pass.state.samples.is_some()).map_or(Ok(1), |most| self.values.value(most, 0))?;
        let mut masks = Vec::new();
        // There are at most 32 samples, so at most 32 iterations have masks of their own.
        for iteration in 0..most.clamp(1, 32) {
            let mask = self.values.value(mask_formula(pass), iteration)?;
            if !masks.contains(&mask) {
                masks.push(mask);
            }
        }
        Ok(masks)
    }
}

fn what(pass: &Pass) -> String {
    format!("the pipeline of the pass `{}`", pass.name)
}

/// The bytes of a vertex: its inputs one behind the other.
pub fn stride(inputs: &[VertexInput]) -> usize {
    inputs.iter().map(|input| 4 * input.components()).sum()
}

fn attributes(inputs: &[VertexInput]) -> Vec<wgpu::VertexAttribute> {
    let mut offset = 0;
    let attribute = |input: &VertexInput| {
        let at = offset;
        offset += 4 * input.components() as u64;
        let format = match (input.component_type(), input.components()) {
            ("u32", 1) => wgpu::VertexFormat::Uint32,
            ("i32", 1) => wgpu::VertexFormat::Sint32,
            ("f32", 1) => wgpu::VertexFormat::Float32,
            (_, 2) => wgpu::VertexFormat::Float32x2,
            (_, 3) => wgpu::VertexFormat::Float32x3,
            _ => wgpu::VertexFormat::Float32x4,
        };
        wgpu::VertexAttribute { format, offset: at, shader_location: input.location }
    };
    inputs.iter().map(attribute).collect()
}
