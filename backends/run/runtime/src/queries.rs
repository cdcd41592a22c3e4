//! Occlusion queries: whether a sample passed in a pass that a loop waits for, or in the box of an object.
//!
//! Input: the number of queries. Output: the queries and the buffer for their results. This module does not wait.

use std::ops::Range;

use crate::error_scope::in_error_scope;
use crate::{Error, Pending};

/// Queries, and the buffer for their results.
pub(crate) struct Queries {
    pub(crate) set: wgpu::QuerySet,
    resolved: wgpu::Buffer,
}

/// The bytes of a result.
const RESULT_BYTES: u64 = 8;

impl Queries {
    /// Creates `count` queries; `None` for 0.
    pub(crate) async fn new(device: &wgpu::Device, count: u32) -> Result<Option<Self>, Error> {
        if count == 0 {
            return Ok(None);
        }
        if count > wgpu::QUERY_SET_MAX_QUERIES {
            return Err(Error::TooLarge {
                what: "the frame's objects".to_owned(),
                needed: count.into(),
                limit: wgpu::QUERY_SET_MAX_QUERIES.into(),
                limit_name: "QUERY_SET_MAX_QUERIES",
                help: "group several meshes into one object",
                shrinks_with_rows: false,
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
                size: u64::from(count) * RESULT_BYTES,
                usage: wgpu::BufferUsages::QUERY_RESOLVE | wgpu::BufferUsages::COPY_SRC,
                mapped_at_creation: false,
            });
            Queries { set, resolved }
        };
        in_error_scope(device, "the occlusion queries", u64::from(count) * RESULT_BYTES, make).await.map(Some)
    }

    /// Records the readback of queries that have run: one word each, 0 if no sample passed.
    pub(crate) fn read(
        &self,
        device: &wgpu::Device,
        encoder: &mut wgpu::CommandEncoder,
        queries: Range<u32>,
    ) -> Pending<Vec<u32>> {
        let bytes = u64::from(queries.end - queries.start) * RESULT_BYTES;
        encoder.resolve_query_set(&self.set, queries, &self.resolved, 0);
        Pending::record(device, encoder, &self.resolved, 0, bytes, |words| {
            words.chunks_exact(2).map(|halves| u32::from(halves[0] | halves[1] != 0)).collect()
        })
    }
}
