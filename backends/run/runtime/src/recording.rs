//! Records the passes, clears, copies and readbacks of a frame.
//!
//! Input: the renderer, an action of a segment and the caller's draw function. Output: commands in the caller's encoder. Nothing
//! fails here: the segment has been checked.

use std::ops::Range;

use fragbuf_codegen::{LoopId, PassId, PlannedPass, ResourceId};
use fragbuf_frame::{COUNTERS_RESOURCE, Cursor, HostWait, PassRun, WordRange, first_of_query};
use fragbuf_templates::vocabulary::{Kind, Objects};

use crate::attachments::{Attachments, Clears, OutputState, Textures};
use crate::conditional::ConditionalDraws;
use crate::draw::{Call, Draw, Output};
use crate::draws::CallArguments;
use crate::pattern::PATTERN;
use crate::pipeline::Pipeline;
use crate::pipelines::PreparedPass;
use crate::segment::{ActionRun, arguments};
use crate::{Error, Pending, Renderer};

/// The state of a frame that its passes read and change.
#[derive(Debug, Default)]
pub(crate) struct Recording {
    output: OutputState,
    /// Clears of textures that have not been recorded. The next pass with the texture as attachment begins with its clear.
    pub(crate) clears: Clears,
    /// The runs of passes so far.
    pub(crate) runs: Vec<PassId>,
    /// The workgroups of this segment's compute passes in loops that end on the device, and the byte offset of the next.
    workgroups: (Option<wgpu::Buffer>, u64),
}

impl Recording {
    /// Begins a segment with these workgroups.
    pub(crate) fn begin_segment(&mut self, workgroups: Option<wgpu::Buffer>) {
        self.workgroups = (workgroups, 0);
    }

    /// Records a copy between resources.
    pub(crate) fn copy(
        &mut self,
        renderer: &Renderer,
        encoder: &mut wgpu::CommandEncoder,
        from: ResourceId,
        to: ResourceId,
    ) {
        textures(renderer).clear_now(encoder, from, &mut self.clears);
        self.clears.remove(&to);
        let memory = &renderer.resources.memory;
        if let (Some(from), Some(to)) = (memory.texture(from.0), memory.texture(to.0)) {
            encoder.copy_texture_to_texture(from.as_image_copy(), to.as_image_copy(), from.size());
        }
        if let (Some(from), Some(to)) = (memory.buffer(from.0), memory.buffer(to.0)) {
            encoder.copy_buffer_to_buffer(from, 0, to, 0, from.size().min(to.size()));
        }
    }

