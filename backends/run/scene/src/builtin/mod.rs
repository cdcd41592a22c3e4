//! Generated scenes: `NAME[,parameter=value]…`. Equal names and parameters give equal scenes.

mod attributes;
mod building;
mod cubes;
mod hairball;
mod knot;
mod layers;
mod marbles;
mod needles;
mod part;
mod particles;
mod random;
mod row;
mod shapes;
mod slabs;
mod slivers;
mod tets;

use std::str::FromStr;

use crate::error::FileError;
use crate::limits::Budget;
use crate::{AttributeRequest, Error, Limits, Scene};
pub use row::{Attribute, Parameter, Row};

/// A generated scene.
#[derive(Clone, Debug, PartialEq)]
pub struct BuiltinScene {
    row: &'static Row,
    /// In the order of the parameters.
    values: Vec<u32>,
}

/// The registry rows of all generated scenes.
pub const BUILTIN_SCENES: [Row; 12] = [
    cubes::ROW,
    slabs::ROW,
    layers::ROW,
    marbles::ROW,
    hairball::ROW,
    needles::ROW,
    slivers::ROW,
    tets::ROW,
    particles::ROW,
    part::ROW,
    building::ROW,
    knot::ROW,
];

impl BuiltinScene {
    /// Generates the scene without attributes. `Err`: it is larger than the limits.
    pub fn generate(&self, limits: &Limits) -> Result<Scene, Error> {
        self.generate_with(&[], limits)
    }

    /// Generates the scene with these attributes. `Err`: it is larger than the limits, or has no such attribute.
    pub fn generate_with(&self, attributes: &[AttributeRequest], limits: &Limits) -> Result<Scene, Error> {
        let budget = Budget::new(limits);
        let in_scene = |error: FileError| error.in_file(&format!("builtin:{}", self.row.name));
        let found = attributes::find(self.row.attributes, attributes).map_err(in_scene)?;
        let working = budget.hold(1, (self.row.working)(&self.values), "generating the scene").map_err(in_scene)?;
        let attributes = found.iter().map(|(request, _)| request.clone()).collect();
        let mut scene = Scene { attributes, ..Scene::default() };
        for mut object in (self.row.generate)(&self.values) {
            attributes::select(&mut object, self.row.attributes, &found);
            budget.object(&object).map_err(in_scene)?;
            scene.objects.push(object);
        }
        drop(working);
        Ok(scene)
    }
}

impl FromStr for BuiltinScene {
    type Err = Error;

    fn from_str(text: &str) -> Result<Self, Error> {
        static ROWS: [Row; 12] = BUILTIN_SCENES;
        let mut parts = text.split(',');
        let name = parts.next().unwrap_or("");
        let Some(row) = ROWS.iter().find(|row| row.name == name) else {
            let names: Vec<&str> = ROWS.iter().map(|row| row.name).collect();
            return Err(Error::Unknown(format!("no scene `builtin:{name}`: the scenes are {}", names.join(", "))));
        };
        let mut values: Vec<u32> = row.parameters.iter().map(|parameter| parameter.default).collect();
        for part in parts {
            let (key, value) =
                part.split_once('=').map_or((part.trim(), None), |(key, value)| (key.trim(), Some(value)));
            let position = row.parameters.iter().position(|parameter| parameter.name == key);
            let Some((index, parameter)) = position.and_then(|index| Some((index, row.parameters.get(index)?))) else {
                return Err(Error::Unknown(format!("`builtin:{name}` has no `{key}`: {}", parameter_list(row))));
            };
            let (least, greatest) = parameter.range;
            let parsed = value.and_then(|value| value.trim().parse().ok());
            let Some(value) = parsed.filter(|value| (least..=greatest).contains(value)) else {
                let given = value.map_or("no value".to_owned(), |value| format!("`{value}`"));
                let default = parameter.default;
                return Err(Error::Unknown(format!(
                    "`builtin:{name}`: `{key}` has {given}: write a whole number from {least} to {greatest}, as `{key}={default}`"
                )));
            };
            if let Some(slot) = values.get_mut(index) {
                *slot = value;
            }
        }
        Ok(BuiltinScene { row, values })
    }
}

fn parameter_list(row: &Row) -> String {
    let names: Vec<String> =
        row.parameters.iter().map(|parameter| format!("{} ({})", parameter.name, parameter.default)).collect();
    if names.is_empty() {
        "it has no parameters".to_owned()
    } else {
        format!("its parameters are {}", names.join(", "))
    }
}
