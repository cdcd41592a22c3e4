//! The methods of the closure language: one row each, with what Rust calls it and how WGSL spells it.
//!
//! Sources: the documentation of `f32`, `u32`, `i32` in std 1.87 and of glam's vectors; WGSL §17.5 for the built-ins.
//! A method whose two meanings differ is either spelled out here so that they agree, or stands in [`REFUSED`] with the
//! way out. "Agrees" leaves NaN and infinities aside: WGSL lets an implementation assume there are none (§15.7).

use crate::types::Type;
use crate::types::Type::{F32, I32, U32, Usize};

/// One method.
#[derive(Debug)]
pub(crate) struct Method {
    /// Receivers that have it.
    pub on: &'static [Type],
    pub name: &'static str,
    /// Parameters after the receiver.
    pub takes: &'static [Slot],
    pub gives: Slot,
    pub wgsl: Spelling,
    /// What to know of its meaning; the rows that say nothing mean the same to the bit or to WGSL's accuracy.
    pub note: &'static str,
}

/// A type in a row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Slot {
    /// The receiver's.
    Own,
    /// This one.
    Is(Type),
}

impl Slot {
    /// The type, for a call on `receiver`.
    pub(crate) fn on(self, receiver: Type) -> Type {
        match self {
            Slot::Own => receiver,
            Slot::Is(kind) => kind,
        }
    }
}

/// How WGSL spells a call.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Spelling {
    /// A built-in function of the same arguments.
    Call(&'static str),
    /// An expression; `$0` is the receiver, `$1` … the arguments, `$T` the receiver's type. An argument that occurs twice
    /// is bound to a name first.
    Text(&'static str),
}

/// The row for a method of this type.
pub(crate) fn find(receiver: Type, name: &str) -> Option<&'static Method> {
    METHODS.iter().find(|row| row.name == name && row.on.contains(&receiver))
}

/// Whether any type has a method of this name.
pub(crate) fn is_method(name: &str) -> bool {
    METHODS.iter().any(|row| row.name == name)
}

/// What a function of the shading languages is called here.
pub(crate) fn of_shaders(name: &str) -> Option<&'static str> {
    OF_SHADERS.iter().find(|(function, _)| *function == name).map(|(_, method)| *method)
}

/// Functions that shader authors reach for, and what stands for them.
const OF_SHADERS: [(&str, &str); 12] = [
    ("mix", "a.lerp(b, t)"),
    ("select", "if condition { a } else { b }"),
    ("saturate", "x.clamp(0.0, 1.0)"),
    ("sign", "x.signum()"),
    ("inversesqrt", "x.sqrt().recip()"),
    ("inverseSqrt", "x.sqrt().recip()"),
    ("pow", "x.powf(y)"),
    ("log", "x.ln()"),
    ("fma", "a.mul_add(b, c)"),
    ("radians", "x.to_radians()"),
    ("degrees", "x.to_degrees()"),
    ("mod", "x.rem_euclid(y)"),
];

/// The methods of this type, in the order of the table.
pub(crate) fn names_on(receiver: Type) -> impl Iterator<Item = &'static str> {
    METHODS.iter().filter(move |row| row.on.contains(&receiver)).map(|row| row.name)
}

/// Why a method that Rust has is not offered, and what to write instead.
pub(crate) fn refusal(receiver: Type, name: &str) -> Option<(&'static str, &'static str)> {
    REFUSED.iter().find(|row| row.1 == name && row.0.contains(&receiver)).map(|row| (row.2, row.3))
}

const V2: Type = Type::Vector(2);
const V3: Type = Type::Vector(3);
const V4: Type = Type::Vector(4);
const FLOAT: &[Type] = &[F32];
const VECTOR: &[Type] = &[V2, V3, V4];
const FLOATS: &[Type] = &[F32, V2, V3, V4];
const WORD: &[Type] = &[U32];
const SIGNED: &[Type] = &[I32];
const WORDS: &[Type] = &[U32, I32];
const COUNTS: &[Type] = &[U32, Usize];
const ORDERED: &[Type] = &[F32, U32, I32, Usize, V2, V3, V4];

