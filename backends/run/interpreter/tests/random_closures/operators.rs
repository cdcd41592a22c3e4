//! Literals, constants, operators and casts of the evaluator.

use std::cmp::Ordering;

use super::range::{ROUNDED, Range, Undefined};
use super::types::Type;
use super::value::Value;

/// Where Rust panics and devices have results.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Panics {
    /// An overflow, or a shift past the width: only builds with overflow checks panic.
    pub in_debug: bool,
    /// A division by zero, or of the least number by -1.
    pub always: bool,
}

/// Returns the value of a literal.
pub fn literal(literal: &syn::Lit) -> Result<Value, Undefined> {
    match literal {
        syn::Lit::Bool(value) => Ok(Value::Bool(value.value)),
        syn::Lit::Float(value) => {
            let value: f32 = value.base10_digits().parse().map_err(|_| Undefined::Gap("a malformed float"))?;
            Ok(Value::Float(Range::of(value)))
        }
        syn::Lit::Int(value) => {
            let integer =
                Value::Literal(value.base10_parse::<i128>().map_err(|_| Undefined::Gap("a malformed integer"))?);
            Ok(Type::named(value.suffix()).map_or(integer.clone(), |ty| integer.typed(ty)))
        }
        _ => Err(Undefined::Gap("an unknown literal")),
    }
}

/// Returns the value of an integer literal after `-`: the least `i32` has no positive counterpart.
pub fn negative_literal(unary: &syn::ExprUnary) -> Option<Value> {
    let (syn::UnOp::Neg(_), syn::Expr::Lit(syn::ExprLit { lit: syn::Lit::Int(value), .. })) = (&unary.op, &*unary.expr)
    else {
        return None;
    };
    let integer = Value::Literal(-value.base10_parse::<i128>().ok()?);
    Some(Type::named(value.suffix()).map_or(integer.clone(), |ty| integer.typed(ty)))
}

/// Returns the value of a constant's path.
pub fn constant(path: &syn::Path) -> Result<Value, Undefined> {
    let names: Vec<String> = path.segments.iter().map(|segment| segment.ident.to_string()).collect();
    let names: Vec<&str> = names.iter().map(String::as_str).filter(|name| *name != "std").collect();
    let float = |value: f32| Ok(Value::Float(Range::of(value)));
    let splat = |name: &str, value: f32| {
        let size = usize::from(name.as_bytes()[3] - b'0');
        Ok(Value::Vector(vec![Range::of(value); size]))
    };
    match names.as_slice() {
        ["u32", "MAX"] => Ok(Value::U32(u32::MAX)),
        ["i32", "MAX"] => Ok(Value::I32(i32::MAX)),
        ["i32", "MIN"] => Ok(Value::I32(i32::MIN)),
        ["f32", "MAX"] => float(f32::MAX),
        ["f32", "EPSILON"] => float(f32::EPSILON),
        ["f32", "consts", "PI"] => float(std::f32::consts::PI),
        [vector, "ONE"] => splat(vector, 1.0),
        [vector, "ZERO"] => splat(vector, 0.0),
        [vector, "NEG_ONE"] => splat(vector, -1.0),
        _ => Err(Undefined::Gap("an unknown constant")),
    }
}

/// Applies `-` or `!`.
pub fn unary(operator: &syn::UnOp, value: Value, panics: &mut Panics) -> Result<Value, Undefined> {
    Ok(match (operator, value) {
        (syn::UnOp::Neg(_), Value::Literal(value)) => Value::Literal(-value),
        (syn::UnOp::Neg(_), Value::I32(value)) => {
            panics.in_debug |= value == i32::MIN;
            Value::I32(value.wrapping_neg())
        }
        (syn::UnOp::Neg(_), Value::Float(range)) => Value::Float(range.negate()),
        (syn::UnOp::Neg(_), Value::Vector(parts)) => Value::Vector(parts.into_iter().map(Range::negate).collect()),
        (syn::UnOp::Not(_), Value::Bool(value)) => Value::Bool(!value),
        (syn::UnOp::Not(_), Value::U32(value)) => Value::U32(!value),
        (syn::UnOp::Not(_), Value::I32(value)) => Value::I32(!value),
        _ => return Err(Undefined::Gap("an unknown unary operator")),
    })
}

/// The operators with two operands. The last six compare.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Operator {
    Add,
    Subtract,
    Multiply,
    Divide,
    Remainder,
    And,
    Or,
    Xor,
    Left,
    Right,
    Equal,
    NotEqual,
    Less,
    LessEqual,
    Greater,
    GreaterEqual,
}

