//! The type checker of the closure language: from Rust's syntax tree to a typed tree.
//!
//! Input: a parsed function and its environment. Output: a [`Function`] in which every node has a type, or errors. Types are
//! Rust's: rustc accepts every function that passes, with glam's vectors and the same meaning. Nothing here writes WGSL.

mod assign;
mod blocks;
mod branches;
mod calls;
mod checker;
mod declared_names;
mod expressions;
mod fields;
mod given;
mod iterators;
mod list_methods;
mod literal_variables;
mod literals;
mod loops;
mod mismatch;
mod noted;
mod operators;
mod paths;
mod swizzles;
mod texture_methods;
mod unsupported;
mod written_types;

use fragbuf_model::{Diagnostic, Spanned, codes};

use crate::environment::Environment;
use crate::fold;
use crate::raw_function::{RawFunction, RawParameter, Role};
use crate::report::{FIRST, Report};
use crate::tree::{Block, Function, VariableId};
use crate::types::Type;
use checker::Checker;
use noted::Noted;

pub(crate) use texture_methods::TEXTURE_METHODS;
pub(crate) use written_types::written_type;

/// Checks one function; returns `None` if it has an error, or uses a name whose declaration has one.
pub(crate) fn function(raw: RawFunction, environment: &Environment, report: &mut Report) -> Option<Function> {
    let before = report.count();
    let (expected, result) = signature(&raw, environment);
    let mut checker = Checker::new(environment, report, result);
    checker.is_helper = matches!(raw.role, Role::Helper(_));
    let expected = checker.with_swapped_parameters(&raw, expected);
    let parameters = checker.parameters(&raw, &expected);
    checker.written_result(&raw);
    let body = checker.body(&raw.body);
    checker.check_numbers();
    checker.report_names();
    let unused = checker.unused();
    let Checker { inference, variables, uses, lacks_declaration, .. } = checker;
    let name = raw.role.wgsl_name();
    let (span, rust) = (raw.span, raw.rust);
    let function = Function { name, span, rust, parameters, variables, result, body, uses, unused, inference };
    let is_complete = report.count() == before && !lacks_declaration;
    if is_complete {
        fold::reject_overflow(&function, report);
    }
    (is_complete && report.count() == before).then_some(function)
}

/// Returns the types of the parameters and of the result.
fn signature(raw: &RawFunction, environment: &Environment) -> (Vec<Type>, Type) {
    match &raw.role {
        Role::Criterion => (vec![Type::Fragment, Type::Uniforms], Type::F32),
        Role::Constraint(_) => (vec![Type::Fragment, Type::Uniforms], Type::Bool),
        Role::Resolve | Role::Image(_) => (vec![Type::Fragments, Type::Uniforms], Type::Vector(4)),
        Role::Between => (vec![Type::Fragment, Type::Fragment, Type::F32, Type::Uniforms], Type::Vector(4)),
        Role::Helper(name) => {
            let signature = environment.helpers.iter().find(|signature| signature.name == *name);
            signature.map_or((Vec::new(), Type::Error), |signature| (signature.parameters.clone(), signature.result))
        }
    }
}

