//! The positions of the parts of a model in its JSON: a line, or a byte of a GLB. Parsed JSON has none, so the text is searched once an error
//! needs one.

use crate::error::{FileError, FilePosition};

/// The bytes of the header of a GLB file and of its first chunk.
pub(super) const GLB_HEADER: usize = 20;

/// The text of a model.
#[derive(Clone, Copy)]
pub(super) struct Text<'a> {
    json: &'a [u8],
    is_glb: bool,
}

impl<'a> Text<'a> {
    /// Returns the JSON of a file.
    pub(super) fn of(bytes: &'a [u8]) -> Self {
        let is_glb = bytes.starts_with(b"glTF");
        let length = bytes.get(12..).and_then(|rest| rest.first_chunk()).map_or(0, |word| u32::from_le_bytes(*word));
        let glb = || bytes.get(GLB_HEADER..).map(|rest| rest.get(..length as usize).unwrap_or(rest));
        Text { json: if is_glb { glb().unwrap_or_default() } else { bytes }, is_glb }
    }

    pub(super) fn json(self) -> &'a [u8] {
        self.json
    }

    /// Returns an error with its position.
    pub(super) fn located(self, error: FileError) -> FileError {
        match error {
            FileError::InElement { list, index, message } => FileError::Malformed(self.position(list, index), message),
            other => other,
        }
    }

    /// Returns the position of an element of a list of the model, or of a value that is not a list.
    pub(super) fn position(self, list: &str, index: usize) -> FilePosition {
        let Some(byte) = self.find(list, index) else { return FilePosition::Whole };
        if self.is_glb {
            return FilePosition::Byte(GLB_HEADER + byte);
        }
        let before = self.json.get(..byte).unwrap_or_default();
        FilePosition::Line(1 + before.iter().filter(|byte| **byte == b'\n').count())
    }

    /// Returns the first byte of an element.
    fn find(self, list: &str, index: usize) -> Option<usize> {
        let mut depth = 0_usize;
        // The begin of the last string, and the last string at the level of the model.
        let (mut string, mut key) = (None, &[][..]);
        // Whether a value may begin, and the number of the next element of the list.
        let (mut is_value, mut is_list, mut next) = (false, false, 0);
        let mut is_escaped = false;
        for (at, byte) in self.json.iter().enumerate() {
            if let Some(begin) = string {
                match byte {
                    _ if is_escaped => is_escaped = false,
                    b'\\' => is_escaped = true,
                    b'"' => {
                        string = None;
                        key = if depth == 1 { self.json.get(begin..at).unwrap_or_default() } else { key };
                    }
                    _ => {}
                }
                continue;
            }
            let begins = is_value && !byte.is_ascii_whitespace() && *byte != b']';
            let is_named = key == list.as_bytes();
            if begins && depth == 1 && is_named && *byte != b'[' {
                return Some(at);
            }
            if begins && is_list && depth == 2 {
                if next == index {
                    return Some(at);
                }
                next += 1;
            }
            is_value = matches!(byte, b':' | b',' | b'[') || (is_value && byte.is_ascii_whitespace());
            match byte {
                b'"' => string = Some(at + 1),
                b'[' | b'{' => {
                    is_list |= *byte == b'[' && depth == 1 && is_named;
                    depth += 1;
                }
                b']' | b'}' => {
                    depth = depth.saturating_sub(1);
                    is_list &= depth > 1;
                }
                b',' if depth == 1 => key = &[],
                _ => {}
            }
        }
        None
    }
}
