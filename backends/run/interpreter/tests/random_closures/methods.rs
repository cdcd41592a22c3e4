//! Methods of the evaluator, with the errors that WGSL allows, and the domains that `fragbuf language` states.

use super::evaluator::component;
use super::operators::{Operator, Panics, TWICE_ROUNDED, binary, wrapped};
use super::range::{ROUNDED, Range, Undefined};
use super::value::Value;

/// The error of angles and hyperbolic functions: relative, and absolute.
const LOOSE: f64 = 1.0 / 1024.0;

/// Calls a method.
pub fn call(name: &str, receiver: Value, arguments: Vec<Value>, panics: &mut Panics) -> Result<Value, Undefined> {
    let arguments: Vec<Value> = arguments.into_iter().map(|argument| argument.like(&receiver)).collect();
    match &receiver {
        Value::Float(x) => float(name, *x, &arguments),
        Value::Vector(parts) => vector(name, parts, &arguments),
        _ => integer(name, &receiver, &arguments, panics),
    }
}

/// Returns the float of a word, if devices keep it.
pub fn from_bits(word: &Value) -> Result<Value, Undefined> {
    let value = f32::from_bits(word.integer()? as u32);
    if value.is_finite() { Ok(Value::Float(Range::of(value))) } else { Err(Undefined::Open("not a finite number")) }
}

fn integer(name: &str, receiver: &Value, arguments: &[Value], panics: &mut Panics) -> Result<Value, Undefined> {
    let x = receiver.integer()?;
    let word = x as u32;
    let argument = |at: usize| arguments.get(at).map_or(Err(Undefined::Gap("a missing argument")), Value::integer);
    let typed = |exact: i128| Ok(wrapped(receiver, exact)?.0);
    let overflowing = |exact: i128, panics: &mut Panics| {
        let (value, overflows) = wrapped(receiver, exact)?;
        panics.in_debug |= overflows;
        Ok(value)
    };
    match name {
        "abs" => overflowing(x.abs(), panics),
        "min" => typed(x.min(argument(0)?)),
        "max" => typed(x.max(argument(0)?)),
        "clamp" if argument(0)? > argument(1)? => Err(Undefined::Open("a clamp whose lower bound is above the upper")),
        "clamp" => typed(x.clamp(argument(0)?, argument(1)?)),
        "signum" => typed(x.signum()),
        "rem_euclid" => {
            let remainder = binary(Operator::Remainder, receiver.clone(), arguments[0].clone(), panics)?.integer()?;
            typed(if remainder < 0 { remainder + argument(0)?.abs() } else { remainder })
        }
        "count_ones" => Ok(Value::U32(word.count_ones())),
        "leading_zeros" => Ok(Value::U32(word.leading_zeros())),
        "trailing_zeros" => Ok(Value::U32(word.trailing_zeros())),
        "reverse_bits" => Ok(Value::U32(word.reverse_bits())),
        "wrapping_add" => typed(x + argument(0)?),
        "wrapping_sub" => typed(x - argument(0)?),
        "wrapping_mul" => typed(x * argument(0)?),
        "wrapping_neg" => typed(-x),
        "saturating_sub" => typed((x - argument(0)?).max(0)),
        "saturating_add" => typed((x + argument(0)?).min(u32::MAX.into())),
        "abs_diff" => {
            let difference = (x - argument(0)?).abs();
            Ok(match receiver {
                Value::Usize(_) => Value::Usize(difference as u64),
                _ => Value::U32(difference as u32),
            })
        }
        _ => Err(Undefined::Gap("an unknown method of integers")),
    }
}

