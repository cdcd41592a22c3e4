//! Prints readable GLSL, in OpenGL, OpenGL ES and Vulkan dialects, from naga's IR.
//!
//! Input: a validated [`naga::Module`] with the WGSL source that it was parsed from. Output: the GLSL source of one entry
//! point, or a library of functions to include in a shader. [`print()`] names everything and decides for each function
//! which expressions need a variable. It then prints the bodies, and last the declarations that the bodies use. The
//! meaning of the module never changes: a construct that GLSL lacks or defines differently is written out with its WGSL
//! meaning, or reported as an [`Unprintable`].

mod access;
mod analysis;
mod arithmetic;
mod atomics;
mod candidates;
mod comments;
mod control_flow;
mod conversion;
mod declaration;
mod entry_point;
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
mod options;
mod per_expression;
mod precedence;
mod printer;
mod reach;
mod reserved;
mod schedule;
mod statement;
mod texture;
mod types;
mod unit;

use naga::valid::ModuleInfo;

pub use options::{Dialect, Marker, Options, Slot, Unit, Unprintable};

/// Prints one unit of a module.
///
/// `source` is the WGSL source that the module was parsed from, preferably with doc comments enabled. Comments, blank
/// lines and hexadecimal literals are read from it by span. For a module without WGSL source, pass an empty string.
///
/// # Errors
/// Returns everything in the unit that cannot be printed, all at once.
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
