//! Lowers the steps of a plan: loops become begin and end commands, names become resources and symbols, exchanges become
//! parities.
//!
//! Input: the steps after the edits of all rows, and the resources and symbols of the plan. Output: passes and commands. Steps that
//! cannot run are rejected here, once for every device: an exchange of two shapes, a loop that waits for a pass that does not exist.

use fragbuf_templates::Registry;
use fragbuf_templates::vocabulary::{
    BindingTime, Formula, Host, Kind, Objects, Pass, Repeat, Setter, Step, Until, Words,
};

use super::{Action, Command, Decision, Loop, LoopId, LoopUntil, LoweredFrame, Parity, PassId, PlannedPass, Range};
use crate::{PlannedResource, Quantity, ResourceId, SymbolId, SymbolTable};

/// The passes in the order of the steps, and the frame that runs them.
pub(crate) struct LoweredSteps {
    pub(crate) passes: Vec<PlannedPass>,
    pub(crate) frame: LoweredFrame,
}

/// The maximum number of exchanges of a frame, so that their bit mask fits in one word.
const MAX_EXCHANGES: usize = 32;

/// The parts of a plan that lowering reads.
pub(crate) struct LoweringContext<'a> {
    pub(crate) resources: &'a [PlannedResource],
    /// The names that rows declare. A resource with a texture per word may have no texture in a plan.
    pub(crate) declared: &'a [String],
    pub(crate) symbols: &'a SymbolTable,
    pub(crate) registry: &'a Registry,
}

/// Lowers the steps of a plan. Fails with a message if they cannot run.
pub(crate) fn lower(steps: &[Step], context: &LoweringContext<'_>) -> Result<LoweredSteps, String> {
    let mut lowering = Lowering { context, passes: Vec::new(), frame: LoweredFrame::default(), parities: Vec::new() };
    exchanges(steps, context, &mut lowering.frame.exchanges)?;
    lowering.parities = vec![Parity::default(); lowering.frame.exchanges.len()];
    lowering.steps(steps, Nesting::Outside)?;
    lowering.check_queries()?;
    lowering.frame.end = lowering.parities;
    Ok(LoweredSteps { passes: lowering.passes, frame: lowering.frame })
}

struct Lowering<'a> {
    context: &'a LoweringContext<'a>,
    passes: Vec<PlannedPass>,
    frame: LoweredFrame,
    /// For each exchange, its parity at the next command.
    parities: Vec<Parity>,
}

/// Whether steps are inside a loop. The outermost loop computes the parities of the loops inside it.
#[derive(Clone, Copy, PartialEq)]
enum Nesting {
    Outside,
    Inside,
}

