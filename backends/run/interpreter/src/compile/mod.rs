//! Compiles an entry point or a function of a validated module into [`Bytecode`].
//!
//! WGSL has no recursion, so every call is inlined. A machine therefore needs no call stack, its words have fixed numbers,
//! and the live words at each instruction can be computed. Calls that follow each other reuse the same words. All
//! unsupported constructs are collected; none is approximated.

mod access;
mod call;
mod compiler;
mod constant;
mod convert;
mod expression;
mod finish;
mod flow;
mod globals;
mod load_store;
mod math;
mod matrix;
mod operator;
mod pointer;
mod texture;

use naga::valid::{FunctionInfo, ModuleInfo};
use naga::{Function, Module, Span};

use crate::bytecode::{Bytecode, Options, Unsupported};
use compiler::{Compiler, InlinedCall};

/// The most words of an invocation.
const MOST_WORDS: u32 = 1 << 22;

impl Bytecode {
    /// Compiles the entry point with this name. `Err`: every construct in it that the interpreter does not run.
    pub fn entry_point(
        module: &Module,
        info: &ModuleInfo,
        name: &str,
        options: &Options<'_>,
    ) -> Result<Self, Vec<Unsupported>> {
        let found = module.entry_points.iter().position(|entry| entry.name == name);
        let Some(index) = found else { return Err(not_found(name)) };
        let entry = &module.entry_points[index];
        let size = entry.workgroup_size.map(|length| length.max(1));
        compile(module, info, &entry.function, info.get_entry_point(index), options, size)
    }

    /// Compiles the function with this name; its arguments become inputs.
    pub fn function(
        module: &Module,
        info: &ModuleInfo,
        name: &str,
        options: &Options<'_>,
    ) -> Result<Self, Vec<Unsupported>> {
        let found = module.functions.iter().find(|(_, function)| function.name.as_deref() == Some(name));
        let Some((handle, function)) = found else { return Err(not_found(name)) };
        compile(module, info, function, &info[handle], options, [1; 3])
    }
}

fn not_found(name: &str) -> Vec<Unsupported> {
    vec![Unsupported { what: format!("`{name}`, which the module does not have"), span: Span::UNDEFINED }]
}

fn compile<'m>(
    module: &'m Module,
    info: &'m ModuleInfo,
    function: &'m Function,
    function_info: &'m FunctionInfo,
    options: &'m Options<'m>,
    workgroup_size: [u32; 3],
) -> Result<Bytecode, Vec<Unsupported>> {
    let callee = InlinedCall::new(function, function_info, 0, None);
    let mut compiler = Compiler::new(module, info, options, callee);
    compiler.declare_globals(function_info);
    match compiler.outermost(function) {
        Err(what) => {
            compiler.report_unsupported(what);
            Err(compiler.unsupported)
        }
        Ok(_) if compiler.peak > MOST_WORDS => {
            compiler.report_unsupported(format!("an invocation of {} words", compiler.peak));
            Err(compiler.unsupported)
        }
        Ok(_) if !compiler.unsupported.is_empty() => Err(compiler.unsupported),
        Ok((inputs, outputs)) => Ok(compiler.finish(inputs, outputs, workgroup_size)),
    }
}
