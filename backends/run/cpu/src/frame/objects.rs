//! Object culling by occlusion queries of bounding boxes (D13 §3.3).
//!
//! An object whose box failed once stays dropped until the frame ends: peeled layers do not return. Boxes have a margin, so that no
//! object is dropped because of rounding.

use std::ops::Range;

use fragbuf_codegen::PassId;
use fragbuf_frame::{box_around, box_vertices, first_of_query, grown_box};

use super::Frame;

impl Frame<'_> {
    /// Returns the objects that the query `name` has not dropped.
    pub(super) fn objects(&self, name: &str) -> Vec<Range<u32>> {
        let plan = &self.code.plan;
        let is_dropped = |number: usize| plan.pass_id(name).is_some_and(|query| self.is_dropped(query, number));
        let all = self.mesh_objects().into_iter().enumerate();
        all.filter(|(number, _)| !is_dropped(*number)).map(|(_, object)| object).collect()
    }

    /// Whether a query has dropped an object in this slice.
    pub(super) fn is_dropped(&self, query: PassId, object: usize) -> bool {
        let plan = &self.code.plan;
        let first = first_of_query(plan, query);
        let on_device = self.conditions.dropped.get(&first).and_then(|dropped| dropped.get(object));
        self.cursor.is_dropped(plan, query, object) || on_device.is_some_and(|dropped| *dropped)
    }

    /// Returns all objects; a mesh without objects is one object.
    pub(super) fn mesh_objects(&self) -> Vec<Range<u32>> {
        let end = self.mesh.indices.len() as u32;
        let clipped = |object: &Range<u32>| object.start.min(end)..object.end.min(end);
        let objects = &self.device.objects;
        if objects.is_empty() { std::iter::once(0..end).collect() } else { objects.iter().map(clipped).collect() }
    }

    /// Returns the corners of the box around an object as vertices; `None`: the object is empty.
    pub(super) fn corners(&self, object: &Range<u32>, stride: usize) -> Option<Vec<u32>> {
        let indices = self.mesh.indices.get(object.start as usize..object.end as usize)?;
        let positions =
            indices.iter().filter_map(|index| self.mesh.vertices.get(*index as usize * stride..)?.first_chunk());
        let (least, greatest) = box_around(positions.map(|words: &[u32; 3]| words.map(f32::from_bits)))?;
        let (least, greatest) = grown_box(least, greatest);
        Some(box_vertices(least, greatest, stride))
    }
}
