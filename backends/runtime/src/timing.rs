//! GPU time of each pass, by timestamps at its begin and end.

use std::collections::BTreeSet;

use fragbuf_frame::PassTime;

use crate::scope::scoped;
use crate::{Error, Pending};

/// Two queries per run of a pass in every slice, and where they are resolved to.
#[derive(Clone)]
pub(crate) struct Timing {
    queries: wgpu::QuerySet,
    resolved: wgpu::Buffer,
    /// The pass of each run.
    passes: Vec<String>,
    slices: u32,
    nanoseconds: f64,
}

/// Bytes of a timestamp.
const TIMESTAMP: u64 = 8;

impl Timing {
    pub(crate) async fn new(
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        passes: Vec<String>,
        slices: u32,
    ) -> Result<Self, Error> {
        let count = 2 * passes.len() as u32 * slices;
        if count > wgpu::QUERY_SET_MAX_QUERIES {
            return Err(Error::TooLarge {
                what: format!("timing {} runs of passes in {slices} slices, in queries,", passes.len()),
                needed: count.into(),
                limit: wgpu::QUERY_SET_MAX_QUERIES.into(),
                limit_name: "QUERY_SET_MAX_QUERIES",
                hint: "take no times, or a smaller frame",
            });
        }
        let make = || {
            let queries = device.create_query_set(&wgpu::QuerySetDescriptor {
                label: Some("fragbuf pass times"),
                ty: wgpu::QueryType::Timestamp,
                count,
            });
            let resolved = device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("fragbuf pass times"),
                size: u64::from(count) * TIMESTAMP,
                usage: wgpu::BufferUsages::QUERY_RESOLVE | wgpu::BufferUsages::COPY_SRC,
                mapped_at_creation: false,
            });
            (queries, resolved)
        };
        let (queries, resolved) = scoped(device, "the timestamps", u64::from(count) * TIMESTAMP, make).await?;
        Ok(Timing { queries, resolved, passes, slices, nanoseconds: f64::from(queue.get_timestamp_period()) })
    }

    /// The queries of a run in a slice: those of its begin and end.
    pub(crate) fn of(&self, run: usize, slice: u32) -> (&wgpu::QuerySet, u32, u32) {
        let first = 2 * (run as u32 + slice * self.passes.len() as u32);
        (&self.queries, first, first + 1)
    }

    /// Recorded after the last pass of a frame. `written`: the first query of every run that there was; the rounds that
    /// never came take the time of nothing, for a query that nobody writes never arrives.
    pub(crate) fn resolve(&self, encoder: &mut wgpu::CommandEncoder, written: &BTreeSet<u32>) {
        for begin in (0..2 * self.passes.len() as u32 * self.slices).step_by(2).filter(|query| !written.contains(query))
        {
            let timestamp_writes = Some(wgpu::ComputePassTimestampWrites {
                query_set: &self.queries,
                beginning_of_pass_write_index: Some(begin),
                end_of_pass_write_index: Some(begin + 1),
            });
            let label = Some("fragbuf no pass");
            drop(encoder.begin_compute_pass(&wgpu::ComputePassDescriptor { label, timestamp_writes }));
        }
        encoder.resolve_query_set(&self.queries, 0..2 * self.passes.len() as u32 * self.slices, &self.resolved, 0);
    }

    pub(crate) fn read(&self, device: &wgpu::Device, encoder: &mut wgpu::CommandEncoder) -> Pending<Vec<PassTime>> {
        let (passes, nanoseconds) = (self.passes.clone(), self.nanoseconds);
        Pending::record(device, encoder, &self.resolved, 0, self.resolved.size(), move |words| {
            let ticks: Vec<u64> =
                words.chunks_exact(2).map(|half| u64::from(half[1]) << 32 | u64::from(half[0])).collect();
            let milliseconds = |ticks: &[u64]| ticks[1].saturating_sub(ticks[0]) as f64 * nanoseconds / 1.0e6;
            let (times, count) = (ticks.chunks_exact(2), passes.len());
            let mut sums: Vec<PassTime> = passes.into_iter().map(|pass| PassTime { pass, milliseconds: 0.0 }).collect();
            for (index, ticks) in times.enumerate() {
                sums[index % count].milliseconds += milliseconds(ticks);
            }
            sums
        })
    }
}
