//! The numbers of an accessor, checked against its buffers before any of them is read.
//!
//! Input: an accessor, the types that its use allows, and the bytes of the buffers. Output: [`Elements`], numbers by element and
//! component. Elements that a sparse accessor replaces come from its own views; without a view, the others are 0. The counts and
//! strides of a file are never trusted: an accessor that reaches beyond its view, or a view beyond its buffer, is an error.

use gltf::accessor::sparse::{IndexType, Sparse};
use gltf::accessor::{DataType, Dimensions};
use gltf::{Accessor, buffer};

use crate::error::FileError;

/// The types that a use allows.
pub(super) struct Types {
    pub(super) dimensions: &'static [Dimensions],
    pub(super) components: &'static [DataType],
}

/// The numbers of an accessor.
pub(super) struct Elements<'a> {
    pub(super) count: usize,
    /// The numbers of an element.
    pub(super) components: usize,
    kind: DataType,
    is_normalized: bool,
    /// `None`: zeros.
    base: Option<Slices<'a>>,
    sparse: Option<(SparseIndices<'a>, Slices<'a>)>,
}

/// Equal parts of a buffer at equal distances.
#[derive(Clone, Copy)]
struct Slices<'a> {
    bytes: &'a [u8],
    stride: usize,
}

/// The numbers of the elements that a sparse accessor replaces: strictly increasing.
struct SparseIndices<'a> {
    slices: Slices<'a>,
    kind: IndexType,
    count: usize,
}

impl<'a> Elements<'a> {
    /// Returns the numbers of an accessor. `Err`: its type is not among `types`, or it is not within its buffers.
    pub(super) fn of(accessor: &Accessor<'_>, types: &Types, buffers: &'a [Vec<u8>]) -> Result<Self, FileError> {
        let number = accessor.index();
        let error =
            |message: String| FileError::whole(format!("accessor {number}: {message}")).in_element("accessors", number);
        let (dimensions, kind) = (accessor.dimensions(), accessor.data_type());
        if !types.dimensions.contains(&dimensions) || !types.components.contains(&kind) {
            return Err(error(format!(
                "its type is {} of {}; its use allows {} of {}",
                shape(dimensions),
                component(kind),
                one_of(types.dimensions.iter().map(|allowed| shape(*allowed))),
                one_of(types.components.iter().map(|allowed| component(*allowed)))
            )));
        }
        let (count, size) = (accessor.count(), accessor.size());
        if count == 0 {
            return Err(error("it is empty".to_owned()));
        }
        let base = accessor.view().map(|view| slices(&view, accessor.offset(), (count, size), buffers));
        let sparse = accessor.sparse().map(|sparse| replaced(&sparse, (count, size), buffers));
        // An accessor with neither is all zeros.
        Ok(Elements {
            count,
            components: dimensions.multiplicity(),
            kind,
            is_normalized: accessor.normalized(),
            base: base.transpose().map_err(error)?,
            sparse: sparse.transpose().map_err(error)?,
        })
    }

    /// Returns a number; integers that are normalised become numbers from -1 or 0 to 1.
    pub(super) fn float(&self, element: usize, component: usize) -> f32 {
        let size = self.kind.size();
        let scale = |value: f32, greatest: f32| if self.is_normalized { (value / greatest).max(-1.0) } else { value };
        let Some(bytes) = self.bytes(element).and_then(|bytes| bytes.get(component * size..)) else { return 0.0 };
        match self.kind {
            DataType::I8 => scale(chunk(bytes).map_or(0, i8::from_le_bytes).into(), i8::MAX.into()),
            DataType::U8 => scale(chunk(bytes).map_or(0, u8::from_le_bytes).into(), u8::MAX.into()),
            DataType::I16 => scale(chunk(bytes).map_or(0, i16::from_le_bytes).into(), i16::MAX.into()),
            DataType::U16 => scale(chunk(bytes).map_or(0, u16::from_le_bytes).into(), u16::MAX.into()),
            DataType::U32 => chunk(bytes).map_or(0, u32::from_le_bytes) as f32,
            DataType::F32 => chunk(bytes).map_or(0.0, f32::from_le_bytes),
        }
    }

    /// Returns a number like [`Elements::float`]. Integers of 32 bits are exact.
    pub(super) fn number(&self, element: usize, component: usize) -> f64 {
        let bytes = || self.bytes(element)?.get(component * self.kind.size()..).and_then(chunk);
        match self.kind {
            DataType::U32 => bytes().map_or(0, u32::from_le_bytes).into(),
            _ => self.float(element, component).into(),
        }
    }

    /// Returns the first number of an element, an unsigned integer.
    pub(super) fn index(&self, element: usize) -> u32 {
        let Some(bytes) = self.bytes(element) else { return 0 };
        match self.kind {
            DataType::U8 | DataType::I8 => chunk(bytes).map_or(0, u8::from_le_bytes).into(),
            DataType::U16 | DataType::I16 => chunk(bytes).map_or(0, u16::from_le_bytes).into(),
            DataType::U32 | DataType::F32 => chunk(bytes).map_or(0, u32::from_le_bytes),
        }
    }

