//! Several numbers in one word: WGSL's pack and unpack built-ins, half floats, and bits put into a word.
//!
//! In: consecutive words. Out: consecutive words.

use crate::arithmetic::bit_range;

/// Several words to one.
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
    /// The word, the bits to put in, offset, count.
    InsertBits,
}

/// One word to several.
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
    /// Words read.
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

    fn component(self, word: u32) -> u32 {
        let x = f32::from_bits(word);
        let snorm = |scale: f32| (0.5 + scale * x.clamp(-1.0, 1.0)).floor() as i32 as u32;
        let unorm = |scale: f32| (0.5 + scale * x.clamp(0.0, 1.0)).floor() as u32;
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
    /// Words written.
    pub(crate) fn components(self) -> u32 {
        match self {
            Unpack::Snorm16 | Unpack::Unorm16 | Unpack::Half => 2,
            _ => 4,
        }
    }

    /// The component of this number.
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

/// The nearest half float, ties to even.
pub fn to_half(x: f32) -> u16 {
    let bits = x.to_bits();
    let sign = ((bits >> 16) & 0x8000) as u16;
    let magnitude = bits & 0x7fff_ffff;
    if magnitude > 0x7f80_0000 {
        return sign | 0x7e00;
    }
    // From 65520 on the nearest is infinity.
    if magnitude >= 0x477f_f000 {
        return sign | 0x7c00;
    }
    if magnitude < 0x3880_0000 {
        // Subnormal: units of 2^-24.
        let units = (f64::from(f32::from_bits(magnitude)) * 16_777_216.0).round_ties_even();
        return sign | units as u16;
    }
    let rebased = magnitude - 0x3800_0000;
    let odd = (rebased >> 13) & 1;
    sign | ((rebased + 0xfff + odd) >> 13) as u16
}

/// The same number as a float.
pub fn from_half(half: u16) -> f32 {
    let sign = if half & 0x8000 == 0 { 1.0 } else { -1.0 };
    let (exponent, fraction) = (i32::from((half >> 10) & 0x1f), f32::from(half & 0x3ff));
    match exponent {
        0 => sign * fraction / 16_777_216.0,
        31 if fraction == 0.0 => sign * f32::INFINITY,
        31 => f32::NAN,
        _ => sign * (1.0 + fraction / 1024.0) * 2f32.powi(exponent - 15),
    }
}

#[cfg(test)]
mod tests {
    use super::{from_half, to_half};

    #[test]
    fn halves_round_to_the_nearest_and_to_even() {
        for (x, half) in [(1.0, 0x3c00), (65504.0, 0x7bff), (65519.0, 0x7bff), (65520.0, 0x7c00), (-2.0, 0xc000)] {
            assert_eq!(to_half(x), half, "{x}");
        }
        // 1 + 2^-11 is half way between 1 and the next: even is 1.
        assert_eq!(to_half(1.0 + 0.000_488_281_25), 0x3c00);
        assert_eq!(to_half(5.960_464_5e-8), 1);
    }

    #[test]
    fn every_half_survives_the_way_there_and_back() {
        for half in (0..=u16::MAX).filter(|half| half & 0x7c00 != 0x7c00) {
            assert_eq!(to_half(from_half(half)), half);
        }
    }
}
