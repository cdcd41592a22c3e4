//! Wavefront OBJ: `v` (with colours, if present), `vn`, `f`, `o` and `g`, `mtllib` and `usemtl`. Polygons become fans.
//!
//! The reader is our own because every error needs its line: `tobj` reports no lines, ignores unknown statements and materials,
//! and panics on a short `Kd`. Curves, surfaces and display statements are ignored; an unknown statement is an error.

use std::collections::HashMap;

use crate::error::{Error, FileError};
use crate::materials::{self, Material};
use crate::text::{lines, numbers};
use crate::{Object, Scene};

/// Statements without effect on the triangles.
const IGNORED: [&str; 37] = [
    "vt",
    "vp",
    "s",
    "l",
    "p",
    "mg",
    "cstype",
    "deg",
    "bmat",
    "step",
    "curv",
    "curv2",
    "surf",
    "parm",
    "trim",
    "hole",
    "scrv",
    "sp",
    "end",
    "con",
    "bevel",
    "c_interp",
    "d_interp",
    "lod",
    "maplib",
    "usemap",
    "shadow_obj",
    "trace_obj",
    "ctech",
    "stech",
    "call",
    "csh",
    "res",
    "bsp",
    "bzp",
    "cdc",
    "cdp",
];

/// A function from the name of a library in the model to its file name and text.
type Library<'a> = dyn Fn(&str) -> Result<(String, String), Error> + 'a;

/// Reads a model. `library` returns a material library by its name in the model; `color` is the colour of vertices without
/// one.
pub(crate) fn parse(text: &str, file: &str, color: [f32; 4], library: &Library<'_>) -> Result<Scene, Error> {
    let mut reader = Reader { color, ..Reader::default() };
    for (line, statement) in lines(text) {
        let (keyword, rest) = statement.split_once(char::is_whitespace).unwrap_or((&statement, ""));
        if keyword == "mtllib" {
            let (name, text) = library(rest.trim())?;
            reader.materials.extend(materials::parse(&text).map_err(|error| error.in_file(&name))?);
            continue;
        }
        let words: Vec<&str> = rest.split_whitespace().collect();
        reader.statement(keyword, &words, line).map_err(|error| error.in_file(file))?;
    }
    Ok(reader.finish())
}

#[derive(Default)]
struct Reader {
    positions: Vec<[f32; 3]>,
    /// Per position, if the model gives one.
    colors: Vec<Option<[f32; 3]>>,
    normals: Vec<[f32; 3]>,
    materials: Vec<Material>,
    material: Option<usize>,
    color: [f32; 4],
    scene: Scene,
    object: Object,
    /// The vertices of the object, by position, normal and material.
    known: HashMap<(usize, Option<usize>, Option<usize>), u32>,
}

impl Reader {
    fn statement(&mut self, keyword: &str, words: &[&str], line: usize) -> Result<(), FileError> {
        match keyword {
            "v" => {
                let values = numbers(words, &[3, 4, 6, 7], line)?;
                let (position, color) = values.split_at(3);
                self.positions.push(to_array(position));
                self.colors.push((color.len() >= 3).then(|| to_array(color)));
            }
            "vn" => self.normals.push(to_array(&numbers(words, &[3], line)?)),
            "f" | "fo" => self.face(words, line)?,
            "o" | "g" => {
                self.end_object();
                self.object.name = words.join(" ");
            }
            "usemtl" => {
                let name = words.join(" ");
                let found = self.materials.iter().rposition(|material| material.name == name);
                self.material = Some(found.ok_or_else(|| self.unknown_material(&name, line))?);
            }
            _ if IGNORED.contains(&keyword) => {}
            _ => return Err(FileError::line(line, format!("unknown statement `{keyword}`"))),
        }
        Ok(())
    }

    fn unknown_material(&self, name: &str, line: usize) -> FileError {
        let names: Vec<&str> = self.materials.iter().map(|material| material.name.as_str()).collect();
        let available = if names.is_empty() {
            "no `mtllib` defines any".to_owned()
        } else {
            format!("the materials are {}", names.join(", "))
        };
        FileError::line(line, format!("unknown material `{name}`: {available}"))
    }

    fn face(&mut self, words: &[&str], line: usize) -> Result<(), FileError> {
        if words.len() < 3 {
            return Err(FileError::line(line, format!("a face with {} vertices: it needs 3 or more", words.len())));
        }
        let mut corners = Vec::with_capacity(words.len());
        for word in words {
            let mut parts = word.split('/');
            let position = index(parts.next().unwrap_or(""), self.positions.len(), "position", line)?;
            // Texture coordinates are checked, but not kept.
            if let Some(texture) = parts.next().filter(|part| !part.is_empty()) {
                texture.parse::<i64>().map_err(|_| FileError::line(line, format!("`{texture}` is not an index")))?;
            }
            let normal = parts.next().map(|part| index(part, self.normals.len(), "normal", line)).transpose()?;
            if parts.next().is_some() {
                return Err(FileError::line(line, format!("`{word}` has more than position/texture/normal")));
            }
            corners.push(self.corner(position, normal));
        }
        self.object.polygon(&corners);
        Ok(())
    }

    fn corner(&mut self, position: usize, normal: Option<usize>) -> u32 {
        let key = (position, normal, self.material);
        if let Some(known) = self.known.get(&key) {
            return *known;
        }
        let color = self.color_of(position);
        let at = self.positions.get(position).copied().unwrap_or_default();
        let normal = normal.and_then(|normal| self.normals.get(normal).copied()).unwrap_or_default();
        let vertex = self.object.vertex(at, normal, color);
        self.known.insert(key, vertex);
        vertex
    }

    /// Returns the colour of the material, else that of the vertex, else the default.
    fn color_of(&self, position: usize) -> [f32; 4] {
        let [r, g, b, a] = self.color;
        let material = self.material.and_then(|index| self.materials.get(index));
        let vertex_color = self.colors.get(position).copied().flatten();
        let [r, g, b] = material.and_then(|material| material.color).or(vertex_color).unwrap_or([r, g, b]);
        let opaque_or_default = if vertex_color.is_some() { 1.0 } else { a };
        [r, g, b, material.map_or(opaque_or_default, |material| material.alpha)]
    }

    fn end_object(&mut self) {
        self.known.clear();
        let object = std::mem::take(&mut self.object);
        if !object.triangles.is_empty() {
            self.scene.objects.push(object);
        }
    }

    fn finish(mut self) -> Scene {
        self.end_object();
        self.scene
    }
}

fn to_array(values: &[f32]) -> [f32; 3] {
    std::array::from_fn(|axis| values.get(axis).copied().unwrap_or(0.0))
}

/// Converts an index from 1, or from -1 backwards, to one from 0.
fn index(word: &str, count: usize, of: &str, line: usize) -> Result<usize, FileError> {
    let number: i64 = word.parse().map_err(|_| FileError::line(line, format!("`{word}` is not an index of a {of}")))?;
    let from_zero = if number < 0 { count as i64 + number } else { number - 1 };
    match usize::try_from(from_zero) {
        Ok(index) if index < count => Ok(index),
        _ => Err(FileError::line(line, format!("no {of} {number}: {count} are defined so far"))),
    }
}
