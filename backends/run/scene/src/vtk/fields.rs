//! The data of points and cells, and which of them a caller requests.
//!
//! An attribute is the array of its name, of points or else of cells. `boundary` is 1 on the surface, and `NAME_gradient` the gradient of the array
//! `NAME` of points, unless the file has arrays of these names.

use super::Grid;
use crate::attribute::{AttributeRequest, AvailableAttribute};
use crate::error::{FileError, FilePosition};
use crate::limits::Budget;
use crate::tetrahedra::{Corner, gradients};

/// The greatest number of arrays that an error lists.
const MAX_LISTED: usize = 256;

const BOUNDARY: &str = "boundary";

/// The ending of the name of a gradient.
const GRADIENT: &str = "_gradient";

/// An array of a file.
#[derive(Debug)]
pub(super) struct Field {
    pub(super) name: String,
    pub(super) components: usize,
    pub(super) is_of_cells: bool,
    /// The numbers of one point or cell after the other; empty: nothing needs them.
    pub(super) values: Vec<f64>,
    pub(super) position: FilePosition,
}

/// The attributes that a caller requests.
pub(super) struct Wanted<'a>(pub(super) &'a [AttributeRequest]);

/// Where the values of an attribute come from. Fields are numbers of fields of the grid.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Source {
    Points(usize),
    Cells(usize),
    Gradient(usize),
    Boundary,
}

/// The values of an attribute.
pub(super) enum Values<'a> {
    Points(&'a [f64], usize),
    Cells(&'a [f64], usize),
    Gradient(Vec<[f64; 3]>),
    Boundary,
}

impl Wanted<'_> {
    /// Tests whether the values of an array are needed.
    pub(super) fn needs(&self, name: &str, components: usize) -> bool {
        self.0.iter().any(|request| {
            let is_equal = request.name.eq_ignore_ascii_case(name) && request.components == components;
            is_equal || (components == 1 && is_gradient(request, name))
        })
    }

    /// Returns the requests that a grid with these fields has. `Err`: one is missing that is not optional.
    pub(super) fn find(&self, fields: &[Field]) -> Result<Vec<(AttributeRequest, Source)>, FileError> {
        let mut found = Vec::new();
        for request in self.0 {
            match source(request, fields) {
                Some(source) => found.push((request.clone(), source)),
                None if request.is_optional => {}
                None => return Err(FileError::MissingAttribute(request.clone(), available(fields), None)),
            }
        }
        Ok(found)
    }
}

fn is_gradient(request: &AttributeRequest, name: &str) -> bool {
    let (first, last) = request.name.split_at_checked(name.len()).unwrap_or_default();
    request.components == 3 && first.eq_ignore_ascii_case(name) && last.eq_ignore_ascii_case(GRADIENT)
}

fn source(request: &AttributeRequest, fields: &[Field]) -> Option<Source> {
    let is_equal =
        |field: &Field| field.name.eq_ignore_ascii_case(&request.name) && field.components == request.components;
    let of = |is_of_cells: bool| fields.iter().position(|field| field.is_of_cells == is_of_cells && is_equal(field));
    let gradient = || {
        fields.iter().position(|field| !field.is_of_cells && field.components == 1 && is_gradient(request, &field.name))
    };
    let is_boundary = request.components == 1 && request.name.eq_ignore_ascii_case(BOUNDARY);
    of(false)
        .map(Source::Points)
        .or_else(|| of(true).map(Source::Cells))
        .or_else(|| is_boundary.then_some(Source::Boundary))
        .or_else(|| gradient().map(Source::Gradient))
}

fn available(fields: &[Field]) -> Vec<AvailableAttribute> {
    let mut list: Vec<AvailableAttribute> = Vec::new();
    for field in fields.iter().take(MAX_LISTED) {
        list.push(AvailableAttribute::new(&field.name, field.components));
        if !field.is_of_cells && field.components == 1 {
            list.push(AvailableAttribute::new(&format!("{}{GRADIENT}", field.name), 3));
        }
    }
    list.push(AvailableAttribute::new(BOUNDARY, 1));
    list
}

impl Source {
    pub(super) fn is_of_cells(self) -> bool {
        matches!(self, Source::Cells(_))
    }

    fn field(self, grid: &Grid) -> Option<&Field> {
        match self {
            Source::Points(field) | Source::Cells(field) | Source::Gradient(field) => grid.fields.get(field),
            Source::Boundary => None,
        }
    }

    pub(super) fn position(self, grid: &Grid) -> FilePosition {
        self.field(grid).map_or(FilePosition::Line(1), |field| field.position)
    }

    /// Returns the values. `mesh` has the points and the tetrahedra.
    pub(super) fn values<'g>(
        self,
        grid: &'g Grid,
        (points, tetrahedra): (&[[f64; 3]], &[[u32; 4]]),
        budget: &Budget,
    ) -> Result<Values<'g>, FileError> {
        let (values, components) =
            self.field(grid).map_or((&[][..], 1), |field| (field.values.as_slice(), field.components));
        Ok(match self {
            Source::Points(_) => Values::Points(values, components),
            Source::Cells(_) => Values::Cells(values, components),
            Source::Boundary => Values::Boundary,
            Source::Gradient(_) => {
                budget.take(points.len() as u64, 32 + 24, "the gradient of an attribute")?;
                Values::Gradient(gradients(points, tetrahedra, values))
            }
        })
    }
}

impl Values<'_> {
    /// Returns a component at a corner of a face of a cell; 0 if the array is too short, which its reader prevents.
    pub(super) fn at(&self, corner: &Corner, cell: u32, component: usize) -> f64 {
        let of = |values: &[f64], at: u32, components: usize| {
            values.get(at as usize * components + component).copied().unwrap_or_default()
        };
        match self {
            Values::Points(values, components) => of(values, corner.point, *components),
            Values::Cells(values, components) => of(values, cell, *components),
            Values::Boundary => f64::from(u8::from(corner.face.is_boundary)),
            Values::Gradient(vectors) => {
                let vector = vectors.get(corner.point as usize).copied().unwrap_or_default();
                vector.get(component).copied().unwrap_or_default()
            }
        }
    }
}
