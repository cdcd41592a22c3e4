//! The names that a function uses, with their types, and what can be in the place of the placeholder.
//!
//! Input: names as the checker resolves them. Output: [`Name`]s of the report, once the types of all numbers are known. Nothing is
//! computed unless the report collects names.

use fragbuf_model::SourceSpan;

use super::calls::CONSTRUCTORS;
use super::checker::Checker;
use super::list_methods::LIST_METHODS;
use super::texture_methods::TextureMethod;
use crate::constants;
use crate::environment::Signature;
use crate::inspection::{self, Candidate, Name, NameKind};
use crate::methods::{METHODS, Method};
use crate::tree::VariableId;
use crate::types::Type;

/// A name as the checker resolves it.
pub(super) enum Noted {
    Variable(VariableId),
    Attribute(String, Type),
    Uniform(String, Type),
    /// The index of a helper.
    Helper(usize),
    /// A method, and the type of its receiver.
    Method(&'static Method, Type),
    /// A name of the language, with its signature.
    Known(NameKind, String, String),
}

impl Checker<'_, '_, '_> {
    /// Notes what a name means.
    pub(super) fn note(&mut self, span: &SourceSpan, noted: impl FnOnce() -> Noted) {
        if self.report.has_names() {
            self.noted.push((span.clone(), noted()));
        }
    }

    /// Adds the noted names to the report. The types of all numbers are known.
    pub(super) fn report_names(&mut self) {
        for (span, noted) in std::mem::take(&mut self.noted) {
            if let Some(name) = self.name_of(span, &noted) {
                self.report.name(name);
            }
        }
    }

    fn name_of(&self, span: SourceSpan, noted: &Noted) -> Option<Name> {
        let name = |name: &str, kind, signature: String| Name {
            name: name.to_owned(),
            span: span.clone(),
            kind,
            signature,
            note: String::new(),
            declared: None,
        };
        Some(match noted {
            Noted::Variable(id) => {
                let variable = self.variables.get(*id)?;
                let ty = self.inference.resolve_or_default(variable.ty);
                let mutable = if variable.mutable { "mut " } else { "" };
                let signature = format!("{mutable}{}: {}", variable.name, ty.rust());
                Name { declared: Some(variable.span.clone()), ..name(&variable.name, NameKind::Variable, signature) }
            }
            Noted::Attribute(attribute, ty) => {
                name(attribute, NameKind::Attribute, format!("{attribute}: {}", ty.rust()))
            }
            Noted::Uniform(uniform, ty) => name(uniform, NameKind::Uniform, format!("{uniform}: {}", ty.rust())),
            Noted::Helper(index) => {
                let helper = self.environment.helpers.get(*index)?;
                let found = name(&helper.name, NameKind::Function, signature_of_helper(helper));
                Name { declared: Some(helper.span.clone()), ..found }
            }
            Noted::Method(method, receiver) => {
                let found = name(method.name, NameKind::Method, signature_of_method(method, *receiver));
                Name { note: method.note.to_owned(), ..found }
            }
            Noted::Known(kind, known, signature) => name(known, *kind, signature.clone()),
        })
    }

    /// Sets what can be written in place of a value: variables in scope, functions and
    /// constants. Words of statements are known to the caller.
    pub(super) fn candidates_for_value(&mut self) {
        if !self.report.has_names() {
            return;
        }
        let mut found: Vec<Candidate> = Vec::new();
        for (name, id) in self.scopes.iter().rev().flat_map(|scope| scope.iter().rev()) {
            let Some(variable) = self.variables.get(*id).filter(|_| found.iter().all(|other| other.name != *name))
            else {
                continue;
            };
            let ty = self.inference.resolve_or_default(variable.ty);
            found.push(candidate(name, NameKind::Variable, format!("{name}: {}", ty.rust())));
        }
        let helpers = self.environment.helpers.iter();
        found.extend(helpers.map(|helper| candidate(&helper.name, NameKind::Function, signature_of_helper(helper))));
        let known = CONSTRUCTORS.iter().map(|name| candidate(name, NameKind::Function, signature_of_constructor(name)));
        found.extend(known);
        found.extend(constants::names().iter().map(|name| constant(name)));
        self.report.candidates(found);
    }

    /// Sets what can be written after `owner::`.
    pub(super) fn candidates_in(&mut self, path: &[String]) {
        if !self.report.has_names() {
            return;
        }
        let prefix = path.iter().take(path.len().saturating_sub(1)).fold(String::new(), |all, part| all + part + "::");
        let rest = |name: &str| name.strip_prefix(&prefix).filter(|rest| !rest.contains("::")).map(str::to_owned);
        let functions = CONSTRUCTORS.iter().filter_map(|name| {
            let rest = rest(name)?;
            Some(Candidate { name: rest, ..candidate(name, NameKind::Function, signature_of_constructor(name)) })
        });
        let names = constants::names();
        let constants = names.iter().filter_map(|name| Some(Candidate { name: rest(name)?, ..constant(name) }));
        self.report.candidates(functions.chain(constants).collect::<Vec<_>>());
    }

