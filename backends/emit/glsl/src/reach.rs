//! Finds the functions that an entry point calls, directly or indirectly.
//!
//! Types, constants and globals are recorded separately, while the bodies that use them print.

use std::collections::BTreeSet;

use naga::{Function, Handle, Module, Statement};

use crate::footprint::visit;

/// Returns the functions reached from a body, without markers and the functions that only markers call.
pub fn reached(
    module: &Module,
    body: &naga::Block,
    is_marker: &impl Fn(Handle<Function>) -> bool,
) -> BTreeSet<Handle<Function>> {
    let mut found = BTreeSet::new();
    let mut pending = callees(body);
    while let Some(function) = pending.pop() {
        if !is_marker(function) && found.insert(function) {
            pending.extend(callees(&module.functions[function].body));
        }
    }
    found
}

/// Returns the functions that a body calls directly.
fn callees(body: &naga::Block) -> Vec<Handle<Function>> {
    let mut callees = Vec::new();
    visit(body, &mut |statement| {
        if let Statement::Call { function, .. } = statement {
            callees.push(*function);
        }
    });
    callees
}
