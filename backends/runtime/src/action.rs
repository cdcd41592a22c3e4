//! A plan's steps as what the runtime does, one after the other. What it does not run is refused here, by name, before
//! anything is made.

use fragbuf_codegen::Plan;
use fragbuf_frame::{Decision, resource as index, unsupported};
use fragbuf_templates::vocabulary::{Access, Formula, Objects, Pass, Repeat, Step, Until};

use crate::Error;
use crate::texture::{OUTPUT, at_most};

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
    /// The end of a loop's body: back to its first action, unless a word is zero by now.
    Again(Again),
}

/// The end of a round of a loop whose end is found out on the device.
#[derive(Clone, Debug)]
pub(crate) struct Again {
    /// The first action of the body.
    pub(crate) first: usize,
    /// The resource whose only word ends the loop when it is zero.
    pub(crate) zero: usize,
    /// The bound on the rounds.
    pub(crate) at_most: Formula,
}

/// One run of a pass.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Run {
    /// The pass, in the order of the plan.
    pub(crate) pass: usize,
    /// The run's own number in a frame; in the first round of a loop whose end is found out on the device.
    pub(crate) number: usize,
    /// The round of the loop that it is in; 0 outside of any, and in the first round of one whose end is found out.
    pub(crate) round: u32,
    /// Runs of a round of such a loop: what its number grows by from round to round.
    pub(crate) stride: usize,
}

/// Everything that a plan's frame does.
#[derive(Debug)]
pub(crate) struct Actions {
    /// In order; loops over a known number of rounds are unrolled.
    pub(crate) list: Vec<Action>,
    /// The pass of every run that there can be, by its number.
    pub(crate) runs: Vec<usize>,
    /// The most rounds of any loop.
    pub(crate) rounds: u32,
}

/// The actions of a plan.
pub(crate) fn actions(plan: &Plan) -> Result<Actions, Error> {
    let actions = Actions { list: Vec::new(), runs: Vec::new(), rounds: 1 };
    let mut unrolled = Unrolled { plan, passes: 0, stride: 0, actions };
    unrolled.steps(&plan.steps, 0)?;
    Ok(unrolled.actions)
}

struct Unrolled<'a> {
    plan: &'a Plan,
    passes: usize,
    stride: usize,
    actions: Actions,
}

impl Unrolled<'_> {
    fn steps(&mut self, steps: &[Step], round: u32) -> Result<(), Error> {
        let plan = self.plan;
        for step in steps {
            let action = match step {
                Step::Pass(pass) => {
                    check_pass(pass)?;
                    let run = Run { pass: self.passes, number: self.actions.runs.len(), round, stride: self.stride };
                    self.actions.runs.push(self.passes);
                    self.passes += 1;
                    Action::Pass(run)
                }
                Step::Clear { resource, value } => Action::Clear { resource: index(plan, resource)?, value: *value },
                Step::Copy { from, to } => Action::Copy { from: index(plan, from)?, to: index(plan, to)? },
                Step::Host(host) => Action::Host(Decision::of(host, plan)?),
                Step::Swap(a, b) => return Err(refused(format!("the exchange of `{a}` and `{b}`"))),
                Step::Repeat(repeat) => {
                    self.repeat(repeat)?;
                    continue;
                }
            };
            self.actions.list.push(action);
        }
        Ok(())
    }

    fn repeat(&mut self, repeat: &Repeat) -> Result<(), Error> {
        match &repeat.until {
            Until::Times(times) => self.rounds(repeat, times),
            Until::Zero(word) => self.until_zero(repeat, word),
            Until::NoSamples(_) => Err(refused("a loop that ends by an occlusion query".to_owned())),
        }
    }

    /// The body once for every round. Its passes keep their numbers in the plan.
    fn rounds(&mut self, repeat: &Repeat, times: &Formula) -> Result<(), Error> {
        let rounds = self.most(times)?;
        let first = self.passes;
        for round in 0..rounds {
            self.passes = first;
            self.steps(&repeat.body, round)?;
        }
        self.passes = first + count(&repeat.body);
        Ok(())
    }

    /// The body once, and the way back to its beginning. There is a number for every run of the most rounds there can be.
    fn until_zero(&mut self, repeat: &Repeat, word: &str) -> Result<(), Error> {
        let is_simple = |step: &Step| !matches!(step, Step::Repeat(_) | Step::Host(_));
        if self.stride > 0 || !repeat.body.iter().all(is_simple) {
            return Err(refused("loops or host steps in a loop whose end is found out on the device".to_owned()));
        }
        let rounds = self.most(&repeat.at_most)?;
        let first = self.actions.list.len();
        let (passes, numbers) = (self.passes, self.actions.runs.len());
        self.stride = count(&repeat.body);
        self.steps(&repeat.body, 0)?;
        for _ in 1..rounds {
            let body = self.actions.runs[numbers..numbers + self.stride].to_vec();
            self.actions.runs.extend(body);
        }
        (self.stride, self.passes) = (0, passes + count(&repeat.body));
        let again = Again { first, zero: index(self.plan, word)?, at_most: repeat.at_most.clone() };
        self.actions.list.push(Action::Again(again));
        Ok(())
    }

    /// The rounds of a loop, for the greatest k that the code serves.
    fn most(&mut self, rounds: &Formula) -> Result<u32, Error> {
        let rounds = at_most(self.plan, rounds, None, "the rounds of a loop")?;
        self.actions.rounds = self.actions.rounds.max(rounds);
        Ok(rounds)
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
    let tests = (pass.state.depth.as_ref(), pass.state.stencil.as_ref());
    if let (Some(depth), Some(stencil)) = tests
        && depth.resource != stencil.resource
    {
        return refuse("depth and stencil in two textures");
    }
    if pass.state.samples.is_some() && pass.state.targets.iter().any(|target| target.resource == OUTPUT) {
        return refuse("several samples of the output");
    }
    if pass.objects != Objects::All {
        return refuse("drawing only visible objects");
    }
    match pass.uses.iter().find(|usage| usage.access == Access::Indirect) {
        Some(usage) => refuse(&format!("`{}` as {:?}", usage.resource, usage.access)),
        None => Ok(()),
    }
}

fn refused(what: String) -> Error {
    unsupported(what).into()
}