const OWN: Slot = Slot::Own;
const F: Slot = Slot::Is(F32);
const U: Slot = Slot::Is(U32);

use Spelling::{Call, Text};

/// Shorthand for a row.
const fn row(
    on: &'static [Type],
    name: &'static str,
    takes: &'static [Slot],
    gives: Slot,
    wgsl: Spelling,
    note: &'static str,
) -> Method {
    Method { on, name, takes, gives, wgsl, note }
}

/// Every method.
#[rustfmt::skip]
pub(crate) const METHODS: &[Method] = &[
    // Size and order.
    row(FLOATS, "abs", &[], OWN, Call("abs"), ""),
    row(SIGNED, "abs", &[], OWN, Call("abs"), "i32::MIN stays itself, as in release builds"),
    row(ORDERED, "min", &[OWN], OWN, Call("min"), ""),
    row(ORDERED, "max", &[OWN], OWN, Call("max"), ""),
    row(ORDERED, "clamp", &[OWN, OWN], OWN, Call("clamp"), "lower bound above upper: Rust panics"),
    row(FLOAT, "signum", &[], OWN, Text("select(1.0, -1.0, (bitcast<u32>($0) >> 31u) == 1u)"), "the bit of the sign: never 0"),
    row(FLOAT, "copysign", &[F], OWN, Text("bitcast<f32>((bitcast<u32>($0) & 0x7fffffffu) | (bitcast<u32>($1) & 0x80000000u))"), ""),
    row(SIGNED, "signum", &[], OWN, Call("sign"), "-1, 0 or 1 in both"),
    // Whole parts.
    row(FLOATS, "floor", &[], OWN, Call("floor"), ""),
    row(FLOATS, "ceil", &[], OWN, Call("ceil"), ""),
    row(FLOATS, "trunc", &[], OWN, Call("trunc"), ""),
    row(FLOAT, "round_ties_even", &[], OWN, Call("round"), ""),
    row(FLOATS, "fract", &[], OWN, Text("$0 - trunc($0)"), "with the sign of the number; WGSL's fract is never negative"),
    row(VECTOR, "fract_gl", &[], OWN, Call("fract"), "x - floor(x)"),
    row(FLOAT, "rem_euclid", &[F], OWN, Text("select($0 % $1, $0 % $1 + abs($1), $0 % $1 < 0.0)"), ""),
    row(SIGNED, "rem_euclid", &[OWN], OWN, Text("select($0 % $1, $0 % $1 + abs($1), $0 % $1 < 0i)"), ""),
    row(WORD, "rem_euclid", &[OWN], OWN, Text("$0 % $1"), ""),
    // Powers.
    row(FLOAT, "sqrt", &[], OWN, Call("sqrt"), "of at least 0"),
    row(FLOATS, "recip", &[], OWN, Text("1.0 / $0"), ""),
    row(FLOAT, "powf", &[F], OWN, Call("pow"), "of at least 0: WGSL has no power of a negative number"),
    row(VECTOR, "powf", &[F], OWN, Text("pow($0, $T($1))"), "of at least 0"),
    row(FLOATS, "exp", &[], OWN, Call("exp"), ""),
    row(FLOAT, "exp2", &[], OWN, Call("exp2"), ""),
    row(FLOAT, "ln", &[], OWN, Call("log"), "of more than 0"),
    row(FLOAT, "log2", &[], OWN, Call("log2"), "of more than 0"),
    row(FLOATS, "mul_add", &[OWN, OWN], OWN, Call("fma"), "WGSL may round between, Rust does not"),
    // Angles.
    row(FLOAT, "sin", &[], OWN, Call("sin"), ""),
    row(FLOAT, "cos", &[], OWN, Call("cos"), ""),
    row(FLOAT, "tan", &[], OWN, Call("tan"), ""),
    row(FLOAT, "asin", &[], OWN, Call("asin"), "of -1 to 1"),
    row(FLOAT, "acos", &[], OWN, Call("acos"), "of -1 to 1"),
    row(FLOAT, "atan", &[], OWN, Call("atan"), ""),
    row(FLOAT, "atan2", &[F], OWN, Call("atan2"), ""),
    row(FLOAT, "sinh", &[], OWN, Call("sinh"), ""),
    row(FLOAT, "cosh", &[], OWN, Call("cosh"), ""),
    row(FLOAT, "tanh", &[], OWN, Call("tanh"), ""),
    row(FLOAT, "asinh", &[], OWN, Call("asinh"), ""),
    row(FLOAT, "acosh", &[], OWN, Call("acosh"), "of at least 1"),
    row(FLOAT, "atanh", &[], OWN, Call("atanh"), "of more than -1, less than 1"),
    row(FLOAT, "to_radians", &[], OWN, Call("radians"), ""),
    row(FLOAT, "to_degrees", &[], OWN, Call("degrees"), ""),
    // Bits.
    row(FLOAT, "to_bits", &[], U, Call("bitcast<u32>"), ""),
    row(WORD, "count_ones", &[], U, Call("countOneBits"), ""),
    row(WORD, "leading_zeros", &[], U, Call("countLeadingZeros"), "32 for 0 in both"),
    row(WORD, "trailing_zeros", &[], U, Call("countTrailingZeros"), "32 for 0 in both"),
    row(WORD, "reverse_bits", &[], U, Call("reverseBits"), ""),
    row(SIGNED, "count_ones", &[], U, Text("u32(countOneBits($0))"), ""),
    row(SIGNED, "leading_zeros", &[], U, Text("u32(countLeadingZeros($0))"), ""),
    row(SIGNED, "trailing_zeros", &[], U, Text("u32(countTrailingZeros($0))"), ""),
    // Whole numbers that wrap or stop.
    row(WORDS, "wrapping_add", &[OWN], OWN, Text("$0 + $1"), "WGSL always wraps"),
    row(WORDS, "wrapping_sub", &[OWN], OWN, Text("$0 - $1"), "WGSL always wraps"),
    row(WORDS, "wrapping_mul", &[OWN], OWN, Text("$0 * $1"), "WGSL always wraps"),
    row(SIGNED, "wrapping_neg", &[], OWN, Text("-$0"), "WGSL always wraps"),
    row(COUNTS, "saturating_sub", &[OWN], OWN, Text("$0 - min($0, $1)"), ""),
    row(WORD, "saturating_add", &[OWN], OWN, Text("$0 + min($1, 4294967295u - $0)"), ""),
    row(COUNTS, "abs_diff", &[OWN], OWN, Text("max($0, $1) - min($0, $1)"), ""),
    row(SIGNED, "abs_diff", &[OWN], U, Text("u32(max($0, $1)) - u32(min($0, $1))"), ""),
    // Vectors.
    row(VECTOR, "dot", &[OWN], F, Call("dot"), ""),
    row(&[V3], "cross", &[OWN], OWN, Call("cross"), ""),
    row(VECTOR, "length", &[], F, Call("length"), ""),
    row(VECTOR, "length_squared", &[], F, Text("dot($0, $0)"), ""),
    row(VECTOR, "normalize", &[], OWN, Call("normalize"), "of a length above 0"),
    row(VECTOR, "distance", &[OWN], F, Call("distance"), ""),
    row(VECTOR, "lerp", &[OWN, F], OWN, Call("mix"), ""),
    row(VECTOR, "reflect", &[OWN], OWN, Call("reflect"), ""),
    row(&[V2], "min_element", &[], F, Text("min($0.x, $0.y)"), ""),
    row(&[V3], "min_element", &[], F, Text("min(min($0.x, $0.y), $0.z)"), ""),
    row(&[V4], "min_element", &[], F, Text("min(min($0.x, $0.y), min($0.z, $0.w))"), ""),
    row(&[V2], "max_element", &[], F, Text("max($0.x, $0.y)"), ""),
    row(&[V3], "max_element", &[], F, Text("max(max($0.x, $0.y), $0.z)"), ""),
    row(&[V4], "max_element", &[], F, Text("max(max($0.x, $0.y), max($0.z, $0.w))"), ""),
    row(&[V2], "element_sum", &[], F, Text("$0.x + $0.y"), ""),
    row(&[V3], "element_sum", &[], F, Text("$0.x + $0.y + $0.z"), ""),
    row(&[V4], "element_sum", &[], F, Text("$0.x + $0.y + $0.z + $0.w"), ""),
    row(&[V2], "element_product", &[], F, Text("$0.x * $0.y"), ""),
    row(&[V3], "element_product", &[], F, Text("$0.x * $0.y * $0.z"), ""),
    row(&[V4], "element_product", &[], F, Text("$0.x * $0.y * $0.z * $0.w"), ""),
    row(&[V2], "extend", &[F], Slot::Is(V3), Text("vec3<f32>($0, $1)"), ""),
    row(&[V3], "extend", &[F], Slot::Is(V4), Text("vec4<f32>($0, $1)"), ""),
    row(&[V3], "truncate", &[], Slot::Is(V2), Text("$0.xy"), ""),
    row(&[V4], "truncate", &[], Slot::Is(V3), Text("$0.xyz"), ""),
];

