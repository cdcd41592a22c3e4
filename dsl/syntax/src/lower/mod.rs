//! The WGSL printer: from a typed tree to source that reads as if written by hand.
//!
//! Input: a checked function. Output: a WGSL function and the span of each of its lines. Nothing is checked here. Constructs
//! that WGSL does not allow inside an expression (a block, a branch with statements) are written before it, in Rust's
//! order of evaluation.

mod expressions;
mod lines;
mod loops;
mod lowering;
mod methods;
mod names;
mod needs;
mod numbers;
mod ranges;
mod resumable;
mod source;
mod statements;

use crate::environment::Signature;
use crate::tree::Function;
use crate::types::Type;
use lowering::{Destination, Lowering};

pub(crate) use lines::WgslFunction;
pub(crate) use resumable::{NAMES as PARTS, resumable};

/// Lowers a function to WGSL.
pub(crate) fn function(function: &Function, helpers: &[Signature]) -> WgslFunction {
    let mut lowering = Lowering::new(function, helpers);
    lowering.signature();
    lowering.lines.indent();
    lowering.copy_mutable_parameters();
    lowering.block_contents(&function.body, &Destination::Return);
    lowering.lines.dedent();
    lowering.lines.push("}".to_string(), &function.body.end);
    lowering.lines.finish()
}

impl Lowering<'_> {
    fn signature(&mut self) {
        let function = self.function;
        let mut parameters = Vec::new();
        for id in &function.parameters {
            let Some(variable) = function.variables.get(*id) else { continue };
            // The list of fragments and the uniforms have module scope in WGSL.
            if !variable.ty.is_value() {
                continue;
            }
            let name = match (variable.name.as_str(), variable.ty) {
                ("_", Type::Fragment) => self.names.fresh("f"),
                ("_", _) => self.names.fresh("unused"),
                (name, _) => self.names.fresh(name),
            };
            parameters.push(format!("{name}: {}", variable.ty.wgsl()));
            self.set_name(*id, name);
        }
        let signature = format!("fn {}({}) -> {} {{", function.name, parameters.join(", "), function.result.wgsl());
        self.lines.push(signature, &function.span);
    }

    /// Copies mutable parameters to variables: WGSL cannot assign to parameters.
    fn copy_mutable_parameters(&mut self) {
        let function = self.function;
        for id in &function.parameters {
            let Some(variable) = function.variables.get(*id) else { continue };
            if variable.mutable && variable.ty.is_value() {
                let copy = self.names.fresh(&variable.name);
                let line = format!("var {copy} = {};", self.name_of(*id));
                self.lines.push(line, &variable.span);
                self.set_name(*id, copy);
            }
        }
    }
}
