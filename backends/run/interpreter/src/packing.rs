//! WGSL's `pack…`, `unpack…` and `insertBits` built-ins, on consecutive words.

use crate::arithmetic::bit_range;
use crate::half::{from_half, to_half};

/// An operation from several words to one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Pack {
    Snorm8,
    Unorm8,
    Snorm16,
    Unorm16,
    Half,
    Signed8,
    Unsigned8,
    SignedClamped8,
    UnsignedClamped8,
    /// The word, the bits to insert, offset, count.
    InsertBits,
}

/// An operation from one word to several.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Unpack {
    Snorm8,
    Unorm8,
    Snorm16,
    Unorm16,
    Half,
    Signed8,
    Unsigned8,
}

impl Pack {
    /// Returns the number of words read.
    pub(crate) fn components(self) -> u32 {
        match self {
            Pack::Snorm16 | Pack::Unorm16 | Pack::Half => 2,
            _ => 4,
        }
    }

    pub(crate) fn apply(self, words: &[u32]) -> u32 {
        if self == Pack::InsertBits {
            return insert_bits(words);
        }
        let bits = 32 / self.components();
        let mask = u32::MAX >> (32 - bits);
        words
            .iter()
            .rev()
            .fold(0, |packed, word| packed.checked_shl(bits).unwrap_or(0) | (self.component(*word) & mask))
    }

    #[inline(always)]
    pub(crate) fn component(self, word: u32) -> u32 {
        let x = f32::from_bits(word);
        // WGSL writes floor(0.5 + scale * x), whose sum may round up to the next integer; drivers round the product, ties to even.
        let snorm = |scale: f32| rounded(scale * x.clamp(-1.0, 1.0)) as u32;
        let unorm = |scale: f32| rounded(scale * x.clamp(0.0, 1.0)) as u32;
        match self {
            Pack::Snorm8 => snorm(127.0),
            Pack::Unorm8 => unorm(255.0),
            Pack::Snorm16 => snorm(32767.0),
            Pack::Unorm16 => unorm(65535.0),
            Pack::Half => u32::from(to_half(x)),
            Pack::Signed8 | Pack::Unsigned8 | Pack::InsertBits => word,
            Pack::SignedClamped8 => (word as i32).clamp(-128, 127) as u32,
            Pack::UnsignedClamped8 => word.min(255),
        }
    }
}

/// Rounds to an integer, ties to even; 0 for NaN. The magnitude of `x` is less than 2²². Adding 1.5 · 2²³ leaves no bits for a fraction.
#[inline(always)]
fn rounded(x: f32) -> i32 {
    const SHIFT: f32 = 12_582_912.0;
    ((x + SHIFT) - SHIFT) as i32
}

fn insert_bits(words: &[u32]) -> u32 {
    let [word, new, offset, count] = words else { return 0 };
    let (offset, count) = bit_range(*offset, *count);
    if count == 0 {
        return *word;
    }
    let mask = (u32::MAX >> (32 - count)) << offset;
    (word & !mask) | ((new << offset) & mask)
}

impl Unpack {
    /// Returns the number of words written.
    pub(crate) fn components(self) -> u32 {
        match self {
            Unpack::Snorm16 | Unpack::Unorm16 | Unpack::Half => 2,
            _ => 4,
        }
    }

    /// Returns the component with this number.
    pub(crate) fn component(self, word: u32, number: u32) -> u32 {
        let bits = 32 / self.components();
        let part = word >> (bits * number);
        match self {
            Unpack::Snorm8 => (f32::from(part as i8) / 127.0).max(-1.0).to_bits(),
            Unpack::Unorm8 => (f32::from(part as u8) / 255.0).to_bits(),
            Unpack::Snorm16 => (f32::from(part as i16) / 32767.0).max(-1.0).to_bits(),
            Unpack::Unorm16 => (f32::from(part as u16) / 65535.0).to_bits(),
            Unpack::Half => from_half(part as u16).to_bits(),
            Unpack::Signed8 => i32::from(part as i8) as u32,
            Unpack::Unsigned8 => part & 0xff,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_rounded_to_the_nearest_integer_and_ties_to_even() {
        for step in -2_000_000..2_000_000 {
            let x = step as f32 / 16.0;
            assert_eq!(rounded(x), x.round_ties_even() as i32, "{x}");
            assert_eq!(rounded(x.next_up()), x.next_up().round_ties_even() as i32, "{x}");
        }
        assert_eq!(rounded(f32::NAN), 0);
    }
}
