//! Checks what the types of a plan cannot express: loops are nested, and every name is that of something.

use std::collections::BTreeSet;

use crate::Error;
use crate::manifest::{Action, Exchange, Field, Objects, Plan, Until};

/// Returns the first mistake of a plan.
pub fn check(plan: &Plan) -> Result<(), Error> {
    let failed = |at: usize, problem: String| Err(Error(format!("manifest: step {at}: {problem}")));
    let mut loops = Vec::new();
    for (at, step) in plan.steps.iter().enumerate() {
        match &step.action {
            Action::Loop { end, .. } => loops.push((at, *end)),
            Action::LoopEnd { begin, .. } if loops.pop() != Some((*begin, at)) => {
                return failed(at, format!("it does not end the loop that begins at step {begin}"));
            }
            _ => {}
        }
        if let Some(name) = resources(&step.action).into_iter().find(|name| plan.resource(name).is_none()) {
            return failed(at, format!("there is no resource `{name}`"));
        }
        let passes: BTreeSet<&str> = plan.passes().map(|(_, pass)| pass.name.as_str()).collect();
        if let Some(name) = queried(&step.action).filter(|name| !passes.contains(name)) {
            return failed(at, format!("there is no pass `{name}`"));
        }
        exchanges(plan, &step.exchanged).or_else(|problem| failed(at, problem))?;
    }
    blocks(plan)?;
    if let Some((begin, end)) = loops.pop() {
        return failed(begin, format!("the loop does not end at step {end}"));
    }
    exchanges(plan, &plan.exchanges).map_err(|problem| Error(format!("manifest: exchanges: {problem}")))
}

/// The greatest size of a uniform block in bytes, which every device allows: `maxUniformBufferBindingSize` of WebGPU.
const MOST_BYTES: usize = 65_536;

/// Checks that every field is inside of its block.
fn blocks(plan: &Plan) -> Result<(), Error> {
    for block in &plan.uniform_blocks {
        if block.bytes > MOST_BYTES {
            let name = &block.name;
            return Err(Error(format!(
                "manifest: the uniform block `{name}` has {} bytes, more than {MOST_BYTES}",
                block.bytes
            )));
        }
        let is_outside = |field: &&Field| field.offset.checked_add(4).is_none_or(|end| end > block.bytes);
        if let Some(field) = block.fields.iter().find(is_outside) {
            return Err(Error(format!("manifest: `{}` is outside of the uniform block `{}`", field.name, block.name)));
        }
    }
    Ok(())
}

/// Checks that pairs are those of the plan.
fn exchanges(plan: &Plan, pairs: &[Exchange]) -> Result<(), String> {
    for Exchange { resources: [one, other], .. } in pairs {
        let is_known = |name: &String| plan.resource(name).is_some();
        let is_pair = plan.exchanges.iter().any(|pair| pair.resources == [one.clone(), other.clone()]);
        if !is_known(one) || !is_known(other) || !is_pair {
            return Err(format!("`{one}` and `{other}` are no pair of resources"));
        }
    }
    Ok(())
}

/// Returns the resources of a step. `output` is the host's.
fn resources(action: &Action) -> Vec<&str> {
    match action {
        Action::Clear { resource, .. } => vec![resource],
        Action::Copy { from, to } => vec![from, to],
        Action::Host { reads, .. } => reads.iter().map(|read| read.resource.as_str()).collect(),
        Action::LoopEnd { until: Some(Until::WordIsZero(word)), .. } => vec![word],
        Action::Pass(pass) => {
            let (depth, stencil) = (pass.state.depth.iter(), pass.state.stencil.iter());
            let tested = depth.map(|depth| &depth.resource).chain(stencil.map(|stencil| &stencil.resource));
            let targets = pass.state.targets.iter().map(|target| &target.resource);
            let names = tested.chain(targets).chain(pass.uses.keys()).map(String::as_str);
            names.filter(|name| *name != "output").collect()
        }
        Action::Loop { .. } | Action::LoopEnd { .. } => Vec::new(),
    }
}

/// Returns the pass whose samples a step reads.
pub fn queried(action: &Action) -> Option<&str> {
    match action {
        Action::LoopEnd { until: Some(Until::NoSamples(pass)), .. } => Some(pass),
        Action::Pass(pass) => match &pass.objects {
            Objects::VisibleIn(query) => Some(query),
            _ => None,
        },
        _ => None,
    }
}
