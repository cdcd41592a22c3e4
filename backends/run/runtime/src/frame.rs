//! One frame: recorded into the caller's encoder, cut wherever the host must read before it goes on.
//!
//! ```text
//! begin ─► record ─► Finished
//!            └─────► Cut: submit what was recorded ─► resume ─► record …
//! ```
//!
//! A frame is handed on from call to call, so that a segment cannot be recorded twice or out of order.

use std::ops::Range;

use fragbuf_codegen::{PassId, PlannedPass, ResourceId};
use fragbuf_frame::{COUNTERS_RESOURCE, Looped, Question, Run, Span, Turn};
use fragbuf_templates::vocabulary::{Kind, Objects, Pass};

use crate::attachments::{Attachments, Clears, Written, clear_now, clear_sampled};
use crate::pattern::PATTERN;
use crate::pipeline::Pipeline;
use crate::scope::scoped;
use crate::walk::{self, Part, Place, segment};
use crate::{Error, Pending, Renderer};

/// A frame, somewhere between its first and its last step.
#[derive(Debug)]
pub struct Frame {
    id: u64,
    at: Place,
    written: Written,
    /// Textures that the next pass attached to them begins with clearing.
    clears: Clears,
    /// The runs of passes so far.
    runs: Vec<PassId>,
}

/// What [`Frame::record`] came to.
#[must_use = "a cut frame goes on with `Cut::resume`"]
#[allow(clippy::large_enum_variant, reason = "one is made per submission, and none is kept")]
pub enum Recorded {
    /// The frame is whole once this has been submitted. Also: how its loops have ended whose ends are found out while it runs;
    /// nothing where memory was reserved, because then nobody asks.
    Finished(Vec<Looped>),
    /// Submit what was recorded, then resume.
    Cut(Cut),
}

/// A frame that waits for the host.
pub struct Cut {
    frame: Frame,
    question: Question,
    reads: Vec<Read>,
}

/// What the host reads.
enum Read {
    Pending(Pending<Vec<u32>>),
    /// So many zeros: words of an empty resource, or of a buffer that ends before them; samples of a pass that did not run.
    Nothing(u64),
}

/// One draw that is the caller's.
#[derive(Clone, Copy, Debug)]
pub struct Call<'a> {
    /// The pass.
    pub pass: &'a Pass,
    /// The objects to draw, by their numbers in [`Renderer::set_objects`]; `None`: all.
    pub objects: Option<&'a [u32]>,
}

/// Where frames are resolved into.
#[derive(Clone, Copy, Debug)]
pub struct Output<'a> {
    /// One sample per pixel, of the renderer's format and at least its size; the frame is its top left. Colours written to
    /// it are premultiplied.
    pub view: &'a wgpu::TextureView,
    /// `Load`: over what is there; `Clear`: over this background.
    pub load: wgpu::LoadOp<wgpu::Color>,
}

/// The caller's draw function: called for each geometry pass of each slice, with the pipeline, the bind group and the
/// scissor rectangle set, which is the slice.
pub type Draw<'a> = dyn FnMut(&mut wgpu::RenderPass<'_>, &Call<'_>) + 'a;

impl Frame {
    pub(crate) fn new(renderer: &Renderer) -> Self {
        let at = Place::new(renderer);
        Frame { id: renderer.frame_id, at, written: Written::No, clears: Clears::new(), runs: Vec::new() }
    }

