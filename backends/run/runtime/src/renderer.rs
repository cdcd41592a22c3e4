//! A plan with everything that it needs to run: pipelines, buffers of the right size, bind groups.
//!
//! Input: a device, a queue, shaders and settings. Output: frames to record ([`Renderer::begin`]), and the kept fragments, counters
//! and times of a frame. Only [`Renderer::render`] submits commands.

use std::collections::{BTreeSet, VecDeque};
use std::sync::atomic::{AtomicU32, Ordering};
use std::sync::{Mutex, PoisonError};

use fragbuf_codegen::{Plan, SymbolId};
use fragbuf_frame::{
    Conditions, LaggedValues, MemoryLimits, Readbacks, Values, host_sets_k, initial_values, pool_size_after, reserve,
    reuse_pool_sizes, set_uniform, zero_uniforms,
};

use crate::conditional::ConditionalDraws;
use crate::draws::SceneDraw;
use crate::error_scope::in_error_scope;
use crate::external::accept;
use crate::frame_resources::{DeviceObjects, FrameResources, Timestamps};
use crate::lagged::FrameReads;
use crate::memory_limits::memory_limits;
use crate::objects::Objects;
use crate::pipelines::PipelineSet;
use crate::queries::Queries;
use crate::segment::FrameInputs;
use crate::uniform_buffers::{IDENTITY, UniformBuffers};
use crate::words::to_bytes;
use crate::{Error, Pipelines, PoolSize, Settings, Shaders, Value, VertexInputs};

/// Runs one plan on one device.
pub struct Renderer {
    pub(crate) device: wgpu::Device,
    pub(crate) queue: wgpu::Queue,
    pub(crate) pipelines: Pipelines,
    pub(crate) readbacks: Readbacks,
    pub(crate) resources: FrameResources,
    /// The number of the current frame: a frame with another number is stale.
    pub(crate) frame_id: u64,
    /// The rows of a slice that the caller requests.
    slice: Option<u32>,
    /// The bytes that may be allocated for a frame.
    budget: u64,
    timestamps: Timestamps,
    uniform_buffers: UniformBuffers,
    uniforms: Vec<u32>,
    /// The names of the uniforms that the caller has set.
    set_uniforms: BTreeSet<String>,
    pub(crate) k: Option<u32>,
    /// The decisions of earlier frames that later ones use.
    pub(crate) lag: LaggedValues,
    /// The words that frames have copied for such decisions, the oldest first.
    pub(crate) reads: Mutex<VecDeque<FrameReads>>,
    pub(crate) camera: Mutex<[f32; 16]>,
    /// The exchanges that the last frame left flipped.
    flipped: AtomicU32,
    pub(crate) queries: Option<Queries>,
    /// The caller's objects; `None`: the scene is one object, which is always drawn.
    pub(crate) objects: Option<Objects>,
    pub(crate) conditions: Conditions,
    /// The draws of the caller's scene; `None` until they are set.
    pub(crate) draws: Option<Vec<SceneDraw>>,
    /// The device's conditions; `None` if the host evaluates them, or the plan has none.
    pub(crate) conditional: Option<ConditionalDraws>,
}

impl Renderer {
    /// Creates pipelines and buffers. Fails if the plan has an unsupported step, if the device lacks a feature, exceeds a limit or
    /// is out of memory, and if [`Sizing::Exact`](crate::Sizing::Exact) has no host step that counts the fragments.
    pub async fn new(
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        shaders: &Shaders,
        settings: &Settings,
    ) -> Result<Self, Error> {
        let pipelines = Pipelines::new(device, shaders, settings).await?;
        Renderer::with(device, queue, &pipelines, settings).await
    }

