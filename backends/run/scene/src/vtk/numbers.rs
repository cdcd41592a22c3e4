//! The types of numbers in VTK files, and numbers in binary data.

/// A type of numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    I64,
    U64,
    F32,
    F64,
}

/// The names of types in legacy files and in XML.
const NAMES: [(&str, Kind); 29] = [
    ("char", Kind::I8),
    ("signed_char", Kind::I8),
    ("unsigned_char", Kind::U8),
    ("short", Kind::I16),
    ("unsigned_short", Kind::U16),
    ("int", Kind::I32),
    ("unsigned_int", Kind::U32),
    ("long", Kind::I64),
    ("unsigned_long", Kind::U64),
    ("float", Kind::F32),
    ("double", Kind::F64),
    ("vtkidtype", Kind::I64),
    ("vtktypeint8", Kind::I8),
    ("vtktypeuint8", Kind::U8),
    ("vtktypeint16", Kind::I16),
    ("vtktypeuint16", Kind::U16),
    ("vtktypeint32", Kind::I32),
    ("vtktypeuint32", Kind::U32),
    ("vtktypeint64", Kind::I64),
    ("vtktypeuint64", Kind::U64),
    ("vtktypefloat32", Kind::F32),
    ("int8", Kind::I8),
    ("uint8", Kind::U8),
    ("int16", Kind::I16),
    ("uint16", Kind::U16),
    ("int32", Kind::I32),
    ("uint32", Kind::U32),
    ("int64", Kind::I64),
    ("uint64", Kind::U64),
];

const FLOATS: [(&str, Kind); 3] = [("float32", Kind::F32), ("float64", Kind::F64), ("vtktypefloat64", Kind::F64)];

impl Kind {
    /// Returns the type of this name, in upper or lower case.
    pub(super) fn named(name: &str) -> Option<Kind> {
        let mut rows = NAMES.iter().chain(&FLOATS);
        rows.find(|(known, _)| known.eq_ignore_ascii_case(name)).map(|(_, kind)| *kind)
    }

    /// Returns the bytes of a number.
    pub(super) fn size(self) -> usize {
        match self {
            Kind::I8 | Kind::U8 => 1,
            Kind::I16 | Kind::U16 => 2,
            Kind::I32 | Kind::U32 | Kind::F32 => 4,
            Kind::I64 | Kind::U64 | Kind::F64 => 8,
        }
    }

    /// Returns the numbers in binary data.
    pub(super) fn numbers(self, bytes: &[u8], is_big: bool) -> Vec<f64> {
        bytes.chunks_exact(self.size()).map(|bytes| self.number(bytes, is_big)).collect()
    }

    fn number(self, bytes: &[u8], is_big: bool) -> f64 {
        // The least significant byte first, padded to eight bytes.
        let mut word = [0_u8; 8];
        for (index, slot) in word.iter_mut().take(bytes.len()).enumerate() {
            let at = if is_big { bytes.len() - 1 - index } else { index };
            *slot = bytes.get(at).copied().unwrap_or_default();
        }
        let bits = u64::from_le_bytes(word);
        match self {
            Kind::I8 => f64::from(bits as u8 as i8),
            Kind::U8 | Kind::U16 | Kind::U32 | Kind::U64 => bits as f64,
            Kind::I16 => f64::from(bits as u16 as i16),
            Kind::I32 => f64::from(bits as u32 as i32),
            Kind::I64 => bits as i64 as f64,
            Kind::F32 => f64::from(f32::from_bits(bits as u32)),
            Kind::F64 => f64::from_bits(bits),
        }
    }
}
