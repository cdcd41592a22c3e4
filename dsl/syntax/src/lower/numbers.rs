//! Number literals with the same value in WGSL as in Rust.
//!
//! Input: a value. Output: the shortest literal with the same value and type.

use super::source::{ExprSource, Precedence};
use crate::types::Type;

/// Returns an `f32` literal, with a suffix if `suffixed`.
pub(super) fn float(value: f32, suffixed: bool) -> ExprSource {
    let shortest = format!("{value:?}");
    // WGSL parses a literal as a 64-bit number first: a number that rounds to f32::MAX may be out of range there.
    let out_of_range = shortest.parse::<f64>().is_ok_and(|wide| wide.abs() > f64::from(f32::MAX));
    let digits = if out_of_range { format!("{:e}", f64::from(value)) } else { shortest };
    let suffix = if suffixed { "f" } else { "" };
    signed(format!("{digits}{suffix}"))
}

/// Returns an integer literal of this type.
pub(super) fn integer(value: u64, ty: Type) -> ExprSource {
    ExprSource::primary(format!("{value}{}", if ty == Type::I32 { "i" } else { "u" }))
}

/// Returns a negative `i32` literal of this absolute value.
pub(super) fn negative(magnitude: u64) -> ExprSource {
    match magnitude {
        // `-2147483648i` would be `-` applied to a literal out of range.
        2_147_483_648 => ExprSource::primary("i32(-2147483648)"),
        _ => signed(format!("-{magnitude}i")),
    }
}

fn signed(source: String) -> ExprSource {
    let precedence = if source.starts_with('-') { Precedence::Unary } else { Precedence::Primary };
    ExprSource { source, precedence }
}
