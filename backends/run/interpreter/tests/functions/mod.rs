//! Functions that are compiled twice: as Rust and as closures of fragbuf. They call every method.

mod edges;

/// A value of a function, as one word of a buffer.
pub trait Word: Copy + 'static {
    /// The conversion from a word in WGSL.
    const FROM_WORD: &str;
    /// The edge values.
    const EDGES: &[Self];
    fn from_word(word: u32) -> Self;
    fn word(self) -> u32;
}

impl Word for u32 {
    const FROM_WORD: &str = "u32";
    const EDGES: &[u32] = edges::UNSIGNED;
    fn from_word(word: u32) -> u32 {
        word
    }
    fn word(self) -> u32 {
        self
    }
}

impl Word for i32 {
    const FROM_WORD: &str = "bitcast<i32>";
    const EDGES: &[i32] = edges::SIGNED;
    fn from_word(word: u32) -> i32 {
        word.cast_signed()
    }
    fn word(self) -> u32 {
        self.cast_unsigned()
    }
}

impl Word for f32 {
    const FROM_WORD: &str = "bitcast<f32>";
    const EDGES: &[f32] = edges::FLOATS;
    fn from_word(word: u32) -> f32 {
        f32::from_bits(word)
    }
    fn word(self) -> u32 {
        self.to_bits()
    }
}

/// A function that is compiled twice.
pub struct Function {
    pub name: &'static str,
    pub source: &'static str,
    pub parameters: &'static [&'static str],
    pub edges: Vec<Vec<u32>>,
    pub is_float: bool,
    pub run: fn(&[u32]) -> u32,
}

/// Defines functions in Rust and a table of them with their sources.
macro_rules! functions {
    ($table:ident: $(fn $name:ident($($parameter:ident: $type:ty),+) -> $result:ty $body:block)*) => {
        $(#[allow(clippy::eq_op, clippy::manual_clamp, clippy::suboptimal_flops, reason = "the functions are written for the test")]
        fn $name($($parameter: $type),+) -> $result $body)*

        /// Returns the functions.
        pub fn $table() -> Vec<Function> {
            vec![$(Function {
                name: stringify!($name),
                source: stringify!(fn $name($($parameter: $type),+) -> $result $body),
                parameters: &[$(<$type as Word>::FROM_WORD),+],
                edges: vec![$(<$type as Word>::EDGES.iter().map(|value| value.word()).collect()),+],
                is_float: <$result as Word>::FROM_WORD == <f32 as Word>::FROM_WORD,
                run: |words| {
                    let mut words = words.iter().copied();
                    $(let $parameter = <$type as Word>::from_word(words.next().unwrap());)+
                    $name($($parameter),+).word()
                },
            }),*]
        }
    };
}

pub mod vectors;