/// Methods of Rust that are not offered: receivers, name, why, and what to write instead.
#[rustfmt::skip]
pub(crate) const REFUSED: &[(&[Type], &str, &str, &str)] = &[
    (FLOAT, "round", "rounds halves away from zero in Rust and to even in a shader", "write `round_ties_even()`, or `(x + 0.5).floor()`"),
    (VECTOR, "round", "rounds halves away from zero in Rust and to even in a shader", "round the components: `vec2(v.x.round_ties_even(), v.y.round_ties_even())`"),
    (VECTOR, "signum", "is never 0 in Rust and 0 for 0 in a shader", "take the components' signs: `v.x.signum()`"),
    (FLOAT, "powi", "accepts negative numbers in Rust, no power does in a shader", "multiply: `x * x`; or `x.powf(3.0)` where x is at least 0"),
    (FLOAT, "is_nan", "means nothing where a shader may assume that there is no NaN", "test what would make the NaN, before it is made"),
    (FLOAT, "is_finite", "means nothing where a shader may assume that all numbers are finite", "compare with a bound: `x.abs() < 1.0e30`"),
    (FLOAT, "is_infinite", "means nothing where a shader may assume that all numbers are finite", "compare with a bound: `x.abs() > 1.0e30`"),
    (FLOAT, "sin_cos", "gives a pair, which a shader has no value for", "write `x.sin()` and `x.cos()`"),
    (FLOAT, "div_euclid", "has no counterpart in a shader", "write `(x / y).floor()` where y is above 0"),
    (FLOAT, "log10", "has no counterpart in a shader", "write `x.log2() * std::f32::consts::LOG10_2`"),
    (FLOAT, "cbrt", "has no counterpart in a shader", "write `x.abs().powf(1.0 / 3.0) * x.signum()`"),
    (FLOAT, "hypot", "has no counterpart in a shader", "write `vec2(x, y).length()`"),
    (FLOAT, "total_cmp", "gives an ordering, which a shader has no value for", "compare with `<`"),
    (WORDS, "pow", "has no counterpart in a shader", "multiply, or shift: `1u32 << n`"),
    (WORDS, "checked_add", "gives an option, which a shader has no value for", "use `wrapping_add` and compare"),
];

#[cfg(test)]
mod tests {
    use super::METHODS;

    /// The directory of good descriptions shows every row of the table at work.
    #[test]
    fn every_method_is_shown() {
        let shown = concat!(
            include_str!("../tests/good/methods_f32.fragbuf"),
            include_str!("../tests/good/methods_whole.fragbuf"),
            include_str!("../tests/good/methods_vector.fragbuf"),
        );
        let missing: Vec<&str> =
            METHODS.iter().map(|row| row.name).filter(|name| !shown.contains(&format!(".{name}("))).collect();
        assert!(missing.is_empty(), "no good description calls {missing:?}");
    }

    /// No two rows are for the same method of the same type.
    #[test]
    fn every_method_has_one_row() {
        for (index, row) in METHODS.iter().enumerate() {
            for other in METHODS.iter().skip(index + 1) {
                let same = row.name == other.name && row.on.iter().any(|kind| other.on.contains(kind));
                assert!(!same, "{} has two rows", row.name);
            }
        }
    }
}
