//! The state of type checking one function.
//!
//! Input: the environment of the function. Output: variables, scopes and diagnostics. The other files of this folder add
//! the rules.

use fragbuf_model::{SourceSpan, Spanned, codes};
use proc_macro2::Span;

use super::literal_variables::LiteralVariable;
use super::noted::Noted;
use crate::environment::Environment;
use crate::infer::Inference;
use crate::report::Report;
use crate::tree::{Expr, Kind, Use, Variable, VariableId};
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
    /// Whether the function is a helper, whose parameters the user chooses.
    pub is_helper: bool,
    /// The number of loops around the current statement.
    pub loops: usize,
    /// The nesting depth of the current expression.
    pub depth: usize,
    /// Integer literals, whose range is checked when their types are known.
    pub integers: Vec<IntegerLiteral>,
    /// Operands of `-`, which must not be unsigned.
    pub negated: Vec<(Type, SourceSpan)>,
    /// The variables of `let`s.
    pub lets: Vec<VariableId>,
    /// The variables that are declared with a literal alone.
    pub literal_variables: Vec<LiteralVariable>,
    /// Whether the function uses a name whose declaration has an error.
    pub lacks_declaration: bool,
    /// The names of the function with their spans, if the report collects names.
    pub noted: Vec<(SourceSpan, Noted)>,
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
            is_helper: false,
            loops: 0,
            depth: 0,
            integers: Vec::new(),
            negated: Vec::new(),
            lets: Vec::new(),
            literal_variables: Vec::new(),
            lacks_declaration: false,
            noted: Vec::new(),
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
        self.variables.push(Variable { name: name.to_string(), mutable, annotated, ty, span, reads: 0 });
        self.variables.len() - 1
    }

    /// Adds a variable to the innermost scope.
    pub(super) fn bind(&mut self, id: VariableId) {
        let name = self.variables.get(id).map(|variable| variable.name.clone()).unwrap_or_default();
        if let Some(scope) = self.scopes.last_mut() {
            scope.push((name, id));
        }
    }

    /// Counts a read of a variable.
    pub(super) fn count_read(&mut self, id: VariableId) {
        if let Some(variable) = self.variables.get_mut(id) {
            variable.reads += 1;
        }
    }

    /// Removes the read that the place of an assignment counted: `x = …` and `x.y += …` do not read `x`.
    pub(super) fn uncount_read(&mut self, place: &Expr) {
        match &place.kind {
            Kind::Variable(id) => {
                if let Some(variable) = self.variables.get_mut(*id) {
                    variable.reads = variable.reads.saturating_sub(1);
                }
            }
            Kind::Attribute(base, _) | Kind::Element(base, _) | Kind::Components(base, _) => self.uncount_read(base),
            _ => {}
        }
    }

    /// Returns the names of `let`s that no expression reads, unless they begin with `_`.
    pub(super) fn unused(&self) -> Vec<Spanned<String>> {
        let variables = self.lets.iter().filter_map(|id| self.variables.get(*id));
        let unread = variables.filter(|variable| variable.reads == 0 && !variable.name.starts_with('_'));
        unread.map(|variable| Spanned::new(variable.name.clone(), variable.span.clone())).collect()
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

    /// Returns the expression for a name that may be declared in an item with errors, which are reported there.
    pub(super) fn without_declaration(&mut self, span: SourceSpan) -> Expr {
        self.lacks_declaration = true;
        Expr::error(span)
    }

    /// Returns whether a type is a number.
    pub(super) fn is_number(&self, ty: Type) -> bool {
        self.inference.is_integer(ty) || self.inference.is_float(ty)
    }
}