// Every loop ends after five iterations, so that a loop past its end has another result instead of no end.
functions! { loops:
    fn up(a: u32, b: u32) -> u32 {
        let mut sum = 1u32;
        let mut steps = 0u32;
        for i in a..=b {
            if steps == 5 { break; }
            steps += 1;
            if i % 3 == 1 { continue; }
            sum = sum.wrapping_mul(31).wrapping_add(i);
        }
        sum.wrapping_mul(8).wrapping_add(steps)
    }
    fn down(a: u32, b: u32) -> u32 {
        let mut sum = 1u32;
        let mut steps = 0u32;
        for i in (a..=b).rev() {
            if steps == 5 { break; }
            steps += 1;
            if i % 3 == 1 { continue; }
            sum = sum.wrapping_mul(31).wrapping_add(i);
        }
        sum.wrapping_mul(8).wrapping_add(steps)
    }
    fn up_signed(a: i32, b: i32) -> i32 {
        let mut sum = 1i32;
        let mut steps = 0i32;
        for i in a..=b {
            if steps == 5 { break; }
            steps += 1;
            if i % 3 == 1 { continue; }
            sum = sum.wrapping_mul(31).wrapping_add(i);
        }
        sum.wrapping_mul(8).wrapping_add(steps)
    }
    fn down_signed(a: i32, b: i32) -> i32 {
        let mut sum = 1i32;
        let mut steps = 0i32;
        for i in (a..=b).rev() {
            if steps == 5 { break; }
            steps += 1;
            if i % 3 == 1 { continue; }
            sum = sum.wrapping_mul(31).wrapping_add(i);
        }
        sum.wrapping_mul(8).wrapping_add(steps)
    }
    fn exclusive(a: u32, b: u32) -> u32 {
        let mut sum = 1u32;
        let mut steps = 0u32;
        for i in a..b {
            if steps == 5 { break; }
            steps += 1;
            sum = sum.wrapping_mul(31).wrapping_add(i);
        }
        for i in (a..b).rev() {
            if steps == 9 { break; }
            steps += 1;
            sum = sum.wrapping_mul(31).wrapping_add(i);
        }
        sum
    }
    fn exclusive_signed(a: i32, b: i32) -> i32 {
        let mut sum = 1i32;
        let mut steps = 0i32;
        for i in a..b {
            if steps == 5 { break; }
            steps += 1;
            sum = sum.wrapping_mul(31).wrapping_add(i);
        }
        for i in (a..b).rev() {
            if steps == 9 { break; }
            steps += 1;
            sum = sum.wrapping_mul(31).wrapping_add(i);
        }
        sum
    }
    fn constant_bounds(a: u32, b: i32) -> u32 {
        let mut sum = a;
        for i in 4294967293..=u32::MAX { sum = sum.wrapping_mul(31).wrapping_add(i); }
        for i in (4294967293..=u32::MAX).rev() { sum = sum.wrapping_mul(31).wrapping_add(i); }
        for i in (0..=3u32).rev() { sum = sum.wrapping_mul(31).wrapping_add(i); }
        for i in 2147483645..=i32::MAX { sum = sum.wrapping_mul(31).wrapping_add(i as u32); }
        for i in (i32::MIN..=-2147483646).rev() { sum = sum.wrapping_mul(31).wrapping_add(i as u32); }
        let mut steps = 0u32;
        for i in b..=i32::MAX {
            if steps > 3 { break; }
            steps += 1;
            sum = sum.wrapping_mul(31).wrapping_add(i as u32);
        }
        steps = 0;
        for i in (i32::MIN..=b).rev() {
            if steps > 3 { break; }
            steps += 1;
            sum = sum.wrapping_mul(31).wrapping_add(i as u32);
        }
        steps = 0;
        for i in (a..=u32::MAX).rev() {
            if steps > 3 { break; }
            steps += 1;
            sum = sum.wrapping_mul(31).wrapping_add(i);
        }
        steps = 0;
        for i in 0..=a {
            if steps > 3 { break; }
            steps += 1;
            sum = sum.wrapping_mul(31).wrapping_add(i);
        }
        for _ in 2147483644..=a.min(2147483647) { sum = sum.wrapping_mul(3); }
        sum
    }
    fn nested(a: u32, b: u32) -> u32 {
        let mut sum = 0u32;
        for i in a.max(4294967290)..=u32::MAX {
            for j in (i..=b | 4294967290).rev() {
                if j == 4294967292 { continue; }
                sum = sum.wrapping_mul(7).wrapping_add(i ^ j);
            }
        }
        sum
    }
}

functions! { whole_numbers:
    fn unsigned_bits(a: u32) -> u32 { a.count_ones() + 100 * a.leading_zeros() + 10000 * a.trailing_zeros() }
    fn reverse_bits(a: u32) -> u32 { a.reverse_bits() }
    fn unsigned_order(a: u32, b: u32, c: u32) -> u32 { a.clamp(b.min(c), b.max(c)) }
    fn unsigned_remainder(a: u32, b: u32) -> u32 { a.rem_euclid(b.max(1)) }
    fn unsigned_wrapping(a: u32, b: u32) -> u32 { a.wrapping_add(b).wrapping_mul(b).wrapping_sub(a) }
    fn saturating_add(a: u32, b: u32) -> u32 { a.saturating_add(b) }
    fn saturating_sub(a: u32, b: u32) -> u32 { a.saturating_sub(b) }
    fn abs_diff(a: u32, b: u32) -> u32 { a.abs_diff(b) }
    fn unsigned_shifts(a: u32, b: u32) -> u32 { (a << (b & 31)) ^ (a >> (b % 32)) }
    fn signed_bits(a: i32) -> u32 { a.count_ones() + 100 * a.leading_zeros() + 10000 * a.trailing_zeros() }
    fn signed_order(a: i32, b: i32, c: i32) -> i32 { a.clamp(b.min(c), b.max(c)) }
    fn signed_abs(a: i32) -> i32 { a.max(-2147483647).abs() }
    fn signed_signum(a: i32) -> i32 { a.signum() }
    fn signed_remainder(a: i32, b: i32) -> i32 { if b == 0 || b == -1 { 0 } else { a.rem_euclid(b) } }
    fn signed_quotient(a: i32, b: i32) -> i32 { if b == 0 || b == -1 { 0 } else { a / b + a % b } }
    fn signed_wrapping(a: i32, b: i32) -> i32 { a.wrapping_add(b).wrapping_mul(b).wrapping_sub(a).wrapping_neg() }
    fn signed_abs_diff(a: i32, b: i32) -> u32 { a.abs_diff(b) }
    fn signed_shifts(a: i32, b: u32) -> i32 { (a << (b & 31)) ^ (a >> (b % 32)) }
    fn to_unsigned(x: f32) -> u32 { x as u32 }
    fn to_signed(x: f32) -> i32 { x as i32 }
    fn to_bits(x: f32) -> u32 { x.to_bits() }
    fn comparison(x: f32, y: f32) -> u32 { (x < y) as u32 + 2 * (x <= y) as u32 + 4 * (x == y) as u32 + 8 * (x != y) as u32 }
}

