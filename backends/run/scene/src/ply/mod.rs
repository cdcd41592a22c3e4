//! PLY, ASCII and binary in both byte orders: the positions, normals and colours of `vertex`, the polygons of `face`.
//! Other elements and properties are skipped.
//!
//! The reader is our own because every error needs its line, or its byte: `ply-rs-bw` reports no bytes in binary files.
//! Integer colours are divided by their greatest value; float colours are used unchanged.

mod body;
mod header;

use crate::error::FileError;
use crate::limits::{Budget, OBJECT};
use crate::polygon::Triangulator;
use crate::text::quoted;
use crate::{Object, Scene};
use body::Body;
use header::{Element, Header, Property};

/// Reads a model. `color` is the colour of vertices without one.
pub(crate) fn parse(bytes: &[u8], color: [f32; 4], budget: &Budget) -> Result<Scene, FileError> {
    let header = Header::parse(bytes)?;
    budget.take(1, OBJECT, "the scene's objects")?;
    let mut body = Body::new(&header, bytes);
    let (mut object, mut triangulator) = (Object::default(), Triangulator::new());
    for element in &header.elements {
        match element.name.as_str() {
            "vertex" => vertices(element, &mut body, color, (&mut object, budget))?,
            "face" => faces(element, &mut body, &mut triangulator, (&mut object, budget))?,
            "tristrips" => return Err(FileError::line(element.line, "triangle strips are not supported: use faces")),
            _ => skip(element, &mut body)?,
        }
    }
    body.end()?;
    Ok(Scene { objects: vec![object] })
}

/// The names of the properties of a vertex.
const PROPERTIES: [&str; 10] = ["x", "y", "z", "nx", "ny", "nz", "red", "green", "blue", "alpha"];

fn vertices(
    element: &Element,
    body: &mut Body<'_>,
    color: [f32; 4],
    (object, budget): (&mut Object, &Budget),
) -> Result<(), FileError> {
    let slots: Vec<Option<usize>> = element
        .properties
        .iter()
        .map(|property| {
            PROPERTIES.iter().position(|name| property.name == *name || property.name == format!("diffuse_{name}"))
        })
        .collect();
    if let Some(axis) = (0..3).find(|axis| !slots.contains(&Some(*axis))) {
        return Err(FileError::line(element.line, format!("vertices have no `{}`", PROPERTIES[axis])));
    }
    let has_colors = (6..9).any(|slot| slots.contains(&Some(slot)));
    let [r, g, b, a] = color;
    // A colour without alpha is opaque.
    let defaults = [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, r, g, b, if has_colors { 1.0 } else { a }];
    for _ in 0..element.count {
        let mut values: [f32; 10] = defaults;
        for (property, slot) in element.properties.iter().zip(&slots) {
            if let (None, Some(slot)) = (property.list, slot) {
                let value = body.scalar(property.kind)?;
                let scale = if *slot >= 6 { property.kind.greatest() } else { 1.0 };
                let value = (value / scale) as f32;
                if !value.is_finite() {
                    return Err(body.error(format!("{} is not finite", quoted(&property.name))));
                }
                values[*slot] = value;
            } else {
                skip_property(property, body)?;
            }
        }
        budget.vertices(object, 1)?;
        let [x, y, z, nx, ny, nz, r, g, b, a] = values;
        object.vertex([x, y, z], [nx, ny, nz], [r, g, b, a]);
    }
    Ok(())
}

fn faces(
    element: &Element,
    body: &mut Body<'_>,
    triangulator: &mut Triangulator,
    (object, budget): (&mut Object, &Budget),
) -> Result<(), FileError> {
    let indices = |property: &Property| ["vertex_indices", "vertex_index"].contains(&property.name.as_str());
    if !element.properties.iter().any(|property| indices(property) && property.list.is_some()) {
        return Err(FileError::line(element.line, "faces have no list `vertex_indices`"));
    }
    let count = object.positions.len();
    for _ in 0..element.count {
        for property in &element.properties {
            let Some(length) = property.list.filter(|_| indices(property)) else {
                skip_property(property, body)?;
                continue;
            };
            let length = body.length(length, property.kind)?;
            if length < 3 {
                return Err(body.error(format!("a face with {length} vertices: it needs 3 or more")));
            }
            budget.triangles(length - 2)?;
            let _corners = triangulator.begin(length, budget)?;
            for _ in 0..length {
                let index = body.scalar(property.kind)?;
                if index.fract() != 0.0 || index < 0.0 || index >= count as f64 {
                    return Err(body.error(format!("no vertex {index}: the file has {count}, counted from 0")));
                }
                triangulator.corner(index as u32);
            }
            triangulator.end(object).map_err(|message| body.error(message))?;
        }
    }
    Ok(())
}

fn skip(element: &Element, body: &mut Body<'_>) -> Result<(), FileError> {
    // Records without properties are nothing in the file, however many there are.
    if element.properties.is_empty() {
        return Ok(());
    }
    for _ in 0..element.count {
        for property in &element.properties {
            skip_property(property, body)?;
        }
    }
    Ok(())
}

fn skip_property(property: &Property, body: &mut Body<'_>) -> Result<(), FileError> {
    let count = property.list.map_or(Ok(1), |length| body.length(length, property.kind))?;
    for _ in 0..count {
        body.scalar(property.kind)?;
    }
    Ok(())
}
