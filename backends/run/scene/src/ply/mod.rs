//! PLY, ASCII or binary in both byte orders: the positions, normals and colours of `vertex`, the polygons and colours of `face`, and
//! triangle strips, and properties of `vertex` that the caller requests. Other elements and properties are skipped.
//!
//! The reader is our own because every error needs its line, or its byte: `ply-rs-bw` reports no bytes in binary files.
//! Integer colours are divided by their greatest value. Elements may have any order: faces before the vertices are read after them.

mod attributes;
mod body;
mod faces;
mod header;

use crate::attribute::{AttributeRequest, MAX_COMPONENTS};
use crate::color_range::ColorRange;
use crate::error::{FileError, FilePosition};
use crate::limits::{Budget, OBJECT};
use crate::model::{ModelObject, normal};
use crate::text::{MAX_NUMBER, quoted};
use crate::warnings::{FileWarnings, Message, WarningKind};
use attributes::Component;
use body::Body;
use faces::Faces;
use header::{Element, Header, Property};

/// Reads a model, and returns the attributes that it has. `color` is the colour of vertices without one; `attributes` are properties of
/// vertices.
pub(crate) fn parse(
    bytes: &[u8],
    (color, attributes): ([f32; 4], &[AttributeRequest]),
    (budget, warnings): (&Budget, FileWarnings<'_>),
) -> Result<(Vec<ModelObject>, Vec<AttributeRequest>), FileError> {
    let header = Header::parse(bytes)?;
    let vertices = header.elements.iter().filter(|element| element.name == "vertex");
    let attributes = attributes::existing(vertices, attributes);
    let attributes = attributes.as_slice();
    if let Some(line) = header.texture {
        warnings.line(WarningKind::NotRead, "TextureFile", line, || "textures are not read".to_owned());
    }
    check_names(&header, warnings)?;
    budget.take(1, OBJECT, "the scene's objects")?;
    read(&header, bytes, (color, attributes), (budget, warnings))
        .map(|object| (vec![object], attributes.to_vec()))
        .map_err(|error| header.with_counts(error, bytes))
}

/// Reads the body of a file.
fn read(
    header: &Header,
    bytes: &[u8],
    (color, attributes): ([f32; 4], &[AttributeRequest]),
    (budget, warnings): (&Budget, FileWarnings<'_>),
) -> Result<ModelObject, FileError> {
    let mut body = Body::new(header, bytes);
    let mut object = ModelObject::new(String::new(), attributes.len());
    // The elements with faces, each with its position in the body.
    let mut face_elements = Vec::new();
    for element in &header.elements {
        match element.name.as_str() {
            "vertex" => Vertices::of((element, &header.elements), (color, attributes))?.read(
                &mut body,
                (&mut object, budget),
                warnings,
            )?,
            "face" | "tristrips" => {
                face_elements.push((element, body.clone()));
                skip(element, &mut body)?;
            }
            _ => skip(element, &mut body)?,
        }
    }
    body.end(header, warnings);
    let mut faces = Faces::new((&mut object, attributes), budget, warnings, has_colors(header));
    for (element, mut body) in face_elements {
        faces.read(element, &mut body)?;
    }
    Ok(object)
}

/// Rejects a file whose vertices or faces have another name, and warns of other elements and properties with names that have no effect.
fn check_names(header: &Header, warnings: FileWarnings<'_>) -> Result<(), FileError> {
    for element in &header.elements {
        if let Some(right) = element.right_name() {
            let message = format!("the element {} is not read: its name in PLY is `{right}`", quoted(&element.name));
            if !header.elements.iter().any(|other| other.name == right) {
                return Err(FileError::line(element.line, message));
            }
            warnings.line(WarningKind::UnknownStatement, &element.name, element.line, || message);
        }
        for property in element.duplicates() {
            let message = || {
                let (property, element) = (quoted(&property.name), quoted(&element.name));
                Message::new(format!("the element {element} has the property {property} twice"), "the last is used")
            };
            warnings.line(WarningKind::UnknownStatement, &property.name, property.line, message);
        }
    }
    Ok(())
}

/// The names of the properties of a vertex.
const PROPERTIES: [&str; 10] = ["x", "y", "z", "nx", "ny", "nz", "red", "green", "blue", "alpha"];

/// The index of red in [`PROPERTIES`].
const RED: usize = 6;

/// Returns the index in [`PROPERTIES`] of each property of an element. Colours have several names.
fn slots(element: &Element) -> Vec<Option<usize>> {
    const SHORT: [&str; 4] = ["r", "g", "b", "a"];
    let has = |name: &&str| element.properties.iter().any(|other| other.name == *name && other.list.is_none());
    // One of these names alone is another quantity, such as a radius.
    let has_short = SHORT.iter().take(3).all(has);
    let slot = |property: &Property| {
        let name = property.name.as_str();
        let plain = name.strip_prefix("diffuse_").unwrap_or(name);
        let short = || SHORT.iter().position(|known| has_short && *known == name).map(|short| RED + short);
        let slot = PROPERTIES.iter().position(|known| *known == name || *known == plain).or_else(short);
        slot.filter(|_| property.list.is_none())
    };
    element.properties.iter().map(slot).collect()
}

/// Whether the vertices of a file have colours.
fn has_colors(header: &Header) -> bool {
    let vertices = header.elements.iter().filter(|element| element.name == "vertex");
    vertices.flat_map(slots).flatten().any(is_color)
}

/// Whether a property is red, green or blue.
fn is_color(slot: usize) -> bool {
    (RED..RED + 3).contains(&slot)
}

/// Returns the range of the colours of an element.
fn color_range(element: &Element, slots: &[Option<usize>]) -> ColorRange {
    let colors = element.properties.iter().zip(slots).filter(|(_, slot)| slot.is_some_and(is_color));
    ColorRange::of_numbers_to(colors.map(|(property, _)| property.kind.greatest()).fold(1.0, f64::max))
}

/// Returns a channel of a colour from its value.
fn channel(value: f64, property: &Property, body: &Body<'_>) -> Result<f64, FileError> {
    if value.is_finite() {
        return Ok(value / property.kind.greatest());
    }
    Err(body.error(format!("{} is not finite", quoted(&property.name))))
}

/// The vertices of an element.
struct Vertices<'a> {
    element: &'a Element,
    /// The index of each property in [`PROPERTIES`].
    slots: Vec<Option<usize>>,
    color: [f32; 4],
    attributes: &'a [AttributeRequest],
    /// The components of attributes that each property is.
    components: Vec<Vec<Component>>,
}

impl<'a> Vertices<'a> {
    fn of(
        (element, elements): (&'a Element, &[Element]),
        (color, attributes): ([f32; 4], &'a [AttributeRequest]),
    ) -> Result<Self, FileError> {
        let slots = slots(element);
        if let Some(name) = PROPERTIES.iter().take(3).zip(0..).find(|(_, axis)| !slots.contains(&Some(*axis))) {
            return Err(FileError::line(element.line, format!("vertices have no `{}`", name.0)));
        }
        let has_colors = slots.iter().flatten().any(|slot| is_color(*slot));
        let [r, g, b, a] = color;
        // A colour without alpha is opaque.
        let color = [r, g, b, if has_colors { 1.0 } else { a }];
        Ok(Vertices { element, slots, color, attributes, components: attributes::find(element, elements, attributes)? })
    }

    fn read(
        &self,
        body: &mut Body<'_>,
        (object, budget): (&mut ModelObject, &Budget),
        warnings: FileWarnings<'_>,
    ) -> Result<(), FileError> {
        let (first, mut range) = (object.colors.len(), color_range(self.element, &self.slots));
        let mut values = vec![[0.0; MAX_COMPONENTS]; self.attributes.len()];
        let mut line_before = None;
        body.begin(self.element);
        for _ in 0..self.element.count {
            let line = body.next_line();
            let (mut position, mut direction, mut color) = ([0.0; 3], [0.0; 3], self.color.map(f64::from));
            for ((property, slot), components) in self.element.properties.iter().zip(&self.slots).zip(&self.components)
            {
                if slot.is_none() && components.is_empty() {
                    skip_property(property, body)?;
                    continue;
                }
                let value = body.scalar(property.kind)?;
                for Component { attribute, index } in components {
                    if let Some(component) = values.get_mut(*attribute).and_then(|values| values.get_mut(*index)) {
                        *component = value;
                    }
                }
                let Some(slot) = slot else { continue };
                match slot {
                    0..3 if !value.is_finite() => {
                        return Err(body.error(format!("{} is not finite", quoted(&property.name))));
                    }
                    0..3 if value.abs() > MAX_NUMBER => {
                        return Err(body.error(format!("{} is not from -1e300 to 1e300", quoted(&property.name))));
                    }
                    0..3 => position[*slot] = value,
                    3..RED => direction[*slot - 3] = value,
                    _ => color[*slot - RED] = channel(value, property, body)?,
                }
            }
            if let Some((line, start)) = line {
                // One vertex per line, as every writer does. Otherwise a value is missing, or is one too many.
                if line != body.last_line() || line_before == Some(line) {
                    warnings.add(WarningKind::OutOfRange, "", || {
                        let text = body.mismatch((line, start), &self.element.properties);
                        (FilePosition::Line(line), Message::new(text, "values are read across lines"))
                    });
                }
                line_before = Some(body.last_line());
            }
            budget.vertices(object, 1)?;
            let direction = normal(direction).unwrap_or_else(|| {
                let message = || Message::new("a normal is not finite", "it is computed");
                warnings.add(WarningKind::InvalidNormal, "", || (body.position(), message()));
                [0.0; 3]
            });
            object.vertex(position, direction, range.add(color, body.position()));
            for ((request, values), words) in self.attributes.iter().zip(&values).zip(&mut object.attributes) {
                let values = values.iter().take(request.components);
                words.extend(values.map(|value| request.word(*value, || body.position(), warnings)));
            }
            body.end_record();
        }
        range.apply(object.colors.iter_mut().skip(first), warnings);
        Ok(())
    }
}

fn skip(element: &Element, body: &mut Body<'_>) -> Result<(), FileError> {
    // Records without properties are nothing in the file, however many there are.
    if element.properties.is_empty() {
        return Ok(());
    }
    body.begin(element);
    for _ in 0..element.count {
        for property in &element.properties {
            skip_property(property, body)?;
        }
        body.end_record();
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