functions! { numbers:
    fn from_unsigned(a: u32) -> f32 { a as f32 }
    fn from_signed(a: i32) -> f32 { a as f32 }
    fn abs(x: f32) -> f32 { x.abs() }
    fn order(x: f32, y: f32, z: f32) -> f32 { x.clamp(y.min(z), y.max(z)) }
    fn signum(x: f32) -> f32 { x.signum() }
    fn copysign(x: f32, y: f32) -> f32 { x.copysign(y) }
    fn floor(x: f32) -> f32 { x.floor() }
    fn ceil(x: f32) -> f32 { x.ceil() }
    fn trunc(x: f32) -> f32 { x.trunc() }
    fn round_ties_even(x: f32) -> f32 { x.round_ties_even() }
    fn fract(x: f32) -> f32 { x.fract() }
    // The quotient is not near a whole number, where the result jumps.
    fn rem_euclid(x: f32, y: f32) -> f32 { (x.clamp(-500.0, 500.0).floor() + 0.25).rem_euclid(y.abs().clamp(0.5, 64.0).ceil() / 2.0) }
    fn sqrt(x: f32) -> f32 { x.abs().sqrt() }
    fn recip(x: f32) -> f32 { x.recip() }
    fn powf(x: f32, y: f32) -> f32 { x.abs().powf(y.clamp(-4.0, 4.0)) }
    fn powf_of_zero(x: f32, y: f32) -> f32 { (x - x).powf(y - y) }
    fn powf_constant(x: f32) -> f32 { x.abs().powf(2.0) + x.abs().powf(0.0) }
    fn exp(x: f32) -> f32 { x.exp() }
    fn exp2(x: f32) -> f32 { x.exp2() }
    fn ln(x: f32) -> f32 { x.abs().ln() }
    fn log2(x: f32) -> f32 { x.abs().log2() }
    fn mul_add(x: f32, y: f32, z: f32) -> f32 { x.clamp(-8.0, 8.0).mul_add(y.clamp(-8.0, 8.0), z.clamp(-8.0, 8.0)) }
    fn sin(x: f32) -> f32 { x.clamp(-3.1, 3.1).sin() }
    fn cos(x: f32) -> f32 { x.clamp(-3.1, 3.1).cos() }
    fn tan(x: f32) -> f32 { x.clamp(-1.5, 1.5).tan() }
    fn asin(x: f32) -> f32 { x.clamp(-1.0, 1.0).asin() }
    fn acos(x: f32) -> f32 { x.clamp(-1.0, 1.0).acos() }
    fn atan(x: f32) -> f32 { x.atan() }
    fn atan2(x: f32, y: f32) -> f32 { if x == 0.0 && y == 0.0 { 0.0 } else { x.atan2(y) } }
    fn sinh(x: f32) -> f32 { x.clamp(-80.0, 80.0).sinh() }
    fn cosh(x: f32) -> f32 { x.cosh() }
    fn tanh(x: f32) -> f32 { x.tanh() }
    fn asinh(x: f32) -> f32 { x.clamp(-1000.0, 1e18).asinh() }
    fn acosh(x: f32) -> f32 { x.abs().clamp(1.0, 1e18).acosh() }
    fn atanh(x: f32) -> f32 { x.clamp(-0.9, 0.9).atanh() }
    fn to_radians(x: f32) -> f32 { x.to_radians() }
    fn to_degrees(x: f32) -> f32 { x.to_degrees() }
}
