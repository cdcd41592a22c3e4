//! The type checker of the closure language: from Rust's syntax tree to a typed one.
//!
//! In: a function as written, and what it can see. Out: a [`Function`] in which every node has a type, or the mistakes.
//! Types are Rust's: what passes here, rustc accepts with glam's vectors and reads alike. Nothing here writes WGSL.

mod assign;
mod blocks;
mod branches;
mod calls;
mod expressions;
mod fields;
mod literals;
mod loops;
mod mismatch;
mod operators;
mod paths;
mod unsupported;

use fragbuf_model::{Diagnostic, Origin, codes};
use proc_macro2::Span;

use crate::fold;
use crate::grammar::{RawFunction, RawParameter, Role};
use crate::infer::Inference;
use crate::report::Report;
use crate::tree::{Block, Expr, Function, Use, Variable, VariableId};
use crate::types::Type;

pub(crate) use paths::written_type;

/// What every function of a description can see.
pub(crate) struct Environment {
    /// Attributes of a fragment.
    pub attributes: Vec<(String, Type)>,
    pub uniforms: Vec<(String, Type)>,
    pub helpers: Vec<Signature>,
}

/// A helper as its callers see it.
pub(crate) struct Signature {
    pub name: String,
    pub origin: Origin,
    pub parameters: Vec<Type>,
    pub result: Type,
}

/// How deep expressions may nest.
const DEPTH: usize = 64;

/// The state of checking one function.
struct Checker<'e, 'r, 'p> {
    environment: &'e Environment,
    report: &'r mut Report<'p>,
    inference: Inference,
    variables: Vec<Variable>,
    /// Names in scope, innermost last.
    scopes: Vec<Vec<(String, VariableId)>>,
    uses: Vec<Use>,
    result: Type,
    loops: usize,
    depth: usize,
    /// Whole numbers whose range is checked when their type is known.
    wholes: Vec<literals::Whole>,
    /// Operands of `-`, which must not turn out to be unsigned.
    negated: Vec<(Type, Origin)>,
}

/// Checks one function; nothing if it has a mistake.
pub(crate) fn function(raw: RawFunction, environment: &Environment, report: &mut Report) -> Option<Function> {
    let before = report.count();
    let (expected, result) = wanted(&raw, environment);
    let mut checker = Checker::new(environment, report, result);
    let parameters = checker.parameters(&raw, &expected);
    checker.written_result(&raw);
    let body = checker.body(&raw.body);
    checker.finish_numbers();
    let Checker { inference, variables, uses, .. } = checker;
    let name = raw.role.wgsl_name();
    let (origin, rust) = (raw.origin, raw.rust);
    let function = Function { name, origin, rust, parameters, variables, result, body, uses, inference };
    if report.count() == before {
        fold::refuse_overflow(&function, report);
    }
    (report.count() == before).then_some(function)
}

/// The types of the parameters and of the result.
fn wanted(raw: &RawFunction, environment: &Environment) -> (Vec<Type>, Type) {
    match &raw.role {
        Role::Criterion => (vec![Type::Fragment, Type::Uniforms], Type::F32),
        Role::Admit(_) => (vec![Type::Fragment, Type::Uniforms], Type::Bool),
        Role::Resolve => (vec![Type::Fragments, Type::Uniforms], Type::Vector(4)),
        Role::Helper(name) => {
            let signature = environment.helpers.iter().find(|signature| signature.name == *name);
            signature.map_or((Vec::new(), Type::Error), |signature| (signature.parameters.clone(), signature.result))
        }
    }
}

impl<'e, 'r, 'p> Checker<'e, 'r, 'p> {
    fn new(environment: &'e Environment, report: &'r mut Report<'p>, result: Type) -> Self {
        Checker {
            environment,
            report,
            inference: Inference::default(),
            variables: Vec::new(),
            scopes: vec![Vec::new()],
            uses: Vec::new(),
            result,
            loops: 0,
            depth: 0,
            wholes: Vec::new(),
            negated: Vec::new(),
        }
    }

    fn parameters(&mut self, raw: &RawFunction, expected: &[Type]) -> Vec<VariableId> {
        if !matches!(raw.role, Role::Helper(_)) {
            self.count_of_parameters(raw);
        }
        let mut ids = Vec::new();
        for (index, parameter) in raw.parameters.iter().enumerate() {
            let kind = expected.get(index).copied().unwrap_or(Type::Error);
            self.parameter_type(raw, parameter, kind);
            self.refuse_same_parameter(raw, index);
            ids.push(self.declare_parameter(parameter, kind));
        }
        ids
    }

