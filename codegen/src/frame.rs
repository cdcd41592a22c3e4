//! The lowered frame of a plan: a flat list of commands over physical resources.
//!
//! [`lower`] creates it from the steps of a plan. Every device runs it through the cursor of `fragbuf-frame`, and the manifest lists
//! it. Loop limits, ranges and symbols are formulas without values.
//!
//! An exchange of two resources is not a command. It swaps the meaning of two names from there on, so every command has a [`Parity`]
//! per exchange.

mod lower;

pub(crate) use lower::{LoweredSteps, LoweringContext, lower};

use std::ops::Deref;

use fragbuf_templates::vocabulary::{HostFunction, Pass};

use crate::{Quantity, SymbolId};

/// The index of a resource in the plan.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct ResourceId(pub usize);

/// The index of a pass in the plan.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct PassId(pub usize);

/// The index of a loop in the frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct LoopId(pub usize);

/// The commands of a frame.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LoweredFrame {
    /// The commands, in order.
    pub commands: Vec<Command>,
    /// The loops, in the order of their first commands.
    pub loops: Vec<Loop>,
    /// Pairs of resources that the frame exchanges. No resource is in two pairs.
    pub exchanges: Vec<[ResourceId; 2]>,
    /// For each exchange, its parity at the end of the frame.
    pub end: Vec<Parity>,
}

/// One command.
#[derive(Clone, Debug, PartialEq)]
pub struct Command {
    /// The action.
    pub action: Action,
    /// For each exchange, its parity at this command.
    pub parities: Vec<Parity>,
}

/// The action of a command.
#[derive(Clone, Debug, PartialEq)]
pub enum Action {
    /// Sets every word of a resource to `value`.
    Clear {
        /// The resource.
        resource: ResourceId,
        /// The word.
        value: u32,
    },
    /// Copies a resource to another of the same shape.
    Copy {
        /// The source.
        from: ResourceId,
        /// The destination.
        to: ResourceId,
    },
    /// Draws or dispatches a pass.
    Pass(PassId),
    /// Begins a loop. The commands up to its end are its body.
    Loop(LoopId),
    /// Ends the body of a loop.
    LoopEnd(LoopId),
    /// Runs a host function. The frame continues after the words that it reads have been read back, unless the device uses the values of
    /// an earlier frame ([`Decision::may_lag`]).
    Host(Decision),
}

/// A loop.
#[derive(Clone, Debug, PartialEq)]
pub struct Loop {
    /// The index of the command [`Action::Loop`]; the body begins after it.
    pub begin: usize,
    /// The index of the command [`Action::LoopEnd`].
    pub end: usize,
    /// The condition that ends it before its limit.
    pub until: LoopUntil,
    /// The limit of iterations; the exact number if no condition ends the loop.
    pub max_iterations: Quantity,
}

/// The condition that ends a loop before its limit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LoopUntil {
    /// No condition.
    Times,
    /// The first word of this resource is zero after an iteration.
    WordIsZero(ResourceId),
    /// No sample passed in this pass during the iteration.
    NoSamples(PassId),
}

/// A call of a host function.
#[derive(Clone, Debug, PartialEq)]
pub struct Decision {
    /// The key of its row on the axis `host`.
    pub name: String,
    /// The function.
    pub function: HostFunction,
    /// The words that it reads, in order.
    pub reads: Vec<Range>,
    /// The symbols that it sets, in order.
    pub sets: Vec<SymbolId>,
    /// Whether a frame may use the values that the words of an earlier frame gave.
    pub may_lag: bool,
}

/// Words of a resource.
#[derive(Clone, Debug, PartialEq)]
pub struct Range {
    /// The resource.
    pub resource: ResourceId,
    /// The first word.
    pub first: Quantity,
    /// The number of words.
    pub count: Quantity,
}

/// The condition under which two resources are exchanged: either `is_odd` is true, or the total of finished iterations of `loops` is
/// odd, but not both. Iterations are counted over the whole frame.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Parity {
    /// Whether the number of exchanges outside of loops before this command is odd.
    pub is_odd: bool,
    /// The loops that exchange the two an odd number of times per iteration.
    pub loops: Vec<LoopId>,
}

/// A pass with resolved formulas.
#[derive(Clone, Debug, PartialEq)]
pub struct PlannedPass {
    /// The pass.
    pub pass: Pass,
    /// Workgroups in x, y and z; empty for a draw.
    pub groups: Vec<Quantity>,
    /// The reference value of its stencil test.
    pub reference: Option<Quantity>,
    /// Samples per pixel, and the mask of the samples that are written.
    pub samples: Option<[Quantity; 2]>,
}

impl Deref for PlannedPass {
    type Target = Pass;

    fn deref(&self) -> &Pass {
        &self.pass
    }
}

impl Parity {
    /// Tests whether the two are exchanged after these finished iterations of each loop.
    pub fn is_flipped(&self, finished: &[u32]) -> bool {
        let iterations = self.loops.iter().map(|id| finished.get(id.0).copied().unwrap_or(0) % 2).sum::<u32>();
        self.is_odd != (iterations % 2 == 1)
    }
}

impl LoweredFrame {
    /// Tests whether the condition of a loop depends on the samples of a pass.
    pub fn waits_for_samples(&self, pass: PassId) -> bool {
        self.loops.iter().any(|looped| looped.until == LoopUntil::NoSamples(pass))
    }

    /// Returns the index of the exchange that includes `resource`.
    pub fn exchange_of(&self, resource: ResourceId) -> Option<usize> {
        self.exchanges.iter().position(|pair| pair.contains(&resource))
    }

    /// Returns the physical resource of `resource`, given the bit mask of exchanged pairs.
    pub fn physical(&self, resource: ResourceId, flipped: u32) -> ResourceId {
        match self.exchange_of(resource) {
            Some(number) if flipped >> number & 1 == 1 => {
                let [a, b] = self.exchanges[number];
                if resource == a { b } else { a }
            }
            _ => resource,
        }
    }

    /// Returns the calls of host functions, in order.
    pub fn decisions(&self) -> impl Iterator<Item = &Decision> {
        self.commands.iter().filter_map(|command| match &command.action {
            Action::Host(decision) => Some(decision),
            _ => None,
        })
    }
}
