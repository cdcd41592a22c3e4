//! What a unit reaches: an entry point in, the functions it calls, directly or not, out.
//!
//! Types, constants and globals are found otherwise: they are noted as needed while the bodies that name them print.

use std::collections::BTreeSet;

use naga::{Function, Handle, Module, Statement};

use crate::footprint::visit;

/// Functions reached from a body, without markers and what only they call.
pub fn reached(
    module: &Module,
    body: &naga::Block,
    is_marker: &impl Fn(Handle<Function>) -> bool,
) -> BTreeSet<Handle<Function>> {
    let mut found = BTreeSet::new();
    let mut open = callees(body);
    while let Some(function) = open.pop() {
        if !is_marker(function) && found.insert(function) {
            open.extend(callees(&module.functions[function].body));
        }
    }
    found
}

fn callees(body: &naga::Block) -> Vec<Handle<Function>> {
    let mut callees = Vec::new();
    visit(body, &mut |statement| {
        if let Statement::Call { function, .. } = statement {
            callees.push(*function);
        }
    });
    callees
}
