//! Names: variables, constants, and types as written.
//!
//! In: a path. Out: the variable or constant it names, or the type. Names of functions are in `calls.rs`.

use fragbuf_model::{Origin, codes};
use syn::spanned::Spanned;

use super::Checker;
use crate::constants::{self, Constant};
use crate::near;
use crate::report::Report;
use crate::tree::{Expr, Kind};
use crate::types::Type;

/// The words of a path, `std` and `core` taken off; nothing where it has generics.
pub(super) fn words(path: &syn::Path) -> Option<Vec<String>> {
    let plain = path.segments.iter().all(|segment| segment.arguments.is_empty());
    let mut words: Vec<String> = path.segments.iter().map(|segment| segment.ident.to_string()).collect();
    if words.len() > 1 && words.first().is_some_and(|first| first == "std" || first == "core") {
        words.remove(0);
    }
    (plain && path.leading_colon.is_none()).then_some(words)
}

impl Checker<'_, '_, '_> {
    pub(super) fn path(&mut self, path: &syn::ExprPath) -> Expr {
        let origin = self.at(path.span());
        let Some(words) = words(&path.path).filter(|_| path.qself.is_none()) else {
            let hint = "write the plain name, such as `Vec3::ONE`";
            return self.refuse(origin, "generics are not part of the language", hint);
        };
        match words.as_slice() {
            [name] => self.name(name.trim_start_matches("r#"), origin),
            _ => self.constant(&words, origin),
        }
    }

    fn name(&mut self, name: &str, origin: Origin) -> Expr {
        if let Some(id) = self.lookup(name) {
            let ty = self.variables.get(id).map_or(Type::Error, |variable| variable.kind);
            return Expr::new(Kind::Variable(id), ty, origin);
        }
        if self.environment.helpers.iter().any(|helper| helper.name == name) {
            let message = format!("the function `{name}` is not a value");
            return self.refuse(origin, message, format!("call it: `{name}(…)`"));
        }
        let uniforms = self.variables.iter().any(|variable| variable.kind == Type::Uniforms);
        let hint = match name {
            // The name that every example gives them.
            "u" | "uniforms" if !uniforms && !self.environment.uniforms.is_empty() => {
                format!("name the uniforms as the closure's second parameter: `|f, {name}| …`")
            }
            _ => self.hint_for_name(name),
        };
        self.report.error(codes::UNKNOWN_NAME, &origin, format!("nothing in scope is called `{name}`"), hint);
        Expr::error(origin)
    }

    fn hint_for_name(&self, name: &str) -> String {
        let owner = |parameter: Type| {
            let found = self.variables.iter().find(|variable| variable.kind == parameter && variable.name != "_");
            found.map(|variable| variable.name.clone())
        };
        if self.environment.attributes.iter().any(|(other, _)| other == name) {
            return match owner(Type::Fragment) {
                Some(owner) => format!("it is an attribute: write `{owner}.{name}`"),
                None => format!("it is an attribute: write `f.{name}` for a fragment `f`"),
            };
        }
        if self.environment.uniforms.iter().any(|(other, _)| other == name) {
            return match owner(Type::Uniforms) {
                Some(owner) => format!("it is a uniform: write `{owner}.{name}`"),
                None => format!("it is a uniform: take a second parameter, `|f, u|`, and write `u.{name}`"),
            };
        }
        let mut existing: Vec<&str> = Vec::new();
        for (other, _) in self.scopes.iter().flatten() {
            if !existing.contains(&other.as_str()) {
                existing.push(other);
            }
        }
        if existing.is_empty() { "declare it with `let`".to_string() } else { near::hint(name, &existing) }
    }

    fn constant(&mut self, words: &[String], origin: Origin) -> Expr {
        match constants::find(words) {
            Some(constant) => constant_expr(&constant, origin),
            None => self.unknown_constant(words, origin),
        }
    }

    fn unknown_constant(&mut self, words: &[String], origin: Origin) -> Expr {
        let name = words.join("::");
        if matches!(name.as_str(), "f32::INFINITY" | "f32::NEG_INFINITY" | "f32::NAN") {
            let message = format!("`{name}` does not exist in a shader, which may assume that all numbers are finite");
            let hint = if name.ends_with("NEG_INFINITY") { "use `f32::MIN`" } else { "use `f32::MAX`" };
            return self.refuse(origin, message, hint);
        }
        let hint = match near::nearest(&name, &constants::names()) {
            Some(near) if near.starts_with("f32::consts") => format!("did you mean `std::{near}`?"),
            Some(near) => format!("did you mean `{near}`?"),
            None => "constants are `f32::MAX`, `std::f32::consts::PI`, `Vec3::ZERO` and the like".to_string(),
        };
        self.report.error(codes::UNKNOWN_NAME, &origin, format!("there is no constant `{name}`"), hint);
        Expr::error(origin)
    }
}

