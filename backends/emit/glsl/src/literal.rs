//! Prints a literal as the shortest GLSL text that parses to the same bits.
//!
//! 64-bit signed, 16-bit and abstract values are unsupported.

use naga::Literal;

/// Prints a literal. `wgsl` is its WGSL source; a hexadecimal spelling is kept.
pub fn literal(value: Literal, wgsl: &str) -> Option<String> {
    match value {
        Literal::Bool(value) => Some(value.to_string()),
        Literal::U32(value) => Some(unsigned(value, wgsl)),
        Literal::I32(value) => Some(signed(value)),
        Literal::U64(value) => Some(format!("{value}ul")),
        Literal::F32(value) => Some(float(value)),
        _ => None,
    }
}

/// Prints an unsigned literal, such as `12u` or `0xFFFFFFFFu`.
pub fn unsigned(value: u32, wgsl: &str) -> String {
    let digits = wgsl.trim_end_matches('u');
    let hexadecimal = digits.strip_prefix("0x").or_else(|| digits.strip_prefix("0X"));
    if hexadecimal.is_some_and(|digits| u32::from_str_radix(digits, 16) == Ok(value)) {
        return format!("{digits}u");
    }
    // Masks and high single bits are more readable in hexadecimal.
    let is_mask = value & value.wrapping_add(1) == 0 || value.is_power_of_two();
    if value > 0xFFFF && is_mask { format!("0x{value:X}u") } else { format!("{value}u") }
}

fn signed(value: i32) -> String {
    // The least value has no literal: its digits overflow before the minus sign applies.
    if value == i32::MIN { "(-2147483647 - 1)".to_owned() } else { value.to_string() }
}

/// Prints a float literal, such as `1.0` or `1e-5`.
pub fn float(value: f32) -> String {
    // The shortest digits of a large whole number are inexact: 2^32 would print as 4294967300.
    let whole = value.abs() > 16_777_216.0 && value.abs() < 1e10;
    match value.is_finite() {
        true if whole => format!("{value:.1}"),
        true => format!("{value:?}"),
        false => format!("uintBitsToFloat(0x{:X}u)", value.to_bits()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn floats_read_back() {
        assert_eq!(float(1.0), "1.0");
        assert_eq!(float(1e-5), "1e-5");
        assert_eq!(float(1e16), "1e16");
        assert_eq!(float(-0.0), "-0.0");
        assert_eq!(float(0.1), "0.1");
        assert_eq!(float(4_294_967_296.0), "4294967296.0");
        assert_eq!(float(f32::INFINITY), "uintBitsToFloat(0x7F800000u)");
    }

    #[test]
    fn integers() {
        assert_eq!(signed(i32::MIN), "(-2147483647 - 1)");
        assert_eq!(unsigned(255, "0xffu"), "0xffu");
        assert_eq!(unsigned(255, "200u + 55u"), "255u");
        assert_eq!(unsigned(u32::MAX, ""), "0xFFFFFFFFu");
    }
}
