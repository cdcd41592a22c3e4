//! A plan, ready to run: pipelines, buffers of the right size, bind groups.
//!
//! In: a device, a queue, shaders and settings. Out: frames to record ([`Renderer::begin`]), and what they kept, counted
//! and took. Nothing here submits anything, apart from [`Renderer::render`].

use std::sync::atomic::{AtomicU32, Ordering};
use std::sync::{Mutex, PoisonError};

use fragbuf_codegen::{Plan, SymbolId};
use fragbuf_frame::{Counting, Values, decided, reserve, room_after, set, values, zeros};

use crate::blocks::{Blocks, IDENTITY};
use crate::brought::{accept, missing};
use crate::fixed_function::multisample;
use crate::objects::Objects;
use crate::pipeline::no_target;
use crate::pipelines::Made;
use crate::queries::Queries;
use crate::room::rows;
use crate::scope::{is_lost, scoped};
use crate::sized::{Fixed, Sized, Timed};
use crate::words::to_bytes;
use crate::{Error, Frame, ObjectBox, Pipelines, Room, Settings, Shaders, Value, VertexInputs};

/// Runs one plan on one device.
pub struct Renderer {
    pub(crate) device: wgpu::Device,
    pub(crate) queue: wgpu::Queue,
    pub(crate) pipelines: Pipelines,
    /// Whether host steps are carried out; else what they set has been reserved.
    pub(crate) counting: Counting,
    pub(crate) sized: Sized,
    pub(crate) frame_id: u64,
    /// Rows of a slice as the caller wants them.
    slice: Option<u32>,
    timed: Timed,
    blocks: Blocks,
    uniforms: Vec<u32>,
    k: Option<u32>,
    camera: Mutex<[f32; 16]>,
    /// The exchanges of the plan that the last frame has left flipped.
    flipped: AtomicU32,
    pub(crate) queries: Option<Queries>,
    /// The caller's objects; `None`: the scene is one, and always drawn.
    pub(crate) objects: Option<Objects>,
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
        let pipelines = Pipelines::new(device, shaders, settings).await?;
        Renderer::with(device, queue, &pipelines, settings).await
    }

    /// Makes buffers for pipelines that there are already. They must be of the same device, and of settings that differ in
    /// sizes alone.
    pub async fn with(
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        pipelines: &Pipelines,
        settings: &Settings,
    ) -> Result<Self, Error> {
        let made = &pipelines.0;
        let timed = settings.timestamps && device.features().contains(wgpu::Features::TIMESTAMP_QUERY);
        let timed = if timed { Timed::Yes } else { Timed::No };
        let (values, counting) = values(&made.plan, (settings.width, settings.height), settings.sizing)?;
        let values = values.with_rows(rows(&made.plan, &values, settings.slice, &device.limits())?);
        let k = values.k();
        let uniforms = zeros(&made.plan.variant.uniforms);
        let blocks = scoped(device, "the uniform buffers", 0, || Blocks::new(device, &uniforms)).await?;
        let fixed = Fixed { device, queue, made, blocks: &blocks, timed };
        let sized = Sized::new(&fixed, values, None).await?;
        let queries = Queries::new(device, made.queries(0)).await?;
        let renderer = Renderer {
            device: device.clone(),
            queue: queue.clone(),
            pipelines: pipelines.clone(),
            counting,
            sized,
            frame_id: 0,
            slice: settings.slice,
            timed,
            blocks,
            uniforms,
            k,
            camera: Mutex::new(IDENTITY),
            flipped: AtomicU32::new(0),
            queries,
            objects: None,
        };
        renderer.set_camera(&IDENTITY);
        renderer.write_uniforms();
        Ok(renderer)
    }

    /// Starts a frame; one that was not finished is over. Submit what was recorded of a frame before the next begins: uniform
    /// buffers are written ahead of the next submission. Fails where a texture is missing that the caller brings.
    pub fn begin(&mut self) -> Result<Frame, Error> {
        if is_lost(&self.device) {
            return Err(Error::Lost);
        }
        if let Some(number) = self.sized.memory.missing() {
            return Err(missing(self.plan().resources.get(number).map_or("", |planned| &planned.resource.name)));
        }
        self.write_frame()?;
        self.frame_id += 1;
        Ok(Frame::new(self))
    }

    /// Resizes the frame to `width` × `height` pixels. On an error the old size stays.
    pub async fn resize(&mut self, width: u32, height: u32) -> Result<(), Error> {
        self.resized(self.sized.values.resized(width, height)).await
    }

    /// Keeps `k` fragments per pixel from the next frame on, from 1 to [`Renderer::capacity`]. Pipelines stay; buffers are
    /// reallocated only for more than there ever was room for.
    pub async fn set_k(&mut self, k: u32) -> Result<(), Error> {
        let name = || "k".to_owned();
        let Some(room) = self.sized.values.k() else {
            return Err(Error::BadValue {
                name: name(),
                wanted: "left alone: this plan keeps every fragment".to_owned(),
            });
        };
        let (least, most) = self.plan().symbols.get(SymbolId::K).range;
        if !(least..=most).contains(&k.into()) {
            return Err(Error::BadValue { name: name(), wanted: format!("from {least} to the capacity, {most}") });
        }
        if k > room {
            self.resized(self.sized.values.with(SymbolId::K, k.into())).await?;
        }
        self.frame_id += 1;
        self.k = Some(k);
        Ok(())
    }

    /// Serves another k with other pipelines of the same description, of a capacity of at least `k`. Camera and uniforms
    /// stay, and so does everything on an error.
    pub(crate) async fn switch(&mut self, pipelines: &Pipelines, k: u32) -> Result<(), Error> {
        let before = std::mem::replace(&mut self.pipelines, pipelines.clone());
        let values = self.sized.values.of_plan(self.plan()).with(SymbolId::K, k.into());
        let fits = rows(self.plan(), &values, self.slice, &self.device.limits());
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

    /// Makes room, where the plan needs it, and no host step does from now on.
    pub async fn reserve(&mut self, room: Room) -> Result<(), Error> {
        let mut values = self.sized.values.clone();
        reserve(self.plan(), &mut values, room)?;
        self.resized(values).await?;
        self.counting = Counting::Reserved;
        Ok(())
    }

    /// Room, in fragments, after a frame that lost `short` of them for want of it: exactly enough where a pool was too small,
    /// twice as much where every pixel has slots of its own and only the deepest ran out.
    pub fn room_after(&self, short: u32) -> u64 {
        room_after(self.plan(), &self.sized.values, short)
    }

    /// The view-projection matrix, column by column: from positions to clip space, z from 0 to 1.
    pub fn set_camera(&self, view_projection: &[f32; 16]) {
        *self.camera.lock().unwrap_or_else(PoisonError::into_inner) = *view_projection;
        self.queue.write_buffer(&self.blocks.camera, 0, &to_bytes(&view_projection.map(f32::to_bits)));
    }

    /// The boxes of the caller's objects, for passes that draw them or those that are still seen ([`Call::objects`]): in the
    /// order of the numbers by which draws are asked for them. None: the scene is one object, and always drawn.
    pub async fn set_objects(&mut self, boxes: &[ObjectBox]) -> Result<(), Error> {
        let count = u32::try_from(boxes.len()).unwrap_or(u32::MAX);
        let queries = Queries::new(&self.device, self.made().queries(count)).await?;
        let inputs = &self.made().inputs;
        self.objects = match boxes.is_empty() {
            true => None,
            false => Some(Objects::new(&self.device, &self.queue, inputs, boxes).await?),
        };
        self.queries = queries;
        self.frame_id += 1;
        Ok(())
    }

    /// One of the description's own uniforms, from the next submission on.
    pub fn set_uniform(&mut self, name: &str, value: Value) -> Result<(), Error> {
        set(&mut self.uniforms, &self.pipelines.0.plan.variant.uniforms, name, value)?;
        self.write_uniforms();
        Ok(())
    }

    /// Brings a texture that the plan has and does not make (`init: host` in the manifest), filled: of the plan's format and of
    /// the whole frame's size, whatever its slices, with the usages that the plan's passes need. It is only read, from the next
    /// frame on, until another takes its place or the frame gets another size.
    pub async fn set_texture(&mut self, name: &str, texture: &wgpu::Texture) -> Result<(), Error> {
        let number = accept(self.plan(), &self.sized.values, name, texture)?;
        let mut memory = self.sized.memory.clone();
        memory.bring(number, texture);
        let fixed = self.fixed();
        let what = format!("the bind groups with `{name}`");
        let bound = scoped(&self.device, &what, 0, || self.sized.bound(&fixed, &memory)).await?;
        self.sized.groups = bound;
        self.sized.memory = memory;
        self.frame_id += 1;
        Ok(())
    }

    /// Slices that the frame is made of, one after the other.
    pub fn slices(&self) -> u32 {
        self.sized.values.slices()
    }

    /// Bytes of all buffers of the plan's resources, as wgpu has them: what the plan's formulas say for a slice, for the
    /// greatest k so far and for the room there is ([`Renderer::symbol`]).
    pub fn allocated_bytes(&self) -> u64 {
        self.sized.memory.bytes()
    }

    /// The value of a symbol of the plan's formulas that the buffers were sized with; `height` is that of a slice.
    pub fn symbol(&self, name: &str) -> Option<u64> {
        self.sized.values.named(name)
    }

    /// The greatest k that needs no new pipelines.
    pub fn capacity(&self) -> u32 {
        self.pipelines.capacity()
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
        &self.made().plan
    }

    /// What a vertex of a geometry pass carries.
    pub fn vertex_inputs(&self) -> &VertexInputs {
        &self.made().inputs
    }

    /// The bind group layout of the pass `anchor`, for a pipeline of the caller's own around its shader functions.
    pub fn bind_group_layout(&self, anchor: &str) -> Option<&wgpu::BindGroupLayout> {
        self.made().passes.iter().find(|prepared| prepared.pass.anchor == anchor).map(|prepared| &prepared.layout)
    }

    /// The samples that a pipeline of the caller's own must have in the pass `anchor`; one where the plan says nothing, or has
    /// no such pass.
    pub fn multisample(&self, anchor: &str) -> wgpu::MultisampleState {
        let pass = self.made().passes.iter().find(|prepared| prepared.pass.anchor == anchor);
        let samples = pass.and_then(|prepared| multisample(self.plan(), &prepared.pass, 0).ok());
        samples.unwrap_or_default()
    }

    /// The colour target that a pipeline of the caller's own must have in a geometry pass: nothing is written to it.
    pub fn geometry_target() -> wgpu::ColorTargetState {
        no_target()
    }

    /// The exchanges that the last frame has left flipped.
    pub(crate) fn flipped(&self) -> u32 {
        self.flipped.load(Ordering::Relaxed)
    }

    /// Notes the exchanges that a frame leaves flipped.
    pub(crate) fn leave_flipped(&self, flipped: u32) {
        self.flipped.store(flipped, Ordering::Relaxed);
    }

    /// Whether a query can judge an object at all: its box does not cross the near plane.
    pub(crate) fn crosses_near_plane(&self, object: &ObjectBox) -> bool {
        object.crosses_near_plane(&self.camera.lock().unwrap_or_else(PoisonError::into_inner))
    }

    pub(crate) fn made(&self) -> &Made {
        &self.pipelines.0
    }

    /// Gives the frame the size of `values` and slices that fit, or leaves everything as it is.
    async fn resized(&mut self, values: Values) -> Result<(), Error> {
        let rows = rows(self.plan(), &values, self.slice, &self.device.limits())?;
        self.reallocate(values.with_rows(rows)).await
    }

    /// Gives the buffers the sizes of `values`, or leaves everything as it is.
    pub(crate) async fn reallocate(&mut self, values: Values) -> Result<(), Error> {
        if values != self.sized.values {
            self.replace(values).await?;
        }
        self.frame_id += 1;
        Ok(())
    }

    async fn replace(&mut self, values: Values) -> Result<(), Error> {
        self.sized = Sized::new(&self.fixed(), values, Some(&self.sized)).await?;
        self.frame_id += 1;
        Ok(())
    }

    fn fixed(&self) -> Fixed<'_> {
        Fixed { device: &self.device, queue: &self.queue, made: self.made(), blocks: &self.blocks, timed: self.timed }
    }

    /// Writes the uniform buffers of the slices, ahead of the next submission.
    pub(crate) fn write_frame(&self) -> Result<(), Error> {
        let live = self.live();
        let words = |slice, iteration| Ok(live.frame_words(self.plan(), slice, iteration)?);
        let bytes = self.sized.frames.bytes(self.slices(), &words)?;
        self.queue.write_buffer(&self.sized.frames.buffer, 0, &bytes);
        Ok(())
    }

    /// Takes over the values that a host step has decided: for any k there is memory, anything else is memory that is made.
    pub(crate) async fn decide(&mut self, mut values: Values) -> Result<(), Error> {
        decided(self.plan(), &self.sized.values, &mut values);
        let k = values.k();
        if let Some(sized) = self.sized.values.k() {
            values.set(SymbolId::K, sized.into());
        }
        self.reallocate(values).await?;
        self.k = k;
        self.write_frame()
    }

    /// What the buffers were sized with, for the k of the frames from now on.
    pub(crate) fn live(&self) -> Values {
        match self.k {
            Some(k) => self.sized.values.with(SymbolId::K, k.into()),
            None => self.sized.values.clone(),
        }
    }

    fn write_uniforms(&self) {
        if !self.uniforms.is_empty() {
            self.queue.write_buffer(&self.blocks.own, 0, &to_bytes(&self.uniforms));
        }
    }
}