    /// Records everything up to the next decision of the host, or to the end.
    pub fn record(
        mut self,
        renderer: &Renderer,
        encoder: &mut wgpu::CommandEncoder,
        output: &Output<'_>,
        draw: &mut Draw<'_>,
    ) -> Result<Recorded, Error> {
        if self.id != renderer.frame_id {
            return Err(Error::StaleFrame);
        }
        // Whatever can fail does so before anything is recorded.
        let segment = segment(renderer, self.at.clone())?;
        for part in &segment.parts {
            match part {
                Part::SliceEnd(slice) => tally(renderer, encoder, *slice),
                Part::Turn { slice, turn, groups, reference } => match turn {
                    Turn::Clear { resource, value } if renderer.sized.memory.texture(resource.0).is_some() => {
                        self.clears.insert(*resource, *value);
                    }
                    Turn::Clear { resource, value } => clear(renderer, encoder, *resource, *value),
                    Turn::Copy { from, to } => self.copy(renderer, encoder, *from, *to),
                    Turn::Pass(run) => {
                        let recording = Recording { run: *run, slice: *slice, groups: *groups, reference: *reference };
                        self.pass(renderer, encoder, &recording, output, draw);
                    }
                    Turn::Ask(_) => {}
                },
            }
        }
        self.at = segment.end;
        let Some(question) = segment.question else {
            if let Some(timing) = &renderer.sized.timing {
                timing.resolve(encoder, &self.runs);
            }
            renderer.leave_flipped(self.at.flipped);
            return Ok(Recorded::Finished(self.at.loops));
        };
        let reads = self.reads(renderer, encoder, &question);
        Ok(Recorded::Cut(Cut { reads, question, frame: self }))
    }

    fn copy(&mut self, renderer: &Renderer, encoder: &mut wgpu::CommandEncoder, from: ResourceId, to: ResourceId) {
        clear_now(renderer, encoder, from, &mut self.clears);
        self.clears.remove(&to);
        copy(renderer, encoder, from, to);
    }

    fn pass(
        &mut self,
        renderer: &Renderer,
        encoder: &mut wgpu::CommandEncoder,
        recording: &Recording,
        output: &Output<'_>,
        draw: &mut Draw<'_>,
    ) {
        let Recording { run, slice, .. } = recording;
        let sized = &renderer.sized;
        let Some(prepared) = renderer.made().passes.get(run.pass.0) else { return };
        let Some(group) = sized.group(run.pass.0, prepared, run.flipped) else { return };
        let offset = sized.frames.offset(*slice, run.iteration);
        let times = sized.timing.as_ref().and_then(|timing| timing.of(self.runs.len()));
        self.runs.push(run.pass);
        let label = Some(prepared.pass.anchor.as_str());
        if let Pipeline::Compute(pipeline) = &prepared.pipeline {
            let timestamp_writes = times.map(|(query_set, begin, end)| wgpu::ComputePassTimestampWrites {
                query_set,
                beginning_of_pass_write_index: Some(begin),
                end_of_pass_write_index: Some(end),
            });
            let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor { label, timestamp_writes });
            pass.set_pipeline(pipeline);
            pass.set_bind_group(renderer.made().group, group, &[offset]);
            match arguments(renderer, &prepared.pass, run.flipped) {
                Some(arguments) => pass.dispatch_workgroups_indirect(arguments, 0),
                None => {
                    let [x, y, z] = recording.groups;
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
        clear_sampled(renderer, encoder, (&prepared.pass, run.flipped), &mut self.clears);
        let state = (&mut self.clears, &mut self.written);
        let attachments = Attachments::of(renderer, (&prepared.pass, run.flipped), output, state);
        let asks = prepared.query.is_some() || prepared.pass.objects == Objects::Boxes;
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label,
            color_attachments: &attachments.colors(),
            depth_stencil_attachment: attachments.depth_stencil(),
            timestamp_writes,
            occlusion_query_set: renderer.queries.as_ref().filter(|_| asks).map(|queries| &queries.set),
            ..wgpu::RenderPassDescriptor::default()
        });
        if let Pipeline::Render(pipelines) = &prepared.pipeline
            && let Some(pipeline) = pipelines.get(run.iteration as usize).or(pipelines.first())
        {
            pass.set_pipeline(pipeline);
        }
        pass.set_stencil_reference(recording.reference);
        pass.set_bind_group(renderer.made().group, group, &[offset]);
        // Beyond the slice there is no memory: a greater output is left as it is, a smaller one refused.
        let values = &sized.values;
        let first_row = slice * values.rows();
        pass.set_scissor_rect(0, first_row, values.width(), values.rows().min(values.height() - first_row));
        if let Some(query) = prepared.query {
            pass.begin_occlusion_query(query);
        }
        self.draw(renderer, &mut pass, (&prepared.pass, *run), draw);
        if prepared.query.is_some() {
            pass.end_occlusion_query();
        }
    }

