//! Fields and elements: attributes of fragments, uniforms, components of vectors, fragments of the list.
//!
//! In: `value.name` or `value[index]`. Out: a typed access; what is read is noted for the function's [`Use`]s.

use fragbuf_model::{Origin, codes};
use syn::spanned::Spanned;

use super::Checker;
use super::mismatch::quoted;
use crate::near;
use crate::tree::{Expr, Kind, Use};
use crate::types::Type;

const COMPONENTS: [&str; 4] = ["x", "y", "z", "w"];

impl Checker<'_, '_, '_> {
    pub(super) fn field(&mut self, field: &syn::ExprField) -> Expr {
        let origin = self.at(field.span());
        let base = self.expr(&field.base, None);
        let place = self.at(field.member.span());
        let name = match &field.member {
            syn::Member::Named(name) => syn::ext::IdentExt::unraw(name).to_string(),
            syn::Member::Unnamed(index) => index.index.to_string(),
        };
        match self.inference.resolve(base.ty) {
            Type::Error => Expr::error(origin),
            Type::Fragment => self.attribute(base, name, origin, &place),
            Type::Uniforms => self.uniform(name, origin, &place),
            Type::Vector(size) => self.component(base, size, name, origin, &place),
            other => {
                let message = format!("{} has no field `{name}`", quoted(self.inference.name(other)));
                let hint = match other {
                    Type::Fragments => "take one fragment first: `fragments[i].depth`, or `for f in fragments`",
                    _ => "fields belong to fragments, uniforms and vectors",
                };
                self.report.error(codes::UNKNOWN_FIELD, &place, message, hint);
                Expr::error(origin)
            }
        }
    }

    fn attribute(&mut self, base: Expr, name: String, origin: Origin, place: &Origin) -> Expr {
        let Some((_, ty)) = self.environment.attributes.iter().find(|(other, _)| *other == name) else {
            let existing: Vec<&str> = self.environment.attributes.iter().map(|(name, _)| name.as_str()).collect();
            let hint = near::hint(&name, &existing);
            self.report.error(codes::UNKNOWN_FIELD, place, format!("a fragment has no attribute `{name}`"), hint);
            return Expr::error(origin);
        };
        self.uses.push(Use::Attribute(name.clone()));
        Expr::new(Kind::Attribute(Box::new(base), name), *ty, origin)
    }

    fn uniform(&mut self, name: String, origin: Origin, place: &Origin) -> Expr {
        let Some((_, ty)) = self.environment.uniforms.iter().find(|(other, _)| *other == name) else {
            let existing: Vec<&str> = self.environment.uniforms.iter().map(|(name, _)| name.as_str()).collect();
            let hint = match existing.is_empty() {
                true => format!("declare it: `uniform {{ {name}: f32 }}`"),
                false => near::hint(&name, &existing),
            };
            self.report.error(codes::UNKNOWN_FIELD, place, format!("there is no uniform `{name}`"), hint);
            return Expr::error(origin);
        };
        self.uses.push(Use::Uniform(name.clone()));
        Expr::new(Kind::Uniform(name), *ty, origin)
    }

    fn component(&mut self, base: Expr, size: u8, name: String, origin: Origin, place: &Origin) -> Expr {
        let exists = |letter: &str| COMPONENTS.iter().take(usize::from(size)).any(|word| *word == letter);
        if exists(&name) {
            return Expr::new(Kind::Components(Box::new(base), name), Type::F32, origin);
        }
        let swizzle = name.len() > 1 && name.chars().all(|letter| "xyzwrgba".contains(letter));
        let hint = match name.as_str() {
            _ if swizzle && name.chars().all(|letter| "xyzw".contains(letter)) => {
                format!("several components at once are a method: `.{name}()`")
            }
            "r" | "g" | "b" | "a" => {
                let index = "rgba".find(&name).unwrap_or(0);
                format!("components are called x, y, z, w: `.{}`", COMPONENTS.get(index).unwrap_or(&"x"))
            }
            _ => format!("a Vec{size} has {}", COMPONENTS.get(..usize::from(size)).unwrap_or_default().join(", ")),
        };
        self.report.error(codes::UNKNOWN_FIELD, place, format!("a Vec{size} has no field `{name}`"), hint);
        Expr::error(origin)
    }

    pub(super) fn index(&mut self, index: &syn::ExprIndex) -> Expr {
        let origin = self.at(index.span());
        let base = self.expr(&index.expr, None);
        let at = self.value(&index.index, Type::Usize);
        match self.inference.resolve(base.ty) {
            Type::Error => Expr::error(origin),
            Type::Fragments => Expr::new(Kind::Layer(Box::new(at)), Type::Fragment, origin),
            Type::Vector(size) => {
                if let Kind::Whole(number) = at.kind {
                    self.require_component(number, size, &at.origin);
                }
                Expr::new(Kind::Element(Box::new(base), Box::new(at)), Type::F32, origin)
            }
            other => {
                let message = format!("{} has no elements", quoted(self.inference.name(other)));
                self.report.error(
                    codes::WRONG_TYPE,
                    &origin,
                    message,
                    "`[i]` belongs to the list of fragments and to vectors",
                );
                Expr::error(origin)
            }
        }
    }

    fn require_component(&mut self, number: u64, size: u8, origin: &Origin) {
        if number >= u64::from(size) {
            let message = format!("a Vec{size} has no element {number}");
            self.report.error(codes::OUT_OF_RANGE, origin, message, format!("elements go from 0 to {}", size - 1));
        }
    }
}
