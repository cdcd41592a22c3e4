//! Occlusion queries: whether a sample passed in a pass that a loop waits for, or in the box of an object.
//!
//! In: the number of objects. Out: a query for each, and where they are resolved to. Nothing here waits.

use crate::scope::scoped;
use crate::{Error, Pending};

/// Queries, and the buffer that they are resolved to.
pub(crate) struct Queries {
    pub(crate) set: wgpu::QuerySet,
    resolved: wgpu::Buffer,
    count: u32,
}

/// Bytes of an answer.
const ANSWER: u64 = 8;

impl Queries {
    /// Queries for so many objects, at least one.
    pub(crate) async fn new(device: &wgpu::Device, objects: u32) -> Result<Self, Error> {
        let count = objects.max(1);
        if count > wgpu::QUERY_SET_MAX_QUERIES {
            return Err(Error::TooLarge {
                what: "the frame's objects".to_owned(),
                needed: count.into(),
                limit: wgpu::QUERY_SET_MAX_QUERIES.into(),
                limit_name: "QUERY_SET_MAX_QUERIES",
                hint: "put several things into one object",
            });
        }
        let make = || {
            let set = device.create_query_set(&wgpu::QuerySetDescriptor {
                label: Some("fragbuf occlusion"),
                ty: wgpu::QueryType::Occlusion,
                count,
            });
            let resolved = device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("fragbuf occlusion"),
                size: u64::from(count) * ANSWER,
                usage: wgpu::BufferUsages::QUERY_RESOLVE | wgpu::BufferUsages::COPY_SRC,
                mapped_at_creation: false,
            });
            Queries { set, resolved, count }
        };
        scoped(device, "the occlusion queries", u64::from(count) * ANSWER, make).await
    }

    /// Records the readback of the first `count` queries, all of which have been asked: one word each, 0 where no sample
    /// passed.
    pub(crate) fn read(
        &self,
        device: &wgpu::Device,
        encoder: &mut wgpu::CommandEncoder,
        count: u32,
    ) -> Pending<Vec<u32>> {
        let count = count.clamp(1, self.count);
        encoder.resolve_query_set(&self.set, 0..count, &self.resolved, 0);
        Pending::record(device, encoder, &self.resolved, 0, u64::from(count) * ANSWER, |words| {
            words.chunks_exact(2).map(|halves| u32::from(halves[0] | halves[1] != 0)).collect()
        })
    }
}
