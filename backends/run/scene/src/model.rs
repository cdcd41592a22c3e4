//! The objects of a model while it is read, with positions in doubles: a model at map coordinates needs them.

use crate::scene::fan;

/// A named part of a model. Its three vertex lists have equal lengths.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct ModelObject {
    pub(crate) name: String,
    /// Positions, finite.
    pub(crate) positions: Vec<[f64; 3]>,
    /// Normals; zero: computed later.
    pub(crate) normals: Vec<[f32; 3]>,
    /// Linear red, green and blue with straight alpha.
    pub(crate) colors: Vec<[f32; 4]>,
    /// The words of each attribute that the caller requested: those of one vertex after the other.
    pub(crate) attributes: Vec<Vec<u32>>,
    /// Three vertex indices each, in range.
    pub(crate) triangles: Vec<[u32; 3]>,
}

impl ModelObject {
    /// Returns an object without vertices that has `attributes` attributes.
    pub(crate) fn new(name: String, attributes: usize) -> Self {
        ModelObject { name, attributes: vec![Vec::new(); attributes], ..ModelObject::default() }
    }

    /// Adds a vertex and returns its index. A zero normal is computed later from the triangles around the vertex.
    pub(crate) fn vertex(&mut self, position: [f64; 3], normal: [f32; 3], color: [f32; 4]) -> u32 {
        self.positions.push(position);
        self.normals.push(normal);
        self.colors.push(color);
        self.positions.len() as u32 - 1
    }

    /// Adds a convex polygon as a fan.
    pub(crate) fn polygon(&mut self, corners: &[u32]) {
        self.triangles.extend(fan(corners));
    }

    /// Returns the positions of the corners of all triangles.
    pub(crate) fn corners(&self) -> impl Iterator<Item = [f64; 3]> {
        self.triangles.iter().flatten().filter_map(|index| self.positions.get(*index as usize).copied())
    }
}

/// Returns a normal as `f32`, scaled so that its greatest component is 1. `None`: a component is not finite.
pub(crate) fn normal([x, y, z]: [f64; 3]) -> Option<[f32; 3]> {
    let greatest = x.abs().max(y.abs()).max(z.abs());
    if ![x, y, z].iter().all(|component| component.is_finite()) {
        return None;
    }
    Some(if greatest > 0.0 { [x, y, z].map(|component| (component / greatest) as f32) } else { [0.0; 3] })
}
