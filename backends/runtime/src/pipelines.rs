//! What a plan needs on one device whatever the size of its frames: pipelines, layouts, buffers full of a word to clear
//! with. Made once, shared by every renderer of the same shaders.

use std::sync::Arc;

use fragbuf_codegen::Plan;
use fragbuf_templates::vocabulary::Pass;

use crate::action::{Actions, actions};
use crate::layout::{Slot, bind_group_layout, check, slots};
use crate::pattern::patterns;
use crate::pipeline::{Maker, Pipeline};
use crate::scope::scoped;
use crate::{Error, Settings, Shaders, VertexInputs};

/// The pipelines of one plan on one device. Cloning it is cheap.
#[derive(Clone)]
pub struct Pipelines(pub(crate) Arc<Made>);

pub(crate) struct Made {
    pub(crate) plan: Plan,
    pub(crate) group: u32,
    pub(crate) actions: Actions,
    pub(crate) passes: Vec<Prepared>,
    /// Words of 64 KiB each, for clears to something else than zero.
    pub(crate) patterns: Vec<(u32, wgpu::Buffer)>,
    pub(crate) inputs: VertexInputs,
}

impl Made {
    /// The pass of every run, by its number.
    pub(crate) fn run_names(&self) -> Vec<String> {
        let name = |pass: &usize| self.passes.get(*pass).map_or(String::new(), |made| made.pass.anchor.clone());
        self.actions.runs.iter().map(name).collect()
    }
}

/// A pass and what it runs with.
pub(crate) struct Prepared {
    pub(crate) pass: Pass,
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
        let actions = actions(&plan)?;
        let missing = shaders.features() - device.features();
        if !missing.is_empty() {
            return Err(Error::MissingFeatures(missing));
        }
        shaders.check_interlock(settings.interlock)?;
        let inputs = VertexInputs::of(&plan);
        let own = settings.vertices.clone();
        let vertices = own.unwrap_or_else(|| vec![inputs.interleaved()]);
        let maker = Maker { device, shaders, settings, vertices: &vertices, rounds: actions.rounds };
        let mut passes = Vec::new();
        for pass in plan.passes() {
            let slots = slots(&plan, pass);
            check(device, pass, &slots)?;
            let what = format!("the bind group layout of pass `{}`", pass.anchor);
            let layout = scoped(device, &what, 0, || bind_group_layout(device, pass, &slots)).await?;
            let pipeline = maker.make(pass, &layout).await?;
            passes.push(Prepared { pass: pass.clone(), slots, layout, pipeline });
        }
        let patterns =
            scoped(device, "the buffers to clear with", 0, || patterns(device, &plan, &actions.list)).await?;
        Ok(Pipelines(Arc::new(Made { plan, group: shaders.group, actions, passes, patterns, inputs })))
    }

    /// The greatest k that they serve; 0 where every fragment is kept.
    pub fn capacity(&self) -> u32 {
        self.0.plan.bound.value("capacity").and_then(|capacity| u32::try_from(capacity).ok()).unwrap_or(0)
    }
}
