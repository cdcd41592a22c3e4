//! Finds candidates for `a && b`, `a || b` and `x op= y`: code that naga lowered to an `if` or to a load and a store.
//!
//! Input: the order of a function. Output: candidates, found by their form alone. `schedule` drops those that would change
//! the meaning.

use std::collections::BTreeMap;

use naga::{BinaryOperator, Block, Expression, Handle, Literal, LocalVariable, Statement};

use crate::analysis::Order;
use crate::footprint;

/// `left && right` or `left || right`, which naga lowers to an `if` that stores to an unnamed variable.
#[derive(Clone, Copy)]
pub struct ShortCircuit {
    pub operator: BinaryOperator,
    pub left: Handle<Expression>,
    pub right: Handle<Expression>,
    pub variable: Handle<LocalVariable>,
    /// The expression that loads the variable, and so has the value of the short circuit.
    pub value: Handle<Expression>,
    /// Its first step, the `if`.
    pub first: usize,
    /// The first step after it.
    pub end: usize,
}

/// Short circuits, by the expression that loads their value.
pub type ShortCircuits = BTreeMap<Handle<Expression>, ShortCircuit>;
/// Stores of the form `x = x op y`, by step: the value, and the load within it.
pub type CompoundAssignments = BTreeMap<usize, (Handle<Expression>, Handle<Expression>)>;

/// Returns the statements that have the form of a lowered `&&` or `||`.
pub fn find_short_circuits(order: &Order) -> ShortCircuits {
    let mut found = ShortCircuits::new();
    for (step, entry) in order.steps.iter().enumerate() {
        let Some(Statement::If { condition, accept, reject }) = entry.statement else { continue };
        let Some((variable, right)) = last_store(order, accept) else { continue };
        let Some((same, otherwise)) = last_store(order, reject) else { continue };
        let nameless = order.function.local_variables[variable].name.is_none();
        let Expression::Literal(Literal::Bool(short)) = order.function.expressions[otherwise] else { continue };
        if same != variable || !nameless || reject.len() != 1 {
            continue;
        }
        let (operator, left) = match (short, &order.function.expressions[*condition]) {
            (false, _) => (BinaryOperator::LogicalAnd, *condition),
            (true, Expression::Unary { op: naga::UnaryOperator::LogicalNot, expr }) => {
                (BinaryOperator::LogicalOr, *expr)
            }
            _ => continue,
        };
        let Some(value) = only_load(order, variable, entry.block) else { continue };
        let end = step + 1 + count_steps(order, step);
        found.insert(value, ShortCircuit { operator, left, right, variable, value, first: step, end });
    }
    found
}

/// Counts the steps inside the statement at `step`.
fn count_steps(order: &Order, step: usize) -> usize {
    let inside = |mut block: usize| loop {
        if block != 0 && order.blocks[block].owner == step {
            return true;
        }
        match order.blocks[block].parent {
            Some(parent) => block = parent,
            None => return false,
        }
    };
    order.steps[step + 1..].iter().take_while(|entry| inside(entry.block)).count()
}

/// Returns the variable and the value of a store at the end of a block.
fn last_store(order: &Order, block: &Block) -> Option<(Handle<LocalVariable>, Handle<Expression>)> {
    let Some(Statement::Store { pointer, value }) = block.last() else { return None };
    match order.function.expressions[*pointer] {
        Expression::LocalVariable(local) => Some((local, *value)),
        _ => None,
    }
}

/// Returns the load of a variable, if it is the only one and in the given block.
fn only_load(order: &Order, variable: Handle<LocalVariable>, block: usize) -> Option<Handle<Expression>> {
    let mut loads = order.function.expressions.iter().filter(|(_, expression)| {
        matches!(expression, Expression::Load { pointer } if order.function.expressions[*pointer] == Expression::LocalVariable(variable))
    });
    let (load, _) = loads.next()?;
    let step = order.evaluated[load]?;
    (loads.next().is_none() && order.steps[step].block == block).then_some(load)
}

/// Returns the stores that the source may contain as `x op= y`.
pub fn find_compound_assignments(order: &Order) -> CompoundAssignments {
    let mut found = CompoundAssignments::new();
    for (step, entry) in order.steps.iter().enumerate() {
        let Some(statement @ Statement::Store { pointer, value }) = entry.statement else { continue };
        let Expression::Binary { op, left, .. } = order.function.expressions[*value] else { continue };
        let Expression::Load { pointer: loaded } = order.function.expressions[left] else { continue };
        let single = |expression| order.uses[expression].len() == 1;
        let nameless = |expression| !order.function.named_expressions.contains_key(&expression);
        let atomic = footprint::is_atomic(order.module, order.function, *pointer);
        if loaded == *pointer
            && can_assign(op)
            // GLSL has no `&=` of booleans.
            && order.inner(left).scalar_kind() != Some(naga::ScalarKind::Bool)
            && single(*value)
            && single(left)
            && nameless(*value)
            && nameless(left)
            && !atomic
            && is_compound_in_source(order, statement)
        {
            found.insert(step, (*value, left));
        }
    }
    found
}

/// Tests whether the source of a store is `x op= y` or `x++`; without a source, this is assumed.
fn is_compound_in_source(order: &Order, statement: &Statement) -> bool {
    let Statement::Store { value, .. } = statement else { return false };
    let range = order.function.expressions.get_span(*value).to_range();
    let written = range.and_then(|range| order.source.get(range)).unwrap_or_default();
    written.is_empty()
        || ["+=", "-=", "*=", "&=", "|=", "^=", "++", "--"].iter().any(|operator| written.contains(operator))
}

/// Tests whether GLSL's operator has WGSL's meaning. Division, remainder and shifts may print as more than an operator.
fn can_assign(op: BinaryOperator) -> bool {
    use BinaryOperator::{Add, And, ExclusiveOr, InclusiveOr, Multiply, Subtract};
    matches!(op, Add | Subtract | Multiply | And | ExclusiveOr | InclusiveOr)
}
