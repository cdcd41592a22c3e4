//! The operations on single words, as WGSL defines them.
//!
//! Integers wrap, division by zero returns the dividend, shift amounts are taken modulo 32, and conversions saturate at the
//! limits that both types share. Floats follow Rust; where WGSL allows an error bound, the result is the value it bounds.

use crate::half::{from_half, to_half};
use crate::scalar::{Binary, Ternary, Unary};

fn float(word: u32) -> f32 {
    f32::from_bits(word)
}

fn signed(word: u32) -> i32 {
    word as i32
}

#[inline(always)]
pub(crate) fn unary(op: Unary, word: u32) -> u32 {
    let x = float(word);
    let real = |value: f32| value.to_bits();
    match op {
        Unary::Negate => word.wrapping_neg(),
        Unary::NegateF => word ^ 0x8000_0000,
        Unary::Not => u32::from(word == 0),
        Unary::Complement => !word,
        Unary::AbsS => signed(word).wrapping_abs() as u32,
        Unary::AbsF => word & 0x7fff_ffff,
        Unary::SignS => signed(word).signum() as u32,
        Unary::SignF => real(if x > 0.0 {
            1.0
        } else if x < 0.0 {
            -1.0
        } else {
            0.0
        }),
        Unary::Ceil => real(x.ceil()),
        Unary::Floor => real(x.floor()),
        Unary::Round => real(x.round_ties_even()),
        Unary::Fract => real(x - x.floor()),
        Unary::Trunc => real(x.trunc()),
        Unary::FrexpFraction => real(fraction_and_exponent(x).0),
        Unary::FrexpExponent => fraction_and_exponent(x).1 as u32,
        Unary::Exp => real(x.exp()),
        Unary::Exp2 => real(x.exp2()),
        Unary::Log => real(x.ln()),
        Unary::Log2 => real(x.log2()),
        Unary::Sqrt => real(x.sqrt()),
        Unary::InverseSqrt => real(1.0 / x.sqrt()),
        Unary::Sin => real(x.sin()),
        Unary::Cos => real(x.cos()),
        Unary::Tan => real(x.tan()),
        Unary::Asin => real(x.asin()),
        Unary::Acos => real(x.acos()),
        Unary::Atan => real(x.atan()),
        Unary::Sinh => real(x.sinh()),
        Unary::Cosh => real(x.cosh()),
        Unary::Tanh => real(x.tanh()),
        Unary::Asinh => real(x.asinh()),
        Unary::Acosh => real(x.acosh()),
        Unary::Atanh => real(x.atanh()),
        Unary::Radians => real(x.to_radians()),
        Unary::Degrees => real(x.to_degrees()),
        Unary::Saturate => real(x.clamp(0.0, 1.0)),
        Unary::QuantizeToF16 => real(from_half(to_half(x))),
        Unary::TrailingZeros => word.trailing_zeros(),
        Unary::LeadingZeros => word.leading_zeros(),
        Unary::CountOnes => word.count_ones(),
        Unary::ReverseBits => word.reverse_bits(),
        Unary::FirstTrailingBit => {
            if word == 0 {
                u32::MAX
            } else {
                word.trailing_zeros()
            }
        }
        Unary::FirstLeadingBitS => first_leading_bit(if signed(word) < 0 { !word } else { word }),
        Unary::FirstLeadingBitU => first_leading_bit(word),
        // The greatest number of both types.
        Unary::FToS => (x.min(2_147_483_520.0) as i32) as u32,
        Unary::FToU => x.min(4_294_967_040.0) as u32,
        Unary::SToF => real(signed(word) as f32),
        Unary::UToF => real(word as f32),
        Unary::ToBool => u32::from(word != 0),
        Unary::FToBool => u32::from(x != 0.0),
        Unary::IsNan => u32::from(x.is_nan()),
        Unary::IsInf => u32::from(x.is_infinite()),
    }
}

fn first_leading_bit(word: u32) -> u32 {
    31u32.wrapping_sub(word.leading_zeros())
}

/// Splits x into fraction · 2^exponent with 0.5 ≤ |fraction| < 1. Zero and non-finite numbers are returned unchanged.
fn fraction_and_exponent(x: f32) -> (f32, i32) {
    if x == 0.0 || !x.is_finite() {
        return (x, 0);
    }
    // Subnormals are scaled first: their exponent bits do not contain the exponent.
    let (scaled, shift) = if x.abs() < f32::MIN_POSITIVE { (x * 16_777_216.0, 24) } else { (x, 0) };
    let bits = scaled.to_bits();
    let exponent = ((bits >> 23) & 0xff) as i32 - 126 - shift;
    (f32::from_bits((bits & 0x807f_ffff) | (126 << 23)), exponent)
}

