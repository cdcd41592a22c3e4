//! Which expressions need a variable of their own, and which may be written where they are used.
//!
//! In: the order of a function. Out: a [`Plan`]. The rule that keeps the printed program the same program: an expression
//! (or the result of a call or atomic) that is evaluated at step p may be written at its use at step q only if no step
//! between p and q conflicts with it: writes what it reads, or touches what it writes. An expression with effects may
//! moreover pass no statement at all, nor enter a place that evaluation can skip. Otherwise it is *baked*: it gets a
//! variable at p. A `let` of the source is always baked, under its name. Nothing is ever evaluated twice unless it is as
//! cheap to repeat as its variable would be to read.

use std::collections::{BTreeMap, BTreeSet};

use naga::{AddressSpace, Expression, Handle, LocalVariable, Statement};

use crate::analysis::{Order, Use};
use crate::candidates::{Circuit, Circuits, Compound, find_circuits, find_compound};
use crate::footprint::{self, Footprint, Place};

#[derive(Default)]
pub struct Plan {
    /// Expressions that get a variable where they are evaluated.
    pub baked: BTreeSet<Handle<Expression>>,
    /// Expressions that are used at all.
    pub live: BTreeSet<Handle<Expression>>,
    /// Short circuits, by the expression that stands for their value.
    pub circuits: BTreeMap<Handle<Expression>, Circuit>,
    /// Short circuits, by the step of the `if` that they were lowered to.
    pub circuit_steps: BTreeMap<usize, Handle<Expression>>,
    /// Steps of stores that print as `x op= y`.
    pub compound: BTreeSet<usize>,
}

impl Plan {
    pub fn is_circuit_variable(&self, local: Handle<LocalVariable>) -> bool {
        self.circuits.values().any(|circuit| circuit.variable == local)
    }
}

/// Decides; candidates that turn out not to fit are dropped and the rest is decided anew.
pub fn plan(order: &Order) -> Plan {
    let mut circuits = find_circuits(order);
    let mut compound = find_compound(order);
    loop {
        let decided = Decision::new(order, &circuits, &compound).decide();
        let bad_circuits: Vec<_> =
            circuits.values().filter(|circuit| !decided.fits(circuit)).map(|circuit| circuit.value).collect();
        let bad_stores: Vec<_> =
            compound.iter().filter(|(step, parts)| !decided.absorbs(**step, **parts)).map(|(step, _)| *step).collect();
        if bad_circuits.is_empty() && bad_stores.is_empty() {
            return decided.into_plan();
        }
        circuits.retain(|value, _| !bad_circuits.contains(value));
        compound.retain(|step, _| !bad_stores.contains(step));
    }
}

#[derive(Clone, Copy)]
struct Spot {
    step: usize,
    lazy: bool,
}

struct Decision<'a, 'm> {
    order: &'a Order<'m>,
    circuits: &'a Circuits,
    compound: &'a Compound,
    spots: BTreeMap<Handle<Expression>, Vec<Spot>>,
    times: BTreeMap<Handle<Expression>, usize>,
    baked: BTreeSet<Handle<Expression>>,
}

impl<'a, 'm> Decision<'a, 'm> {
    fn new(order: &'a Order<'m>, circuits: &'a Circuits, compound: &'a Compound) -> Self {
        Self { order, circuits, compound, spots: BTreeMap::new(), times: BTreeMap::new(), baked: BTreeSet::new() }
    }

    /// Users come after what they use, so going backwards every use is known when its operand is decided.
    fn decide(mut self) -> Self {
        let handles: Vec<_> = self.order.function.expressions.iter().map(|(handle, _)| handle).collect();
        for &expression in handles.iter().rev() {
            let (times, spots) = self.collect(expression);
            self.times.insert(expression, times);
            self.spots.insert(expression, spots);
            if self.must_bake(expression) {
                self.baked.insert(expression);
            }
        }
        self
    }

