//! The methods of the closure language: a table with the Rust name and the WGSL expression of each.
//!
//! Sources: the documentation of `f32`, `u32`, `i32` in std 1.87 and of glam's vectors; WGSL §17.5 for the built-ins.
//! If the WGSL built-in differs from the Rust method, the table has an equivalent expression, or [`UNSUPPORTED`] lists the
//! method with a replacement. NaN and infinities are ignored: a WGSL implementation may assume there are none (§15.7).

use crate::types::Type;
use crate::types::Type::{F32, I32, U32, Usize};

/// One method.
#[derive(Debug)]
pub(crate) struct Method {
    /// The receiver types.
    pub on: &'static [Type],
    pub name: &'static str,
    /// Parameters after the receiver.
    pub parameters: &'static [MethodType],
    pub result: MethodType,
    pub wgsl: Spelling,
    /// A remark on differences. If empty, both results are equal, to the bit or within WGSL's accuracy.
    pub note: &'static str,
}

/// The type of a parameter or result of a method.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum MethodType {
    /// The type of the receiver.
    Receiver,
    /// A fixed type.
    Fixed(Type),
}

impl MethodType {
    /// Returns the type for a call on `receiver`.
    pub(crate) fn on(self, receiver: Type) -> Type {
        match self {
            MethodType::Receiver => receiver,
            MethodType::Fixed(ty) => ty,
        }
    }
}

/// The WGSL expression of a method call.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Spelling {
    /// A built-in function with the same arguments.
    Call(&'static str),
    /// An expression; `$0` is the receiver, `$1` … the arguments, `$T` the receiver's type. An argument that occurs twice
    /// is bound to a name first.
    Template(&'static str),
    /// Two such expressions: one for calls whose `$1` is a constant other than 0, and one for all other calls.
    ByZero { nonzero: &'static str, other: &'static str },
}

/// Returns the row of a method of this type.
pub(crate) fn find(receiver: Type, name: &str) -> Option<&'static Method> {
    METHODS.iter().find(|row| row.name == name && row.on.contains(&receiver))
}

/// Returns whether any type has a method of this name.
pub(crate) fn is_method(name: &str) -> bool {
    METHODS.iter().any(|row| row.name == name)
}

/// Returns the types that have a method of this name.
pub(crate) fn receivers(name: &str) -> impl Iterator<Item = Type> {
    METHODS.iter().filter(move |row| row.name == name).flat_map(|row| row.on.iter().copied())
}

/// Returns the names of the methods of this type, in the order of the table.
pub(crate) fn names_on(receiver: Type) -> impl Iterator<Item = &'static str> {
    METHODS.iter().filter(move |row| row.on.contains(&receiver)).map(|row| row.name)
}

/// Returns why a method of Rust is not supported, and what to write instead.
pub(crate) fn unsupported(receiver: Type, name: &str) -> Option<(&'static str, &'static str)> {
    UNSUPPORTED.iter().find(|row| row.1 == name && row.0.contains(&receiver)).map(|row| (row.2, row.3))
}

const V2: Type = Type::Vector(2);
const V3: Type = Type::Vector(3);
const V4: Type = Type::Vector(4);
const FLOAT: &[Type] = &[F32];
const VECTOR: &[Type] = &[V2, V3, V4];
const FLOATS: &[Type] = &[F32, V2, V3, V4];
const UNSIGNED: &[Type] = &[U32];
const SIGNED: &[Type] = &[I32];
const INTEGERS: &[Type] = &[U32, I32];
const COUNTS: &[Type] = &[U32, Usize];
const ORDERED: &[Type] = &[F32, U32, I32, Usize, V2, V3, V4];

const SELF: MethodType = MethodType::Receiver;
const F: MethodType = MethodType::Fixed(F32);
const U: MethodType = MethodType::Fixed(U32);

use Spelling::{ByZero, Call, Template};

/// Returns a row.
const fn row(
    on: &'static [Type],
    name: &'static str,
    parameters: &'static [MethodType],
    result: MethodType,
    wgsl: Spelling,
    note: &'static str,
) -> Method {
    Method { on, name, parameters, result, wgsl, note }
}

