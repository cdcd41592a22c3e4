//! Where each name is declared: a hash map with a hash that is fast on short names.
//!
//! In: names of one program. Out: numbers of declarations. Order is never taken from it.

use std::collections::HashMap;
use std::hash::{BuildHasherDefault, Hasher};

/// Declarations by name.
pub(super) type Index<'a> = HashMap<&'a str, usize, BuildHasherDefault<Fnv>>;

/// FNV-1a of 64 bits. Names come from templates and from the user's own description, so no input is hostile.
pub(super) struct Fnv(u64);

impl Default for Fnv {
    fn default() -> Self {
        Fnv(0xcbf2_9ce4_8422_2325)
    }
}

impl Hasher for Fnv {
    fn write(&mut self, bytes: &[u8]) {
        for byte in bytes {
            self.0 = (self.0 ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01b3);
        }
    }

    fn finish(&self) -> u64 {
        self.0
    }
}
