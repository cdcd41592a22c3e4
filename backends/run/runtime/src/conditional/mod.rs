//! Loops that end on the device, and objects that the device drops: conditional rendering by indirect draws, because wgpu has no other.
//!
//! Input: the plan's loops and queries, the caller's draws. Output: a compute pass per update, which zeroes the instance counts of what is not
//! drawn. A frame is never suspended for it.

mod updates;

use fragbuf_codegen::{LoopId, PassId, Plan};
use fragbuf_frame::{Condition, ConditionWord, FrameStep, LOOP_WORDS, PassRun, object_queries};

use crate::draws::{ARGUMENT_WORDS, CallArguments, SceneDraw};
use crate::error_scope::in_error_scope;
use crate::segment::{ActionRun, SegmentPart};
use crate::words::to_bytes;
use crate::{Error, Renderer};
use updates::{STRIDE, Update, updates};

/// The device's words of loops and objects, and the arguments of draws.
pub(crate) struct ConditionalDraws {
    pipeline: wgpu::ComputePipeline,
    group: wgpu::BindGroup,
    updates: Vec<Update>,
    words: wgpu::Buffer,
    tested: wgpu::Buffer,
    undecided: wgpu::Buffer,
    arguments: wgpu::Buffer,
    /// The workgroups of the next compute pass in a loop.
    dispatch: wgpu::Buffer,
    queries: Vec<PassId>,
    objects: u32,
    draws: u32,
}

/// Returns the device objects for `objects` objects and these draws; `None` if the plan has neither a loop that ends on a condition nor a
/// query.
pub(crate) async fn conditional_draws(
    (device, queue): (&wgpu::Device, &wgpu::Queue),
    plan: &Plan,
    objects: u32,
    draws: &[SceneDraw],
) -> Result<Option<ConditionalDraws>, Error> {
    let updates = updates(plan);
    if updates.is_empty() {
        return Ok(None);
    }
    let count = u32::try_from(draws.len()).unwrap_or(u32::MAX);
    let queries = object_queries(plan);
    let (loops, boxes) = (plan.frame.loops.len() as u64, queries.len() as u64);
    let of_loop = 1 + (1 + boxes) * u64::from(count) + boxes * u64::from(objects);
    let argument_bytes = 4 * u64::from(ARGUMENT_WORDS) * of_loop * loops;
    let limit = device.limits().max_storage_buffer_binding_size;
    if argument_bytes > limit {
        return Err(Error::TooLarge {
            what: "the arguments of the scene's draws".to_owned(),
            needed: argument_bytes,
            limit,
            limit_name: "max_storage_buffer_binding_size",
            help: "group several meshes into one draw, or use `Conditions::OnHost`",
            shrinks_with_rows: false,
        });
    }
    let make = || {
        let buffer = |label: &str, bytes: u64, usage: wgpu::BufferUsages| {
            let usage = usage | wgpu::BufferUsages::COPY_DST;
            let size = bytes.next_multiple_of(4).max(16);
            device.create_buffer(&wgpu::BufferDescriptor { label: Some(label), size, usage, mapped_at_creation: false })
        };
        let storage = wgpu::BufferUsages::STORAGE;
        let words = 4 * (LOOP_WORDS as u64 * loops + boxes * u64::from(objects));
        let words = buffer("fragbuf loops and objects", words, storage | wgpu::BufferUsages::COPY_SRC);
        let tested =
            buffer("fragbuf conditions", 8 * u64::from(objects.max(1)), storage | wgpu::BufferUsages::QUERY_RESOLVE);
        let undecided = buffer("fragbuf undecided objects", 4 * u64::from(objects), storage);
        let scene: Vec<u32> = draws.iter().flat_map(SceneDraw::words).collect();
        let source = buffer("fragbuf draws", 4 * scene.len() as u64, storage);
        queue.write_buffer(&source, 0, &to_bytes(&scene));
        let arguments = buffer("fragbuf arguments", argument_bytes, storage | wgpu::BufferUsages::INDIRECT);
        let dispatch = buffer("fragbuf workgroups", 12, wgpu::BufferUsages::INDIRECT);
        let uniform = buffer("fragbuf updates", STRIDE * updates.len() as u64, wgpu::BufferUsages::UNIFORM);
        for (number, update) in updates.iter().enumerate() {
            let sizes = [loops as u32, boxes as u32, objects, count];
            queue.write_buffer(&uniform, STRIDE * number as u64, &to_bytes(&update.words(&queries, sizes)));
        }
        let (pipeline, group) = pipeline(device, [&uniform, &words, &tested, &undecided, &source, &arguments]);
        ConditionalDraws {
            pipeline,
            group,
            updates,
            words,
            tested,
            undecided,
            arguments,
            dispatch,
            queries,
            objects,
            draws: count,
        }
    };
    in_error_scope(device, "the conditional draws", argument_bytes, make).await.map(Some)
}

