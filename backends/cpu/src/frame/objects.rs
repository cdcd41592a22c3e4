//! Objects by their boxes: which of them are seen, as far as anybody has asked in this frame (D13 §3.3).
//!
//! In: the words of vertices and the samples that passed. Out: the parts of the index list that are still drawn. An object whose box
//! failed once stays dropped until the frame ends: what is peeled away does not come back. A box is drawn as it is, as on a GPU: what
//! lies beyond by less than its depths are rounded by may be dropped with it.

use std::ops::Range;

use fragbuf_frame::unsupported;

use super::Frame;
use crate::Error;

/// Corners of a box as vertices.
pub(super) struct Corners {
    /// Eight vertices, interleaved as the mesh's are; attributes beside the position are zero.
    pub(super) vertices: Vec<u32>,
}

/// The faces of a box, two triangles each; bit 0, 1 and 2 of a corner's number say whether it is the greater along x, y and z.
pub(super) const FACES: [u32; 36] =
    [0, 1, 3, 0, 3, 2, 4, 6, 7, 4, 7, 5, 0, 4, 5, 0, 5, 1, 2, 3, 7, 2, 7, 6, 0, 2, 6, 0, 6, 4, 1, 5, 7, 1, 7, 3];

impl Frame<'_> {
    /// The objects that the query `anchor` has not dropped.
    pub(super) fn objects(&self, anchor: &str) -> Result<Vec<Range<u32>>, Error> {
        let plan = &self.code.plan;
        let query = plan.pass_id(anchor);
        let query = query.ok_or_else(|| unsupported(format!("the query of `{anchor}`, which is no pass")))?;
        let all = self.mesh_objects().into_iter().enumerate();
        Ok(all.filter(|(number, _)| !self.cursor.is_dropped(plan, query, *number)).map(|(_, object)| object).collect())
    }

    /// All objects; a mesh that names none is one.
    pub(super) fn mesh_objects(&self) -> Vec<Range<u32>> {
        let end = self.mesh.indices.len() as u32;
        let clipped = |object: &Range<u32>| object.start.min(end)..object.end.min(end);
        let objects = &self.device.objects;
        if objects.is_empty() { std::iter::once(0..end).collect() } else { objects.iter().map(clipped).collect() }
    }

    /// The box around an object; `None`: it has no vertices.
    pub(super) fn corners(&self, object: &Range<u32>, stride: usize) -> Option<Corners> {
        let indices = self.mesh.indices.get(object.start as usize..object.end as usize)?;
        let positions =
            indices.iter().filter_map(|index| self.mesh.vertices.get(*index as usize * stride..)?.first_chunk());
        let mut positions = positions.map(|words: &[u32; 3]| words.map(f32::from_bits));
        let first = positions.next()?;
        let (least, greatest) = positions.fold((first, first), |(least, greatest), position| {
            let pick = |choose: fn(f32, f32) -> f32, from: [f32; 3]| -> [f32; 3] {
                std::array::from_fn(|axis| choose(from[axis], position[axis]))
            };
            (pick(f32::min, least), pick(f32::max, greatest))
        });
        let mut vertices = vec![0; 8 * stride];
        for (corner, vertex) in vertices.chunks_mut(stride.max(3)).enumerate() {
            for (axis, word) in vertex.iter_mut().take(3).enumerate() {
                let is_greater = corner >> axis & 1 == 1;
                *word = if is_greater { greatest[axis] } else { least[axis] }.to_bits();
            }
        }
        Some(Corners { vertices })
    }
}