impl Lowering<'_> {
    fn steps(&mut self, steps: &[Step], nesting: Nesting) -> Result<(), String> {
        for step in steps {
            match step {
                Step::Pass(pass) => {
                    self.passes.push(self.context.pass(pass)?);
                    self.push(Action::Pass(PassId(self.passes.len() - 1)));
                }
                Step::Clear { resource, value } => {
                    for resource in self.context.resources(resource)? {
                        self.push(Action::Clear { resource, value: *value });
                    }
                }
                Step::Copy { from, to } => {
                    for (from, to) in self.context.pairs(from, to)? {
                        self.push(Action::Copy { from, to });
                    }
                }
                Step::Swap(a, b) => {
                    for (a, _) in self.context.pairs(a, b)? {
                        if let Some(number) = self.frame.exchange_of(a) {
                            self.parities[number].is_odd = !self.parities[number].is_odd;
                        }
                    }
                }
                Step::Host(host) => {
                    let decision = self.context.decision(host)?;
                    self.push(Action::Host(decision));
                }
                Step::Repeat(repeat) => self.repeat(repeat, nesting)?,
            }
        }
        Ok(())
    }

    fn push(&mut self, action: Action) {
        self.frame.commands.push(Command { action, parities: self.parities.clone() });
    }

    fn repeat(&mut self, repeat: &Repeat, nesting: Nesting) -> Result<(), String> {
        let limit = match &repeat.until {
            Until::Times(times) => times,
            _ => &repeat.at_most,
        };
        let max_iterations = self.context.quantity(limit, "the iterations of a loop")?;
        if max_iterations.mentions(SymbolId::ITERATION) {
            return Err(
                "the limit of a loop depends on `iteration`: it must be known before any loop begins".to_owned()
            );
        }
        let id = LoopId(self.frame.loops.len());
        let begin = self.frame.commands.len();
        // The pass that a query names can follow in the body, so it is resolved after the body.
        let until = match &repeat.until {
            Until::Times(_) | Until::NoSamples(_) => LoopUntil::Times,
            Until::WordIsZero(name) => LoopUntil::WordIsZero(self.context.buffer(name)?),
        };
        self.frame.loops.push(Loop { begin, end: begin, until, max_iterations });
        if nesting == Nesting::Outside {
            self.add_loops_to_parities(&repeat.body, id)?;
        }
        let before = self.parities.clone();
        self.push(Action::Loop(id));
        let first = self.passes.len();
        self.steps(&repeat.body, Nesting::Inside)?;
        if let Until::NoSamples(name) = &repeat.until {
            let query = self.passes.iter().skip(first).position(|pass| pass.name == *name);
            let query = query
                .ok_or_else(|| format!("a loop waits for the samples of `{name}`, which is not a pass of its body"))?;
            self.frame.loops[id.0].until = LoopUntil::NoSamples(PassId(first + query));
        }
        self.frame.loops[id.0].end = self.frame.commands.len();
        self.push(Action::LoopEnd(id));
        // The exchanges of the body are counted by the finished iterations of the loop.
        self.parities = before;
        Ok(())
    }

    /// Adds to each parity the loops, `first` and those in its body, that exchange the pair an odd number of times per iteration.
    fn add_loops_to_parities(&mut self, body: &[Step], first: LoopId) -> Result<(), String> {
        let mut bodies = vec![body];
        nested(body, &mut bodies);
        for (number, body) in bodies.into_iter().enumerate() {
            for step in body {
                let Step::Swap(a, b) = step else { continue };
                for (a, _) in self.context.pairs(a, b)? {
                    let Some(parity) = self.frame.exchange_of(a).and_then(|at| self.parities.get_mut(at)) else {
                        continue;
                    };
                    let id = LoopId(first.0 + number);
                    match parity.loops.iter().position(|known| *known == id) {
                        Some(at) => drop(parity.loops.remove(at)),
                        None => parity.loops.push(id),
                    }
                }
            }
        }
        Ok(())
    }

    /// Checks that each pass that draws visible objects names a query of the frame.
    fn check_queries(&self) -> Result<(), String> {
        for pass in &self.passes {
            let Objects::Visible(query) = &pass.objects else { continue };
            let is_query = |other: &&PlannedPass| other.name == *query && other.objects == Objects::Boxes;
            if self.passes.iter().find(is_query).is_none() {
                return Err(format!(
                    "pass `{}` draws the objects visible in `{query}`, which is not a pass that draws boxes",
                    pass.name
                ));
            }
        }
        Ok(())
    }
}

/// Appends the bodies of the loops in `steps`, in the order in which the loops begin.
fn nested<'s>(steps: &'s [Step], bodies: &mut Vec<&'s [Step]>) {
    for step in steps {
        if let Step::Repeat(repeat) = step {
            bodies.push(&repeat.body);
            nested(&repeat.body, bodies);
        }
    }
}

/// Appends every pair that a step exchanges, once.
fn exchanges(steps: &[Step], context: &LoweringContext<'_>, pairs: &mut Vec<[ResourceId; 2]>) -> Result<(), String> {
    for step in steps {
        match step {
            Step::Swap(a, b) => {
                for (a, b) in context.pairs(a, b)? {
                    let pair = [a.min(b), a.max(b)];
                    if pairs.contains(&pair) {
                        continue;
                    }
                    if a == b || pairs.iter().any(|known| known.contains(&a) || known.contains(&b)) {
                        let name = |id: ResourceId| &context.resources[id.0].resource.name;
                        return Err(format!(
                            "`{}` and `{}` are exchanged: a resource can be exchanged with only one other resource",
                            name(a),
                            name(b)
                        ));
                    }
                    pairs.push(pair);
                }
            }
            Step::Repeat(repeat) => exchanges(&repeat.body, context, pairs)?,
            _ => {}
        }
    }
    if pairs.len() > MAX_EXCHANGES {
        return Err(format!("{} pairs of resources are exchanged; the limit is {MAX_EXCHANGES}", pairs.len()));
    }
    Ok(())
}

