//! Calls: helper functions, constructors of vectors, and rows of the method table.
//!
//! In: a call. Out: a typed call with as many arguments as it takes. A method of a number needs to know which number it
//! is, as in Rust: `2.0_f32.sqrt()`.

use fragbuf_model::{Diagnostic, Origin, codes};
use syn::spanned::Spanned;

use super::Checker;
use super::mismatch::quoted;
use super::paths::words;
use crate::methods::{self, Spelling};
use crate::near;
use crate::tree::{Expr, Kind, Use};
use crate::types::Type;

type Arguments = syn::punctuated::Punctuated<syn::Expr, syn::Token![,]>;

impl Checker<'_, '_, '_> {
    pub(super) fn call(&mut self, call: &syn::ExprCall) -> Expr {
        let origin = self.at(call.span());
        let name = match &*call.func {
            syn::Expr::Path(path) if path.qself.is_none() => words(&path.path),
            _ => None,
        };
        let Some(words) = name else {
            let hint = "call a helper `fn` or a method by its name";
            return self.refuse(origin, "only names can be called", hint);
        };
        let place = self.at(call.func.span());
        let words: Vec<&str> = words.iter().map(String::as_str).collect();
        match words.as_slice() {
            [name] if self.hides_function(name) => {
                let message = format!("the variable `{name}` hides the function `{name}`");
                self.refuse(origin, message, "rename one of them")
            }
            ["vec2"] => self.vector(2, &call.args, origin),
            ["vec3"] => self.vector(3, &call.args, origin),
            ["vec4"] => self.vector(4, &call.args, origin),
            [name] => self.helper_call(name, &call.args, origin, &place),
            [owner, name] => self.associated(owner, name, &call.args, origin, &place),
            _ => self.unknown_function(&words.join("::"), &call.args, origin, &place),
        }
    }

    fn hides_function(&self, name: &str) -> bool {
        let function = self.environment.helpers.iter().any(|helper| helper.name == name);
        (function || matches!(name, "vec2" | "vec3" | "vec4")) && self.lookup(name).is_some()
    }

    fn vector(&mut self, size: u8, arguments: &Arguments, origin: Origin) -> Expr {
        self.require_count(&format!("vec{size}"), usize::from(size), arguments.len(), &origin);
        let components = arguments.iter().map(|argument| self.value(argument, Type::F32)).collect();
        Expr::new(Kind::Vector(components), Type::Vector(size), origin)
    }

    fn helper_call(&mut self, name: &str, arguments: &Arguments, origin: Origin, place: &Origin) -> Expr {
        let environment = self.environment;
        let Some(index) = environment.helpers.iter().position(|helper| helper.name == name) else {
            return self.unknown_function(name, arguments, origin, place);
        };
        let Some(helper) = environment.helpers.get(index) else { return Expr::error(origin) };
        self.uses.push(Use::Helper(index, origin.clone()));
        if arguments.len() != helper.parameters.len() {
            let (message, hint) = count_words(name, helper.parameters.len(), arguments.len());
            let diagnostic = Diagnostic::new(codes::WRONG_ARGUMENTS, &origin, message, hint);
            self.report.push(diagnostic.label(&helper.origin, "declared here"));
        }
        let mut checked = Vec::new();
        for (index, argument) in arguments.iter().enumerate() {
            let kind = helper.parameters.get(index).copied().unwrap_or(Type::Error);
            let value = self.value(argument, kind);
            // Uniforms are module scope in WGSL: they are not passed.
            if kind != Type::Uniforms {
                checked.push(value);
            }
        }
        Expr::new(Kind::Helper(index, checked), helper.result, origin)
    }

    /// `Vec3::new(…)`, `f32::from_bits(…)`, and methods written as functions: `f32::max(a, b)`.
    fn associated(&mut self, owner: &str, name: &str, arguments: &Arguments, origin: Origin, place: &Origin) -> Expr {
        match (Type::from_rust(owner), name) {
            (Some(Type::Vector(size)), "new") => self.vector(size, arguments, origin),
            (Some(Type::Vector(size)), "splat") => {
                self.require_count(&format!("{owner}::splat"), 1, arguments.len(), &origin);
                let components = arguments.iter().map(|argument| self.value(argument, Type::F32)).collect();
                Expr::new(Kind::Vector(components), Type::Vector(size), origin)
            }
            (Some(Type::F32), "from_bits") => {
                self.require_count("f32::from_bits", 1, arguments.len(), &origin);
                let bits = arguments.iter().map(|argument| self.value(argument, Type::U32)).collect();
                Expr::new(Kind::Method(Spelling::Call("bitcast<f32>"), bits), Type::F32, origin)
            }
            (Some(kind), _) if !arguments.is_empty() && self.has_method(kind, name) => {
                let mut arguments = arguments.iter();
                let receiver = arguments.next().map(|first| self.value(first, kind));
                let receiver = receiver.unwrap_or_else(|| Expr::error(origin.clone()));
                self.method(receiver, kind, name, &arguments.collect::<Vec<_>>(), origin, place)
            }
            _ => self.unknown_function(&format!("{owner}::{name}"), arguments, origin, place),
        }
    }

    fn has_method(&self, kind: Type, name: &str) -> bool {
        methods::find(kind, name).is_some() || methods::refusal(kind, name).is_some()
    }

    fn unknown_function(&mut self, name: &str, arguments: &Arguments, origin: Origin, place: &Origin) -> Expr {
        // What is wrong with the arguments is worth knowing too.
        for argument in arguments {
            self.expr(argument, None);
        }
        let mut existing: Vec<&str> = self.environment.helpers.iter().map(|helper| helper.name.as_str()).collect();
        existing.extend(["vec2", "vec3", "vec4", "Vec2::splat", "Vec3::splat", "Vec4::splat", "f32::from_bits"]);
        let hint = match near::nearest(name, &existing) {
            _ if self.lookup(name).is_some() => format!("`{name}` is a variable: write it without `(…)`"),
            Some(near) => format!("did you mean `{near}`?"),
            None if methods::is_method(name) => {
                format!("it is a method: write `a.{name}({})`", if arguments.len() > 1 { "b" } else { "" })
            }
            None if methods::of_shaders(name).is_some() => {
                format!("write `{}`", methods::of_shaders(name).unwrap_or_default())
            }
            None => format!("declare it in the buffer: `fn {} (x: f32) -> f32 {{ … }}`", last_word(name)),
        };
        self.report.error(codes::UNKNOWN_NAME, place, format!("there is no function `{name}`"), hint);
        Expr::error(origin)
    }

    pub(super) fn method_call(&mut self, call: &syn::ExprMethodCall) -> Expr {
        let origin = self.at(call.span());
        if let Some(generics) = &call.turbofish {
            let place = self.at(generics.span());
            return self.refuse(place, "generics are not part of the language", "leave out `::<…>`");
        }
        let receiver = self.expr(&call.receiver, None);
        let name = call.method.to_string();
        let place = self.at(call.method.span());
        let arguments: Vec<&syn::Expr> = call.args.iter().collect();
        match self.inference.resolve(receiver.ty) {
            Type::Error => {
                for argument in arguments {
                    self.expr(argument, None);
                }
                Expr::error(origin)
            }
            Type::Fragments => self.list_method(&name, arguments.len(), origin, &place),
            Type::Unknown(_) => self.undecided_receiver(&receiver, &name, origin, &place),
            kind => self.method(receiver, kind, &name, &arguments, origin, &place),
        }
    }

    fn method(
        &mut self,
        receiver: Expr,
        kind: Type,
        name: &str,
        arguments: &[&syn::Expr],
        origin: Origin,
        place: &Origin,
    ) -> Expr {
        if let Some(size) = swizzle_size(kind, name) {
            self.require_count(name, 0, arguments.len(), &origin);
            return Expr::new(Kind::Components(Box::new(receiver), name.to_string()), Type::Vector(size), origin);
        }
        let Some(row) = methods::find(kind, name) else {
            self.unknown_method(kind, name, place);
            for argument in arguments {
                self.expr(argument, None);
            }
            return Expr::error(origin);
        };
        self.require_count(name, row.takes.len(), arguments.len(), &origin);
        let mut all = vec![receiver];
        for (argument, slot) in arguments.iter().zip(row.takes) {
            all.push(self.value(argument, slot.on(kind)));
        }
        Expr::new(Kind::Method(row.wgsl, all), row.gives.on(kind), origin)
    }

    fn unknown_method(&mut self, kind: Type, name: &str, place: &Origin) {
        let of = quoted(kind.rust());
        if let Some((why, hint)) = methods::refusal(kind, name) {
            self.report.error(codes::METHOD_DIFFERS, place, format!("`{name}` of {of} {why}"), hint);
            return;
        }
        let existing: Vec<&str> = methods::names_on(kind).collect();
        let hint = match existing.is_empty() {
            true => format!("{of} has no methods here: use operators or fields"),
            false => near::hint(name, &existing),
        };
        self.report.error(codes::UNKNOWN_METHOD, place, format!("{of} has no method `{name}` here"), hint);
    }

    fn list_method(&mut self, name: &str, arguments: usize, origin: Origin, place: &Origin) -> Expr {
        match name {
            "len" => {
                self.require_count(name, 0, arguments, &origin);
                Expr::new(Kind::LayerCount, Type::Usize, origin)
            }
            "is_empty" => {
                self.require_count(name, 0, arguments, &origin);
                let count = Expr::new(Kind::LayerCount, Type::Usize, origin.clone());
                let zero = Expr::new(Kind::Whole(0), Type::Usize, origin.clone());
                let kind = Kind::Binary(crate::tree::Operator::Equal, Box::new(count), Box::new(zero));
                Expr::new(kind, Type::Bool, origin)
            }
            _ => {
                let message = format!("the list of fragments has no method `{name}` here");
                let hint = match near::nearest(name, &["len", "is_empty"]) {
                    Some(near) => format!("did you mean `{near}`?"),
                    None => {
                        "there are `len()` and `is_empty()`; go through it with `for f in fragments { … }`".to_string()
                    }
                };
                self.report.error(codes::UNKNOWN_METHOD, place, message, hint);
                Expr::error(origin)
            }
        }
    }

    /// Rust does not guess which number a method is of.
    fn undecided_receiver(&mut self, receiver: &Expr, name: &str, origin: Origin, place: &Origin) -> Expr {
        let whole = self.inference.is_whole(receiver.ty);
        let suffix = if whole { "u32" } else { "f32" };
        let hint = match receiver.kind {
            Kind::Float(value) => format!("write `{value:?}_{suffix}.{name}(…)`"),
            Kind::Whole(value) => format!("write `{value}_{suffix}.{name}(…)`"),
            _ => format!("give the variable its type: `let x: {suffix} = …;`"),
        };
        let message = format!("the number that `{name}` is called on has no type yet");
        self.report.error(codes::WRONG_TYPE, place, message, hint);
        Expr::error(origin)
    }

    fn require_count(&mut self, name: &str, takes: usize, given: usize, origin: &Origin) {
        if takes != given {
            let (message, hint) = count_words(name, takes, given);
            self.report.error(codes::WRONG_ARGUMENTS, origin, message, hint);
        }
    }
}

fn count_words(name: &str, takes: usize, given: usize) -> (String, String) {
    let plural = |count: usize| if count == 1 { "1 argument".to_string() } else { format!("{count} arguments") };
    let message = format!("`{name}` takes {}, not {given}", plural(takes));
    let hint = match name {
        "vec2" | "vec3" | "vec4" => format!("write all components, or `{}::splat(…)`", name.replace('v', "V")),
        _ if takes < given => "leave out the rest".to_string(),
        _ => format!("write {} more", takes - given),
    };
    (message, hint)
}

/// How many components a glam swizzle such as `xyz` has, if the vector has them all.
fn swizzle_size(kind: Type, name: &str) -> Option<u8> {
    let Type::Vector(size) = kind else { return None };
    let letters = "xyzw".get(..usize::from(size))?;
    let fits = (2..=4).contains(&name.len()) && name.chars().all(|letter| letters.contains(letter));
    if fits { u8::try_from(name.len()).ok() } else { None }
}

fn last_word(name: &str) -> &str {
    name.rsplit("::").next().unwrap_or(name)
}