/// Returns the operator of a compound assignment.
pub fn compound(token: &syn::BinOp) -> Option<Operator> {
    Some(match token {
        syn::BinOp::AddAssign(_) => Operator::Add,
        syn::BinOp::SubAssign(_) => Operator::Subtract,
        syn::BinOp::MulAssign(_) => Operator::Multiply,
        syn::BinOp::DivAssign(_) => Operator::Divide,
        syn::BinOp::RemAssign(_) => Operator::Remainder,
        syn::BinOp::BitAndAssign(_) => Operator::And,
        syn::BinOp::BitOrAssign(_) => Operator::Or,
        syn::BinOp::BitXorAssign(_) => Operator::Xor,
        syn::BinOp::ShlAssign(_) => Operator::Left,
        syn::BinOp::ShrAssign(_) => Operator::Right,
        _ => return None,
    })
}

/// Returns the operator of an expression that evaluates both operands.
pub fn simple(token: &syn::BinOp) -> Option<Operator> {
    Some(match token {
        syn::BinOp::Add(_) => Operator::Add,
        syn::BinOp::Sub(_) => Operator::Subtract,
        syn::BinOp::Mul(_) => Operator::Multiply,
        syn::BinOp::Div(_) => Operator::Divide,
        syn::BinOp::Rem(_) => Operator::Remainder,
        syn::BinOp::BitAnd(_) => Operator::And,
        syn::BinOp::BitOr(_) => Operator::Or,
        syn::BinOp::BitXor(_) => Operator::Xor,
        syn::BinOp::Shl(_) => Operator::Left,
        syn::BinOp::Shr(_) => Operator::Right,
        syn::BinOp::Eq(_) => Operator::Equal,
        syn::BinOp::Ne(_) => Operator::NotEqual,
        syn::BinOp::Lt(_) => Operator::Less,
        syn::BinOp::Le(_) => Operator::LessEqual,
        syn::BinOp::Gt(_) => Operator::Greater,
        syn::BinOp::Ge(_) => Operator::GreaterEqual,
        _ => return None,
    })
}

/// Applies an operator.
pub fn binary(operator: Operator, left: Value, right: Value, panics: &mut Panics) -> Result<Value, Undefined> {
    if matches!(operator, Operator::Left | Operator::Right) {
        return shift(operator, left, &right, panics);
    }
    let (left, right) = (left.clone().like(&right), right.like(&left));
    match (&left, &right) {
        (Value::Bool(a), Value::Bool(b)) => Ok(Value::Bool(match operator {
            Operator::And => a & b,
            Operator::Or => a | b,
            Operator::Xor | Operator::NotEqual => a ^ b,
            Operator::Equal => a == b,
            _ => return Err(Undefined::Gap("an unknown operator of bool")),
        })),
        (Value::Float(_) | Value::Vector(_), _) | (_, Value::Vector(_)) => floats(operator, &left, &right),
        _ => integers(operator, &left, &right, panics),
    }
}

fn floats(operator: Operator, left: &Value, right: &Value) -> Result<Value, Undefined> {
    if let (Value::Float(a), Value::Float(b)) = (left, right)
        && let Some(holds) = compared(operator, || a.compare(*b))
    {
        return holds.map(Value::Bool);
    }
    let (a, b) = (left.parts()?, right.parts()?);
    let size = a.len().max(b.len());
    let parts = (0..size).map(|at| {
        let (a, b) = (a[at.min(a.len() - 1)], b[at.min(b.len() - 1)]);
        match operator {
            Operator::Add => a.add(b),
            Operator::Subtract => a.subtract(b),
            Operator::Multiply => a.multiply(b),
            Operator::Divide => a.divide(b),
            // glam's `Vec4` rounds the quotient down where the processor has SIMD instructions.
            Operator::Remainder if size == 4 && a.divide(b)?.lo < 0.0 => {
                Err(Undefined::Open("the remainder of a negative `Vec4`"))
            }
            Operator::Remainder => a.remainder(b),
            _ => Err(Undefined::Gap("an unknown operator of floats")),
        }
    });
    let parts = parts.collect::<Result<Vec<Range>, Undefined>>()?;
    let is_vector = matches!((left, right), (Value::Vector(_), _) | (_, Value::Vector(_)));
    Ok(if is_vector { Value::Vector(parts) } else { Value::Float(parts[0]) })
}

