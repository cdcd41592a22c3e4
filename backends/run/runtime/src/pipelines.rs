//! What a plan needs on one device whatever the size of its frames: pipelines, layouts, buffers full of a word to clear
//! with. Made once, shared by every renderer of the same shaders.

use std::sync::Arc;

use fragbuf_codegen::{PassId, Plan, PlannedPass, ResourceId};
use fragbuf_frame::{most_iterations, most_runs, unsupported};
use fragbuf_templates::vocabulary::Objects;

use crate::layout::{Slot, bind_group_layout, check, slots};
use crate::pattern::patterns;
use crate::pipeline::{Maker, Pipeline};
use crate::scope::scoped;
use crate::{Error, Settings, Shaders, VertexInputs, refusals};

/// The pipelines of one plan on one device. Cloning it is cheap.
#[derive(Clone)]
pub struct Pipelines(pub(crate) Arc<Made>);

pub(crate) struct Made {
    pub(crate) plan: Plan,
    pub(crate) group: u32,
    /// The most iterations of any loop.
    pub(crate) iterations: u32,
    /// Runs of passes in a slice at most.
    pub(crate) most_runs: u64,
    pub(crate) passes: Vec<Prepared>,
    /// Words of 64 KiB each, for clears to something else than zero.
    pub(crate) patterns: Vec<(u32, wgpu::Buffer)>,
    pub(crate) inputs: VertexInputs,
}

impl Made {
    /// Occlusion queries that a frame needs with so many objects: one for each pass whose samples a loop waits for, and
    /// behind them one for each object, where boxes are drawn.
    pub(crate) fn queries(&self, objects: u32) -> u32 {
        let has_boxes = self.passes.iter().any(|prepared| prepared.pass.objects == Objects::Boxes);
        self.awaited() + if has_boxes { objects.max(1) } else { 0 }
    }

    /// Passes whose samples a loop waits for; the query of the first object has this number.
    pub(crate) fn awaited(&self) -> u32 {
        self.passes.iter().filter(|prepared| prepared.query.is_some()).count() as u32
    }
}

/// A pass and what it runs with.
pub(crate) struct Prepared {
    pub(crate) pass: PlannedPass,
    /// The exchanges of the frame that it uses resources of, by their numbers.
    pub(crate) exchanges: Vec<usize>,
    /// The number of its query, where a loop waits for its samples.
    pub(crate) query: Option<u32>,
    pub(crate) slots: Vec<Slot>,
    pub(crate) layout: wgpu::BindGroupLayout,
    pub(crate) pipeline: Pipeline,
}

impl Pipelines {
    /// Makes the pipelines of `shaders`. Of the settings only target, checks, interlock, vertices and
    /// primitive matter. Fails where the
    /// plan has a step that the runtime does not run, and where the device lacks a feature.
    pub async fn new(device: &wgpu::Device, shaders: &Shaders, settings: &Settings) -> Result<Self, Error> {
        let plan = shaders.plan.clone();
        refusals::check(&plan)?;
        let iterations = most_iterations(&plan)?;
        let missing = shaders.features() - device.features();
        if !missing.is_empty() {
            return Err(Error::MissingFeatures(missing));
        }
        shaders.check_interlock(settings.interlock)?;
        let inputs = VertexInputs::of(&plan);
        let own = settings.vertices.clone();
        let vertices = own.unwrap_or_else(|| vec![inputs.interleaved()]);
        let interleaved = inputs.interleaved();
        let maker = Maker { device, shaders, settings, vertices: &vertices, interleaved, rounds: iterations };
        let mut passes = Vec::new();
        let mut queries = 0..;
        for (number, pass) in plan.passes.iter().enumerate() {
            let slots = slots(&plan, pass);
            check(device, pass, &slots)?;
            let what = format!("the bind group layout of pass `{}`", pass.anchor);
            let layout = scoped(device, &what, 0, || bind_group_layout(device, pass, &slots)).await?;
            let pipeline = maker.make(pass, &layout).await?;
            let exchanges = exchanges(&plan, pass)?;
            if pass.objects == Objects::Boxes && matches!(pipeline, Pipeline::Caller) {
                return Err(unsupported(format!("pass `{}`: boxes of objects in module form", pass.anchor)).into());
            }
            let query = if plan.frame.waits_for_samples(PassId(number)) { queries.next() } else { None };
            passes.push(Prepared { pass: pass.clone(), exchanges, query, slots, layout, pipeline });
        }
        let patterns = scoped(device, "the buffers to clear with", 0, || patterns(device, &plan)).await?;
        let (group, most_runs) = (shaders.group, most_runs(&plan)?);
        Ok(Pipelines(Arc::new(Made { plan, group, iterations, most_runs, passes, patterns, inputs })))
    }

    /// The greatest k that they serve; 0 where every fragment is kept.
    pub fn capacity(&self) -> u32 {
        self.0.plan.capacity()
    }
}

/// Exchanges that one pass may use resources of: a bind group is made for every way to flip them.
const MOST_EXCHANGES: usize = 6;

/// The exchanges that a pass uses resources of.
fn exchanges(plan: &Plan, pass: &PlannedPass) -> Result<Vec<usize>, Error> {
    let uses = |pair: &[ResourceId; 2]| pair.iter().any(|id| pass.touches(&plan.resources[id.0].resource.name));
    let pairs = plan.frame.exchanges.iter().enumerate();
    let used: Vec<usize> = pairs.filter(|(_, pair)| uses(pair)).map(|(number, _)| number).collect();
    if used.len() > MOST_EXCHANGES {
        let what = format!("pass `{}`: {} exchanged pairs of resources", pass.anchor, used.len());
        return Err(unsupported(what).into());
    }
    Ok(used)
}
