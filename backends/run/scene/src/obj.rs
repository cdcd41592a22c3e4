//! Wavefront OBJ: `v` (with a colour and alpha, if present), `vn`, `f`, `o` and `g`, `mtllib` and `usemtl`.
//!
//! The reader is our own because every error needs its line: `tobj` reports no lines, ignores unknown statements and materials,
//! and panics on a short `Kd`. The lines are read twice: first vertices and libraries, then faces, because a face may name a vertex or
//! a material that a later line defines.

use std::collections::{HashMap, HashSet};

use crate::color_range::ColorRange;
use crate::error::{Error, FileError, FilePosition};
use crate::limits::{Budget, OBJECT};
use crate::materials::{Material, Materials, single_spaces};
use crate::model::{ModelObject, normal};
use crate::polygon::Triangulator;
use crate::text::{lines, number, numbers, quoted};
use crate::warnings::{FileWarnings, Message, WarningKind, Warnings};

/// Statements without effect on the triangles.
const IGNORED: [&str; 20] = [
    "vt",
    "vp",
    "s",
    "mg",
    "deg",
    "bmat",
    "step",
    "parm",
    "con",
    "end",
    "bevel",
    "c_interp",
    "d_interp",
    "lod",
    "shadow_obj",
    "trace_obj",
    "ctech",
    "stech",
    "csh",
    "res",
];

/// Statements of what is not read.
const NOT_READ: [(&[&str], &str); 4] = [
    (&["maplib", "usemap"], "textures are not read"),
    (&["l", "p"], "lines and points are not read"),
    (
        &["cstype", "curv", "curv2", "surf", "trim", "hole", "scrv", "sp", "bsp", "bzp", "cdc", "cdp"],
        "curves and surfaces are not read",
    ),
    (&["call"], "files of `call` are not read"),
];

/// A function from the libraries that a line names to their file names and bytes.
type Libraries<'a> = dyn Fn(&str, usize) -> Result<Vec<(String, Vec<u8>)>, Error> + 'a;

/// A model, and the function that reads its libraries.
pub(crate) struct Model<'a> {
    pub(crate) bytes: &'a [u8],
    pub(crate) file: &'a str,
    pub(crate) libraries: &'a Libraries<'a>,
    pub(crate) warnings: &'a Warnings,
}

/// The greatest number of different `mtllib` statements.
const MAX_LIBRARIES: usize = 256;

/// The bytes of a `v` or a `vn` in the lists of the reader, at most.
const LISTED: u64 = 24 + 20;

/// The bytes of an entry of [`Reader::known`].
const KNOWN: u64 = 64;

/// Reads a model. `color` is the colour of vertices without one.
pub(crate) fn parse(model: &Model<'_>, color: [f32; 4], budget: &Budget) -> Result<Vec<ModelObject>, Error> {
    let mut reader = Reader::new(color, model.warnings.in_file(model.file), budget);
    // A library that the model names twice is read once.
    let mut libraries: HashSet<String> = HashSet::new();
    for statement in lines(model.bytes) {
        let (line, statement) = statement.map_err(|error| error.in_file(model.file))?;
        let (keyword, words) = statement.split_once(char::is_whitespace).unwrap_or((&statement, ""));
        if keyword != "mtllib" {
            reader.define(keyword, words, line).map_err(|error| error.in_file(model.file))?;
        } else if libraries.insert(words.trim().to_owned()) {
            if libraries.len() > MAX_LIBRARIES {
                let message = format!("more than {MAX_LIBRARIES} different `mtllib`");
                return Err(FileError::line(line, message).in_file(model.file));
            }
            for (name, bytes) in (model.libraries)(words.trim(), line)? {
                let added = reader.materials.add(&bytes, model.warnings.in_file(&name), budget);
                added.map_err(|error| error.in_file(&name))?;
            }
        }
    }
    reader.color_range.apply(reader.colors.iter_mut().flatten(), reader.warnings);
    for statement in lines(model.bytes) {
        let added = statement.and_then(|(line, statement)| {
            let (keyword, words) = statement.split_once(char::is_whitespace).unwrap_or((&statement, ""));
            reader.statement(keyword, words, line)
        });
        added.map_err(|error| error.in_file(model.file))?;
    }
    Ok(reader.finish())
}

struct Reader<'a> {
    budget: &'a Budget,
    warnings: FileWarnings<'a>,
    positions: Vec<[f64; 3]>,
    /// Per position, if the model gives one.
    colors: Vec<Option<[f32; 4]>>,
    color_range: ColorRange,
    /// Zero: the normal is computed.
    normals: Vec<[f32; 3]>,
    /// The numbers of positions and normals in the lines so far, for indices that count backwards.
    defined: (usize, usize),
    materials: Materials,
    material: Option<usize>,
    color: [f32; 4],
    objects: Vec<ModelObject>,
    object: ModelObject,
    triangulator: Triangulator,
    /// The vertices of the object, by position, normal and material.
    known: HashMap<(usize, Option<usize>, Option<usize>), u32>,
}

impl<'a> Reader<'a> {
    fn new(color: [f32; 4], warnings: FileWarnings<'a>, budget: &'a Budget) -> Self {
        Reader {
            budget,
            warnings,
            positions: Vec::new(),
            colors: Vec::new(),
            color_range: ColorRange::default(),
            normals: Vec::new(),
            defined: (0, 0),
            materials: Materials::default(),
            material: None,
            color,
            objects: Vec::new(),
            object: ModelObject::default(),
            triangulator: Triangulator::new(),
            known: HashMap::new(),
        }
    }

