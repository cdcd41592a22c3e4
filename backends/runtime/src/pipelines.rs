//! What a plan needs on one device whatever the size of its frames: pipelines, layouts, buffers full of a word to clear
//! with. Made once, shared by every renderer of the same shaders.

use std::sync::Arc;

use fragbuf_codegen::{LoopUntil, PassId, Plan, PlannedPass, ResourceId};
use fragbuf_frame::{most_iterations, unsupported};
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
    pub(crate) passes: Vec<Prepared>,
    /// Words of 64 KiB each, for clears to something else than zero.
    pub(crate) patterns: Vec<(u32, wgpu::Buffer)>,
    pub(crate) inputs: VertexInputs,
}

impl Made {
    /// Runs of passes in a slice at most.
    pub(crate) fn most_runs(&self) -> u64 {
        self.plan.passes.len() as u64 * u64::from(self.iterations)
    }

    /// Whether a loop waits for the samples of a pass, or a pass asks for objects by their boxes.
    pub(crate) fn has_queries(&self) -> bool {
        self.passes.iter().any(|prepared| prepared.is_awaited || prepared.pass.objects == Objects::Boxes)
    }
}

/// A pass and what it runs with.
pub(crate) struct Prepared {
    pub(crate) pass: PlannedPass,
    /// The exchanges of the frame that it uses resources of, by their numbers.
    pub(crate) exchanges: Vec<usize>,
    /// Whether a loop waits for its samples.
    pub(crate) is_awaited: bool,
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
        for (number, pass) in plan.passes.iter().enumerate() {
            let slots = slots(&plan, pass);
            check(device, pass, &slots)?;
            let what = format!("the bind group layout of pass `{}`", pass.anchor);
            let layout = scoped(device, &what, 0, || bind_group_layout(device, pass, &slots)).await?;
            let pipeline = maker.make(pass, &layout).await?;
            let exchanges = exchanges(&plan, pass)?;
            let is_awaited = is_awaited(&plan, PassId(number));
            passes.push(Prepared { pass: pass.clone(), exchanges, is_awaited, slots, layout, pipeline });
        }
        let patterns = scoped(device, "the buffers to clear with", 0, || patterns(device, &plan)).await?;
        Ok(Pipelines(Arc::new(Made { plan, group: shaders.group, iterations, passes, patterns, inputs })))
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

/// Whether a loop waits for the samples of a pass.
fn is_awaited(plan: &Plan, pass: PassId) -> bool {
    plan.frame.loops.iter().any(|looped| looped.until == LoopUntil::NoSamples(pass))
}
