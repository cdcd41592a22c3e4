//! The GPU time of each pass, from timestamps at its beginning and end.

use std::sync::{Arc, Mutex, PoisonError};

use fragbuf_codegen::PassId;
use fragbuf_frame::PassTime;

use crate::error_scope::in_error_scope;
use crate::{Error, Pending};

/// Two queries per run of a pass, in the order of a frame, and the buffer for their results.
#[derive(Clone)]
pub(crate) struct Timing {
    queries: wgpu::QuerySet,
    resolved: wgpu::Buffer,
    /// The names of the plan's passes.
    passes: Vec<String>,
    /// The runs that can be timed in a frame.
    capacity: u32,
    /// The runs of the last recorded frame.
    last: Arc<Mutex<Vec<PassId>>>,
    nanoseconds: f64,
}

/// The bytes of a timestamp.
const TIMESTAMP: u64 = 8;

/// Returns how many of `runs` can be timed.
fn capacity(runs: u64) -> u32 {
    runs.clamp(1, u64::from(wgpu::QUERY_SET_MAX_QUERIES / 2)) as u32
}

impl Timing {
    /// Creates queries for `runs` runs per frame, or as many as a query set can have. Later runs are not timed.
    pub(crate) async fn new(
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        passes: Vec<String>,
        runs: u64,
    ) -> Result<Self, Error> {
        let capacity = capacity(runs);
        let make = || {
            let queries = device.create_query_set(&wgpu::QuerySetDescriptor {
                label: Some("fragbuf pass times"),
                ty: wgpu::QueryType::Timestamp,
                count: 2 * capacity,
            });
            let resolved = device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("fragbuf pass times"),
                size: u64::from(2 * capacity) * TIMESTAMP,
                usage: wgpu::BufferUsages::QUERY_RESOLVE | wgpu::BufferUsages::COPY_SRC,
                mapped_at_creation: false,
            });
            (queries, resolved)
        };
        let bytes = u64::from(2 * capacity) * TIMESTAMP;
        let (queries, resolved) = in_error_scope(device, "the timestamps", bytes, make).await?;
        let nanoseconds = f64::from(queue.get_timestamp_period());
        Ok(Timing { queries, resolved, passes, capacity, last: Arc::default(), nanoseconds })
    }

    /// Whether this has as many queries as `new` would create for `runs`.
    pub(crate) fn is_for(&self, runs: u64) -> bool {
        self.capacity == capacity(runs)
    }

    /// Returns the queries at the beginning and the end of a frame's run of this number; `None` if there are too few.
    pub(crate) fn of(&self, run: usize) -> Option<(&wgpu::QuerySet, u32, u32)> {
        let run = u32::try_from(run).ok().filter(|run| *run < self.capacity)?;
        Some((&self.queries, 2 * run, 2 * run + 1))
    }

    /// Records the resolution of the queries, after the last pass of a frame with these runs.
    pub(crate) fn resolve(&self, encoder: &mut wgpu::CommandEncoder, runs: &[PassId]) {
        let timed = runs.len().min(self.capacity as usize) as u32;
        if timed > 0 {
            encoder.resolve_query_set(&self.queries, 0..2 * timed, &self.resolved, 0);
        }
        *self.last.lock().unwrap_or_else(PoisonError::into_inner) = runs.to_vec();
    }

    /// Records the readback of the times of the last recorded frame.
    pub(crate) fn read(&self, device: &wgpu::Device, encoder: &mut wgpu::CommandEncoder) -> Pending<Vec<PassTime>> {
        let runs = self.last.lock().unwrap_or_else(PoisonError::into_inner).clone();
        let (passes, nanoseconds) = (self.passes.clone(), self.nanoseconds);
        Pending::record(device, encoder, &self.resolved, 0, self.resolved.size(), move |words| {
            let ticks: Vec<u64> =
                words.chunks_exact(2).map(|half| u64::from(half[1]) << 32 | u64::from(half[0])).collect();
            let mut sums: Vec<PassTime> = passes.into_iter().map(PassTime::zero).collect();
            for (index, PassId(pass)) in runs.into_iter().enumerate() {
                let Some(sum) = sums.get_mut(pass) else { continue };
                match ticks.get(2 * index..2 * index + 2) {
                    Some(ticks) => sum.milliseconds += ticks[1].saturating_sub(ticks[0]) as f64 * nanoseconds / 1.0e6,
                    None => sum.untimed += 1,
                }
            }
            sums
        })
    }
}
