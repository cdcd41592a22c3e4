//! Subdivision of long and thin triangles, so that centroids say more about the depths of fragments (B06 §4.3, Fig. 9).
//!
//! Input: a scene and a budget of triangles. Output: the same surfaces with more triangles. "The triangles are recursively subdivided until a triangle
//! budget is reached", by "how long and skinny they are". A new vertex is added on the longest edge; the original vertices stay where they are.
//!
//! * An edge of one triangle alone is divided as in B06, at a distance of min(l_min, l_max / 2) from its common vertex with the shortest edge.
//! * B06 divides neighbours apart, which leaves T-junctions, and rounding opens cracks there. Here every triangle with an edge is divided at the
//!   same position. The position of B06 is at the wrong end for a neighbour, so a common edge is halved; and if a neighbour has a longer edge, that
//!   is divided first (longest-edge propagation, Rivara 1997), so that neighbours do not become thinner.
//!
//! Edges are equal if the positions of their ends are.

mod edges;
mod split;

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use self::edges::{Edge, Edges};
use crate::Scene;
use crate::scene::TriangleId;

/// The bytes that the subdivision needs for a triangle, beside the scene: its three edges, and its place in the queue.
const WORKING_BYTES: u64 = 320;

impl Scene {
    /// Returns the most triangles that [`Scene::subdivide`] makes of the scene's, for a ratio of at least 1.
    pub fn triangle_budget(&self, ratio: f64) -> u64 {
        // Saturates. A ratio below 1, or one that is no number, adds none.
        let triangles = self.triangles() as u64;
        ((triangles as f64 * ratio).floor() as u64).max(triangles)
    }

    /// Returns the bytes that [`Scene::subdivide`] may need, those of the larger scene included.
    pub fn subdivision_bytes(&self, ratio: f64) -> u64 {
        let (triangles, budget) = (self.triangles().max(1) as u64, self.triangle_budget(ratio));
        let words: usize = self.attributes.iter().map(|attribute| attribute.components).sum();
        // A vertex, a triangle, and the room that growing lists reserve.
        let added = 2 * (12 + 12 + 16 + 12 + 4 * words as u64);
        let more = (budget - self.triangles() as u64).saturating_mul(added);
        self.bytes().saturating_add(more).saturating_add(budget.max(triangles).saturating_mul(WORKING_BYTES))
    }

    /// Divides triangles until the scene has `ratio` times as many, or no triangle can be divided. Attributes are interpolated, and integers have
    /// the value of the first vertex of the divided triangle. The order of triangles becomes that of the objects.
    pub fn subdivide(&mut self, ratio: f64) {
        let budget = self.triangle_budget(ratio);
        self.order.clear();
        let (mut edges, mut queue, mut count) = (Edges::of(self), BinaryHeap::new(), self.triangles() as u64);
        queue.extend(self.triangle_ids().filter_map(|id| Some((skinniness(self, id)?, Reverse(id)))));
        while let Some((key, Reverse(id))) = queue.pop() {
            if count >= budget {
                break;
            }
            // A triangle that a neighbour has divided is in the queue with its new shape, too.
            if skinniness(self, id) != Some(key) {
                continue;
            }
            let Some((divided, sharing)) = self.to_divide(id, &mut edges, budget - count) else { continue };
            let cut = self.positions(divided).and_then(|corners| cut(corners, sharing.len() > 1));
            let Some((edge, position)) = cut.filter(|_| self.has_indices_for(&sharing)) else { continue };
            if !sharing.contains(&id) {
                queue.push((key, Reverse(id)));
            }
            for id in sharing {
                let Some(added) = self.split(id, edge, position) else { continue };
                count += 1;
                for id in [id, added] {
                    edges.add(self, id);
                    queue.extend(skinniness(self, id).map(|key| (key, Reverse(id))));
                }
            }
        }
    }

