//! Decides which expressions get a variable and which print at their use.
//!
//! Input: the order of a function. Output: a [`Plan`]. One rule preserves the meaning. Let an expression, or the result of a
//! call or atomic, be evaluated at step p. It may print at its use at step q only if no step between p and q conflicts with
//! it, that is, writes what it reads or accesses what it writes. An expression with effects may also pass no statement and
//! enter no operand that evaluation can skip. Otherwise it is *baked*, in naga's term: it gets a variable at p. A `let` of
//! the source is always baked, under its name. An expression prints twice only if repeating it costs no more than reading
//! a variable.

use std::collections::{BTreeMap, BTreeSet};

use naga::{AddressSpace, Expression, Handle, LocalVariable, Statement};

use crate::analysis::{Order, Use};
use crate::candidates::{
    CompoundAssignments, ShortCircuit, ShortCircuits, find_compound_assignments, find_short_circuits,
};
use crate::footprint::{self, Footprint, MemoryObject};
use crate::per_expression::PerExpression;

/// The decisions for one function.
pub struct Plan {
    /// Expressions that get a variable where they are evaluated.
    pub baked: PerExpression<bool>,
    /// Expressions that are used.
    pub live: PerExpression<bool>,
    /// Short circuits, by the expression that loads their value.
    pub short_circuits: BTreeMap<Handle<Expression>, ShortCircuit>,
    /// Short circuits, by the step of the `if` that they were lowered to.
    pub short_circuit_steps: BTreeMap<usize, Handle<Expression>>,
    /// Steps of stores that print as `x op= y`.
    pub compound: BTreeSet<usize>,
}

impl Plan {
    /// Tests whether a variable exists only for a short circuit.
    pub fn is_short_circuit_variable(&self, local: Handle<LocalVariable>) -> bool {
        self.short_circuits.values().any(|circuit| circuit.variable == local)
    }
}

/// Plans a function. Drops the candidates that do not fit and decides again until all fit.
pub fn plan(order: &Order) -> Plan {
    let mut short_circuits = find_short_circuits(order);
    let mut compound = find_compound_assignments(order);
    loop {
        let decision = Decision::new(order, &short_circuits, &compound).decide();
        let bad_circuits: Vec<_> = short_circuits
            .values()
            .filter(|circuit| !decision.fits_short_circuit(circuit))
            .map(|circuit| circuit.value)
            .collect();
        let bad_stores: Vec<_> = compound
            .iter()
            .filter(|(step, parts)| !decision.fits_compound_assignment(**step, **parts))
            .map(|(step, _)| *step)
            .collect();
        if bad_circuits.is_empty() && bad_stores.is_empty() {
            return decision.into_plan();
        }
        short_circuits.retain(|value, _| !bad_circuits.contains(value));
        compound.retain(|step, _| !bad_stores.contains(step));
    }
}

/// A step that uses an expression; a lazy use may be skipped.
#[derive(Clone, Copy)]
struct UseSite {
    step: usize,
    lazy: bool,
}

/// The steps that evaluate an expression, and the memory that they access.
struct Evaluation {
    first: usize,
    /// The first step after the evaluation.
    end: usize,
    footprint: Footprint,
}

/// One attempt at a plan, with the given candidates.
struct Decision<'a, 'm> {
    order: &'a Order<'m>,
    short_circuits: &'a ShortCircuits,
    compound: &'a CompoundAssignments,
    /// The steps at which an expression prints, through all users that are not baked.
    sites: PerExpression<Vec<UseSite>>,
    /// How often an expression prints.
    times: PerExpression<usize>,
    baked: PerExpression<bool>,
}

impl<'a, 'm> Decision<'a, 'm> {
    fn new(order: &'a Order<'m>, short_circuits: &'a ShortCircuits, compound: &'a CompoundAssignments) -> Self {
        let function = order.function;
        Self {
            order,
            short_circuits,
            compound,
            sites: PerExpression::new(function),
            times: PerExpression::new(function),
            baked: PerExpression::new(function),
        }
    }

    /// Decides all expressions, from last to first: users follow their operands, so every use of an operand is decided
    /// before it.
    fn decide(mut self) -> Self {
        let handles: Vec<_> = self.order.function.expressions.iter().map(|(handle, _)| handle).collect();
        for &expression in handles.iter().rev() {
            let (times, sites) = self.collect(expression);
            self.times[expression] = times;
            self.sites[expression] = sites;
            self.baked[expression] = self.must_bake(expression);
        }
        self
    }