    /// Creates buffers for existing pipelines. These must be of the same device, and of settings that differ only in sizes.
    pub async fn with(
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        pipelines: &Pipelines,
        settings: &Settings,
    ) -> Result<Self, Error> {
        let set = &pipelines.0;
        let is_timed = settings.timestamps && device.features().contains(wgpu::Features::TIMESTAMP_QUERY);
        let timestamps = if is_timed { Timestamps::Enabled } else { Timestamps::Disabled };
        let (values, readbacks) = initial_values(&set.plan, (settings.width, settings.height), settings.sizing)?;
        let limits = memory_limits(device, set, settings.memory)?;
        let values = values.with_rows(limits.rows(&set.plan, &values, settings.slice)?);
        let k = values.k();
        let uniforms = zero_uniforms(&set.plan.variant.uniforms);
        let make = || UniformBuffers::new(device, &uniforms);
        let uniform_buffers = in_error_scope(device, "the uniform buffers", 0, make).await?;
        let objects = DeviceObjects { device, queue, pipelines: set, uniforms: &uniform_buffers, timestamps, limits };
        let resources = FrameResources::new(&objects, values, None).await?;
        let queries = Queries::new(device, set.queries(0)).await?;
        let mut renderer = Renderer {
            device: device.clone(),
            queue: queue.clone(),
            pipelines: pipelines.clone(),
            readbacks,
            resources,
            frame_id: 0,
            slice: settings.slice,
            budget: settings.memory,
            timestamps,
            uniform_buffers,
            uniforms,
            set_uniforms: BTreeSet::new(),
            k,
            lag: LaggedValues::new(&pipelines.0.plan, settings.decisions),
            reads: Mutex::new(VecDeque::new()),
            camera: Mutex::new(IDENTITY),
            flipped: AtomicU32::new(0),
            queries,
            objects: None,
            conditions: settings.conditions,
            draws: None,
            conditional: None,
        };
        renderer.set_camera(&IDENTITY);
        renderer.write_uniforms();
        renderer.conditional = renderer.conditional_draws(0, &[]).await?;
        Ok(renderer)
    }

    /// Resizes the frame to `width` × `height` pixels. An error keeps the old size.
    pub async fn resize(&mut self, width: u32, height: u32) -> Result<(), Error> {
        let mut values = self.resources.values.resized(width, height);
        let is_decided = self.readbacks == Readbacks::Enabled && host_sets_k(self.plan());
        if is_decided {
            // The k of another size may exceed the budget at this one. The next frame decides again.
            values.set(SymbolId::K, 1);
        }
        self.resize_to(values).await?;
        if is_decided {
            self.k = Some(1);
        }
        self.forget_decisions();
        Ok(())
    }

    /// Sets the number of fragments per pixel from the next frame on, from 1 to [`Renderer::capacity`]. Pipelines stay; buffers
    /// are reallocated only for a greater k than ever before.
    pub async fn set_k(&mut self, k: u32) -> Result<(), Error> {
        let name = || "k".to_owned();
        let Some(allocated) = self.resources.values.k() else {
            return Err(Error::BadValue { name: name(), expected: "unset: this plan keeps every fragment".to_owned() });
        };
        let (least, most) = self.plan().symbols.get(SymbolId::K).range;
        if !(least..=most).contains(&k.into()) {
            return Err(Error::BadValue { name: name(), expected: format!("from {least} to the capacity, {most}") });
        }
        if k > allocated {
            self.resize_to(self.resources.values.with(SymbolId::K, k.into())).await?;
        }
        self.frame_id += 1;
        self.k = Some(k);
        Ok(())
    }

    /// Switches to other pipelines of the same description, with a capacity of at least `k`. Camera and uniforms stay. An error
    /// changes nothing.
    pub(crate) async fn switch_pipelines(&mut self, pipelines: &Pipelines, k: u32) -> Result<(), Error> {
        let before = std::mem::replace(&mut self.pipelines, pipelines.clone());
        let values = self.resources.values.of_plan(self.plan()).with(SymbolId::K, k.into());
        let fits = self.rows(&values);
        let replaced = match fits {
            Ok(rows) => self.replace(values.with_rows(rows)).await,
            Err(error) => Err(error),
        };
        if let Err(error) = replaced {
            self.pipelines = before;
            return Err(error);
        }
        self.k = Some(k);
        Ok(())
    }

    /// Gives memory for fragments this capacity if the plan needs it, as [`Sizing::Capacity`](crate::Sizing::Capacity) does: from then
    /// on host steps are skipped. Under [`Sizing::Reserve`](crate::Sizing::Reserve) frames are still never suspended.
    pub async fn reserve(&mut self, size: PoolSize) -> Result<(), Error> {
        let mut values = self.resources.values.clone();
        reserve(self.plan(), &mut values, size)?;
        let k = host_sets_k(self.plan()).then(|| values.k());
        self.resize_to(values).await?;
        self.k = k.unwrap_or(self.k);
        if self.readbacks == Readbacks::Enabled {
            self.readbacks = Readbacks::LoopsOnly;
        }
        Ok(())
    }

