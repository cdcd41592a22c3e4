//! Closures of effects that can be interrupted between two fragments, as peeling requires: it passes fragments on in several
//! iterations, nearest first.
//!
//! Input: a checked closure of the form `{ let mut a = …; for f in fragments { … } value }`. Output: its parts before, in and after the
//! loop, as three functions, and the variables that are kept between them; or why there are none. Nothing is lowered here.

use std::collections::BTreeSet;

use fragbuf_model::SourceSpan;

use crate::tree::{Block, Expr, For, Function, Kind, Sequence, Statement, VariableId};
use crate::types::Type;

/// The parts of a closure.
pub(crate) struct Parts<'a> {
    /// The statements before the loop.
    pub before: &'a [Statement],
    pub each: &'a For,
    pub loop_span: &'a SourceSpan,
    /// The statements after the loop.
    pub after: &'a [Statement],
    pub value: Option<&'a Expr>,
    /// The variables that are kept, in the order of their declarations.
    pub kept: Vec<VariableId>,
    /// The declarations of other variables: their values are the same in every part, so each part computes those that it reads.
    pub constants: Vec<&'a Statement>,
}

/// Why a closure cannot be interrupted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Obstacle {
    /// It has no loop over the fragments outside of other blocks, or several.
    Loops,
    /// Its loop begins at the farthest fragment.
    Reversed,
    /// It reads a fragment by its index, or the number of fragments.
    Indexed,
    /// A variable that is kept has no words, such as a fragment.
    Variable,
    /// It returns before the loop.
    Return,
}

impl Obstacle {
    /// Returns what to change, beginning with a verb.
    pub(crate) fn help(self) -> &'static str {
        match self {
            Obstacle::Loops => {
                "read the fragments in one loop, outside of other blocks: `let mut a = …; for f in fragments { … } value`"
            }
            Obstacle::Reversed => {
                "begin the loop at the nearest fragment: remove `.rev()`, and weight each fragment by the light that passes those in front of it"
            }
            Obstacle::Indexed => {
                "read the fragments in one loop, without `fragments[i]` and `fragments.len()`: keep what a later one needs in a variable"
            }
            Obstacle::Variable => "keep the attributes of a fragment in variables, and not the fragment",
            Obstacle::Return => "move the `return` behind the beginning of the loop",
        }
    }
}

/// Returns the parts of a closure.
pub(crate) fn parts(function: &Function) -> Result<Parts<'_>, Obstacle> {
    let Block { statements, value, .. } = &function.body;
    let is_loop = |statement: &Statement| matches!(statement, Statement::Expr(expr) if each_fragment(expr).is_some());
    let at = statements.iter().position(is_loop).ok_or(Obstacle::Loops)?;
    let (before, rest) = statements.split_at(at);
    let Some((Statement::Expr(looped), after)) = rest.split_first() else { return Err(Obstacle::Loops) };
    let each = each_fragment(looped).ok_or(Obstacle::Loops)?;
    if matches!(each.sequence, Sequence::Fragments { reversed: true, .. }) {
        return Err(Obstacle::Reversed);
    }
    let mut obstacles = Vec::new();
    let note = &mut |expr: &Expr| obstacles.extend(obstacle(&expr.kind));
    before.iter().chain(after).for_each(|statement| in_statement(statement, note));
    in_block(&each.body, note);
    value.iter().for_each(|value| in_expr(value, note));
    let mut returns = false;
    before
        .iter()
        .for_each(|statement| in_statement(statement, &mut |expr| returns |= matches!(expr.kind, Kind::Return(_))));
    obstacles.extend(returns.then_some(Obstacle::Return));
    match obstacles.first() {
        Some(obstacle) => Err(*obstacle),
        None => {
            let parts = Parts {
                before,
                each,
                loop_span: &looped.span,
                after,
                value: value.as_deref(),
                kept: Vec::new(),
                constants: Vec::new(),
            };
            with_variables(parts, function)
        }
    }
}