fn float(name: &str, x: Range, arguments: &[Value]) -> Result<Value, Undefined> {
    let y = || arguments.first().map_or(Err(Undefined::Gap("a missing argument")), Value::float);
    match name {
        "to_bits" => match x.exact() {
            Some(value) if value != 0.0 => Ok(Value::U32((value as f32).to_bits())),
            _ => Err(Undefined::Open("the bits of a number with errors")),
        },
        "abs" | "min" | "max" | "clamp" | "floor" | "ceil" | "trunc" | "fract" | "recip" | "exp" | "mul_add" => {
            let parts: Vec<Vec<Range>> = arguments.iter().map(Value::parts).collect::<Result<_, _>>()?;
            let others: Vec<Range> = parts.iter().map(|parts| parts[0]).collect();
            component_wise(name, x, &others)
        }
        .map(Value::Float),
        "rem_euclid" => {
            let remainder = x.remainder(y()?)?;
            let divisor = y()?.abs();
            match remainder.sign()? < 0.0 {
                true => remainder.add(divisor),
                false => Ok(remainder),
            }
            .map(Value::Float)
        }
        "copysign" => {
            let size = x.abs();
            Ok(Value::Float(if y()?.sign()? < 0.0 { size.negate() } else { size }))
        }
        "signum" => Ok(Value::Float(Range::of(x.sign()? as f32))),
        "powf" => power(x, y()?).map(Value::Float),
        "atan2" => angle_of(x, y()?).map(Value::Float),
        _ => function(name, x).map(Value::Float),
    }
}

/// Calls a function of one float.
fn function(name: &str, x: Range) -> Result<Range, Undefined> {
    let angle = std::f64::consts::PI;
    match name {
        "round_ties_even" => Ok(x.whole(f64::round_ties_even)),
        "sqrt" => x.within(0.0, f64::MAX)?.rising(f64::sqrt, 8.0 * ROUNDED, 0.0),
        "exp2" => x.within(-100.0, 100.0)?.rising(f64::exp2, (4.0 + x.abs().hi) * 4.0 * ROUNDED, 0.0),
        "ln" => x.within(1e-37, f64::MAX)?.rising(f64::ln, 4.0 * ROUNDED, 1e-6),
        "log2" => x.within(1e-37, f64::MAX)?.rising(f64::log2, 4.0 * ROUNDED, 1e-6),
        "sin" => extrema(x.within(-angle, angle)?, f64::sin),
        "cos" => extrema(x.within(-angle, angle)?, f64::cos),
        "tan" => {
            let x = x.within(-1.5, 1.5)?;
            x.rising(f64::tan, LOOSE * (1.0 + x.rising(f64::tan, 0.0, 0.0)?.abs().hi), LOOSE)
        }
        "asin" => x.within(-1.0, 1.0)?.rising(f64::asin, LOOSE, LOOSE),
        "acos" => Ok(x.within(-1.0, 1.0)?.negate().rising(f64::acos_of_negative, LOOSE, LOOSE)?),
        "atan" => x.rising(f64::atan, LOOSE, LOOSE),
        "sinh" => x.within(-80.0, 80.0)?.rising(f64::sinh, LOOSE, LOOSE),
        "cosh" => x.within(-80.0, 80.0)?.abs().rising(f64::cosh, LOOSE, LOOSE),
        "tanh" => x.rising(f64::tanh, LOOSE, LOOSE),
        "asinh" => x.within(-1000.0, 1e18)?.rising(f64::asinh, LOOSE, LOOSE),
        "acosh" => x.within(1.0, 1e18)?.rising(f64::acosh, LOOSE, 4.0 * LOOSE),
        "atanh" => x.within(-0.9, 0.9)?.rising(f64::atanh, LOOSE, LOOSE),
        "to_radians" => x.rising(f64::to_radians, 4.0 * ROUNDED, 0.0),
        "to_degrees" => x.rising(f64::to_degrees, 4.0 * ROUNDED, 0.0),
        _ => Err(Undefined::Gap("an unknown method of floats")),
    }
}

/// The function `x ↦ acos(-x)`, which never decreases.
trait Negated {
    fn acos_of_negative(self) -> Self;
}

impl Negated for f64 {
    fn acos_of_negative(self) -> f64 {
        (-self).acos()
    }
}

/// Applies the sine or cosine to a short range: the results are near those of the ends.
fn extrema(x: Range, function: fn(f64) -> f64) -> Result<Range, Undefined> {
    let width = x.hi - x.lo;
    if width > 0.01 {
        return Err(Undefined::Open("an angle with a large error"));
    }
    let (first, last) = (function(x.lo), function(x.hi));
    Range::with_errors(first.min(last), first.max(last), 0.0, LOOSE + width)
}

