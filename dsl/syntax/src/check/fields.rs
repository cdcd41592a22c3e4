//! Fields and elements: attributes of fragments, uniforms, components of vectors, fragments of the list.
//!
//! Input: `value.name` or `value[index]`. Output: a typed access, and a [`Use`] of each attribute and uniform.

use fragbuf_model::{SourceSpan, codes};
use syn::spanned::Spanned;

use super::checker::Checker;
use super::declared_names::Place;
use super::given::source_of_operand;
use super::mismatch::quoted;
use super::noted::Noted;
use crate::inspection::NameKind;
use crate::tree::{Expr, Kind, Use};
use crate::types::{Shape, Type};
use crate::{foreign_names, methods};

const COMPONENTS: [&str; 4] = ["x", "y", "z", "w"];

impl Checker<'_, '_, '_> {
    pub(super) fn field(&mut self, field: &syn::ExprField) -> Expr {
        let span = self.at(field.span());
        let base = self.expr(&field.base, None);
        let name_span = self.at(field.member.span());
        let name = match &field.member {
            syn::Member::Named(name) => syn::ext::IdentExt::unraw(name).to_string(),
            syn::Member::Unnamed(index) => index.index.to_string(),
        };
        if self.report.is_placeholder(&name) {
            self.candidates_of(base.ty);
            return Expr::error(span);
        }
        match self.inference.resolve(base.ty) {
            Type::Error => Expr::error(span),
            Type::Fragment => self.attribute(base, name, span, &name_span),
            Type::Uniforms => self.uniform(name, span, &name_span),
            Type::Vector(size) => self.component(base, size, name, span, &name_span),
            other => {
                let message = format!("no field `{name}` on {}", quoted(self.inference.name(other)));
                let help = match other {
                    Type::Fragments if matches!(name.as_str(), "len" | "length" | "count" | "size") => {
                        format!("write `{}.len()`", source_of_operand(&field.base))
                    }
                    Type::Fragments => "select a fragment: `fragments[i].depth`, or `for f in fragments`".to_owned(),
                    other if methods::find(other, &name).is_some() => {
                        let has_parameters = methods::find(other, &name).is_some_and(|row| !row.parameters.is_empty());
                        let arguments = if has_parameters { "…" } else { "" };
                        format!("it is a method: write `{}.{name}({arguments})`", source_of_operand(&field.base))
                    }
                    _ => "only fragments, uniforms and vectors have fields".to_owned(),
                };
                self.report.error(codes::UNKNOWN_FIELD, &name_span, message, help);
                Expr::error(span)
            }
        }
    }

    fn attribute(&mut self, base: Expr, name: String, span: SourceSpan, name_span: &SourceSpan) -> Expr {
        let Some((_, ty)) = self.environment.attributes.iter().find(|(other, _)| *other == name) else {
            if self.environment.incomplete.attributes {
                return self.without_declaration(span);
            }
            let help = self.help_for_name(&name, Place::Attribute);
            self.report.error(codes::UNKNOWN_FIELD, name_span, format!("no attribute `{name}` on a fragment"), help);
            return Expr::error(span);
        };
        self.note(name_span, || Noted::Attribute(name.clone(), *ty));
        self.uses.push(Use::Attribute(name.clone()));
        Expr::new(Kind::Attribute(Box::new(base), name), *ty, span)
    }

    fn uniform(&mut self, name: String, span: SourceSpan, name_span: &SourceSpan) -> Expr {
        let Some((_, ty)) = self.environment.uniforms.iter().find(|(other, _)| *other == name) else {
            if self.environment.incomplete.uniforms {
                return self.without_declaration(span);
            }
            let help = self.help_for_name(&name, Place::Uniform);
            self.report.error(codes::UNKNOWN_FIELD, name_span, format!("cannot find uniform `{name}`"), help);
            return Expr::error(span);
        };
        self.note(name_span, || Noted::Uniform(name.clone(), *ty));
        self.uses.push(match ty {
            Type::Texture(Shape::Image) => Use::Image(name.clone()),
            Type::Texture(_) => Use::Texture(name.clone()),
            _ => Use::Uniform(name.clone()),
        });
        Expr::new(Kind::Uniform(name), *ty, span)
    }

    fn component(&mut self, base: Expr, size: u8, name: String, span: SourceSpan, name_span: &SourceSpan) -> Expr {
        let exists = |letter: &str| COMPONENTS.iter().take(usize::from(size)).any(|component| *component == letter);
        if exists(&name) {
            self.note(name_span, || Noted::Known(NameKind::Component, name.clone(), format!("{name}: f32")));
            return Expr::new(Kind::Components(Box::new(base), name), Type::F32, span);
        }
        let letters = COMPONENTS.get(..usize::from(size)).unwrap_or_default();
        let has_all = |name: &str| name.chars().all(|letter| letters.contains(&letter.to_string().as_str()));
        let help = match (name.len(), foreign_names::swizzle(&name)) {
            (2..=4, _) if has_all(&name) => format!("a swizzle is a method: `.{name}()`"),
            (1, Some(component)) if has_all(&component) => {
                format!("components are named x, y, z, w: `.{component}`")
            }
            (2..=4, Some(swizzle)) if has_all(&swizzle) => {
                format!("components are named x, y, z, w, and a swizzle is a method: `.{swizzle}()`")
            }
            _ => format!("the components of `Vec{size}` are {}", letters.join(", ")),
        };
        self.report.error(codes::UNKNOWN_FIELD, name_span, format!("no field `{name}` on `Vec{size}`"), help);
        Expr::error(span)
    }

    pub(super) fn index(&mut self, index: &syn::ExprIndex) -> Expr {
        let span = self.at(index.span());
        let base = self.expr(&index.expr, None);
        let at = self.value(&index.index, Type::Usize);
        match self.inference.resolve(base.ty) {
            Type::Error => Expr::error(span),
            Type::Fragments => Expr::new(Kind::Layer(Box::new(at)), Type::Fragment, span),
            Type::Vector(size) => {
                if let Kind::Integer(number) = at.kind {
                    self.require_component(number, size, &at.span);
                }
                Expr::new(Kind::Element(Box::new(base), Box::new(at)), Type::F32, span)
            }
            other => {
                let message = format!("cannot index into {}", quoted(self.inference.name(other)));
                let help = "only the list of fragments and vectors can be indexed";
                self.report.error(codes::TYPE_MISMATCH, &span, message, help);
                Expr::error(span)
            }
        }
    }

    fn require_component(&mut self, number: u64, size: u8, span: &SourceSpan) {
        if number >= u64::from(size) {
            let message = format!("index out of bounds: the length is {size} but the index is {number}");
            self.report.error(codes::OUT_OF_RANGE, span, message, format!("use an index from 0 to {}", size - 1));
        }
    }
}
