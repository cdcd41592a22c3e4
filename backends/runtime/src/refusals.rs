//! What the runtime does not run, refused by name before anything is made.

use fragbuf_codegen::{Plan, PlannedPass};
use fragbuf_frame::unsupported;
use fragbuf_templates::vocabulary::{Access, Kind};

use crate::Error;
use crate::texture::OUTPUT;

/// Whether the runtime runs every pass of a plan.
pub(crate) fn check(plan: &Plan) -> Result<(), Error> {
    plan.passes.iter().try_for_each(check_pass)
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
