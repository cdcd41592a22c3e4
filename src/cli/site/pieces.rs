//! The parts that the files of many variants have in common.
//!
//! Input: generated files and manifests. Output: a list of pieces, and each file as the numbers of its pieces: those of a WGSL file begin at
//! its headings, those of a manifest are its fields. The variants of a technique differ in few of them, so that the list is a tenth of the
//! files.

use std::collections::HashMap;

use fragbuf::File;
use serde_json::{Map, Value};

/// The beginning of the line that generated files have above the content of a template.
const HEADING: &str = "// ---- ";

/// Pieces in the order in which they were first seen.
#[derive(Default)]
pub(super) struct Pieces {
    values: Vec<Value>,
    numbers: HashMap<String, usize>,
}

impl Pieces {
    /// Adds a text. Returns the numbers of its pieces; joined, they are the text.
    pub(super) fn text(&mut self, file: &File) -> Value {
        let text = String::from_utf8_lossy(&file.bytes);
        let mut rest = text.as_ref();
        let mut numbers = Vec::new();
        while !rest.is_empty() {
            let end = rest.match_indices(HEADING).map(|(at, _)| at).find(|at| *at > 0 && rest[..*at].ends_with('\n'));
            let (piece, others) = rest.split_at(end.unwrap_or(rest.len()));
            numbers.push(self.number(Value::from(piece)));
            rest = others;
        }
        numbers.into()
    }

    /// Adds an object. Returns the number of each field's value.
    pub(super) fn object(&mut self, object: Value) -> Value {
        let Value::Object(fields) = object else { return Value::Null };
        let numbered = fields.into_iter().map(|(name, value)| (name, self.number(value).into()));
        numbered.collect::<Map<String, Value>>().into()
    }

    /// Returns the list.
    pub(super) fn into_values(self) -> Vec<Value> {
        self.values
    }

    fn number(&mut self, value: Value) -> usize {
        let next = self.values.len();
        let number = *self.numbers.entry(value.to_string()).or_insert(next);
        if number == next {
            self.values.push(value);
        }
        number
    }
}

#[cfg(test)]
mod tests {
    use serde_json::{Value, json};

    use super::Pieces;

    #[test]
    fn joined_pieces_are_the_file_and_equal_pieces_are_stored_once() {
        let file = |text: &str| fragbuf::File {
            path: String::new(),
            target: "wgsl",
            pass: String::new(),
            entry_points: Vec::new(),
            bytes: text.as_bytes().to_vec(),
        };
        let mut pieces = Pieces::default();
        let texts =
            ["// a\n\n// ---- x\nfn x // ---- y\n// ---- z\n", "// b\n\n// ---- x\nfn x // ---- y\n// ---- z\n"];
        let numbers = texts.map(|text| pieces.text(&file(text)));
        assert_eq!(numbers, [json!([0, 1, 2]), json!([3, 1, 2])]);
        let object = pieces.object(json!({ "a": 1, "b": 1 }));
        assert_eq!(object, json!({ "a": 4, "b": 4 }));
        let values = pieces.into_values();
        let piece = |number: &Value| values.get(usize::try_from(number.as_u64()?).ok()?)?.as_str();
        let joined: Option<String> = numbers[1].as_array().into_iter().flatten().map(piece).collect();
        assert_eq!(joined.as_deref(), Some(texts[1]));
    }
}
