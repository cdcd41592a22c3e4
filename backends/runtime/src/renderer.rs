//! A plan, ready to run: pipelines, buffers of the right size, bind groups.
//!
//! In: a device, a queue, shaders and settings. Out: frames to record ([`Renderer::begin`]), and what they kept, counted
//! and took. Nothing here submits anything, apart from [`Renderer::render`].

use fragbuf_codegen::Plan;
use fragbuf_templates::vocabulary::Pass;

use crate::action::{Action, actions, index};
use crate::blocks::{Blocks, IDENTITY};
use crate::layout::{Slot, bind_group_layout, check, slots};
use crate::pattern::patterns;
use crate::pipeline::{Maker, Pipeline, no_target};
use crate::room::{automatic_room, fitting_height, symbols};
use crate::scope::{is_lost, scoped};
use crate::sized::Sized;
use crate::symbols::Symbols;
use crate::timing::Timing;
use crate::uniforms::{set, zeros};
use crate::words::to_bytes;
use crate::{Counters, Error, Frame, PassTime, Pending, Settings, Shaders, Sizing, Value, VertexInputs, counters};

/// Runs one plan on one device.
pub struct Renderer {
    pub(crate) device: wgpu::Device,
    pub(crate) queue: wgpu::Queue,
    pub(crate) plan: Plan,
    pub(crate) group: u32,
    pub(crate) actions: Vec<Action>,
    pub(crate) passes: Vec<Prepared>,
    pub(crate) timing: Option<Timing>,
    /// Whether host steps are carried out; else what they set has been reserved.
    pub(crate) exact: bool,
    /// Whether what is reserved follows the size of the frame.
    follows_size: bool,
    pub(crate) sized: Sized,
    /// Words of 64 KiB each, for clears to something else than zero.
    pub(crate) patterns: Vec<(u32, wgpu::Buffer)>,
    pub(crate) frame_id: u64,
    inputs: VertexInputs,
    blocks: Blocks,
    uniforms: Vec<u32>,
    k: Option<u32>,
}

/// A pass and what it runs with.
pub(crate) struct Prepared {
    pub(crate) pass: Pass,
    pub(crate) slots: Vec<Slot>,
    pub(crate) layout: wgpu::BindGroupLayout,
    pub(crate) pipeline: Pipeline,
}

impl Renderer {
    /// Makes pipelines and buffers. Fails where the plan has a step that the runtime does not run, where the device lacks
    /// a feature, a limit or memory, and where no one says how many fragments there may be.
    pub async fn new(
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        shaders: &Shaders,
        settings: &Settings,
    ) -> Result<Self, Error> {
        let plan = shaders.plan.clone();
        let actions = actions(&plan)?;
        let missing = shaders.features() - device.features();
        if !missing.is_empty() {
            return Err(Error::MissingFeatures(missing));
        }
        let inputs = VertexInputs::of(&plan);
        let own = settings.vertices.clone();
        let vertices = own.unwrap_or_else(|| vec![inputs.interleaved()]);
        let maker = Maker { device, shaders, settings, vertices: &vertices };
        let mut passes = Vec::new();
        for pass in plan.passes() {
            let slots = slots(&plan, pass);
            check(device, pass, &slots)?;
            let what = format!("the bind group layout of pass `{}`", pass.anchor);
            let layout = scoped(device, &what, 0, || bind_group_layout(device, pass, &slots)).await?;
            let pipeline = maker.make(pass, &layout).await?;
            passes.push(Prepared { pass: pass.clone(), slots, layout, pipeline });
        }
        let timed = settings.timestamps && device.features().contains(wgpu::Features::TIMESTAMP_QUERY);
        let names = passes.iter().map(|prepared| prepared.pass.anchor.clone()).collect();
        let timing = if timed { Some(Timing::new(device, queue, names).await?) } else { None };
        let (symbols, exact) = symbols(&plan, &actions, settings)?;
        let k = symbols.k;
        let uniforms = zeros(&plan.variant.uniforms);
        let make = || (Blocks::new(device, &plan, &uniforms), patterns(device, &actions));
        let (blocks, patterns) = scoped(device, "the uniform buffers", 0, make).await?;
        let sized = Sized::new(device, &plan, &passes, &blocks, symbols, None).await?;
        let renderer = Renderer {
            device: device.clone(),
            queue: queue.clone(),
            group: shaders.group,
            plan,
            actions,
            passes,
            timing,
            exact,
            follows_size: !exact && settings.sizing == Sizing::Auto,
            sized,
            patterns,
            frame_id: 0,
            inputs,
            blocks,
            uniforms,
            k,
        };
        renderer.set_camera(&IDENTITY);
        renderer.write_uniforms();
        Ok(renderer)
    }

