//! Divides one triangle at a position on one of its edges.

use glam::{Vec3, Vec4};

use super::edges::Edge;
use crate::scene::TriangleId;
use crate::{AttributeRequest, Object, Scene};

impl Scene {
    /// Divides a triangle in two, which have its orientation. One takes its place, the other is the last of the object. Returns the other;
    /// `None`: the triangle does not have the edge.
    pub(super) fn split(&mut self, id: TriangleId, edge: Edge, position: [f32; 3]) -> Option<TriangleId> {
        let positions = self.positions(id)?;
        let next = |corner: usize| (corner + 1) % 3;
        let from = (0..3).find(|corner| Edge::between([positions[*corner], positions[next(*corner)]]) == edge)?;
        let to = next(from);
        let corners = self.corners(id)?;
        let share = share([positions[from], positions[to]], position);
        let object = self.objects.get_mut(id.object as usize)?;
        let middle = object.vertex_between([corners[from], corners[to]], (position, share))?;
        object.attributes_between(&self.attributes, ([corners[from], corners[to]], corners[0]), share);
        let replaced = |corner: usize| {
            let mut corners = corners;
            corners[corner] = middle;
            corners
        };
        *object.triangles.get_mut(id.triangle as usize)? = replaced(to);
        object.triangles.push(replaced(from));
        Some(TriangleId { triangle: object.triangles.len() as u32 - 1, ..id })
    }
}

/// Returns where a position is between two others, from 0 to 1.
fn share(ends: [[f32; 3]; 2], position: [f32; 3]) -> f32 {
    let [from, to, at] = [ends[0], ends[1], position].map(|point| Vec3::from_array(point).as_dvec3());
    (from.distance(at) / from.distance(to)).clamp(0.0, 1.0) as f32
}

impl Object {
    /// Adds a vertex between two others, with its normal and colour.
    fn vertex_between(&mut self, ends: [u32; 2], (position, share): ([f32; 3], f32)) -> Option<u32> {
        let [from, to] = ends.map(|end| end as usize);
        let normals = [self.normals.get(from)?, self.normals.get(to)?].map(|normal| Vec3::from_array(*normal));
        let colors = [self.colors.get(from)?, self.colors.get(to)?].map(|color| Vec4::from_array(*color));
        // Opposite normals have no mean.
        let normal = normals[0].lerp(normals[1], share).normalize_or(normals[0]);
        Some(self.vertex(position, normal.to_array(), colors[0].lerp(colors[1], share).to_array()))
    }

    /// Adds the attributes of a vertex between two others. Integers are those of the first vertex of the triangle, whose value the triangle has.
    fn attributes_between(&mut self, requests: &[AttributeRequest], (ends, first): ([u32; 2], u32), share: f32) {
        for (words, request) in self.attributes.iter_mut().zip(requests) {
            let word = |vertex: u32, component: usize| {
                words.get(vertex as usize * request.components + component).copied().unwrap_or(0)
            };
            let between = |component: usize| match request.is_integer {
                true => word(first, component),
                false => {
                    let [from, to] = ends.map(|end| f32::from_bits(word(end, component)));
                    (from * (1.0 - share) + to * share).to_bits()
                }
            };
            let added: Vec<u32> = (0..request.components).map(between).collect();
            words.extend(added);
        }
    }
}
