//! Pipelines: one per pass, from the plan's state and the shaders' entry points.

use fragbuf_codegen::{EntryPoint, PlannedPass, Stage};
use fragbuf_templates::vocabulary::{Kind, Objects, Pass};

use crate::fixed_function::{FixedFunction, fixed_functions};
use crate::scope::scoped;
use crate::{Checks, Code, Error, Module, Settings, Shaders, VertexBuffer};

/// The pipeline of one pass.
pub(crate) enum Pipeline {
    /// One, or one for each round of a loop where the sample mask changes with it.
    Render(Vec<wgpu::RenderPipeline>),
    Compute(wgpu::ComputePipeline),
    /// The caller's draw function sets its own.
    Caller,
}

/// The format of the attachment that passes without a target have: WebGPU refuses a render pass without any.
pub(crate) const DUMMY_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::R8Unorm;

/// What all pipelines of a renderer share.
pub(crate) struct Maker<'a> {
    pub(crate) device: &'a wgpu::Device,
    pub(crate) shaders: &'a Shaders,
    pub(crate) settings: &'a Settings,
    pub(crate) vertices: &'a [VertexBuffer],
    pub(crate) interleaved: VertexBuffer,
    /// The most iterations of any loop.
    pub(crate) rounds: u32,
}

/// A compiled module and its entry point.
struct Entry {
    module: wgpu::ShaderModule,
    name: String,
}

impl Maker<'_> {
    /// The pipeline of `pass` over the bind group of `layout`.
    pub(crate) async fn make(&self, pass: &PlannedPass, layout: &wgpu::BindGroupLayout) -> Result<Pipeline, Error> {
        let what = format!("the pipeline of pass `{}`", pass.anchor);
        let is_callers = pass.kind == Kind::Geometry && !self.shaders.modules.iter().any(|m| m.pass == pass.anchor);
        if is_callers {
            return Ok(Pipeline::Caller);
        }
        let mut groups: Vec<Option<&wgpu::BindGroupLayout>> = vec![None; self.shaders.group as usize];
        groups.push(Some(layout));
        let descriptor = wgpu::PipelineLayoutDescriptor {
            label: Some(&pass.anchor),
            bind_group_layouts: &groups,
            immediate_size: 0,
        };
        let layout = scoped(self.device, &what, 0, || self.device.create_pipeline_layout(&descriptor)).await?;
        if let Kind::Compute { .. } = pass.kind {
            let entry = self.entry(pass, Stage::Compute).await?;
            let pipeline = scoped(self.device, &what, 0, || self.compute(pass, &layout, &entry)).await?;
            return Ok(Pipeline::Compute(pipeline));
        }
        let vertex = self.entry(pass, Stage::Vertex).await?;
        let fragment = self.entry(pass, Stage::Fragment).await?;
        let mut pipelines = Vec::new();
        for fixed in fixed_functions(&self.shaders.plan, pass, self.settings.target, self.rounds)? {
            let make = || self.render(pass, &layout, (&vertex, &fragment), &fixed);
            let made = scoped(self.device, &what, 0, make).await;
            pipelines.push(made.map_err(|error| unusual_samples(error, pass, fixed.multisample.count))?);
        }
        Ok(Pipeline::Render(pipelines))
    }

    async fn entry(&self, pass: &Pass, stage: Stage) -> Result<Entry, Error> {
        let candidates = self.shaders.modules.iter().filter(|module| module.pass == pass.anchor);
        let found = candidates.flat_map(|m| m.entry_points.iter().map(move |e| (m, e))).find(|(_, e)| e.stage == stage);
        let Some((module, entry)) = found else {
            return Err(Error::MissingCode { pass: pass.anchor.clone(), stage: stage_name(stage) });
        };
        let what = format!("the {} shader of pass `{}`", stage_name(stage), pass.anchor);
        let compiled = scoped(self.device, &what, 0, || self.module(module, entry)).await?;
        Ok(Entry { module: compiled, name: entry.name.clone() })
    }

    #[allow(unsafe_code, reason = "wgpu marks code that it does not guard at run time; each site says why it may")]
    fn module(&self, module: &Module, entry: &EntryPoint) -> wgpu::ShaderModule {
        let label = Some(module.pass.as_str());
        match &module.code {
            Code::Wgsl(text) => {
                let source = wgpu::ShaderSource::Wgsl(text.as_str().into());
                let descriptor = wgpu::ShaderModuleDescriptor { label, source };
                let checked = match self.settings.checks {
                    Checks::Auto => self.shaders.has_user_functions(),
                    Checks::On => true,
                    Checks::Off => false,
                };
                if checked {
                    return self.device.create_shader_module(descriptor);
                }
                // SAFETY: indices in generated code stay below the sizes that the same plan's formulas give the buffers,
                // and its loops end; the caller asked for it where the description's author wrote code of their own.
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
                // SAFETY: the words are what the targets `spirv` or `glsl-vulkan` made of a plan that naga validated, and
                // the layout that they are used with is made from the same plan.
                unsafe { self.device.create_shader_module_passthrough(descriptor) }
            }
        }
    }

    fn compute(&self, pass: &Pass, layout: &wgpu::PipelineLayout, entry: &Entry) -> wgpu::ComputePipeline {
        self.device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label: Some(&pass.anchor),
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
        // Boxes of objects are drawn by the runtime, whatever the caller's vertices are like.
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
            label: Some(&pass.anchor),
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

/// What a refusal is about where a pass has another number of samples than every device has.
fn unusual_samples(error: Error, pass: &Pass, samples: u32) -> Error {
    match error {
        Error::Validation { .. } if ![1, 4].contains(&samples) => Error::Unsupported {
            what: format!("{samples} samples per pixel on this device, in the pass `{}`", pass.anchor),
            hint:
                "every device has 4; other numbers need wgpu::Features::TEXTURE_ADAPTER_SPECIFIC_FORMAT_FEATURES and \
                   hardware that has them, and the CPU device has 2, 4 and 8"
                    .to_owned(),
        },
        error => error,
    }
}

/// The target of passes that write buffers alone.
pub(crate) fn no_target() -> wgpu::ColorTargetState {
    wgpu::ColorTargetState { format: DUMMY_FORMAT, blend: None, write_mask: wgpu::ColorWrites::empty() }
}

fn stage_name(stage: Stage) -> &'static str {
    match stage {
        Stage::Vertex => "vertex",
        Stage::Fragment => "fragment",
        Stage::Compute => "compute",
    }
}
