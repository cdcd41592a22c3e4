//! What might be printed as the source had it: short circuits, and stores of the form `x op= y`.
//!
//! In: the order of a function. Out: candidates by their shape alone; `schedule` drops those that would change the meaning.

use std::collections::BTreeMap;

use naga::{BinaryOperator, Block, Expression, Handle, Literal, LocalVariable, Statement};

use crate::analysis::Order;
use crate::footprint;

/// `left && right` or `left || right`, which naga has lowered to an `if` that stores to a nameless variable.
#[derive(Clone, Copy)]
pub struct Circuit {
    pub operator: BinaryOperator,
    pub left: Handle<Expression>,
    pub right: Handle<Expression>,
    pub variable: Handle<LocalVariable>,
    /// The expression that loads the variable, which stands for the whole.
    pub value: Handle<Expression>,
    /// Its steps: the `if` and everything inside.
    pub first: usize,
    pub end: usize,
}

/// By the expression that stands for the value.
pub type Circuits = BTreeMap<Handle<Expression>, Circuit>;
/// The value and the load within it of each store of the form `x = x op y`.
pub type Compound = BTreeMap<usize, (Handle<Expression>, Handle<Expression>)>;

/// What naga lowered from `&&` and `||`, as far as its shape tells.
pub fn find_circuits(order: &Order) -> Circuits {
    let mut found = Circuits::new();
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
        found.insert(value, Circuit { operator, left, right, variable, value, first: step, end });
    }
    found
}

/// Steps inside the statement at `step`.
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

fn last_store(order: &Order, block: &Block) -> Option<(Handle<LocalVariable>, Handle<Expression>)> {
    let Some(Statement::Store { pointer, value }) = block.last() else { return None };
    match order.function.expressions[*pointer] {
        Expression::LocalVariable(local) => Some((local, *value)),
        _ => None,
    }
}

/// The single load of a variable, if it is in the given block.
fn only_load(order: &Order, variable: Handle<LocalVariable>, block: usize) -> Option<Handle<Expression>> {
    let mut loads = order.function.expressions.iter().filter(|(_, expression)| {
        matches!(expression, Expression::Load { pointer } if order.function.expressions[*pointer] == Expression::LocalVariable(variable))
    });
    let (load, _) = loads.next()?;
    let step = *order.evaluated.get(&load)?;
    (loads.next().is_none() && order.steps[step].block == block).then_some(load)
}

/// Stores that the source may have written as `x op= y`.
pub fn find_compound(order: &Order) -> Compound {
    let mut found = Compound::new();
    for (step, entry) in order.steps.iter().enumerate() {
        let Some(statement @ Statement::Store { pointer, value }) = entry.statement else { continue };
        let Expression::Binary { op, left, .. } = order.function.expressions[*value] else { continue };
        let Expression::Load { pointer: loaded } = order.function.expressions[left] else { continue };
        let single = |expression| order.uses.get(&expression).is_some_and(|uses| uses.len() == 1);
        let nameless = |expression| !order.function.named_expressions.contains_key(&expression);
        let unlike = footprint::is_atomic(order.module, order.function, *pointer);
        if loaded == *pointer
            && can_assign(op)
            && single(*value)
            && single(left)
            && nameless(*value)
            && nameless(left)
            && !unlike
            && is_written_so(order, statement)
        {
            found.insert(step, (*value, left));
        }
    }
    found
}

/// Whether the source has `x op= y` or `x++` here; without a source, it might have.
fn is_written_so(order: &Order, statement: &Statement) -> bool {
    let Statement::Store { value, .. } = statement else { return false };
    let range = order.function.expressions.get_span(*value).to_range();
    let written = range.and_then(|range| order.source.get(range)).unwrap_or_default();
    written.is_empty()
        || ["+=", "-=", "*=", "&=", "|=", "^=", "++", "--"].iter().any(|operator| written.contains(operator))
}

/// Division, remainder and shifts are left out: they need more than GLSL's operator.
fn can_assign(op: BinaryOperator) -> bool {
    use BinaryOperator::{Add, And, ExclusiveOr, InclusiveOr, Multiply, Subtract};
    matches!(op, Add | Subtract | Multiply | And | ExclusiveOr | InclusiveOr)
}