    /// Reads a vertex. Other statements have no effect.
    fn define(&mut self, keyword: &str, words: &str, line: usize) -> Result<(), FileError> {
        match keyword {
            "v" => {
                let ([x, y, z, r, g, b, a], count) = numbers(words, &[3, 4, 6, 7], line)?;
                self.budget.take(1, LISTED, "the list of positions")?;
                self.positions.push([x, y, z]);
                // A single number after the position is its weight in curves, which are not read.
                let alpha = if count == 7 { a } else { 1.0 };
                let color = (count >= 6).then(|| self.color_range.add([r, g, b, alpha], FilePosition::Line(line)));
                self.colors.push(color);
            }
            "vn" => {
                self.budget.take(1, LISTED, "the list of normals")?;
                self.normals.push(self.normal(words, line));
            }
            _ => {}
        }
        Ok(())
    }

    /// Returns a normal; zero if it is not three finite numbers, which a tool writes as `nan` or `-1.#IND` for a face without area.
    fn normal(&self, words: &str, line: usize) -> [f32; 3] {
        let mut values = words.split_whitespace().map(|word| number(word, line).ok());
        let mut next = || values.next().flatten();
        let found = match (next(), next(), next()) {
            (Some(x), Some(y), Some(z)) => normal([x, y, z]),
            _ => None,
        };
        found.unwrap_or_else(|| {
            let text = || format!("a normal {} is not three finite numbers", quoted(words.trim()));
            let message = || Message::new(text(), "it is computed");
            self.warnings.line(WarningKind::InvalidNormal, "vn", line, message);
            [0.0; 3]
        })
    }

    fn statement(&mut self, keyword: &str, words: &str, line: usize) -> Result<(), FileError> {
        match keyword {
            "v" => self.defined.0 += 1,
            "vn" => self.defined.1 += 1,
            "f" | "fo" => self.face(words, line)?,
            "o" | "g" => {
                self.end_object();
                self.object.name = single_spaces(words);
            }
            "usemtl" => self.use_material(words, line),
            "mtllib" => {}
            _ if IGNORED.contains(&keyword) => {}
            _ => match NOT_READ.iter().find(|(keywords, _)| keywords.contains(&keyword)) {
                Some((_, message)) => {
                    self.warnings.line(WarningKind::NotRead, message, line, || (*message).to_owned());
                }
                None => self.warnings.line(WarningKind::UnknownStatement, keyword, line, || {
                    format!("unknown statement {}", quoted(keyword))
                }),
            },
        }
        Ok(())
    }

    fn use_material(&mut self, name: &str, line: usize) {
        self.material = self.materials.find(name);
        if self.material.is_none() {
            // The message lists materials, so it is made for the first only.
            let message = || Message::new(self.materials.unknown(name), "the default colour is used");
            self.warnings.line(WarningKind::MissingMaterial, "", line, message);
        }
        let material = self.material.and_then(|index| self.materials.get(index));
        if material.is_some_and(Material::is_doubtful) {
            self.warnings.line(WarningKind::Invisible, &single_spaces(name), line, || {
                let name = quoted(name.trim());
                format!(
                    "material {name} is invisible by `Tr 1`, which some tools write for opaque materials: give it a `d`"
                )
            });
        }
    }

    fn face(&mut self, words: &str, line: usize) -> Result<(), FileError> {
        let count = words.split_whitespace().count();
        if count < 3 {
            let noun = if count == 1 { "vertex" } else { "vertices" };
            let text = || format!("a face with {count} {noun}, which needs 3 or more");
            let message = || Message::new(text(), "it is skipped");
            self.warnings.line(WarningKind::DegenerateFace, "", line, message);
            return Ok(());
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
        let number = index_number(parts.next().unwrap_or(""), "position", line)?;
        let count = self.positions.len();
        let position = index(number, (self.defined.0, count))
            .ok_or_else(|| FileError::line(line, format!("no position {number}: the file has {count}")))?;
        // Texture coordinates are checked, but not kept.
        if let Some(texture) = parts.next().filter(|part| !part.is_empty()) {
            index_number(texture, "texture coordinate", line)?;
        }
        let normal = parts.next().filter(|part| !part.is_empty());
        let normal = normal.map(|part| index_number(part, "normal", line)).transpose()?;
        if parts.next().is_some() {
            return Err(FileError::line(line, format!("{} has more than position/texture/normal", quoted(word))));
        }
        let normal = normal.and_then(|number| {
            let found = index(number, (self.defined.1, self.normals.len()));
            if found.is_none() {
                let text = || format!("no normal {number}: the file has {}", self.normals.len());
                let message = || Message::new(text(), "it is computed");
                self.warnings.line(WarningKind::InvalidNormal, "f", line, message);
            }
            found
        });
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
            self.objects.push(object);
        }
    }

    fn finish(mut self) -> Vec<ModelObject> {
        self.end_object();
        self.objects
    }
}

fn index_number(word: &str, of: &str, line: usize) -> Result<i64, FileError> {
    word.parse().map_err(|_| FileError::line(line, format!("{} is not an index of a {of}", quoted(word))))
}

/// Converts an index from 1, or from -1 backwards from those `defined` so far, to one from 0. `None`: there is none of `count`.
fn index(number: i64, (defined, count): (usize, usize)) -> Option<usize> {
    let from_zero = if number < 0 { (defined as i64).checked_add(number) } else { number.checked_sub(1) };
    from_zero.and_then(|index| usize::try_from(index).ok()).filter(|index| *index < count)
}
