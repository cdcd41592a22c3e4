//! Names of variables and constants.
//!
//! Input: a path. Output: the variable or constant that it names. Names of functions are in `calls.rs`.

use fragbuf_model::{SourceSpan, codes, nearest_name};
use syn::spanned::Spanned;

use super::checker::Checker;
use super::declared_names::Place;
use super::noted::Noted;
use super::written_types::segments;
use crate::constants::{self, Constant};
use crate::foreign_names;
use crate::inspection::NameKind;
use crate::tree::{Expr, Kind};
use crate::types::Type;

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
        if self.report.is_placeholder(name) {
            self.candidates_for_value();
            return Expr::error(span);
        }
        if let Some(id) = self.lookup(name) {
            self.count_read(id);
            self.note(&span, || Noted::Variable(id));
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
        let help = foreign_names::value(name).unwrap_or_else(|| self.help_for_name(name, Place::Value));
        self.report.error(codes::UNKNOWN_NAME, &span, format!("cannot find value `{name}` in this scope"), help);
        Expr::error(span)
    }

    fn constant(&mut self, path: &[String], span: SourceSpan) -> Expr {
        match constants::find(path) {
            Some(constant) => {
                let signature = || format!("const {}: {}", path.join("::"), constant.rust());
                self.note(&span, || Noted::Known(NameKind::Constant, path.join("::"), signature()));
                constant_expr(&constant, span)
            }
            None if path.last().is_some_and(|name| self.report.is_placeholder(name)) => {
                self.candidates_in(path);
                Expr::error(span)
            }
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
