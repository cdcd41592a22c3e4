//! Flattens the statements of a function into an ordered list of steps.
//!
//! A step is one evaluation of an expression, or one statement. Steps are numbered in source order, inner blocks included,
//! so that "between" is a range of numbers. `schedule` makes the decisions.

use std::collections::BTreeMap;

use naga::{
    AtomicFunction, BinaryOperator, Block, Expression, Function, Handle, MathFunction, Module, SampleLevel, ScalarKind,
    Statement, TypeInner,
};

use crate::footprint::{self, CallFootprints, Footprint};
use crate::per_expression::PerExpression;
use crate::types::numeric;

/// One evaluation of an expression, or one statement.
pub struct OrderedStep<'m> {
    pub block: usize,
    /// None for the evaluation of an expression and for a loop's `break if`.
    pub statement: Option<&'m Statement>,
    pub footprint: Footprint,
}

/// A block: its parent and the step that contains it.
pub struct BlockOrder {
    pub parent: Option<usize>,
    /// The step of the statement that contains the block.
    pub owner: usize,
    pub is_loop: bool,
}

/// A use of an operand. `times` is how often the user prints it; a `lazy` use may be skipped, as in `c ? a : b`.
#[derive(Clone, Copy)]
pub enum Use {
    Expression { user: Handle<Expression>, times: usize, lazy: bool },
    Step { step: usize, times: usize },
}

/// The steps of a function in source order, and the uses of its expressions.
pub struct Order<'m> {
    pub module: &'m Module,
    pub function: &'m Function,
    pub info: &'m naga::valid::FunctionInfo,
    pub source: &'m str,
    pub steps: Vec<OrderedStep<'m>>,
    pub blocks: Vec<BlockOrder>,
    /// The step that evaluates an expression; none for constants, arguments and variables.
    pub evaluated: PerExpression<Option<usize>>,
    pub uses: PerExpression<Vec<Use>>,
    /// Used for look-up only, so that addresses do not affect the output.
    statements: BTreeMap<*const Statement, usize>,
    /// The comparison value of each compare-exchange, by its result.
    pub compared: BTreeMap<Handle<Expression>, Handle<Expression>>,
}

impl<'m> Order<'m> {
    /// Analyses a function.
    pub fn new(
        module: &'m Module,
        function: &'m Function,
        info: &'m naga::valid::FunctionInfo,
        source: &'m str,
        calls: &CallFootprints,
    ) -> Self {
        let mut order = Self {
            module,
            function,
            info,
            source,
            steps: Vec::new(),
            blocks: vec![BlockOrder { parent: None, owner: 0, is_loop: false }],
            evaluated: PerExpression::new(function),
            uses: PerExpression::new(function),
            statements: BTreeMap::new(),
            compared: BTreeMap::new(),
        };
        order.walk(&function.body, 0, calls);
        for (user, _) in function.expressions.iter() {
            for (operand, times, lazy) in order.operands(user) {
                order.uses[operand].push(Use::Expression { user, times, lazy });
            }
        }
        order
    }

    /// Returns the step of a statement; for an `Emit`, that of its first expression.
    pub fn step_of(&self, statement: &Statement) -> usize {
        self.statements.get(&std::ptr::from_ref(statement)).copied().unwrap_or_default()
    }

    /// Returns the type of an expression.
    pub fn inner(&self, expression: Handle<Expression>) -> &TypeInner {
        self.info[expression].ty.inner_with(&self.module.types)
    }

    /// Tests whether an expression is a pointer.
    pub fn is_pointer(&self, expression: Handle<Expression>) -> bool {
        self.inner(expression).pointer_space().is_some()
    }

    /// Adds the steps of a block and of its inner blocks.
    fn walk(&mut self, block: &'m Block, id: usize, calls: &CallFootprints) {
        for statement in block {
            if let Statement::Emit(range) = statement {
                self.statements.insert(std::ptr::from_ref(statement), self.steps.len());
                for expression in range.clone() {
                    self.evaluated[expression] = Some(self.steps.len());
                    let footprint = footprint::of_expression(self.module, self.function, expression);
                    self.steps.push(OrderedStep { block: id, statement: None, footprint });
                }
                // naga leaves an empty range of unused expressions. Every statement has a step of its own.
                if range.clone().next().is_none() {
                    self.steps.push(OrderedStep { block: id, statement: None, footprint: Footprint::default() });
                }
                continue;
            }
            let step = self.steps.len();
            self.statements.insert(std::ptr::from_ref(statement), step);
            let footprint = footprint::of_statement(self.module, self.function, statement, calls);
            self.steps.push(OrderedStep { block: id, statement: Some(statement), footprint });
            self.record_uses(statement, step);
            for inner in footprint::inner_blocks(statement) {
                let inner_id = self.blocks.len();
                self.blocks.push(BlockOrder {
                    parent: Some(id),
                    owner: step,
                    is_loop: matches!(statement, Statement::Loop { .. }),
                });
                self.walk(inner, inner_id, calls);
                if let Statement::Loop { continuing, break_if: Some(condition), .. } = statement
                    && std::ptr::eq(inner, continuing)
                {
                    // The condition is evaluated at the end of the continuing block.
                    self.uses[*condition].push(Use::Step { step: self.steps.len(), times: 1 });
                    self.steps.push(OrderedStep { block: inner_id, statement: None, footprint: Footprint::default() });
                }
            }
        }
    }

