//! One frame: recorded into the caller's encoder, and suspended wherever the host must read before it continues.
//!
//! ```text
//! begin ─► record ─► Finished
//!            └─────► SuspendedFrame: submit the recorded commands ─► resume ─► record …
//! ```
//!
//! Each call takes the frame by value, so that a segment cannot be recorded twice or out of order.

use fragbuf_frame::{Conditions, FrameStep, HostWait, LoopReport, check_conditions};

use crate::conditional::workgroups_of;
use crate::draw::{Draw, Output};
use crate::error_scope::{in_error_scope, is_lost};
use crate::external::missing;
use crate::lagged::FrameReads;
use crate::recording::{Readback, Recording, clear, copy_slice_counters, readbacks};
use crate::segment::{FrameCursor, SegmentPart, segment};
use crate::{Error, Renderer};

/// A frame at some position between its first and its last step.
#[derive(Debug)]
pub struct Frame {
    id: u64,
    at: FrameCursor,
    recording: Recording,
    /// Whether a part of it is recorded.
    is_begun: bool,
    /// The words for lagged decisions; `None` if the frame copies none.
    reads: Option<FrameReads>,
}

/// The result of [`Frame::record`].
#[must_use = "a suspended frame continues with `SuspendedFrame::resume`"]
#[allow(clippy::large_enum_variant, reason = "there is one per submission, and it is not stored")]
pub enum Recorded {
    /// The frame is complete once the commands are submitted. The reports are on the loops that end on a condition; there are
    /// none if memory was reserved, because then loops run to their limits, and none if they end on the device
    /// ([`Renderer::loop_reports`]).
    Finished(Vec<LoopReport>),
    /// Submit the recorded commands, then resume.
    Suspended(SuspendedFrame),
}

/// A frame that is suspended at a readback.
pub struct SuspendedFrame {
    frame: Frame,
    wait: HostWait,
    readbacks: Vec<Readback>,
}

impl Frame {
    /// Records everything up to the next readback of the host, or to the end.
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
        // All errors occur here, before anything is recorded.
        let segment = segment(&renderer.frame_inputs(), self.at.clone())?;
        if let Some(conditional) = renderer.conditional.as_ref().filter(|_| !self.is_begun) {
            conditional.begin_frame(encoder);
        }
        self.is_begun = true;
        self.recording.begin_segment(workgroups_of(&renderer.device, &segment.parts));
        for part in &segment.parts {
            let action = match part {
                SegmentPart::SliceEnd(slice) => {
                    copy_slice_counters(renderer, encoder, *slice);
                    if let Some(conditional) = &renderer.conditional {
                        conditional.begin_slice(encoder, renderer.plan());
                    }
                    continue;
                }
                SegmentPart::Action(action) => action,
            };
            match &action.step {
                FrameStep::Clear { resource, value } if renderer.resources.memory.texture(resource.0).is_some() => {
                    self.recording.clears.insert(*resource, *value);
                }
                FrameStep::Clear { resource, value } => clear(renderer, encoder, *resource, *value),
                FrameStep::Copy { from, to } => self.recording.copy(renderer, encoder, *from, *to),
                FrameStep::Pass(run) => {
                    // A later slice has its own cursor: no object is culled in it before its first readback.
                    let cursor = if action.slice == self.at.slice { &self.at.cursor } else { &segment.end.cursor };
                    self.recording.pass(renderer, encoder, (action, *run), cursor, (output, draw));
                }
                FrameStep::Read(read) => {
                    if let Some(reads) = &mut self.reads {
                        let wait = HostWait::Words(read.ranges.clone());
                        reads.push((read.clone(), readbacks(renderer, encoder, &wait, &self.recording.runs)));
                    }
                }
                FrameStep::Condition(condition) => {
                    if let Some(conditional) = &renderer.conditional {
                        conditional.update(renderer, encoder, condition);
                    }
                }
                FrameStep::Wait(_) => {}
            }
        }
        self.at = segment.end;
        let Some(wait) = segment.wait else {
            if let Some(timing) = &renderer.resources.timing {
                timing.resolve(encoder, &self.recording.runs);
            }
            renderer.store_flipped(self.at.flipped);
            renderer.store_reads(self.reads.unwrap_or_default());
            return Ok(Recorded::Finished(self.at.loops));
        };
        let readbacks = readbacks(renderer, encoder, &wait, &self.recording.runs);
        Ok(Recorded::Suspended(SuspendedFrame { readbacks, wait, frame: self }))
    }
}