    fn collect(&self, expression: Handle<Expression>) -> (usize, Vec<Spot>) {
        let mut total = 0;
        let mut spots = Vec::new();
        for used in self.order.uses.get(&expression).into_iter().flatten() {
            match *used {
                Use::Step { step, times } => {
                    total += times;
                    spots.push(Spot { step, lazy: false });
                }
                // `x op= y` writes the pointer once, so the load within it uses nothing.
                Use::Expression { user, .. } if self.compound.values().any(|(_, load)| *load == user) => {}
                Use::Expression { user, .. } if self.circuits.contains_key(&user) => {}
                Use::Expression { user, times, lazy } => {
                    let user_times = self.times.get(&user).copied().unwrap_or_default();
                    if self.baked.contains(&user) {
                        total += times;
                        spots.extend(self.order.evaluated.get(&user).map(|step| Spot { step: *step, lazy }));
                    } else if user_times > 0 {
                        total += times * user_times;
                        let passed_on = self.spots.get(&user).into_iter().flatten();
                        spots.extend(passed_on.map(|spot| Spot { step: spot.step, lazy: spot.lazy || lazy }));
                    }
                }
            }
        }
        (total, spots)
    }

    fn must_bake(&self, expression: Handle<Expression>) -> bool {
        if !self.order.evaluated.contains_key(&expression)
            || self.order.is_pointer(expression)
            || self.is_opaque(expression)
        {
            return false;
        }
        if name_of(self.order, expression).is_some() {
            return true;
        }
        let times = self.times.get(&expression).copied().unwrap_or_default();
        match times {
            0 => false,
            1 => !self.may_move(expression),
            _ => !self.is_cheap(expression) || !self.may_move(expression),
        }
    }

    fn is_opaque(&self, expression: Handle<Expression>) -> bool {
        matches!(self.order.inner(expression), naga::TypeInner::Image { .. } | naga::TypeInner::Sampler { .. })
    }

    /// Writing it again costs no more than reading a variable would.
    fn is_cheap(&self, expression: Handle<Expression>) -> bool {
        match self.order.function.expressions[expression] {
            // Their base, if it is not cheap, is used twice itself, and so baked.
            Expression::AccessIndex { .. } | Expression::Swizzle { .. } => true,
            Expression::Load { pointer } => !self.circuits.contains_key(&expression) && self.is_cheap_pointer(pointer),
            _ => false,
        }
    }

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

    /// Where the expression is evaluated, the first step after that, and what it touches.
    fn origin(&self, expression: Handle<Expression>) -> Option<(usize, usize, Footprint)> {
        if let Some(circuit) = self.circuits.get(&expression) {
            return Some((circuit.first, circuit.end, self.circuit_footprint(circuit)));
        }
        let step = *self.order.evaluated.get(&expression)?;
        let mut footprint = self.order.steps[step].footprint.clone();
        // A call or atomic takes its operands along.
        if let Some(statement) = self.order.steps[step].statement {
            for operand in statement_operands(statement) {
                self.join_operands(operand, &mut footprint);
            }
        }
        Some((step, step + 1, footprint))
    }

    fn circuit_footprint(&self, circuit: &Circuit) -> Footprint {
        let mut footprint = Footprint::default();
        for step in &self.order.steps[circuit.first..circuit.end] {
            footprint.join(&step.footprint);
        }
        self.join_operands(circuit.left, &mut footprint);
        let own = |place: &Place| *place == Place::Local(circuit.variable);
        footprint.reads.retain(|place| !own(place));
        footprint.writes.retain(|place| !own(place) && !self.is_inner_variable(circuit, *place));
        footprint.reads.retain(|place| !self.is_inner_variable(circuit, *place));
        footprint
    }

    fn is_inner_variable(&self, circuit: &Circuit, place: Place) -> bool {
        let inner = |other: &Circuit| {
            place == Place::Local(other.variable) && circuit.first < other.first && other.end <= circuit.end
        };
        self.circuits.values().any(inner)
    }

    fn join_operands(&self, expression: Handle<Expression>, footprint: &mut Footprint) {
        if name_of(self.order, expression).is_some() {
            return;
        }
        let is_result =
            self.order.evaluated.get(&expression).is_some_and(|step| self.order.steps[*step].statement.is_some());
        if is_result || self.circuits.contains_key(&expression) {
            footprint.join(&self.origin(expression).map(|(_, _, own)| own).unwrap_or_default());
            return;
        }
        footprint.join(&footprint::of_expression(self.order.module, self.order.function, expression));
        for (operand, _, _) in self.order.operands(expression) {
            self.join_operands(operand, footprint);
        }
    }

