//! What the runtime does not run, refused by name before anything is made.

use fragbuf_codegen::{PassId, Plan, PlannedPass};
use fragbuf_frame::unsupported;
use fragbuf_templates::vocabulary::{Access, Kind, Objects};

use crate::Error;
use crate::texture::OUTPUT;

/// Whether the runtime runs every pass of a plan.
pub(crate) fn check(plan: &Plan) -> Result<(), Error> {
    for (number, pass) in plan.passes.iter().enumerate() {
        check_pass(pass)?;
        // A query of each box leaves none for all of them.
        if pass.objects == Objects::Boxes && plan.frame.waits_for_samples(PassId(number)) {
            return Err(unsupported(format!("pass `{}`: a loop that waits for samples of boxes", pass.anchor)).into());
        }
    }
    Ok(())
}

fn check_pass(pass: &PlannedPass) -> Result<(), Error> {
    let refuse = |what: &str| Err(unsupported(format!("pass `{}`: {what}", pass.anchor)).into());
    let tests = (pass.state.depth.as_ref(), pass.state.stencil.as_ref());
    if let (Some(depth), Some(stencil)) = tests
        && depth.resource != stencil.resource
    {
        return refuse("depth and stencil in two textures");
    }
    if pass.state.samples.is_some() && pass.state.targets.iter().any(|target| target.resource == OUTPUT) {
        return refuse("several samples of the output");
    }
    match pass.uses.iter().find(|usage| usage.access == Access::Indirect) {
        // The scene is the caller's to draw.
        Some(usage) if pass.kind == Kind::Geometry => refuse(&format!("`{}` as {:?}", usage.resource, usage.access)),
        _ => Ok(()),
    }
}