/// Returns a power, which devices compute from a logarithm.
fn power(x: Range, y: Range) -> Result<Range, Undefined> {
    if y.exact() == Some(0.0) {
        x.within(0.0, f64::MAX)?;
        return Ok(Range::of(1.0));
    }
    if x.exact() == Some(0.0) && y.lo > 0.0 {
        return Range::with_errors(0.0, 0.0, 0.0, 0.0);
    }
    let x = x.within(1e-30, 1e30)?;
    let y = y.within(-20.0, 20.0)?;
    let exponents = [x.lo.log2() * y.lo, x.lo.log2() * y.hi, x.hi.log2() * y.lo, x.hi.log2() * y.hi];
    let (lo, hi) = (exponents.into_iter().fold(f64::MAX, f64::min), exponents.into_iter().fold(f64::MIN, f64::max));
    let size = lo.abs().max(hi.abs());
    if size > 120.0 {
        return Err(Undefined::Open("a power near the limits"));
    }
    Range::with_errors(lo.exp2(), hi.exp2(), (16.0 + 8.0 * size + 8.0 * y.abs().hi) * ROUNDED, 0.0)
}

fn angle_of(y: Range, x: Range) -> Result<Range, Undefined> {
    // The angle jumps on the negative axis and is undefined at 0.
    if y.lo <= 0.0 && y.hi >= 0.0 && x.lo <= 1e-30 {
        return Err(Undefined::Open("an angle on the negative axis"));
    }
    if x.lo <= 0.0 && x.hi >= 0.0 && y.abs().lo < 1e-30 {
        return Err(Undefined::Open("an angle near 0"));
    }
    y.within(-1e30, 1e30)?;
    x.within(-1e30, 1e30)?;
    let corners = [y.lo.atan2(x.lo), y.lo.atan2(x.hi), y.hi.atan2(x.lo), y.hi.atan2(x.hi)];
    let (lo, hi) = (corners.into_iter().fold(f64::MAX, f64::min), corners.into_iter().fold(f64::MIN, f64::max));
    Range::with_errors(lo, hi, LOOSE, LOOSE)
}

/// Calls a method that glam applies to each component.
fn component_wise(name: &str, x: Range, others: &[Range]) -> Result<Range, Undefined> {
    let other = |at: usize| others.get(at).copied().ok_or(Undefined::Gap("a missing argument"));
    match name {
        "abs" => Ok(x.abs()),
        "min" => Ok(x.min(other(0)?)),
        "max" => Ok(x.max(other(0)?)),
        "clamp" if other(0)?.hi > other(1)?.lo => {
            Err(Undefined::Open("a clamp whose lower bound may be above the upper"))
        }
        "clamp" => Ok(x.max(other(0)?).min(other(1)?)),
        "floor" => Ok(x.whole(f64::floor)),
        "ceil" => Ok(x.whole(f64::ceil)),
        "trunc" => Ok(x.whole(f64::trunc)),
        "fract" => without(x, f64::trunc),
        "fract_gl" => without(x, f64::floor),
        "recip" => Range::of(1.0).divide(x),
        "exp" => x.within(-80.0, 80.0)?.rising(f64::exp, (4.0 + 2.0 * x.abs().hi) * 2.0 * ROUNDED, 0.0),
        "mul_add" => {
            let (product, added) = (x.multiply(other(0)?)?, other(1)?);
            product.add(added)
        }
        _ => Err(Undefined::Gap("an unknown method of vectors")),
    }
}

/// Returns a number without its whole part, if errors do not change that part.
fn without(x: Range, whole: fn(f64) -> f64) -> Result<Range, Undefined> {
    let part = whole(x.lo);
    if part != whole(x.hi) {
        return Err(Undefined::Open("the fraction of a number near a whole number"));
    }
    // Devices may return 1 for a negative number near 0.
    let fraction = Range::between(x.lo - part, x.hi - part);
    if fraction.hi > 0.999_999 {
        return Err(Undefined::Open("a fraction near 1"));
    }
    Range::rounded(fraction.lo, fraction.hi, true)
}

