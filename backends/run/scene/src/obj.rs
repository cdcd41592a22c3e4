//! Wavefront OBJ: `v` (with a colour and alpha, if present), `vn`, `f`, `o` and `g`, `mtllib` and `usemtl`.
//!
//! The reader is our own because every error needs its line: `tobj` reports no lines, ignores unknown statements and materials,
//! and panics on a short `Kd`. Curves, surfaces and display statements are ignored; an unknown statement is an error.

use std::collections::{HashMap, HashSet};

use crate::error::{Error, FileError};
use crate::limits::{Budget, OBJECT};
use crate::materials::{Materials, single_spaces};
use crate::polygon::Triangulator;
use crate::text::{lines, numbers, quoted};
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

/// A function from the name of a library in the model to its file name and bytes.
type Library<'a> = dyn Fn(&str) -> Result<(String, Vec<u8>), Error> + 'a;

/// The bytes of a `v` or a `vn` in the lists of the reader, at most.
const LISTED: u64 = 12 + 20;

/// The bytes of an entry of [`Reader::known`].
const KNOWN: u64 = 64;

/// Reads a model. `library` returns a material library by its name in the model; `color` is the colour of vertices without
/// one.
pub(crate) fn parse(
    bytes: &[u8],
    file: &str,
    color: [f32; 4],
    library: &Library<'_>,
    budget: &Budget,
) -> Result<Scene, Error> {
    let mut reader = Reader::new(color, budget);
    // A library that the model names twice is read once.
    let mut libraries: HashSet<String> = HashSet::new();
    for statement in lines(bytes) {
        let (line, statement) = statement.map_err(|error| error.in_file(file))?;
        let (keyword, rest) = statement.split_once(char::is_whitespace).unwrap_or((&statement, ""));
        if keyword == "mtllib" {
            if libraries.insert(rest.trim().to_owned()) {
                let (name, bytes) = library(rest.trim())?;
                reader.materials.add(&bytes, budget).map_err(|error| error.in_file(&name))?;
            }
            continue;
        }
        reader.statement(keyword, rest, line).map_err(|error| error.in_file(file))?;
    }
    Ok(reader.finish())
}

struct Reader<'a> {
    budget: &'a Budget,
    positions: Vec<[f32; 3]>,
    /// Per position, if the model gives one.
    colors: Vec<Option<[f32; 4]>>,
    normals: Vec<[f32; 3]>,
    materials: Materials,
    material: Option<usize>,
    color: [f32; 4],
    scene: Scene,
    object: Object,
    triangulator: Triangulator,
    /// The vertices of the object, by position, normal and material.
    known: HashMap<(usize, Option<usize>, Option<usize>), u32>,
}

impl<'a> Reader<'a> {
    fn new(color: [f32; 4], budget: &'a Budget) -> Self {
        Reader {
            budget,
            positions: Vec::new(),
            colors: Vec::new(),
            normals: Vec::new(),
            materials: Materials::default(),
            material: None,
            color,
            scene: Scene::default(),
            object: Object::default(),
            triangulator: Triangulator::new(),
            known: HashMap::new(),
        }
    }

    fn statement(&mut self, keyword: &str, words: &str, line: usize) -> Result<(), FileError> {
        match keyword {
            "v" => {
                let ([x, y, z, r, g, b, a], count) = numbers(words, &[3, 4, 6, 7], line)?;
                self.budget.take(1, LISTED, "the list of positions")?;
                self.positions.push([x, y, z]);
                // A single number after the position is its weight in curves, which are ignored.
                let alpha = if count == 7 { a } else { 1.0 };
                self.colors.push((count >= 6).then_some([r, g, b, alpha]));
            }
            "vn" => {
                self.budget.take(1, LISTED, "the list of normals")?;
                self.normals.push(numbers(words, &[3], line)?.0);
            }
            "f" | "fo" => self.face(words, line)?,
            "o" | "g" => {
                self.end_object();
                self.object.name = single_spaces(words);
            }
            "usemtl" => self.material = Some(self.materials.find(words, line)?),
            _ if IGNORED.contains(&keyword) => {}
            _ => return Err(FileError::line(line, format!("unknown statement {}", quoted(keyword)))),
        }
        Ok(())
    }

