//! Triangles that share no vertex, for attributes that differ between the triangles around a vertex.

use glam::Vec3;

use crate::{Object, Scene};

impl Scene {
    /// Returns the scene with three vertices of its own for each triangle: the vertices `3 i` to `3 i + 2` of an object are the corners of its
    /// triangle `i`.
    pub fn with_own_corners(&self) -> Self {
        let objects = self.objects.iter().map(Object::with_own_corners).collect();
        Scene {
            objects,
            placement: self.placement,
            attributes: self.attributes.clone(),
            warnings: self.warnings.clone(),
            files: self.files.clone(),
            order: self.order.clone(),
        }
    }

    /// Returns the bytes of the lists of [`Scene::with_own_corners`].
    pub fn bytes_with_own_corners(&self) -> u64 {
        let words = |object: &Object| {
            let attributes: usize =
                object.attributes.iter().map(|words| words.len() / object.positions.len().max(1)).sum();
            // Three vertices with position, normal, colour and attributes, and three indices.
            (object.triangles.len() as u64).saturating_mul(3 * (3 + 3 + 4 + attributes as u64) + 3)
        };
        let words = self.objects.iter().fold(0, |sum: u64, object| sum.saturating_add(words(object)));
        words.saturating_mul(4).saturating_add(size_of_val(&self.order[..]) as u64)
    }
}

impl Object {
    fn with_own_corners(&self) -> Self {
        let corners = || self.triangles.iter().flatten().map(|index| *index as usize);
        let attribute = |words: &Vec<u32>| {
            let count = words.len() / self.positions.len().max(1);
            let of = |index: usize| words.get(index * count..(index + 1) * count).unwrap_or_default().iter().copied();
            corners().flat_map(of).collect()
        };
        Object {
            name: self.name.clone(),
            positions: corners().filter_map(|index| self.positions.get(index).copied()).collect(),
            normals: corners().filter_map(|index| self.normals.get(index).copied()).collect(),
            colors: corners().filter_map(|index| self.colors.get(index).copied()).collect(),
            attributes: self.attributes.iter().map(attribute).collect(),
            triangles: (0..self.triangles.len() as u32)
                .map(|first| [3 * first, 3 * first + 1, 3 * first + 2])
                .collect(),
        }
    }
}

/// Returns the distances of a corner of a triangle to the lines through the edges opposite to its corners: one is its height over the opposite
/// edge, the others are 0. Over the triangle they are interpolated to the distances of a point.
pub fn edge_distances(corners: [[f32; 3]; 3], corner: usize) -> [f32; 3] {
    let [a, b, c] = corners.map(Vec3::from_array);
    let double_area = (b - a).cross(c - a).length();
    let opposite = [c - b, a - c, b - a].map(Vec3::length);
    std::array::from_fn(|edge| match opposite.get(edge) {
        Some(length) if edge == corner && *length > 0.0 => double_area / length,
        _ => 0.0,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn triangles_share_no_vertex_and_keep_their_values() {
        let mut object = Object::default();
        let corners: Vec<u32> = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]
            .map(|[x, y]| object.vertex([x, y, 0.0], [0.0, 0.0, 1.0], [x, y, 0.5, 1.0]))
            .to_vec();
        object.polygon(&corners);
        object.attributes = vec![vec![10, 11, 20, 21, 30, 31, 40, 41]];
        let scene = Scene { objects: vec![object], ..Scene::default() };
        let own = scene.with_own_corners();
        assert_eq!((own.vertices(), own.triangles()), (6, 2));
        assert!(own.bytes() >= own.bytes_with_own_corners());
        assert_eq!(own.objects[0].attributes, [[10, 11, 20, 21, 30, 31, 10, 11, 30, 31, 40, 41]]);
        for (before, after) in scene.objects[0].corners().zip(own.objects[0].corners()) {
            assert_eq!(before, after);
        }
        assert_eq!(own.objects[0].colors[4], [1.0, 1.0, 0.5, 1.0]);
    }

    /// A right triangle with sides 3, 4 and 5.
    #[test]
    fn distances_are_heights_at_corners() {
        let corners = [[0.0, 0.0, 7.0], [3.0, 0.0, 7.0], [0.0, 4.0, 7.0]];
        let heights: Vec<[f32; 3]> = (0..3).map(|corner| edge_distances(corners, corner)).collect();
        assert_eq!(heights, [[2.4, 0.0, 0.0], [0.0, 3.0, 0.0], [0.0, 0.0, 4.0]]);
        assert_eq!(edge_distances([[1.0; 3]; 3], 0), [0.0; 3]);
    }
}