/// Divides the variables that are declared before the loop.
fn with_variables<'a>(parts: Parts<'a>, function: &Function) -> Result<Parts<'a>, Obstacle> {
    let mut later = BTreeSet::new();
    let mut note = |expr: &Expr| later.extend(variable(&expr.kind));
    in_block(&parts.each.body, &mut note);
    parts.after.iter().for_each(|statement| in_statement(statement, &mut note));
    parts.value.iter().for_each(|value| in_expr(value, &mut note));
    let (mut constants, mut constant_ids, mut kept) = (Vec::new(), BTreeSet::new(), Vec::new());
    for statement in parts.before {
        let Statement::Let { variable: Some(id), value, .. } = statement else { continue };
        let ty = function
            .variables
            .get(*id)
            .map_or(Type::Error, |variable| function.inference.resolve_or_default(variable.ty));
        if !ty.is_value() {
            continue;
        }
        let mut is_constant = !function.is_mutable(*id);
        in_expr(value, &mut |expr| {
            is_constant &= variable(&expr.kind).is_none_or(|read| constant_ids.contains(&read));
            is_constant &= !matches!(expr.kind, Kind::Block(_) | Kind::For(_) | Kind::Assign { .. });
        });
        if is_constant {
            constant_ids.insert(*id);
            constants.push(statement);
        } else if later.contains(id) {
            if ty == Type::Fragment {
                return Err(Obstacle::Variable);
            }
            kept.push(*id);
        }
    }
    Ok(Parts { kept, constants, ..parts })
}

impl<'a> Parts<'a> {
    /// Returns the declarations of constants that a part reads, directly or through other constants.
    pub(crate) fn constants_of(&self, statements: &[Statement], value: Option<&Expr>) -> Vec<&'a Statement> {
        let mut read = BTreeSet::new();
        let mut note = |expr: &Expr| read.extend(variable(&expr.kind));
        statements.iter().for_each(|statement| in_statement(statement, &mut note));
        value.iter().for_each(|value| in_expr(value, &mut note));
        self.declarations(read)
    }

    /// As [`Parts::constants_of`], for what is before the loop.
    pub(crate) fn constants_before(&self) -> Vec<&'a Statement> {
        let mut read = BTreeSet::new();
        let mut note = |expr: &Expr| read.extend(variable(&expr.kind));
        let others = self.before.iter().filter(|statement| !self.is_constant(statement));
        others.for_each(|statement| in_statement(statement, &mut note));
        self.declarations(read)
    }

    /// Returns whether a statement declares a constant.
    pub(crate) fn is_constant(&self, statement: &Statement) -> bool {
        self.constants.iter().any(|other| std::ptr::eq(*other, statement))
    }

    fn declarations(&self, mut read: BTreeSet<VariableId>) -> Vec<&'a Statement> {
        let mut needed = Vec::new();
        for statement in self.constants.iter().rev() {
            let Statement::Let { variable: Some(id), value, .. } = statement else { continue };
            if read.contains(id) {
                in_expr(value, &mut |expr| read.extend(variable(&expr.kind)));
                needed.push(*statement);
            }
        }
        needed.reverse();
        needed
    }
}

/// Returns the loop over the fragments that an expression is.
fn each_fragment(expr: &Expr) -> Option<&For> {
    match &expr.kind {
        Kind::For(each) if matches!(each.sequence, Sequence::Fragments { .. }) => Some(each),
        _ => None,
    }
}

fn obstacle(kind: &Kind) -> Option<Obstacle> {
    match kind {
        Kind::Layer(_) | Kind::LayerCount => Some(Obstacle::Indexed),
        Kind::For(each) if matches!(each.sequence, Sequence::Fragments { .. }) => Some(Obstacle::Loops),
        _ => None,
    }
}

fn variable(kind: &Kind) -> Option<VariableId> {
    match kind {
        Kind::Variable(id) => Some(*id),
        _ => None,
    }
}

/// Visits an expression and all expressions in it.
fn in_expr(expr: &Expr, visit: &mut dyn FnMut(&Expr)) {
    visit(expr);
    expr.kind.operands().into_iter().for_each(|operand| in_expr(operand, visit));
    if let Some(block) = expr.kind.block() {
        in_block(block, visit);
    }
}

fn in_block(block: &Block, visit: &mut dyn FnMut(&Expr)) {
    block.statements.iter().for_each(|statement| in_statement(statement, visit));
    block.value.iter().for_each(|value| in_expr(value, visit));
}

fn in_statement(statement: &Statement, visit: &mut dyn FnMut(&Expr)) {
    match statement {
        Statement::Let { value, .. } | Statement::Expr(value) => in_expr(value, visit),
    }
}
