//! MTL: the diffuse colour `Kd` and the opacity `d` (or `Tr`, its complement) of materials, by name. Textures and all other
//! statements are ignored.

use std::collections::HashMap;

use crate::error::FileError;
use crate::limits::Budget;
use crate::text::{lines, numbers, quoted, without_comment};

/// A material.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Material {
    /// Linear, straight alpha; `None` if the file gives none.
    pub(crate) color: Option<[f32; 3]>,
    pub(crate) alpha: f32,
}

/// The materials of all libraries of a model. A material replaces an earlier one of the same name.
///
/// A `#` in a name may be part of it or begin a comment. A whole name has precedence over the part before the `#`.
#[derive(Default)]
pub(crate) struct Materials {
    materials: Vec<Material>,
    by_name: HashMap<String, usize>,
    /// By the part of the name before a `#`.
    by_short_name: HashMap<String, usize>,
}

/// The bytes of a material without its name: its list entry and its map entry.
const MATERIAL: u64 = 96;

/// The greatest number of names that a message lists.
const MAX_LISTED: usize = 10;

impl Materials {
    /// Adds the materials of a library.
    pub(crate) fn add(&mut self, library: &[u8], budget: &Budget) -> Result<(), FileError> {
        let mut is_first = true;
        for statement in lines(library) {
            let (line, statement) = statement?;
            let (keyword, values) = statement.split_once(char::is_whitespace).unwrap_or((&statement, ""));
            if keyword == "newmtl" {
                is_first = false;
                self.begin(values, line, budget)?;
                continue;
            }
            let Some(material) = self.materials.last_mut().filter(|_| !is_first) else {
                return Err(FileError::line(line, format!("{} before the first `newmtl`", quoted(keyword))));
            };
            match keyword {
                "Kd" => material.color = Some(color(values, line)?),
                "d" => {
                    let (option, value) = values.trim_start().split_once(char::is_whitespace).unwrap_or_default();
                    material.alpha = unit_number(if option == "-halo" { value } else { values }, line)?;
                }
                "Tr" => material.alpha = 1.0 - unit_number(values, line)?,
                _ => {}
            }
        }
        Ok(())
    }

    fn begin(&mut self, name: &str, line: usize, budget: &Budget) -> Result<(), FileError> {
        let name = single_spaces(name);
        if name.is_empty() {
            return Err(FileError::line(line, "`newmtl` without a name"));
        }
        budget.take(1, MATERIAL + name.len() as u64, "the materials")?;
        let short = single_spaces(without_comment(&name));
        if short != name && !short.is_empty() {
            budget.take(1, MATERIAL + short.len() as u64, "the materials")?;
            self.by_short_name.insert(short, self.materials.len());
        }
        self.by_name.insert(name, self.materials.len());
        self.materials.push(Material { color: None, alpha: 1.0 });
        Ok(())
    }

    /// Returns the index of the material `name`.
    pub(crate) fn find(&self, name: &str, line: usize) -> Result<usize, FileError> {
        let name = single_spaces(name);
        let short = single_spaces(without_comment(&name));
        let candidates = [(&self.by_name, &name), (&self.by_name, &short), (&self.by_short_name, &short)];
        let found = candidates.iter().find_map(|(materials, name)| materials.get(*name));
        let unknown = || format!("unknown material {}: {}", quoted(&name), self.available());
        found.copied().ok_or_else(|| FileError::line(line, unknown()))
    }

    /// Returns a list of some materials for a message.
    fn available(&self) -> String {
        let mut names: Vec<&str> = self.by_name.keys().map(String::as_str).collect();
        names.sort_unstable();
        let more = names.len().saturating_sub(MAX_LISTED);
        let listed: Vec<String> = names.into_iter().take(MAX_LISTED).map(quoted).collect();
        match (listed.is_empty(), more) {
            (true, _) => "no `mtllib` defines any".to_owned(),
            (_, 0) => format!("the materials are {}", listed.join(", ")),
            _ => format!("the materials are {} and {more} more", listed.join(", ")),
        }
    }

    pub(crate) fn get(&self, index: usize) -> Option<&Material> {
        self.materials.get(index)
    }
}

/// Returns a name with single spaces between its words.
pub(crate) fn single_spaces(name: &str) -> String {
    name.split_whitespace().collect::<Vec<_>>().join(" ")
}

fn color(words: &str, line: usize) -> Result<[f32; 3], FileError> {
    if let Some(kind @ ("spectral" | "xyz")) = words.split_whitespace().next() {
        return Err(FileError::line(line, format!("`Kd {kind}` is not supported: give red, green and blue")));
    }
    let (values, count) = numbers::<3>(words, &[1, 3], line)?;
    // The format defines a single number as grey.
    let color = if count == 1 { [values[0]; 3] } else { values };
    match color.iter().find(|value| !(0.0..=1.0).contains(*value)) {
        Some(value) => Err(FileError::line(line, format!("{value} is not from 0 to 1"))),
        None => Ok(color),
    }
}

fn unit_number(words: &str, line: usize) -> Result<f32, FileError> {
    let ([value], _) = numbers(words, &[1], line)?;
    if (0.0..=1.0).contains(&value) {
        Ok(value)
    } else {
        Err(FileError::line(line, format!("{value} is not from 0 to 1")))
    }
}
