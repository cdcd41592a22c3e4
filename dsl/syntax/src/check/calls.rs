//! Calls: helper functions, constructors of vectors, and rows of the method table.
//!
//! Input: a call. Output: a typed call with the right number of arguments. As in Rust, a method call on a number needs a
//! known type: `2.0_f32.sqrt()`.

use fragbuf_model::{Diagnostic, SourceSpan, codes, nearest_name};
use syn::spanned::Spanned;

use super::checker::Checker;
use super::given::{given, source_of_generics};
use super::mismatch::quoted;
use super::noted::{Noted, signature_of_constructor};
use super::swizzles;
use super::written_types::segments;
use crate::foreign_functions::{self, Given};
use crate::inspection::NameKind;
use crate::methods::{self, Spelling};
use crate::tree::{Expr, Kind, Use};
use crate::types::Type;
use crate::{foreign_names, unknown_name};

/// The functions of the language.
pub(super) const CONSTRUCTORS: [&str; 7] =
    ["vec2", "vec3", "vec4", "Vec2::splat", "Vec3::splat", "Vec4::splat", "f32::from_bits"];

type Arguments = syn::punctuated::Punctuated<syn::Expr, syn::Token![,]>;

impl Checker<'_, '_, '_> {
    pub(super) fn call(&mut self, call: &syn::ExprCall) -> Expr {
        let span = self.at(call.span());
        let path = match &*call.func {
            syn::Expr::Path(path) if path.qself.is_none() => segments(&path.path),
            _ => None,
        };
        let Some(path) = path else {
            let help = "call a helper `fn` or a method by its name";
            return self.unsupported(span, "only named functions can be called", help);
        };
        let name_span = self.at(call.func.span());
        if path.last().is_some_and(|name| self.report.is_placeholder(name)) {
            match path.len() {
                1 => self.candidates_for_value(),
                _ => self.candidates_in(&path),
            }
            return Expr::error(span);
        }
        let path: Vec<&str> = path.iter().map(String::as_str).collect();
        if self.is_constructor(&path) {
            let name = path.join("::");
            let signature = signature_of_constructor(&name);
            self.note(&name_span, || Noted::Known(NameKind::Function, name, signature));
        }
        match path.as_slice() {
            [name] if self.shadows_function(name) => {
                let message = format!("the variable `{name}` shadows the function `{name}`");
                self.unsupported(span, message, "rename one of them")
            }
            ["vec2"] => self.vector(2, &call.args, span),
            ["vec3"] => self.vector(3, &call.args, span),
            ["vec4"] => self.vector(4, &call.args, span),
            [name] => self.helper_call(name, &call.args, span, &name_span),
            [owner, name] => self.associated(owner, name, &call.args, span, &name_span),
            _ => self.unknown_function(&path.join("::"), &call.args, span, &name_span),
        }
    }

    fn is_constructor(&self, path: &[&str]) -> bool {
        let is_vector = matches!(path, [owner, "new"] if matches!(Type::from_rust(owner), Some(Type::Vector(_))));
        self.report.has_names() && (is_vector || CONSTRUCTORS.contains(&path.join("::").as_str()))
    }

    fn shadows_function(&self, name: &str) -> bool {
        let function = self.environment.helpers.iter().any(|helper| helper.name == name);
        (function || matches!(name, "vec2" | "vec3" | "vec4")) && self.lookup(name).is_some()
    }

    fn vector(&mut self, size: u8, arguments: &Arguments, span: SourceSpan) -> Expr {
        if usize::from(size) == arguments.len() {
            let components = arguments.iter().map(|argument| self.value(argument, Type::F32)).collect();
            return Expr::new(Kind::Vector(components), Type::Vector(size), span);
        }
        // Other languages construct a vector from others.
        let given: Vec<Given> = arguments.iter().map(|argument| self.given(argument)).collect();
        let (message, help) = argument_count(&format!("vec{size}"), usize::from(size), arguments.len());
        let help = foreign_functions::vector(size, &given).unwrap_or(help);
        self.report.error(codes::ARGUMENT_COUNT, &span, message, help);
        Expr::new(Kind::Error, Type::Vector(size), span)
    }

    /// Returns the declaration that a variable needs as the receiver of a method, if it is declared with a literal: `max(m, f.depth)` is
    /// `m.max(f.depth)`. Its other uses are not reported.
    fn typed_receiver(&mut self, checked: &[Expr], given: &[Given]) -> String {
        let has_float = given.iter().any(|argument| argument.ty == Type::F32 || argument.ty_is_vector());
        let ty = if has_float { Type::F32 } else { Type::U32 };
        let Some(receiver) = checked.first() else { return String::new() };
        let Some(declaration) = self.typed_declaration(receiver, ty) else { return String::new() };
        self.ignore(receiver);
        format!(", and give the variable its type: `{declaration}`")
    }

    /// Checks an argument of a call that is not of the language.
    fn given(&mut self, argument: &syn::Expr) -> Given {
        let checked = self.expr(argument, None);
        self.given_of(argument, &checked)
    }

    /// Returns an argument that is checked.
    fn given_of(&self, argument: &syn::Expr, checked: &Expr) -> Given {
        let ty = self.inference.resolve_or_default(checked.ty);
        let is_literal =
            matches!(self.inference.resolve(checked.ty), Type::Unknown(_)) && matches!(argument, syn::Expr::Lit(_));
        given(argument, ty, is_literal)
    }

    fn helper_call(&mut self, name: &str, arguments: &Arguments, span: SourceSpan, name_span: &SourceSpan) -> Expr {
        let environment = self.environment;
        let Some(index) = environment.helpers.iter().position(|helper| helper.name == name) else {
            return self.unknown_function(name, arguments, span, name_span);
        };
        let Some(helper) = environment.helpers.get(index) else { return Expr::error(span) };
        self.note(name_span, || Noted::Helper(index));
        self.uses.push(Use::Helper(index, span.clone()));
        if arguments.len() != helper.parameters.len() {
            let (message, help) = argument_count(name, helper.parameters.len(), arguments.len());
            let diagnostic = Diagnostic::new(codes::ARGUMENT_COUNT, &span, message, help);
            self.report.push(diagnostic.label(&helper.span, "declared here"));
        }
        let mut checked = Vec::new();
        for (index, argument) in arguments.iter().enumerate() {
            let ty = helper.parameters.get(index).copied().unwrap_or(Type::Error);
            let value = self.value(argument, ty);
            // Uniforms have module scope in WGSL: they are not passed.
            if ty != Type::Uniforms {
                checked.push(value);
            }
        }
        Expr::new(Kind::Helper(index, checked), helper.result, span)
    }

    /// Checks `Vec3::new(…)`, `f32::from_bits(…)`, and methods written as functions: `f32::max(a, b)`.
    fn associated(
        &mut self,
        owner: &str,
        name: &str,
        arguments: &Arguments,
        span: SourceSpan,
        name_span: &SourceSpan,
    ) -> Expr {
        match (Type::from_rust(owner), name) {
            (Some(Type::Vector(size)), "new") => self.vector(size, arguments, span),
            (Some(Type::Vector(size)), "splat") => {
                self.require_count(&format!("{owner}::splat"), 1, arguments.len(), &span);
                let components = arguments.iter().map(|argument| self.value(argument, Type::F32)).collect();
                Expr::new(Kind::Vector(components), Type::Vector(size), span)
            }
            (Some(Type::F32), "from_bits") => {
                self.require_count("f32::from_bits", 1, arguments.len(), &span);
                let bits = arguments.iter().map(|argument| self.value(argument, Type::U32)).collect();
                Expr::new(Kind::Method(Spelling::Call("bitcast<f32>"), bits), Type::F32, span)
            }
            (Some(ty), _) if !arguments.is_empty() && has_method(ty, name) => {
                let mut arguments = arguments.iter();
                let Some(first) = arguments.next() else { return Expr::error(span) };
                let receiver = self.value(first, ty);
                self.method((receiver, first), ty, name, &arguments.collect::<Vec<_>>(), span, name_span)
            }
            _ => self.unknown_function(&format!("{owner}::{name}"), arguments, span, name_span),
        }
    }

    fn unknown_function(
        &mut self,
        name: &str,
        arguments: &Arguments,
        span: SourceSpan,
        name_span: &SourceSpan,
    ) -> Expr {
        // The arguments are checked for errors all the same.
        let checked: Vec<Expr> = arguments.iter().map(|argument| self.expr(argument, None)).collect();
        let given: Vec<Given> =
            arguments.iter().zip(&checked).map(|(argument, checked)| self.given_of(argument, checked)).collect();
        let foreign = foreign_names::function(name, &given);
        if self.environment.incomplete.helpers {
            return self.without_declaration(span);
        }
        let help = match self.lookup(name) {
            Some(_) => format!("`{name}` is a variable: remove `(…)`"),
            None => self.help_for_function(name, &given, foreign) + &self.typed_receiver(&checked, &given),
        };
        self.report.error(codes::UNKNOWN_NAME, name_span, format!("cannot find function `{name}`"), help);
        Expr::error(span)
    }

    /// Returns what to write instead of an unknown function: what another language's function is here, or else a function of the
    /// description.
    fn help_for_function(&self, name: &str, given: &[Given], foreign: Option<String>) -> String {
        let last = last_segment(name);
        let helpers: Vec<&str> = self.environment.helpers.iter().map(|helper| helper.name.as_str()).collect();
        let arguments: Vec<&str> = given.iter().map(|argument| argument.source.as_str()).collect();
        let call = format!("{last}({})", arguments.join(", "));
        if last != name && (helpers.contains(&last) || CONSTRUCTORS.contains(&last)) {
            return format!("it is called without a path: write `{call}`");
        }
        let nearest = nearest_name(name, &[&helpers[..], &CONSTRUCTORS].concat()).map(str::to_owned);
        let of_path = || foreign_functions::associated(name, given).filter(|_| last != name);
        if let Some(instead) = foreign.or_else(of_path) {
            return instead;
        }
        if let Some(nearest) = nearest {
            return format!("did you mean `{nearest}`?");
        }
        if let Some(nearest) = foreign_functions::nearest(last, given) {
            return nearest;
        }
        let declaration = foreign_functions::declaration(last, given);
        match last == name {
            true => format!("declare it in the buffer: `{declaration}`"),
            false => format!(
                "closures call functions of the description alone: declare `{declaration}` in the buffer, and call it as `{call}`"
            ),
        }
    }

    pub(super) fn method_call(&mut self, call: &syn::ExprMethodCall) -> Expr {
        let span = self.at(call.span());
        if let Some(error) = self.iterator_chain(call) {
            return error;
        }
        if let Some(generics) = &call.turbofish {
            let span = self.at(generics.span());
            let help = format!("remove `{}`", source_of_generics(generics));
            return self.unsupported(span, "generics are not supported", help);
        }
        let receiver = self.expr(&call.receiver, None);
        let name = call.method.to_string();
        let name_span = self.at(call.method.span());
        if self.report.is_placeholder(&name) {
            self.candidates_of(receiver.ty);
            return Expr::error(span);
        }
        let arguments: Vec<&syn::Expr> = call.args.iter().collect();
        match self.inference.resolve(receiver.ty) {
            Type::Error => {
                for argument in arguments {
                    self.expr(argument, None);
                }
                Expr::error(span)
            }
            Type::Fragments => self.list_method(call, span, &name_span),
            Type::Texture(shape) => self.texture_method((&receiver, shape), call, span, &name_span),
            Type::Unknown(_) => self.unknown_receiver(&receiver, call, span, &name_span),
            ty => self.method((receiver, &call.receiver), ty, &name, &arguments, span, &name_span),
        }
    }

    fn method(
        &mut self,
        (receiver, source): (Expr, &syn::Expr),
        ty: Type,
        name: &str,
        arguments: &[&syn::Expr],
        span: SourceSpan,
        name_span: &SourceSpan,
    ) -> Expr {
        if let Some(size) = swizzle_size(ty, name) {
            let signature = || format!("fn {name}(self: {}) -> Vec{size}", ty.rust());
            self.note(name_span, || Noted::Known(NameKind::Component, name.to_owned(), signature()));
            self.require_count(name, 0, arguments.len(), &span);
            return Expr::new(Kind::Components(Box::new(receiver), name.to_string()), Type::Vector(size), span);
        }
        let Some(row) = methods::find(ty, name) else {
            let rest: Vec<Given> = arguments.iter().map(|argument| self.given(argument)).collect();
            let all = [&[given(source, ty, false)], rest.as_slice()].concat();
            self.unknown_method(ty, name, &all, name_span);
            return Expr::error(span);
        };
        self.note(name_span, || Noted::Method(row, ty));
        self.require_count(name, row.parameters.len(), arguments.len(), &span);
        let mut all = vec![receiver];
        for (argument, parameter) in arguments.iter().zip(row.parameters) {
            all.push(self.value(argument, parameter.on(ty)));
        }
        Expr::new(Kind::Method(row.wgsl, all), row.result.on(ty), span)
    }

    /// Reports a method that `ty` does not have; `given` are the receiver and the arguments.
    fn unknown_method(&mut self, ty: Type, name: &str, given: &[Given], name_span: &SourceSpan) {
        let of = quoted(ty.rust());
        if let Some((why, help)) = methods::unsupported(ty, name) {
            self.report.error(codes::METHOD_DIFFERS, name_span, format!("`{name}` of {of} {why}"), help);
            return;
        }
        let existing: Vec<&str> = methods::names_on(ty).collect();
        let swizzle = given.first().and_then(|receiver| swizzles::instead(ty, name, &receiver.source));
        let instead = match methods::is_method(name) {
            _ if swizzle.is_some() => swizzle,
            true => foreign_functions::of_components(name, given).or_else(|| foreign_functions::help(name, given)),
            false => foreign_names::function(name, &in_order_of_functions(name, given)),
        };
        let help = match instead {
            _ if existing.is_empty() => format!("{of} has no methods: use operators or fields"),
            Some(instead) => instead,
            None => unknown_name::help(name, &existing),
        };
        self.report.error(codes::UNKNOWN_METHOD, name_span, format!("no method `{name}` for {of}"), help);
    }

    /// Reports a method call on a number of unknown type, as Rust does.
    fn unknown_receiver(
        &mut self,
        receiver: &Expr,
        call: &syn::ExprMethodCall,
        span: SourceSpan,
        name_span: &SourceSpan,
    ) -> Expr {
        let name = call.method.to_string();
        let arguments: Vec<Given> = call.args.iter().map(|argument| self.given(argument)).collect();
        let has_float = arguments.iter().any(|argument| argument.ty == Type::F32 && !argument.is_literal);
        let has_integers = methods::find(Type::U32, &name).is_some();
        let ty =
            if self.inference.is_integer(receiver.ty) && has_integers && !has_float { Type::U32 } else { Type::F32 };
        if !has_method(ty, &name) {
            // No type of number has it: `n.extend(1.0)`.
            let ty = self.inference.resolve_or_default(receiver.ty);
            let all = [&[given(&call.receiver, ty, false)], arguments.as_slice()].concat();
            self.unknown_method(ty, &name, &all, name_span);
            self.ignore(receiver);
            return Expr::error(span);
        }
        let message = format!("cannot call method `{name}` on a number of unknown type");
        let help = match self.typed_declaration(receiver, ty) {
            Some(declaration) => format!("give the variable its type: `{declaration}`"),
            None => {
                let arguments: Vec<String> = arguments.iter().map(|argument| argument.of_type(ty)).collect();
                let receiver_type = self.inference.resolve_or_default(receiver.ty);
                let receiver = given(&call.receiver, receiver_type, true).typed(ty);
                format!("write `{receiver}.{name}({})`", arguments.join(", "))
            }
        };
        self.report.error(codes::TYPE_MISMATCH, name_span, message, help);
        self.ignore(receiver);
        Expr::error(span)
    }

    pub(super) fn require_count(&mut self, name: &str, expected: usize, given: usize, span: &SourceSpan) {
        if expected != given {
            let (message, help) = argument_count(name, expected, given);
            self.report.error(codes::ARGUMENT_COUNT, span, message, help);
        }
    }
}

