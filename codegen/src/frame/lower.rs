//! The steps of a plan, lowered: loops become their beginnings and ends, names become resources and symbols, exchanges
//! become parities.
//!
//! In: the steps, edited by every row, and the resources and symbols of the plan. Out: passes and commands. What cannot be
//! run is refused here, once for every device: two shapes exchanged, a loop that waits for what there is not.

use fragbuf_templates::Registry;
use fragbuf_templates::vocabulary::{
    Element, Formula, Host, Kind, Objects, Pass, Repeat, SetBy, Step, Until, When, Words,
};

use super::{Action, Command, Decision, Loop, LoopId, LoopUntil, LoweredFrame, Parity, PassId, PlannedPass, Range};
use crate::{Planned, Quantity, ResourceId, SymbolId, SymbolTable};

/// Passes in the order of the steps, and what is done with them.
pub(crate) struct Lowered {
    pub(crate) passes: Vec<PlannedPass>,
    pub(crate) frame: LoweredFrame,
}

/// Exchanges that one frame may have: a mask of them is one word.
const MOST_EXCHANGES: usize = 32;

/// What steps are lowered with.
pub(crate) struct Context<'a> {
    pub(crate) resources: &'a [Planned],
    /// The resources as rows name them: one that is a texture per word may have none of them in a plan.
    pub(crate) declared: &'a [String],
    pub(crate) symbols: &'a SymbolTable,
    pub(crate) registry: &'a Registry,
}

/// Lowers the steps of a plan. `Err`: what they say cannot be run, in words.
pub(crate) fn lower(steps: &[Step], context: &Context<'_>) -> Result<Lowered, String> {
    let mut lowering = Lowering { context, passes: Vec::new(), frame: LoweredFrame::default(), parities: Vec::new() };
    exchanges(steps, context, &mut lowering.frame.exchanges)?;
    lowering.parities = vec![Parity::default(); lowering.frame.exchanges.len()];
    lowering.steps(steps, Nesting::Outside)?;
    lowering.queries()?;
    lowering.frame.end = lowering.parities;
    Ok(Lowered { passes: lowering.passes, frame: lowering.frame })
}

struct Lowering<'a> {
    context: &'a Context<'a>,
    passes: Vec<PlannedPass>,
    frame: LoweredFrame,
    /// Whether the resources of each exchange stand for each other at the next command.
    parities: Vec<Parity>,
}

