//! Probe passes: passes that are added to a plan to call the storage's functions outside the plan's own passes.
//!
//! Input: a plan and the name of a probe, which is a WGSL file of this crate. Output: a row and a pass that link like any
//! other. Nothing runs here.

use fragbuf_codegen::{Plan, PlannedPass};
use fragbuf_templates::vocabulary::{Access, Kind, Pass, Row, Template, Use};

/// Returns the registry row of a probe.
pub(crate) fn probe_row(key: &str, source: &'static str, path: &'static str) -> Row {
    Row {
        template: Some(Template::new(path, source)),
        calls: vec!["addressing", "storage", "peeling"],
        ..Row::new("pass", key, "a probe of the checker", "")
    }
}

/// Returns a pass that reads every resource of the plan's passes, with the implementations of those passes.
pub(crate) fn probe_pass(plan: &Plan, name: &str) -> PlannedPass {
    let mut pass = Pass::compute(name, name, "1", "1");
    let mut passes: Vec<&PlannedPass> = plan.passes.iter().collect();
    let mut implementations = passes.clone();
    // The resolve pass may count while it reads a pixel, so the probe uses its resources in the same way.
    let reads_storage = |pass: &&PlannedPass| {
        pass.kind == Kind::Fullscreen && pass.implementations.iter().any(|one| one.contract == "storage")
    };
    if let Some(resolve) = passes.iter().rposition(reads_storage) {
        let resolve = passes.remove(resolve);
        let in_shader = |usage: &&Use| matches!(usage.access, Access::Read | Access::Atomic | Access::Sampled);
        pass.uses = resolve.uses.iter().filter(in_shader).cloned().collect();
        // A storage of fixed function is called by the resolve pass only. Otherwise the other passes' implementations count.
        implementations.retain(|other| other.name != resolve.name);
        implementations.push(resolve);
    }
    for implementation in implementations.into_iter().flat_map(|other| &other.implementations) {
        if !pass.implementations.iter().any(|known| known.contract == implementation.contract) {
            pass.implementations.push(implementation.clone());
        }
    }
    for other in passes {
        for usage in &other.uses {
            let access = match usage.access {
                Access::Read | Access::Plain | Access::Atomic | Access::Coherent | Access::Hinted => Access::Read,
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