    /// Sets what can be written after the `.` of a value of this type.
    pub(super) fn candidates_of(&mut self, ty: Type) {
        if !self.report.has_names() {
            return;
        }
        let ty = self.inference.resolve_or_default(ty);
        let environment = self.environment;
        let declared = |names: &[(String, Type)], kind| -> Vec<Candidate> {
            names.iter().map(|(name, ty)| candidate(name, kind, format!("{name}: {}", ty.rust()))).collect()
        };
        let found = match ty {
            Type::Fragment => declared(&environment.attributes, NameKind::Attribute),
            Type::Uniforms => declared(&environment.uniforms, NameKind::Uniform),
            Type::Fragments => {
                let method =
                    |(name, signature): &(&str, &str)| candidate(name, NameKind::Method, (*signature).to_owned());
                LIST_METHODS.iter().map(method).collect()
            }
            Type::Texture(shape) => {
                let method = |method: &TextureMethod| Candidate {
                    note: method.about.to_owned(),
                    ..candidate(method.name, NameKind::Method, format!("fn {}", method.signature()))
                };
                TextureMethod::of(shape).map(method).collect()
            }
            _ => members(ty),
        };
        self.report.candidates(found);
    }
}

/// Returns the components, the most usual swizzles and the methods of a number or a vector.
fn members(ty: Type) -> Vec<Candidate> {
    let size = match ty {
        Type::Vector(size) => usize::from(size),
        _ => 0,
    };
    let letters = "xyzw".get(..size).unwrap_or_default();
    let component = |name: char| candidate(&name.to_string(), NameKind::Component, format!("{name}: f32"));
    let swizzles = (2..size.max(2)).filter_map(|length| {
        let name = letters.get(..length)?;
        Some(candidate(name, NameKind::Method, format!("fn {name}(self: {}) -> Vec{length}", ty.rust())))
    });
    let methods = METHODS.iter().filter(|row| row.on.contains(&ty)).map(|row| Candidate {
        note: row.note.to_owned(),
        ..candidate(row.name, NameKind::Method, signature_of_method(row, ty))
    });
    letters.chars().map(component).chain(swizzles).chain(methods).collect()
}

fn candidate(name: &str, kind: NameKind, signature: String) -> Candidate {
    Candidate { name: name.to_owned(), kind, signature, note: String::new() }
}

fn constant(name: &str) -> Candidate {
    let path = if name.contains("consts") { format!("std::{name}") } else { name.to_owned() };
    let ty =
        constants::find(&name.split("::").map(str::to_owned).collect::<Vec<_>>()).map_or("f32", |value| value.rust());
    candidate(&path, NameKind::Constant, format!("const {path}: {ty}"))
}

fn signature_of_helper(helper: &Signature) -> String {
    let parameters: Vec<&str> = helper.parameters.iter().map(|ty| ty.rust()).collect();
    format!("fn {}({}) -> {}", helper.name, parameters.join(", "), helper.result.rust())
}

fn signature_of_method(method: &Method, receiver: Type) -> String {
    let parameters = method.parameters.iter().map(|ty| format!(", {}", ty.on(receiver).rust()));
    let parameters: String = parameters.collect();
    let result = method.result.on(receiver).rust();
    format!("fn {}(self: {}{parameters}) -> {result}", method.name, receiver.rust())
}

/// Returns the signature of a function of the language: `vec3`, `Vec3::splat`, `f32::from_bits`.
pub(super) fn signature_of_constructor(name: &str) -> String {
    let size = name.chars().find_map(|letter| letter.to_digit(10)).filter(|size| (2..=4).contains(size));
    match (name.split_once("::"), size) {
        (None, Some(size)) => {
            let parameters = vec!["f32"; size as usize].join(", ");
            format!("fn {name}({parameters}) -> Vec{size}")
        }
        (Some((owner, "new")), Some(size)) => {
            format!("fn {name}({}) -> {owner}", vec!["f32"; size as usize].join(", "))
        }
        (Some((owner, "splat")), _) => format!("fn {name}(f32) -> {owner}"),
        (Some((owner, _)), _) => format!("fn {name}(u32) -> {owner}"),
        (None, None) => format!("fn {name}"),
    }
}

/// Adds what can be written as a type.
pub(super) fn candidates_for_type(report: &mut crate::report::Report) {
    report.candidates(inspection::types());
}
