//! Decisions of host steps that no frame waits for ([`Decisions::Lagged`](crate::Decisions)): a frame copies the words that they read, and
//! a later frame uses the values that they give.

use std::collections::VecDeque;
use std::sync::PoisonError;

use fragbuf_codegen::Plan;
use fragbuf_frame::{HostRead, LaggedValues, Readbacks, Values, decide, reuse_pool_sizes};

use crate::recording::Readback;
use crate::{Error, Renderer};

/// The words that one frame has copied for its host steps.
pub(crate) type FrameReads = Vec<(HostRead, Vec<Readback>)>;

/// The most frames whose words are copied and not used yet: further frames copy none.
const FRAMES: usize = 4;

impl Renderer {
    /// Applies what earlier frames have decided, with [`Decisions::Lagged`](crate::Decisions::Lagged). Call it before [`Renderer::begin`];
    /// an unfinished frame becomes stale if a value changes. It never waits for the device: words that have not been read back yet count
    /// for a later call. Buffers are reallocated for another k. An error leaves the values unchanged.
    pub async fn decide(&mut self) -> Result<(), Error> {
        let (lag, values) = self.next_values(None).await?;
        self.apply_lagged(lag, values).await
    }

    /// Whether the next frame uses what an earlier frame has decided.
    pub fn is_lagged(&self) -> bool {
        self.frame_readbacks() == Readbacks::Lagged
    }

    /// Returns the values of lagged decisions, for another renderer of the same description.
    pub fn lagged_values(&self) -> &LaggedValues {
        &self.lag
    }

    /// Continues with the lagged decisions of another renderer. Fails if it is of another description, and if there is no memory for the
    /// values; then nothing changes.
    pub async fn resume_lagged(&mut self, others: &LaggedValues) -> Result<(), Error> {
        let (mut lag, mut values) = (self.lag.clone(), self.current_values());
        lag.resume(self.plan(), others, &mut values)?;
        self.apply_lagged(lag, values).await
    }

    /// Returns what the finished frames have decided, with the values of the next frame. `plan`: that of a greater capacity, for which host
    /// steps decide instead of the renderer's own.
    pub(crate) async fn next_values(&mut self, plan: Option<&Plan>) -> Result<(LaggedValues, Values), Error> {
        // The callbacks of finished readbacks.
        self.device.poll(wgpu::PollType::Poll).map_err(|_| Error::DeviceLost)?;
        let (mut lag, current) = (self.lag.clone(), self.current_values());
        let mut values = plan.map_or_else(|| current.clone(), |plan| current.of_plan(plan));
        // Those of a frame that has waited.
        lag.advance(&mut values);
        for frame in self.ready_reads() {
            for (read, readbacks) in frame {
                let mut words = Vec::new();
                for readback in readbacks {
                    readback.append_to(&mut words).await?;
                }
                let mut decided = values.clone();
                decide(plan.unwrap_or_else(|| self.plan()), &read, &words, &mut decided)?;
                lag.record(&decided);
            }
            lag.advance(&mut values);
        }
        Ok((lag, values.of_plan(self.plan())))
    }

    /// Allocates memory for the values. An error changes nothing.
    pub(crate) async fn apply_lagged(&mut self, lag: LaggedValues, mut values: Values) -> Result<(), Error> {
        if values != self.current_values() {
            reuse_pool_sizes(self.plan(), &self.resources.values, &mut values);
            let k = values.k();
            self.resize_to(values).await?;
            self.k = k;
        }
        self.lag = lag;
        Ok(())
    }

    /// Returns how the next frame reads words back.
    pub(crate) fn frame_readbacks(&self) -> Readbacks {
        self.lag.readbacks(self.readbacks)
    }

    /// Whether a frame copies words for lagged decisions: a device that is some frames behind has enough of them.
    pub(crate) fn copies_reads(&self) -> bool {
        self.reads.lock().unwrap_or_else(PoisonError::into_inner).len() < FRAMES
    }

    /// Stores the words that a finished frame copies.
    pub(crate) fn store_reads(&self, reads: FrameReads) {
        if !reads.is_empty() {
            self.reads.lock().unwrap_or_else(PoisonError::into_inner).push_back(reads);
        }
    }

    /// Forgets all decisions: the next frame waits for its own.
    pub(crate) fn forget_decisions(&mut self) {
        self.lag.reset();
        self.reads.get_mut().unwrap_or_else(PoisonError::into_inner).clear();
    }

    /// Takes the words that have been read back. Those of a frame before them that are not there were never submitted.
    fn ready_reads(&mut self) -> VecDeque<FrameReads> {
        let reads = self.reads.get_mut().unwrap_or_else(PoisonError::into_inner);
        let is_ready = |frame: &FrameReads| frame.iter().flat_map(|(_, readbacks)| readbacks).all(Readback::is_ready);
        let end = reads.iter().rposition(is_ready).map_or(0, |last| last + 1);
        reads.drain(..end).filter(is_ready).collect()
    }
}