    fn may_move(&self, expression: Handle<Expression>) -> bool {
        let Some((step, after, footprint)) = self.origin(expression) else { return true };
        let spots = self.spots.get(&expression).map(Vec::as_slice).unwrap_or_default();
        spots.iter().all(|spot| self.may_move_to(expression, (step, after), &footprint, *spot))
    }

    fn may_move_to(
        &self,
        expression: Handle<Expression>,
        (step, after): (usize, usize),
        footprint: &Footprint,
        to: Spot,
    ) -> bool {
        let Some(target) = self.order.steps.get(to.step) else { return false };
        let home = self.order.steps[step].block;
        let Some(enters_loop) = self.path(home, target.block) else { return false };
        if footprint.is_pure() {
            return !enters_loop || self.is_cheap(expression);
        }
        let passed = &self.order.steps[after.min(to.step)..to.step];
        if enters_loop || passed.iter().any(|between| between.footprint.conflicts(footprint)) {
            return false;
        }
        let stays = home == target.block && !to.lazy;
        if footprint.has_effect() {
            return stays && passed.iter().all(|between| between.statement.is_none());
        }
        stays || !footprint.uniform
    }

    /// Whether the way from a block into one of its descendants enters a loop; nothing if it is no descendant.
    fn path(&self, from: usize, to: usize) -> Option<bool> {
        let mut block = to;
        let mut enters_loop = false;
        while block != from {
            enters_loop |= self.order.blocks[block].is_loop;
            block = self.order.blocks[block].parent?;
        }
        Some(enters_loop)
    }

    /// Whether everything the short circuit's right side needs can be written within it.
    fn fits(&self, circuit: &Circuit) -> bool {
        let steps = circuit.first + 1..circuit.end;
        let baked = self
            .order
            .evaluated
            .iter()
            .any(|(expression, step)| steps.contains(step) && self.baked.contains(expression));
        let statements = steps.clone().all(|step| match self.order.steps[step].statement {
            None => true,
            Some(Statement::Store { .. }) => self.is_circuit_store(step),
            Some(Statement::If { .. }) => {
                self.circuits.values().any(|other| other.first == step && !self.baked.contains(&other.value))
            }
            Some(Statement::Call { result: Some(result), .. } | Statement::Atomic { result: Some(result), .. }) => {
                self.times.get(result) == Some(&1)
            }
            Some(_) => false,
        });
        let used =
            self.baked.contains(&circuit.value) || self.times.get(&circuit.value).is_some_and(|times| *times > 0);
        !baked && statements && used
    }

    fn is_circuit_store(&self, step: usize) -> bool {
        let block = self.order.steps[step].block;
        self.circuits.values().any(|circuit| circuit.first == self.order.blocks[block].owner)
    }

    /// Whether the store can print as `x op= y`.
    fn absorbs(&self, step: usize, (value, load): (Handle<Expression>, Handle<Expression>)) -> bool {
        let Some((evaluated, after, footprint)) = self.origin(load) else { return false };
        let spot = Spot { step, lazy: false };
        !self.baked.contains(&value) && self.may_move_to(load, (evaluated, after), &footprint, spot)
    }

    fn into_plan(self) -> Plan {
        let live = self.times.iter().filter(|(_, times)| **times > 0).map(|(expression, _)| *expression).collect();
        Plan {
            live,
            circuit_steps: self.circuits.values().map(|circuit| (circuit.first, circuit.value)).collect(),
            circuits: self.circuits.clone(),
            compound: self.compound.keys().copied().collect(),
            baked: self.baked,
        }
    }
}

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

/// The `let` name of an expression; `_ = x` is no name.
pub fn name_of<'m>(order: &Order<'m>, expression: Handle<Expression>) -> Option<&'m str> {
    order.function.named_expressions.get(&expression).map(String::as_str).filter(|name| *name != "phony")
}
