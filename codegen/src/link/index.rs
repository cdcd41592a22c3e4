//! Maps names to declarations: a hash map with a hash function that is fast on short names.
//!
//! Input: names of one program. Output: numbers of declarations. No output depends on the order of the map.

use std::collections::HashMap;
use std::hash::{BuildHasherDefault, Hasher};

/// The numbers of declarations by name.
pub(super) type Index<'a> = HashMap<&'a str, usize, BuildHasherDefault<NameHasher>>;

/// A hash function that processes eight bytes at a time: rotate, xor, multiply. Names come from templates and from the user's
/// description, so no input is hostile.
#[derive(Default)]
pub(super) struct NameHasher(u64);

/// An odd number without a pattern: the fraction of the golden ratio.
const FACTOR: u64 = 0x9e37_79b9_7f4a_7c15;

impl NameHasher {
    fn add(&mut self, word: u64) {
        self.0 = (self.0.rotate_left(5) ^ word).wrapping_mul(FACTOR);
    }
}

impl Hasher for NameHasher {
    fn write(&mut self, bytes: &[u8]) {
        let (words, rest) = bytes.as_chunks::<8>();
        words.iter().for_each(|word| self.add(u64::from_le_bytes(*word)));
        // The length is included, so that a short rest differs from one with leading zeros.
        let last = rest.iter().fold(bytes.len() as u64, |last, byte| last << 8 | u64::from(*byte));
        self.add(last);
    }

    fn write_u8(&mut self, _: u8) {
        // The byte that ends a string. The hash already includes the length.
    }

    fn finish(&self) -> u64 {
        // The high bits of a product depend on all bits of its factors; the low bits do not.
        self.0 ^ self.0 >> 32
    }
}
