//! The names of marker functions, without prefix. They stand for what WGSL cannot express (`templates/shared/markers.wgsl`).
//!
//! For targets that naga writes, memory fences replace the calls of their marker after validation, because naga's validator
//! rejects them in fragment shaders. Each target replaces the other markers itself.

use std::borrow::Cow;

pub(crate) use fragbuf_codegen::{CRITICAL_BEGIN, CRITICAL_END, HELPER_LANE, MEMORY_FENCE};
use naga::{Block, Statement};

/// Returns the module with a fence over storage buffers in place of every call of the fence marker. Copies only a module that has
/// the marker.
pub(crate) fn with_fences<'m>(module: &'m naga::Module, prefix: &str) -> Cow<'m, naga::Module> {
    let name = format!("{prefix}{MEMORY_FENCE}");
    let marker = module.functions.iter().find(|(_, function)| function.name.as_deref() == Some(&name));
    let Some((marker, _)) = marker else { return Cow::Borrowed(module) };
    let mut module = module.clone();
    for (_, function) in module.functions.iter_mut() {
        splice(&mut function.body, marker);
    }
    for entry in &mut module.entry_points {
        splice(&mut entry.function.body, marker);
    }
    Cow::Owned(module)
}

fn splice(block: &mut Block, marker: naga::Handle<naga::Function>) {
    for statement in block.iter_mut() {
        match statement {
            Statement::Call { function, .. } if *function == marker => {
                *statement = Statement::MemoryBarrier(naga::Barrier::STORAGE);
            }
            Statement::Block(inner) => splice(inner, marker),
            Statement::If { accept, reject, .. } => {
                splice(accept, marker);
                splice(reject, marker);
            }
            Statement::Switch { cases, .. } => cases.iter_mut().for_each(|case| splice(&mut case.body, marker)),
            Statement::Loop { body, continuing, .. } => {
                splice(body, marker);
                splice(continuing, marker);
            }
            _ => {}
        }
    }
}
