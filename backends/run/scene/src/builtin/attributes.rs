//! Finds the attributes of a generated scene that a caller requests, and reduces objects to them.

use super::row::Attribute;
use crate::error::FileError;
use crate::{AttributeRequest, AvailableAttribute, Object};

/// Returns the requests that the scene has, with their indices in the row. `Err`: it does not have one that is not optional.
pub(super) fn find(
    available: &[Attribute],
    requests: &[AttributeRequest],
) -> Result<Vec<(AttributeRequest, usize)>, FileError> {
    let mut found = Vec::new();
    for request in requests {
        let is_equal = |attribute: &Attribute| {
            attribute.name.eq_ignore_ascii_case(&request.name) && attribute.components == request.components
        };
        match available.iter().position(is_equal) {
            Some(index) => found.push((request.clone(), index)),
            None if request.is_optional => {}
            None => {
                let available =
                    available.iter().map(|attribute| AvailableAttribute::new(attribute.name, attribute.components));
                return Err(FileError::MissingAttribute(request.clone(), available.collect(), None));
            }
        }
    }
    Ok(found)
}

/// Replaces the attributes of an object, all of a row, by those that were found.
pub(super) fn select(object: &mut Object, row: &[Attribute], found: &[(AttributeRequest, usize)]) {
    let all = std::mem::take(&mut object.attributes);
    let words = |(request, index): &(AttributeRequest, usize)| {
        let is_integer = row.get(*index).is_some_and(|attribute| attribute.is_integer);
        let words = all.get(*index).into_iter().flatten();
        words.map(|word| converted(*word, is_integer, request.is_integer)).collect()
    };
    object.attributes = found.iter().map(words).collect();
}

/// Returns the word of the same number as an integer or as a float.
fn converted(word: u32, is_integer: bool, to_integer: bool) -> u32 {
    match (is_integer, to_integer) {
        (true, false) => (word as f32).to_bits(),
        // Saturates.
        (false, true) => f32::from_bits(word).round() as u32,
        _ => word,
    }
}
