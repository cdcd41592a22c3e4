//! One frame: recorded into the caller's encoder, cut wherever the host must read before it goes on.
//!
//! ```text
//! begin ─► record ─► Finished
//!            └─────► Cut: submit what was recorded ─► resume ─► record …
//! ```
//!
//! A frame is handed on from call to call, so that a segment cannot be recorded twice or out of order.

use std::collections::BTreeSet;

use fragbuf_frame::{COUNTERS_RESOURCE, Decision};
use fragbuf_templates::vocabulary::{Formula, Kind, Pass};

use crate::action::{Action, Run};
use crate::attachments::{Attachments, Clears, Written, clear_sampled};
use crate::pattern::PATTERN;
use crate::pipeline::Pipeline;
use crate::scope::scoped;
use crate::walk::{Ends, Place, Question, Step, segment};
use crate::{Error, Pending, Renderer};

/// A frame, somewhere between its first and its last step.
#[derive(Debug)]
pub struct Frame {
    id: u64,
    at: Place,
    written: Written,
    /// Textures that the next pass attached to them begins with clearing.
    clears: Clears,
    /// The first query of every run so far.
    timed: BTreeSet<u32>,
}

/// What [`Frame::record`] came to.
#[must_use = "a cut frame goes on with `Cut::resume`"]
pub enum Recorded {
    /// The frame is whole once this has been submitted.
    Finished,
    /// Submit what was recorded, then resume.
    Cut(Cut),
}

/// A frame that waits for the host.
pub struct Cut {
    frame: Frame,
    question: Question,
    reads: Vec<Pending<Vec<u32>>>,
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
pub type Draw<'a> = dyn FnMut(&mut wgpu::RenderPass<'_>, &Pass) + 'a;

impl Frame {
    pub(crate) fn new(id: u64) -> Self {
        Frame { id, at: Place::default(), written: Written::No, clears: Clears::new(), timed: BTreeSet::new() }
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
        let segment = segment(renderer, self.at)?;
        let places = segment.question.as_ref().map(|question| places(renderer, question)).transpose()?;
        for step in &segment.steps {
            match step.action {
                Action::Clear { resource, value } if renderer.sized.memory.texture(*resource).is_some() => {
                    self.clears.insert(*resource, *value);
                }
                Action::Clear { resource, value } => clear(renderer, encoder, *resource, *value),
                Action::Copy { from, to } => copy(renderer, encoder, *from, *to),
                Action::Pass(run) => self.pass(renderer, encoder, (*run, step), output, draw),
                Action::Host(_) | Action::Again(_) => {}
            }
            if let Ends::Slice = step.ends {
                tally(renderer, encoder, step.slice);
            }
        }
        self.at = segment.end;
        let (Some(question), Some(places)) = (segment.question, places) else {
            if let Some(timing) = &renderer.sized.timing {
                timing.resolve(encoder, &self.timed);
            }
            return Ok(Recorded::Finished);
        };
        let device = &renderer.device;
        let reads =
            places.into_iter().map(|(buffer, place)| Pending::record(device, encoder, buffer, place, 4, |words| words));
        Ok(Recorded::Cut(Cut { reads: reads.collect(), question, frame: self }))
    }

    fn pass(
        &mut self,
        renderer: &Renderer,
        encoder: &mut wgpu::CommandEncoder,
        (run, step): (Run, &Step<'_>),
        output: &Output<'_>,
        draw: &mut Draw<'_>,
    ) {
        let (sized, slice) = (&renderer.sized, step.slice);
        let round = sized.slices.get(slice as usize).and_then(|rounds| rounds.get((run.round + step.round) as usize));
        let group = round.and_then(|round| round.groups.get(run.pass));
        let (Some(prepared), Some(group)) = (renderer.made().passes.get(run.pass), group) else { return };
        let number = run.number + step.round as usize * run.stride;
        let times = sized.timing.as_ref().map(|timing| timing.of(number, slice));
        self.timed.extend(times.map(|(_, begin, _)| begin));
        let label = Some(prepared.pass.anchor.as_str());
        if let Pipeline::Compute(pipeline) = &prepared.pipeline {
            let timestamp_writes = times.map(|(query_set, begin, end)| wgpu::ComputePassTimestampWrites {
                query_set,
                beginning_of_pass_write_index: Some(begin),
                end_of_pass_write_index: Some(end),
            });
            let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor { label, timestamp_writes });
            pass.set_pipeline(pipeline);
            pass.set_bind_group(renderer.made().group, group, &[]);
            let [x, y, z] = step.groups;
            pass.dispatch_workgroups(x, y, z);
            return;
        }
        let timestamp_writes = times.map(|(query_set, begin, end)| wgpu::RenderPassTimestampWrites {
            query_set,
            beginning_of_pass_write_index: Some(begin),
            end_of_pass_write_index: Some(end),
        });
        clear_sampled(renderer, encoder, &prepared.pass, &mut self.clears);
        let state = (&mut self.clears, &mut self.written);
        let attachments = Attachments::of(renderer, &prepared.pass, output, state);
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label,
            color_attachments: &attachments.colors(),
            depth_stencil_attachment: attachments.depth_stencil(),
            timestamp_writes,
            ..wgpu::RenderPassDescriptor::default()
        });
        if let Pipeline::Render(pipelines) = &prepared.pipeline
            && let Some(pipeline) = pipelines.get((run.round + step.round) as usize).or(pipelines.first())
        {
            pass.set_pipeline(pipeline);
        }
        pass.set_stencil_reference(step.reference);
        pass.set_bind_group(renderer.made().group, group, &[]);
        // Beyond the slice there is no memory: a greater output is left as it is, a smaller one refused.
        let symbols = &sized.symbols;
        let first_row = slice * symbols.rows;
        pass.set_scissor_rect(0, first_row, symbols.width, symbols.rows.min(symbols.height - first_row));
        match prepared.pass.kind {
            Kind::Geometry => draw(&mut pass, &prepared.pass),
            _ => pass.draw(0..3, 0..1),
        }
    }
}

