//! Generated scenes: `NAME[,parameter=value]…`. The same text gives the same scene.

mod cubes;
mod hairball;
mod marbles;
mod needles;
mod random;
mod slabs;

use std::str::FromStr;

use crate::{Error, Object, Scene};

/// A generated scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Builtin {
    row: &'static Row,
    /// In the order of the row's parameters.
    values: Vec<u32>,
}

/// A number that a generated scene takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Parameter {
    /// Its name.
    pub name: &'static str,
    /// Its value where none is given.
    pub default: u32,
    /// The least and the greatest value.
    pub range: (u32, u32),
}

/// Every generated scene: name, what it shows, parameters.
pub const BUILTIN: [Row; 5] = [cubes::ROW, slabs::ROW, marbles::ROW, hairball::ROW, needles::ROW];

/// One generated scene's name, meaning and parameters.
#[derive(Clone, Copy, Debug)]
pub struct Row {
    /// What it is called by.
    pub name: &'static str,
    /// What it shows.
    pub summary: &'static str,
    /// What it takes.
    pub parameters: &'static [Parameter],
    make: fn(&[u32]) -> Vec<Object>,
}

impl PartialEq for Row {
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name
    }
}

const SEED: Parameter = Parameter { name: "seed", default: 1, range: (0, u32::MAX) };

impl Builtin {
    /// Makes the triangles.
    pub fn generate(&self) -> Scene {
        Scene { objects: (self.row.make)(&self.values) }
    }
}

impl FromStr for Builtin {
    type Err = Error;

    fn from_str(text: &str) -> Result<Self, Error> {
        static ROWS: [Row; 5] = BUILTIN;
        let mut parts = text.split(',');
        let name = parts.next().unwrap_or("");
        let Some(row) = ROWS.iter().find(|row| row.name == name) else {
            let names: Vec<&str> = ROWS.iter().map(|row| row.name).collect();
            return Err(Error::Unknown(format!("no scene `builtin:{name}`: there are {}", names.join(", "))));
        };
        let mut values: Vec<u32> = row.parameters.iter().map(|parameter| parameter.default).collect();
        for part in parts {
            let (key, value) = part.split_once('=').unwrap_or((part, ""));
            let found = row.parameters.iter().position(|parameter| parameter.name == key);
            let Some((index, parameter)) = found.and_then(|index| Some((index, row.parameters.get(index)?))) else {
                return Err(Error::Unknown(format!("`builtin:{name}` has no `{key}`: it takes {}", takes(row))));
            };
            let (least, greatest) = parameter.range;
            let value = value.parse().ok().filter(|value| (least..=greatest).contains(value));
            let value =
                value.ok_or_else(|| Error::Unknown(format!("`{part}`: give `{key}` from {least} to {greatest}")))?;
            if let Some(place) = values.get_mut(index) {
                *place = value;
            }
        }
        Ok(Builtin { row, values })
    }
}

fn takes(row: &Row) -> String {
    let names: Vec<String> =
        row.parameters.iter().map(|parameter| format!("{} ({})", parameter.name, parameter.default)).collect();
    if names.is_empty() { "nothing".to_owned() } else { names.join(", ") }
}

/// The value of a parameter by its place in the row.
fn value(values: &[u32], index: usize) -> u32 {
    values.get(index).copied().unwrap_or_default()
}

/// A saturated colour of this hue, from 0 to 1 around the circle.
fn hue(hue: f32, alpha: f32) -> [f32; 4] {
    let channel = |shift: f32| {
        let distance = ((hue + shift).fract() - 0.5).abs() * 6.0;
        0.1 + 0.8 * (distance - 1.0).clamp(0.0, 1.0)
    };
    [channel(0.0), channel(2.0 / 3.0), channel(1.0 / 3.0), alpha]
}
