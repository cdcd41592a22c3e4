//! Methods of textures and images.
//!
//! Input: a call on a texture or image. Output: a typed lookup, or the error with what the language has instead.

use fragbuf_model::{SourceSpan, codes};

use super::checker::Checker;
use super::noted::Noted;
use crate::inspection::NameKind;
use crate::tree::{Expr, Kind};
use crate::types::{Shape, Type};
use crate::unknown_name;

/// A method of textures.
#[derive(Debug)]
pub(crate) struct TextureMethod {
    /// The shapes that have it.
    pub on: &'static [Shape],
    pub name: &'static str,
    pub parameters: &'static [(&'static str, Type)],
    pub result: Type,
    /// What it returns.
    pub about: &'static str,
}

const I: Type = Type::I32;
const TEXEL: Type = Type::Vector(4);
const BORDERS: &str = "a texel; coordinates beyond the border are those of the nearest texel";

/// Every method.
pub(crate) const TEXTURE_METHODS: &[TextureMethod] = &[
    method(&[Shape::D2], "load", &[("x", I), ("y", I)], TEXEL, BORDERS),
    method(&[Shape::D3], "load", &[("x", I), ("y", I), ("z", I)], TEXEL, BORDERS),
    method(
        &[Shape::D2],
        "sample",
        &[("at", Type::Vector(2))],
        TEXEL,
        "linear between texels; (0, 0) is the corner before the first texel, (1, 1) that after the last",
    ),
    method(&[Shape::D3], "sample", &[("at", Type::Vector(3))], TEXEL, "linear between texels, in all three directions"),
    method(&[Shape::D2], "sample_nearest", &[("at", Type::Vector(2))], TEXEL, "the texel at a place from 0 to 1"),
    method(&[Shape::D3], "sample_nearest", &[("at", Type::Vector(3))], TEXEL, "the texel at a place from 0 to 1"),
    method(
        &[Shape::Image],
        "at",
        &[("dx", I), ("dy", I)],
        TEXEL,
        "the value of the pixel dx to the right and dy below; beyond the border, that of the nearest pixel",
    ),
    method(&[Shape::D2, Shape::D3, Shape::Image], "width", &[], Type::U32, "the number of columns"),
    method(&[Shape::D2, Shape::D3, Shape::Image], "height", &[], Type::U32, "the number of rows"),
    method(&[Shape::D3], "depth", &[], Type::U32, "the number of slices"),
];

const fn method(
    on: &'static [Shape],
    name: &'static str,
    parameters: &'static [(&'static str, Type)],
    result: Type,
    about: &'static str,
) -> TextureMethod {
    TextureMethod { on, name, parameters, result, about }
}

impl TextureMethod {
    /// Returns the methods of a shape.
    pub(crate) fn of(shape: Shape) -> impl Iterator<Item = &'static TextureMethod> {
        TEXTURE_METHODS.iter().filter(move |method| method.on.contains(&shape))
    }

    /// Returns the signature without the receiver, `load(x: i32, y: i32) -> Vec4`.
    pub(crate) fn signature(&self) -> String {
        let parameters = self.parameters.iter().map(|(name, ty)| format!("{name}: {}", ty.rust()));
        let parameters: Vec<String> = parameters.collect();
        format!("{}({}) -> {}", self.name, parameters.join(", "), self.result.rust())
    }
}

impl Checker<'_, '_, '_> {
    /// Checks a call on a texture; `receiver` is the field that names it.
    pub(super) fn texture_method(
        &mut self,
        (receiver, shape): (&Expr, Shape),
        call: &syn::ExprMethodCall,
        span: SourceSpan,
        name_span: &SourceSpan,
    ) -> Expr {
        let name = call.method.to_string();
        let Some(method) = TextureMethod::of(shape).find(|method| method.name == name) else {
            for argument in &call.args {
                self.expr(argument, None);
            }
            let of = Type::Texture(shape).rust();
            let message = format!("no method `{name}` for `{of}`");
            self.report.error(codes::UNKNOWN_METHOD, name_span, message, instead(&name, shape));
            return Expr::error(span);
        };
        self.note(name_span, || Noted::Known(NameKind::Method, name.clone(), format!("fn {}", method.signature())));
        self.require_count(&name, method.parameters.len(), call.args.len(), &span);
        let parameters = call.args.iter().zip(method.parameters);
        let arguments = parameters.map(|(argument, (_, ty))| self.value(argument, *ty)).collect();
        match &receiver.kind {
            Kind::Uniform(texture) => {
                Expr::new(Kind::Lookup(shape, texture.clone(), method.name, arguments), method.result, span)
            }
            _ => Expr::error(span),
        }
    }
}

/// Returns what a texture has instead of a method of another language.
fn instead(name: &str, shape: Shape) -> String {
    let known: Vec<&str> = TextureMethod::of(shape).map(|method| method.name).collect();
    let of_shape = |name: &str| TextureMethod::of(shape).find(|method| method.name == name);
    let other = match name {
        "texture" | "texture_lod" | "sample_level" | "sample_lod" | "sample_linear" | "get" => "sample",
        "texel_fetch" | "fetch" | "texel" | "read" | "pixel" => "load",
        "size" | "dimensions" => "width",
        _ => name,
    };
    let other =
        if shape == Shape::Image && ["load", "sample", "sample_nearest"].contains(&other) { "at" } else { other };
    match of_shape(other).filter(|_| other != name) {
        Some(method) => format!("write `{}`", method.signature()),
        None => unknown_name::help(name, &known),
    }
}
