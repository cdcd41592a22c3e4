//! The header of a PLY file: its encoding, and the elements with their properties in the order of the body.

use super::body::lines;
use crate::error::{FileError, FilePosition};
use crate::text::{first_line, quoted};

/// The greatest length of a header in bytes.
const MAX_HEADER: usize = 1 << 20;

/// The header of a PLY file.
pub(super) struct Header {
    pub(super) encoding: Encoding,
    pub(super) elements: Vec<Element>,
    /// Its length in bytes.
    pub(super) length: usize,
    /// Its number of lines.
    pub(super) lines: usize,
    /// The line of the first comment that names a texture.
    pub(super) texture: Option<usize>,
}

impl Header {
    /// Returns the declared numbers of records, as "3 `vertex` and 1 `face`".
    pub(super) fn declared(&self) -> String {
        let counts: Vec<String> = self
            .elements
            .iter()
            .take(MAX_COUNTS)
            .map(|element| format!("{} {}", element.count, quoted(&element.name)))
            .collect();
        match counts.as_slice() {
            [] => "no elements".to_owned(),
            [only] => only.clone(),
            [begin @ .., last] => format!("{} and {last}", begin.join(", ")),
        }
    }

    /// Adds the declared numbers of records to an error that may be the consequence of a wrong one: an ASCII body has another number of
    /// lines, or a list of a binary body does not fit the file.
    pub(super) fn with_counts(&self, error: FileError, bytes: &[u8]) -> FileError {
        let FileError::Malformed(position, message) = error else { return error };
        let records =
            self.elements.iter().filter(|element| !element.properties.is_empty()).map(|element| element.count);
        let records = records.fold(0_usize, usize::saturating_add);
        let counts = match position {
            _ if message.contains("declares") => None,
            FilePosition::Line(line) if line > self.lines && self.encoding == Encoding::Ascii => {
                let found = lines(bytes.get(self.length..).unwrap_or_default());
                (found != records).then(|| match found {
                    1 => ", and 1 line follows it".to_owned(),
                    _ => format!(", and {found} lines follow it"),
                })
            }
            FilePosition::Byte(_) if ["a list", "no vertex"].iter().any(|begin| message.starts_with(begin)) => {
                Some(String::new())
            }
            _ => None,
        };
        let counts = counts.map(|counts| format!("; the header declares {}{counts}", self.declared()));
        FileError::Malformed(position, message + &counts.unwrap_or_default())
    }
}

/// The greatest number of elements that a message lists.
const MAX_COUNTS: usize = 8;

#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Encoding {
    Ascii,
    Little,
    Big,
}

pub(super) struct Element {
    pub(super) name: String,
    pub(super) count: usize,
    pub(super) properties: Vec<Property>,
    /// The line of its declaration.
    pub(super) line: usize,
}

pub(super) struct Property {
    pub(super) name: String,
    pub(super) kind: Kind,
    /// The type of the length of a list; `None`: a single value.
    pub(super) list: Option<Kind>,
    /// The line of its declaration.
    pub(super) line: usize,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

impl Kind {
    fn named(name: &str) -> Option<Self> {
        Some(match name {
            "char" | "int8" => Kind::I8,
            "uchar" | "uint8" => Kind::U8,
            "short" | "int16" => Kind::I16,
            "ushort" | "uint16" => Kind::U16,
            "int" | "int32" => Kind::I32,
            "uint" | "uint32" => Kind::U32,
            "float" | "float32" => Kind::F32,
            "double" | "float64" => Kind::F64,
            _ => return None,
        })
    }

    /// Returns its size in bytes in a binary file.
    pub(super) fn size(self) -> u64 {
        match self {
            Kind::I8 | Kind::U8 => 1,
            Kind::I16 | Kind::U16 => 2,
            Kind::I32 | Kind::U32 | Kind::F32 => 4,
            Kind::F64 => 8,
        }
    }

    /// Returns the value of a colour at full intensity.
    pub(super) fn greatest(self) -> f64 {
        match self {
            Kind::I8 => i8::MAX.into(),
            Kind::U8 => u8::MAX.into(),
            Kind::I16 => i16::MAX.into(),
            Kind::U16 => u16::MAX.into(),
            Kind::I32 => i32::MAX.into(),
            Kind::U32 => u32::MAX.into(),
            Kind::F32 | Kind::F64 => 1.0,
        }
    }
}

/// The names of elements that are read, and names that writers use in their place.
const ELEMENTS: [(&str, &[&str]); 3] = [
    ("vertex", &["vertices", "vertexes", "verts", "vert", "point", "points"]),
    ("face", &["faces", "polygon", "polygons", "triangle", "triangles"]),
    ("tristrips", &["tristrip", "tri_strips", "strips", "triangle_strips"]),
];

impl Element {
    /// Returns the name that an element with another name of vertices, faces or strips has in the format.
    pub(super) fn right_name(&self) -> Option<&'static str> {
        let name = self.name.to_ascii_lowercase();
        let is_meant = |(right, others): &&(&str, &[&str])| {
            self.name != *right && (name == *right || others.contains(&name.as_str()))
        };
        ELEMENTS.iter().find(is_meant).map(|(right, _)| *right)
    }