impl SuspendedFrame {
    /// Whether all readbacks are complete, so that resuming does not wait for the device.
    pub fn is_ready(&self) -> bool {
        self.readbacks.iter().all(Readback::is_ready)
    }

    /// Waits for the readbacks, runs the host step, and allocates memory as it decides. After an error the frame is over, and
    /// the renderer is unchanged.
    pub async fn resume(self, renderer: &mut Renderer) -> Result<Frame, Error> {
        let mut words = Vec::with_capacity(self.readbacks.len());
        for readback in self.readbacks {
            readback.append_to(&mut words).await?;
        }
        let mut frame = self.frame;
        if frame.id != renderer.frame_id {
            return Err(Error::StaleFrame);
        }
        if let HostWait::Objects(_) = self.wait {
            words = visibility(renderer, words);
        }
        let before = renderer.current_values();
        let mut values = before.clone();
        let plan = renderer.plan();
        frame.at.cursor.supply(plan, &words, &mut values)?;
        renderer.lag.record(&values);
        if values != before {
            renderer.apply_decision(values).await?;
            frame.id = renderer.frame_id;
        }
        Ok(frame)
    }
}

/// Returns one word per object: not 0 if a sample of its box passed, or if no query can decide whether it is visible.
fn visibility(renderer: &Renderer, words: Vec<u32>) -> Vec<u32> {
    match &renderer.objects {
        None => vec![1],
        Some(objects) => {
            let boxes = objects.boxes().iter().zip(words);
            boxes.map(|(one, word)| word | u32::from(renderer.is_undecided(one))).collect()
        }
    }
}

impl Renderer {
    /// Starts a frame; an unfinished frame becomes stale. Submit the commands of a frame before the next one begins, because
    /// uniform buffers are written ahead of the next submission. Fails if an external texture is not set.
    pub fn begin(&mut self) -> Result<Frame, Error> {
        if is_lost(&self.device) {
            return Err(Error::DeviceLost);
        }
        if let Some(number) = self.resources.memory.missing_texture() {
            return Err(missing(self.plan().resources.get(number).map_or("", |planned| &planned.resource.name)));
        }
        self.write_frame_blocks()?;
        self.frame_id += 1;
        let conditions = self.begin_conditions()?;
        let at = FrameCursor::new(self.plan(), self.frame_readbacks(), conditions, self.flipped());
        let reads = self.copies_reads().then(Vec::new);
        Ok(Frame { id: self.frame_id, at, recording: Recording::default(), is_begun: false, reads })
    }

    /// Writes which objects the device must not drop. Returns who evaluates the conditions of the frame.
    fn begin_conditions(&self) -> Result<Conditions, Error> {
        check_conditions(self.plan(), self.conditions)?;
        let Some(conditional) = &self.conditional else { return Ok(Conditions::OnHost) };
        if self.draws.is_none() {
            return Err(Error::BadValue {
                name: "the draws of the scene".to_owned(),
                expected: "set with `Renderer::set_draws`, because the device ends the loops of the frame".to_owned(),
            });
        }
        if let Some(objects) = &self.objects {
            let undecided: Vec<u32> =
                objects.boxes().iter().map(|object| u32::from(self.is_undecided(object))).collect();
            conditional.write_undecided(&self.queue, &undecided);
        }
        Ok(self.conditions)
    }

    /// Renders and submits a whole frame, and blocks where the host must read. Browsers cannot block: record segments and await
    /// there. Lagged decisions are applied first ([`Renderer::decide`]). Returns reports on the loops ([`Recorded::Finished`]).
    pub fn render(&mut self, output: &Output<'_>, draw: &mut Draw<'_>) -> Result<Vec<LoopReport>, Error> {
        let device = self.device.clone();
        crate::block_on(&device, self.decide())??;
        let mut frame = self.begin()?;
        loop {
            let record = || {
                let descriptor = wgpu::CommandEncoderDescriptor { label: Some("fragbuf") };
                let mut encoder = device.create_command_encoder(&descriptor);
                let recorded = frame.record(self, &mut encoder, output, draw)?;
                self.queue.submit([encoder.finish()]);
                Ok::<_, Error>(recorded)
            };
            let recorded = crate::block_on(&device, in_error_scope(&device, "the frame's commands", 0, record))??;
            let suspended = match recorded? {
                Recorded::Finished(loops) => return Ok(loops),
                Recorded::Suspended(suspended) => suspended,
            };
            frame = crate::block_on(&device, suspended.resume(self))??;
        }
    }
}