    /// Returns the capacity to reserve, in fragments, after a frame that lost `short` fragments to overflow. For a pool that is
    /// exactly enough. Where every pixel has its own slots it is twice the capacity, because only the deepest pixels overflowed.
    pub fn pool_size_after(&self, short: u32) -> u64 {
        pool_size_after(self.plan(), &self.resources.values, short)
    }

    /// Sets the view-projection matrix, column by column: from positions to clip space, z from 0 to 1.
    pub fn set_camera(&self, view_projection: &[f32; 16]) {
        *self.camera.lock().unwrap_or_else(PoisonError::into_inner) = *view_projection;
        self.queue.write_buffer(&self.uniform_buffers.camera, 0, &to_bytes(&view_projection.map(f32::to_bits)));
    }

    /// Sets one of the description's uniforms, from the next submission on.
    pub fn set_uniform(&mut self, name: &str, value: Value) -> Result<(), Error> {
        set_uniform(&mut self.uniforms, &self.pipelines.0.plan.variant.uniforms, name, value)?;
        self.set_uniforms.insert(name.to_owned());
        self.write_uniforms();
        Ok(())
    }

    /// Returns the names of the uniforms that [`set_uniform`](Renderer::set_uniform) has not set yet, in the order of the description.
    /// They are 0.
    pub fn unset_uniforms(&self) -> impl Iterator<Item = &str> {
        let names = self.plan().variant.uniforms.iter().map(|uniform| uniform.name.value.as_str());
        names.filter(|name| !self.set_uniforms.contains(*name))
    }

    /// Sets an external texture (`init: external` in the manifest) with its content. It needs the plan's format, the size of the
    /// whole frame and the usages of the plan's passes. It is only read, from the next frame on, until another call replaces it
    /// or the frame is resized. A texture of the description has its name there, any size, one level, and any format of floats, and stays
    /// set when the frame is resized.
    pub async fn set_texture(&mut self, name: &str, texture: &wgpu::Texture) -> Result<(), Error> {
        let number = accept(self.plan(), &self.resources.values, name, texture)?;
        let mut memory = self.resources.memory.clone();
        memory.set_texture(number, texture);
        let objects = self.device_objects()?;
        let what = format!("the bind groups with `{name}`");
        let make = || self.resources.bind_groups(&objects, &memory);
        self.resources.groups = in_error_scope(&self.device, &what, 0, make).await?;
        self.resources.memory = memory;
        self.frame_id += 1;
        Ok(())
    }

    /// Returns the number of slices of the frame.
    pub fn slices(&self) -> u32 {
        self.resources.values.slices()
    }

    /// Returns the allocated bytes of the plan's resources: those of the plan's formulas for a slice, the greatest k so far and
    /// the current capacity ([`Renderer::symbol`]).
    pub fn allocated_bytes(&self) -> u64 {
        self.resources.memory.bytes()
    }

    /// Returns the value of a symbol for which the buffers are sized; `height` is that of a slice.
    pub fn symbol(&self, name: &str) -> Option<u64> {
        self.resources.values.named(name)
    }

    /// Returns the greatest k that needs no other pipelines.
    pub fn capacity(&self) -> u32 {
        self.pipelines.capacity()
    }

    /// Returns the number of fragments that a pixel keeps; `None`: all.
    pub fn k(&self) -> Option<u32> {
        self.k
    }

    /// Returns the device of this renderer.
    pub fn device(&self) -> &wgpu::Device {
        &self.device
    }

    /// Returns the plan.
    pub fn plan(&self) -> &Plan {
        &self.pipeline_set().plan
    }

    /// Returns the inputs of a vertex of a geometry pass.
    pub fn vertex_inputs(&self) -> &VertexInputs {
        &self.pipeline_set().inputs
    }