    /// Records one run of a pass.
    pub(crate) fn pass(
        &mut self,
        renderer: &Renderer,
        encoder: &mut wgpu::CommandEncoder,
        (action, run): (&ActionRun, PassRun),
        cursor: &Cursor,
        (output, draw): (&Output<'_>, &mut Draw<'_>),
    ) {
        let resources = &renderer.resources;
        let Some(prepared) = renderer.pipeline_set().passes.get(run.pass.0) else { return };
        let Some(group) = resources.group(run.pass.0, prepared, run.flipped) else { return };
        let offset = resources.frame_blocks.offset(action.slice, run.iteration);
        let times = resources.timing.as_ref().and_then(|timing| timing.of(self.runs.len()));
        self.runs.push(run.pass);
        if let Pipeline::Compute(pipeline) = &prepared.pipeline {
            let timestamp_writes = times.map(|(query_set, begin, end)| wgpu::ComputePassTimestampWrites {
                query_set,
                beginning_of_pass_write_index: Some(begin),
                end_of_pass_write_index: Some(end),
            });
            let label = Some(prepared.pass.name.as_str());
            let arguments = match arguments_buffer(renderer, &prepared.pass, run.flipped) {
                None => self.conditional_workgroups(renderer, encoder, run),
                own => own,
            };
            let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor { label, timestamp_writes });
            pass.set_pipeline(pipeline);
            pass.set_bind_group(renderer.pipeline_set().group, group, &[offset]);
            match arguments {
                Some(arguments) => pass.dispatch_workgroups_indirect(arguments, 0),
                None => {
                    let [x, y, z] = action.groups;
                    pass.dispatch_workgroups(x, y, z);
                }
            }
            return;
        }
        let timestamp_writes = times.map(|(query_set, begin, end)| wgpu::RenderPassTimestampWrites {
            query_set,
            beginning_of_pass_write_index: Some(begin),
            end_of_pass_write_index: Some(end),
        });
        let mut pass = self.begin_render_pass(renderer, encoder, (prepared, run), output, timestamp_writes);
        if let Pipeline::Render(pipelines) = &prepared.pipeline
            && let Some(pipeline) = pipelines.get(run.iteration as usize).or(pipelines.first())
        {
            pass.set_pipeline(pipeline);
        }
        pass.set_stencil_reference(action.reference);
        pass.set_bind_group(renderer.pipeline_set().group, group, &[offset]);
        // There is no memory beyond the slice. A larger output keeps its other pixels; wgpu rejects a smaller one.
        let values = &resources.values;
        let first_row = action.slice * values.rows();
        pass.set_scissor_rect(0, first_row, values.width(), values.rows().min(values.height() - first_row));
        if let Some(query) = prepared.query {
            pass.begin_occlusion_query(query);
        }
        draw_pass(renderer, &mut pass, (&prepared.pass, run), cursor, draw);
        if prepared.query.is_some() {
            pass.end_occlusion_query();
        }
    }

    /// Returns the buffer with the workgroups of a compute pass in a loop that ends on the device.
    fn conditional_workgroups<'r>(
        &mut self,
        renderer: &'r Renderer,
        encoder: &mut wgpu::CommandEncoder,
        run: PassRun,
    ) -> Option<&'r wgpu::Buffer> {
        let (conditional, id) = conditional(renderer, run)?;
        let (workgroups, offset) = &mut self.workgroups;
        let of_run = (workgroups.as_ref()?, *offset);
        *offset += 8;
        Some(conditional.prepare_dispatch(encoder, id, of_run))
    }

    fn begin_render_pass<'e>(
        &mut self,
        renderer: &Renderer,
        encoder: &'e mut wgpu::CommandEncoder,
        (prepared, run): (&PreparedPass, PassRun),
        output: &Output<'_>,
        timestamp_writes: Option<wgpu::RenderPassTimestampWrites<'_>>,
    ) -> wgpu::RenderPass<'e> {
        let textures = textures(renderer);
        textures.clear_sampled(encoder, (&prepared.pass, run.flipped), &mut self.clears);
        let state = (&mut self.clears, &mut self.output);
        let attachments = Attachments::of(&textures, (&prepared.pass, run.flipped), output, state);
        let has_queries = prepared.query.is_some() || prepared.pass.objects == Objects::Boxes;
        encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some(prepared.pass.name.as_str()),
            color_attachments: &attachments.colors(),
            depth_stencil_attachment: attachments.depth_stencil(),
            timestamp_writes,
            occlusion_query_set: renderer.queries.as_ref().filter(|_| has_queries).map(|queries| &queries.set),
            ..wgpu::RenderPassDescriptor::default()
        })
    }
}

fn textures(renderer: &Renderer) -> Textures<'_> {
    let resources = &renderer.resources;
    Textures { plan: renderer.plan(), memory: &resources.memory, placeholders: &resources.placeholders }
}

fn draw_pass(
    renderer: &Renderer,
    pass: &mut wgpu::RenderPass<'_>,
    (planned, run): (&PlannedPass, PassRun),
    cursor: &Cursor,
    draw: &mut Draw<'_>,
) {
    match (&planned.kind, &planned.objects) {
        (Kind::Geometry, Objects::Boxes) => draw_boxes(renderer, pass, run, cursor),
        (Kind::Geometry, objects) => {
            let query = match objects {
                Objects::Visible(query) => renderer.plan().pass_id(query),
                _ => None,
            };
            let visible = query.and_then(|query| visible_objects(renderer, query, cursor));
            let arguments = conditional(renderer, run)
                .map_or(CallArguments::Direct, |(conditional, id)| conditional.scene(id, query));
            let draws = renderer.draws.as_deref().unwrap_or_default();
            draw(pass, &Call { pass: planned, objects: visible.as_deref(), draws, arguments });
        }
        _ => match (arguments_buffer(renderer, planned, run.flipped), conditional(renderer, run)) {
            (Some(arguments), _) => pass.draw_indirect(arguments, 0),
            (None, Some((conditional, id))) => conditional.draw_fullscreen(pass, id),
            (None, None) => pass.draw(0..3, 0..1),
        },
    }
}

/// Returns the loop around a run that ends on the device.
fn conditional(renderer: &Renderer, run: PassRun) -> Option<(&ConditionalDraws, LoopId)> {
    renderer.conditional.as_ref().zip(run.conditional)
}

/// Draws the box of every object in a query. The query of a dropped object is empty.
fn draw_boxes(renderer: &Renderer, pass: &mut wgpu::RenderPass<'_>, run: PassRun, cursor: &Cursor) {
    let Some(objects) = &renderer.objects else { return };
    let plan = renderer.plan();
    let query = first_of_query(plan, run.pass);
    let first = renderer.pipeline_set().loop_queries();
    for object in 0..objects.boxes().len() as u32 {
        pass.begin_occlusion_query(first + object);
        if let Some((conditional, id)) = conditional(renderer, run) {
            objects.bind(pass);
            conditional.draw_box(pass, (id, query), object);
        } else if !cursor.is_dropped(plan, query, object as usize) {
            objects.bind(pass);
            objects.draw(pass, object);
        }
        pass.end_occlusion_query();
    }
}

