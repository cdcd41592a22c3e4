//! MTL: the diffuse colour `Kd` and the opacity `d` (or `Tr`, its complement) of materials, by name. All other statements are ignored;
//! textures of the colour and the opacity are a warning.

use std::collections::HashMap;

use crate::error::FileError;
use crate::limits::Budget;
use crate::text::{counted, lines, number, quoted, without_comment};
use crate::warnings::{FileWarnings, Message, WarningKind};

/// A material.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Material {
    /// Linear, straight alpha; `None` if the file gives none.
    pub(crate) color: Option<[f32; 3]>,
    /// From `d`, or else from `Tr`.
    pub(crate) alpha: f32,
    has_opacity: bool,
}

impl Material {
    const DEFAULT: Material = Material { color: None, alpha: 1.0, has_opacity: false };

    /// Whether `Tr` alone makes it invisible.
    pub(crate) fn is_doubtful(&self) -> bool {
        self.alpha == 0.0 && !self.has_opacity
    }
}

/// The statements of textures that change the colour or the opacity.
const TEXTURES: [&str; 4] = ["map_Kd", "map_d", "map_Tr", "map_opacity"];

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
    pub(crate) fn add(&mut self, library: &[u8], warnings: FileWarnings<'_>, budget: &Budget) -> Result<(), FileError> {
        let mut is_first = true;
        for statement in lines(library) {
            let (line, statement) = statement?;
            let (keyword, values) = statement.split_once(char::is_whitespace).unwrap_or((&statement, ""));
            if keyword == "newmtl" {
                is_first = false;
                self.begin(values, budget)?;
                continue;
            }
            let Some(material) = self.materials.last_mut().filter(|_| !is_first) else {
                warnings.line(WarningKind::UnknownStatement, "", line, || {
                    format!("{} before the first `newmtl` has no effect", quoted(keyword))
                });
                continue;
            };
            let values = Values { words: values, keyword, line, warnings };
            match keyword {
                "Kd" => material.color = values.color()?.or(material.color),
                "d" => {
                    (material.alpha, material.has_opacity) = (values.opacity()?, true);
                }
                "Tr" => {
                    let alpha = 1.0 - values.unit_number()?;
                    if !material.has_opacity {
                        material.alpha = alpha;
                    } else if (material.alpha - alpha).abs() > 1.0e-3 {
                        warnings.line(WarningKind::OutOfRange, "Tr", line, || {
                            Message::new("`Tr` contradicts `d`", format!("the opacity is {}", material.alpha))
                        });
                    }
                }
                _ if TEXTURES.contains(&keyword) => warnings.line(WarningKind::NotRead, keyword, line, || {
                    Message::new("textures are not read", format!("{} has no effect", quoted(keyword)))
                }),
                _ => {}
            }
        }
        Ok(())
    }

    /// Begins a material. Its name may be empty.
    fn begin(&mut self, name: &str, budget: &Budget) -> Result<(), FileError> {
        let name = single_spaces(name);
        budget.take(1, MATERIAL + name.len() as u64, "the materials")?;
        let short = single_spaces(without_comment(&name));
        if short != name && !short.is_empty() {
            budget.take(1, MATERIAL + short.len() as u64, "the materials")?;
            self.by_short_name.insert(short, self.materials.len());
        }
        self.by_name.insert(name, self.materials.len());
        self.materials.push(Material::DEFAULT);
        Ok(())
    }

    /// Returns the index of the material `name`.
    pub(crate) fn find(&self, name: &str) -> Option<usize> {
        let name = single_spaces(name);
        let short = single_spaces(without_comment(&name));
        let candidates = [(&self.by_name, &name), (&self.by_name, &short), (&self.by_short_name, &short)];
        let found = candidates.iter().find_map(|(materials, name)| materials.get(*name));
        found.copied()
    }

    /// Returns a message about a material that does not exist.
    pub(crate) fn unknown(&self, name: &str) -> String {
        format!("unknown material {}: {}", quoted(&single_spaces(name)), self.available())
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

/// The words after a keyword.
#[derive(Clone, Copy)]
struct Values<'a> {
    words: &'a str,
    keyword: &'a str,
    line: usize,
    warnings: FileWarnings<'a>,
}

impl Values<'_> {
    /// Returns a colour. `None`: it is not red, green and blue.
    fn color(self) -> Result<Option<[f32; 3]>, FileError> {
        if let Some(kind @ ("spectral" | "xyz")) = self.words.split_whitespace().next() {
            let message = || format!("`Kd {kind}` is not read: give red, green and blue");
            self.warnings.line(WarningKind::NotRead, "Kd", self.line, message);
            return Ok(None);
        }
        // The format defines a single number as grey.
        if self.words.split_whitespace().count() == 1 {
            let [grey] = self.numbers()?;
            return Ok(Some([grey; 3]));
        }
        self.numbers().map(Some)
    }

    fn opacity(self) -> Result<f32, FileError> {
        let (option, value) = self.words.trim_start().split_once(char::is_whitespace).unwrap_or_default();
        Values { words: if option == "-halo" { value } else { self.words }, ..self }.unit_number()
    }

    fn unit_number(self) -> Result<f32, FileError> {
        let [value] = self.numbers()?;
        Ok(value)
    }

    /// Returns the first `N` numbers. Further words are a warning; so are numbers that are not from 0 to 1.
    fn numbers<const N: usize>(self) -> Result<[f32; N], FileError> {
        let found = self.words.split_whitespace().count();
        if found < N {
            return Err(FileError::line(self.line, format!("expected {}, found {found}", counted(N, "number"))));
        }
        if found > N {
            let text = || format!("{} has {found} values, and takes {N}", quoted(self.keyword));
            let used = if N == 1 { "the first is used".to_owned() } else { format!("the first {N} are used") };
            let message = || Message::new(text(), used);
            self.warnings.line(WarningKind::OutOfRange, self.keyword, self.line, message);
        }
        let mut values = [0.0; N];
        for (value, word) in values.iter_mut().zip(self.words.split_whitespace()) {
            let exact = number(word, self.line)?;
            let clamped = exact.clamp(0.0, 1.0);
            // A tool that writes 1.000001 has rounded.
            if (exact - clamped).abs() > ROUNDED {
                let text = || format!("{exact} is not from 0 to 1");
                let message = || Message::new(text(), format!("{clamped} is used"));
                self.warnings.line(WarningKind::OutOfRange, self.keyword, self.line, message);
            }
            *value = clamped as f32;
        }
        Ok(values)
    }
}

/// The distance outside of the range from 0 to 1 that is no warning.
const ROUNDED: f64 = 1.0e-3;
