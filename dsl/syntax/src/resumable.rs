//! Closures of effects that can be interrupted between two fragments, as peeling requires: it passes fragments on in several
//! iterations, nearest first.
//!
//! Input: a checked closure of the form `{ let mut a = …; for f in fragments { … } value }`. Output: its parts before, in and after the
//! loop, as three functions, and the variables that are kept between them; or why there are none. Nothing is lowered here.

use std::collections::BTreeSet;

use fragbuf_model::SourceSpan;
use fragbuf_model::resumable::Uninterruptible;

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
    /// It has no loop over the fragments.
    NoLoop,
    /// Its loop over the fragments is inside of another block.
    Nested,
    /// It has a second loop over the fragments.
    Second,
    /// Its loop begins at the farthest fragment.
    Reversed,
    /// It reads a fragment by its index.
    Indexed,
    /// It reads the number of fragments.
    Counted,
    /// A variable that is kept is a whole fragment.
    Fragment,
    /// It returns before the loop.
    Return,
}

impl Obstacle {
    /// Returns why the closure needs all fragments at once, and what to change.
    fn words(self) -> (&'static str, &'static str) {
        match self {
            Obstacle::NoLoop => ("it has no loop over them", "read them in a loop: `for f in fragments { … }`"),
            Obstacle::Nested => (
                "its loop over them is inside of another block",
                "move the loop to the level of the closure, and test the condition inside of it",
            ),
            Obstacle::Second => ("this is a second loop over them", "compute both in one loop"),
            Obstacle::Reversed => (
                "this loop begins at the farthest",
                "begin at the nearest, without `.rev()`: weight each fragment by the light that passes those in front of it",
            ),
            Obstacle::Indexed => (
                "it reads one by its index",
                "remember what a later fragment needs in a variable of the loop, such as `last = f.depth`",
            ),
            Obstacle::Counted => ("it reads their number", "count in the loop: `count += 1`"),
            Obstacle::Fragment => (
                "this variable keeps a whole fragment",
                "keep the attributes that are needed, each in a variable of its own",
            ),
            Obstacle::Return => ("it returns before its loop", "move the `return` into the loop or behind it"),
        }
    }

    fn at(self, span: &SourceSpan) -> Uninterruptible {
        let (reason, help) = self.words();
        Uninterruptible { span: span.clone(), reason, help }
    }
}

/// Returns the parts of a closure.
pub(crate) fn parts(function: &Function) -> Result<Parts<'_>, Uninterruptible> {
    let Block { statements, value, end } = &function.body;
    let is_loop = |statement: &Statement| matches!(statement, Statement::Expr(expr) if each_fragment(expr).is_some());
    let at = statements.iter().position(is_loop);
    let (before, rest) = statements.split_at(at.unwrap_or(statements.len()));
    let split = rest.split_first().and_then(|(first, after)| match first {
        Statement::Expr(looped) => Some((each_fragment(looped)?, looped, after)),
        Statement::Let { .. } => None,
    });
    let mut obstacles = Vec::new();
    let is_split = split.is_some();
    let note = &mut |expr: &Expr| obstacles.extend(obstacle(expr, is_split).map(|obstacle| obstacle.at(&expr.span)));
    before.iter().for_each(|statement| in_statement(statement, note));
    if let Some((each, _, after)) = split {
        in_block(&each.body, note);
        after.iter().for_each(|statement| in_statement(statement, note));
    }
    value.iter().for_each(|value| in_expr(value, note));
    let return_before = &mut |expr: &Expr| {
        let is_return = is_split && matches!(expr.kind, Kind::Return(_));
        obstacles.extend(is_return.then(|| Obstacle::Return.at(&expr.span)));
    };
    before.iter().for_each(|statement| in_statement(statement, return_before));
    let Some((each, looped, after)) = split else {
        return Err(obstacles.into_iter().next().unwrap_or_else(|| Obstacle::NoLoop.at(end)));
    };
    if matches!(each.sequence, Sequence::Fragments { reversed: true, .. }) {
        return Err(Obstacle::Reversed.at(&looped.span));
    }
    if let Some(obstacle) = obstacles.into_iter().next() {
        return Err(obstacle);
    }
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

/// Divides the variables that are declared before the loop.
fn with_variables<'a>(parts: Parts<'a>, function: &Function) -> Result<Parts<'a>, Uninterruptible> {
    let mut later = BTreeSet::new();
    let mut note = |expr: &Expr| later.extend(variable(&expr.kind));
    in_block(&parts.each.body, &mut note);
    parts.after.iter().for_each(|statement| in_statement(statement, &mut note));
    parts.value.iter().for_each(|value| in_expr(value, &mut note));
    let (mut constants, mut constant_ids, mut kept) = (Vec::new(), BTreeSet::new(), Vec::new());
    for statement in parts.before {
        let Statement::Let { variable: Some(id), value, span } = statement else { continue };
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
                return Err(Obstacle::Fragment.at(span));
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

/// Returns why an expression needs all fragments; `has_loop`: the closure has a loop that can be interrupted.
fn obstacle(expr: &Expr, has_loop: bool) -> Option<Obstacle> {
    match &expr.kind {
        Kind::Layer(_) => Some(Obstacle::Indexed),
        Kind::LayerCount => Some(Obstacle::Counted),
        _ if each_fragment(expr).is_some() => Some(if has_loop { Obstacle::Second } else { Obstacle::Nested }),
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
