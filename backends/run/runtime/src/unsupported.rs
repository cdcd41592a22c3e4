//! Rejects plans that the runtime does not support, by name, before it creates anything.

use fragbuf_codegen::{PassId, Plan, PlannedPass};
use fragbuf_frame::unsupported;
use fragbuf_templates::vocabulary::{Access, Kind, Objects};

use crate::Error;
use crate::texture::OUTPUT;

/// Checks that the runtime supports every pass of a plan.
pub(crate) fn check(plan: &Plan) -> Result<(), Error> {
    for (number, pass) in plan.passes.iter().enumerate() {
        check_pass(pass)?;
        // A pass has one query at a time: with a query per box there is none for the whole pass.
        if pass.objects == Objects::Boxes && plan.frame.waits_for_samples(PassId(number)) {
            return Err(unsupported(format!("pass `{}`: a loop that waits for samples of boxes", pass.name)).into());
        }
    }
    Ok(())
}

fn check_pass(pass: &PlannedPass) -> Result<(), Error> {
    let reject = |what: &str| Err(unsupported(format!("pass `{}`: {what}", pass.name)).into());
    let tests = (pass.state.depth.as_ref(), pass.state.stencil.as_ref());
    if let (Some(depth), Some(stencil)) = tests
        && depth.resource != stencil.resource
    {
        return reject("depth and stencil in two textures");
    }
    if pass.state.samples.is_some() && pass.state.targets.iter().any(|target| target.resource == OUTPUT) {
        return reject("several samples of the output");
    }
    match pass.uses.iter().find(|usage| usage.access == Access::Indirect) {
        // The caller draws the scene.
        Some(usage) if pass.kind == Kind::Geometry => reject(&format!("`{}` as {:?}", usage.resource, usage.access)),
        _ => Ok(()),
    }
}
