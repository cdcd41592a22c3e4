//! Objects by their boxes: which of them are seen, as far as anybody has asked in this frame (D13 §3.3).
//!
//! In: the words of vertices and the samples that passed. Out: the parts of the index list that are still drawn. An object whose box
//! failed once stays dropped until the frame ends: what is peeled away does not come back. A box is drawn as it is, as on a GPU: what
//! lies beyond by less than its depths are rounded by may be dropped with it.

use std::ops::Range;

use fragbuf_frame::box_vertices;

use super::Frame;

impl Frame<'_> {
    /// The objects that the query `anchor` has not dropped.
    pub(super) fn objects(&self, anchor: &str) -> Vec<Range<u32>> {
        let plan = &self.code.plan;
        let is_dropped =
            |number: usize| plan.pass_id(anchor).is_some_and(|query| self.cursor.is_dropped(plan, query, number));
        let all = self.mesh_objects().into_iter().enumerate();
        all.filter(|(number, _)| !is_dropped(*number)).map(|(_, object)| object).collect()
    }

    /// All objects; a mesh that names none is one.
    pub(super) fn mesh_objects(&self) -> Vec<Range<u32>> {
        let end = self.mesh.indices.len() as u32;
        let clipped = |object: &Range<u32>| object.start.min(end)..object.end.min(end);
        let objects = &self.device.objects;
        if objects.is_empty() { std::iter::once(0..end).collect() } else { objects.iter().map(clipped).collect() }
    }

    /// The corners of the box around an object, as vertices; `None`: it has none.
    pub(super) fn corners(&self, object: &Range<u32>, stride: usize) -> Option<Vec<u32>> {
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
        Some(box_vertices(least, greatest, stride))
    }
}
