//! Builds the pipeline of each pass from the plan's state and the shaders' entry points.

use fragbuf_codegen::{EntryPoint, PlannedPass, Stage};
use fragbuf_templates::vocabulary::{Kind, Objects, Pass};

use crate::error_scope::in_error_scope;
use crate::fixed_function::{FixedFunction, fixed_functions};
use crate::{Checks, Code, Error, Module, Settings, Shaders, VertexBuffer};

/// The pipeline of one pass.
pub(crate) enum Pipeline {
    /// One, or one for each iteration of a loop if the sample mask depends on the iteration.
    Render(Vec<wgpu::RenderPipeline>),
    Compute(wgpu::ComputePipeline),
    /// The caller's draw function sets the pipeline.
    Caller,
}

/// Builds the pipelines of a renderer from these common inputs.
pub(crate) struct PipelineBuilder<'a> {
    pub(crate) device: &'a wgpu::Device,
    pub(crate) shaders: &'a Shaders,
    pub(crate) settings: &'a Settings,
    pub(crate) vertices: &'a [VertexBuffer],
    pub(crate) interleaved: VertexBuffer,
    /// The greatest iteration limit of any loop.
    pub(crate) max_iterations: u32,
}

/// A compiled module and its entry point.
struct Entry {
    module: wgpu::ShaderModule,
    name: String,
}

