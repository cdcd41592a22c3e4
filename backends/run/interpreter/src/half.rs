//! Conversions between half floats and floats.

/// Rounds to the nearest half float, ties to even.
pub fn to_half(x: f32) -> u16 {
    let bits = x.to_bits();
    let sign = ((bits >> 16) & 0x8000) as u16;
    let magnitude = bits & 0x7fff_ffff;
    if magnitude > 0x7f80_0000 {
        return sign | 0x7e00;
    }
    // From 65520 on, infinity is nearest.
    if magnitude >= 0x477f_f000 {
        return sign | 0x7c00;
    }
    if magnitude < 0x3880_0000 {
        // Subnormal: a multiple of 2^-24.
        let units = (f64::from(f32::from_bits(magnitude)) * 16_777_216.0).round_ties_even();
        return sign | units as u16;
    }
    let rebased = magnitude - 0x3800_0000;
    let odd = (rebased >> 13) & 1;
    sign | ((rebased + 0xfff + odd) >> 13) as u16
}

/// Converts a half float to a float.
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
        // 1 + 2^-11 is half way between 1 and the next half float; the even one is 1.
        assert_eq!(to_half(1.0 + 0.000_488_281_25), 0x3c00);
        assert_eq!(to_half(5.960_464_5e-8), 1);
    }

    #[test]
    fn every_half_survives_a_round_trip() {
        for half in (0..=u16::MAX).filter(|half| half & 0x7c00 != 0x7c00) {
            assert_eq!(to_half(from_half(half)), half);
        }
    }
}