/// Every method.
#[rustfmt::skip]
pub(crate) const METHODS: &[Method] = &[
    // Size and order.
    row(FLOATS, "abs", &[], SELF, Call("abs"), ""),
    row(SIGNED, "abs", &[], SELF, Call("abs"), "i32::MIN stays itself, as in release builds"),
    row(ORDERED, "min", &[SELF], SELF, Call("min"), "of 0.0 and -0.0: either"),
    row(ORDERED, "max", &[SELF], SELF, Call("max"), "of 0.0 and -0.0: either"),
    row(ORDERED, "clamp", &[SELF, SELF], SELF, Call("clamp"), "lower bound above upper: Rust panics"),
    row(FLOAT, "signum", &[], SELF, Template("select(1.0, -1.0, (bitcast<u32>($0) >> 31u) == 1u)"), "by the sign bit: never 0"),
    row(FLOAT, "copysign", &[F], SELF, Template("bitcast<f32>((bitcast<u32>($0) & 0x7fffffffu) | (bitcast<u32>($1) & 0x80000000u))"), ""),
    row(SIGNED, "signum", &[], SELF, Call("sign"), "-1, 0 or 1 in both"),
    // Integer parts.
    row(FLOATS, "floor", &[], SELF, Call("floor"), ""),
    row(FLOATS, "ceil", &[], SELF, Call("ceil"), ""),
    row(FLOATS, "trunc", &[], SELF, Call("trunc"), ""),
    row(FLOAT, "round_ties_even", &[], SELF, Call("round"), ""),
    row(FLOATS, "fract", &[], SELF, Template("$0 - trunc($0)"), "with the sign of the number; WGSL's fract is never negative"),
    row(VECTOR, "fract_gl", &[], SELF, Call("fract"), "x - floor(x)"),
    row(FLOAT, "rem_euclid", &[F], SELF, Template("select($0 % $1, $0 % $1 + abs($1), $0 % $1 < 0.0)"), "WGSL rounds the quotient: near a multiple of the divisor, 0 or the divisor"),
    row(SIGNED, "rem_euclid", &[SELF], SELF, Template("select($0 % $1, $0 % $1 + abs($1), $0 % $1 < 0i)"), ""),
    row(UNSIGNED, "rem_euclid", &[SELF], SELF, Template("$0 % $1"), ""),
    // Powers.
    row(FLOAT, "sqrt", &[], SELF, Call("sqrt"), "of at least 0"),
    row(FLOATS, "recip", &[], SELF, Template("1.0 / $0"), ""),
    row(FLOAT, "powf", &[F], SELF, ByZero { nonzero: "pow($0, $1)", other: "select(pow($0, $1), 1.0, $1 == 0.0)" }, "of at least 0: WGSL has no power of a negative number, and no negative power of 0"),
    row(VECTOR, "powf", &[F], SELF, ByZero { nonzero: "pow($0, $T($1))", other: "select(pow($0, $T($1)), $T(1.0), $1 == 0.0)" }, "of at least 0, and of more than 0 for a negative power"),
    row(FLOATS, "exp", &[], SELF, Call("exp"), ""),
    row(FLOAT, "exp2", &[], SELF, Call("exp2"), ""),
    row(FLOAT, "ln", &[], SELF, Call("log"), "of more than 0"),
    row(FLOAT, "log2", &[], SELF, Call("log2"), "of more than 0"),
    row(FLOATS, "mul_add", &[SELF, SELF], SELF, Call("fma"), "WGSL may round between, Rust does not"),
    // Angles.
    row(FLOAT, "sin", &[], SELF, Call("sin"), "accurate from -π to π"),
    row(FLOAT, "cos", &[], SELF, Call("cos"), "accurate from -π to π"),
    row(FLOAT, "tan", &[], SELF, Call("tan"), "accurate from -π to π"),
    row(FLOAT, "asin", &[], SELF, Call("asin"), "of -1 to 1"),
    row(FLOAT, "acos", &[], SELF, Call("acos"), "of -1 to 1"),
    row(FLOAT, "atan", &[], SELF, Call("atan"), ""),
    row(FLOAT, "atan2", &[F], SELF, Call("atan2"), "not of 0 and 0: undefined on some devices"),
    row(FLOAT, "sinh", &[], SELF, Call("sinh"), "of -88 to 88"),
    row(FLOAT, "cosh", &[], SELF, Call("cosh"), "of -88 to 88"),
    row(FLOAT, "tanh", &[], SELF, Template("tanh(clamp($0, -16.0, 16.0))"), "1 beyond 16 in both; tanh of large numbers is NaN on some devices"),
    row(FLOAT, "asinh", &[], SELF, Call("asinh"), "of -1e19 to 1e19; WGSL allows large errors below -1000"),
    row(FLOAT, "acosh", &[], SELF, Call("acosh"), "of 1 to 1e19"),
    row(FLOAT, "atanh", &[], SELF, Call("atanh"), "of more than -1, less than 1"),
    row(FLOAT, "to_radians", &[], SELF, Call("radians"), ""),
    row(FLOAT, "to_degrees", &[], SELF, Call("degrees"), ""),
    // Bits.
    row(FLOAT, "to_bits", &[], U, Call("bitcast<u32>"), ""),
    row(UNSIGNED, "count_ones", &[], U, Call("countOneBits"), ""),
    row(UNSIGNED, "leading_zeros", &[], U, Call("countLeadingZeros"), "32 for 0 in both"),
    row(UNSIGNED, "trailing_zeros", &[], U, Call("countTrailingZeros"), "32 for 0 in both"),
    row(UNSIGNED, "reverse_bits", &[], U, Call("reverseBits"), ""),
    row(SIGNED, "count_ones", &[], U, Template("u32(countOneBits($0))"), ""),
    row(SIGNED, "leading_zeros", &[], U, Template("u32(countLeadingZeros($0))"), ""),
    row(SIGNED, "trailing_zeros", &[], U, Template("u32(countTrailingZeros($0))"), ""),
    // Integers that wrap or saturate.
    row(INTEGERS, "wrapping_add", &[SELF], SELF, Template("$0 + $1"), "WGSL always wraps"),
    row(INTEGERS, "wrapping_sub", &[SELF], SELF, Template("$0 - $1"), "WGSL always wraps"),
    row(INTEGERS, "wrapping_mul", &[SELF], SELF, Template("$0 * $1"), "WGSL always wraps"),
    row(SIGNED, "wrapping_neg", &[], SELF, Template("-$0"), "WGSL always wraps"),
    row(COUNTS, "saturating_sub", &[SELF], SELF, Template("$0 - min($0, $1)"), ""),
    row(UNSIGNED, "saturating_add", &[SELF], SELF, Template("$0 + min($1, 4294967295u - $0)"), ""),
    row(COUNTS, "abs_diff", &[SELF], SELF, Template("max($0, $1) - min($0, $1)"), ""),
    row(SIGNED, "abs_diff", &[SELF], U, Template("u32(max($0, $1)) - u32(min($0, $1))"), ""),
    // Vectors.
    row(VECTOR, "dot", &[SELF], F, Call("dot"), ""),
    row(&[V3], "cross", &[SELF], SELF, Call("cross"), ""),
    row(VECTOR, "length", &[], F, Call("length"), ""),
    row(VECTOR, "length_squared", &[], F, Template("dot($0, $0)"), ""),
    row(VECTOR, "normalize", &[], SELF, Call("normalize"), "of a length above 0"),
    row(VECTOR, "distance", &[SELF], F, Call("distance"), ""),
    row(VECTOR, "lerp", &[SELF, F], SELF, Call("mix"), ""),
    row(VECTOR, "reflect", &[SELF], SELF, Call("reflect"), ""),
    row(&[V2], "min_element", &[], F, Template("min($0.x, $0.y)"), ""),
    row(&[V3], "min_element", &[], F, Template("min(min($0.x, $0.y), $0.z)"), ""),
    row(&[V4], "min_element", &[], F, Template("min(min($0.x, $0.y), min($0.z, $0.w))"), ""),
    row(&[V2], "max_element", &[], F, Template("max($0.x, $0.y)"), ""),
    row(&[V3], "max_element", &[], F, Template("max(max($0.x, $0.y), $0.z)"), ""),
    row(&[V4], "max_element", &[], F, Template("max(max($0.x, $0.y), max($0.z, $0.w))"), ""),
    row(&[V2], "element_sum", &[], F, Template("$0.x + $0.y"), ""),
    row(&[V3], "element_sum", &[], F, Template("$0.x + $0.y + $0.z"), ""),
    row(&[V4], "element_sum", &[], F, Template("$0.x + $0.y + $0.z + $0.w"), ""),
    row(&[V2], "element_product", &[], F, Template("$0.x * $0.y"), ""),
    row(&[V3], "element_product", &[], F, Template("$0.x * $0.y * $0.z"), ""),
    row(&[V4], "element_product", &[], F, Template("$0.x * $0.y * $0.z * $0.w"), ""),
    row(&[V2], "extend", &[F], MethodType::Fixed(V3), Template("vec3<f32>($0, $1)"), ""),
    row(&[V3], "extend", &[F], MethodType::Fixed(V4), Template("vec4<f32>($0, $1)"), ""),
    row(&[V3], "truncate", &[], MethodType::Fixed(V2), Template("$0.xy"), ""),
    row(&[V4], "truncate", &[], MethodType::Fixed(V3), Template("$0.xyz"), ""),
];