/// Returns message and help for a wrong number of arguments.
fn argument_count(name: &str, expected: usize, given: usize) -> (String, String) {
    let plural = |count: usize| if count == 1 { "1 argument".to_string() } else { format!("{count} arguments") };
    let message = format!("`{name}` takes {}, found {given}", plural(expected));
    let help = match name {
        "vec2" | "vec3" | "vec4" => format!("write all components, or `{}::splat(…)`", name.replace('v', "V")),
        _ if expected < given => format!("remove {}", plural(given - expected)),
        _ => format!("add {}", plural(expected - given)),
    };
    (message, help)
}

/// Returns the number of components of a glam swizzle such as `xyz`, if the vector has them all.
fn swizzle_size(ty: Type, name: &str) -> Option<u8> {
    let Type::Vector(size) = ty else { return None };
    let letters = "xyzw".get(..usize::from(size))?;
    let fits = (2..=4).contains(&name.len()) && name.chars().all(|letter| letters.contains(letter));
    if fits { u8::try_from(name.len()).ok() } else { None }
}

fn has_method(ty: Type, name: &str) -> bool {
    methods::find(ty, name).is_some() || methods::unsupported(ty, name).is_some()
}

fn last_segment(name: &str) -> &str {
    name.rsplit("::").next().unwrap_or(name)
}

/// Returns the receiver and the arguments of a method in the order of the function of this name: `smoothstep(a, b, x)` and `step(edge, x)`
/// have the receiver last.
fn in_order_of_functions(name: &str, given: &[Given]) -> Vec<Given> {
    let mut given = given.to_vec();
    if ["smoothstep", "step"].contains(&name) {
        given.rotate_left(1);
    }
    given
}