    fn declare_parameter(&mut self, parameter: &RawParameter, kind: Type) -> VariableId {
        let name = parameter.name.as_ref().map_or("_", |name| name.value.as_str());
        let id = self.new_variable(name, parameter.mutable, true, kind, &parameter.origin);
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
        let message = format!("the closure takes {} parameters", raw.parameters.len());
        let hint = format!("write `|{first}|`, or `|{first}, u|` to read uniforms");
        self.report.error(codes::WRONG_ARGUMENTS, &raw.origin, message, hint);
    }

    /// A closure's parameter may have a type, which must be the one it has anyway.
    fn parameter_type(&mut self, raw: &RawFunction, parameter: &RawParameter, kind: Type) {
        if matches!(raw.role, Role::Helper(_)) {
            return;
        }
        let Some(written) = &parameter.kind else { return };
        let written = written_type(written, self.report);
        if self.inference.unify(written, kind).is_none() {
            let message = format!("the parameter is `{}`, not `{}`", kind.rust(), written.rust());
            self.report.error(codes::WRONG_TYPE, &parameter.origin, message, "leave the type out");
        }
    }

    fn refuse_same_parameter(&mut self, raw: &RawFunction, index: usize) {
        let Some(name) = raw.parameters.get(index).and_then(|parameter| parameter.name.as_ref()) else { return };
        let earlier = raw.parameters.iter().take(index).filter_map(|parameter| parameter.name.as_ref());
        if let Some(first) = earlier.into_iter().find(|other| other.value == name.value) {
            let message = format!("the parameter `{}` is given twice", name.value);
            let diagnostic = Diagnostic::new(codes::DUPLICATE, &name.origin, message, "rename one of them");
            self.report.push(diagnostic.label(&first.origin, "the first is here"));
        }
    }

    /// A closure may say what it gives: `|f| -> f32 { … }`.
    fn written_result(&mut self, raw: &RawFunction) {
        let (Some(output), false) = (&raw.output, matches!(raw.role, Role::Helper(_))) else { return };
        let written = written_type(output, self.report);
        if self.inference.unify(written, self.result).is_none() {
            let message = format!("the closure must give `{}`, not `{}`", self.result.rust(), written.rust());
            self.report.error(codes::WRONG_TYPE, &raw.origin, message, "leave the `-> …` out");
        }
    }

    fn body(&mut self, body: &syn::Expr) -> Block {
        let result = self.result;
        match body {
            syn::Expr::Block(block) if block.label.is_none() => self.block(&block.block, Some(result)),
            other => {
                let value = self.value(other, result);
                let end = value.origin.clone();
                Block { statements: Vec::new(), value: Some(Box::new(value)), end }
            }
        }
    }

    /// A new name for a value; it is not in scope before [`Checker::bind`].
    fn new_variable(&mut self, name: &str, mutable: bool, annotated: bool, kind: Type, origin: &Origin) -> VariableId {
        let origin = origin.clone();
        self.variables.push(Variable { name: name.to_string(), mutable, annotated, kind, origin });
        self.variables.len() - 1
    }

    /// Brings a variable into the innermost scope.
    fn bind(&mut self, id: VariableId) {
        let name = self.variables.get(id).map(|variable| variable.name.clone()).unwrap_or_default();
        if let Some(scope) = self.scopes.last_mut() {
            scope.push((name, id));
        }
    }

    fn lookup(&self, name: &str) -> Option<VariableId> {
        let innermost_first = self.scopes.iter().rev().flat_map(|scope| scope.iter().rev());
        innermost_first.into_iter().find(|(other, _)| other == name).map(|(_, id)| *id)
    }

    fn at(&self, span: Span) -> Origin {
        self.report.at(span)
    }

    /// Reports a construct that the language does not have.
    fn refuse(&mut self, origin: Origin, message: impl Into<String>, hint: impl Into<String>) -> Expr {
        self.report.error(codes::UNSUPPORTED, &origin, message, hint);
        Expr::error(origin)
    }

    /// Once all types are known: do the numbers fit?
    fn finish_numbers(&mut self) {
        for whole in std::mem::take(&mut self.wholes) {
            self.check_range(&whole);
        }
        for (kind, origin) in std::mem::take(&mut self.negated) {
            self.check_negation(kind, &origin);
        }
    }
}