impl Checker<'_, '_, '_> {
    fn parameters(&mut self, raw: &RawFunction, expected: &[Type]) -> Vec<VariableId> {
        if !matches!(raw.role, Role::Helper(_)) {
            self.count_of_parameters(raw);
        }
        let mut ids = Vec::new();
        for (index, parameter) in raw.parameters.iter().enumerate() {
            let ty = expected.get(index).copied().unwrap_or(Type::Error);
            self.parameter_type(raw, parameter, ty);
            self.reject_duplicate_parameter(raw, index);
            ids.push(self.declare_parameter(parameter, ty));
        }
        ids
    }

    /// Reports parameters of a closure in the wrong order, `|u, f|`, and returns their types in the order of the closure.
    fn with_swapped_parameters(&mut self, raw: &RawFunction, expected: Vec<Type>) -> Vec<Type> {
        let names: Vec<&Spanned<String>> = raw.parameters.iter().filter_map(|each| each.name.as_ref()).collect();
        let ([first, second], [kept, uniforms]) = (names.as_slice(), expected.as_slice()) else { return expected };
        if matches!(raw.role, Role::Helper(_)) || !self.are_swapped(raw, &first.value, &second.value) {
            return expected;
        }
        let what = if *kept == Type::Fragments { "the fragments are" } else { "the fragment is" };
        let message = format!("the parameters are swapped: {what} the first, and the uniforms are the second");
        let help = format!("write `|{}, {}|`", second.value, first.value);
        self.report.error(codes::TYPE_MISMATCH, &first.span, message, help);
        vec![*uniforms, *kept]
    }

    /// Tests whether the body uses the first parameter only as the uniforms, or the second only as a fragment or the list of fragments.
    fn are_swapped(&self, raw: &RawFunction, first: &str, second: &str) -> bool {
        let tokens: Vec<&str> = raw.rust.split(' ').collect();
        let has = |list: &[(String, Type)], name: &str| list.iter().any(|(other, _)| other == name);
        let (attributes, uniforms) = (&self.environment.attributes, &self.environment.uniforms);
        // `name . field`, `name [`, and `in name`; after the parameters.
        let uses = |name: &str| {
            let name = name.to_owned();
            tokens.windows(3).filter_map(move |window| match *window {
                [base, ".", field] if base == name => Some(field.to_owned()),
                [base, "[", _] if base == name => Some("[".to_owned()),
                ["in", base, _] if base == name => Some("in".to_owned()),
                _ => None,
            })
        };
        let is_list = raw.role.reads_list();
        let is_kept = |field: &str| match is_list {
            true => matches!(field, "[" | "in" | "len" | "iter" | "is_empty"),
            false => has(attributes, field) && !has(uniforms, field),
        };
        let is_uniform = |field: &str| has(uniforms, field) && (is_list || !has(attributes, field));
        let are_uniforms = uses(first).all(|field| is_uniform(&field));
        let are_kept = uses(second).all(|field| is_kept(&field));
        are_uniforms && are_kept && uses(first).chain(uses(second)).next().is_some()
    }

    fn declare_parameter(&mut self, parameter: &RawParameter, ty: Type) -> VariableId {
        let name = parameter.name.as_ref().map_or("_", |name| name.value.as_str());
        let id = self.new_variable(name, parameter.mutable, true, ty, &parameter.span);
        if let Some(name) = &parameter.name {
            self.bind(id);
            self.note(&name.span, || Noted::Variable(id));
        }
        id
    }

    fn count_of_parameters(&mut self, raw: &RawFunction) {
        let usual = raw.role.usual_parameters();
        let most = usual.len();
        if [most - 1, most].contains(&raw.parameters.len()) {
            return;
        }
        let message = format!("expected {} or {most} parameters, found {}", most - 1, raw.parameters.len());
        let without = usual.get(..most - 1).unwrap_or_default().join(", ");
        let help = format!("write `|{without}|`, or `|{}|` to read uniforms", usual.join(", "));
        self.report.error(codes::ARGUMENT_COUNT, &raw.span, message, help);
    }

    /// Checks the type annotation of a closure's parameter, which is optional.
    fn parameter_type(&mut self, raw: &RawFunction, parameter: &RawParameter, ty: Type) {
        if matches!(raw.role, Role::Helper(_)) {
            return;
        }
        let Some(written) = &parameter.ty else { return };
        let written = written_type(written, self.report);
        if self.inference.unify(written, ty).is_none() {
            let message = format!("mismatched parameter type: expected `{}`, found `{}`", ty.rust(), written.rust());
            self.report.error(codes::TYPE_MISMATCH, &parameter.span, message, "remove the type");
        }
    }

    fn reject_duplicate_parameter(&mut self, raw: &RawFunction, index: usize) {
        let Some(name) = raw.parameters.get(index).and_then(|parameter| parameter.name.as_ref()) else { return };
        let earlier = raw.parameters.iter().take(index).filter_map(|parameter| parameter.name.as_ref());
        if let Some(first) = earlier.into_iter().find(|other| other.value == name.value) {
            let message = format!("duplicate parameter `{}`", name.value);
            let diagnostic = Diagnostic::new(codes::DUPLICATE, &name.span, message, "rename one of them");
            self.report.push(diagnostic.label(&first.span, FIRST));
        }
    }

    /// Checks the return type of a closure, which is optional: `|f| -> f32 { … }`.
    fn written_result(&mut self, raw: &RawFunction) {
        let (Some(output), false) = (&raw.output, matches!(raw.role, Role::Helper(_))) else { return };
        let written = written_type(output, self.report);
        if self.inference.unify(written, self.result).is_none() {
            let (expected, found) = (self.result.rust(), written.rust());
            let message = format!("mismatched return type: expected `{expected}`, found `{found}`");
            self.report.error(codes::TYPE_MISMATCH, &raw.span, message, "remove `-> …`");
        }
    }

    fn body(&mut self, body: &syn::Expr) -> Block {
        let result = self.result;
        match body {
            syn::Expr::Block(block) if block.label.is_none() => self.block(&block.block, Some(result)),
            other => {
                let value = self.value(other, result);
                let end = value.span.clone();
                Block { statements: Vec::new(), value: Some(Box::new(value)), end }
            }
        }
    }

    /// Checks ranges and negations once all types are known.
    fn check_numbers(&mut self) {
        for integer in std::mem::take(&mut self.integers) {
            self.check_range(&integer);
        }
        for (ty, span) in std::mem::take(&mut self.negated) {
            self.check_negation(ty, &span);
        }
    }
}
