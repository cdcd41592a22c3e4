//! Passes that are added to a plan to call the storage's functions outside the plan's own passes.
//!
//! In: a plan and the name of a question, which is a file of this crate. Out: a row and a pass that link like any other.
//! Nothing runs here.

use fragbuf_codegen::{Plan, PlannedPass};
use fragbuf_templates::vocabulary::{Access, Kind, Pass, Row, Template, Use};

/// The row of a question.
pub(crate) fn row(key: &str, text: &'static str, path: &'static str) -> Row {
    Row {
        template: Some(Template::new(path, text)),
        calls: vec!["addressing", "storage"],
        ..Row::new("pass", key, "what the checker asks", "")
    }
}

/// A pass that reads everything that the plan's passes touch, with their roles.
pub(crate) fn question(plan: &Plan, anchor: &str) -> PlannedPass {
    let mut pass = Pass::compute(anchor, anchor, "1", "1");
    let mut passes: Vec<&PlannedPass> = plan.passes.iter().collect();
    let mut roles = passes.clone();
    // What reads a pixel out in the frame itself may count: its resources are touched as there.
    if let Some(resolve) = passes.iter().rposition(|pass| pass.kind == Kind::Fullscreen) {
        let resolve = passes.remove(resolve);
        let in_shader = |usage: &&Use| matches!(usage.access, Access::Read | Access::Atomic | Access::Sampled);
        pass.uses = resolve.uses.iter().filter(in_shader).cloned().collect();
        // What fixed function stores is called by that pass alone; where others call too, theirs are the roles.
        roles.retain(|other| other.anchor != resolve.anchor);
        roles.push(resolve);
    }
    for role in roles.into_iter().flat_map(|other| &other.roles) {
        if !pass.roles.iter().any(|known| known.contract == role.contract) {
            pass.roles.push(role.clone());
        }
    }
    for other in passes {
        for usage in &other.uses {
            let access = match usage.access {
                Access::Read | Access::Plain | Access::Atomic | Access::Coherent => Access::Read,
                Access::Sampled => Access::Sampled,
                _ => continue,
            };
            if !pass.uses.iter().any(|known| known.resource == usage.resource) {
                pass.uses.push(Use::new(&usage.resource, access));
            }
        }
    }
    PlannedPass { pass, groups: Vec::new(), reference: None, samples: None }
}