    fn bytes(&self, element: usize) -> Option<&'a [u8]> {
        let replaced = self.sparse.as_ref().and_then(|(indices, values)| Some((indices.find(element)?, values)));
        match replaced {
            Some((number, values)) => values.get(number),
            None => self.base?.get(element),
        }
    }
}

impl<'a> Slices<'a> {
    fn get(&self, number: usize) -> Option<&'a [u8]> {
        self.bytes.get(number.checked_mul(self.stride)?..)
    }
}

impl SparseIndices<'_> {
    fn get(&self, number: usize) -> usize {
        let bytes = self.slices.get(number).unwrap_or_default();
        match self.kind {
            IndexType::U8 => chunk(bytes).map_or(0, u8::from_le_bytes).into(),
            IndexType::U16 => chunk(bytes).map_or(0, u16::from_le_bytes).into(),
            IndexType::U32 => chunk(bytes).map_or(0, u32::from_le_bytes) as usize,
        }
    }

    /// Returns the number of the replacement for an element, by binary search.
    fn find(&self, element: usize) -> Option<usize> {
        let (mut least, mut end) = (0, self.count);
        while least < end {
            let middle = least + (end - least) / 2;
            match self.get(middle).cmp(&element) {
                std::cmp::Ordering::Equal => return Some(middle),
                std::cmp::Ordering::Less => least = middle + 1,
                std::cmp::Ordering::Greater => end = middle,
            }
        }
        None
    }
}

/// Returns the replaced elements of a sparse accessor with `count` elements of `size` bytes.
fn replaced<'a>(
    sparse: &Sparse<'_>,
    (count, size): (usize, usize),
    buffers: &'a [Vec<u8>],
) -> Result<(SparseIndices<'a>, Slices<'a>), String> {
    let (indices, values) = (sparse.indices(), sparse.values());
    let number = sparse.count();
    if number == 0 || number > count {
        return Err(format!("it replaces {number} of {count} elements"));
    }
    let kind = indices.index_type();
    let found = slices(&indices.view(), indices.offset(), (number, kind.size()), buffers)?;
    let replaced = SparseIndices { slices: found, kind, count: number };
    for next in 1..number {
        if replaced.get(next - 1) >= replaced.get(next) {
            return Err(format!("the numbers of its sparse elements do not increase at {next}"));
        }
    }
    if replaced.get(number - 1) >= count {
        return Err(format!("it replaces element {} of {count}", replaced.get(number - 1)));
    }
    Ok((replaced, slices(&values.view(), values.offset(), (number, size), buffers)?))
}

/// Returns `count` parts of `size` bytes from `offset` in a view. `Err`: they are not within it, or it is not within its buffer.
fn slices<'a>(
    view: &buffer::View<'_>,
    offset: usize,
    (count, size): (usize, usize),
    buffers: &'a [Vec<u8>],
) -> Result<Slices<'a>, String> {
    let stride = view.stride().unwrap_or(size);
    if stride < size {
        return Err(format!("its elements have {size} bytes, and its view a stride of {stride}"));
    }
    let end = (count - 1).checked_mul(stride).and_then(|last| last.checked_add(size)?.checked_add(offset));
    let end = end.filter(|end| *end <= view.length());
    let buffer = buffers.get(view.buffer().index()).map_or(&[][..], Vec::as_slice);
    let inside = view.offset().checked_add(view.length()).and_then(|end| buffer.get(view.offset()..end));
    let bytes = end.and_then(|end| inside?.get(offset..end));
    let bytes = bytes.ok_or_else(|| {
        let (length, of) = (view.length(), buffer.len());
        format!(
            "it reaches beyond its buffer: {count} elements of {size} bytes from byte {offset}, of a view of {length} bytes and a buffer of {of}"
        )
    })?;
    Ok(Slices { bytes, stride })
}

fn chunk<const N: usize>(bytes: &[u8]) -> Option<[u8; N]> {
    bytes.first_chunk().copied()
}

/// Returns the name of a shape in the format.
fn shape(dimensions: Dimensions) -> &'static str {
    match dimensions {
        Dimensions::Scalar => "SCALAR",
        Dimensions::Vec2 => "VEC2",
        Dimensions::Vec3 => "VEC3",
        Dimensions::Vec4 => "VEC4",
        Dimensions::Mat2 => "MAT2",
        Dimensions::Mat3 => "MAT3",
        Dimensions::Mat4 => "MAT4",
    }
}

/// Returns the name and the number of a component type in the format.
fn component(kind: DataType) -> &'static str {
    match kind {
        DataType::I8 => "BYTE (5120)",
        DataType::U8 => "UNSIGNED_BYTE (5121)",
        DataType::I16 => "SHORT (5122)",
        DataType::U16 => "UNSIGNED_SHORT (5123)",
        DataType::U32 => "UNSIGNED_INT (5125)",
        DataType::F32 => "FLOAT (5126)",
    }
}

/// Returns `a, b or c`.
fn one_of<'a>(names: impl Iterator<Item = &'a str>) -> String {
    let names: Vec<&str> = names.collect();
    match names.split_last() {
        Some((last, rest)) if !rest.is_empty() => format!("{} or {last}", rest.join(", ")),
        _ => names.concat(),
    }
}
