//! GPU time of each pass, by timestamps at its begin and end.

use crate::scope::scoped;
use crate::{Error, Pending};

/// The time that one pass took on the device.
#[derive(Clone, Debug, PartialEq)]
pub struct PassTime {
    /// The pass.
    pub pass: String,
    /// In milliseconds.
    pub milliseconds: f64,
}

/// Two queries per pass, and where they are resolved to.
pub(crate) struct Timing {
    queries: wgpu::QuerySet,
    resolved: wgpu::Buffer,
    passes: Vec<String>,
    nanoseconds: f64,
}

/// Bytes of a timestamp.
const TIMESTAMP: u64 = 8;

impl Timing {
    pub(crate) async fn new(device: &wgpu::Device, queue: &wgpu::Queue, passes: Vec<String>) -> Result<Self, Error> {
        let count = 2 * passes.len() as u32;
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
        Ok(Timing { queries, resolved, passes, nanoseconds: f64::from(queue.get_timestamp_period()) })
    }

    /// The queries of a pass: those of its begin and end.
    pub(crate) fn of(&self, pass: usize) -> (&wgpu::QuerySet, u32, u32) {
        let first = 2 * pass as u32;
        (&self.queries, first, first + 1)
    }

    /// Recorded after the last pass of a frame: every query has been written by then.
    pub(crate) fn resolve(&self, encoder: &mut wgpu::CommandEncoder) {
        encoder.resolve_query_set(&self.queries, 0..2 * self.passes.len() as u32, &self.resolved, 0);
    }

    pub(crate) fn read(&self, device: &wgpu::Device, encoder: &mut wgpu::CommandEncoder) -> Pending<Vec<PassTime>> {
        let (passes, nanoseconds) = (self.passes.clone(), self.nanoseconds);
        Pending::record(device, encoder, &self.resolved, 0, self.resolved.size(), move |words| {
            let ticks: Vec<u64> =
                words.chunks_exact(2).map(|half| u64::from(half[1]) << 32 | u64::from(half[0])).collect();
            let milliseconds = |ticks: &[u64]| ticks[1].saturating_sub(ticks[0]) as f64 * nanoseconds / 1.0e6;
            let times = passes.into_iter().zip(ticks.chunks_exact(2));
            times.map(|(pass, ticks)| PassTime { pass, milliseconds: milliseconds(ticks) }).collect()
        })
    }
}