/// Returns the objects that a query has not dropped; `None` if the caller has set no objects.
fn visible_objects(renderer: &Renderer, query: PassId, cursor: &Cursor) -> Option<Vec<u32>> {
    let count = renderer.objects.as_ref().filter(|_| renderer.conditional.is_none())?.boxes().len() as u32;
    let plan = renderer.plan();
    Some((0..count).filter(|object| !cursor.is_dropped(plan, query, *object as usize)).collect())
}

/// Returns the buffer with the arguments of an indirect draw or dispatch.
fn arguments_buffer<'a>(renderer: &'a Renderer, pass: &PlannedPass, flipped: u32) -> Option<&'a wgpu::Buffer> {
    renderer.resources.memory.buffer(arguments(renderer.plan(), pass, flipped)?.0)
}

/// Copies the counters of a slice before the next slice clears them.
pub(crate) fn copy_slice_counters(renderer: &Renderer, encoder: &mut wgpu::CommandEncoder, slice: u32) {
    if let (Some(all), Some(counters)) = (&renderer.resources.slice_counters, renderer.buffer(COUNTERS_RESOURCE)) {
        encoder.copy_buffer_to_buffer(counters, 0, all, u64::from(slice) * counters.size(), counters.size());
    }
}

/// Records the clear of a buffer.
pub(crate) fn clear(renderer: &Renderer, encoder: &mut wgpu::CommandEncoder, resource: ResourceId, value: u32) {
    let Some(buffer) = renderer.resources.memory.buffer(resource.0) else { return };
    let Some((_, pattern)) = renderer.pipeline_set().patterns.iter().find(|(known, _)| *known == value) else {
        encoder.clear_buffer(buffer, 0, None);
        return;
    };
    for offset in (0..buffer.size()).step_by(PATTERN as usize) {
        encoder.copy_buffer_to_buffer(pattern, 0, buffer, offset, PATTERN.min(buffer.size() - offset));
    }
}

/// Words for the host.
#[derive(Debug)]
pub(crate) enum Readback {
    Pending(Pending<Vec<u32>>),
    /// This many zeros: for an empty resource, a range beyond a buffer's end, or the samples of a pass that has not run.
    Zeros(u64),
}

impl Readback {
    pub(crate) fn is_ready(&self) -> bool {
        match self {
            Readback::Pending(pending) => pending.is_ready(),
            Readback::Zeros(_) => true,
        }
    }

    /// Waits for the words and appends them.
    pub(crate) async fn append_to(self, words: &mut Vec<u32>) -> Result<(), Error> {
        match self {
            Readback::Pending(pending) => words.extend(pending.await?),
            Readback::Zeros(count) => words.resize(words.len() + count as usize, 0),
        }
        Ok(())
    }
}

/// Records the readbacks of the words that the host waits for. `runs`: the runs of passes so far.
pub(crate) fn readbacks(
    renderer: &Renderer,
    encoder: &mut wgpu::CommandEncoder,
    wait: &HostWait,
    runs: &[PassId],
) -> Vec<Readback> {
    let pipelines = renderer.pipeline_set();
    let queries = |encoder: &mut wgpu::CommandEncoder, range: Range<u32>| match &renderer.queries {
        Some(queries) if !range.is_empty() => Readback::Pending(queries.read(&renderer.device, encoder, range)),
        _ => Readback::Zeros(1),
    };
    match wait {
        HostWait::Samples(pass) => {
            let has_run = runs.contains(pass);
            let query = pipelines.passes.get(pass.0).and_then(|prepared| prepared.query).filter(|_| has_run);
            vec![queries(encoder, query.map_or(0..0, |query| query..query + 1))]
        }
        HostWait::Objects(_) => match &renderer.objects {
            None => Vec::new(),
            Some(objects) => {
                let first = pipelines.loop_queries();
                vec![queries(encoder, first..first + objects.boxes().len() as u32)]
            }
        },
        HostWait::Words(ranges) => ranges.iter().map(|range| read_words(renderer, encoder, *range)).collect(),
    }
}

fn read_words(renderer: &Renderer, encoder: &mut wgpu::CommandEncoder, range: WordRange) -> Readback {
    let WordRange { resource, first, count } = range;
    let buffer = renderer.resources.memory.buffer(resource.0);
    match buffer.filter(|buffer| count > 0 && 4 * (first + count) <= buffer.size()) {
        None => Readback::Zeros(count),
        Some(buffer) => {
            Readback::Pending(Pending::record(&renderer.device, encoder, buffer, 4 * first, 4 * count, |words| words))
        }
    }
}
