//! The printer: a typed tree to WGSL text that reads as if a person had written it.
//!
//! In: a checked function. Out: a whole WGSL function and the place of each of its lines. Nothing is checked here: the
//! tree is right, and everything in it can be said. What WGSL cannot say inside an expression (a block, a branch with
//! statements) is written before it, in Rust's order of evaluation.

mod expressions;
mod lines;
mod loops;
mod methods;
mod names;
mod needs;
mod numbers;
mod statements;
mod text;

use fragbuf_model::Origin;

use crate::check::Signature;
use crate::tree::{Function, VariableId};
use crate::types::Type;
use lines::Lines;
use names::Names;
use statements::Destination;

/// A function in WGSL.
pub(crate) struct Lowered {
    pub text: String,
    /// The place of each line.
    pub lines: Vec<Origin>,
}

/// The state of printing one function.
struct Lowering<'a> {
    function: &'a Function,
    helpers: &'a [Signature],
    lines: Lines,
    names: Names,
    /// The WGSL name of each variable, once it is declared.
    spelled: Vec<String>,
    /// Whether what follows is never reached: then nothing is written.
    dead: bool,
    /// Whether number literals are written with their type: between constants, WGSL would calculate more precisely.
    suffixed: bool,
}

/// Writes a function.
pub(crate) fn function(function: &Function, helpers: &[Signature]) -> Lowered {
    let mut lowering = Lowering {
        function,
        helpers,
        lines: Lines::default(),
        names: Names::default(),
        spelled: vec![String::new(); function.variables.len()],
        dead: false,
        suffixed: false,
    };
    lowering.head();
    lowering.lines.indent();
    lowering.copy_mutable_parameters();
    lowering.block_contents(&function.body, &Destination::Return);
    lowering.lines.dedent();
    lowering.lines.push("}".to_string(), &function.body.end);
    lowering.lines.finish()
}

impl Lowering<'_> {
    fn head(&mut self) {
        let function = self.function;
        let mut parameters = Vec::new();
        for id in &function.parameters {
            let Some(variable) = function.variables.get(*id) else { continue };
            // The list of fragments and the uniforms are module scope in WGSL.
            if !variable.kind.is_value() {
                continue;
            }
            let name = match (variable.name.as_str(), variable.kind) {
                ("_", Type::Fragment) => self.names.fresh("f"),
                ("_", _) => self.names.fresh("unused"),
                (name, _) => self.names.fresh(name),
            };
            parameters.push(format!("{name}: {}", variable.kind.wgsl()));
            self.spell(*id, name);
        }
        let head = format!("fn {}({}) -> {} {{", function.name, parameters.join(", "), function.result.wgsl());
        self.lines.push(head, &function.origin);
    }

    /// WGSL's parameters cannot be assigned.
    fn copy_mutable_parameters(&mut self) {
        let function = self.function;
        for id in &function.parameters {
            let Some(variable) = function.variables.get(*id) else { continue };
            if variable.mutable && variable.kind.is_value() {
                let copy = self.names.fresh(&variable.name);
                let line = format!("var {copy} = {};", self.name_of(*id));
                self.lines.push(line, &variable.origin);
                self.spell(*id, copy);
            }
        }
    }

    fn spell(&mut self, id: VariableId, name: String) {
        if let Some(slot) = self.spelled.get_mut(id) {
            *slot = name;
        }
    }

    fn name_of(&self, id: VariableId) -> String {
        self.spelled.get(id).cloned().unwrap_or_default()
    }

    /// Writes a line, unless it is never reached.
    fn emit(&mut self, line: String, origin: &Origin) {
        if !self.dead {
            self.lines.push(line, origin);
        }
    }
}