/// Returns a buffer with the workgroups of each compute pass in a loop that ends on the device, in x and y; `None` if there is none.
pub(crate) fn workgroups_of(device: &wgpu::Device, parts: &[SegmentPart]) -> Option<wgpu::Buffer> {
    let of = |part: &SegmentPart| match part {
        SegmentPart::Action(action) if is_dispatch(action) => Some([action.groups[0], action.groups[1]]),
        _ => None,
    };
    let words: Vec<u32> = parts.iter().filter_map(of).flatten().collect();
    if words.is_empty() {
        return None;
    }
    let buffer = device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("fragbuf workgroups"),
        size: 4 * words.len() as u64,
        usage: wgpu::BufferUsages::COPY_SRC | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: true,
    });
    if let Ok(mut view) = buffer.get_mapped_range_mut(..) {
        view.copy_from_slice(&to_bytes(&words));
    }
    buffer.unmap();
    Some(buffer)
}

/// Whether an action is a compute pass in a loop that ends on the device.
fn is_dispatch(action: &ActionRun) -> bool {
    action.groups[2] == 1 && matches!(action.step, FrameStep::Pass(PassRun { conditional: Some(_), .. }))
}

/// Returns the pipeline that updates words and arguments, and its bind group over these buffers.
fn pipeline(device: &wgpu::Device, buffers: [&wgpu::Buffer; 6]) -> (wgpu::ComputePipeline, wgpu::BindGroup) {
    let label = Some("fragbuf conditions");
    let entry = |binding: u32| wgpu::BindGroupLayoutEntry {
        binding,
        visibility: wgpu::ShaderStages::COMPUTE,
        ty: wgpu::BindingType::Buffer {
            ty: match binding {
                0 => wgpu::BufferBindingType::Uniform,
                _ => wgpu::BufferBindingType::Storage { read_only: (2..=4).contains(&binding) },
            },
            has_dynamic_offset: binding == 0,
            min_binding_size: None,
        },
        count: None,
    };
    let entries: [wgpu::BindGroupLayoutEntry; 6] = std::array::from_fn(|binding| entry(binding as u32));
    let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label, entries: &entries });
    let pipeline_layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label,
        bind_group_layouts: &[Some(&layout)],
        immediate_size: 0,
    });
    let source = wgpu::ShaderSource::Wgsl(include_str!("conditions.wgsl").into());
    let pipeline = device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
        label,
        layout: Some(&pipeline_layout),
        module: &device.create_shader_module(wgpu::ShaderModuleDescriptor { label, source }),
        entry_point: Some("update_conditions"),
        compilation_options: wgpu::PipelineCompilationOptions::default(),
        cache: None,
    });
    let updates = wgpu::BufferBinding { buffer: buffers[0], offset: 0, size: wgpu::BufferSize::new(STRIDE) };
    let mut resources = buffers.map(wgpu::Buffer::as_entire_binding);
    resources[0] = wgpu::BindingResource::Buffer(updates);
    let entries = (0..).zip(resources).map(|(binding, resource)| wgpu::BindGroupEntry { binding, resource });
    let entries: Vec<wgpu::BindGroupEntry<'_>> = entries.collect();
    let group = device.create_bind_group(&wgpu::BindGroupDescriptor { label, layout: &layout, entries: &entries });
    (pipeline, group)
}

impl ConditionalDraws {
    /// Writes which objects no query can decide about, ahead of the next submission.
    pub(crate) fn write_undecided(&self, queue: &wgpu::Queue, undecided: &[u32]) {
        if !undecided.is_empty() {
            queue.write_buffer(&self.undecided, 0, &to_bytes(undecided));
        }
    }

    /// Returns the words of all loops, over all slices ([`LOOP_WORDS`]); the objects that are dropped follow in the buffer.
    pub(crate) fn loop_words(&self, plan: &Plan) -> (&wgpu::Buffer, u64) {
        (&self.words, 4 * (LOOP_WORDS * plan.frame.loops.len()) as u64)
    }

    /// Records the beginning of a frame.
    pub(crate) fn begin_frame(&self, encoder: &mut wgpu::CommandEncoder) {
        encoder.clear_buffer(&self.words, 0, None);
    }

