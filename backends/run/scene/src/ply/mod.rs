//! PLY, ascii and binary in both orders of bytes: the positions, normals and colours of `vertex`, the polygons of `face`.
//! Other elements and properties are read and passed over.
//!
//! Written out here because every mistake must have its line, or its byte. Colours are taken as they stand: integers over
//! their greatest value, floats as they are.

mod body;
mod header;

use crate::error::Fault;
use crate::{Object, Scene};
use body::Body;
use header::{Element, Header, Property};

/// Reads a model. `color` is the colour of what has none.
pub(crate) fn parse(bytes: &[u8], color: [f32; 4]) -> Result<Scene, Fault> {
    let header = Header::parse(bytes)?;
    let mut body = Body::new(&header, bytes);
    let mut object = Object::default();
    for element in &header.elements {
        match element.name.as_str() {
            "vertex" => vertices(element, &mut body, color, &mut object)?,
            "face" => faces(element, &mut body, &mut object)?,
            "tristrips" => return Err(Fault::line(element.line, "triangle strips are not read: give faces")),
            _ => skip(element, &mut body)?,
        }
    }
    body.end()?;
    Ok(Scene { objects: vec![object] })
}

/// What a vertex has, by the names of properties, in the order of `VALUES`.
const VALUES: [&str; 10] = ["x", "y", "z", "nx", "ny", "nz", "red", "green", "blue", "alpha"];

fn vertices(element: &Element, body: &mut Body<'_>, color: [f32; 4], object: &mut Object) -> Result<(), Fault> {
    let slots: Vec<Option<usize>> = element
        .properties
        .iter()
        .map(|property| {
            VALUES.iter().position(|name| property.name == *name || property.name == format!("diffuse_{name}"))
        })
        .collect();
    if let Some(axis) = (0..3).find(|axis| !slots.contains(&Some(*axis))) {
        return Err(Fault::line(element.line, format!("vertices have no `{}`", VALUES[axis])));
    }
    let own_colors = (6..9).any(|slot| slots.contains(&Some(slot)));
    let [r, g, b, a] = color;
    // A colour without an alpha is opaque.
    let defaults = [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, r, g, b, if own_colors { 1.0 } else { a }];
    for _ in 0..element.count {
        body.record()?;
        let mut values: [f32; 10] = defaults;
        for (property, slot) in element.properties.iter().zip(&slots) {
            if let (None, Some(slot)) = (property.list, slot) {
                let value = body.scalar(property.kind)?;
                let scale = if *slot >= 6 { property.kind.greatest() } else { 1.0 };
                let value = (value / scale) as f32;
                if !value.is_finite() {
                    return Err(body.fault(format!("`{}` is not finite", property.name)));
                }
                values[*slot] = value;
            } else {
                skip_property(property, body)?;
            }
        }
        body.end_record()?;
        let [x, y, z, nx, ny, nz, r, g, b, a] = values;
        object.vertex([x, y, z], [nx, ny, nz], [r, g, b, a]);
    }
    Ok(())
}

fn faces(element: &Element, body: &mut Body<'_>, object: &mut Object) -> Result<(), Fault> {
    let indices = |property: &Property| ["vertex_indices", "vertex_index"].contains(&property.name.as_str());
    if !element.properties.iter().any(|property| indices(property) && property.list.is_some()) {
        return Err(Fault::line(element.line, "faces have no list `vertex_indices`"));
    }
    let count = object.positions.len();
    let mut corners = Vec::new();
    for _ in 0..element.count {
        body.record()?;
        for property in &element.properties {
            let Some(length) = property.list.filter(|_| indices(property)) else {
                skip_property(property, body)?;
                continue;
            };
            corners.clear();
            let length = body.length(length)?;
            if length < 3 {
                return Err(body.fault(format!("a face of {length} vertices: it needs 3 or more")));
            }
            for _ in 0..length {
                let index = body.scalar(property.kind)?;
                if index.fract() != 0.0 || index < 0.0 || index >= count as f64 {
                    return Err(body.fault(format!("no vertex {index}: there are {count}, from 0")));
                }
                corners.push(index as u32);
            }
            object.polygon(&corners);
        }
        body.end_record()?;
    }
    Ok(())
}

fn skip(element: &Element, body: &mut Body<'_>) -> Result<(), Fault> {
    for _ in 0..element.count {
        body.record()?;
        for property in &element.properties {
            skip_property(property, body)?;
        }
        body.end_record()?;
    }
    Ok(())
}

fn skip_property(property: &Property, body: &mut Body<'_>) -> Result<(), Fault> {
    let count = property.list.map_or(Ok(1), |length| body.length(length))?;
    for _ in 0..count {
        body.scalar(property.kind)?;
    }
    Ok(())
}