fn constant_expr(constant: &Constant, origin: Origin) -> Expr {
    let number = |value: f32| Expr::new(Kind::Float(value), Type::F32, origin.clone());
    match *constant {
        Constant::Float(value) => number(value),
        Constant::U32(value) => Expr::new(Kind::Whole(u64::from(value)), Type::U32, origin),
        Constant::I32(value) => {
            let size = Expr::new(Kind::Whole(u64::from(value.unsigned_abs())), Type::I32, origin.clone());
            if value < 0 { Expr::new(Kind::Negate(Box::new(size)), Type::I32, origin) } else { size }
        }
        Constant::Splat(size, value) => Expr::new(Kind::Vector(vec![number(value)]), Type::Vector(size), origin),
        Constant::Axis(size, axis, value) => {
            let components = (0..size).map(|index| number(if index == axis { value } else { 0.0 })).collect();
            Expr::new(Kind::Vector(components), Type::Vector(size), origin)
        }
    }
}

/// The type that a user wrote.
pub(crate) fn written_type(written: &syn::Type, report: &mut Report) -> Type {
    let origin = report.at(written.span());
    match written {
        syn::Type::Paren(inner) => written_type(&inner.elem, report),
        syn::Type::Group(inner) => written_type(&inner.elem, report),
        syn::Type::Tuple(tuple) if tuple.elems.is_empty() => Type::Unit,
        syn::Type::Path(path) if path.qself.is_none() => match words(&path.path).as_deref() {
            Some([name]) => named_type(name, &origin, report),
            _ => refused_type(&origin, report),
        },
        syn::Type::Reference(_) => {
            let hint = "pass the value itself: all values are copied";
            report.error(codes::UNSUPPORTED, &origin, "references are not part of the language", hint);
            Type::Error
        }
        _ => refused_type(&origin, report),
    }
}

fn refused_type(origin: &Origin, report: &mut Report) -> Type {
    report.error(codes::UNSUPPORTED, origin, "this type is not part of the language", format!("types are {}", list()));
    Type::Error
}

fn named_type(name: &str, origin: &Origin, report: &mut Report) -> Type {
    if let Some(found) = Type::from_rust(name) {
        return found;
    }
    let instead = match name {
        "f64" | "f16" => Some("`f32`"),
        "u8" | "u16" | "u64" | "u128" => Some("`u32`"),
        "i8" | "i16" | "i64" | "i128" | "isize" => Some("`i32`"),
        _ => None,
    };
    let message = format!("the language has no type `{name}`");
    match instead {
        Some(instead) => report.error(codes::UNSUPPORTED, origin, message, format!("use {instead}")),
        None => {
            let names = Type::NAMED.map(|(word, _)| word);
            report.error(codes::UNKNOWN_NAME, origin, message, near::hint(name, &names));
        }
    }
    Type::Error
}

fn list() -> String {
    Type::NAMED.map(|(word, _)| format!("`{word}`")).join(", ")
}