    /// Records the readback of what a question asks for.
    fn reads(&self, renderer: &Renderer, encoder: &mut wgpu::CommandEncoder, question: &Question) -> Vec<Read> {
        let made = renderer.made();
        let queries = |encoder: &mut wgpu::CommandEncoder, range: Range<u32>| match &renderer.queries {
            Some(queries) if !range.is_empty() => Read::Pending(queries.read(&renderer.device, encoder, range)),
            _ => Read::Nothing(1),
        };
        match question {
            Question::Samples(pass) => {
                let has_run = self.runs.contains(pass);
                let query = made.passes.get(pass.0).and_then(|prepared| prepared.query).filter(|_| has_run);
                vec![queries(encoder, query.map_or(0..0, |query| query..query + 1))]
            }
            Question::Objects(_) => match &renderer.objects {
                None => Vec::new(),
                Some(objects) => {
                    let first = made.awaited();
                    vec![queries(encoder, first..first + objects.boxes().len() as u32)]
                }
            },
            Question::Words(spans) => spans.iter().map(|span| read(renderer, encoder, *span)).collect(),
        }
    }

    fn draw(
        &self,
        renderer: &Renderer,
        pass: &mut wgpu::RenderPass<'_>,
        (planned, run): (&PlannedPass, Run),
        draw: &mut Draw<'_>,
    ) {
        match (&planned.kind, &planned.objects) {
            (Kind::Geometry, Objects::Boxes) => self.boxes(renderer, pass, run.pass),
            (Kind::Geometry, Objects::All) => draw(pass, &Call { pass: planned, objects: None }),
            (Kind::Geometry, Objects::Visible(query)) => {
                let seen = self.visible(renderer, query);
                draw(pass, &Call { pass: planned, objects: seen.as_deref() });
            }
            _ => match arguments(renderer, planned, run.flipped) {
                Some(arguments) => pass.draw_indirect(arguments, 0),
                None => pass.draw(0..3, 0..1),
            },
        }
    }

    /// A query for the box of every object. Of one that has been dropped it is empty.
    fn boxes(&self, renderer: &Renderer, pass: &mut wgpu::RenderPass<'_>, query: PassId) {
        let Some(objects) = &renderer.objects else { return };
        let first = renderer.made().awaited();
        for object in 0..objects.boxes().len() as u32 {
            pass.begin_occlusion_query(first + object);
            if !self.at.cursor.is_dropped(renderer.plan(), query, object as usize) {
                objects.draw(pass, object);
            }
            pass.end_occlusion_query();
        }
    }

    /// The objects that a query has not dropped; `None`: the scene is one object.
    fn visible(&self, renderer: &Renderer, query: &str) -> Option<Vec<u32>> {
        let count = renderer.objects.as_ref()?.boxes().len() as u32;
        let plan = renderer.plan();
        let query = plan.pass_id(query)?;
        Some((0..count).filter(|object| !self.at.cursor.is_dropped(plan, query, *object as usize)).collect())
    }
}

/// What a run of a pass is recorded with.
struct Recording {
    run: Run,
    slice: u32,
    groups: [u32; 3],
    reference: u32,
}

/// The buffer that says what a pass draws or dispatches, where there is one.
fn arguments<'a>(renderer: &'a Renderer, pass: &PlannedPass, flipped: u32) -> Option<&'a wgpu::Buffer> {
    renderer.sized.memory.filled(walk::arguments(renderer.plan(), pass, flipped)?.0)
}

impl Cut {
    /// Whether everything has arrived: resuming will not wait for the device.
    pub fn is_ready(&self) -> bool {
        self.reads.iter().all(|read| match read {
            Read::Pending(pending) => pending.is_ready(),
            Read::Nothing(_) => true,
        })
    }