    /// The greatest height, up to that of `settings`, at which every buffer is within the device's limits: the rows of a
    /// slice. A frame beyond the limits can be made of slices, by a renderer of that height and a draw function that moves
    /// each to the top, with `set_viewport(0, -first_row, width, whole_height, 0, 1)`. A pool that is counted exactly is
    /// not known yet, and may still be too large.
    pub fn fitting_height(device: &wgpu::Device, shaders: &Shaders, settings: &Settings) -> Result<u32, Error> {
        fitting_height(&shaders.plan, settings, &device.limits())
    }

    /// Starts a frame; one that was not finished is over. Submit what was recorded of a frame before the next begins:
    /// uniform buffers are written ahead of the next submission.
    pub fn begin(&mut self) -> Result<Frame, Error> {
        if is_lost(&self.device) {
            return Err(Error::Lost);
        }
        self.write_frame()?;
        self.frame_id += 1;
        Ok(Frame::new(self.frame_id))
    }

    /// Resizes the frame to `width` × `height` pixels. On an error the old size stays.
    pub async fn resize(&mut self, width: u32, height: u32) -> Result<(), Error> {
        let mut symbols = Symbols { width, height, ..self.sized.symbols.clone() };
        if self.follows_size {
            let room = automatic_room(width, height);
            symbols.counted.iter_mut().for_each(|(_, value)| *value = room);
        }
        self.reallocate(symbols).await
    }

    /// Keeps `k` fragments per pixel from the next frame on, from 1 to [`Renderer::capacity`]. Pipelines stay; buffers are
    /// reallocated only for more than there ever was room for.
    pub async fn set_k(&mut self, k: u32) -> Result<(), Error> {
        let name = || "k".to_owned();
        let Some(room) = self.sized.symbols.k else {
            return Err(Error::BadValue {
                name: name(),
                wanted: "left alone: this plan keeps every fragment".to_owned(),
            });
        };
        if k == 0 || k > self.capacity() {
            return Err(Error::BadValue {
                name: name(),
                wanted: format!("from 1 to the capacity, {}", self.capacity()),
            });
        }
        if k > room {
            self.reallocate(Symbols { k: Some(k), ..self.sized.symbols.clone() }).await?;
        }
        self.frame_id += 1;
        self.k = Some(k);
        Ok(())
    }

    /// Makes room for `fragments` fragments in the whole frame, where the plan needs room and no host step makes it.
    pub async fn reserve(&mut self, fragments: u32) -> Result<(), Error> {
        let mut symbols = self.sized.symbols.clone();
        for (_, value) in &mut symbols.counted {
            *value = fragments.into();
        }
        self.reallocate(symbols).await?;
        (self.exact, self.follows_size) = (false, false);
        Ok(())
    }

    /// The view-projection matrix, column by column: from positions to clip space, z from 0 to 1.
    pub fn set_camera(&self, view_projection: &[f32; 16]) {
        self.queue.write_buffer(&self.blocks.camera, 0, &to_bytes(&view_projection.map(f32::to_bits)));
    }

    /// One of the description's own uniforms, from the next submission on.
    pub fn set_uniform(&mut self, name: &str, value: Value) -> Result<(), Error> {
        set(&mut self.uniforms, &self.plan.variant.uniforms, name, value)?;
        self.write_uniforms();
        Ok(())
    }

