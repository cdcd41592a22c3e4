//! A registry row of a generated scene, and helpers of the generators.

use crate::Object;

/// A parameter of a generated scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Parameter {
    /// The name.
    pub name: &'static str,
    /// The default value.
    pub default: u32,
    /// The least and the greatest value.
    pub range: (u32, u32),
}

/// An attribute of the vertices of a generated scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Attribute {
    /// The name.
    pub name: &'static str,
    /// The number of components.
    pub components: usize,
    /// Whether its words are unsigned integers. If not, they are the bits of `f32` numbers.
    pub is_integer: bool,
}

/// The objects of a generated scene, one after the other.
pub(super) type Objects = Box<dyn Iterator<Item = Object>>;

/// The registry row of a generated scene.
#[derive(Clone, Copy, Debug)]
pub struct Row {
    /// The name.
    pub name: &'static str,
    /// A description of the scene.
    pub summary: &'static str,
    /// The parameters.
    pub parameters: &'static [Parameter],
    /// The attributes of the vertices, beside position, normal and colour.
    pub attributes: &'static [Attribute],
    /// Returns the bytes that generating an object needs beside it.
    pub(super) working: fn(&[u32]) -> u64,
    /// Generates the objects, with all attributes of the row, from the values of the parameters.
    pub(super) generate: fn(&[u32]) -> Objects,
}

impl PartialEq for Row {
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name
    }
}

pub(super) const SEED: Parameter = Parameter { name: "seed", default: 1, range: (0, u32::MAX) };

/// Returns that generating an object needs no memory beside it.
pub(super) fn no_memory(_: &[u32]) -> u64 {
    0
}

/// Returns the value of a parameter by its index in the row.
pub(super) fn value(values: &[u32], index: usize) -> u32 {
    values.get(index).copied().unwrap_or_default()
}

/// Returns a saturated colour; hues go from 0 to 1.
pub(super) fn hue(hue: f32, alpha: f32) -> [f32; 4] {
    let channel = |shift: f32| {
        let distance = ((hue + shift).fract() - 0.5).abs() * 6.0;
        0.1 + 0.8 * (distance - 1.0).clamp(0.0, 1.0)
    };
    [channel(0.0), channel(2.0 / 3.0), channel(1.0 / 3.0), alpha]
}
