//! A finished program: one entry point or function with all its calls inlined, and what is known of it.
//!
//! In: a validated module. Out: plain data that any number of machines share. A program is made once, by `compile`.

use std::collections::BTreeMap;
use std::ops::Range;

use naga::valid::ModuleInfo;
use naga::{Binding, Module, Span};

use crate::compile;
use crate::operation::Op;

/// What a function of this name stands for, because WGSL has no word for it. Its body is not run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Marker {
    /// A memory fence.
    Fence,
    /// Whether this is a helper invocation.
    HelperLane,
    /// The interlock begins.
    CriticalBegin,
    /// The interlock ends.
    CriticalEnd,
}

/// How to make a program.
#[derive(Clone, Copy, Debug, Default)]
pub struct Options<'a> {
    /// Functions by name.
    pub markers: &'a [(&'a str, Marker)],
    /// Private variables, by name, that are written before they are read: they begin with words that no program means, so
    /// that a read of their initial value shows.
    pub written_first: &'a [String],
}

/// What the interpreter cannot run, and where it stands.
#[derive(Clone, Debug, PartialEq)]
pub struct Unsupported {
    /// The construct.
    pub what: String,
    /// Its place in the source; undefined where there is none.
    pub span: Span,
}

impl std::fmt::Display for Unsupported {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "the interpreter does not run {}", self.what)
    }
}

/// Where a buffer of a program lives.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Space {
    /// A uniform buffer.
    Uniform,
    /// A storage buffer.
    Storage,
    /// Shared by a workgroup; zero when it begins.
    Workgroup,
}

/// A buffer that a program touches.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Buffer {
    /// Its name in the module.
    pub name: String,
    /// Group and binding, where it has them.
    pub binding: Option<(u32, u32)>,
    /// Where it lives.
    pub space: Space,
    /// Words that it has at least: all of them, unless it ends in an array of unknown length.
    pub words: u32,
    /// Whether the program writes to it. What it only reads, machines do not stop for.
    pub is_written: bool,
    /// Whether everything that the program does to it is one atomic operation whose result it never looks at and whose
    /// order does not matter.
    pub commutes: bool,
    /// Whether it is declared coherent, or atomic.
    pub is_coherent: bool,
    /// Whether some access to it is of 64 bits.
    pub is_wide: bool,
}

/// A texture that a program reads, texel by texel. No program writes any.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Texture {
    /// Its name in the module.
    pub name: String,
    /// Group and binding.
    pub binding: Option<(u32, u32)>,
    /// The kind of its numbers.
    pub kind: naga::ScalarKind,
    /// Whether it is declared as depth, of which the first number alone is read.
    pub is_depth: bool,
    /// Whether it is declared with several samples.
    pub is_multisampled: bool,
}

/// A part of what goes into an entry point or function, or of what comes out of it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Input {
    /// The member's or argument's name.
    pub name: String,
    /// What feeds it, or what it feeds; nothing, for a plain function.
    pub binding: Option<Binding>,
    /// The kind of its numbers; nothing, for a structure or an array.
    pub kind: Option<naga::ScalarKind>,
    /// The words of the machine that hold it.
    pub words: Range<usize>,
}

/// One entry point or function, ready to run.
#[derive(Clone, Debug)]
pub struct Program {
    pub(crate) ops: Vec<Op>,
    /// Per instruction, its place in `sites`.
    pub(crate) site_of: Vec<u32>,
    /// A place in the source, and the site of the call that brought it here.
    pub(crate) sites: Vec<(Span, Option<u32>)>,
    /// What every machine starts with: variables and frames at zero, then constants.
    pub(crate) image: Vec<u32>,
    /// Words of private variables, at the beginning of the image.
    pub(crate) privates: usize,
    /// Per stop, the words whose values still matter.
    pub(crate) live: BTreeMap<u32, Vec<Range<u32>>>,
    /// Per instruction, whether it can come again.
    pub(crate) in_loop: Vec<bool>,
    /// Arguments, flattened to members.
    pub inputs: Vec<Input>,
    /// Where the result is when the program has ended.
    pub result: Range<usize>,
    /// The result, flattened to members.
    pub outputs: Vec<Input>,
    /// Buffers by number.
    pub buffers: Vec<Buffer>,
    /// Textures by number.
    pub textures: Vec<Texture>,
    /// Invocations of a workgroup; 1 where it is no compute shader.
    pub workgroup_size: [u32; 3],
}

impl Program {
    /// The entry point of this name. `Err`: everything in it that the interpreter does not run.
    pub fn entry_point(
        module: &Module,
        info: &ModuleInfo,
        name: &str,
        options: &Options<'_>,
    ) -> Result<Self, Vec<Unsupported>> {
        compile::entry_point(module, info, name, options)
    }

    /// The function of this name, with its arguments as inputs.
    pub fn function(
        module: &Module,
        info: &ModuleInfo,
        name: &str,
        options: &Options<'_>,
    ) -> Result<Self, Vec<Unsupported>> {
        compile::function(module, info, name, options)
    }

    /// The same, for memory that has no textures. `Err`: it reads some.
    pub fn without_textures(self) -> Result<Self, Vec<Unsupported>> {
        let refused = |texture: &Texture| {
            let what = format!("the texture `{}`, for which there is no memory here", texture.name);
            Unsupported { what, span: Span::UNDEFINED }
        };
        if self.textures.is_empty() { Ok(self) } else { Err(self.textures.iter().map(refused).collect()) }
    }

    /// Where the instruction at `at` stands in the source, and the calls that lead there, innermost first.
    pub fn trace(&self, at: u32) -> Vec<Span> {
        let mut trace = Vec::new();
        let mut site = self.site_of.get(at as usize).copied();
        while let Some((span, caller)) = site.and_then(|site| self.sites.get(site as usize)) {
            trace.push(*span);
            site = *caller;
        }
        trace
    }

    /// Whether the instruction at `at` can come again without leaving the function it is in.
    pub fn is_in_loop(&self, at: u32) -> bool {
        self.in_loop.get(at as usize).copied().unwrap_or(false)
    }

    /// Whether invocations of a workgroup wait for each other.
    pub fn has_barriers(&self) -> bool {
        self.ops.contains(&Op::Barrier)
    }

    /// The input that is this built-in value.
    pub fn built_in(&self, built_in: naga::BuiltIn) -> Option<&Input> {
        self.inputs.iter().find(|input| input.is(built_in))
    }
}

impl Input {
    /// Whether it is this built-in value.
    pub fn is(&self, built_in: naga::BuiltIn) -> bool {
        match &self.binding {
            // Invariance is a property of the output that feeds it.
            Some(Binding::BuiltIn(naga::BuiltIn::Position { .. })) => {
                matches!(built_in, naga::BuiltIn::Position { .. })
            }
            Some(Binding::BuiltIn(own)) => *own == built_in,
            _ => false,
        }
    }

    /// Its location, where it has one.
    pub fn location(&self) -> Option<u32> {
        match &self.binding {
            Some(Binding::Location { location, .. }) => Some(*location),
            _ => None,
        }
    }
}
