//! A draw call: programs, vertices, attachments and the triangles to draw.

use std::ops::Range;

use fragbuf_interpreter::Bytecode;
use fragbuf_templates::vocabulary::Coverage;

use crate::attachment::Attachments;
use crate::settings::FragmentOrder;
use crate::vertices;
use crate::view::View;

/// The state of a draw call.
pub(crate) struct DrawCall<'a> {
    pub(crate) vertex: (&'a Bytecode, View<'a>),
    pub(crate) fragment: (&'a Bytecode, View<'a>),
    /// Interleaved vertices, as words.
    pub(crate) vertices: &'a [u32],
    /// Three vertex numbers per triangle; `None`: consecutive vertices.
    pub(crate) indices: Option<&'a [u32]>,
    pub(crate) arguments: DrawArguments,
    pub(crate) size: (u32, u32),
    /// The rows of the slice.
    pub(crate) rows: Range<u32>,
    pub(crate) attachments: Attachments<'a>,
    pub(crate) coverage: Coverage,
    pub(crate) order: FragmentOrder,
    /// Whether invocations run in lanes.
    pub(crate) lanes: bool,
    /// The bytes for the triangles and the lists of the tiles. They limit a shuffled order only.
    pub(crate) memory: u64,
}

/// The triangles and instances to draw.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct DrawArguments {
    /// Ranges of the index list, in triangles. Gaps do not change the numbers of other triangles.
    pub(crate) triangles: Vec<Range<u32>>,
    /// The triangle with the primitive index 0.
    pub(crate) zero: u32,
    /// Added to every index.
    pub(crate) base: i32,
    pub(crate) instances: Range<u32>,
}

impl DrawArguments {
    /// Returns arguments for the first `triangles` triangles, drawn once.
    pub(crate) fn once(triangles: u32) -> Self {
        DrawArguments { triangles: std::iter::once(0..triangles).collect(), zero: 0, base: 0, instances: 0..1 }
    }
}

impl DrawCall<'_> {
    /// Returns the numbers of all triangles within the index list.
    pub(crate) fn numbers(&self) -> Vec<u32> {
        self.ranges().flatten().collect()
    }

    /// Returns how many numbers [`DrawCall::numbers`] returns.
    pub(crate) fn triangle_count(&self) -> u64 {
        self.ranges().map(|range| range.len() as u64).sum()
    }

    fn ranges(&self) -> impl Iterator<Item = Range<u32>> {
        let end = self.indices.map_or(u32::MAX, |indices| (indices.len() / 3) as u32);
        self.arguments.triangles.iter().map(move |range| range.start.min(end)..range.end.min(end))
    }

    /// Returns the number of vertices.
    pub(crate) fn vertex_count(&self) -> usize {
        match self.indices {
            Some(_) => self.vertices.len() / vertices::stride(self.vertex.0).max(1),
            None => {
                let last = self.arguments.triangles.iter().map(|range| 3 * i64::from(range.end)).max().unwrap_or(0);
                (last + i64::from(self.arguments.base)).max(0) as usize
            }
        }
    }

    /// Returns the vertices of a triangle. `None`: one of them does not exist.
    pub(crate) fn corners(&self, number: u32, count: usize) -> Option<[usize; 3]> {
        let mut corners = [0; 3];
        for (vertex, corner) in (3 * number as usize..).zip(&mut corners) {
            let index = self.indices.map_or(vertex as i64, |indices| i64::from(indices[vertex]));
            *corner = usize::try_from(index + i64::from(self.arguments.base)).ok().filter(|vertex| *vertex < count)?;
        }
        Some(corners)
    }
}
