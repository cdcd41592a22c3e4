//! The triangles of every edge.

use std::collections::HashMap;

use crate::Scene;
use crate::scene::TriangleId;

/// An edge by the positions of its ends, in an order that does not depend on the triangle.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) struct Edge([[u32; 3]; 2]);

impl Edge {
    /// Returns an edge of a triangle: edge i is from corner i to the next.
    pub(super) fn of(corners: [[f32; 3]; 3], edge: usize) -> Self {
        Edge::between([corners[edge % 3], corners[(edge + 1) % 3]])
    }

    pub(super) fn between(ends: [[f32; 3]; 2]) -> Self {
        // The sum makes 0 of -0, which is at the same position.
        let mut ends = ends.map(|end| end.map(|coordinate| (coordinate + 0.0).to_bits()));
        ends.sort_unstable();
        Edge(ends)
    }
}

/// The triangles that an edge can have to be divided. Surfaces have edges of two; a model with more than a thousand would take long.
const MOST: u64 = 1024;

/// The triangles of every edge. Nothing depends on the order of the map.
///
/// A list may have triangles that were divided since and others twice; they are left out when it is read. `None`: the edge has too many
/// triangles, and is never divided.
pub(super) struct Edges(HashMap<Edge, Option<Vec<TriangleId>>>);

impl Edges {
    pub(super) fn of(scene: &Scene) -> Self {
        let mut edges = Edges(HashMap::new());
        scene.triangle_ids().for_each(|id| edges.add(scene, id));
        edges
    }

    /// Adds the edges of a triangle.
    pub(super) fn add(&mut self, scene: &Scene, id: TriangleId) {
        for edge in edges(scene, id) {
            if let Some(triangles) = self.0.entry(edge).or_insert_with(|| Some(Vec::new())) {
                triangles.push(id);
            }
        }
    }

    /// Returns the triangles of an edge, each once. Of more than `most`, or [`MOST`], it returns none, also later.
    pub(super) fn sharing(&mut self, scene: &Scene, edge: Edge, most: u64) -> Vec<TriangleId> {
        let Some(list) = self.0.get_mut(&edge) else { return Vec::new() };
        let Some(triangles) = list else { return Vec::new() };
        triangles.retain(|id| edges(scene, *id).any(|other| other == edge));
        triangles.sort_unstable();
        triangles.dedup();
        if triangles.len() as u64 > most.min(MOST) {
            *list = None;
        }
        list.clone().unwrap_or_default()
    }
}

/// Returns the edges of a triangle.
fn edges(scene: &Scene, id: TriangleId) -> impl Iterator<Item = Edge> {
    let corners = scene.positions(id);
    corners.into_iter().flat_map(|[a, b, c]| [[a, b], [b, c], [c, a]].map(Edge::between))
}