    /// Bytes of all buffers of the plan's resources, as wgpu has them: what the plan's formulas say for this size, for the
    /// greatest k so far and for the room there is ([`Renderer::symbol`]).
    pub fn allocated_bytes(&self) -> u64 {
        self.sized.memory.bytes()
    }

    /// The value of a symbol of the plan's formulas that the buffers were sized with.
    pub fn symbol(&self, name: &str) -> Option<u64> {
        self.sized.symbols.value(&self.plan, name)
    }

    /// The greatest k that needs no new pipelines.
    pub fn capacity(&self) -> u32 {
        self.plan.bound.value("capacity").and_then(|capacity| u32::try_from(capacity).ok()).unwrap_or(0)
    }

    /// Fragments that a pixel keeps; `None`: all.
    pub fn k(&self) -> Option<u32> {
        self.k
    }

    /// The device that it was made on.
    pub fn device(&self) -> &wgpu::Device {
        &self.device
    }

    /// What is run.
    pub fn plan(&self) -> &Plan {
        &self.plan
    }

    /// What a vertex of a geometry pass carries.
    pub fn vertex_inputs(&self) -> &VertexInputs {
        &self.inputs
    }

    /// The bind group layout of the pass `anchor`, for a pipeline of the caller's own around its shader functions.
    pub fn bind_group_layout(&self, anchor: &str) -> Option<&wgpu::BindGroupLayout> {
        self.passes.iter().find(|prepared| prepared.pass.anchor == anchor).map(|prepared| &prepared.layout)
    }

    /// The colour target that a pipeline of the caller's own must have in a geometry pass: nothing is written to it.
    pub fn geometry_target() -> wgpu::ColorTargetState {
        no_target()
    }

    /// Records the readback of what the frame counted. `None`: the plan counts nothing.
    pub fn counters(&self, encoder: &mut wgpu::CommandEncoder) -> Option<Pending<Counters>> {
        let buffer = self.buffer(counters::RESOURCE)?;
        let decode = |words: Vec<u32>| Counters::from_words(&words);
        Some(Pending::record(&self.device, encoder, buffer, 0, buffer.size(), decode))
    }

    /// Records the readback of the time that each pass of the finished frame took. `None`: passes are not timed.
    pub fn pass_times(&self, encoder: &mut wgpu::CommandEncoder) -> Option<Pending<Vec<PassTime>>> {
        self.timing.as_ref().map(|timing| timing.read(&self.device, encoder))
    }

    /// Records the readback of a resource, all its words. `None`: the plan does not have it, or it is empty.
    pub fn words(&self, resource: &str, encoder: &mut wgpu::CommandEncoder) -> Option<Pending<Vec<u32>>> {
        let buffer = self.buffer(resource)?;
        Some(Pending::record(&self.device, encoder, buffer, 0, buffer.size(), |words| words))
    }

    /// The buffer of a resource. `None`: the plan does not have it, or it is empty.
    pub fn buffer(&self, resource: &str) -> Option<&wgpu::Buffer> {
        self.sized.memory.filled(index(&self.plan, resource).ok()?)
    }

    /// Gives the buffers the sizes of `symbols`, or leaves everything as it is.
    pub(crate) async fn reallocate(&mut self, symbols: Symbols) -> Result<(), Error> {
        if symbols != self.sized.symbols {
            let old = Some(&self.sized);
            self.sized = Sized::new(&self.device, &self.plan, &self.passes, &self.blocks, symbols, old).await?;
        }
        self.frame_id += 1;
        Ok(())
    }

    /// Writes the frame's uniform buffer, ahead of the next submission.
    pub(crate) fn write_frame(&self) -> Result<(), Error> {
        let live = Symbols { k: self.k, ..self.sized.symbols.clone() };
        self.queue.write_buffer(&self.blocks.frame, 0, &to_bytes(&live.frame_words(&self.plan)?));
        Ok(())
    }

    fn write_uniforms(&self) {
        if !self.uniforms.is_empty() {
            self.queue.write_buffer(&self.blocks.own, 0, &to_bytes(&self.uniforms));
        }
    }
}
