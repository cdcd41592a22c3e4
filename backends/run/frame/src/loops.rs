//! Upper bounds on the iterations of a plan's loops and on the runs of its passes, for frames of any size.

use fragbuf_codegen::{Action, Plan, Quantity};

use crate::{Error, Values};

/// Returns the iteration limit of a loop for these values.
pub(crate) fn iteration_limit(values: &Values, limit: &Quantity) -> Result<u64, Error> {
    Ok(values.evaluate(limit, "the iterations of a loop")?.min(u64::from(u32::MAX)))
}

/// Returns the greatest iteration limit of any loop, at least 1. k is the capacity of the code.
pub fn max_iterations(plan: &Plan) -> Result<u32, Error> {
    limits(plan)?.into_iter().try_fold(1, |most, limit| Ok(most.max(limit)))
}

/// Returns the greatest number of pass runs in a slice: a pass runs once for every iteration of each loop around it.
pub fn max_pass_runs(plan: &Plan) -> Result<u64, Error> {
    let limits = limits(plan)?;
    let (mut around, mut runs) = (vec![1u64], 0u64);
    for command in &plan.frame.commands {
        let now = around.last().copied().unwrap_or(1);
        match command.action {
            Action::Loop(id) => around.push(now.saturating_mul(limits[id.0].into())),
            Action::LoopEnd(_) => drop(around.pop()),
            Action::Pass(_) => runs = runs.saturating_add(now),
            _ => {}
        }
    }
    Ok(runs)
}

fn limits(plan: &Plan) -> Result<Vec<u32>, Error> {
    let values = Values::of_code(plan);
    plan.frame.loops.iter().map(|looped| values.word(&looped.max_iterations, "the iterations of a loop")).collect()
}
