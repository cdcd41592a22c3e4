//! The operations on 64-bit integers, stored as two words, the lower first. They behave like those on 32 bits.

/// An operation on 64-bit integers. Suffix `N`: the second operand is narrow, one word.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Wide {
    Add,
    Subtract,
    Multiply,
    DivideS,
    DivideU,
    RemainderS,
    RemainderU,
    And,
    Or,
    ExclusiveOr,
    MinS,
    MaxS,
    MinU,
    MaxU,
    ShiftLeftN,
    ShiftRightSN,
    ShiftRightUN,
    Equal,
    NotEqual,
    LessS,
    LessEqualS,
    LessU,
    LessEqualU,
    Negate,
    Complement,
    AbsS,
    FromU,
    FromS,
    FromFToS,
    FromFToU,
    SToF,
    UToF,
    ToBool,
}

impl Wide {
    /// Returns the widths of both operands and the result in words; 0: no second operand.
    pub(crate) fn widths(self) -> (u32, u32, u32) {
        match self {
            Wide::ShiftLeftN | Wide::ShiftRightSN | Wide::ShiftRightUN => (2, 1, 2),
            Wide::Equal | Wide::NotEqual | Wide::LessS | Wide::LessEqualS | Wide::LessU | Wide::LessEqualU => (2, 2, 1),
            Wide::Negate | Wide::Complement | Wide::AbsS => (2, 0, 2),
            Wide::FromU | Wide::FromS | Wide::FromFToS | Wide::FromFToU => (1, 0, 2),
            Wide::SToF | Wide::UToF | Wide::ToBool => (2, 0, 1),
            _ => (2, 2, 2),
        }
    }

    pub(crate) fn apply(self, a: u64, b: u64) -> u64 {
        let (i, j) = (a as i64, b as i64);
        let real = |word: u64| f32::from_bits(word as u32);
        match self {
            Wide::Add => a.wrapping_add(b),
            Wide::Subtract => a.wrapping_sub(b),
            Wide::Multiply => a.wrapping_mul(b),
            Wide::DivideS => {
                if j == 0 {
                    a
                } else {
                    i.wrapping_div(j) as u64
                }
            }
            Wide::DivideU => a.checked_div(b).unwrap_or(a),
            Wide::RemainderS => {
                if j == 0 {
                    0
                } else {
                    i.wrapping_rem(j) as u64
                }
            }
            Wide::RemainderU => a.checked_rem(b).unwrap_or(0),
            Wide::And => a & b,
            Wide::Or => a | b,
            Wide::ExclusiveOr => a ^ b,
            Wide::MinS => i.min(j) as u64,
            Wide::MaxS => i.max(j) as u64,
            Wide::MinU => a.min(b),
            Wide::MaxU => a.max(b),
            Wide::ShiftLeftN => a.wrapping_shl(b as u32),
            Wide::ShiftRightSN => i.wrapping_shr(b as u32) as u64,
            Wide::ShiftRightUN => a.wrapping_shr(b as u32),
            Wide::Equal => u64::from(a == b),
            Wide::NotEqual => u64::from(a != b),
            Wide::LessS => u64::from(i < j),
            Wide::LessEqualS => u64::from(i <= j),
            Wide::LessU => u64::from(a < b),
            Wide::LessEqualU => u64::from(a <= b),
            Wide::Negate => a.wrapping_neg(),
            Wide::Complement => !a,
            Wide::AbsS => i.wrapping_abs() as u64,
            Wide::FromU => a,
            Wide::FromS => i64::from(a as u32 as i32) as u64,
            Wide::FromFToS => (real(a).min(9_223_371_487_098_961_920.0) as i64) as u64,
            Wide::FromFToU => real(a).min(18_446_742_974_197_923_840.0) as u64,
            Wide::SToF => u64::from((i as f32).to_bits()),
            Wide::UToF => u64::from((a as f32).to_bits()),
            Wide::ToBool => u64::from(a != 0),
        }
    }
}