    /// Returns the triangle whose longest edge is to be divided so that this triangle can be, and all triangles with that edge. `None`: they are
    /// more than `most`.
    fn to_divide(&self, mut id: TriangleId, edges: &mut Edges, most: u64) -> Option<(TriangleId, Vec<TriangleId>)> {
        loop {
            let corners = self.positions(id)?;
            let length = |id: &TriangleId| self.positions(*id).map_or(0.0, |corners| length(corners, longest(corners)));
            let sharing = edges.sharing(self, Edge::of(corners, longest(corners)), most);
            // The length grows with every step, so there is an end.
            match sharing.iter().find(|other| length(other) > length(&id)) {
                Some(longer) => id = *longer,
                None => return Some((id, sharing)).filter(|(_, sharing)| !sharing.is_empty()),
            }
        }
    }

    /// Returns the positions of the corners of a triangle.
    fn positions(&self, id: TriangleId) -> Option<[[f32; 3]; 3]> {
        let object = self.objects.get(id.object as usize)?;
        let [a, b, c] = self.corners(id)?.map(|corner| object.positions.get(corner as usize).copied());
        Some([a?, b?, c?])
    }

    /// Returns whether indices of 32 bits suffice for a new vertex and a new triangle per triangle.
    fn has_indices_for(&self, triangles: &[TriangleId]) -> bool {
        triangles
            .iter()
            .filter_map(|id| self.objects.get(id.object as usize))
            .all(|object| object.positions.len().max(object.triangles.len()) + triangles.len() < u32::MAX as usize)
    }
}

/// Returns how long and thin a triangle is, as an integer that orders triangles: the length of its longest edge times the aspect ratio, the same
/// length over the height. The aspect ratio alone would not end: the tip that a cut leaves is about similar to the whole. `None`: it has no
/// area beyond the rounding of its positions, so it has next to no fragments.
fn skinniness(scene: &Scene, id: TriangleId) -> Option<u64> {
    let corners = scene.positions(id)?.map(|position| glam::Vec3::from_array(position).as_dvec3());
    let [a, b, c] = corners;
    let doubled_area = (b - a).cross(c - a).length();
    let longest = a.distance_squared(b).max(b.distance_squared(c)).max(c.distance_squared(a));
    let skinniness = longest.sqrt() * longest / doubled_area;
    // The bits of positive numbers order as the numbers do.
    (doubled_area * THINNEST > longest && skinniness.is_finite()).then(|| skinniness.to_bits())
}

/// The aspect ratio from which a triangle is not divided: its height is as small as the rounding of `f32` positions.
const THINNEST: f64 = 1.0e6;

/// Returns the length of an edge: edge i is from corner i to the next.
fn length(corners: [[f32; 3]; 3], edge: usize) -> f64 {
    let [from, to] = [edge % 3, (edge + 1) % 3].map(|corner| glam::Vec3::from_array(corners[corner]).as_dvec3());
    from.distance(to)
}

/// Returns the longest edge of a triangle; of equal lengths the first.
fn longest(corners: [[f32; 3]; 3]) -> usize {
    let length = |edge: usize| length(corners, edge);
    (1..3).fold(0, |a, b| if length(b) > length(a) { b } else { a })
}

/// Returns the longest edge of a triangle and the position of a new vertex on it, the middle if other triangles have the edge, too. `None`:
/// rounding moves it to a corner.
fn cut(corners: [[f32; 3]; 3], is_shared: bool) -> Option<(Edge, [f32; 3])> {
    let edge = longest(corners);
    let [after, before] = [(edge + 1) % 3, (edge + 2) % 3];
    // The common vertex with the shortest edge is the end of the longest edge if the shortest one follows it.
    let (shortest, near, far) = match length(corners, after) < length(corners, before) {
        true => (after, after, edge),
        false => (before, edge, after),
    };
    let share = match is_shared {
        true => 0.5,
        false => (length(corners, shortest) / length(corners, edge)).min(0.5),
    };
    let [near, far] = [near, far].map(|corner| glam::Vec3::from_array(corners[corner]).as_dvec3());
    let position = near.lerp(far, share).as_vec3().to_array();
    (!corners.contains(&position)).then(|| (Edge::of(corners, edge), position))
}
