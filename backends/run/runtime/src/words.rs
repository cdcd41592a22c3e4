//! Conversions between 32-bit words and bytes, in little-endian order, as on every device that wgpu supports.

/// Returns the words of `bytes`, without an incomplete word at the end.
pub(crate) fn from_bytes(bytes: &[u8]) -> Vec<u32> {
    bytes.as_chunks().0.iter().map(|word| u32::from_le_bytes(*word)).collect()
}

/// Returns the bytes of `words`.
pub(crate) fn to_bytes(words: &[u32]) -> Vec<u8> {
    words.iter().flat_map(|word| word.to_le_bytes()).collect()
}
