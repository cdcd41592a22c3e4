//! Literals: numbers that WGSL reads as exactly what Rust read.
//!
//! In: a value. Out: the shortest text that reads back as the same value of the same type.

use super::text::{Level, Text};
use crate::types::Type;

/// An `f32`; `suffixed` writes its type too.
pub(super) fn float(value: f32, suffixed: bool) -> Text {
    let shortest = format!("{value:?}");
    // WGSL reads a literal as a 64-bit number first: what rounds to f32::MAX may be beyond it there.
    let beyond = shortest.parse::<f64>().is_ok_and(|wide| wide.abs() > f64::from(f32::MAX));
    let text = if beyond { format!("{:e}", f64::from(value)) } else { shortest };
    let suffix = if suffixed { "f" } else { "" };
    signed(format!("{text}{suffix}"))
}

/// A whole number of this type.
pub(super) fn whole(value: u64, ty: Type) -> Text {
    Text::primary(format!("{value}{}", if ty == Type::I32 { "i" } else { "u" }))
}

/// A negative `i32`, from its size.
pub(super) fn negative(size: u64) -> Text {
    match size {
        // `-2147483648i` would be `-` applied to a literal that is too great.
        2_147_483_648 => Text::primary("i32(-2147483648)"),
        _ => signed(format!("-{size}i")),
    }
}

fn signed(text: String) -> Text {
    let level = if text.starts_with('-') { Level::Unary } else { Level::Primary };
    Text { text, level }
}