fn vector(name: &str, x: &[Range], arguments: &[Value]) -> Result<Value, Undefined> {
    if name.len() > 1 && name.chars().all(|letter| "xyzw".contains(letter)) {
        let parts = name.chars().map(|letter| Ok(x[component(&letter.to_string())?]));
        return Ok(Value::Vector(parts.collect::<Result<_, Undefined>>()?));
    }
    let others: Vec<Vec<Range>> = arguments.iter().map(Value::parts).collect::<Result<_, _>>()?;
    let scalar = || others.first().and_then(|other| other.first()).copied().ok_or(Undefined::Gap("a missing argument"));
    let other = || others.first().ok_or(Undefined::Gap("a missing argument"));
    let fold = |function: fn(Range, Range) -> Result<Range, Undefined>| {
        x.iter().skip(1).try_fold(x[0], |total, part| function(total, *part)).map(Value::Float)
    };
    match name {
        "dot" => dot(x, other()?).map(Value::Float),
        "length_squared" => dot(x, x).map(Value::Float),
        "length" => length(x).map(Value::Float),
        "distance" => length(&each(x, other()?, Range::subtract)?).map(Value::Float),
        "normalize" => normalize(x).map(Value::Vector),
        "cross" => cross(x, other()?).map(Value::Vector),
        "lerp" => lerp(x, other()?, others[1][0]).map(Value::Vector),
        "reflect" => reflect(x, other()?).map(Value::Vector),
        "min_element" => fold(|total, part| Ok(total.min(part))),
        "max_element" => fold(|total, part| Ok(total.max(part))),
        "element_sum" => fold(Range::add),
        "element_product" => fold(Range::multiply),
        "extend" => Ok(Value::Vector(x.iter().copied().chain([scalar()?]).collect())),
        "truncate" => Ok(Value::Vector(x[..x.len() - 1].to_vec())),
        "powf" => {
            let exponent = scalar()?;
            Ok(Value::Vector(x.iter().map(|part| power(*part, exponent)).collect::<Result<_, _>>()?))
        }
        _ => {
            let parts = x.iter().enumerate().map(|(at, part)| {
                let others: Vec<Range> = others.iter().map(|other| other[at]).collect();
                component_wise(name, *part, &others)
            });
            Ok(Value::Vector(parts.collect::<Result<_, _>>()?))
        }
    }
}

type Pair = fn(Range, Range) -> Result<Range, Undefined>;

fn each(x: &[Range], y: &[Range], function: Pair) -> Result<Vec<Range>, Undefined> {
    x.iter().zip(y).map(|(x, y)| function(*x, *y)).collect()
}

/// Returns the dot product. Its error is relative to the sum of the absolute products.
fn dot(x: &[Range], y: &[Range]) -> Result<Range, Undefined> {
    let products = each(x, y, Range::multiply)?;
    let size: f64 = products.iter().map(|product| product.scale()).sum();
    let (lo, hi) = products.iter().fold((0.0, 0.0), |(lo, hi), product| (lo + product.lo, hi + product.hi));
    Range::with_errors(lo, hi, 0.0, size * 4.0 * TWICE_ROUNDED)
}

fn length(x: &[Range]) -> Result<Range, Undefined> {
    let square = dot(x, x)?;
    let square = Range::between(square.lo.max(0.0), square.hi);
    // A square below the least normal number may be replaced by 0.
    square.rising(f64::sqrt, 16.0 * ROUNDED, 1e-18)
}

fn normalize(x: &[Range]) -> Result<Vec<Range>, Undefined> {
    let length = length(x)?.within(1e-12, 1e15)?;
    x.iter()
        .map(|part| {
            let quotient = part.divide(length)?;
            Range::with_errors(quotient.lo, quotient.hi, 16.0 * ROUNDED, 16.0 * ROUNDED)
        })
        .collect()
}

fn cross(x: &[Range], y: &[Range]) -> Result<Vec<Range>, Undefined> {
    let part = |a: usize, b: usize| x[a].multiply(y[b])?.subtract(x[b].multiply(y[a])?);
    Ok(vec![part(1, 2)?, part(2, 0)?, part(0, 1)?])
}

/// Returns the mixture: glam and WGSL may use different formulas.
fn lerp(x: &[Range], y: &[Range], t: Range) -> Result<Vec<Range>, Undefined> {
    let rest = Range::of(1.0).subtract(t)?;
    let formulas = |(x, y): (&Range, &Range)| {
        let weighted = x.multiply(rest)?.add(y.multiply(t)?)?;
        let stepped = x.add(y.subtract(*x)?.multiply(t)?)?;
        Ok(weighted.hull(stepped))
    };
    x.iter().zip(y).map(formulas).collect()
}

fn reflect(x: &[Range], normal: &[Range]) -> Result<Vec<Range>, Undefined> {
    let twice = dot(x, normal)?.multiply(Range::of(2.0))?;
    x.iter().zip(normal).map(|(x, normal)| x.subtract(normal.multiply(twice)?)).collect()
}
