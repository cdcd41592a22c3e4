//! Names of variables and constants.
//!
//! Input: a path. Output: the variable or constant that it names. Names of functions are in `calls.rs`.

use fragbuf_model::{SourceSpan, codes, nearest_name};
use syn::spanned::Spanned;

use super::checker::Checker;
use super::written_types::segments;
use crate::constants::{self, Constant};
use crate::tree::{Expr, Kind};
use crate::types::Type;
use crate::{foreign_names, unknown_name};

impl Checker<'_, '_, '_> {
    pub(super) fn path(&mut self, path: &syn::ExprPath) -> Expr {
        let span = self.at(path.span());
        let Some(path) = segments(&path.path).filter(|_| path.qself.is_none()) else {
            let help = "write the plain name, such as `Vec3::ONE`";
            return self.unsupported(span, "generics are not supported", help);
        };
        match path.as_slice() {
            [name] => self.name(name.trim_start_matches("r#"), span),
            _ => self.constant(&path, span),
        }
    }

    fn name(&mut self, name: &str, span: SourceSpan) -> Expr {
        if let Some(id) = self.lookup(name) {
            self.count_read(id);
            let ty = self.variables.get(id).map_or(Type::Error, |variable| variable.ty);
            return Expr::new(Kind::Variable(id), ty, span);
        }
        if self.environment.helpers.iter().any(|helper| helper.name == name) {
            let message = format!("the function `{name}` is not a value");
            return self.unsupported(span, message, format!("call it: `{name}(…)`"));
        }
        if self.environment.constants.iter().any(|constant| constant == name) {
            return self.without_declaration(span);
        }
        let uniforms = self.variables.iter().any(|variable| variable.ty == Type::Uniforms);
        let help = match name {
            // The names that the examples use.
            "u" | "uniforms" if !uniforms && !self.environment.uniforms.is_empty() => {
                format!("declare the uniforms as the closure's second parameter: `|f, {name}| …`")
            }
            _ => foreign_names::value(name).unwrap_or_else(|| self.help_for_name(name)),
        };
        self.report.error(codes::UNKNOWN_NAME, &span, format!("cannot find value `{name}` in this scope"), help);
        Expr::error(span)
    }

    fn help_for_name(&self, name: &str) -> String {
        let owner = |parameter: Type| {
            let found = self.variables.iter().find(|variable| variable.ty == parameter && variable.name != "_");
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
                None => format!("it is a uniform: add a second parameter, `|f, u|`, and write `u.{name}`"),
            };
        }
        let mut existing: Vec<&str> = Vec::new();
        for (other, _) in self.scopes.iter().flatten() {
            if !existing.contains(&other.as_str()) {
                existing.push(other);
            }
        }
        if existing.is_empty() { "declare it with `let`".to_string() } else { unknown_name::help(name, &existing) }
    }

    fn constant(&mut self, path: &[String], span: SourceSpan) -> Expr {
        match constants::find(path) {
            Some(constant) => constant_expr(&constant, span),
            None => self.unknown_constant(path, span),
        }
    }

    fn unknown_constant(&mut self, path: &[String], span: SourceSpan) -> Expr {
        let name = path.join("::");
        if matches!(name.as_str(), "f32::INFINITY" | "f32::NEG_INFINITY" | "f32::NAN") {
            let message = format!("`{name}` is not supported: a shader may assume that all numbers are finite");
            let help = if name.ends_with("NEG_INFINITY") { "use `f32::MIN`" } else { "use `f32::MAX`" };
            return self.unsupported(span, message, help);
        }
        let help = match nearest_name(&name, &constants::names()) {
            Some(nearest) if nearest.starts_with("f32::consts") => format!("did you mean `std::{nearest}`?"),
            Some(nearest) => format!("did you mean `{nearest}`?"),
            None => "constants are `f32::MAX`, `std::f32::consts::PI`, `Vec3::ZERO` and others".to_string(),
        };
        self.report.error(codes::UNKNOWN_NAME, &span, format!("cannot find constant `{name}`"), help);
        Expr::error(span)
    }
}

fn constant_expr(constant: &Constant, span: SourceSpan) -> Expr {
    let number = |value: f32| Expr::new(Kind::Float(value), Type::F32, span.clone());
    match *constant {
        Constant::Float(value) => number(value),
        Constant::U32(value) => Expr::new(Kind::Integer(u64::from(value)), Type::U32, span),
        Constant::I32(value) => {
            let size = Expr::new(Kind::Integer(u64::from(value.unsigned_abs())), Type::I32, span.clone());
            if value < 0 { Expr::new(Kind::Negate(Box::new(size)), Type::I32, span) } else { size }
        }
        Constant::Splat(size, value) => Expr::new(Kind::Vector(vec![number(value)]), Type::Vector(size), span),
        Constant::Axis(size, axis, value) => {
            let components = (0..size).map(|index| number(if index == axis { value } else { 0.0 })).collect();
            Expr::new(Kind::Vector(components), Type::Vector(size), span)
        }
    }
}
