//! Attributes of vertices beyond the position, the normal and the colour: what a caller requests by name, and what a model has.
//!
//! A value is stored as a word: the bits of an `f32`, or an unsigned integer. Numbers of a model that have no such word are replaced,
//! which is a warning.

use crate::error::FilePosition;
use crate::text::beginning;
use crate::warnings::{FileWarnings, Message, WarningKind};

/// The greatest number of components of an attribute.
pub(crate) const MAX_COMPONENTS: usize = 4;

/// The greatest length of a name in [`AvailableAttribute`], in characters.
const MAX_NAME: usize = 60;

/// An attribute that a scene is opened with.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct AttributeRequest {
    /// Its name. A PLY has it as a property, a glTF as `_NAME`, `COLOR_n` or `TEXCOORD_n`.
    pub name: String,
    /// The number of components, from 1 to 4. Others are never found.
    pub components: usize,
    /// Whether its words are unsigned integers. If not, they are the bits of finite `f32` numbers.
    pub is_integer: bool,
    /// Whether a model without it is valid. Then the scene does not list it.
    pub is_optional: bool,
}

/// An attribute that the vertices of a model have.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct AvailableAttribute {
    /// The name to request, or the beginning of a long one.
    pub name: String,
    /// The number of components.
    pub components: usize,
}

impl AvailableAttribute {
    pub(crate) fn new(name: &str, components: usize) -> Self {
        AvailableAttribute { name: beginning(name, MAX_NAME).to_owned(), components }
    }
}

impl AttributeRequest {
    /// Returns the bytes of a vertex in the list of the attribute.
    pub(crate) fn bytes(&self) -> u64 {
        (self.components * size_of::<u32>()) as u64
    }

    /// Returns the word of a number of the model. If it has none, the word of another number, with a warning.
    pub(crate) fn word(&self, value: f64, position: impl FnOnce() -> FilePosition, warnings: FileWarnings<'_>) -> u32 {
        let name = beginning(&self.name, MAX_NAME);
        if !value.is_finite() || (!self.is_integer && !(value as f32).is_finite()) {
            warnings.add(WarningKind::InvalidAttribute, name, || {
                (position(), Message::new(format!("a value of `{name}`, {value}, has no finite `f32`"), "0 is used"))
            });
            return 0;
        }
        if !self.is_integer {
            return (value as f32).to_bits();
        }
        // Saturates.
        let word = value.round() as u32;
        if f64::from(word) != value {
            warnings.add(WarningKind::OutOfRange, name, || {
                let text = format!("a value of `{name}`, {value}, is not a whole number from 0 to {}", u32::MAX);
                (position(), Message::new(text, format!("{word} is used")))
            });
        }
        word
    }
}
