//! Steps through a frame: from command to command, into loops and out of them, past host steps.
//!
//! Input: a plan's lowered frame and the values of its symbols. Output: one step after the other, over physical resources. Where
//! a loop or a host step needs words that passes wrote, the cursor requests them from the device ([`HostWait`]) and continues
//! once they are supplied. This module runs nothing. A cursor is small, so that a search can copy it.

use std::collections::BTreeMap;

use fragbuf_codegen::{Action, Command, Decision, LoopId, LoopUntil, Parity, PassId, Plan, ResourceId};
use fragbuf_templates::vocabulary::Objects;

use crate::condition::{Condition, ConditionWord, Conditions};
use crate::host_step::{apply, decision, word_ranges};
use crate::loops::iteration_limit;
use crate::step::{FrameStep, HostRead, HostWait, PassRun, WordRange};
use crate::{Error, LoopEnd, LoopReport, Readbacks, Values};

/// A position in the commands of a frame.
#[derive(Clone, Debug, PartialEq)]
pub struct Cursor {
    readbacks: Readbacks,
    conditions: Conditions,
    /// The next command.
    at: usize,
    /// The loops around it, the innermost last, each with its iteration.
    around: Vec<(LoopId, u32)>,
    /// The finished iterations of every loop, over the whole frame.
    finished: Vec<u32>,
    /// The exchanges that were flipped when the frame began.
    base: u32,
    /// The objects that queries have dropped, by the query's pass.
    dropped: BTreeMap<PassId, Vec<bool>>,
    /// The update of a query's objects on the device that follows the query's pass.
    update: Option<Condition>,
    /// The request that is not supplied yet, and its purpose.
    requested: Option<(HostWait, Purpose)>,
    loops: Vec<LoopReport>,
}

/// The purpose of requested words.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Purpose {
    /// The host step of this command.
    Decision(usize),
    LoopEnd(LoopId),
    Objects(PassId),
}

impl Cursor {
    /// Returns a cursor at the beginning of a frame. With [`Readbacks::Disabled`] it requests nothing: it skips host steps, runs
    /// loops to their limits and drops no object. With [`Readbacks::Lagged`] it hands on the words of host steps that may lag, and does
    /// not wait. `flipped` is [`Cursor::flipped`] at the end of the previous frame, 0 at first.
    pub fn new(plan: &Plan, readbacks: Readbacks, flipped: u32) -> Self {
        Cursor {
            readbacks,
            conditions: Conditions::OnHost,
            at: 0,
            around: Vec::new(),
            finished: vec![0; plan.frame.loops.len()],
            base: flipped,
            dropped: BTreeMap::new(),
            update: None,
            requested: None,
            loops: Vec::new(),
        }
    }

    /// Sets who evaluates the conditions of loops and objects; at first it is the host.
    #[must_use]
    pub fn with_conditions(self, conditions: Conditions) -> Self {
        Cursor { conditions, ..self }
    }

    /// Returns the next step; `None` at the end of the frame. A request repeats until its words are supplied.
    pub fn next(&mut self, plan: &Plan, values: &Values) -> Result<Option<FrameStep>, Error> {
        if let Some(update) = self.update.take() {
            return Ok(Some(FrameStep::Condition(update)));
        }
        if let Some((wait, _)) = &self.requested {
            return Ok(Some(FrameStep::Wait(wait.clone())));
        }
        while let Some(command) = plan.frame.commands.get(self.at) {
            let flipped = self.flipped_at(command);
            let physical = |resource: ResourceId| plan.frame.physical(resource, flipped);
            let step = match &command.action {
                Action::Clear { resource, value } => FrameStep::Clear { resource: physical(*resource), value: *value },
                Action::Copy { from, to } => FrameStep::Copy { from: physical(*from), to: physical(*to) },
                Action::Pass(pass) => match self.run(plan, *pass, flipped) {
                    Some(run) => FrameStep::Pass(run),
                    None => {
                        self.at += 1;
                        continue;
                    }
                },
                Action::Loop(id) => match self.enter(plan, values, *id)? {
                    Some(step) => return Ok(Some(step)),
                    None => continue,
                },
                Action::LoopEnd(id) => match self.end_iteration(plan, values, *id)? {
                    Some(step) => return Ok(Some(step)),
                    None => continue,
                },
                Action::Host(decision) => match self.host_step(plan, values, decision, flipped)? {
                    Some(step) => return Ok(Some(step)),
                    None => continue,
                },
            };
            self.at += 1;
            return Ok(Some(step));
        }
        Ok(None)
    }

