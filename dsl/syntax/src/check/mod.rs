//! The type checker of the closure language: from Rust's syntax tree to a typed tree.
//!
//! Input: a parsed function and its environment. Output: a [`Function`] in which every node has a type, or errors. Types are
//! Rust's: rustc accepts every function that passes, with glam's vectors and the same meaning. Nothing here writes WGSL.

mod assign;
mod blocks;
mod branches;
mod calls;
mod checker;
mod expressions;
mod fields;
mod given;
mod literals;
mod loops;
mod mismatch;
mod operators;
mod paths;
mod unsupported;
mod written_types;

use fragbuf_model::{Diagnostic, codes};

use crate::environment::Environment;
use crate::fold;
use crate::raw_function::{RawFunction, RawParameter, Role};
use crate::report::{FIRST, Report};
use crate::tree::{Block, Function, VariableId};
use crate::types::Type;
use checker::Checker;

pub(crate) use written_types::written_type;

/// Checks one function; returns `None` if it has an error, or uses a name whose declaration has one.
pub(crate) fn function(raw: RawFunction, environment: &Environment, report: &mut Report) -> Option<Function> {
    let before = report.count();
    let (expected, result) = signature(&raw, environment);
    let mut checker = Checker::new(environment, report, result);
    let parameters = checker.parameters(&raw, &expected);
    checker.written_result(&raw);
    let body = checker.body(&raw.body);
    checker.check_numbers();
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
        Role::Resolve => (vec![Type::Fragments, Type::Uniforms], Type::Vector(4)),
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

    fn declare_parameter(&mut self, parameter: &RawParameter, ty: Type) -> VariableId {
        let name = parameter.name.as_ref().map_or("_", |name| name.value.as_str());
        let id = self.new_variable(name, parameter.mutable, true, ty, &parameter.span);
        if parameter.name.is_some() {
            self.bind(id);
        }
        id
    }

    fn count_of_parameters(&mut self, raw: &RawFunction) {
        if matches!(raw.parameters.len(), 1 | 2) {
            return;
        }
        let first = if raw.role == Role::Resolve { "fragments" } else { "f" };
        let message = format!("expected 1 or 2 parameters, found {}", raw.parameters.len());
        let help = format!("write `|{first}|`, or `|{first}, u|` to read uniforms");
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