    /// Returns the bind group layout of the pass `name`, for a pipeline of the caller ([`Renderer::geometry_passes`]).
    pub fn bind_group_layout(&self, name: &str) -> Option<&wgpu::BindGroupLayout> {
        self.pipeline_set().passes.iter().find(|prepared| prepared.pass.name == name).map(|prepared| &prepared.layout)
    }

    /// Returns the exchanges that the last frame left flipped.
    pub(crate) fn flipped(&self) -> u32 {
        self.flipped.load(Ordering::Relaxed)
    }

    /// Stores the exchanges that a frame leaves flipped.
    pub(crate) fn store_flipped(&self, flipped: u32) {
        self.flipped.store(flipped, Ordering::Relaxed);
    }

    /// Returns the pipelines and their plan.
    pub(crate) fn pipeline_set(&self) -> &PipelineSet {
        &self.pipelines.0
    }

    /// Resizes the frame to `values`, in slices that fit. An error changes nothing.
    pub(crate) async fn resize_to(&mut self, values: Values) -> Result<(), Error> {
        let rows = self.rows(&values)?;
        self.reallocate(values.with_rows(rows)).await
    }

    /// Reallocates the buffers for `values`. An error changes nothing.
    async fn reallocate(&mut self, values: Values) -> Result<(), Error> {
        if values != self.resources.values {
            self.replace(values).await?;
        }
        self.frame_id += 1;
        Ok(())
    }

    async fn replace(&mut self, values: Values) -> Result<(), Error> {
        self.resources = FrameResources::new(&self.device_objects()?, values, Some(&self.resources)).await?;
        self.frame_id += 1;
        Ok(())
    }

    /// Returns the rows of a slice for these values.
    fn rows(&self, values: &Values) -> Result<u32, Error> {
        Ok(self.limits()?.rows(self.plan(), values, self.slice)?)
    }

    fn limits(&self) -> Result<MemoryLimits, Error> {
        memory_limits(&self.device, self.pipeline_set(), self.budget)
    }

    fn device_objects(&self) -> Result<DeviceObjects<'_>, Error> {
        Ok(DeviceObjects {
            device: &self.device,
            queue: &self.queue,
            pipelines: self.pipeline_set(),
            uniforms: &self.uniform_buffers,
            timestamps: self.timestamps,
            limits: self.limits()?,
        })
    }

    /// Returns the inputs of a frame's steps.
    pub(crate) fn frame_inputs(&self) -> FrameInputs<'_> {
        FrameInputs {
            plan: self.plan(),
            values: self.current_values(),
            memory: &self.resources.memory,
            readbacks: self.frame_readbacks(),
            conditions: self.conditions,
            flipped: self.flipped(),
            max_workgroups: self.device.limits().max_compute_workgroups_per_dimension,
        }
    }

    /// Writes the uniform blocks of the slices, ahead of the next submission.
    pub(crate) fn write_frame_blocks(&self) -> Result<(), Error> {
        let values = self.current_values();
        let words = |slice, iteration| Ok(values.frame_words(self.plan(), slice, iteration)?);
        let bytes = self.resources.frame_blocks.bytes(self.slices(), &words)?;
        self.queue.write_buffer(&self.resources.frame_blocks.buffer, 0, &bytes);
        Ok(())
    }

    /// Applies the values that a host step has set. Buffers are reallocated for a greater k than ever before, and for other values.
    pub(crate) async fn apply_decision(&mut self, mut values: Values) -> Result<(), Error> {
        reuse_pool_sizes(self.plan(), &self.resources.values, &mut values);
        let k = values.k();
        if let Some(allocated) = self.resources.values.k() {
            values.set(SymbolId::K, allocated.max(k.unwrap_or(0)).into());
        }
        self.reallocate(values).await?;
        self.k = k;
        self.write_frame_blocks()
    }

    /// Returns the values for which the buffers are sized, with the current k.
    pub(crate) fn current_values(&self) -> Values {
        match self.k {
            Some(k) => self.resources.values.with(SymbolId::K, k.into()),
            None => self.resources.values.clone(),
        }
    }

    fn write_uniforms(&self) {
        if !self.uniforms.is_empty() {
            self.queue.write_buffer(&self.uniform_buffers.description, 0, &to_bytes(&self.uniforms));
        }
    }
}