/// Returns the result of a comparison, or `None` for another operator.
fn compared(
    operator: Operator,
    order: impl FnOnce() -> Result<Ordering, Undefined>,
) -> Option<Result<bool, Undefined>> {
    let holds: fn(Ordering) -> bool = match operator {
        Operator::Equal => Ordering::is_eq,
        Operator::NotEqual => Ordering::is_ne,
        Operator::Less => Ordering::is_lt,
        Operator::LessEqual => Ordering::is_le,
        Operator::Greater => Ordering::is_gt,
        Operator::GreaterEqual => Ordering::is_ge,
        _ => return None,
    };
    Some(order().map(holds))
}

fn integers(operator: Operator, left: &Value, right: &Value, panics: &mut Panics) -> Result<Value, Undefined> {
    let (a, b) = (left.integer()?, right.integer()?);
    if let Some(holds) = compared(operator, || Ok(a.cmp(&b))) {
        return holds.map(Value::Bool);
    }
    let exact = match operator {
        Operator::Add => a + b,
        Operator::Subtract => a - b,
        Operator::Multiply => a * b,
        Operator::Divide | Operator::Remainder if b == 0 => {
            panics.always = true;
            if operator == Operator::Divide { a } else { 0 }
        }
        Operator::Divide => a / b,
        Operator::Remainder => {
            // As the quotient, the remainder of the least number by -1 panics.
            panics.always |= wrapped(left, a / b)?.1;
            a % b
        }
        Operator::And => a & b,
        Operator::Or => a | b,
        _ => a ^ b,
    };
    let (value, overflows) = wrapped(left, exact)?;
    match operator {
        Operator::Divide | Operator::Remainder => panics.always |= overflows,
        _ => panics.in_debug |= overflows,
    }
    Ok(value)
}

/// Wraps an exact result to the type of `like`; returns whether it does not fit.
pub fn wrapped(like: &Value, exact: i128) -> Result<(Value, bool), Undefined> {
    let value = match like {
        Value::U32(_) => Value::U32(exact as u32),
        Value::Usize(_) if !(0..=i128::from(u32::MAX)).contains(&exact) => {
            return Err(Undefined::Open("a `usize` that needs 64 bits"));
        }
        Value::Usize(_) => Value::Usize(exact as u64),
        _ => Value::I32(exact as i32),
    };
    let overflows = value.integer()? != exact;
    Ok((value, overflows))
}

fn shift(operator: Operator, left: Value, right: &Value, panics: &mut Panics) -> Result<Value, Undefined> {
    let count = right.integer()?;
    panics.in_debug |= !(0..32).contains(&count);
    let count = (count & 31) as u32;
    Ok(match (left, operator) {
        (Value::U32(value), Operator::Left) => Value::U32(value << count),
        (Value::U32(value), _) => Value::U32(value >> count),
        (Value::I32(value), Operator::Left) => Value::I32(value << count),
        (Value::I32(value), _) => Value::I32(value >> count),
        _ => return Err(Undefined::Gap("a shift of an unknown type")),
    })
}

/// Casts a number.
pub fn cast(value: Value, to: Type) -> Result<Value, Undefined> {
    match (value, to) {
        (Value::Float(range), Type::F32) => Ok(Value::Float(range)),
        (Value::Float(range), _) => {
            let (lo, hi) = (range.lo.trunc(), range.hi.trunc());
            let (least, greatest) =
                if to == Type::I32 { (f64::from(i32::MIN), f64::from(i32::MAX)) } else { (0.0, f64::from(u32::MAX)) };
            let (lo, hi) = (lo.clamp(least, greatest), hi.clamp(least, greatest));
            if lo != hi {
                return Err(Undefined::Open("a cast of a float near a whole number"));
            }
            Ok(Value::Literal(lo as i128).typed(to))
        }
        (Value::Bool(value), _) => Ok(Value::Literal(value.into()).typed(to)),
        (value, Type::F32) => {
            let value = value.integer()? as f64;
            Ok(Value::Float(Range::rounded(value, value, true)?))
        }
        (value, _) => Ok(wrapped(&Value::Literal(0).typed(to), value.integer()?)?.0),
    }
}

/// Returns the expression inside of parentheses.
pub fn without_parens(mut expr: &syn::Expr) -> &syn::Expr {
    while let syn::Expr::Paren(inner) = expr {
        expr = &inner.expr;
    }
    expr
}

/// The relative error of one operation, doubled.
pub const TWICE_ROUNDED: f64 = 2.0 * ROUNDED;
