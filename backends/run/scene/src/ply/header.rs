//! The head of a PLY file: its encoding, and the elements with their properties in the order of the body.

use crate::error::Fault;

/// What the head says.
pub(super) struct Header {
    pub(super) encoding: Encoding,
    pub(super) elements: Vec<Element>,
    /// Bytes of the head.
    pub(super) length: usize,
    /// Lines of the head.
    pub(super) lines: usize,
}

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
    /// Where it is declared.
    pub(super) line: usize,
}

pub(super) struct Property {
    pub(super) name: String,
    pub(super) kind: Kind,
    /// The kind of the length in front of a list; `None`: a single value.
    pub(super) list: Option<Kind>,
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

    /// What a colour's full intensity is stored as.
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

impl Header {
    pub(super) fn parse(bytes: &[u8]) -> Result<Self, Fault> {
        let (mut encoding, mut elements, mut length) = (None, Vec::<Element>::new(), 0);
        for (line, text) in (1..).zip(bytes.split_inclusive(|byte| *byte == b'\n')) {
            length += text.len();
            let text = std::str::from_utf8(text).map_err(|_| Fault::line(line, "the head is no text"))?;
            let words: Vec<&str> = text.split_whitespace().collect();
            match words.as_slice() {
                ["ply"] if line == 1 => {}
                _ if line == 1 => return Err(Fault::line(line, "a PLY file begins with `ply`")),
                [] | ["comment" | "obj_info", ..] => {}
                ["format", name, "1.0"] => encoding = Some(encoding_of(name, line)?),
                ["element", name, count] => {
                    let count = count.parse().map_err(|_| Fault::line(line, format!("`{count}` is no count")))?;
                    elements.push(Element { name: (*name).to_owned(), count, properties: Vec::new(), line });
                }
                ["property", rest @ ..] => {
                    let element = elements.last_mut().ok_or_else(|| Fault::line(line, "a property of no element"))?;
                    element.properties.push(property(rest, line)?);
                }
                ["end_header"] => {
                    let encoding = encoding.ok_or_else(|| Fault::line(line, "the head has no `format`"))?;
                    return Ok(Header { encoding, elements, length, lines: line });
                }
                _ => return Err(Fault::line(line, format!("`{}` is no line of a head", text.trim()))),
            }
        }
        let lines = bytes.split(|byte| *byte == b'\n').count();
        Err(Fault::line(lines, "the head does not end: `end_header` is missing"))
    }
}

fn encoding_of(name: &str, line: usize) -> Result<Encoding, Fault> {
    match name {
        "ascii" => Ok(Encoding::Ascii),
        "binary_little_endian" => Ok(Encoding::Little),
        "binary_big_endian" => Ok(Encoding::Big),
        _ => Err(Fault::line(line, format!("no format `{name}`: ascii, binary_little_endian or binary_big_endian"))),
    }
}

fn property(words: &[&str], line: usize) -> Result<Property, Fault> {
    let kind = |name: &str| Kind::named(name).ok_or_else(|| Fault::line(line, format!("no type `{name}`")));
    match words {
        ["list", length, item, name] => {
            let length = kind(length)?;
            if matches!(length, Kind::F32 | Kind::F64) {
                return Err(Fault::line(line, "the length of a list is an integer"));
            }
            Ok(Property { name: (*name).to_owned(), kind: kind(item)?, list: Some(length) })
        }
        [single, name] => Ok(Property { name: (*name).to_owned(), kind: kind(single)?, list: None }),
        _ => Err(Fault::line(line, "write `property TYPE NAME` or `property list TYPE TYPE NAME`")),
    }
}