    /// Records the operands and results of a statement.
    fn record_uses(&mut self, statement: &Statement, step: usize) {
        let mut results = Vec::new();
        let mut use_once = |operand: Handle<Expression>| {
            self.uses[operand].push(Use::Step { step, times: 1 });
        };
        match *statement {
            Statement::If { condition, .. } => use_once(condition),
            Statement::Switch { selector, .. } => use_once(selector),
            Statement::Return { value: Some(value) } => use_once(value),
            Statement::Store { pointer, value } => {
                use_once(pointer);
                use_once(value);
            }
            Statement::ImageStore { image, coordinate, array_index, value } => {
                [Some(image), Some(coordinate), array_index, Some(value)].into_iter().flatten().for_each(use_once);
            }
            Statement::ImageAtomic { image, coordinate, array_index, value, .. } => {
                [Some(image), Some(coordinate), array_index, Some(value)].into_iter().flatten().for_each(use_once);
            }
            Statement::Atomic { pointer, ref fun, value, result } => {
                use_once(pointer);
                use_once(value);
                if let AtomicFunction::Exchange { compare: Some(compare) } = *fun {
                    use_once(compare);
                    results.extend(result.map(|result| (result, compare)));
                }
                if let Some(result) = result {
                    self.evaluated[result] = Some(step);
                }
            }
            Statement::Call { ref arguments, result, .. } => {
                arguments.iter().copied().for_each(use_once);
                if let Some(result) = result {
                    self.evaluated[result] = Some(step);
                }
            }
            Statement::WorkGroupUniformLoad { pointer, result } => {
                use_once(pointer);
                self.evaluated[result] = Some(step);
            }
            _ => {}
        }
        self.compared.extend(results);
    }

    fn is_scalar_bool(&self, expression: Handle<Expression>) -> bool {
        matches!(self.inner(expression), TypeInner::Scalar(scalar) if scalar.kind == ScalarKind::Bool)
    }

    /// Returns the operands of an expression as printed: which, how often, and whether evaluation may skip them.
    pub fn operands(&self, expression: Handle<Expression>) -> Vec<(Handle<Expression>, usize, bool)> {
        let once = |operand: Handle<Expression>| (operand, 1, false);
        match self.function.expressions[expression] {
            Expression::Compose { ref components, .. } => components.iter().copied().map(once).collect(),
            Expression::Access { base, index } => vec![once(base), once(index)],
            Expression::AccessIndex { base, index } => {
                // `exchanged` prints as a comparison of the old value with the compared one.
                let compared = self.compared.get(&base).filter(|_| index == 1);
                std::iter::once(base).chain(compared.copied()).map(once).collect()
            }
            Expression::Splat { value, .. } => vec![once(value)],
            Expression::Swizzle { vector, .. } => vec![once(vector)],
            Expression::Load { pointer } => vec![once(pointer)],
            Expression::ImageSample { image, sampler, coordinate, array_index, offset, level, depth_ref, .. } => {
                let mut operands = vec![Some(image), Some(sampler), Some(coordinate), array_index, offset, depth_ref];
                match level {
                    SampleLevel::Exact(level) | SampleLevel::Bias(level) => operands.push(Some(level)),
                    SampleLevel::Gradient { x, y } => operands.extend([Some(x), Some(y)]),
                    SampleLevel::Auto | SampleLevel::Zero => {}
                }
                operands.into_iter().flatten().map(once).collect()
            }
            Expression::ImageLoad { image, coordinate, array_index, sample, level } => {
                [Some(image), Some(coordinate), array_index, sample, level].into_iter().flatten().map(once).collect()
            }
            Expression::ImageQuery { image, query } => match query {
                naga::ImageQuery::Size { level: Some(level) } => vec![once(image), once(level)],
                _ => vec![once(image)],
            },
            Expression::Unary { expr, .. } | Expression::Derivative { expr, .. } | Expression::As { expr, .. } => {
                vec![once(expr)]
            }
            Expression::Relational { argument, .. } => vec![once(argument)],
            Expression::Binary { op, left, right } => {
                let lazy = matches!(
                    op,
                    BinaryOperator::And
                        | BinaryOperator::InclusiveOr
                        | BinaryOperator::LogicalAnd
                        | BinaryOperator::LogicalOr
                ) && self.is_scalar_bool(left);
                vec![once(left), (right, 1, lazy)]
            }
            Expression::Select { condition, accept, reject } => {
                let lazy = self.is_scalar_bool(condition);
                vec![once(condition), (accept, 1, lazy), (reject, 1, lazy)]
            }
            Expression::Math { fun, arg, arg1, arg2, arg3 } => {
                // A dot product of integers prints component by component.
                let integers = numeric(self.inner(arg)).is_some_and(|(_, scalar)| scalar.kind != ScalarKind::Float);
                let times = if fun == MathFunction::Dot && integers { 2 } else { 1 };
                [Some(arg), arg1, arg2, arg3].into_iter().flatten().map(|operand| (operand, times, false)).collect()
            }
            Expression::ArrayLength(array) => vec![once(array)],
            _ => Vec::new(),
        }
    }
}
