//! A plan's steps as what the runtime does, one after the other. What it does not run is refused here, by name, before
//! anything is made.

use fragbuf_codegen::Plan;
use fragbuf_templates::vocabulary::{Access, Element, Objects, Pass, Step};

use crate::{Error, host};

/// One thing to record, or to wait for.
#[derive(Clone, Debug)]
pub(crate) enum Action {
    /// Every word of a resource becomes `value`.
    Clear { resource: usize, value: u32 },
    /// One resource over another.
    Copy { from: usize, to: usize },
    /// The pass of this number, in the order of the plan.
    Pass(usize),
    /// The host decides; the frame is cut here unless room has been reserved.
    Host(host::Decision),
}

/// The actions of a plan.
pub(crate) fn actions(plan: &Plan) -> Result<Vec<Action>, Error> {
    for planned in &plan.resources {
        if let Element::Texture(_) = planned.resource.element {
            return Err(unsupported(format!("`{}`, a texture", planned.resource.name)));
        }
    }
    let mut passes = 0..;
    plan.steps.iter().map(|step| action(plan, step, &mut passes)).collect()
}

fn action(plan: &Plan, step: &Step, passes: &mut impl Iterator<Item = usize>) -> Result<Action, Error> {
    Ok(match step {
        Step::Pass(pass) => {
            check_pass(pass)?;
            Action::Pass(passes.next().unwrap_or_default())
        }
        Step::Clear { resource, value } => Action::Clear { resource: index(plan, resource)?, value: *value },
        Step::Copy { from, to } => Action::Copy { from: index(plan, from)?, to: index(plan, to)? },
        Step::Host(host) => Action::Host(host::Decision::of(host, plan)?),
        Step::Swap(a, b) => return Err(unsupported(format!("the exchange of `{a}` and `{b}`"))),
        Step::Repeat(repeat) => return Err(unsupported(format!("a loop of at most {} rounds", repeat.at_most))),
    })
}

fn check_pass(pass: &Pass) -> Result<(), Error> {
    let refuse = |what: &str| Err(unsupported(format!("pass `{}`: {what}", pass.anchor)));
    let state = &pass.state;
    if state.depth.is_some() || state.stencil.is_some() {
        return refuse("a depth or stencil test");
    }
    if state.samples.is_some() {
        return refuse("several samples per pixel");
    }
    if let Some(target) = state.targets.iter().find(|target| target.resource != OUTPUT) {
        return refuse(&format!("the target `{}`", target.resource));
    }
    if state.targets.len() > 1 {
        return refuse("several targets");
    }
    if pass.objects != Objects::All {
        return refuse("drawing only visible objects");
    }
    let attached = |access| matches!(access, Access::Attachment | Access::Sampled | Access::Indirect);
    match pass.uses.iter().find(|usage| attached(usage.access)) {
        Some(usage) => refuse(&format!("`{}` as {:?}", usage.resource, usage.access)),
        None => Ok(()),
    }
}

/// The vocabulary's name for the caller's own target.
const OUTPUT: &str = "output";

pub(crate) fn index(plan: &Plan, resource: &str) -> Result<usize, Error> {
    let index = plan.resources.iter().position(|planned| planned.resource.name == resource);
    index.ok_or_else(|| unsupported(format!("`{resource}`, which the plan does not have")))
}

pub(crate) fn unsupported(what: String) -> Error {
    Error::Unsupported {
        what,
        hint: "follow the manifest with an engine of your own, or take another technique".to_owned(),
    }
}