    /// Returns how often an expression prints, and at which steps.
    fn collect(&self, expression: Handle<Expression>) -> (usize, Vec<UseSite>) {
        let mut total = 0;
        let mut sites = Vec::new();
        for used in &self.order.uses[expression] {
            match *used {
                Use::Step { step, times } => {
                    total += times;
                    sites.push(UseSite { step, lazy: false });
                }
                // `x op= y` prints the pointer once, so the load within it is no use.
                Use::Expression { user, .. } if self.compound.values().any(|(_, load)| *load == user) => {}
                Use::Expression { user, .. } if self.short_circuits.contains_key(&user) => {}
                Use::Expression { user, times, lazy } => {
                    let user_times = self.times[user];
                    if self.baked[user] {
                        total += times;
                        sites.extend(self.order.evaluated[user].map(|step| UseSite { step, lazy }));
                    } else if user_times > 0 {
                        total += times * user_times;
                        let passed_on = self.sites[user].iter();
                        sites.extend(passed_on.map(|site| UseSite { step: site.step, lazy: site.lazy || lazy }));
                    }
                }
            }
        }
        (total, sites)
    }

    /// Tests whether an expression needs a variable.
    fn must_bake(&self, expression: Handle<Expression>) -> bool {
        if self.order.evaluated[expression].is_none() || self.order.is_pointer(expression) || self.is_opaque(expression)
        {
            return false;
        }
        if name_of(self.order, expression).is_some() {
            return true;
        }
        match self.times[expression] {
            0 => false,
            1 => !self.may_move(expression),
            _ => !self.is_cheap(expression) || !self.may_move(expression),
        }
    }

    fn is_opaque(&self, expression: Handle<Expression>) -> bool {
        matches!(self.order.inner(expression), naga::TypeInner::Image { .. } | naga::TypeInner::Sampler { .. })
    }

    /// Tests whether repeating an expression costs no more than reading a variable.
    fn is_cheap(&self, expression: Handle<Expression>) -> bool {
        match self.order.function.expressions[expression] {
            // A base that is not cheap is also used twice, so it is baked.
            Expression::AccessIndex { .. } | Expression::Swizzle { .. } => true,
            Expression::Load { pointer } => {
                !self.short_circuits.contains_key(&expression) && self.is_cheap_pointer(pointer)
            }
            _ => false,
        }
    }

    /// Tests whether a load from a pointer costs no more than reading a variable.
    fn is_cheap_pointer(&self, pointer: Handle<Expression>) -> bool {
        match self.order.function.expressions[pointer] {
            Expression::AccessIndex { base, .. } => self.is_cheap_pointer(base),
            Expression::LocalVariable(_) | Expression::FunctionArgument(_) => true,
            Expression::GlobalVariable(global) => {
                matches!(
                    self.order.module.global_variables[global].space,
                    AddressSpace::Private | AddressSpace::Uniform
                )
            }
            _ => false,
        }
    }

    /// Returns the evaluation of an expression; none for constants, arguments and variables.
    fn evaluation(&self, expression: Handle<Expression>) -> Option<Evaluation> {
        if let Some(circuit) = self.short_circuits.get(&expression) {
            let footprint = self.short_circuit_footprint(circuit);
            return Some(Evaluation { first: circuit.first, end: circuit.end, footprint });
        }
        let step = self.order.evaluated[expression]?;
        let mut footprint = self.order.steps[step].footprint.clone();
        // The operands of a call or atomic move with it.
        if let Some(statement) = self.order.steps[step].statement {
            for operand in statement_operands(statement) {
                self.join_operands(operand, &mut footprint);
            }
        }
        Some(Evaluation { first: step, end: step + 1, footprint })
    }

    /// Returns the footprint of a short circuit, without the variables that it does not print.
    fn short_circuit_footprint(&self, circuit: &ShortCircuit) -> Footprint {
        let mut footprint = Footprint::default();
        for step in &self.order.steps[circuit.first..circuit.end] {
            footprint.join(&step.footprint);
        }
        self.join_operands(circuit.left, &mut footprint);
        let is_internal = |object: &MemoryObject| {
            *object == MemoryObject::Local(circuit.variable) || self.is_inner_variable(circuit, *object)
        };
        footprint.reads.retain(|object| !is_internal(object));
        footprint.writes.retain(|object| !is_internal(object));
        footprint
    }

    /// Tests whether an object is the variable of a short circuit inside this one.
    fn is_inner_variable(&self, circuit: &ShortCircuit, object: MemoryObject) -> bool {
        let inner = |other: &ShortCircuit| {
            object == MemoryObject::Local(other.variable) && circuit.first < other.first && other.end <= circuit.end
        };
        self.short_circuits.values().any(inner)
    }

    /// Adds the footprint of an operand that prints within its user.
    fn join_operands(&self, expression: Handle<Expression>, footprint: &mut Footprint) {
        if name_of(self.order, expression).is_some() {
            return;
        }
        let is_result = self.order.evaluated[expression].is_some_and(|step| self.order.steps[step].statement.is_some());
        if is_result || self.short_circuits.contains_key(&expression) {
            if let Some(evaluation) = self.evaluation(expression) {
                footprint.join(&evaluation.footprint);
            }
            return;
        }
        footprint.join(&footprint::of_expression(self.order.module, self.order.function, expression));
        for (operand, _, _) in self.order.operands(expression) {
            self.join_operands(operand, footprint);
        }
    }

