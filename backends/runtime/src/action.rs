//! A plan's steps as what the runtime does, one after the other. What it does not run is refused here, by name, before
//! anything is made.

use fragbuf_codegen::Plan;
use fragbuf_frame::{Decision, resource as index, unsupported};
use fragbuf_templates::vocabulary::{Access, Element, Objects, Pass, Repeat, Step, Until};

use crate::Error;

/// One thing to record, or to wait for.
#[derive(Clone, Debug)]
pub(crate) enum Action {
    /// Every word of a resource becomes `value`.
    Clear { resource: usize, value: u32 },
    /// One resource over another.
    Copy { from: usize, to: usize },
    /// A pass.
    Pass(Run),
    /// The host decides; the frame is cut here unless room has been reserved.
    Host(Decision),
}

/// One run of a pass.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Run {
    /// The pass, in the order of the plan.
    pub(crate) pass: usize,
    /// The run's own number in a frame.
    pub(crate) number: usize,
    /// The round of the loop that it is in; 0 outside of any.
    pub(crate) round: u32,
}

/// The actions of a plan, loops unrolled.
pub(crate) fn actions(plan: &Plan) -> Result<Vec<Action>, Error> {
    for planned in &plan.resources {
        if let Element::Texture(_) = planned.resource.element {
            return Err(refused(format!("`{}`, a texture", planned.resource.name)));
        }
    }
    let mut unrolled = Unrolled { plan, passes: 0, runs: 0, actions: Vec::new() };
    unrolled.steps(&plan.steps, 0)?;
    Ok(unrolled.actions)
}

struct Unrolled<'a> {
    plan: &'a Plan,
    passes: usize,
    runs: usize,
    actions: Vec<Action>,
}

impl Unrolled<'_> {
    fn steps(&mut self, steps: &[Step], round: u32) -> Result<(), Error> {
        let plan = self.plan;
        for step in steps {
            let action = match step {
                Step::Pass(pass) => {
                    check_pass(pass)?;
                    let run = Run { pass: self.passes, number: self.runs, round };
                    self.passes += 1;
                    self.runs += 1;
                    Action::Pass(run)
                }
                Step::Clear { resource, value } => Action::Clear { resource: index(plan, resource)?, value: *value },
                Step::Copy { from, to } => Action::Copy { from: index(plan, from)?, to: index(plan, to)? },
                Step::Host(host) => Action::Host(Decision::of(host, plan)?),
                Step::Swap(a, b) => return Err(refused(format!("the exchange of `{a}` and `{b}`"))),
                Step::Repeat(repeat) => {
                    self.rounds(repeat)?;
                    continue;
                }
            };
            self.actions.push(action);
        }
        Ok(())
    }

    /// The body once for every round. Its passes keep their numbers in the plan.
    fn rounds(&mut self, repeat: &Repeat) -> Result<(), Error> {
        let Until::Times(times) = &repeat.until else {
            return Err(refused("a loop whose end is found out on the device".to_owned()));
        };
        let rounds = times.evaluate(&|symbol| self.plan.bound.value(symbol));
        let rounds = rounds.map_err(|error| Error::Formula { what: "the rounds of a loop".to_owned(), error })?;
        let rounds = u32::try_from(rounds).map_err(|_| refused(format!("a loop of {rounds} rounds")))?;
        let first = self.passes;
        for round in 0..rounds {
            self.passes = first;
            self.steps(&repeat.body, round)?;
        }
        self.passes = first + count(&repeat.body);
        Ok(())
    }
}

/// Passes among steps, those inside loops included.
fn count(steps: &[Step]) -> usize {
    let passes = steps.iter().map(|step| match step {
        Step::Pass(_) => 1,
        Step::Repeat(repeat) => count(&repeat.body),
        _ => 0,
    });
    passes.sum()
}

fn check_pass(pass: &Pass) -> Result<(), Error> {
    let refuse = |what: &str| Err(refused(format!("pass `{}`: {what}", pass.anchor)));
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

fn refused(what: String) -> Error {
    unsupported(what).into()
}