    /// Records the beginning of a slice: every object is visible.
    pub(crate) fn begin_slice(&self, encoder: &mut wgpu::CommandEncoder, plan: &Plan) {
        let (words, loops) = self.loop_words(plan);
        let bytes = 4 * u64::from(self.objects) * self.queries.len() as u64;
        if bytes > 0 {
            encoder.clear_buffer(words, loops, Some(bytes));
        }
    }

    /// Records an update.
    pub(crate) fn update(&self, renderer: &Renderer, encoder: &mut wgpu::CommandEncoder, condition: &Condition) {
        let Some(number) = self.updates.iter().position(|update| update.is_of(condition)) else { return };
        self.copy_tested(renderer, encoder, condition);
        let label = Some("fragbuf conditions");
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor { label, timestamp_writes: None });
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &self.group, &[(STRIDE * number as u64) as u32]);
        pass.dispatch_workgroups(1, 1, 1);
    }

    /// Copies the words that an update tests.
    fn copy_tested(&self, renderer: &Renderer, encoder: &mut wgpu::CommandEncoder, condition: &Condition) {
        let pipelines = renderer.pipeline_set();
        let query = |pass: &PassId| pipelines.passes.get(pass.0).and_then(|prepared| prepared.query);
        let queries = match condition {
            Condition::Begin { .. } => return,
            Condition::End { word: ConditionWord::Word(range), .. } => {
                match renderer.resources.memory.buffer(range.resource.0) {
                    Some(buffer) => encoder.copy_buffer_to_buffer(buffer, 4 * range.first, &self.tested, 0, 4),
                    None => encoder.clear_buffer(&self.tested, 0, Some(4)),
                }
                return;
            }
            Condition::End { word: ConditionWord::Samples(pass), .. } => query(pass).map(|query| query..query + 1),
            Condition::Objects { .. } => {
                let first = pipelines.loop_queries();
                (self.objects > 0).then(|| first..first + self.objects)
            }
        };
        if let (Some(queries), Some(all)) = (queries, &renderer.queries) {
            encoder.resolve_query_set(&all.set, queries, &self.tested, 0);
        }
    }

    /// Returns the arguments of the scene's draws in a pass of a loop, with the objects that this query has not dropped; `None`: with all.
    pub(crate) fn scene(&self, id: LoopId, query: Option<PassId>) -> CallArguments<'_> {
        let region = query.and_then(|query| self.number(query)).map_or(0, |number| 1 + number);
        CallArguments::Conditional { arguments: &self.arguments, offset: self.offset(id, 1 + region * self.draws) }
    }

    /// Records a dispatch of these workgroups, of which the third dimension is 1 or 0: as many as the loop's passes run.
    pub(crate) fn prepare_dispatch(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        id: LoopId,
        (groups, offset): (&wgpu::Buffer, u64),
    ) -> &wgpu::Buffer {
        encoder.copy_buffer_to_buffer(groups, offset, &self.dispatch, 0, 8);
        encoder.copy_buffer_to_buffer(&self.words, 4 * (LOOP_WORDS * id.0) as u64, &self.dispatch, 8, 4);
        &self.dispatch
    }

    /// Draws the three vertices of a fullscreen pass in a loop.
    pub(crate) fn draw_fullscreen(&self, pass: &mut wgpu::RenderPass<'_>, id: LoopId) {
        pass.draw_indirect(&self.arguments, self.offset(id, 0));
    }

    /// Draws the box of an object in a loop; its buffers are set.
    pub(crate) fn draw_box(&self, pass: &mut wgpu::RenderPass<'_>, (id, query): (LoopId, PassId), object: u32) {
        let Some(number) = self.number(query) else { return };
        let boxes = 1 + (1 + self.queries.len() as u32) * self.draws;
        pass.draw_indexed_indirect(&self.arguments, self.offset(id, boxes + number * self.objects + object));
    }

    fn number(&self, query: PassId) -> Option<u32> {
        self.queries.iter().position(|known| *known == query).map(|number| number as u32)
    }

    /// Returns the byte offset of the arguments of a draw in a loop.
    fn offset(&self, id: LoopId, draw: u32) -> u64 {
        let queries = self.queries.len() as u64;
        let of_loop = 1 + (1 + queries) * u64::from(self.draws) + queries * u64::from(self.objects);
        4 * u64::from(ARGUMENT_WORDS) * (of_loop * id.0 as u64 + u64::from(draw))
    }
}