    /// Supplies the words of the last request. Missing words count as 0. A host step sets its symbols in `values`; it is an
    /// error if it sets one outside the symbol's range.
    pub fn supply(&mut self, plan: &Plan, words: &[u32], values: &mut Values) -> Result<(), Error> {
        let Some((wait, purpose)) = self.requested.take() else { return Ok(()) };
        match purpose {
            Purpose::Objects(pass) => {
                let dropped = self.dropped.entry(first_of_query(plan, pass)).or_default();
                dropped.resize(dropped.len().max(words.len()), false);
                dropped.iter_mut().zip(words).for_each(|(dropped, word)| *dropped |= *word == 0);
            }
            Purpose::LoopEnd(id) => {
                let end = if words.first().copied().unwrap_or(0) == 0 {
                    LoopEnd::ConditionMet
                } else {
                    LoopEnd::LimitReached
                };
                self.finish_iteration(plan, values, id, end)?;
            }
            Purpose::Decision(command) => {
                if let (Some(decision), HostWait::Words(ranges)) = (decision(plan, command), &wait) {
                    apply(plan, decision, (words, ranges), values)?;
                }
            }
        }
        Ok(())
    }

    /// Returns the host step whose words are requested.
    pub fn pending_decision<'p>(&self, plan: &'p Plan) -> Option<&'p Decision> {
        match self.requested {
            Some((_, Purpose::Decision(command))) => decision(plan, command),
            _ => None,
        }
    }

    /// Returns the exchanges that are flipped at this position. At the end of a frame, the next frame begins with them.
    pub fn flipped(&self, plan: &Plan) -> u32 {
        let parities = plan.frame.commands.get(self.at).map_or(&plan.frame.end, |command| &command.parities);
        self.mask(parities)
    }

    /// Whether the query `pass` has dropped an object in this frame. A dropped object stays dropped until the frame ends.
    pub fn is_dropped(&self, plan: &Plan, pass: PassId, object: usize) -> bool {
        self.dropped.get(&first_of_query(plan, pass)).and_then(|dropped| dropped.get(object)).copied().unwrap_or(false)
    }

    /// Returns a report on each finished loop that has an end condition.
    pub fn loops(&self) -> &[LoopReport] {
        &self.loops
    }

    fn flipped_at(&self, command: &Command) -> u32 {
        self.mask(&command.parities)
    }

    fn mask(&self, parities: &[Parity]) -> u32 {
        let bits =
            parities.iter().enumerate().map(|(number, parity)| u32::from(parity.is_flipped(&self.finished)) << number);
        bits.fold(self.base, |mask, bit| mask ^ bit)
    }

    /// Returns a run of a pass; `None` for an object query without readbacks.
    fn run(&mut self, plan: &Plan, pass: PassId, flipped: u32) -> Option<PassRun> {
        let conditional = self.conditional_loop(plan);
        if plan.passes[pass.0].objects == Objects::Boxes {
            match (self.conditions, self.readbacks) {
                (Conditions::OnDevice, _) => {
                    self.update = Some(Condition::Objects { pass: first_of_query(plan, pass), around: conditional });
                }
                (Conditions::OnHost, Readbacks::Disabled) => return None,
                (Conditions::OnHost, _) => self.requested = Some((HostWait::Objects(pass), Purpose::Objects(pass))),
            }
        }
        let iteration = self.around.last().map_or(0, |(_, iteration)| *iteration);
        Some(PassRun { pass, iteration, flipped, conditional })
    }

    /// Returns the innermost loop around the next command whose condition the device evaluates.
    fn conditional_loop(&self, plan: &Plan) -> Option<LoopId> {
        let is_conditional = |id: &LoopId| plan.frame.loops[id.0].until != LoopUntil::Times;
        let inside_out = self.around.iter().rev().map(|(id, _)| *id);
        inside_out.filter(|_| self.conditions != Conditions::OnHost).find(is_conditional)
    }

    /// Moves into a loop, or past one without iterations. Returns the update of the device's words.
    fn enter(&mut self, plan: &Plan, values: &Values, id: LoopId) -> Result<Option<FrameStep>, Error> {
        let looped = &plan.frame.loops[id.0];
        if iteration_limit(values, &looped.max_iterations)? == 0 {
            self.at = looped.end + 1;
            return Ok(None);
        }
        let around = self.conditional_loop(plan);
        self.around.push((id, 0));
        self.at += 1;
        let is_conditional = self.conditional_loop(plan) == Some(id);
        Ok(is_conditional.then_some(FrameStep::Condition(Condition::Begin { id, around })))
    }

    /// Returns the request whose words decide whether the loop continues, or the update of the device's words; `None` if the cursor
    /// has moved without one.
    fn end_iteration(&mut self, plan: &Plan, values: &Values, id: LoopId) -> Result<Option<FrameStep>, Error> {
        let word = match plan.frame.loops[id.0].until {
            LoopUntil::Times => None,
            LoopUntil::NoSamples(pass) => Some(ConditionWord::Samples(pass)),
            LoopUntil::WordIsZero(resource) => {
                let resource = plan.frame.physical(resource, self.flipped(plan));
                Some(ConditionWord::Word(WordRange { resource, first: 0, count: 1 }))
            }
        };
        let Some(word) =
            word.filter(|_| self.conditional_loop(plan).is_some() || self.readbacks != Readbacks::Disabled)
        else {
            self.finish_iteration(plan, values, id, LoopEnd::LimitReached)?;
            return Ok(None);
        };
        if self.conditions != Conditions::OnHost {
            self.finish_iteration(plan, values, id, LoopEnd::LimitReached)?;
            let is_last = !self.around.iter().any(|(around, _)| *around == id);
            return Ok(Some(FrameStep::Condition(Condition::End { id, word, is_last })));
        }
        let wait = match word {
            ConditionWord::Word(word) => HostWait::Words(vec![word]),
            ConditionWord::Samples(pass) => HostWait::Samples(pass),
        };
        self.requested = Some((wait.clone(), Purpose::LoopEnd(id)));
        Ok(Some(FrameStep::Wait(wait)))
    }

    /// Moves to the beginning of a loop's body, or past its end. `end` is how the loop ends if this iteration is the last one.
    fn finish_iteration(&mut self, plan: &Plan, values: &Values, id: LoopId, end: LoopEnd) -> Result<(), Error> {
        let looped = &plan.frame.loops[id.0];
        let limit = iteration_limit(values, &looped.max_iterations)?;
        let Some((_, iteration)) = self.around.last_mut() else { return Ok(()) };
        *iteration += 1;
        self.finished[id.0] += 1;
        let iterations = *iteration;
        if end == LoopEnd::LimitReached && u64::from(iterations) < limit {
            self.at = looped.begin + 1;
            return Ok(());
        }
        self.around.pop();
        self.at = looped.end + 1;
        let is_observed = self.conditions == Conditions::OnHost && self.readbacks != Readbacks::Disabled;
        if let Some(until) = until(plan, looped.until).filter(|_| is_observed) {
            LoopReport { until, iterations, end }.merge_into(&mut self.loops);
        }
        Ok(())
    }

    /// Returns the step that reads the words of a host step; `None` if host steps are skipped. The cursor moves past the step.
    fn host_step(
        &mut self,
        plan: &Plan,
        values: &Values,
        decision: &Decision,
        flipped: u32,
    ) -> Result<Option<FrameStep>, Error> {
        let command = self.at;
        self.at += 1;
        if matches!(self.readbacks, Readbacks::LoopsOnly | Readbacks::Disabled) {
            return Ok(None);
        }
        let ranges = word_ranges(plan, values, decision, flipped)?;
        if self.readbacks == Readbacks::Lagged && decision.may_lag {
            return Ok(Some(FrameStep::Read(HostRead { command, ranges })));
        }
        let wait = HostWait::Words(ranges);
        self.requested = Some((wait.clone(), Purpose::Decision(command)));
        Ok(Some(FrameStep::Wait(wait)))
    }
}

/// Returns the first pass with the name of this pass: a frame may contain several passes of one query.
pub fn first_of_query(plan: &Plan, pass: PassId) -> PassId {
    plan.pass_id(&plan.passes[pass.0].name).unwrap_or(pass)
}

/// Returns the end condition of a loop as a sentence; `None` if its iteration count is fixed.
pub(crate) fn until(plan: &Plan, until: LoopUntil) -> Option<String> {
    match until {
        LoopUntil::Times => None,
        LoopUntil::WordIsZero(id) => Some(format!("`{}` is zero", plan.resources[id.0].resource.name)),
        LoopUntil::NoSamples(id) => Some(format!("no sample passes in `{}`", plan.passes[id.0].name)),
    }
}
