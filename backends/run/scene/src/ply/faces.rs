//! The faces of a PLY file: polygons with a colour or without, and triangle strips.

use std::collections::HashMap;

use super::body::Body;
use super::header::{Element, Kind, Property};
use super::{RED, channel, color_range, is_color, skip_property, slots};
use crate::attribute::AttributeRequest;
use crate::error::FileError;
use crate::limits::{Budget, Held};
use crate::model::ModelObject;
use crate::polygon::Triangulator;
use crate::warnings::{FileWarnings, Message, WarningKind};

/// The bytes of an entry of [`Faces::known`].
const KNOWN: u64 = 64;

/// Adds the faces of a file to the object that has its vertices.
pub(super) struct Faces<'a> {
    object: &'a mut ModelObject,
    attributes: &'a [AttributeRequest],
    budget: &'a Budget,
    warnings: FileWarnings<'a>,
    /// The number of vertices in the file.
    count: usize,
    /// Whether vertices have colours. They have precedence over those of faces.
    has_vertex_colors: bool,
    triangulator: Triangulator,
    /// The copies of vertices with the colours of faces, by the vertex and the bits of the colour.
    known: HashMap<(u32, [u32; 4]), u32>,
}

impl<'a> Faces<'a> {
    pub(super) fn new(
        (object, attributes): (&'a mut ModelObject, &'a [AttributeRequest]),
        budget: &'a Budget,
        warnings: FileWarnings<'a>,
        has_vertex_colors: bool,
    ) -> Self {
        let count = object.positions.len();
        Faces {
            object,
            attributes,
            budget,
            warnings,
            count,
            has_vertex_colors,
            triangulator: Triangulator::new(),
            known: HashMap::new(),
        }
    }

    /// Reads an element.
    pub(super) fn read(&mut self, element: &Element, body: &mut Body<'_>) -> Result<(), FileError> {
        let is_list = |property: &&Property| {
            property.list.is_some() && ["vertex_indices", "vertex_index"].contains(&property.name.as_str())
        };
        let Some(list) = element.properties.iter().position(|property| is_list(&property)) else {
            return Err(FileError::line(element.line, "faces have no list `vertex_indices` or `vertex_index`"));
        };
        let is_used = |slot: &usize| *slot >= RED && !self.has_vertex_colors;
        let slots: Vec<Option<usize>> = slots(element).into_iter().map(|slot| slot.filter(is_used)).collect();
        let has_colors = slots.iter().flatten().any(|slot| is_color(*slot));
        let (first, mut range) = (self.object.colors.len(), color_range(element, &slots));
        if has_colors && element.name == "tristrips" {
            let message = || "the colours of triangle strips are not read".to_owned();
            self.warnings.line(WarningKind::NotRead, "tristrips", element.line, message);
        }
        body.begin(element);
        for _ in 0..element.count {
            let mut color = [1.0; 4];
            // The memory of the corners is held until the end of the record.
            let mut corners = None;
            for (number, (property, slot)) in element.properties.iter().zip(&slots).enumerate() {
                match (property.list, slot) {
                    (Some(length), _) if number == list && element.name == "tristrips" => {
                        self.strip((length, property.kind), body)?;
                    }
                    (Some(length), _) if number == list => corners = self.corners((length, property.kind), body)?,
                    (None, Some(slot)) => {
                        let value = body.scalar(property.kind)?;
                        color[*slot - RED] = channel(value, property, body)?;
                    }
                    _ => skip_property(property, body)?,
                }
            }
            if corners.is_some() {
                if has_colors {
                    self.recolor(range.add(color, body.position()))?;
                }
                self.triangulator.end(self.object).map_err(|message| body.error(message))?;
            }
            body.end_record();
        }
        // Only the copies of this element have the colours that were added.
        range.apply(self.object.colors.iter_mut().skip(first), self.warnings);
        self.known.clear();
        Ok(())
    }

    /// Reads the corners of a face. `None`: it has none, because it has fewer than three.
    fn corners(&mut self, (length, kind): (Kind, Kind), body: &mut Body<'_>) -> Result<Option<Held<'a>>, FileError> {
        let length = body.length(length, kind)?;
        if length < 3 {
            let noun = if length == 1 { "vertex" } else { "vertices" };
            let text = || format!("a face with {length} {noun}, which needs 3 or more");
            let message = || Message::new(text(), "it is skipped");
            self.warnings.add(WarningKind::DegenerateFace, "", || (body.position(), message()));
            for _ in 0..length {
                body.scalar(kind)?;
            }
            return Ok(None);
        }
        self.budget.triangles(length - 2)?;
        let held = self.triangulator.begin(length, self.budget)?;
        for _ in 0..length {
            let index = body.scalar(kind)?;
            let vertex = self.vertex(index, body)?;
            self.triangulator.corner(vertex);
        }
        Ok(Some(held))
    }

    /// Reads triangle strips: lists of vertices, each but the last followed by -1. Every second triangle is turned.
    fn strip(&mut self, (length, kind): (Kind, Kind), body: &mut Body<'_>) -> Result<(), FileError> {
        let length = body.length(length, kind)?;
        self.budget.triangles(length.saturating_sub(2))?;
        let (mut first, mut second, mut is_turned) = (None, None, false);
        for _ in 0..length {
            let index = body.scalar(kind)?;
            if index == -1.0 {
                (first, second, is_turned) = (None, None, false);
                continue;
            }
            let vertex = self.vertex(index, body)?;
            if let (Some(first), Some(second)) = (first, second) {
                self.object.triangles.push(if is_turned { [second, first, vertex] } else { [first, second, vertex] });
                is_turned = !is_turned;
            }
            (first, second) = (second, Some(vertex));
        }
        Ok(())
    }

    fn vertex(&self, index: f64, body: &Body<'_>) -> Result<u32, FileError> {
        if index.fract() != 0.0 || index < 0.0 || index >= self.count as f64 {
            return Err(body.error(format!("no vertex {index}: the file has {}, counted from 0", self.count)));
        }
        Ok(index as u32)
    }

    /// Replaces the corners of the face by copies with this colour.
    fn recolor(&mut self, color: [f32; 4]) -> Result<(), FileError> {
        let Faces { object, budget, known, attributes, .. } = self;
        let bits = color.map(f32::to_bits);
        self.triangulator.replace(|vertex| {
            if let Some(copy) = known.get(&(vertex, bits)) {
                return Ok(*copy);
            }
            budget.vertices(object, 1)?;
            budget.take(1, KNOWN, "the index of the scene's vertices")?;
            let position = object.positions.get(vertex as usize).copied().unwrap_or_default();
            let normal = object.normals.get(vertex as usize).copied().unwrap_or_default();
            let copy = object.vertex(position, normal, color);
            for (words, request) in object.attributes.iter_mut().zip(*attributes) {
                let first = vertex as usize * request.components;
                words.extend_from_within(first..first + request.components);
            }
            known.insert((vertex, bits), copy);
            Ok(copy)
        })
    }
}
