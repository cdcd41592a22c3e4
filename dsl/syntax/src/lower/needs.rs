//! Properties of expressions that the printer needs.
//!
//! Input: a typed expression. Output: whether it needs statements before it, changes a variable, can be written twice, or can
//! be an arm of `select`.

use super::lowering::Lowering;
use crate::fold::{self, Value};
use crate::methods::Spelling;
use crate::tree::{Block, Expr, Function, If, Kind, Statement};
use crate::types::Type;

/// The maximum number of nodes in an arm of `select`.
const MAX_ARM: usize = 8;

impl Lowering<'_> {
    /// Returns whether the expression needs statements before it.
    pub(super) fn needs_statements(&self, expr: &Expr) -> bool {
        let itself = match &expr.kind {
            Kind::If(branch) => !self.is_select(branch, expr),
            Kind::Block(block) => !block.statements.is_empty() || block.value.is_none(),
            Kind::For(_) | Kind::Assign { .. } | Kind::Return(_) | Kind::Break | Kind::Continue => true,
            Kind::Method(spelling, arguments) => self.binds(*spelling, arguments),
            Kind::Cast(inner) => self.saturates(inner, expr) && (!is_plain(inner) || self.is_constant(inner)),
            _ => false,
        };
        itself
            || expr.kind.operands().into_iter().any(|operand| self.needs_statements(operand))
            || value_of(&expr.kind).is_some_and(|value| self.needs_statements(value))
    }

    /// Returns whether an argument must be bound to a name: it occurs twice in the template, or all arguments are constant.
    pub(super) fn binds(&self, spelling: Spelling, arguments: &[Expr]) -> bool {
        let spelling = self.chosen(spelling, arguments);
        let twice = |(index, argument): (usize, &Expr)| occurs_twice(spelling, index) && !is_plain(argument);
        arguments.iter().enumerate().any(twice) || self.all_constant(arguments)
    }

    /// Returns the spelling of a call with these arguments.
    pub(super) fn chosen(&self, spelling: Spelling, arguments: &[Expr]) -> Spelling {
        let Spelling::ByZero { nonzero, other } = spelling else { return spelling };
        let value = arguments.get(1).and_then(|argument| fold::constant(argument, self.function));
        let is_nonzero = matches!(value, Some(Value::Float(parts)) if parts.iter().all(|part| *part != 0.0));
        Spelling::Template(if is_nonzero { nonzero } else { other })
    }

    pub(super) fn all_constant(&self, arguments: &[Expr]) -> bool {
        arguments.iter().all(|argument| self.is_constant(argument))
    }

    pub(super) fn is_constant(&self, expr: &Expr) -> bool {
        fold::constant(expr, self.function).is_some()
    }

    /// Returns whether a conversion needs `select`: Rust saturates at the greatest integer, WGSL at the last float before it.
    pub(super) fn saturates(&self, inner: &Expr, cast: &Expr) -> bool {
        self.function.type_of(inner) == Type::F32 && self.function.type_of(cast).is_integer()
    }

    /// Returns whether a branch can be a `select`: both arms are small, have no effects and are safe to evaluate.
    pub(super) fn is_select(&self, branch: &If, expr: &Expr) -> bool {
        let (Some(then), Some(else_branch)) = (only_value(&branch.then), &branch.else_branch) else { return false };
        let else_branch = match &else_branch.kind {
            Kind::Block(block) => only_value(block),
            _ => None,
        };
        let Some(else_branch) = else_branch else { return false };
        let value = !matches!(self.function.type_of(expr), Type::Fragment | Type::Unit | Type::Never);
        let cheap = |arm: &Expr| self.is_safe(arm) && size(arm) <= MAX_ARM;
        value && cheap(then) && cheap(else_branch) && !self.is_constant(&branch.condition)
    }

    /// Returns whether the expression can be evaluated where Rust does not evaluate it.
    fn is_safe(&self, expr: &Expr) -> bool {
        let itself = match &expr.kind {
            Kind::Helper(..) | Kind::Lookup(..) | Kind::Layer(_) | Kind::LayerCount | Kind::Element(..) => false,
            Kind::If(_) | Kind::Block(_) | Kind::For(_) | Kind::Assign { .. } => false,
            Kind::Return(_) | Kind::Break | Kind::Continue => false,
            _ => !self.needs_statements(expr),
        };
        itself && expr.kind.operands().into_iter().all(|operand| self.is_safe(operand))
    }

    /// Returns whether the value cannot change while other operands are evaluated.
    pub(super) fn is_stable(&self, expr: &Expr) -> bool {
        !reads_mutable(expr, self.function)
    }
}

/// Returns the value of a block without statements.
pub(super) fn only_value(block: &Block) -> Option<&Expr> {
    if block.statements.is_empty() { block.value.as_deref() } else { None }
}

/// Returns whether it is a name, a literal, or a field of such: it may be written twice.
pub(super) fn is_plain(expr: &Expr) -> bool {
    match &expr.kind {
        Kind::Variable(_) | Kind::Float(_) | Kind::Integer(_) | Kind::Bool(_) | Kind::Uniform(_) => true,
        Kind::Attribute(base, _) | Kind::Components(base, _) => is_plain(base),
        _ => false,
    }
}

/// Returns whether the expression assigns a variable.
pub(super) fn assigns(expr: &Expr) -> bool {
    let within = |block: &Block| {
        let statement = |statement: &Statement| match statement {
            Statement::Let { value, .. } | Statement::Expr(value) => assigns(value),
        };
        block.statements.iter().any(statement) || block.value.as_deref().is_some_and(assigns)
    };
    matches!(expr.kind, Kind::Assign { .. })
        || expr.kind.operands().into_iter().any(assigns)
        || expr.kind.block().is_some_and(within)
}

/// Returns whether the expression reads a mutable variable.
fn reads_mutable(expr: &Expr, function: &Function) -> bool {
    let within = |block: &Block| {
        let statement = |statement: &Statement| match statement {
            Statement::Let { value, .. } | Statement::Expr(value) => reads_mutable(value, function),
        };
        block.statements.iter().any(statement)
            || block.value.as_deref().is_some_and(|value| reads_mutable(value, function))
    };
    matches!(expr.kind, Kind::Variable(id) if function.is_mutable(id))
        || expr.kind.operands().into_iter().any(|operand| reads_mutable(operand, function))
        || expr.kind.block().is_some_and(within)
}

/// Returns whether an argument occurs more than once in the WGSL of a method.
pub(super) fn occurs_twice(spelling: Spelling, index: usize) -> bool {
    match spelling {
        Spelling::Call(_) => false,
        Spelling::Template(template) | Spelling::ByZero { other: template, .. } => {
            template.matches(&format!("${index}")).count() > 1
        }
    }
}

fn size(expr: &Expr) -> usize {
    1 + expr.kind.operands().into_iter().map(size).sum::<usize>()
}

/// Returns the final value of a block, which `operands` omits.
fn value_of(kind: &Kind) -> Option<&Expr> {
    match kind {
        Kind::Block(block) => block.value.as_deref(),
        Kind::If(branch) => branch.then.value.as_deref(),
        _ => None,
    }
}
