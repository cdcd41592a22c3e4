//! Type mismatches, and the fix for each pair of types.
//!
//! Input: a checked expression and the expected type. Output: the expression, or an error expression.

use fragbuf_model::codes;

use super::checker::Checker;
use crate::infer::Inference;
use crate::tree::{Expr, Kind};
use crate::types::Type;

impl Checker<'_, '_, '_> {
    /// Returns the expression if it has this type or can be inferred to have it. Reports a mismatch otherwise.
    pub(super) fn require(&mut self, found: Expr, expected: Type) -> Expr {
        if self.inference.unify(found.ty, expected).is_some() {
            return found;
        }
        self.mismatch(&found, expected);
        Expr::error(found.span)
    }

    fn mismatch(&mut self, found: &Expr, expected: Type) {
        let (found_name, expected_name) = (self.inference.name(found.ty), self.inference.name(expected));
        if found.ty == Type::Unit {
            let message = format!("expected a value of type `{expected_name}`, found none");
            let help = "end it with the value, without `;`";
            self.report.error(codes::MISSING_VALUE, &found.span, message, help);
            return;
        }
        let message = if expected == Type::Unit {
            format!("unused value of type `{found_name}`")
        } else {
            format!("mismatched types: expected {1}, found {0}", quoted(found_name), quoted(expected_name))
        };
        let help = fix(&self.inference, found, expected);
        self.report.error(codes::TYPE_MISMATCH, &found.span, message, help);
    }
}

/// Returns a type name in backticks; a description of a type stays as it is.
pub(super) fn quoted(name: &str) -> String {
    if name.contains(' ') { name.to_string() } else { format!("`{name}`") }
}

/// Returns the help that turns `found` into a value of type `expected`.
pub(super) fn fix(inference: &Inference, found: &Expr, expected: Type) -> String {
    let (ty, expected) = (inference.resolve(found.ty), inference.resolve(expected));
    if let (Kind::Integer(number), Type::F32 | Type::Unknown(_)) = (&found.kind, expected)
        && inference.is_float(expected)
    {
        return format!("write `{number}.0`");
    }
    if let Kind::Float(number) = found.kind
        && inference.is_integer(expected)
        && number.fract() == 0.0
        && number >= 0.0
    {
        return format!("write `{number:.0}`");
    }
    match (ty, expected) {
        (_, Type::Unit) => "end it with `;`, or remove it".to_string(),
        (Type::Bool, Type::F32) => "write `if … { 1.0 } else { 0.0 }`".to_string(),
        (_, Type::Bool) if inference.is_float(ty) => "compare it: `… > 0.0`".to_string(),
        (_, Type::Bool) if inference.is_integer(ty) => "compare it: `… != 0`".to_string(),
        (Type::Vector(_), Type::Bool) => "compare a component: `v.x > 0.0`".to_string(),
        (Type::Bool, _) if inference.is_integer(expected) => format!("convert it: `… as {}`", inference.name(expected)),
        (Type::Vector(4), Type::Vector(3)) => "write `.truncate()` or `.xyz()`".to_string(),
        (Type::Vector(3), Type::Vector(2)) => "write `.truncate()` or `.xy()`".to_string(),
        (Type::Vector(4), Type::Vector(2)) => "write `.xy()`".to_string(),
        (Type::Vector(a), Type::Vector(b)) if a + 1 == b => "append a component: `.extend(1.0)`".to_string(),
        (Type::Vector(_), Type::F32) => "use a component, `.x`, or `.length()`".to_string(),
        (_, Type::Vector(size)) if inference.is_float(ty) => {
            format!("for equal components, write `Vec{size}::splat(…)`")
        }
        (Type::Fragment, _) => "use an attribute, such as `.depth`".to_string(),
        (Type::Fragments, Type::Fragment) => "use one, `fragments[i]`, or iterate: `for f in fragments`".to_string(),
        _ if is_number(inference, ty) && is_number(inference, expected) => {
            let target = if inference.is_float(expected) { "f32" } else { integer(inference, expected) };
            format!("convert it: `… as {target}`")
        }
        _ => format!("write an expression of type {}", quoted(inference.name(expected))),
    }
}

fn is_number(inference: &Inference, ty: Type) -> bool {
    inference.is_integer(ty) || inference.is_float(ty)
}

fn integer(inference: &Inference, ty: Type) -> &'static str {
    inference.resolve_or_default(ty).rust()
}
