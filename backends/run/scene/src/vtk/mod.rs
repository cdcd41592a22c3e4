//! Unstructured grids of VTK, legacy (`.vtk`, ASCII and binary) and XML (`.vtu`): every face of their tetrahedra once. Hexahedra, wedges,
//! pyramids and voxels are divided into tetrahedra.
//!
//! Input: the bytes of a file. Output: one object, whose attributes are data of points or cells. The reader is our own because every error needs its
//! line or its byte, and every allocation a limit: the crate `vtkio` 0.6 has neither, and its last release is of 2021.

mod cells;
mod fields;
mod legacy;
mod numbers;
mod scan;
mod xml;
mod xml_data;

use crate::attribute::AttributeRequest;
use crate::error::{FileError, FilePosition};
use crate::limits::{Budget, OBJECT, TRIANGLE};
use crate::model::ModelObject;
use crate::tetrahedra::{faces, vertices};
use crate::text::MAX_NUMBER;
use crate::warnings::FileWarnings;
use fields::{Field, Wanted};

/// The beginning of a legacy file.
const LEGACY: &[u8] = b"# vtk DataFile";

/// A grid as it is in a file.
#[derive(Debug, Default)]
struct Grid {
    /// Three coordinates per point.
    points: Vec<f64>,
    /// The points of all cells, one cell after the other.
    connectivity: Vec<f64>,
    /// The end of each cell in the connectivity.
    ends: Vec<f64>,
    /// The types of the cells.
    types: Vec<f64>,
    fields: Vec<Field>,
    /// The positions of the points and of the cells in the file.
    points_at: Option<FilePosition>,
    cells_at: Option<FilePosition>,
}

/// Reads a grid, and returns the attributes that it has. `color` is the colour of its vertices.
pub(crate) fn parse(
    bytes: &[u8],
    (color, attributes): ([f32; 4], &[AttributeRequest]),
    (budget, warnings): (&Budget, FileWarnings<'_>),
) -> Result<(Vec<ModelObject>, Vec<AttributeRequest>), FileError> {
    let wanted = Wanted(attributes);
    let grid = match bytes.starts_with(LEGACY) {
        true => legacy::read(bytes, &wanted, budget, warnings)?,
        false => xml::read(bytes, &wanted, budget, warnings)?,
    };
    let found = wanted.find(&grid.fields)?;
    let object = grid.object((color, &found), (budget, warnings))?;
    Ok((vec![object], found.into_iter().map(|(request, _)| request).collect()))
}

impl Grid {
    /// Returns the faces of the tetrahedra with these attributes.
    fn object(
        &self,
        (color, attributes): ([f32; 4], &[(AttributeRequest, fields::Source)]),
        (budget, warnings): (&Budget, FileWarnings<'_>),
    ) -> Result<ModelObject, FileError> {
        let positions = self.positions(budget)?;
        let (tetrahedra, cells) = cells::divided(self, positions.len(), (budget, warnings))?;
        let faces = faces(&positions, &tetrahedra, budget)?;
        let per_face = attributes.iter().any(|(_, source)| source.is_of_cells());
        let (corners, triangles) = vertices(positions.len(), &faces, per_face, budget)?;
        budget.take(1, OBJECT, "the scene's objects")?;
        let mut object = ModelObject::new(String::new(), attributes.len());
        budget.vertices(&object, corners.len() as u64)?;
        budget.take(triangles.len() as u64, TRIANGLE, "the scene's triangles")?;
        for corner in &corners {
            let position = positions.get(corner.point as usize).copied().unwrap_or_default();
            object.vertex(position, [0.0; 3], color);
        }
        object.triangles = triangles;
        for ((request, source), words) in attributes.iter().zip(&mut object.attributes) {
            let values = source.values(self, (&positions, &tetrahedra), budget)?;
            let cell_of = |tetrahedron: u32| cells.get(tetrahedron as usize).copied().unwrap_or_default();
            for corner in &corners {
                for component in 0..request.components {
                    let value = values.at(corner, cell_of(corner.face.tetrahedron), component);
                    words.push(request.word(value, || source.position(self), warnings));
                }
            }
        }
        Ok(object)
    }

    /// Returns the points.
    fn positions(&self, budget: &Budget) -> Result<Vec<[f64; 3]>, FileError> {
        budget.take(self.points.len() as u64, 8, "the points of the grid")?;
        let is_valid = |value: &f64| value.is_finite() && value.abs() <= MAX_NUMBER;
        if let Some(at) = self.points.iter().position(|value| !is_valid(value)) {
            let message = format!("point {} is not finite, or not from -1e300 to 1e300", at / 3);
            return Err(FileError::Malformed(self.points_at.unwrap_or(FilePosition::Line(1)), message));
        }
        Ok(self.points.as_chunks::<3>().0.to_vec())
    }
}
