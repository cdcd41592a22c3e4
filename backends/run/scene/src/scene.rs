//! A scene: indexed triangles per object.

use std::path::PathBuf;

use glam::Vec3;

use crate::{AttributeRequest, Placement, Warning};

/// The triangles of a scene, object after object.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Scene {
    /// The index of an object is its id.
    pub objects: Vec<Object>,
    /// The coordinates of the objects, relative to those of the model.
    pub placement: Placement,
    /// The attributes that the scene was opened with.
    pub attributes: Vec<AttributeRequest>,
    /// What was replaced by a default, and what was not read.
    pub warnings: Vec<Warning>,
    /// The files that the scene was read from, the model first.
    pub files: Vec<PathBuf>,
    /// The order in which triangles are drawn, each once; empty: object after object.
    pub order: Vec<TriangleId>,
}

/// A triangle of a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct TriangleId {
    /// The index of its object.
    pub object: u32,
    /// Its index in the object.
    pub triangle: u32,
}

/// A named part of a scene. Its three vertex lists have equal lengths.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Object {
    /// Its name in the model; empty if it has none.
    pub name: String,
    /// Positions, finite, in the coordinates of the scene's placement.
    pub positions: Vec<[f32; 3]>,
    /// Unit normals.
    pub normals: Vec<[f32; 3]>,
    /// Linear red, green and blue with straight alpha.
    pub colors: Vec<[f32; 4]>,
    /// The words of each attribute of the scene: those of one vertex after the other.
    pub attributes: Vec<Vec<u32>>,
    /// Three vertex indices each, in range.
    pub triangles: Vec<[u32; 3]>,
}

impl Scene {
    /// Returns the number of vertices of all objects.
    pub fn vertices(&self) -> usize {
        self.objects.iter().map(|object| object.positions.len()).sum()
    }

    /// Returns the number of triangles of all objects.
    pub fn triangles(&self) -> usize {
        self.objects.iter().map(|object| object.triangles.len()).sum()
    }

    /// Returns the least and greatest coordinates of the triangles; `None` if there are none.
    pub fn bounds(&self) -> Option<([f32; 3], [f32; 3])> {
        bounds(&self.objects)
    }

    /// Returns the unit vector from the centre of the scene towards a point; the z axis if they are equal.
    pub fn direction_to(&self, point: [f32; 3]) -> [f32; 3] {
        let (least, greatest) = self.bounds().unwrap_or_default();
        let centre = Vec3::from_array(least).midpoint(Vec3::from_array(greatest));
        (Vec3::from_array(point) - centre).normalize_or(Vec3::Z).to_array()
    }

    /// Returns the bytes of the lists of all objects.
    pub fn bytes(&self) -> u64 {
        let bytes = |object: &Object| {
            let vertices = size_of_val(&object.positions[..]) + size_of_val(&object.normals[..]);
            let attributes: usize = object.attributes.iter().map(|words| size_of_val(&words[..])).sum();
            size_of::<Object>()
                + vertices
                + attributes
                + size_of_val(&object.colors[..])
                + size_of_val(&object.triangles[..])
        };
        let objects: u64 = self.objects.iter().map(|object| bytes(object) as u64).sum();
        objects + size_of_val(&self.order[..]) as u64
    }

    /// Returns the triangles object after object, whatever the order in which they are drawn.
    pub(crate) fn triangle_ids(&self) -> impl Iterator<Item = TriangleId> {
        let of = |(object, one): (u32, &Object)| {
            (0..one.triangles.len() as u32).map(move |triangle| TriangleId { object, triangle })
        };
        (0..).zip(&self.objects).flat_map(of)
    }

    /// Returns the three vertices of a triangle; `None`: there is no such triangle.
    pub fn corners(&self, TriangleId { object, triangle }: TriangleId) -> Option<[u32; 3]> {
        self.objects.get(object as usize)?.triangles.get(triangle as usize).copied()
    }
}

/// Returns the least and greatest coordinates of the triangles of objects; `None` if there are none.
pub(crate) fn bounds<'a>(objects: impl IntoIterator<Item = &'a Object>) -> Option<([f32; 3], [f32; 3])> {
    let used = objects.into_iter().flat_map(Object::corners);
    used.map(|position| (position, position)).reduce(|(least, greatest), (position, _)| {
        let pick = |choose: fn(f32, f32) -> f32, from: [f32; 3]| {
            std::array::from_fn(|axis| choose(from[axis], position[axis]))
        };
        (pick(f32::min, least), pick(f32::max, greatest))
    })
}

impl Object {
    /// Returns the positions of the corners of all triangles.
    pub(crate) fn corners(&self) -> impl Iterator<Item = [f32; 3]> {
        self.triangles.iter().flatten().filter_map(|index| self.positions.get(*index as usize).copied())
    }

    /// Adds a vertex and returns its index. A zero normal is computed later from the triangles around the vertex.
    pub(crate) fn vertex(&mut self, position: [f32; 3], normal: [f32; 3], color: [f32; 4]) -> u32 {
        self.positions.push(position);
        self.normals.push(normal);
        self.colors.push(color);
        self.positions.len() as u32 - 1
    }

    /// Adds a convex polygon as a fan.
    pub(crate) fn polygon(&mut self, corners: &[u32]) {
        self.triangles.extend(fan(corners));
    }
}

/// Returns the triangles of a convex polygon.
pub(crate) fn fan(corners: &[u32]) -> impl Iterator<Item = [u32; 3]> {
    let (first, rest) = corners.split_first().map_or((0, &[][..]), |(first, rest)| (*first, rest));
    rest.windows(2).filter_map(move |pair| Some([first, *pair.first()?, *pair.last()?]))
}
