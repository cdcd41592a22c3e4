//! Checks what the types of a plan cannot express: loops are nested, every name is that of something, and every
//! number is in its range. A manifest may be written by anybody.

mod blocks;
mod passes;
mod symbols;

use std::collections::BTreeMap;

use crate::Error;
use crate::manifest::{Action, Exchange, Kind, Objects, Pass, Plan, Until};

/// Returns the first mistake of a plan.
pub fn check(plan: &Plan) -> Result<(), Error> {
    let failed = |problem: String| Error(format!("manifest: {problem}: generate it again"));
    steps(plan).map_err(failed)?;
    exchanges(plan, &plan.exchanges).map_err(|problem| failed(format!("exchanges: {problem}")))?;
    blocks::check(plan).map_err(failed)?;
    symbols::check_defaults(plan).map_err(failed)?;
    symbols::check_counters(plan).map_err(failed)
}

fn steps(plan: &Plan) -> Result<(), String> {
    let failed = |at: usize, problem: String| Err(format!("step {at}: {problem}"));
    let mut loops = Vec::new();
    let draws = draws(plan);
    for (at, step) in plan.steps.iter().enumerate() {
        match &step.action {
            Action::Loop { end, .. } => loops.push((at, *end)),
            Action::LoopEnd { begin, .. } if loops.pop() != Some((*begin, at)) => {
                return failed(at, format!("it does not end the loop that begins at step {begin}"));
            }
            Action::Pass(pass) => passes::check(pass).or_else(|problem| failed(at, problem))?,
            _ => {}
        }
        if let Some(name) = resources(&step.action).into_iter().find(|name| plan.resource(name).is_none()) {
            return failed(at, format!("there is no resource `{name}`"));
        }
        match queried(&step.action).map(|name| (name, draws.get(name))) {
            Some((name, None)) => return failed(at, format!("there is no pass `{name}`")),
            Some((name, Some(false))) => {
                return failed(at, format!("the pass `{name}` computes, so it has no samples"));
            }
            _ => {}
        }
        exchanges(plan, &step.exchanged).or_else(|problem| failed(at, problem))?;
    }
    match loops.pop() {
        Some((begin, end)) => failed(begin, format!("the loop does not end at step {end}")),
        None => Ok(()),
    }
}

/// Returns the names of passes, each with whether all passes of the name draw.
fn draws(plan: &Plan) -> BTreeMap<&str, bool> {
    let mut draws = BTreeMap::new();
    for (_, Pass { name, kind, .. }) in plan.passes() {
        *draws.entry(name.as_str()).or_insert(true) &= *kind != Kind::Compute;
    }
    draws
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
