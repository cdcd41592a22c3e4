//! The numbers of a `DataArray` of an XML file: words, Base64 or bytes behind the document, also compressed with zlib.
//!
//! Binary data begins with a header of 32 or 64 bits per number: its length in bytes; or, if it is compressed, the number of blocks, the bytes of a block,
//! those of the last, and the compressed bytes of each.

use std::io::Read as _;

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;

use super::numbers::Kind;
use crate::limits::Budget;
use crate::text::quoted_bytes;

/// The bytes by which compression may lengthen a block, with a margin.
const GROWTH: u64 = 1024;

/// How a file stores binary data.
#[derive(Clone, Copy, Debug)]
pub(super) struct Encoding {
    pub(super) is_big: bool,
    /// The type of the numbers of headers.
    pub(super) header: Kind,
    pub(super) is_compressed: bool,
}

/// Where the data of an array begins.
#[derive(Clone, Copy, Debug)]
pub(super) enum Data<'a> {
    Words(&'a str),
    Base64(&'a [u8]),
    Bytes(&'a [u8]),
}

/// An error about the data, or one of its memory.
pub(super) enum DataError {
    Message(String),
    Memory(crate::error::FileError),
}

impl From<String> for DataError {
    fn from(message: String) -> Self {
        DataError::Message(message)
    }
}

impl From<crate::error::FileError> for DataError {
    fn from(error: crate::error::FileError) -> Self {
        DataError::Memory(error)
    }
}

/// Returns exactly `count` numbers. Their memory, and that of their bytes, is taken from the budget.
pub(super) fn numbers(
    data: Data<'_>,
    (count, kind): (usize, Kind),
    encoding: Encoding,
    budget: &Budget,
) -> Result<Vec<f64>, DataError> {
    let what = "the numbers of an array";
    if let Data::Words(text) = data {
        // A digit and a separator each.
        if count > text.len().div_ceil(2) {
            return Err(format!("{count} numbers are declared, and {} bytes follow", text.len()).into());
        }
        budget.take(count as u64, 8, what)?;
        let numbers: Option<Vec<f64>> =
            text.split_ascii_whitespace().take(count + 1).map(|word| word.parse().ok()).collect();
        let numbers = numbers.ok_or_else(|| "a word is not a number".to_owned())?;
        let found = if numbers.len() > count { "more".to_owned() } else { numbers.len().to_string() };
        return if numbers.len() == count {
            Ok(numbers)
        } else {
            Err(format!("{count} numbers are declared, and {found} follow").into())
        };
    }
    let length = (count as u64).saturating_mul(kind.size() as u64);
    // What is compressed can be a thousandth of its length, and no less.
    let available = match data {
        Data::Words(text) => text.len(),
        Data::Base64(bytes) | Data::Bytes(bytes) => bytes.len(),
    } as u64;
    let most = available.saturating_mul(if encoding.is_compressed { 1100 } else { 1 });
    if length > most {
        return Err(format!("{count} numbers are declared, and {available} bytes follow").into());
    }
    budget.take(length, 1, what)?;
    budget.take(count as u64, 8, what)?;
    let bytes = match encoding.is_compressed {
        true => decompressed(data, length as usize, encoding, budget)?,
        false => plain(data, length as usize, encoding, budget)?,
    };
    Ok(kind.numbers(&bytes, encoding.is_big))
}

/// Returns data that is not compressed.
fn plain(data: Data<'_>, length: usize, encoding: Encoding, budget: &Budget) -> Result<Vec<u8>, DataError> {
    let size = encoding.header.size();
    let bytes = first(data, &[size, length], budget)?;
    let (header, rest) = bytes.split_at_checked(size).ok_or_else(|| "the data has no header".to_owned())?;
    let declared = whole(header, encoding).first().copied().unwrap_or_default();
    if declared != length as u64 {
        return Err(format!("the data has {declared} bytes, and the array needs {length}").into());
    }
    let rest = rest.get(..length).ok_or_else(|| format!("the data ends after {} of {length} bytes", rest.len()))?;
    Ok(rest.to_vec())
}

/// Returns decompressed data.
fn decompressed(data: Data<'_>, length: usize, encoding: Encoding, budget: &Budget) -> Result<Vec<u8>, DataError> {
    let size = encoding.header.size();
    let begin = first(data, &[size], budget)?;
    let blocks = whole(&begin, encoding).first().copied().unwrap_or_default();
    let available = match data {
        Data::Words(text) => text.len(),
        Data::Base64(bytes) | Data::Bytes(bytes) => bytes.len(),
    };
    // A block has a byte or more, before and after.
    if blocks > (available as u64).min(length as u64) {
        return Err(format!("{blocks} blocks are declared for {length} bytes, and {available} bytes follow").into());
    }
    let header_length = size * (3 + blocks as usize);
    let header = first(data, &[header_length], budget)?;
    let sizes: Vec<u64> = header.get(3 * size..header_length).map(|sizes| whole(sizes, encoding)).unwrap_or_default();
    let total = sizes.iter().fold(0_u64, |sum, size| sum.saturating_add(*size));
    // What cannot be compressed grows by some bytes per block.
    let most = (available as u64).min(2 * length as u64 + GROWTH * blocks);
    if sizes.len() as u64 != blocks || total > most {
        return Err(format!("compressed data of {total} bytes in {blocks} blocks, and {available} bytes follow").into());
    }
    let all = first(data, &[header_length, total as usize], budget)?;
    let mut rest = all.get(header_length..).unwrap_or_default();
    let mut bytes = Vec::with_capacity(length);
    for size in sizes {
        let (block, after) =
            rest.split_at_checked(size as usize).ok_or_else(|| "the data ends within a block".to_owned())?;
        rest = after;
        let left = (length - bytes.len()) as u64;
        let read = flate2::read::ZlibDecoder::new(block).take(left + 1).read_to_end(&mut bytes);
        read.map_err(|error| format!("invalid zlib data: {error}"))?;
        if bytes.len() > length {
            return Err(format!("the decompressed data has more than {length} bytes").into());
        }
    }
    if bytes.len() < length {
        return Err(format!("the decompressed data has {} bytes of {length}", bytes.len()).into());
    }
    Ok(bytes)
}

/// Returns the numbers of a header.
fn whole(bytes: &[u8], encoding: Encoding) -> Vec<u64> {
    let size = encoding.header.size();
    let number = |bytes: &[u8]| {
        let byte = |word: u64, byte: &u8| word << 8 | u64::from(*byte);
        if encoding.is_big { bytes.iter().fold(0, byte) } else { bytes.iter().rev().fold(0, byte) }
    };
    bytes.chunks_exact(size).map(number).collect()
}

/// Returns the first bytes: as many as the parts have together, or fewer at the end of the data. In Base64, each part may have an end of its own.
fn first(data: Data<'_>, parts: &[usize], budget: &Budget) -> Result<Vec<u8>, DataError> {
    let length: usize = parts.iter().sum();
    let text = match data {
        Data::Bytes(bytes) => return Ok(bytes.get(..length).unwrap_or(bytes).to_vec()),
        Data::Words(text) => text.as_bytes(),
        Data::Base64(text) => text,
    };
    let letters: usize = parts.iter().map(|part| part.div_ceil(3).saturating_mul(4)).sum();
    let _held = budget.hold(2 * letters.min(text.len()) as u64, 1, "the numbers of an array")?;
    let mut letters: Vec<u8> = text.iter().copied().filter(|byte| !byte.is_ascii_whitespace()).take(letters).collect();
    letters.truncate(letters.len() / 4 * 4);
    let mut bytes = Vec::with_capacity(length);
    // The letters up to each padding are decoded on their own.
    let is_end = |group: &[u8], next: &[u8]| !group.ends_with(b"=") || next.ends_with(b"=");
    for part in letters.as_chunks::<4>().0.chunk_by(|group, next| is_end(group, next)) {
        let decoded = STANDARD.decode(part.as_flattened());
        let part = part.as_flattened();
        bytes.extend(decoded.map_err(|error| format!("invalid Base64 in {}: {error}", quoted_bytes(part)))?);
    }
    bytes.truncate(length);
    Ok(bytes)
}