/// Whether steps are in a loop, whose parities hold for the loops inside of it too.
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
                    for (from, to) in self.context.alike(from, to)? {
                        self.push(Action::Copy { from, to });
                    }
                }
                Step::Swap(a, b) => {
                    for (a, _) in self.context.alike(a, b)? {
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
        let at_most = match &repeat.until {
            Until::Times(times) => times,
            _ => &repeat.at_most,
        };
        let at_most = self.context.quantity(at_most, "the iterations of a loop")?;
        if at_most.mentions(SymbolId::ITERATION) {
            return Err("the bound of a loop rests on `iteration`: it must be known before any loop begins".to_owned());
        }
        let id = LoopId(self.frame.loops.len());
        let begin = self.frame.commands.len();
        // The pass that a query names may come later in the body: it is looked up once all are known.
        let until = match &repeat.until {
            Until::Times(_) | Until::NoSamples(_) => LoopUntil::Times,
            Until::Zero(name) => LoopUntil::WordIsZero(self.context.buffer(name)?),
        };
        self.frame.loops.push(Loop { begin, end: begin, until, at_most });
        if nesting == Nesting::Outside {
            self.flip_by_iterations(&repeat.body, id)?;
        }
        let before = self.parities.clone();
        self.push(Action::Loop(id));
        let first = self.passes.len();
        self.steps(&repeat.body, Nesting::Inside)?;
        if let Until::NoSamples(anchor) = &repeat.until {
            let query = self.passes.iter().skip(first).position(|pass| pass.anchor == *anchor);
            let query = query
                .ok_or_else(|| format!("a loop waits for the samples of `{anchor}`, which is no pass of its body"))?;
            self.frame.loops[id.0].until = LoopUntil::NoSamples(PassId(first + query));
        }
        self.frame.loops[id.0].end = self.frame.commands.len();
        self.push(Action::LoopEnd(id));
        // What the body has exchanged counts as a finished iteration from here on.
        self.parities = before;
        Ok(())
    }

    /// Marks the loops, `first` and those in its body, that exchange a pair an odd number of times in each iteration.
    fn flip_by_iterations(&mut self, body: &[Step], first: LoopId) -> Result<(), String> {
        let mut bodies = vec![body];
        nested(body, &mut bodies);
        for (number, body) in bodies.into_iter().enumerate() {
            for step in body {
                let Step::Swap(a, b) = step else { continue };
                for (a, _) in self.context.alike(a, b)? {
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

    /// Visible objects are those of a query that there is.
    fn queries(&self) -> Result<(), String> {
        for pass in &self.passes {
            let Objects::Visible(query) = &pass.objects else { continue };
            let is_query = |other: &&PlannedPass| other.anchor == *query && other.objects == Objects::Boxes;
            if self.passes.iter().find(is_query).is_none() {
                return Err(format!(
                    "pass `{}` draws the objects visible in `{query}`, which is no pass that asks for boxes",
                    pass.anchor
                ));
            }
        }
        Ok(())
    }
}

/// The bodies of the loops in `steps`, in the order of their beginnings.
fn nested<'s>(steps: &'s [Step], bodies: &mut Vec<&'s [Step]>) {
    for step in steps {
        if let Step::Repeat(repeat) = step {
            bodies.push(&repeat.body);
            nested(&repeat.body, bodies);
        }
    }
}

/// Every pair that some step exchanges, once.
fn exchanges(steps: &[Step], context: &Context<'_>, pairs: &mut Vec<[ResourceId; 2]>) -> Result<(), String> {
    for step in steps {
        match step {
            Step::Swap(a, b) => {
                for (a, b) in context.alike(a, b)? {
                    let pair = [a.min(b), a.max(b)];
                    if pairs.contains(&pair) {
                        continue;
                    }
                    if a == b || pairs.iter().any(|known| known.contains(&a) || known.contains(&b)) {
                        let name = |id: ResourceId| &context.resources[id.0].resource.name;
                        return Err(format!(
                            "`{}` and `{}` are exchanged, and one of them with another too",
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
    if pairs.len() > MOST_EXCHANGES {
        return Err(format!("{} pairs of resources are exchanged, and there may be {MOST_EXCHANGES}", pairs.len()));
    }
    Ok(())
}

impl Context<'_> {
    /// The resources of a name: one, or the textures that hold a word of the entry each.
    fn resources(&self, name: &str) -> Result<Vec<ResourceId>, String> {
        let is_named = |planned: &Planned| {
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

    /// The buffer of a name.
    fn buffer(&self, name: &str) -> Result<ResourceId, String> {
        let is_texture = |id: &ResourceId| matches!(self.resources[id.0].resource.element, Element::Texture(_));
        match self.resources(name)?.as_slice() {
            [one] if !is_texture(one) => Ok(*one),
            _ => Err(format!("a step reads `{name}`, which is not one buffer")),
        }
    }

    /// Resources of two names, in pairs of one shape.
    fn alike(&self, a: &str, b: &str) -> Result<Vec<(ResourceId, ResourceId)>, String> {
        let (of_a, of_b) = (self.resources(a)?, self.resources(b)?);
        let shape = |id: &ResourceId| {
            let planned = &self.resources[id.0];
            (planned.resource.element, planned.words.formula())
        };
        let is_alike = of_a.len() == of_b.len() && of_a.iter().zip(&of_b).all(|(a, b)| shape(a) == shape(b));
        if !is_alike {
            return Err(format!("`{a}` takes the place of `{b}`, which has another shape"));
        }
        Ok(of_a.into_iter().zip(of_b).collect())
    }

    fn quantity(&self, formula: &Formula, what: &str) -> Result<Quantity, String> {
        self.symbols.compile(formula).map_err(|error| format!("{what}: {error}"))
    }

    fn pass(&self, pass: &Pass) -> Result<PlannedPass, String> {
        let what = format!("pass `{}`", pass.anchor);
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

    /// A formula for samples, which pipelines are made with.
    fn samples(&self, formula: &Formula, what: &str) -> Result<Quantity, String> {
        let quantity = self.quantity(formula, what)?;
        let is_known = |id: &SymbolId| *id == SymbolId::ITERATION || self.symbols.get(*id).when <= When::Generation;
        match quantity.symbols().into_iter().find(|id| !is_known(id)) {
            None => Ok(quantity),
            Some(id) => {
                let name = &self.symbols.get(id).name;
                Err(format!("{what}: its samples rest on `{name}`, which has no value when pipelines are made"))
            }
        }
    }

    fn decision(&self, host: &Host) -> Result<Decision, String> {
        let name = &host.function;
        let function = self.registry.row("host", name).and_then(|row| row.host);
        let function =
            function.ok_or_else(|| format!("a step calls the host function `{name}`, which does not exist"))?;
        let what = format!("what the host function `{name}` reads");
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
            let id = self.symbols.find(symbol).filter(|id| self.symbols.get(*id).set_by == SetBy::Host);
            sets.push(
                id.ok_or_else(|| format!("the host function `{name}` sets `{symbol}`, which a host does not set"))?,
            );
        }
        Ok(Decision { name: name.clone(), function, reads, sets })
    }
}
