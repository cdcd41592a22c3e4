//! The description of a peer: the shaders of another project, the memory that they bind, and what has to change in their source so
//! that it compiles and composites every fragment. Nothing of the other project is part of it.

use std::collections::BTreeMap;

use serde::Deserialize;

use crate::Error;

/// A technique of a peer.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Description {
    /// Our technique that it is compared with.
    pub technique: String,
    /// Changes of that technique, as for `--set`.
    #[serde(default)]
    pub set: BTreeMap<String, String>,
    /// What was changed in the peer's source, and why, in a sentence.
    pub note: String,
    /// The folder of the files that `#include` names.
    pub include: String,
    /// The memory that the shaders bind.
    pub memory: Vec<MemoryDescription>,
    /// The passes, in their order.
    pub passes: Vec<PassDescription>,
    /// The files of the peer that are corrected, by path.
    #[serde(default)]
    pub corrections: BTreeMap<String, Correction>,
}

/// What replaces lines of a file.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Correction {
    /// The checksum (FNV-1a, 64 bits) of the file whose lines the numbers count.
    pub checksum: String,
    /// Per number of a line, or range `first-last`, the source that replaces it.
    pub lines: BTreeMap<String, String>,
}

/// An image, a block of words or a counter.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, tag = "kind", rename_all = "kebab-case")]
pub enum MemoryDescription {
    /// An array of images with the size of the frame.
    ImageArray { binding: u32, format: String, layers: u32, clear: Option<[f32; 2]> },
    /// A rectangle with the size of the frame.
    ImageRectangle { binding: u32, format: String, clear: Option<[f32; 2]> },
    /// An image of a buffer.
    ImageBuffer { binding: u32, format: String, texels_per_pixel: u32, clear: Option<[f32; 2]> },
    /// A storage buffer.
    Block { binding: u32, words_per_pixel: u32, words: u32, clear: Option<u32> },
    /// An atomic counter, zero at the begin of a frame.
    Counter { binding: u32 },
}

/// A pass that draws the scene, or one triangle over the frame.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PassDescription {
    /// The fragment shader: a file of the peer.
    #[serde(default)]
    pub fragment: String,
    /// A fragment shader for what the peer's application does itself.
    pub source: Option<String>,
    /// Whether it draws the scene.
    #[serde(default)]
    pub scene: bool,
    /// Whether it blends over the image.
    #[serde(default)]
    pub output: bool,
    /// Integer uniforms: a number, or `width`, `height` or `pixels`.
    #[serde(default)]
    pub uniforms: BTreeMap<String, String>,
}

impl Description {
    /// Parses a description.
    pub fn parse(text: &str) -> Result<Self, Error> {
        serde_json::from_str(text).map_err(|error| Error(format!("the description of a peer: {error}")))
    }
}

impl Description {
    /// Returns the source of a fragment shader, with included files and corrections.
    pub fn source(
        &self,
        pass: &PassDescription,
        read: &dyn Fn(&str) -> Result<String, Error>,
    ) -> Result<String, Error> {
        let source = match &pass.source {
            Some(source) => source.clone(),
            None => self.included(&pass.fragment, read, 0)?,
        };
        // The version must be the first line.
        let (versions, body): (Vec<&str>, Vec<&str>) =
            source.lines().partition(|line| line.trim_start().starts_with("#version"));
        let version = versions.iter().max().copied().unwrap_or("#version 450 core");
        let body = format!("{version}\nin vec4 peer_color;\n{}\n", body.join("\n"));
        let needs_color = body.contains("vec4 computePixelColor();");
        Ok(if needs_color { format!("{body}vec4 computePixelColor() {{ return peer_color; }}\n") } else { body })
    }

    /// Returns a file with its corrections, and with the files that it includes in their places.
    fn included(&self, path: &str, read: &dyn Fn(&str) -> Result<String, Error>, depth: u32) -> Result<String, Error> {
        if depth > 8 {
            return Err(Error(format!("{path}: files include each other")));
        }
        let source = self.corrected(path, read(path)?)?;
        let mut lines = Vec::new();
        for line in source.lines() {
            let name = line.trim().strip_prefix("#include").and_then(|rest| rest.trim().strip_prefix('"'));
            match name.and_then(|rest| rest.strip_suffix('"')) {
                Some(name) => lines.push(self.included(&format!("{}/{name}", self.include), read, depth + 1)?),
                None => lines.push(line.to_owned()),
            }
        }
        Ok(lines.join("\n"))
    }

    fn corrected(&self, path: &str, source: String) -> Result<String, Error> {
        let Some(correction) = self.corrections.get(path) else { return Ok(source) };
        let checksum = checksum(&source);
        if checksum != correction.checksum {
            let expected = &correction.checksum;
            return Err(Error(format!("{path}: the checksum is {checksum}, and the corrections are for {expected}")));
        }
        let mut lines: Vec<&str> = source.lines().collect();
        for (range, replacement) in &correction.lines {
            let (first, last) = range.split_once('-').unwrap_or((range, range));
            let number = |text: &str| text.parse::<usize>().ok().filter(|number| (1..=lines.len()).contains(number));
            let (Some(first), Some(last)) = (number(first), number(last)) else {
                return Err(Error(format!("{path}: no lines `{range}` to correct")));
            };
            lines.get_mut(first - 1..last).into_iter().for_each(|range| range.fill(""));
            lines[first - 1] = replacement;
        }
        Ok(lines.join("\n"))
    }
}

/// Returns the checksum of a source (FNV-1a).
fn checksum(source: &str) -> String {
    let hash = source
        .bytes()
        .fold(0xcbf2_9ce4_8422_2325_u64, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3));
    format!("{hash:016x}")
}