impl LoweringContext<'_> {
    /// Returns the resources of a name: one, or one texture per word of the entry.
    fn resources(&self, name: &str) -> Result<Vec<ResourceId>, String> {
        let is_named = |planned: &PlannedResource| {
            planned.resource.name == name || planned.part.as_ref().is_some_and(|part| part.of == name)
        };
        let found = self.resources.iter().enumerate().filter(|(_, planned)| is_named(planned));
        let found: Vec<ResourceId> = found.map(|(index, _)| ResourceId(index)).collect();
        let is_declared = self.declared.iter().any(|declared| declared == name);
        if found.is_empty() && !is_declared {
            Err(format!("a step names `{name}`, which the plan does not have"))
        } else {
            Ok(found)
        }
    }

    /// Returns the buffer of a name.
    fn buffer(&self, name: &str) -> Result<ResourceId, String> {
        let is_texture = |id: &ResourceId| self.resources[id.0].is_texture();
        match self.resources(name)?.as_slice() {
            [one] if !is_texture(one) => Ok(*one),
            _ => Err(format!("a step reads `{name}`, which is not one buffer")),
        }
    }

    /// Returns the resources of two names in pairs. Fails if the shapes of a pair differ.
    fn pairs(&self, a: &str, b: &str) -> Result<Vec<(ResourceId, ResourceId)>, String> {
        let (of_a, of_b) = (self.resources(a)?, self.resources(b)?);
        let shape = |id: &ResourceId| {
            let planned = &self.resources[id.0];
            (planned.resource.element, planned.words.formula())
        };
        let is_same = of_a.len() == of_b.len() && of_a.iter().zip(&of_b).all(|(a, b)| shape(a) == shape(b));
        if !is_same {
            return Err(format!("`{a}` cannot be copied to or exchanged with `{b}`: their shapes differ"));
        }
        Ok(of_a.into_iter().zip(of_b).collect())
    }

    fn quantity(&self, formula: &Formula, what: &str) -> Result<Quantity, String> {
        self.symbols.compile(formula).map_err(|error| format!("{what}: {error}"))
    }

    fn pass(&self, pass: &Pass) -> Result<PlannedPass, String> {
        let what = format!("pass `{}`", pass.name);
        let groups = match &pass.kind {
            Kind::Compute { groups } => {
                groups.iter().map(|formula| self.quantity(formula, &what)).collect::<Result<_, _>>()?
            }
            _ => Vec::new(),
        };
        let reference =
            pass.state.stencil.as_ref().map(|stencil| self.quantity(&stencil.reference, &what)).transpose()?;
        let samples = match &pass.state.samples {
            Some(samples) => Some([self.samples(&samples.count, &what)?, self.samples(&samples.mask, &what)?]),
            None => None,
        };
        Ok(PlannedPass { pass: pass.clone(), groups, reference, samples })
    }

    /// Compiles a formula over samples. Pipelines are created from its value.
    fn samples(&self, formula: &Formula, what: &str) -> Result<Quantity, String> {
        let quantity = self.quantity(formula, what)?;
        let is_known =
            |id: &SymbolId| *id == SymbolId::ITERATION || self.symbols.get(*id).when <= BindingTime::Generation;
        match quantity.symbols().into_iter().find(|id| !is_known(id)) {
            None => Ok(quantity),
            Some(id) => {
                let name = &self.symbols.get(id).name;
                Err(format!("{what}: its samples depend on `{name}`, which has no value when pipelines are created"))
            }
        }
    }

    fn decision(&self, host: &Host) -> Result<Decision, String> {
        let name = &host.function;
        let function = self.registry.row("host", name).and_then(|row| row.host);
        let function =
            function.ok_or_else(|| format!("a step calls the host function `{name}`, which does not exist"))?;
        let what = format!("a read of the host function `{name}`");
        let mut reads = Vec::new();
        for read in &host.reads {
            let resource = self.buffer(&read.resource)?;
            let (first, count) = match &read.words {
                Words::All => (self.quantity(&"0".into(), &what)?, self.resources[resource.0].words.clone()),
                Words::Some { first, count } => (self.quantity(first, &what)?, self.quantity(count, &what)?),
            };
            reads.push(Range { resource, first, count });
        }
        let mut sets = Vec::new();
        for symbol in &host.sets {
            let id = self.symbols.find(symbol).filter(|id| self.symbols.get(*id).set_by == Setter::Host);
            sets.push(id.ok_or_else(|| {
                format!("the host function `{name}` sets `{symbol}`, which host functions cannot set")
            })?);
        }
        Ok(Decision { name: name.clone(), function, reads, sets, may_lag: host.may_lag })
    }
}
