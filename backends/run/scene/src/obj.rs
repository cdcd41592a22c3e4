//! Wavefront OBJ: `v` (with colours, where there are), `vn`, `f`, `o` and `g`, `mtllib` and `usemtl`. Polygons become fans.
//!
//! Written out here because every mistake must have its line; curves, surfaces and display statements are passed over,
//! and a statement that the format does not have is an error.

use std::collections::HashMap;

use crate::error::{Error, Fault};
use crate::materials::{self, Material};
use crate::text::{lines, numbers};
use crate::{Object, Scene};

/// Statements that change nothing that is drawn here.
const PASSED_OVER: [&str; 37] = [
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

/// The name of a library's file and its text, by the name that the model calls it.
type Library<'a> = dyn Fn(&str) -> Result<(String, String), Error> + 'a;

/// Reads a model. `library` gives the text of a material library by the name that the model calls it; `color` is the colour
/// of what has no material.
pub(crate) fn parse(text: &str, file: &str, color: [f32; 4], library: &Library<'_>) -> Result<Scene, Error> {
    let mut reader = Reader { color, ..Reader::default() };
    for (line, statement) in lines(text) {
        let (keyword, rest) = statement.split_once(char::is_whitespace).unwrap_or((&statement, ""));
        if keyword == "mtllib" {
            let (name, text) = library(rest.trim())?;
            reader.materials.extend(materials::parse(&text).map_err(|fault| fault.of(&name))?);
            continue;
        }
        let words: Vec<&str> = rest.split_whitespace().collect();
        reader.statement(keyword, &words, line).map_err(|fault| fault.of(file))?;
    }
    Ok(reader.finish())
}

#[derive(Default)]
struct Reader {
    positions: Vec<[f32; 3]>,
    /// Per position, where the model gives one.
    colors: Vec<Option<[f32; 3]>>,
    normals: Vec<[f32; 3]>,
    materials: Vec<Material>,
    material: Option<usize>,
    color: [f32; 4],
    scene: Scene,
    object: Object,
    /// Vertices of the object: position, normal, material.
    known: HashMap<(usize, Option<usize>, Option<usize>), u32>,
}

impl Reader {
    fn statement(&mut self, keyword: &str, words: &[&str], line: usize) -> Result<(), Fault> {
        match keyword {
            "v" => {
                let values = numbers(words, &[3, 4, 6, 7], line)?;
                let (position, color) = values.split_at(3);
                self.positions.push(three(position));
                self.colors.push((color.len() >= 3).then(|| three(color)));
            }
            "vn" => self.normals.push(three(&numbers(words, &[3], line)?)),
            "f" | "fo" => self.face(words, line)?,
            "o" | "g" => {
                self.end_object();
                self.object.name = words.join(" ");
            }
            "usemtl" => {
                let name = words.join(" ");
                let found = self.materials.iter().rposition(|material| material.name == name);
                self.material = Some(found.ok_or_else(|| self.no_material(&name, line))?);
            }
            _ if PASSED_OVER.contains(&keyword) => {}
            _ => return Err(Fault::line(line, format!("`{keyword}` is no statement of this format"))),
        }
        Ok(())
    }

    fn no_material(&self, name: &str, line: usize) -> Fault {
        let names: Vec<&str> = self.materials.iter().map(|material| material.name.as_str()).collect();
        let there = if names.is_empty() {
            "no `mtllib` gave any".to_owned()
        } else {
            format!("there are {}", names.join(", "))
        };
        Fault::line(line, format!("no material `{name}`: {there}"))
    }

    fn face(&mut self, words: &[&str], line: usize) -> Result<(), Fault> {
        if words.len() < 3 {
            return Err(Fault::line(line, format!("a face of {} vertices: it needs 3 or more", words.len())));
        }
        let mut corners = Vec::with_capacity(words.len());
        for word in words {
            let mut parts = word.split('/');
            let position = index(parts.next().unwrap_or(""), self.positions.len(), "position", line)?;
            // Texture coordinates are not kept; that they are numbers is still checked.
            if let Some(texture) = parts.next().filter(|part| !part.is_empty()) {
                texture.parse::<i64>().map_err(|_| Fault::line(line, format!("`{texture}` is no index")))?;
            }
            let normal = parts.next().map(|part| index(part, self.normals.len(), "normal", line)).transpose()?;
            if parts.next().is_some() {
                return Err(Fault::line(line, format!("`{word}` has more than position/texture/normal")));
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

    /// The material's colour; else the vertex's; else that of what has none.
    fn color_of(&self, position: usize) -> [f32; 4] {
        let [r, g, b, a] = self.color;
        let material = self.material.and_then(|index| self.materials.get(index));
        let own = self.colors.get(position).copied().flatten();
        let [r, g, b] = material.and_then(|material| material.color).or(own).unwrap_or([r, g, b]);
        let opaque_or_default = if own.is_some() { 1.0 } else { a };
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

fn three(values: &[f32]) -> [f32; 3] {
    std::array::from_fn(|axis| values.get(axis).copied().unwrap_or(0.0))
}

/// From 1, or from -1 backwards, to from 0.
fn index(word: &str, count: usize, of: &str, line: usize) -> Result<usize, Fault> {
    let number: i64 = word.parse().map_err(|_| Fault::line(line, format!("`{word}` is no index of a {of}")))?;
    let from_zero = if number < 0 { count as i64 + number } else { number - 1 };
    match usize::try_from(from_zero) {
        Ok(index) if index < count => Ok(index),
        _ => Err(Fault::line(line, format!("no {of} {number}: there are {count} so far"))),
    }
}