#[inline(always)]
pub(crate) fn binary(op: Binary, left: u32, right: u32) -> u32 {
    let (x, y) = (float(left), float(right));
    let (i, j) = (signed(left), signed(right));
    let real = |value: f32| value.to_bits();
    match op {
        Binary::Add => left.wrapping_add(right),
        Binary::Subtract => left.wrapping_sub(right),
        Binary::Multiply => left.wrapping_mul(right),
        Binary::DivideS => {
            if j == 0 {
                left
            } else {
                i.wrapping_div(j) as u32
            }
        }
        Binary::DivideU => left.checked_div(right).unwrap_or(left),
        Binary::RemainderS => {
            if j == 0 {
                0
            } else {
                i.wrapping_rem(j) as u32
            }
        }
        Binary::RemainderU => left.checked_rem(right).unwrap_or(0),
        Binary::AddF => real(x + y),
        Binary::SubtractF => real(x - y),
        Binary::MultiplyF => real(x * y),
        Binary::DivideF => real(x / y),
        Binary::RemainderF => real(x - y * (x / y).trunc()),
        Binary::And => left & right,
        Binary::Or => left | right,
        Binary::ExclusiveOr => left ^ right,
        Binary::ShiftLeft => left.wrapping_shl(right),
        Binary::ShiftRightS => i.wrapping_shr(right) as u32,
        Binary::ShiftRightU => left.wrapping_shr(right),
        Binary::Equal => u32::from(left == right),
        Binary::NotEqual => u32::from(left != right),
        Binary::LessS => u32::from(i < j),
        Binary::LessEqualS => u32::from(i <= j),
        Binary::LessU => u32::from(left < right),
        Binary::LessEqualU => u32::from(left <= right),
        Binary::EqualF => u32::from(x == y),
        Binary::NotEqualF => u32::from(x != y),
        Binary::LessF => u32::from(x < y),
        Binary::LessEqualF => u32::from(x <= y),
        Binary::MinS => i.min(j) as u32,
        Binary::MaxS => i.max(j) as u32,
        Binary::MinU => left.min(right),
        Binary::MaxU => left.max(right),
        Binary::MinF => real(x.min(y)),
        Binary::MaxF => real(x.max(y)),
        Binary::Power => real(x.powf(y)),
        Binary::Atan2 => real(x.atan2(y)),
        Binary::Step => real(if x <= y { 1.0 } else { 0.0 }),
        Binary::Ldexp => real((f64::from(x) * 2f64.powi(j.clamp(-400, 400))) as f32),
        Binary::Dot4S => (0..4)
            .fold(0i32, |sum, at| sum + i32::from((left >> (8 * at)) as i8) * i32::from((right >> (8 * at)) as i8))
            as u32,
        Binary::Dot4U => (0..4).fold(0, |sum, at| sum + ((left >> (8 * at)) & 0xff) * ((right >> (8 * at)) & 0xff)),
    }
}

#[inline(always)]
pub(crate) fn ternary(op: Ternary, a: u32, b: u32, c: u32) -> u32 {
    let (x, y, z) = (float(a), float(b), float(c));
    match op {
        Ternary::Select => {
            if a != 0 {
                b
            } else {
                c
            }
        }
        Ternary::FusedMultiplyAdd => x.mul_add(y, z).to_bits(),
        Ternary::Mix => (x * (1.0 - z) + y * z).to_bits(),
        Ternary::SmoothStep => {
            let t = ((z - x) / (y - x)).clamp(0.0, 1.0);
            (t * t * (3.0 - 2.0 * t)).to_bits()
        }
        Ternary::ExtractBitsU => {
            let (offset, count) = bit_range(b, c);
            if count == 0 { 0 } else { (a >> offset) & (u32::MAX >> (32 - count)) }
        }
        Ternary::ExtractBitsS => {
            let (offset, count) = bit_range(b, c);
            if count == 0 { 0 } else { (((a << (32 - offset - count)) as i32) >> (32 - count)) as u32 }
        }
    }
}

/// Clamps a bit field to the word, as WGSL does.
pub(crate) fn bit_range(offset: u32, count: u32) -> (u32, u32) {
    let offset = offset.min(32);
    (offset, count.min(32 - offset))
}