impl PipelineBuilder<'_> {
    /// Builds the pipeline of `pass` for a bind group of `layout`.
    pub(crate) async fn build(&self, pass: &PlannedPass, layout: &wgpu::BindGroupLayout) -> Result<Pipeline, Error> {
        let what = format!("the pipeline of pass `{}`", pass.name);
        let is_callers = pass.kind == Kind::Geometry && !self.shaders.modules.iter().any(|m| m.pass == pass.name);
        if is_callers {
            return Ok(Pipeline::Caller);
        }
        let mut groups: Vec<Option<&wgpu::BindGroupLayout>> = vec![None; self.shaders.group as usize];
        groups.push(Some(layout));
        let descriptor =
            wgpu::PipelineLayoutDescriptor { label: Some(&pass.name), bind_group_layouts: &groups, immediate_size: 0 };
        let layout = in_error_scope(self.device, &what, 0, || self.device.create_pipeline_layout(&descriptor)).await?;
        if let Kind::Compute { .. } = pass.kind {
            let entry = self.entry(pass, Stage::Compute).await?;
            let pipeline = in_error_scope(self.device, &what, 0, || self.compute(pass, &layout, &entry)).await?;
            return Ok(Pipeline::Compute(pipeline));
        }
        let vertex = self.entry(pass, Stage::Vertex).await?;
        let fragment = self.entry(pass, Stage::Fragment).await?;
        let mut pipelines = Vec::new();
        for fixed in fixed_functions(&self.shaders.plan, pass, self.settings.target, self.max_iterations)? {
            let make = || self.render(pass, &layout, (&vertex, &fragment), &fixed);
            let pipeline = in_error_scope(self.device, &what, 0, make).await;
            pipelines.push(pipeline.map_err(|error| unsupported_samples(error, pass, fixed.multisample.count))?);
        }
        Ok(Pipeline::Render(pipelines))
    }

    async fn entry(&self, pass: &Pass, stage: Stage) -> Result<Entry, Error> {
        let candidates = self.shaders.modules.iter().filter(|module| module.pass == pass.name);
        let found = candidates.flat_map(|m| m.entry_points.iter().map(move |e| (m, e))).find(|(_, e)| e.stage == stage);
        let Some((module, entry)) = found else {
            return Err(Error::MissingCode { pass: pass.name.clone(), stage: stage_name(stage) });
        };
        let what = format!("the {} shader of pass `{}`", stage_name(stage), pass.name);
        let compiled = in_error_scope(self.device, &what, 0, || self.module(module, entry)).await?;
        Ok(Entry { module: compiled, name: entry.name.clone() })
    }

    #[allow(
        unsafe_code,
        reason = "wgpu marks shaders without run-time checks as unsafe; each call gives the reason why it is sound"
    )]
    fn module(&self, module: &Module, entry: &EntryPoint) -> wgpu::ShaderModule {
        let label = Some(module.pass.as_str());
        match &module.code {
            Code::Wgsl(source) => {
                let source = wgpu::ShaderSource::Wgsl(source.as_str().into());
                let descriptor = wgpu::ShaderModuleDescriptor { label, source };
                let checked = match self.settings.checks {
                    Checks::Auto => self.shaders.has_user_functions(),
                    Checks::On => true,
                    Checks::Off => false,
                };
                if checked {
                    return self.device.create_shader_module(descriptor);
                }
                // SAFETY: indices in generated code stay below the buffer sizes, which the same plan's formulas give, and its
                // loops terminate. With user functions the caller has turned the checks off.
                unsafe { self.device.create_shader_module_trusted(descriptor, wgpu::ShaderRuntimeChecks::unchecked()) }
            }
            Code::SpirV(words) => {
                let point =
                    wgpu::PassthroughShaderEntryPoint { name: entry.name.as_str().into(), workgroup_size: (0, 0, 0) };
                let descriptor = wgpu::ShaderModuleDescriptorPassthrough {
                    label,
                    entry_points: std::slice::from_ref(&point).into(),
                    spirv: Some(words.as_slice().into()),
                    ..wgpu::ShaderModuleDescriptorPassthrough::default()
                };
                // SAFETY: the targets `spirv` or `glsl-vulkan` generated the words from a plan that naga validated, and the
                // layout comes from the same plan.
                unsafe { self.device.create_shader_module_passthrough(descriptor) }
            }
        }
    }

    fn compute(&self, pass: &Pass, layout: &wgpu::PipelineLayout, entry: &Entry) -> wgpu::ComputePipeline {
        self.device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label: Some(&pass.name),
            layout: Some(layout),
            module: &entry.module,
            entry_point: Some(&entry.name),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            cache: None,
        })
    }

    fn render(
        &self,
        pass: &Pass,
        layout: &wgpu::PipelineLayout,
        (vertex, fragment): (&Entry, &Entry),
        fixed: &FixedFunction,
    ) -> wgpu::RenderPipeline {
        let geometry = pass.kind == Kind::Geometry;
        // The runtime draws the boxes of objects, with its own vertex layout.
        let boxes = pass.objects == Objects::Boxes;
        let vertices = if boxes { std::slice::from_ref(&self.interleaved) } else { self.vertices };
        let buffers: Vec<Option<wgpu::VertexBufferLayout<'_>>> = vertices
            .iter()
            .filter(|_| geometry)
            .map(|buffer| {
                Some(wgpu::VertexBufferLayout {
                    array_stride: buffer.stride,
                    step_mode: buffer.step_mode,
                    attributes: &buffer.attributes,
                })
            })
            .collect();
        let primitive = if geometry && !boxes { self.settings.primitive } else { wgpu::PrimitiveState::default() };
        self.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some(&pass.name),
            layout: Some(layout),
            vertex: wgpu::VertexState {
                module: &vertex.module,
                entry_point: Some(&vertex.name),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                buffers: &buffers,
            },
            primitive,
            depth_stencil: fixed.depth_stencil.clone(),
            multisample: fixed.multisample,
            fragment: Some(wgpu::FragmentState {
                module: &fragment.module,
                entry_point: Some(&fragment.name),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                targets: &fixed.targets,
            }),
            multiview_mask: None,
            cache: None,
        })
    }
}

/// Replaces wgpu's validation error if a pass has a sample count that not every device supports.
fn unsupported_samples(error: Error, pass: &Pass, samples: u32) -> Error {
    match error {
        Error::Validation { .. } if ![1, 4].contains(&samples) => Error::Unsupported {
            what: format!("{samples} samples per pixel on this device, in the pass `{}`", pass.name),
            help:
                "every device supports 4; other counts need wgpu::Features::TEXTURE_ADAPTER_SPECIFIC_FORMAT_FEATURES and \
                   hardware support, and the CPU device supports 2, 4 and 8"
                    .to_owned(),
        },
        error => error,
    }
}

fn stage_name(stage: Stage) -> &'static str {
    match stage {
        Stage::Vertex => "vertex",
        Stage::Fragment => "fragment",
        Stage::Compute => "compute",
    }
}
