//! MTL: the diffuse colour `Kd` and the opacity `d` (or `Tr`, its complement) of materials, by name. Textures and all other
//! statements are ignored.

use crate::error::FileError;
use crate::text::{lines, number, numbers};

/// A material.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Material {
    pub(crate) name: String,
    /// Linear, straight alpha; `None` if the file gives none.
    pub(crate) color: Option<[f32; 3]>,
    pub(crate) alpha: f32,
}

/// Parses the materials of a library.
pub(crate) fn parse(text: &str) -> Result<Vec<Material>, FileError> {
    let mut materials: Vec<Material> = Vec::new();
    for (line, statement) in lines(text) {
        let words: Vec<&str> = statement.split_whitespace().collect();
        let Some((keyword, values)) = words.split_first() else { continue };
        if *keyword == "newmtl" {
            let name = values.join(" ");
            if name.is_empty() {
                return Err(FileError::line(line, "`newmtl` without a name"));
            }
            materials.push(Material { name, color: None, alpha: 1.0 });
            continue;
        }
        let Some(material) = materials.last_mut() else {
            return Err(FileError::line(line, format!("`{keyword}` before the first `newmtl`")));
        };
        match *keyword {
            "Kd" => material.color = Some(color(values, line)?),
            "d" => material.alpha = unit_number(values.strip_prefix(&["-halo"]).unwrap_or(values), line)?,
            "Tr" => material.alpha = 1.0 - unit_number(values, line)?,
            _ => {}
        }
    }
    Ok(materials)
}

fn color(words: &[&str], line: usize) -> Result<[f32; 3], FileError> {
    if let Some(kind @ ("spectral" | "xyz")) = words.first().copied() {
        return Err(FileError::line(line, format!("`Kd {kind}` is not supported: give red, green and blue")));
    }
    // The format defines a single number as grey.
    let values = numbers(words, &[1, 3], line)?;
    let last = values.len() - 1;
    let color: [f32; 3] = std::array::from_fn(|channel| values.get(channel.min(last)).copied().unwrap_or(0.0));
    match color.iter().find(|value| !(0.0..=1.0).contains(*value)) {
        Some(value) => Err(FileError::line(line, format!("{value} is not from 0 to 1"))),
        None => Ok(color),
    }
}

fn unit_number(words: &[&str], line: usize) -> Result<f32, FileError> {
    match words {
        [word] => match number(word, line)? {
            value if (0.0..=1.0).contains(&value) => Ok(value),
            value => Err(FileError::line(line, format!("{value} is not from 0 to 1"))),
        },
        _ => Err(FileError::line(line, format!("expected 1 number, found {}", words.len()))),
    }
}
