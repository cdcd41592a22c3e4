//! Where each name is declared: a hash map with a hash that is fast on short names.
//!
//! In: names of one program. Out: numbers of declarations. Order is never taken from it.

use std::collections::HashMap;
use std::hash::{BuildHasherDefault, Hasher};

/// Numbers by name.
pub(super) type Index<'a> = HashMap<&'a str, usize, BuildHasherDefault<Words>>;

/// A hash that takes a name eight bytes at a time: rotate, xor, multiply. Names come from templates and from the user's own
/// description, so no input is hostile.
#[derive(Default)]
pub(super) struct Words(u64);

/// An odd number without a pattern: the golden ratio's fraction.
const FACTOR: u64 = 0x9e37_79b9_7f4a_7c15;

impl Words {
    fn add(&mut self, word: u64) {
        self.0 = (self.0.rotate_left(5) ^ word).wrapping_mul(FACTOR);
    }
}

impl Hasher for Words {
    fn write(&mut self, bytes: &[u8]) {
        let (words, rest) = bytes.as_chunks::<8>();
        words.iter().for_each(|word| self.add(u64::from_le_bytes(*word)));
        // The length is in it, so that names of different lengths never read alike.
        let last = rest.iter().fold(bytes.len() as u64, |last, byte| last << 8 | u64::from(*byte));
        self.add(last);
    }

    fn write_u8(&mut self, _: u8) {
        // What ends a string; its length is in the hash already.
    }

    fn finish(&self) -> u64 {
        // A product's high bits depend on all of its factors' bits, its low ones do not.
        self.0 ^ self.0 >> 32
    }
}
