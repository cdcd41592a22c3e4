//! The options of a printing run, and its errors.

use naga::Span;

/// A GLSL dialect.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Dialect {
    /// `#version 450` for OpenGL 4.5, as `glslangValidator --target-env opengl` accepts it: flat bindings, combined
    /// samplers.
    OpenGl450,
    /// `#version 450` for Vulkan 1.1, as `glslangValidator -V --target-env vulkan1.1` accepts it: sets and bindings,
    /// separate samplers.
    Vulkan450,
    /// `#version 310 es` for OpenGL ES 3.1: as OpenGL, without 64-bit integers, interlock and `fma`.
    Es310,
}

/// The GLSL built-in that replaces calls of a WGSL function, because WGSL has no equivalent.
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

/// The printed binding of a resource.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Slot {
    /// Descriptor set; only the Vulkan dialect prints it.
    pub set: u32,
    /// Binding within the set; in OpenGL, within the kind (buffers, uniform blocks, textures, images).
    pub binding: u32,
}

/// The options of a printing run.
pub struct Options<'a> {
    /// Target dialect.
    pub dialect: Dialect,
    /// Lines to print as `//` comments at the top, below `#version`; empty for none.
    pub header: &'a str,
    /// WGSL functions, by name, that are markers. Their definitions are omitted and their calls replaced.
    pub markers: &'a [(&'a str, Marker)],
    /// Maps a WGSL group and binding to the printed slot.
    pub bindings: &'a dyn Fn(u32, u32) -> Slot,
    /// OpenGL only: names of globals whose `atomicLoad` may print as a plain (coherent, volatile) read, because no writer
    /// runs in the pass or the value is a hint that is checked again. Every other `atomicLoad` prints as `atomicOr(x, 0u)`.
    pub plain_loads: &'a [&'a str],
    /// Names of functions whose `atomicLoad` and `atomicStore` may print as plain accesses of a coherent buffer, because other
    /// invocations access the words only in order with them.
    pub plain_functions: &'a [&'a str],
    /// Names of private variables that are written before they are read. They get no initial value; WGSL initialises
    /// them to zero.
    pub written_first: &'a [&'a str],
    /// Initialises workgroup variables to zero, as WGSL does. This is unnecessary if each is written before it is read.
    pub zero_workgroup_memory: bool,
}

/// The part of a module to print.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unit<'a> {
    /// One entry point, printed as `main`, with everything that it reaches.
    EntryPoint(&'a str),
    /// Every function that is no entry point, without `main` and `#version`: source to include in a shader.
    Library,
}

/// An error: a part of the module that the dialect cannot express.
#[derive(Clone, Debug, PartialEq)]
pub struct Unprintable {
    /// Description of the part.
    pub message: String,
    /// Its span in the WGSL source; may be undefined.
    pub span: Span,
}

impl std::fmt::Display for Unprintable {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(formatter, "cannot be printed as GLSL: {}", self.message)
    }
}

impl std::error::Error for Unprintable {}
