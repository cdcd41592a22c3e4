//! The device objects of a plan that do not depend on the size of its frames: pipelines, layouts, and buffers with clear words.
//! They are created once and shared by every renderer of the same shaders.

use std::sync::Arc;

use fragbuf_codegen::{PassId, Plan, PlannedPass, ResourceId};
use fragbuf_frame::{max_iterations, max_pass_runs, unsupported as unsupported_plan};
use fragbuf_templates::vocabulary::Objects;

use crate::error_scope::in_error_scope;
use crate::layout::{Binding, bind_group_layout, bindings, check};
use crate::pattern::patterns;
use crate::pipeline::{Pipeline, PipelineBuilder};
use crate::{Error, GeometryPass, Settings, Shaders, VertexInputs, unsupported};

/// The pipelines of one plan on one device. Cloning is cheap.
#[derive(Clone)]
pub struct Pipelines(pub(crate) Arc<PipelineSet>);

/// The shared content of [`Pipelines`].
pub(crate) struct PipelineSet {
    pub(crate) plan: Plan,
    pub(crate) group: u32,
    /// The greatest iteration limit of any loop.
    pub(crate) max_iterations: u32,
    /// The greatest number of pass runs in a slice.
    pub(crate) max_pass_runs: u64,
    pub(crate) passes: Vec<PreparedPass>,
    /// Buffers of 64 KiB filled with a word, for clears to words other than zero.
    pub(crate) patterns: Vec<(u32, wgpu::Buffer)>,
    pub(crate) inputs: VertexInputs,
}

impl PipelineSet {
    /// Returns the number of occlusion queries in a frame with `objects` objects: one for each pass whose samples a loop waits
    /// for, then one for each object if a pass draws boxes.
    pub(crate) fn queries(&self, objects: u32) -> u32 {
        let has_boxes = self.passes.iter().any(|prepared| prepared.pass.objects == Objects::Boxes);
        self.loop_queries() + if has_boxes { objects.max(1) } else { 0 }
    }

    /// Returns the number of passes whose samples a loop waits for. The query of the first object has this number.
    pub(crate) fn loop_queries(&self) -> u32 {
        self.passes.iter().filter(|prepared| prepared.query.is_some()).count() as u32
    }
}

/// A pass and its device objects.
pub(crate) struct PreparedPass {
    pub(crate) pass: PlannedPass,
    /// The numbers of the frame's exchanges whose resources it uses.
    pub(crate) exchanges: Vec<usize>,
    /// The number of its query if a loop waits for its samples.
    pub(crate) query: Option<u32>,
    pub(crate) bindings: Vec<Binding>,
    pub(crate) layout: wgpu::BindGroupLayout,
    pub(crate) pipeline: Pipeline,
    /// What the caller's pipeline needs, in module form.
    pub(crate) callers: Option<GeometryPass>,
}

impl Pipelines {
    /// Creates the pipelines of `shaders`. The relevant settings are target, checks, interlock, vertices and primitive. Fails if
    /// the plan has an unsupported step, and if the device lacks a feature.
    pub async fn new(device: &wgpu::Device, shaders: &Shaders, settings: &Settings) -> Result<Self, Error> {
        let plan = shaders.plan.clone();
        unsupported::check(&plan)?;
        let max_iterations = max_iterations(&plan)?;
        let missing = shaders.features() - device.features();
        if !missing.is_empty() {
            return Err(Error::MissingFeatures(missing));
        }
        shaders.check_interlock(settings.interlock)?;
        let inputs = VertexInputs::of(&plan);
        let vertices = settings.vertices.clone().unwrap_or_else(|| vec![inputs.interleaved()]);
        let interleaved = inputs.interleaved();
        let builder = PipelineBuilder { device, shaders, settings, vertices: &vertices, interleaved, max_iterations };
        let mut passes = Vec::new();
        let mut queries = 0..;
        for (number, pass) in plan.passes.iter().enumerate() {
            let bindings = bindings(&plan, pass);
            check(device, pass, &bindings)?;
            let what = format!("the bind group layout of pass `{}`", pass.name);
            let layout = in_error_scope(device, &what, 0, || bind_group_layout(device, pass, &bindings)).await?;
            let pipeline = builder.build(pass, &layout).await?;
            let exchanges = exchanges(&plan, pass)?;
            if pass.objects == Objects::Boxes && matches!(pipeline, Pipeline::Caller) {
                return Err(unsupported_plan(format!("pass `{}`: boxes of objects in module form", pass.name)).into());
            }
            let query = if plan.frame.waits_for_samples(PassId(number)) { queries.next() } else { None };
            let callers = GeometryPass::of(shaders, pass, settings.target)?;
            passes.push(PreparedPass { pass: pass.clone(), exchanges, query, bindings, layout, pipeline, callers });
        }
        let patterns = in_error_scope(device, "the buffers with clear words", 0, || patterns(device, &plan)).await?;
        let (group, max_pass_runs) = (shaders.group, max_pass_runs(&plan)?);
        let set = PipelineSet { plan, group, max_iterations, max_pass_runs, passes, patterns, inputs };
        Ok(Pipelines(Arc::new(set)))
    }

    /// Returns the greatest k that these pipelines support; 0 if they keep every fragment.
    pub fn capacity(&self) -> u32 {
        self.0.plan.capacity()
    }
}

/// The limit on exchanges whose resources one pass may use: it needs a bind group for every combination of them.
const MAX_EXCHANGES: usize = 6;

/// Returns the numbers of the exchanges whose resources a pass uses.
fn exchanges(plan: &Plan, pass: &PlannedPass) -> Result<Vec<usize>, Error> {
    let uses = |pair: &[ResourceId; 2]| pair.iter().any(|id| pass.accesses(&plan.resources[id.0].resource.name));
    let pairs = plan.frame.exchanges.iter().enumerate();
    let used: Vec<usize> = pairs.filter(|(_, pair)| uses(pair)).map(|(number, _)| number).collect();
    if used.len() > MAX_EXCHANGES {
        let what = format!("pass `{}`: {} exchanged pairs of resources", pass.name, used.len());
        return Err(unsupported_plan(what).into());
    }
    Ok(used)
}