/// Methods of Rust that are not supported: receivers, name, why, and what to write instead.
#[rustfmt::skip]
pub(crate) const UNSUPPORTED: &[(&[Type], &str, &str, &str)] = &[
    (FLOAT, "round", "rounds halves away from zero in Rust and to even in a shader", "write `round_ties_even()`, or `(x + 0.5).floor()`"),
    (VECTOR, "round", "rounds halves away from zero in Rust and to even in a shader", "round each component: `vec2(v.x.round_ties_even(), v.y.round_ties_even())`"),
    (VECTOR, "signum", "is never 0 in Rust and 0 for 0 in a shader", "use the sign of each component: `v.x.signum()`"),
    (FLOAT, "powi", "accepts negative numbers in Rust, but no power function of a shader does", "multiply: `x * x`; or `x.powf(3.0)` where x is at least 0"),
    (FLOAT, "is_nan", "is not supported: a shader may assume that there is no NaN", "test the operands before the operation that would produce NaN"),
    (FLOAT, "is_finite", "is not supported: a shader may assume that all numbers are finite", "compare with a bound: `x.abs() < 1.0e30`"),
    (FLOAT, "is_infinite", "is not supported: a shader may assume that all numbers are finite", "compare with a bound: `x.abs() > 1.0e30`"),
    (FLOAT, "sin_cos", "returns a pair, which shaders do not have", "write `x.sin()` and `x.cos()`"),
    (FLOAT, "div_euclid", "has no equivalent in a shader", "write `(x / y).floor()` where y is above 0"),
    (FLOAT, "log10", "has no equivalent in a shader", "write `x.log2() * std::f32::consts::LOG10_2`"),
    (FLOAT, "cbrt", "has no equivalent in a shader", "write `x.abs().powf(1.0 / 3.0) * x.signum()`"),
    (FLOAT, "hypot", "has no equivalent in a shader", "write `vec2(x, y).length()`"),
    (FLOAT, "total_cmp", "returns an `Ordering`, which shaders do not have", "compare with `<`"),
    (INTEGERS, "pow", "has no equivalent in a shader", "multiply, or shift: `1u32 << n`"),
    (INTEGERS, "checked_add", "returns an `Option`, which shaders do not have", "use `wrapping_add` and compare"),
];

#[cfg(test)]
mod tests {
    use super::METHODS;

    /// The good descriptions call every method of the table.
    #[test]
    fn every_method_is_called() {
        let source = concat!(
            include_str!("../tests/good/methods_f32.fragbuf"),
            include_str!("../tests/good/methods_whole.fragbuf"),
            include_str!("../tests/good/methods_vector.fragbuf"),
        );
        let missing: Vec<&str> =
            METHODS.iter().map(|row| row.name).filter(|name| !source.contains(&format!(".{name}("))).collect();
        assert!(missing.is_empty(), "no good description calls {missing:?}");
    }

    /// No two rows have the same method of the same type.
    #[test]
    fn every_method_has_one_row() {
        for (index, row) in METHODS.iter().enumerate() {
            for other in METHODS.iter().skip(index + 1) {
                let same = row.name == other.name && row.on.iter().any(|ty| other.on.contains(ty));
                assert!(!same, "{} has two rows", row.name);
            }
        }
    }
}
