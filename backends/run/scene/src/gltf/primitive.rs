//! The vertices and triangles of a primitive.

use glam::{DMat3, DMat4, DVec3};
use gltf::accessor::{DataType, Dimensions};
use gltf::json::Root;
use gltf::mesh::Mode;
use gltf::{Primitive, Semantic};

use super::accessor::{Elements, Types};
use super::locate::Text;
use super::material::{factor, visible};
use crate::attribute::AttributeRequest;
use crate::error::FileError;
use crate::limits::Budget;
use crate::model::{ModelObject, normal};
use crate::text::MAX_NUMBER;
use crate::warnings::{FileWarnings, Message, WarningKind};

const POSITIONS: Types = Types {
    dimensions: &[Dimensions::Vec3],
    // Integers: KHR_mesh_quantization.
    components: &[DataType::F32, DataType::I8, DataType::U8, DataType::I16, DataType::U16],
};

const NORMALS: Types =
    Types { dimensions: &[Dimensions::Vec3], components: &[DataType::F32, DataType::I8, DataType::I16] };

const COLORS: Types = Types {
    dimensions: &[Dimensions::Vec3, Dimensions::Vec4],
    components: &[DataType::F32, DataType::U8, DataType::U16],
};

const INDICES: Types =
    Types { dimensions: &[Dimensions::Scalar], components: &[DataType::U8, DataType::U16, DataType::U32] };

/// The bytes that a primitive counts for, so that the time for primitives is limited.
const PRIMITIVE: u64 = 64;

/// The bytes of the offset of a vertex in a morph target.
const MORPH_OFFSET: u64 = 12;

/// The buffers of a model and the settings for its primitives.
pub(super) struct Reader<'a> {
    pub(super) buffers: &'a [Vec<u8>],
    pub(super) root: &'a Root,
    pub(super) color: [f32; 4],
    /// The attributes that the caller requests.
    pub(super) requests: &'a [AttributeRequest],
    pub(super) text: Text<'a>,
    pub(super) budget: &'a Budget,
    pub(super) warnings: FileWarnings<'a>,
}

