//! Readable GLSL, OpenGL and Vulkan dialects, printed from naga's IR.
//!
//! In: a validated [`naga::Module`] with the WGSL text it was parsed from. Out: one GLSL text per entry point, or a
//! library of functions for a shader of the user's own. The recipe is the body of [`print()`]: name everything, decide for
//! each function which expressions need a variable of their own, print bodies, then print the declarations that the
//! bodies turned out to use. Nothing here changes the meaning of the module: what GLSL cannot say, or says differently,
//! is either written out so that it means what WGSL means, or comes back as an [`Unprintable`].

mod access;
mod analysis;
mod arithmetic;
mod atomics;
mod candidates;
mod comments;
mod control_flow;
mod conversion;
mod declaration;
mod expression;
mod footprint;
mod function;
mod globals;
mod helpers;
mod interface;
mod layout;
mod literal;
mod locals;
mod math;
mod names;
mod printer;
mod reach;
mod reserved;
mod schedule;
mod statement;
mod texture;
mod types;
mod unit;

use naga::Span;
use naga::valid::ModuleInfo;

/// Which GLSL to print.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Dialect {
    /// `#version 450` for OpenGL 4.5, as `glslangValidator --target-env opengl` takes it: flat bindings, combined samplers.
    OpenGl450,
    /// `#version 450` for Vulkan 1.1, as `glslangValidator -V --target-env vulkan1.1` takes it: sets and bindings, separate samplers.
    Vulkan450,
    /// `#version 310 es` for OpenGL ES 3.1: as OpenGL, without 64-bit integers, interlock and `fma`.
    Es310,
}

/// What a WGSL function stands for, because WGSL has no word for it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Marker {
    /// `memoryBarrierBuffer()`: earlier buffer accesses of this invocation are visible before later ones.
    MemoryFence,
    /// `gl_HelperInvocation`, as a value.
    HelperLane,
    /// `beginInvocationInterlockARB()`; only at the top level of the entry point.
    CriticalBegin,
    /// As [`Marker::CriticalBegin`], where invocations enter in the order of their primitives.
    OrderedCriticalBegin,
    /// `endInvocationInterlockARB()`; only at the top level of the entry point.
    CriticalEnd,
}

/// Where a resource is bound in the printed text.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Slot {
    /// Descriptor set; printed by the Vulkan dialect only.
    pub set: u32,
    /// Binding within the set, or, in OpenGL, within the kind (buffers, uniform blocks, textures, images).
    pub binding: u32,
}

/// How to print.
pub struct Options<'a> {
    /// Target language.
    pub dialect: Dialect,
    /// Lines printed as `//` comments at the top, below `#version`; empty for none.
    pub header: &'a str,
    /// WGSL functions, by name, that stand for what WGSL cannot say: their definition is omitted, their calls replaced.
    pub markers: &'a [(&'a str, Marker)],
    /// Maps a WGSL group and binding to the printed slot.
    pub bindings: &'a dyn Fn(u32, u32) -> Slot,
    /// OpenGL only: names of globals whose `atomicLoad` may print as a plain (coherent, volatile) read, because no writer
    /// runs in the pass or the value is a hint that is checked again. Every other `atomicLoad` prints as `atomicOr(x, 0u)`.
    pub plain_loads: &'a [&'a str],
    /// Names of private variables that are written before they are read: these get no initial value, where WGSL has zeros.
    pub written_first: &'a [&'a str],
    /// Whether workgroup variables are set to zero first, as WGSL has them. Not needed where all are written before they
    /// are read.
    pub zero_workgroup_memory: bool,
}

/// What to print of a module.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unit<'a> {
    /// One entry point, as `main`, with all that it reaches.
    EntryPoint(&'a str),
    /// Every function that is no entry point, and no `main` and no `#version`: text to include in a shader.
    Library,
}

/// Something in the module that the dialect cannot say.
#[derive(Clone, Debug, PartialEq)]
pub struct Unprintable {
    /// What it is, in words.
    pub what: String,
    /// Where it stands in the WGSL text; may be undefined.
    pub span: Span,
}

impl std::fmt::Display for Unprintable {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(formatter, "cannot be printed as GLSL: {}", self.what)
    }
}

impl std::error::Error for Unprintable {}

/// Prints one unit of a module.
///
/// `source` is the WGSL text that the module was parsed from, best with doc comments on: comments, blank lines and
/// hexadecimal literals are taken from it by span. A module from elsewhere prints without them, given an empty text.
///
/// # Errors
/// Everything in the unit that cannot be printed, all at once.
pub fn print(
    module: &naga::Module,
    info: &ModuleInfo,
    source: &str,
    unit: Unit,
    options: &Options,
) -> Result<String, Vec<Unprintable>> {
    let mut printer = printer::Printer::new(module, info, source, options);
    let text = unit::print(&mut printer, unit);
    printer.finish(text)
}