    fn face(&mut self, words: &str, line: usize) -> Result<(), FileError> {
        let count = words.split_whitespace().count();
        if count < 3 {
            return Err(FileError::line(line, format!("a face with {count} vertices: it needs 3 or more")));
        }
        if self.object.triangles.is_empty() {
            self.budget.take(1, OBJECT + self.object.name.len() as u64, "the scene's objects")?;
        }
        self.budget.triangles(count as u64 - 2)?;
        let _corners = self.triangulator.begin(count as u64, self.budget)?;
        for word in words.split_whitespace() {
            let vertex = self.corner(word, line)?;
            self.triangulator.corner(vertex);
        }
        self.triangulator.end(&mut self.object).map_err(|message| FileError::line(line, message))
    }

    /// Returns the vertex of a corner, `position/texture/normal`.
    fn corner(&mut self, word: &str, line: usize) -> Result<u32, FileError> {
        let mut parts = word.split('/');
        let position = index(parts.next().unwrap_or(""), self.positions.len(), "position", line)?;
        // Texture coordinates are checked, but not kept.
        if let Some(texture) = parts.next().filter(|part| !part.is_empty()) {
            texture
                .parse::<i64>()
                .map_err(|_| FileError::line(line, format!("{} is not an index", quoted(texture))))?;
        }
        let normal = parts
            .next()
            .filter(|part| !part.is_empty())
            .map(|part| index(part, self.normals.len(), "normal", line))
            .transpose()?;
        if parts.next().is_some() {
            return Err(FileError::line(line, format!("{} has more than position/texture/normal", quoted(word))));
        }
        self.vertex(position, normal)
    }

    fn vertex(&mut self, position: usize, normal: Option<usize>) -> Result<u32, FileError> {
        let key = (position, normal, self.material);
        if let Some(known) = self.known.get(&key) {
            return Ok(*known);
        }
        self.budget.vertices(&self.object, 1)?;
        self.budget.take(1, KNOWN, "the index of the scene's vertices")?;
        let color = self.color_of(position);
        let at = self.positions.get(position).copied().unwrap_or_default();
        let normal = normal.and_then(|normal| self.normals.get(normal).copied()).unwrap_or_default();
        let vertex = self.object.vertex(at, normal, color);
        self.known.insert(key, vertex);
        Ok(vertex)
    }

    /// Returns the colour of the material, else that of the vertex, else the default.
    fn color_of(&self, position: usize) -> [f32; 4] {
        let [r, g, b, a] = self.color;
        let material = self.material.and_then(|index| self.materials.get(index));
        let vertex_color = self.colors.get(position).copied().flatten();
        let [r, g, b, a] = vertex_color.unwrap_or([r, g, b, a]);
        let [r, g, b] = material.and_then(|material| material.color).unwrap_or([r, g, b]);
        [r, g, b, material.map_or(a, |material| material.alpha)]
    }

    fn end_object(&mut self) {
        self.budget.give_back(self.known.len() as u64 * KNOWN);
        // A new map, because clearing a large one takes as long as its capacity.
        self.known = HashMap::new();
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

/// Converts an index from 1, or from -1 backwards, to one from 0.
fn index(word: &str, count: usize, of: &str, line: usize) -> Result<usize, FileError> {
    let number: i64 =
        word.parse().map_err(|_| FileError::line(line, format!("{} is not an index of a {of}", quoted(word))))?;
    let from_zero = if number < 0 { (count as i64).checked_add(number) } else { number.checked_sub(1) };
    match from_zero.map(usize::try_from) {
        Some(Ok(index)) if index < count => Ok(index),
        _ => Err(FileError::line(line, format!("no {of} {number}: {count} are defined so far"))),
    }
}
