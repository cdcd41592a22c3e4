//! The state of lowering one function.
//!
//! Input: a checked function. Output: lines of WGSL. The other files of this folder add the constructs.

use std::collections::BTreeSet;

use fragbuf_model::SourceSpan;

use super::lines::Lines;
use super::names::Names;
use super::source::ExprSource;
use crate::environment::Signature;
use crate::tree::{Function, VariableId};

/// The destination of a value.
#[derive(Clone, Debug)]
pub(super) enum Destination {
    /// The value is unused; only its effects are needed.
    Unused,
    /// The result of the function.
    Return,
    /// The variable of this name.
    Assign(String),
}

/// The state of lowering one function.
pub(super) struct Lowering<'a> {
    pub function: &'a Function,
    pub helpers: &'a [Signature],
    pub lines: Lines,
    pub names: Names,
    /// The WGSL name of each variable, after its declaration.
    pub wgsl_names: Vec<String>,
    /// Whether the next line is unreachable. Unreachable lines are not written.
    pub dead: bool,
    /// Whether float literals have a suffix: WGSL evaluates constants without suffixes in higher precision.
    pub suffixed: bool,
    /// The variables that are members of a struct, and declared there.
    pub kept: BTreeSet<VariableId>,
    /// Whether `break` ends the loop of an effect that can be interrupted.
    pub is_in_each: bool,
    /// Whether `return` ends such an effect from within its loop.
    pub is_in_effect: bool,
    /// Whether one has.
    pub returns_in_effect: bool,
}

impl<'a> Lowering<'a> {
    /// Returns the state at the start of a function.
    pub(super) fn new(function: &'a Function, helpers: &'a [Signature]) -> Self {
        Lowering {
            function,
            helpers,
            lines: Lines::default(),
            names: Names::default(),
            wgsl_names: vec![String::new(); function.variables.len()],
            dead: false,
            suffixed: false,
            kept: BTreeSet::new(),
            is_in_each: false,
            is_in_effect: false,
            returns_in_effect: false,
        }
    }

    /// Sets the WGSL name of a variable.
    pub(super) fn set_name(&mut self, id: VariableId, name: String) {
        if let Some(slot) = self.wgsl_names.get_mut(id) {
            *slot = name;
        }
    }

    /// Returns the WGSL name of a variable.
    pub(super) fn name_of(&self, id: VariableId) -> String {
        self.wgsl_names.get(id).cloned().unwrap_or_default()
    }

    /// Writes a line if it is reachable.
    pub(super) fn emit(&mut self, line: String, span: &SourceSpan) {
        if !self.dead {
            self.lines.push(line, span);
        }
    }

    /// Writes `let name = …;` and returns the name.
    pub(super) fn bind(&mut self, name: &str, value: &ExprSource, span: &SourceSpan) -> ExprSource {
        let name = self.names.fresh(name);
        self.emit(format!("let {name} = {};", value.source), span);
        ExprSource::primary(name)
    }
}