    /// Waits for what the host reads, decides, and makes room. On an error the frame is over, and the renderer as it was.
    pub async fn resume(self, renderer: &mut Renderer) -> Result<Frame, Error> {
        let mut words = Vec::with_capacity(self.reads.len());
        for read in self.reads {
            match read {
                Read::Pending(pending) => words.extend(pending.await?),
                Read::Nothing(count) => words.resize(words.len() + count as usize, 0),
            }
        }
        let mut frame = self.frame;
        if frame.id != renderer.frame_id {
            return Err(Error::StaleFrame);
        }
        if let Question::Objects(_) = self.question {
            words = seen(renderer, words);
        }
        let before = renderer.live();
        let mut values = before.clone();
        let plan = renderer.plan();
        frame.at.cursor.answer(plan, &words, &mut values)?;
        if values != before {
            renderer.decide(values).await?;
            frame.id = renderer.frame_id;
        }
        Ok(frame)
    }
}

/// One word per object: whether a sample of its box passed, or no query can judge it.
fn seen(renderer: &Renderer, words: Vec<u32>) -> Vec<u32> {
    match &renderer.objects {
        None => vec![1],
        Some(objects) => {
            let boxes = objects.boxes().iter().zip(words);
            boxes.map(|(one, word)| word | u32::from(renderer.crosses_near_plane(one))).collect()
        }
    }
}

impl Renderer {
    /// A whole frame, submitted; blocks where the host must read. Not for browsers: there, record segments and await. What
    /// comes back is how its loops have ended ([`Recorded::Finished`]).
    pub fn render(&mut self, output: &Output<'_>, draw: &mut Draw<'_>) -> Result<Vec<Looped>, Error> {
        let mut frame = self.begin()?;
        loop {
            let device = self.device.clone();
            let segment = || {
                let descriptor = wgpu::CommandEncoderDescriptor { label: Some("fragbuf") };
                let mut encoder = device.create_command_encoder(&descriptor);
                let recorded = frame.record(self, &mut encoder, output, draw)?;
                self.queue.submit([encoder.finish()]);
                Ok::<_, Error>(recorded)
            };
            let recorded = crate::block_on(&device, scoped(&device, "the frame's commands", 0, segment))??;
            let cut = match recorded? {
                Recorded::Finished(loops) => return Ok(loops),
                Recorded::Cut(cut) => cut,
            };
            frame = crate::block_on(&device, cut.resume(self))??;
        }
    }
}

/// Keeps what a slice has counted before the next one counts anew.
fn tally(renderer: &Renderer, encoder: &mut wgpu::CommandEncoder, slice: u32) {
    if let (Some(tally), Some(counters)) = (&renderer.sized.tally, renderer.buffer(COUNTERS_RESOURCE)) {
        encoder.copy_buffer_to_buffer(counters, 0, tally, u64::from(slice) * counters.size(), counters.size());
    }
}

fn read(renderer: &Renderer, encoder: &mut wgpu::CommandEncoder, Span { resource, first, count }: Span) -> Read {
    let filled = renderer.sized.memory.filled(resource.0);
    match filled.filter(|buffer| count > 0 && 4 * (first + count) <= buffer.size()) {
        None => Read::Nothing(count),
        Some(buffer) => {
            Read::Pending(Pending::record(&renderer.device, encoder, buffer, 4 * first, 4 * count, |words| words))
        }
    }
}

fn clear(renderer: &Renderer, encoder: &mut wgpu::CommandEncoder, resource: ResourceId, value: u32) {
    let Some(buffer) = renderer.sized.memory.filled(resource.0) else { return };
    let Some((_, pattern)) = renderer.made().patterns.iter().find(|(known, _)| *known == value) else {
        encoder.clear_buffer(buffer, 0, None);
        return;
    };
    for offset in (0..buffer.size()).step_by(PATTERN as usize) {
        encoder.copy_buffer_to_buffer(pattern, 0, buffer, offset, PATTERN.min(buffer.size() - offset));
    }
}

fn copy(renderer: &Renderer, encoder: &mut wgpu::CommandEncoder, from: ResourceId, to: ResourceId) {
    let memory = &renderer.sized.memory;
    if let (Some(from), Some(to)) = (memory.texture(from.0), memory.texture(to.0)) {
        encoder.copy_texture_to_texture(from.as_image_copy(), to.as_image_copy(), from.size());
    }
    if let (Some(from), Some(to)) = (memory.filled(from.0), memory.filled(to.0)) {
        encoder.copy_buffer_to_buffer(from, 0, to, 0, from.size().min(to.size()));
    }
}
