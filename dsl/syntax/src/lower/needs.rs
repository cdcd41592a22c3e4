//! What an expression needs from its surroundings when it is printed.
//!
//! In: a typed expression. Out: whether statements must stand before it, whether it changes a variable, whether it can be
//! written twice, whether `select` can hold it.

use crate::methods::Spelling;
use crate::tree::{Block, Expr, Function, Kind, Statement};
use crate::types::Type;
use crate::{fold, tree};

/// How large an arm of `select` may be.
const CHEAP: usize = 8;

impl super::Lowering<'_> {
    /// Whether statements must stand before the expression.
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

    /// Whether some argument must get a name: it occurs twice in the text, or all are constants.
    pub(super) fn binds(&self, spelling: Spelling, arguments: &[Expr]) -> bool {
        let twice = |(index, argument): (usize, &Expr)| occurs_twice(spelling, index) && !is_plain(argument);
        arguments.iter().enumerate().any(twice) || self.all_constant(arguments)
    }

    pub(super) fn all_constant(&self, arguments: &[Expr]) -> bool {
        arguments.iter().all(|argument| self.is_constant(argument))
    }

    pub(super) fn is_constant(&self, expr: &Expr) -> bool {
        fold::constant(expr, self.function).is_some()
    }

    /// Whether a conversion needs more than WGSL's: Rust stops at the greatest number, WGSL at the last float before it.
    pub(super) fn saturates(&self, inner: &Expr, cast: &Expr) -> bool {
        self.function.type_of(inner) == Type::F32 && self.function.type_of(cast).is_integer()
    }

    /// Whether a branch can be written as `select`: both arms small, without effects, and safe to evaluate.
    pub(super) fn is_select(&self, branch: &tree::If, expr: &Expr) -> bool {
        let (Some(then), Some(otherwise)) = (only_value(&branch.then), &branch.otherwise) else { return false };
        let otherwise = match &otherwise.kind {
            Kind::Block(block) => only_value(block),
            _ => None,
        };
        let Some(otherwise) = otherwise else { return false };
        let value = !matches!(self.function.type_of(expr), Type::Fragment | Type::Unit | Type::Never);
        let cheap = |arm: &Expr| self.is_safe(arm) && size(arm) <= CHEAP;
        value && cheap(then) && cheap(otherwise) && !self.is_constant(&branch.condition)
    }

    /// Whether evaluating it when Rust would not cannot matter.
    fn is_safe(&self, expr: &Expr) -> bool {
        let itself = match &expr.kind {
            Kind::Helper(..) | Kind::Layer(_) | Kind::LayerCount | Kind::Element(..) => false,
            Kind::If(_) | Kind::Block(_) | Kind::For(_) | Kind::Assign { .. } => false,
            Kind::Return(_) | Kind::Break | Kind::Continue => false,
            _ => !self.needs_statements(expr),
        };
        itself && expr.kind.operands().into_iter().all(|operand| self.is_safe(operand))
    }

    /// Whether its value cannot change while other operands are evaluated.
    pub(super) fn is_stable(&self, expr: &Expr) -> bool {
        !reads_mutable(expr, self.function)
    }
}

/// The value of a block that has nothing else.
pub(super) fn only_value(block: &Block) -> Option<&Expr> {
    if block.statements.is_empty() { block.value.as_deref() } else { None }
}

/// Whether it is a name, a literal, or a field of such: text that may be written twice.
pub(super) fn is_plain(expr: &Expr) -> bool {
    match &expr.kind {
        Kind::Variable(_) | Kind::Float(_) | Kind::Whole(_) | Kind::Bool(_) | Kind::Uniform(_) => true,
        Kind::Attribute(base, _) | Kind::Components(base, _) => is_plain(base),
        _ => false,
    }
}

/// Whether evaluating it assigns a variable.
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

/// How often an argument stands in the text of a method.
pub(super) fn occurs_twice(spelling: Spelling, index: usize) -> bool {
    match spelling {
        Spelling::Call(_) => false,
        Spelling::Text(text) => text.matches(&format!("${index}")).count() > 1,
    }
}

fn size(expr: &Expr) -> usize {
    1 + expr.kind.operands().into_iter().map(size).sum::<usize>()
}

/// The value at the end of a block, which `operands` leaves out.
fn value_of(kind: &Kind) -> Option<&Expr> {
    match kind {
        Kind::Block(block) => block.value.as_deref(),
        Kind::If(branch) => branch.then.value.as_deref(),
        _ => None,
    }
}
