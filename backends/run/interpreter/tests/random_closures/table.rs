//! The methods that generated closures call, each with the receivers for which its result is defined.

use super::types::Type;
use super::types::Type::{F32, I32, U32, Usize, Vector};

/// A method: receiver, its limits, name, arguments, and result.
pub struct Method {
    pub on: Type,
    /// Text after the receiver that brings it into the method's domain.
    pub limits: &'static str,
    pub name: &'static str,
    pub arguments: &'static [Argument],
    pub result: Type,
}

/// An argument of a method.
pub enum Argument {
    /// Any expression of this type.
    Any(Type),
    /// An expression of this type with these limits after it.
    Limited(Type, &'static str),
}

use Argument::{Any, Limited};

const V2: Type = Vector(2);
const V3: Type = Vector(3);
const V4: Type = Vector(4);

const fn row(
    on: Type,
    limits: &'static str,
    name: &'static str,
    arguments: &'static [Argument],
    result: Type,
) -> Method {
    Method { on, limits, name, arguments, result }
}

/// Methods of vectors of every size.
macro_rules! vectors {
    ($($v:ident $parts:literal),*) => { [$(
        row($v, "", "abs", &[], $v),
        row($v, "", "min", &[Any($v)], $v),
        row($v, "", "max", &[Any($v)], $v),
        row($v, "", "floor", &[], $v),
        row($v, "", "ceil", &[], $v),
        row($v, "", "trunc", &[], $v),
        row($v, "", "fract", &[], $v),
        row($v, "", "fract_gl", &[], $v),
        row($v, "", "recip", &[], $v),
        row($v, concat!(".min(", $parts, "::splat(8.0))"), "exp", &[], $v),
        row($v, "", "mul_add", &[Any($v), Any($v)], $v),
        row($v, concat!(".max(", $parts, "::ZERO)"), "powf", &[Limited(F32, ".clamp(0.5, 3.0)")], $v),
        row($v, "", "clamp", &[Limited($v, concat!(".min(", $parts, "::ZERO)")), Limited($v, concat!(".max(", $parts, "::ONE)"))], $v),
        row($v, "", "dot", &[Any($v)], F32),
        row($v, "", "length", &[], F32),
        row($v, "", "length_squared", &[], F32),
        row($v, "", "normalize", &[], $v),
        row($v, "", "distance", &[Any($v)], F32),
        row($v, "", "lerp", &[Any($v), Limited(F32, ".clamp(-2.0, 2.0)")], $v),
        row($v, "", "reflect", &[Any($v)], $v),
        row($v, "", "min_element", &[], F32),
        row($v, "", "max_element", &[], F32),
        row($v, "", "element_sum", &[], F32),
        row($v, "", "element_product", &[], F32),
    )*] };
}

/// Methods of vectors.
pub const VECTORS: &[Method] = &vectors!(V2 "Vec2", V3 "Vec3", V4 "Vec4");

/// Methods of numbers, and those that only vectors of one size have.
#[rustfmt::skip]
pub const NUMBERS: &[Method] = &[
    row(V3, "", "cross", &[Any(V3)], V3),
    row(V2, "", "extend", &[Any(F32)], V3),
    row(V3, "", "extend", &[Any(F32)], V4),
    row(V3, "", "truncate", &[], V2),
    row(V4, "", "truncate", &[], V3),
    row(F32, "", "abs", &[], F32),
    row(F32, "", "min", &[Any(F32)], F32),
    row(F32, "", "max", &[Any(F32)], F32),
    row(F32, "", "clamp", &[Limited(F32, ".min(0.25)"), Limited(F32, ".max(0.5)")], F32),
    row(F32, "", "signum", &[], F32),
    row(F32, "", "copysign", &[Any(F32)], F32),
    row(F32, "", "floor", &[], F32),
    row(F32, "", "ceil", &[], F32),
    row(F32, "", "trunc", &[], F32),
    row(F32, "", "round_ties_even", &[], F32),
    row(F32, "", "fract", &[], F32),
    row(F32, "", "rem_euclid", &[Any(F32)], F32),
    row(F32, ".abs()", "sqrt", &[], F32),
    row(F32, "", "recip", &[], F32),
    row(F32, ".abs()", "powf", &[Limited(F32, ".clamp(-3.0, 4.0)")], F32),
    row(F32, ".max(0.0)", "powf", &[Limited(F32, ".clamp(0.0, 2.0)")], F32),
    row(F32, ".clamp(-9.0, 9.0)", "exp", &[], F32),
    row(F32, ".clamp(-9.0, 9.0)", "exp2", &[], F32),
    row(F32, ".abs()", "ln", &[], F32),
    row(F32, ".abs()", "log2", &[], F32),
    row(F32, "", "mul_add", &[Any(F32), Any(F32)], F32),
    row(F32, ".clamp(-3.0, 3.0)", "sin", &[], F32),
    row(F32, ".clamp(-3.0, 3.0)", "cos", &[], F32),
    row(F32, ".clamp(-1.0, 1.0)", "tan", &[], F32),
    row(F32, ".clamp(-0.875, 0.875)", "asin", &[], F32),
    row(F32, ".clamp(-0.875, 0.875)", "acos", &[], F32),
    row(F32, "", "atan", &[], F32),
    row(F32, "", "atan2", &[Any(F32)], F32),
    row(F32, ".clamp(-20.0, 20.0)", "sinh", &[], F32),
    row(F32, ".clamp(-20.0, 20.0)", "cosh", &[], F32),
    row(F32, "", "tanh", &[], F32),
    row(F32, ".clamp(-900.0, 1.0e6)", "asinh", &[], F32),
    row(F32, ".clamp(1.0, 1.0e6)", "acosh", &[], F32),
    row(F32, ".clamp(-0.75, 0.75)", "atanh", &[], F32),
    row(F32, "", "to_radians", &[], F32),
    row(F32, "", "to_degrees", &[], F32),
    row(F32, "", "to_bits", &[], U32),
    row(U32, "", "min", &[Any(U32)], U32),
    row(U32, "", "max", &[Any(U32)], U32),
    row(U32, "", "clamp", &[Limited(U32, ".min(9)"), Limited(U32, ".max(9)")], U32),
    row(U32, "", "rem_euclid", &[Any(U32)], U32),
    row(U32, "", "count_ones", &[], U32),
    row(U32, "", "leading_zeros", &[], U32),
    row(U32, "", "trailing_zeros", &[], U32),
    row(U32, "", "reverse_bits", &[], U32),
    row(U32, "", "wrapping_add", &[Any(U32)], U32),
    row(U32, "", "wrapping_sub", &[Any(U32)], U32),
    row(U32, "", "wrapping_mul", &[Any(U32)], U32),
    row(U32, "", "saturating_sub", &[Any(U32)], U32),
    row(U32, "", "saturating_add", &[Any(U32)], U32),
    row(U32, "", "abs_diff", &[Any(U32)], U32),
    row(I32, "", "abs", &[], I32),
    row(I32, "", "min", &[Any(I32)], I32),
    row(I32, "", "max", &[Any(I32)], I32),
    row(I32, "", "clamp", &[Limited(I32, ".min(-1)"), Limited(I32, ".max(-1)")], I32),
    row(I32, "", "signum", &[], I32),
    row(I32, "", "rem_euclid", &[Any(I32)], I32),
    row(I32, "", "count_ones", &[], U32),
    row(I32, "", "leading_zeros", &[], U32),
    row(I32, "", "trailing_zeros", &[], U32),
    row(I32, "", "wrapping_add", &[Any(I32)], I32),
    row(I32, "", "wrapping_sub", &[Any(I32)], I32),
    row(I32, "", "wrapping_mul", &[Any(I32)], I32),
    row(I32, "", "wrapping_neg", &[], I32),
    row(I32, "", "abs_diff", &[Any(I32)], U32),
    row(Usize, "", "min", &[Any(Usize)], Usize),
    row(Usize, "", "max", &[Any(Usize)], Usize),
    row(Usize, "", "clamp", &[Limited(Usize, ".min(2)"), Limited(Usize, ".max(2)")], Usize),
    row(Usize, "", "saturating_sub", &[Any(Usize)], Usize),
    row(Usize, "", "abs_diff", &[Any(Usize)], Usize),
];
