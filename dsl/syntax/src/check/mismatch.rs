//! What is said when a value has another type than its place needs, and the way out for each pair of types.
//!
//! In: a checked expression and the type its place needs. Out: the expression, or a mistake in its place.

use fragbuf_model::codes;

use super::Checker;
use crate::infer::Inference;
use crate::tree::{Expr, Kind};
use crate::types::Type;

impl Checker<'_, '_, '_> {
    /// The expression, if it has this type or can still get it.
    pub(super) fn require(&mut self, found: Expr, needed: Type) -> Expr {
        if self.inference.unify(found.ty, needed).is_some() {
            return found;
        }
        self.mismatch(&found, needed);
        Expr::error(found.origin)
    }

    fn mismatch(&mut self, found: &Expr, needed: Type) {
        let (is, wants) = (self.inference.name(found.ty), self.inference.name(needed));
        if found.ty == Type::Unit {
            let message = format!("this gives no value, but one of type `{wants}` is needed");
            let hint = "end it with the value, without `;`";
            self.report.error(codes::MISSING_VALUE, &found.origin, message, hint);
            return;
        }
        let message = if needed == Type::Unit {
            format!("this value of type `{is}` is not used")
        } else {
            format!("this is {}, but {} is needed", quoted(is), quoted(wants))
        };
        let hint = way_out(&self.inference, found, needed);
        self.report.error(codes::WRONG_TYPE, &found.origin, message, hint);
    }
}

/// Type names in code marks, descriptions without.
pub(super) fn quoted(name: &str) -> String {
    if name.contains(' ') { name.to_string() } else { format!("`{name}`") }
}

/// How to get from the type of `found` to `needed`.
pub(super) fn way_out(inference: &Inference, found: &Expr, needed: Type) -> String {
    let (is, needed) = (inference.resolve(found.ty), inference.resolve(needed));
    if let (Kind::Whole(number), Type::F32 | Type::Unknown(_)) = (&found.kind, needed)
        && inference.is_fractional(needed)
    {
        return format!("write `{number}.0`");
    }
    if let Kind::Float(number) = found.kind
        && inference.is_whole(needed)
        && number.fract() == 0.0
        && number >= 0.0
    {
        return format!("write `{number:.0}`");
    }
    match (is, needed) {
        (_, Type::Unit) => "end it with `;`, or leave it out".to_string(),
        (Type::Bool, Type::F32) => "write `if … { 1.0 } else { 0.0 }`".to_string(),
        (_, Type::Bool) if inference.is_fractional(is) => "compare it: `… > 0.0`".to_string(),
        (_, Type::Bool) if inference.is_whole(is) => "compare it: `… != 0`".to_string(),
        (Type::Vector(_), Type::Bool) => "compare a component: `v.x > 0.0`".to_string(),
        (Type::Bool, _) if inference.is_whole(needed) => format!("convert it: `… as {}`", inference.name(needed)),
        (Type::Vector(4), Type::Vector(3)) => "write `.truncate()` or `.xyz()`".to_string(),
        (Type::Vector(3), Type::Vector(2)) => "write `.truncate()` or `.xy()`".to_string(),
        (Type::Vector(4), Type::Vector(2)) => "write `.xy()`".to_string(),
        (Type::Vector(a), Type::Vector(b)) if a + 1 == b => "append a component: `.extend(1.0)`".to_string(),
        (Type::Vector(_), Type::F32) => "take a component, `.x`, or `.length()`".to_string(),
        (_, Type::Vector(size)) if inference.is_fractional(is) => {
            format!("all components alike: `Vec{size}::splat(…)`")
        }
        (Type::Fragment, _) => "take an attribute, such as `.depth`".to_string(),
        (Type::Fragments, Type::Fragment) => {
            "take one, `fragments[i]`, or go through all: `for f in fragments`".to_string()
        }
        _ if is_number(inference, is) && is_number(inference, needed) => {
            let target = if inference.is_fractional(needed) { "f32" } else { integer(inference, needed) };
            format!("convert it: `… as {target}`")
        }
        _ => format!("write an expression of type {}", quoted(inference.name(needed))),
    }
}

fn is_number(inference: &Inference, kind: Type) -> bool {
    inference.is_whole(kind) || inference.is_fractional(kind)
}

fn integer(inference: &Inference, kind: Type) -> &'static str {
    inference.settle(kind).rust()
}