    /// Returns the properties that have the name of an earlier one.
    pub(super) fn duplicates(&self) -> impl Iterator<Item = &Property> {
        let properties = self.properties.iter().enumerate();
        let has_earlier = |index: usize, name: &str| self.properties.iter().take(index).any(|other| other.name == name);
        properties.filter(move |(index, property)| has_earlier(*index, &property.name)).map(|(_, property)| property)
    }
}

impl Header {
    pub(super) fn parse(bytes: &[u8]) -> Result<Self, FileError> {
        let (mut encoding, mut elements, mut length) = (None, Vec::<Element>::new(), 0);
        let mut texture = None;
        let line_end = LineEnd::of(bytes);
        let head = head(bytes);
        let (mut rest, mut line) = (head, 0);
        while let Some((text, after)) = first_line(rest) {
            line += 1;
            length += rest.len() - after.len();
            rest = after;
            // Comments may be in any encoding.
            let text = String::from_utf8_lossy(text);
            let words: Vec<&str> = text.split_whitespace().collect();
            match words.as_slice() {
                ["ply"] if line == 1 => {}
                _ if line == 1 => return Err(FileError::line(line, "a PLY file begins with `ply`")),
                ["comment", "TextureFile", ..] => texture = texture.or(Some(line)),
                [] | ["comment" | "obj_info", ..] => {}
                ["format", name, "1.0"] => encoding = Some(encoding_of(name, line)?),
                ["element", name, count] => {
                    let count = count
                        .parse()
                        .map_err(|_| FileError::line(line, format!("{} is not a count", quoted(count))))?;
                    elements.push(Element { name: (*name).to_owned(), count, properties: Vec::new(), line });
                }
                ["property", rest @ ..] => {
                    let element = elements
                        .last_mut()
                        .ok_or_else(|| FileError::line(line, "a property before the first element"))?;
                    element.properties.push(property(rest, line)?);
                }
                ["end_header"] => {
                    let encoding = encoding.ok_or_else(|| FileError::line(line, "the header has no `format`"))?;
                    let length = line_end.body(bytes, length);
                    return Ok(Header { encoding, elements, length, lines: line, texture });
                }
                _ => return Err(FileError::line(line, format!("unknown header line {}", quoted(text.trim())))),
            }
        }
        let message = match head.len() == bytes.len() {
            true => "`end_header` is missing".to_owned(),
            false => format!("`end_header` is missing in the first {MAX_HEADER} bytes"),
        };
        Err(FileError::line(line.max(1), message))
    }
}

/// The ends of the lines of a header, as that of its first line.
#[derive(Clone, Copy, PartialEq, Eq)]
enum LineEnd {
    CarriageReturn,
    /// A line feed, or a carriage return and a line feed.
    LineFeed,
}

impl LineEnd {
    fn of(bytes: &[u8]) -> Self {
        let mut ends = bytes.iter().skip_while(|byte| !matches!(byte, b'\n' | b'\r'));
        match (ends.next(), ends.next()) {
            (Some(b'\r'), Some(b'\n')) | (Some(b'\n'), _) | (None, _) => LineEnd::LineFeed,
            _ => LineEnd::CarriageReturn,
        }
    }

    /// Returns the first byte of the body of a file whose header ends before `end`, including a line feed. Where lines end with a
    /// carriage return alone, a line feed after `end_header` is the first byte of a binary body.
    fn body(self, bytes: &[u8], end: usize) -> usize {
        let header = bytes.get(..end).unwrap_or(bytes);
        if self == LineEnd::CarriageReturn && header.ends_with(b"\r\n") { end - 1 } else { end }
    }
}

/// Returns the lines that may belong to a header.
fn head(bytes: &[u8]) -> &[u8] {
    let Some(head) = bytes.get(..MAX_HEADER) else { return bytes };
    let end = head.iter().rposition(|byte| matches!(byte, b'\n' | b'\r')).map_or(0, |last| last + 1);
    // A carriage return and a line feed are one line end.
    let is_divided = head.get(..end).is_some_and(|head| head.ends_with(b"\r")) && bytes.get(end) == Some(&b'\n');
    bytes.get(..end + usize::from(is_divided)).unwrap_or(bytes)
}

fn encoding_of(name: &str, line: usize) -> Result<Encoding, FileError> {
    match name {
        "ascii" => Ok(Encoding::Ascii),
        "binary_little_endian" => Ok(Encoding::Little),
        "binary_big_endian" => Ok(Encoding::Big),
        _ => Err(FileError::line(
            line,
            format!("unknown format {}: use ascii, binary_little_endian or binary_big_endian", quoted(name)),
        )),
    }
}

/// The names of types.
const TYPES: &str = "the types are char, uchar, short, ushort, int, uint, float and double";

fn property(words: &[&str], line: usize) -> Result<Property, FileError> {
    let kind = |name: &str| {
        Kind::named(name).ok_or_else(|| FileError::line(line, format!("unknown type {}: {TYPES}", quoted(name))))
    };
    match words {
        ["list", length, item, name] => {
            let length = kind(length)?;
            if matches!(length, Kind::F32 | Kind::F64) {
                return Err(FileError::line(line, "the length of a list must be an integer"));
            }
            Ok(Property { name: (*name).to_owned(), kind: kind(item)?, list: Some(length), line })
        }
        [single, name] => Ok(Property { name: (*name).to_owned(), kind: kind(single)?, list: None, line }),
        _ => Err(FileError::line(line, "expected `property TYPE NAME` or `property list TYPE TYPE NAME`")),
    }
}
