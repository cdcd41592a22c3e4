//! The state of type checking one function.
//!
//! Input: the environment of the function. Output: variables, scopes and diagnostics. The other files of this folder add
//! the rules.

use fragbuf_model::{SourceSpan, codes};
use proc_macro2::Span;

use crate::environment::Environment;
use crate::infer::Inference;
use crate::report::Report;
use crate::tree::{Expr, Use, Variable, VariableId};
use crate::types::Type;

/// The state of type checking one function.
pub(super) struct Checker<'e, 'r, 'p> {
    pub environment: &'e Environment,
    pub report: &'r mut Report<'p>,
    pub inference: Inference,
    pub variables: Vec<Variable>,
    /// Names in scope, innermost last.
    pub scopes: Vec<Vec<(String, VariableId)>>,
    pub uses: Vec<Use>,
    /// The result type of the function.
    pub result: Type,
    /// The number of loops around the current statement.
    pub loops: usize,
    /// The nesting depth of the current expression.
    pub depth: usize,
    /// Integer literals, whose range is checked when their types are known.
    pub integers: Vec<IntegerLiteral>,
    /// Operands of `-`, which must not be unsigned.
    pub negated: Vec<(Type, SourceSpan)>,
}

/// An integer literal.
pub(super) struct IntegerLiteral {
    pub value: u64,
    pub ty: Type,
    pub span: SourceSpan,
    /// Whether `-` precedes it.
    pub negative: bool,
}

impl<'e, 'r, 'p> Checker<'e, 'r, 'p> {
    /// Returns the state at the start of a function.
    pub(super) fn new(environment: &'e Environment, report: &'r mut Report<'p>, result: Type) -> Self {
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
            integers: Vec::new(),
            negated: Vec::new(),
        }
    }

    /// Adds a variable. It is in scope only after [`Checker::bind`].
    pub(super) fn new_variable(
        &mut self,
        name: &str,
        mutable: bool,
        annotated: bool,
        ty: Type,
        span: &SourceSpan,
    ) -> VariableId {
        let span = span.clone();
        self.variables.push(Variable { name: name.to_string(), mutable, annotated, ty, span });
        self.variables.len() - 1
    }

    /// Adds a variable to the innermost scope.
    pub(super) fn bind(&mut self, id: VariableId) {
        let name = self.variables.get(id).map(|variable| variable.name.clone()).unwrap_or_default();
        if let Some(scope) = self.scopes.last_mut() {
            scope.push((name, id));
        }
    }

    /// Returns the innermost variable of this name.
    pub(super) fn lookup(&self, name: &str) -> Option<VariableId> {
        let innermost_first = self.scopes.iter().rev().flat_map(|scope| scope.iter().rev());
        innermost_first.into_iter().find(|(other, _)| other == name).map(|(_, id)| *id)
    }

    /// Returns the position of a token span in the user's source.
    pub(super) fn at(&self, span: Span) -> SourceSpan {
        self.report.at(span)
    }

    /// Reports a construct that the language does not support.
    pub(super) fn unsupported(
        &mut self,
        span: SourceSpan,
        message: impl Into<String>,
        help: impl Into<String>,
    ) -> Expr {
        self.report.error(codes::UNSUPPORTED, &span, message, help);
        Expr::error(span)
    }

    /// Returns whether a type is a number.
    pub(super) fn is_number(&self, ty: Type) -> bool {
        self.inference.is_integer(ty) || self.inference.is_float(ty)
    }
}
