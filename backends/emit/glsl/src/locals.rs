//! Decides where each `var` is declared.
//!
//! naga hoists every `var` to the top of its function and leaves a store at its initialiser. Input: the order of a function.
//! Output: for each variable the store that becomes its declaration, or the statement that the declaration precedes. A
//! variable that each iteration initialises must be declared by its store. One that is initialised once must not be declared
//! inside a loop.

use std::collections::{BTreeMap, BTreeSet};

use naga::{Block, Expression, Handle, LocalVariable, Statement};

use crate::analysis::Order;
use crate::footprint::{self, MemoryObject};
use crate::schedule::Plan;

/// The declarations of a function.
#[derive(Default)]
pub struct Declarations {
    /// Steps of stores that declare the variable they store to.
    pub by_store: BTreeMap<usize, Handle<LocalVariable>>,
    /// Variables to declare, with their constant value, before a statement; by its step.
    pub before: BTreeMap<usize, Vec<Handle<LocalVariable>>>,
}

/// Decides the declarations of a function.
pub fn declarations(order: &Order, plan: &Plan) -> Declarations {
    let mut result = Declarations::default();
    let mut mentions: BTreeMap<Handle<LocalVariable>, Vec<usize>> = BTreeMap::new();
    for step in 0..order.steps.len() {
        for local in mentioned(order, step) {
            mentions.entry(local).or_default().push(step);
        }
    }
    for (local, steps) in mentions {
        if plan.is_short_circuit_variable(local) {
            continue;
        }
        match declaring_store(order, local, &steps) {
            Some(step) => drop(result.by_store.insert(step, local)),
            None => result.before.entry(statement_before(order, plan, local, &steps)).or_default().push(local),
        }
    }
    result
}

/// Returns the variables that the printed step mentions.
fn mentioned(order: &Order, step: usize) -> BTreeSet<Handle<LocalVariable>> {
    let entry = &order.steps[step];
    let accessed = entry.footprint.reads.iter().chain(&entry.footprint.writes);
    let mut locals: BTreeSet<_> = accessed
        .filter_map(|object| if let MemoryObject::Local(local) = object { Some(*local) } else { None })
        .collect();
    let pointers: Vec<Handle<Expression>> = match entry.statement {
        Some(Statement::Store { pointer, .. } | Statement::Atomic { pointer, .. }) => vec![*pointer],
        Some(Statement::Call { arguments, .. }) => arguments.clone(),
        _ => Vec::new(),
    };
    for pointer in pointers.into_iter().filter(|pointer| order.is_pointer(*pointer)) {
        if let Some(MemoryObject::Local(local)) = footprint::root(order.module, order.function, pointer) {
            locals.insert(local);
        }
    }
    locals
}

/// Returns the store that was the variable's initialiser, if all other mentions follow it inside its block.
fn declaring_store(order: &Order, local: Handle<LocalVariable>, mentions: &[usize]) -> Option<usize> {
    let first = *mentions.first()?;
    let entry = &order.steps[first];
    let Some(Statement::Store { pointer, .. }) = entry.statement else { return None };
    let whole = order.function.expressions[*pointer] == Expression::LocalVariable(local);
    let initialised = order.function.local_variables[local].init.is_some();
    let inside = mentions.iter().all(|step| ancestors(order, order.steps[*step].block).contains(&entry.block));
    (whole && inside && !initialised).then_some(first)
}

/// Returns a block and all blocks around it, innermost first.
fn ancestors(order: &Order, block: usize) -> Vec<usize> {
    std::iter::successors(Some(block), |block| order.blocks[*block].parent).collect()
}

/// Returns the innermost statement outside every loop that a declaration can precede to be visible at all mentions. The operand of
/// a short circuit is a block in the IR, but prints as a part of an expression, where nothing can be declared.
fn statement_before(order: &Order, plan: &Plan, local: Handle<LocalVariable>, mentions: &[usize]) -> usize {
    let first = mentions.first().copied().unwrap_or_default();
    let is_operand = |block: usize| block != 0 && plan.short_circuit_steps.contains_key(&order.blocks[block].owner);
    let common = ancestors(order, order.steps[first].block).into_iter().find(|candidate| {
        let contains_all = mentions.iter().all(|step| ancestors(order, order.steps[*step].block).contains(candidate));
        contains_all
            && !ancestors(order, *candidate).iter().any(|block| order.blocks[*block].is_loop || is_operand(*block))
    });
    let common = common.unwrap_or_default();
    // Climb from the first mention to the statement of the common block that contains it.
    let mut step = first;
    while order.steps[step].block != common {
        step = order.blocks[order.steps[step].block].owner;
    }
    let block = block_of(order, common);
    let first_statement = block.and_then(|block| statement_containing(order, block, step)).unwrap_or(step);
    block
        .and_then(|block| source_position(order, block, local))
        .map_or(first_statement, |position| position.min(first_statement))
}

/// Returns the block with an index.
fn block_of<'m>(order: &Order<'m>, id: usize) -> Option<&'m Block> {
    if id == 0 {
        return Some(&order.function.body);
    }
    let owner = order.steps[order.blocks[id].owner].statement?;
    let siblings = order
        .blocks
        .iter()
        .enumerate()
        .filter(|(_, block)| block.parent.is_some() && block.owner == order.blocks[id].owner);
    let position = siblings.map(|(sibling, _)| sibling).position(|sibling| sibling == id)?;
    footprint::inner_blocks(owner).get(position).copied()
}

/// Returns the step of the statement of a block that contains a step; an `Emit` is a statement.
fn statement_containing(order: &Order, block: &Block, step: usize) -> Option<usize> {
    block.iter().map(|statement| order.step_of(statement)).filter(|start| *start <= step).max()
}

/// Returns the first statement of the block that follows the variable's declaration in the source.
fn source_position(order: &Order, block: &Block, local: Handle<LocalVariable>) -> Option<usize> {
    let declared = order.function.local_variables.get_span(local).to_range()?;
    let after = |span: &naga::Span| {
        span.to_range().is_some_and(|range| range.start >= declared.start || range.end >= declared.end)
    };
    block.span_iter().find(|(_, span)| after(span)).map(|(statement, _)| order.step_of(statement))
}
