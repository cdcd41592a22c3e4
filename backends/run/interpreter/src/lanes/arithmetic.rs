//! The operations on single words, applied to every lane. Each lane has the bits that `crate::arithmetic` gives one invocation.
//!
//! The operation is constant in each arm, so the compiler turns the arm into a loop of vector instructions.

use super::set::{LANES, LaneSet, Lanes};
use crate::arithmetic;
use crate::scalar::{Binary, Ternary, Unary};

#[inline(always)]
fn each(a: &Lanes, operation: impl Fn(u32) -> u32) -> Lanes {
    let mut result = [0; LANES];
    for lane in 0..LANES {
        result[lane] = operation(a[lane]);
    }
    result
}

#[inline(always)]
fn pairs(a: &Lanes, b: &Lanes, operation: impl Fn(u32, u32) -> u32) -> Lanes {
    let mut result = [0; LANES];
    for lane in 0..LANES {
        result[lane] = operation(a[lane], b[lane]);
    }
    result
}

/// Applies an operation to the lanes of a set; it is too slow to be wasted on others.
fn some(lanes: LaneSet, operation: impl Fn(usize) -> u32) -> Lanes {
    let mut result = [0; LANES];
    lanes.for_each(|lane| result[lane] = operation(lane));
    result
}

/// Applies an operation at least to the lanes of the set.
pub(super) fn unary(op: Unary, a: &Lanes, lanes: LaneSet) -> Lanes {
    macro_rules! vectors {
        ($($name:ident)*) => {
            match op {
                $(Unary::$name => each(a, |word| arithmetic::unary(Unary::$name, word)),)*
                _ => some(lanes, |lane| arithmetic::unary(op, a[lane])),
            }
        };
    }
    vectors!(
        Negate NegateF Not Complement AbsS AbsF SignS SignF Sqrt InverseSqrt Radians Degrees Saturate FToS FToU SToF UToF ToBool
        FToBool IsNan IsInf
    )
}

/// Applies an operation at least to the lanes of the set.
pub(super) fn binary(op: Binary, a: &Lanes, b: &Lanes, lanes: LaneSet) -> Lanes {
    macro_rules! vectors {
        ($($name:ident)*) => {
            match op {
                $(Binary::$name => pairs(a, b, |left, right| arithmetic::binary(Binary::$name, left, right)),)*
                _ => some(lanes, |lane| arithmetic::binary(op, a[lane], b[lane])),
            }
        };
    }
    vectors!(
        Add Subtract Multiply AddF SubtractF MultiplyF DivideF And Or ExclusiveOr ShiftLeft ShiftRightS ShiftRightU Equal NotEqual
        LessS LessEqualS LessU LessEqualU EqualF NotEqualF LessF LessEqualF MinS MaxS MinU MaxU MinF MaxF Step
    )
}

/// Applies an operation at least to the lanes of the set.
pub(super) fn ternary(op: Ternary, a: &Lanes, b: &Lanes, c: &Lanes, lanes: LaneSet) -> Lanes {
    match op {
        Ternary::Select => {
            let mut result = [0; LANES];
            for lane in 0..LANES {
                result[lane] = arithmetic::ternary(Ternary::Select, a[lane], b[lane], c[lane]);
            }
            result
        }
        Ternary::Mix => {
            let mut result = [0; LANES];
            for lane in 0..LANES {
                result[lane] = arithmetic::ternary(Ternary::Mix, a[lane], b[lane], c[lane]);
            }
            result
        }
        _ => some(lanes, |lane| arithmetic::ternary(op, a[lane], b[lane], c[lane])),
    }
}
