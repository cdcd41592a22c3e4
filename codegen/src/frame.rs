//! The lowered frame: what one frame of a plan does, as a flat list of commands over physical resources.
//!
//! In: nothing; [`lower`] makes it from the steps of a plan. Out: what every device runs, the manifest prints, and one
//! cursor steps through (`fragbuf-frame`). Nothing here has a value: loops, ranges and symbols are formulas.
//!
//! An exchange of two resources is no command. It flips which of the two a name stands for from there on, so every command
//! says by how many finished iterations of which loops the names have been flipped: a [`Parity`].

mod lower;

pub(crate) use lower::{Context, Lowered, lower};

use std::ops::Deref;

use fragbuf_templates::vocabulary::{HostFunction, Pass};

use crate::{Quantity, SymbolId};

/// A resource, by its place in the plan.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct ResourceId(pub usize);

/// A pass, by its place in the plan.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct PassId(pub usize);

/// A loop, by its place in the frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct LoopId(pub usize);

/// What a frame does.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LoweredFrame {
    /// In order.
    pub commands: Vec<Command>,
    /// The loops, in the order of their beginnings.
    pub loops: Vec<Loop>,
    /// Pairs of resources that exchange their roles. No resource is in two of them.
    pub exchanges: Vec<[ResourceId; 2]>,
    /// For each exchange, whether the two resources stand for each other when the frame is over.
    pub end: Vec<Parity>,
}

/// One command.
#[derive(Clone, Debug, PartialEq)]
pub struct Command {
    /// What is done.
    pub action: Action,
    /// For each exchange, whether the two resources stand for each other here.
    pub parities: Vec<Parity>,
}

/// What a command does.
#[derive(Clone, Debug, PartialEq)]
pub enum Action {
    /// Every word of a resource becomes `value`.
    Clear {
        /// The resource.
        resource: ResourceId,
        /// The word.
        value: u32,
    },
    /// One resource over another of the same shape.
    Copy {
        /// Read.
        from: ResourceId,
        /// Written.
        to: ResourceId,
    },
    /// A draw or a dispatch.
    Pass(PassId),
    /// The beginning of a loop; the commands up to its end are its body.
    Loop(LoopId),
    /// The end of a loop's body.
    LoopEnd(LoopId),
    /// The host decides: the words must have arrived before the frame goes on.
    Host(Decision),
}

/// A loop.
#[derive(Clone, Debug, PartialEq)]
pub struct Loop {
    /// The command [`Action::Loop`]; the body begins behind it.
    pub begin: usize,
    /// The command [`Action::LoopEnd`].
    pub end: usize,
    /// What ends it before its bound.
    pub until: LoopUntil,
    /// Iterations at most; exactly as many where nothing else ends it.
    pub at_most: Quantity,
}

/// What ends a loop before its bound.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LoopUntil {
    /// Nothing.
    Times,
    /// The first word of this resource is zero after an iteration.
    WordIsZero(ResourceId),
    /// No sample passed in this pass, in the iteration.
    NoSamples(PassId),
}

/// A decision of the host.
#[derive(Clone, Debug, PartialEq)]
pub struct Decision {
    /// The key of its row on the axis `host`.
    pub name: String,
    /// What is called.
    pub function: HostFunction,
    /// The words that it is given, in order.
    pub reads: Vec<Range>,
    /// The symbols that it sets, in order.
    pub sets: Vec<SymbolId>,
}

/// Words of a resource.
#[derive(Clone, Debug, PartialEq)]
pub struct Range {
    /// The resource.
    pub resource: ResourceId,
    /// The first word.
    pub first: Quantity,
    /// How many.
    pub count: Quantity,
}

/// Whether two resources stand for each other: they do where `is_odd`, and the finished iterations of `loops` together are
/// even, or the other way round. Iterations are counted over the whole frame.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Parity {
    /// Exchanges before this command in a straight line, odd in number.
    pub is_odd: bool,
    /// Loops that exchange the two an odd number of times in each iteration.
    pub loops: Vec<LoopId>,
}

/// A pass with its formulas resolved.
#[derive(Clone, Debug, PartialEq)]
pub struct PlannedPass {
    /// The pass.
    pub pass: Pass,
    /// Workgroups along x, y and z; none for a draw.
    pub groups: Vec<Quantity>,
    /// The reference of its stencil test.
    pub reference: Option<Quantity>,
    /// Samples per pixel, and the mask of those that are written.
    pub samples: Option<[Quantity; 2]>,
}

impl Deref for PlannedPass {
    type Target = Pass;

    fn deref(&self) -> &Pass {
        &self.pass
    }
}

impl Parity {
    /// Whether the two stand for each other after these finished iterations of each loop.
    pub fn is_flipped(&self, finished: &[u32]) -> bool {
        let rounds = self.loops.iter().map(|id| finished.get(id.0).copied().unwrap_or(0) % 2).sum::<u32>();
        self.is_odd != (rounds % 2 == 1)
    }
}

impl LoweredFrame {
    /// Whether a loop waits for the samples of a pass.
    pub fn waits_for_samples(&self, pass: PassId) -> bool {
        self.loops.iter().any(|looped| looped.until == LoopUntil::NoSamples(pass))
    }

    /// The exchanges that `resource` is in, by their number.
    pub fn exchange_of(&self, resource: ResourceId) -> Option<usize> {
        self.exchanges.iter().position(|pair| pair.contains(&resource))
    }

    /// The physical resource that `resource` stands for where the exchanges of the bit mask `flipped` are flipped.
    pub fn physical(&self, resource: ResourceId, flipped: u32) -> ResourceId {
        match self.exchange_of(resource) {
            Some(number) if flipped >> number & 1 == 1 => {
                let [a, b] = self.exchanges[number];
                if resource == a { b } else { a }
            }
            _ => resource,
        }
    }

    /// The decisions of the host, in order.
    pub fn decisions(&self) -> impl Iterator<Item = &Decision> {
        self.commands.iter().filter_map(|command| match &command.action {
            Action::Host(decision) => Some(decision),
            _ => None,
        })
    }
}