impl Cut {
    /// Whether everything has arrived: resuming will not wait for the device.
    pub fn is_ready(&self) -> bool {
        self.reads.iter().all(Pending::is_ready)
    }

    /// Waits for what the host reads, decides, and makes room. On an error the frame is over, and the renderer as it was.
    pub async fn resume(self, renderer: &mut Renderer) -> Result<Frame, Error> {
        let mut words = Vec::with_capacity(self.reads.len());
        for read in self.reads {
            words.extend(read.await?);
        }
        if self.frame.id != renderer.frame_id {
            return Err(Error::StaleFrame);
        }
        let decision = match self.question {
            Question::Decision(decision) => decision,
            Question::Round(again, bound) => {
                let word = words.first().copied().unwrap_or(0);
                return Ok(Frame { at: self.frame.at.answered(&again, bound, word), ..self.frame });
            }
        };
        let mut symbols = renderer.sized.symbols.clone();
        decision.apply(&words, &mut symbols);
        // Room for a little more than is needed is kept; room for more than twice as much is given back.
        for (name, needed) in &mut symbols.counted {
            let room = renderer.sized.symbols.counted(name).unwrap_or(0);
            *needed = needed.map(|needed| if needed <= room && room <= 2 * needed { room } else { needed });
        }
        renderer.reallocate(symbols).await?;
        renderer.write_frame()?;
        Ok(Frame { id: renderer.frame_id, ..self.frame })
    }
}

impl Renderer {
    /// A whole frame, submitted; blocks where the host must read. Not for browsers: there, record segments and await.
    pub fn render(&mut self, output: &Output<'_>, draw: &mut Draw<'_>) -> Result<(), Error> {
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
            let Recorded::Cut(cut) = recorded? else { return Ok(()) };
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

/// Buffer and byte of each word that the host reads.
fn places<'a>(renderer: &'a Renderer, question: &Question) -> Result<Vec<(&'a wgpu::Buffer, u64)>, Error> {
    let filled = |resource: usize| renderer.sized.memory.filled(resource);
    let reads: &[(usize, Formula)] = match question {
        Question::Decision(Decision { reads, .. }) => reads,
        Question::Round(again, _) => return Ok(filled(again.zero).into_iter().map(|buffer| (buffer, 0)).collect()),
    };
    let places = reads.iter().filter_map(|(resource, place)| {
        let buffer = filled(*resource)?;
        let name = || renderer.plan().resources.get(*resource).map_or(String::new(), |p| p.resource.name.clone());
        let word = renderer.sized.symbols.evaluate(renderer.plan(), place, &format!("the index into `{}`", name()));
        Some(word.map(|word| (buffer, 4 * word)).map_err(Error::from))
    });
    places.collect()
}

fn clear(renderer: &Renderer, encoder: &mut wgpu::CommandEncoder, resource: usize, value: u32) {
    let Some(buffer) = renderer.sized.memory.filled(resource) else { return };
    let Some((_, pattern)) = renderer.made().patterns.iter().find(|(known, _)| *known == value) else {
        encoder.clear_buffer(buffer, 0, None);
        return;
    };
    for offset in (0..buffer.size()).step_by(PATTERN as usize) {
        encoder.copy_buffer_to_buffer(pattern, 0, buffer, offset, PATTERN.min(buffer.size() - offset));
    }
}

fn copy(renderer: &Renderer, encoder: &mut wgpu::CommandEncoder, from: usize, to: usize) {
    let memory = &renderer.sized.memory;
    if let (Some(from), Some(to)) = (memory.texture(from), memory.texture(to)) {
        encoder.copy_texture_to_texture(from.as_image_copy(), to.as_image_copy(), from.size());
    }
    if let (Some(from), Some(to)) = (memory.filled(from), memory.filled(to)) {
        encoder.copy_buffer_to_buffer(from, 0, to, 0, from.size().min(to.size()));
    }
}