impl Reader<'_> {
    /// Adds a primitive to an object.
    pub(super) fn primitive(
        &self,
        primitive: &Primitive<'_>,
        mesh: usize,
        (transform, weights): (&DMat4, &[f32]),
        object: &mut ModelObject,
    ) -> Result<(), FileError> {
        let error = |message: String| FileError::whole(format!("primitive {}: {message}", primitive.index()));
        // Nodes may share a mesh, so that a small file has very many primitives.
        self.budget.take(1, PRIMITIVE, "the primitives")?;
        if primitive.get(&Semantic::Positions).is_none() {
            let message = || "a primitive without POSITION is not drawn".to_owned();
            self.warnings.add(WarningKind::NotRead, "POSITION", || (self.text.position("meshes", mesh), message()));
            return Ok(());
        }
        let corners_of = match primitive.mode() {
            Mode::Triangles => |turn: usize| [3 * turn, 3 * turn + 1, 3 * turn + 2],
            // Every second triangle of a strip is turned, so that all have the same front.
            Mode::TriangleStrip => |turn: usize| [turn + turn % 2, turn + 1 - turn % 2, turn + 2],
            Mode::TriangleFan => |turn: usize| [0, turn + 1, turn + 2],
            _ => {
                let message = || "lines and points are not read".to_owned();
                self.warnings.add(WarningKind::NotRead, "lines", || (self.text.position("meshes", mesh), message()));
                return Ok(());
            }
        };
        let first = object.positions.len() as u32;
        let vertices = self.vertices(primitive, mesh, (transform, weights), object)?;
        let indices =
            primitive.indices().map(|accessor| Elements::of(&accessor, &INDICES, self.buffers)).transpose()?;
        let count = indices.as_ref().map_or(vertices, |indices| indices.count);
        let triangles = match primitive.mode() {
            Mode::Triangles => count / 3,
            _ => count.saturating_sub(2),
        };
        self.budget.triangles(triangles as u64)?;
        // Corners of a mirrored node are clockwise.
        let is_mirrored = transform.determinant() < 0.0;
        object.triangles.reserve(triangles);
        for turn in 0..triangles {
            let mut triangle = [0; 3];
            for (corner, number) in triangle.iter_mut().zip(corners_of(turn)) {
                let index = indices.as_ref().map_or(number as u32, |indices| indices.index(number));
                if index as usize >= vertices {
                    return Err(error(format!("no vertex {index}: it has {vertices}")));
                }
                *corner = first + index;
            }
            if is_mirrored {
                triangle.swap(1, 2);
            }
            object.triangles.push(triangle);
        }
        Ok(())
    }

    /// Returns the offsets of the morph targets of a primitive, each with its weight.
    fn morphs(
        &self,
        primitive: &Primitive<'_>,
        weights: &[f32],
        count: usize,
    ) -> Result<Vec<(f32, Elements<'_>)>, FileError> {
        let mut morphs = Vec::new();
        for (target, weight) in primitive.morph_targets().zip(weights).filter(|(_, weight)| **weight != 0.0) {
            let Some(accessor) = target.positions() else { continue };
            let offsets = Elements::of(&accessor, &POSITIONS, self.buffers)?;
            if offsets.count != count {
                let (number, found) = (primitive.index(), offsets.count);
                let message = format!("primitive {number}: a morph target of {found} of {count} positions");
                return Err(FileError::whole(message));
            }
            // Offsets are read where they are. They count as if they were copied, so that the time for them is limited, too.
            self.budget.take(count as u64, MORPH_OFFSET, "the morph targets")?;
            morphs.push((*weight, offsets));
        }
        Ok(morphs)
    }

    /// Adds the vertices of a primitive to an object; returns their number.
    fn vertices(
        &self,
        primitive: &Primitive<'_>,
        mesh: usize,
        (transform, weights): (&DMat4, &[f32]),
        object: &mut ModelObject,
    ) -> Result<usize, FileError> {
        let error = |message: String| FileError::whole(format!("primitive {}: {message}", primitive.index()));
        let read = |semantic: Semantic, types: &Types| {
            let accessor = primitive.get(&semantic);
            accessor.map(|accessor| Elements::of(&accessor, types, self.buffers)).transpose()
        };
        let positions = read(Semantic::Positions, &POSITIONS)?.ok_or_else(|| error("it has no POSITION".to_owned()))?;
        let normals = read(Semantic::Normals, &NORMALS)?;
        let colors = read(Semantic::Colors(0), &COLORS)?;
        for (name, elements) in [("NORMAL", &normals), ("COLOR_0", &colors)] {
            if let Some(elements) = elements.as_ref().filter(|elements| elements.count != positions.count) {
                return Err(error(format!("{} of {name}, and {} of POSITION", elements.count, positions.count)));
            }
        }
        self.budget.vertices(object, positions.count as u64)?;
        let material = primitive.material();
        let factor = factor(&material, colors.is_some(), self.color);
        let morphs = self.morphs(primitive, weights, positions.count)?;
        let attributes = self.attributes(primitive, mesh, positions.count)?;
        let directions = DMat3::from_mat4(*transform).inverse().transpose();
        for index in 0..positions.count {
            let moved = morphs.iter().map(|(weight, offsets)| f64::from(*weight) * vector(offsets, index));
            let position = transform.transform_point3(vector(&positions, index) + moved.sum::<DVec3>());
            let is_valid = position.is_finite() && position.abs().max_element() <= MAX_NUMBER;
            if !is_valid {
                return Err(error(format!("position {index} is not finite")));
            }
            let given = normals.as_ref().map_or(DVec3::ZERO, |normals| vector(normals, index));
            if !given.is_finite() {
                let text = || format!("primitive {}: normal {index} is not finite", primitive.index());
                let message = || Message::new(text(), "it is computed");
                self.warnings.add(WarningKind::InvalidNormal, "", || (self.text.position("meshes", mesh), message()));
            }
            // A transform without an inverse has no normals, either.
            let direction = normal((directions * given).to_array()).unwrap_or_default();
            let color = colors.as_ref().map_or([1.0; 4], |colors| rgba(colors, index));
            let color: [f32; 4] = std::array::from_fn(|channel| factor[channel] * color[channel]);
            if !color.iter().all(|channel| channel.is_finite()) {
                return Err(error(format!("colour {index} is not finite")));
            }
            let color = visible(&material, color);
            object.vertex(position.to_array(), direction, color);
            for (values, words) in attributes.iter().zip(&mut object.attributes) {
                values.add(index, mesh, self, words);
            }
        }
        Ok(positions.count)
    }
}

fn vector(elements: &Elements<'_>, index: usize) -> DVec3 {
    DVec3::new(elements.float(index, 0).into(), elements.float(index, 1).into(), elements.float(index, 2).into())
}

fn rgba(elements: &Elements<'_>, index: usize) -> [f32; 4] {
    let alpha = if elements.components == 4 { elements.float(index, 3) } else { 1.0 };
    [elements.float(index, 0), elements.float(index, 1), elements.float(index, 2), alpha]
}
