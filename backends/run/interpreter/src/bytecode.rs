//! Bytecode: one entry point or function with all its calls inlined, and its interface.
//!
//! It is plain data that any number of machines share. `compile` makes it from a validated module.

use std::collections::BTreeMap;
use std::ops::Range;
use std::sync::OnceLock;

use naga::{Binding, Span};

use crate::lanes::LaneProgram;
use crate::operation::Op;
use crate::retry::RetryLoop;

/// The operation of a function that stands for a construct that WGSL lacks. The interpreter does not run its body.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Marker {
    /// A memory fence.
    Fence,
    /// Returns whether this is a helper invocation.
    HelperLane,
    /// The beginning of the interlock.
    CriticalBegin,
    /// The end of the interlock.
    CriticalEnd,
}

/// Options of a compilation.
#[derive(Clone, Copy, Debug, Default)]
pub struct Options<'a> {
    /// Marker functions by name.
    pub markers: &'a [(&'a str, Marker)],
    /// Private variables, by name, that the program writes before it reads. Their initial words are implausible values,
    /// so that tests detect a read of them.
    pub written_first: &'a [String],
    /// Whether the program writes its workgroup memory before it reads it. Its initial words are then implausible values, too.
    pub writes_workgroup_first: bool,
    /// Functions, by name, whose atomic loads and stores are plain accesses.
    pub plain_functions: &'a [String],
}

/// A construct that the interpreter does not run.
#[derive(Clone, Debug, PartialEq)]
pub struct Unsupported {
    /// A description of the construct.
    pub what: String,
    /// Its span in the source; undefined if it has none.
    pub span: Span,
}

impl std::fmt::Display for Unsupported {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "the interpreter does not run {}", self.what)
    }
}

/// The address space of a buffer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Space {
    /// A uniform buffer.
    Uniform,
    /// A storage buffer.
    Storage,
    /// Workgroup memory; zero when the workgroup starts, unless the options say otherwise.
    Workgroup,
}

/// A buffer that a program accesses.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Buffer {
    /// Its name in the module.
    pub name: String,
    /// Its group and binding, if it has them.
    pub binding: Option<(u32, u32)>,
    /// Its address space.
    pub space: Space,
    /// Its least length in words: its length, unless it ends in a runtime-sized array.
    pub words: u32,
    /// The words of an element of the runtime-sized array at its end; 0 if it has none.
    pub element_words: u32,
    /// Whether the program writes to it. Machines do not stop at reads of other buffers.
    pub is_written: bool,
    /// Whether all accesses to it commute: one atomic operation whose result the program ignores and whose order does
    /// not matter.
    pub commutes: bool,
    /// Whether it is declared as coherent.
    pub is_coherent: bool,
    /// The words of atomic types before the runtime-sized array at its end.
    pub atomics: Vec<Range<u32>>,
    /// The words of atomic types in an element of that array.
    pub element_atomics: Vec<Range<u32>>,
    /// Whether the program also has plain accesses of words of atomic types.
    pub is_mixed: bool,
    /// Whether the program accesses 64 bits of it at once.
    pub is_wide: bool,
    /// For workgroup memory, each of its words when a workgroup starts.
    pub initial: u32,
}

impl Buffer {
    /// Returns whether a word has an atomic type.
    pub fn is_atomic(&self, word: u32) -> bool {
        let contains = |ranges: &[Range<u32>], word: u32| ranges.iter().any(|range| range.contains(&word));
        match word.checked_sub(self.words) {
            Some(beyond) if self.element_words > 0 => contains(&self.element_atomics, beyond % self.element_words),
            _ => contains(&self.atomics, word),
        }
    }
}

/// A texture that a program reads texel by texel.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Texture {
    /// Its name in the module.
    pub name: String,
    /// Its group and binding.
    pub binding: Option<(u32, u32)>,
    /// The scalar kind of its channels.
    pub kind: naga::ScalarKind,
    /// Whether it is declared as a depth texture; a read then returns one channel.
    pub is_depth: bool,
    /// Whether it is declared as multisampled.
    pub is_multisampled: bool,
    /// Whether it has three dimensions.
    pub is_3d: bool,
}

/// One input or output of an entry point or function. Structures are flattened to their members.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct InterfaceVariable {
    /// The member's or argument's name.
    pub name: String,
    /// Its binding; `None` for a plain function.
    pub binding: Option<Binding>,
    /// Its scalar kind; `None` for a structure or an array.
    pub kind: Option<naga::ScalarKind>,
    /// The words of the machine that contain it.
    pub words: Range<usize>,
}