    /// Tests whether an expression may print at all its uses.
    fn may_move(&self, expression: Handle<Expression>) -> bool {
        let Some(evaluation) = self.evaluation(expression) else { return true };
        self.sites[expression].iter().all(|site| self.may_move_to(expression, &evaluation, *site))
    }

    /// Tests whether an expression may print at one use, by the rule above.
    fn may_move_to(&self, expression: Handle<Expression>, evaluation: &Evaluation, to: UseSite) -> bool {
        let Evaluation { first, end, ref footprint } = *evaluation;
        let Some(target) = self.order.steps.get(to.step) else { return false };
        let source = self.order.steps[first].block;
        let Some(enters_loop) = self.enters_loop(source, target.block) else { return false };
        if footprint.is_pure() {
            return !enters_loop || self.is_cheap(expression);
        }
        let passed = &self.order.steps[end.min(to.step)..to.step];
        if enters_loop || passed.iter().any(|between| between.footprint.conflicts(footprint)) {
            return false;
        }
        let stays = source == target.block && !to.lazy;
        if footprint.has_effect() {
            return stays && passed.iter().all(|between| between.statement.is_none());
        }
        stays || !footprint.uniform
    }

    /// Tests whether the path from a block to a descendant enters a loop. Returns none for blocks that are no descendants.
    fn enters_loop(&self, from: usize, to: usize) -> Option<bool> {
        let mut block = to;
        let mut enters_loop = false;
        while block != from {
            enters_loop |= self.order.blocks[block].is_loop;
            block = self.order.blocks[block].parent?;
        }
        Some(enters_loop)
    }

    /// Tests whether everything that the right side of a short circuit needs can print within it.
    fn fits_short_circuit(&self, circuit: &ShortCircuit) -> bool {
        let steps = circuit.first + 1..circuit.end;
        let is_within = |expression| self.order.evaluated[expression].is_some_and(|step| steps.contains(&step));
        let mut expressions = self.order.function.expressions.iter();
        let baked = expressions.any(|(expression, _)| self.baked[expression] && is_within(expression));
        let statements = steps.clone().all(|step| match self.order.steps[step].statement {
            None => true,
            Some(Statement::Store { .. }) => self.is_short_circuit_store(step),
            Some(Statement::If { .. }) => {
                self.short_circuits.values().any(|other| other.first == step && !self.baked[other.value])
            }
            Some(Statement::Call { result: Some(result), .. } | Statement::Atomic { result: Some(result), .. }) => {
                self.times[*result] == 1
            }
            Some(_) => false,
        });
        let used = self.baked[circuit.value] || self.times[circuit.value] > 0;
        !baked && statements && used
    }

    /// Tests whether a store sets the variable of a short circuit.
    fn is_short_circuit_store(&self, step: usize) -> bool {
        let block = self.order.steps[step].block;
        self.short_circuits.values().any(|circuit| circuit.first == self.order.blocks[block].owner)
    }

    /// Tests whether a store can print as `x op= y`.
    fn fits_compound_assignment(&self, step: usize, (value, load): (Handle<Expression>, Handle<Expression>)) -> bool {
        let Some(evaluation) = self.evaluation(load) else { return false };
        let site = UseSite { step, lazy: false };
        !self.baked[value] && self.may_move_to(load, &evaluation, site)
    }

    fn into_plan(self) -> Plan {
        let mut live = PerExpression::new(self.order.function);
        self.order.function.expressions.iter().for_each(|(used, _)| live[used] = self.times[used] > 0);
        Plan {
            live,
            short_circuit_steps: self.short_circuits.values().map(|circuit| (circuit.first, circuit.value)).collect(),
            short_circuits: self.short_circuits.clone(),
            compound: self.compound.keys().copied().collect(),
            baked: self.baked,
        }
    }
}

/// Returns the operands of a call or atomic.
fn statement_operands(statement: &Statement) -> Vec<Handle<Expression>> {
    match *statement {
        Statement::Call { ref arguments, .. } => arguments.clone(),
        Statement::Atomic { pointer, ref fun, value, .. } => {
            let compare = match *fun {
                naga::AtomicFunction::Exchange { compare } => compare,
                _ => None,
            };
            [Some(pointer), Some(value), compare].into_iter().flatten().collect()
        }
        _ => Vec::new(),
    }
}

/// Returns the `let` name of an expression; `_ = x` is no name.
pub fn name_of<'m>(order: &Order<'m>, expression: Handle<Expression>) -> Option<&'m str> {
    order.function.named_expressions.get(&expression).map(String::as_str).filter(|name| *name != "phony")
}