/// The program of one entry point or function.
#[derive(Clone, Debug)]
pub struct Bytecode {
    pub(crate) ops: Vec<Op>,
    /// Per instruction, its index into `sites`.
    pub(crate) site_of: Vec<u32>,
    /// A source span, and the site of the call that inlined it.
    pub(crate) sites: Vec<(Span, Option<u32>)>,
    /// The initial words of a machine: private variables, temporaries (zero), then constants.
    pub(crate) initial_words: Vec<u32>,
    /// The number of words of private variables, which come first.
    pub(crate) privates: usize,
    /// The number of constants, which come last.
    pub(crate) constants: usize,
    /// The instructions of lane machines, once one is created.
    pub(crate) in_lanes: OnceLock<LaneProgram>,
    /// Per instruction that can stop a machine, the live words.
    pub(crate) live: BTreeMap<u32, Vec<Range<u32>>>,
    /// Per instruction, whether it is part of a loop.
    pub(crate) in_loop: Vec<bool>,
    /// The loops that count their attempts.
    pub(crate) retry_loops: Vec<RetryLoop>,
    /// The arguments, flattened to members.
    pub inputs: Vec<InterfaceVariable>,
    /// The words of the result after the program has ended.
    pub result: Range<usize>,
    /// The result, flattened to members.
    pub outputs: Vec<InterfaceVariable>,
    /// The buffers, by number.
    pub buffers: Vec<Buffer>,
    /// The textures, by number.
    pub textures: Vec<Texture>,
    /// The workgroup size; 1 if it is not a compute shader.
    pub workgroup_size: [u32; 3],
}

impl Bytecode {
    /// Returns the program if it reads no texture. `Err`: the textures that it reads.
    pub fn without_textures(self) -> Result<Self, Vec<Unsupported>> {
        let unsupported = |texture: &Texture| {
            let what = format!("the texture `{}`: this memory has no textures", texture.name);
            Unsupported { what, span: Span::UNDEFINED }
        };
        if self.textures.is_empty() { Ok(self) } else { Err(self.textures.iter().map(unsupported).collect()) }
    }

    /// Returns the source span of the instruction at `at` and the spans of the calls around it, innermost first.
    pub fn trace(&self, at: u32) -> Vec<Span> {
        let mut trace = Vec::new();
        let mut site = self.site_of.get(at as usize).copied();
        while let Some((span, caller)) = site.and_then(|site| self.sites.get(site as usize)) {
            trace.push(*span);
            site = *caller;
        }
        trace
    }

    /// Returns whether the instruction at `at` is part of a loop of its function.
    pub fn is_in_loop(&self, at: u32) -> bool {
        self.in_loop.get(at as usize).copied().unwrap_or(false)
    }

    /// Returns whether two states, as [`Machine::save`](crate::Machine::save) appends them, are equal but for the number of
    /// attempts of the loops around them. Such a number only limits how often its loop is repeated.
    pub fn is_same_attempt(&self, one: &[u32], other: &[u32]) -> bool {
        let ([at, one @ ..], [other_at, other @ ..]) = (one, other) else { return false };
        if at != other_at || one.len() != other.len() {
            return false;
        }
        let around = self.retry_loops.iter().filter(|retry| retry.instructions.contains(at));
        let counters: Vec<u32> = around.flat_map(|retry| &retry.counters).copied().collect();
        let live = self.live.get(at).into_iter().flatten().cloned().flatten();
        one.iter().zip(other).zip(live).all(|((one, other), word)| one == other || counters.contains(&word))
    }

    /// Returns the jump back of every loop that has a retry counter.
    pub fn retry_loops(&self) -> impl Iterator<Item = u32> {
        self.retry_loops.iter().map(|retry| retry.instructions.end.saturating_sub(1))
    }

    /// Returns whether the program calls a marker function.
    pub fn calls(&self, marker: Marker) -> bool {
        let is_call = |op: &Op| match marker {
            Marker::Fence => *op == Op::Fence,
            Marker::HelperLane => matches!(op, Op::HelperLane { .. }),
            Marker::CriticalBegin => *op == Op::CriticalBegin,
            Marker::CriticalEnd => *op == Op::CriticalEnd,
        };
        self.ops.iter().any(is_call)
    }

    /// Returns whether the program has workgroup barriers.
    pub fn has_barriers(&self) -> bool {
        self.ops.iter().any(|op| matches!(op, Op::Barrier(_)))
    }

    /// Returns the input that is this built-in value.
    pub fn built_in(&self, built_in: naga::BuiltIn) -> Option<&InterfaceVariable> {
        self.inputs.iter().find(|input| input.is(built_in))
    }
}

impl InterfaceVariable {
    /// Returns whether it is this built-in value.
    pub fn is(&self, built_in: naga::BuiltIn) -> bool {
        match &self.binding {
            // Only outputs are invariant.
            Some(Binding::BuiltIn(naga::BuiltIn::Position { .. })) => {
                matches!(built_in, naga::BuiltIn::Position { .. })
            }
            Some(Binding::BuiltIn(bound)) => *bound == built_in,
            _ => false,
        }
    }

    /// Returns its location, if it has one.
    pub fn location(&self) -> Option<u32> {
        match &self.binding {
            Some(Binding::Location { location, .. }) => Some(*location),
            _ => None,
        }
    }
}
