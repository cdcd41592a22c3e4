//! The one way through a frame: from command to command, into loops and out of them, past what the host decides.
//!
//! In: a plan's lowered frame and the values of its symbols. Out: turns, one after the other, over physical resources. What
//! a loop or the host must see before the frame goes on is a question to the device, which answers with words. Nothing is
//! run here, and a cursor is small: a search may copy it.

use std::collections::BTreeMap;

use fragbuf_codegen::{Action, Command, Decision, LoopId, LoopUntil, PassId, Plan, Quantity, ResourceId};
use fragbuf_templates::vocabulary::{HostCall, Objects};

use crate::{Counting, Error, LoopEnd, Looped, Values};

/// What a device does next.
#[derive(Clone, Debug, PartialEq)]
pub enum Turn {
    /// Every word of a resource becomes `value`.
    Clear {
        /// The resource.
        resource: ResourceId,
        /// The word.
        value: u32,
    },
    /// One resource over another.
    Copy {
        /// Read.
        from: ResourceId,
        /// Written.
        to: ResourceId,
    },
    /// A pass.
    Pass(Run),
    /// The frame goes on once this has been answered ([`Cursor::answer`]).
    Ask(Question),
}

/// One run of a pass.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Run {
    /// The pass.
    pub pass: PassId,
    /// The iteration of the innermost loop around it; 0 outside of any.
    pub iteration: u32,
    /// The exchanges of the frame that are flipped: a resource of the pass is
    /// [`LoweredFrame::physical`](fragbuf_codegen::LoweredFrame::physical).
    pub flipped: u32,
}

/// What must be known before a frame goes on.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Question {
    /// Words of resources, one range after the other.
    Words(Vec<Span>),
    /// One word: 0 where no sample passed in the last run of this pass.
    Samples(PassId),
    /// One word per object: 0 where no sample of its box passed in the last run of this pass, and the box does not cross
    /// the near plane.
    Objects(PassId),
}

/// Words of a resource.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Span {
    /// The resource.
    pub resource: ResourceId,
    /// The first word.
    pub first: u64,
    /// How many.
    pub count: u64,
}

/// A place in a frame.
#[derive(Clone, Debug, PartialEq)]
pub struct Cursor {
    counting: Counting,
    /// The next command.
    at: usize,
    /// The loops around it, the innermost last, each with its iteration.
    around: Vec<(LoopId, u32)>,
    /// Finished iterations of every loop, over the whole frame.
    finished: Vec<u32>,
    /// The exchanges that were flipped when the frame began.
    base: u32,
    /// Objects that queries have dropped, by the query's pass.
    dropped: BTreeMap<PassId, Vec<bool>>,
    /// What has been asked and not answered, and what the answer is for.
    asked: Option<(Question, Purpose)>,
    loops: Vec<Looped>,
}

/// What an answer is for.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Purpose {
    /// The decision of this command.
    Decision(usize),
    LoopEnd(LoopId),
    Objects(PassId),
}

impl Cursor {
    /// At the beginning of a frame. `counting`: where the caller has reserved memory, nothing is asked: host steps are left
    /// out, loops go on to their bound, and no object is dropped. `flipped`: [`Cursor::flipped`] at the end of the frame
    /// before, 0 at first.
    pub fn new(plan: &Plan, counting: Counting, flipped: u32) -> Self {
        Cursor {
            counting,
            at: 0,
            around: Vec::new(),
            finished: vec![0; plan.frame.loops.len()],
            base: flipped,
            dropped: BTreeMap::new(),
            asked: None,
            loops: Vec::new(),
        }
    }

    /// The next turn; `None`: the frame is over. A question is asked again until it has been answered.
    pub fn next(&mut self, plan: &Plan, values: &Values) -> Result<Option<Turn>, Error> {
        if let Some((question, _)) = &self.asked {
            return Ok(Some(Turn::Ask(question.clone())));
        }
        while let Some(command) = plan.frame.commands.get(self.at) {
            let flipped = self.flipped_at(command);
            let physical = |resource: ResourceId| plan.frame.physical(resource, flipped);
            let turn = match &command.action {
                Action::Clear { resource, value } => Turn::Clear { resource: physical(*resource), value: *value },
                Action::Copy { from, to } => Turn::Copy { from: physical(*from), to: physical(*to) },
                Action::Pass(pass) => match self.run(plan, *pass, flipped) {
                    Some(run) => Turn::Pass(run),
                    None => {
                        self.at += 1;
                        continue;
                    }
                },
                Action::Loop(id) => {
                    self.enter(plan, values, *id)?;
                    continue;
                }
                Action::LoopEnd(id) => match self.end_iteration(plan, values, *id)? {
                    Some(question) => return Ok(Some(Turn::Ask(question))),
                    None => continue,
                },
                Action::Host(decision) => match self.decide(plan, values, decision, flipped)? {
                    Some(question) => return Ok(Some(Turn::Ask(question))),
                    None => continue,
                },
            };
            self.at += 1;
            return Ok(Some(turn));
        }
        Ok(None)
    }

    /// Answers the question that was asked last. Words that are missing count as 0. What a host step decides is set in
    /// `values`. `Err`: it decides what there is not.
    pub fn answer(&mut self, plan: &Plan, words: &[u32], values: &mut Values) -> Result<(), Error> {
        let Some((question, purpose)) = self.asked.take() else { return Ok(()) };
        match purpose {
            Purpose::Objects(pass) => {
                let dropped = self.dropped.entry(query(plan, pass)).or_default();
                dropped.resize(dropped.len().max(words.len()), false);
                dropped.iter_mut().zip(words).for_each(|(dropped, word)| *dropped |= *word == 0);
            }
            Purpose::LoopEnd(id) => {
                let end = if words.first().copied().unwrap_or(0) == 0 { LoopEnd::Reached } else { LoopEnd::Cut };
                self.go_on(plan, values, id, end)?;
            }
            Purpose::Decision(command) => {
                if let (Some(decision), Question::Words(spans)) = (decision(plan, command), &question) {
                    apply(plan, decision, (words, spans), values)?;
                }
            }
        }
        Ok(())
    }

    /// The decision that waits for an answer.
    pub fn decides<'p>(&self, plan: &'p Plan) -> Option<&'p Decision> {
        match self.asked {
            Some((_, Purpose::Decision(command))) => decision(plan, command),
            _ => None,
        }
    }

    /// The exchanges that are flipped here: once the frame is over, those that the next one begins with.
    pub fn flipped(&self, plan: &Plan) -> u32 {
        let parities = plan.frame.commands.get(self.at).map_or(&plan.frame.end, |command| &command.parities);
        self.mask(parities)
    }

    /// Whether the query `pass` has dropped an object in this frame: what is peeled away does not come back.
    pub fn is_dropped(&self, plan: &Plan, pass: PassId, object: usize) -> bool {
        self.dropped.get(&query(plan, pass)).and_then(|dropped| dropped.get(object)).copied().unwrap_or(false)
    }

    /// How the loops have ended so far whose ends are found out while a frame runs.
    pub fn loops(&self) -> &[Looped] {
        &self.loops
    }

    fn flipped_at(&self, command: &Command) -> u32 {
        self.mask(&command.parities)
    }

    fn mask(&self, parities: &[fragbuf_codegen::Parity]) -> u32 {
        let bits =
            parities.iter().enumerate().map(|(number, parity)| u32::from(parity.is_flipped(&self.finished)) << number);
        bits.fold(self.base, |mask, bit| mask ^ bit)
    }

    /// A run of a pass; `None`: a query for objects, of which nothing could be asked.
    fn run(&mut self, plan: &Plan, pass: PassId, flipped: u32) -> Option<Run> {
        if plan.passes[pass.0].objects == Objects::Boxes {
            if self.counting == Counting::Reserved {
                return None;
            }
            self.asked = Some((Question::Objects(pass), Purpose::Objects(pass)));
        }
        let iteration = self.around.last().map_or(0, |(_, iteration)| *iteration);
        Some(Run { pass, iteration, flipped })
    }

    fn enter(&mut self, plan: &Plan, values: &Values, id: LoopId) -> Result<(), Error> {
        let looped = &plan.frame.loops[id.0];
        if at_most(values, &looped.at_most)? == 0 {
            self.at = looped.end + 1;
        } else {
            self.around.push((id, 0));
            self.at += 1;
        }
        Ok(())
    }

    /// The question whose answer decides whether a loop goes on; `None`: nothing is asked, and the cursor has moved.
    fn end_iteration(&mut self, plan: &Plan, values: &Values, id: LoopId) -> Result<Option<Question>, Error> {
        let question = match plan.frame.loops[id.0].until {
            LoopUntil::Times => None,
            _ if self.counting == Counting::Reserved => None,
            LoopUntil::NoSamples(pass) => Some(Question::Samples(pass)),
            LoopUntil::WordIsZero(resource) => {
                let flipped = self.flipped(plan);
                let resource = plan.frame.physical(resource, flipped);
                Some(Question::Words(vec![Span { resource, first: 0, count: 1 }]))
            }
        };
        match &question {
            None => self.go_on(plan, values, id, LoopEnd::Cut)?,
            Some(question) => self.asked = Some((question.clone(), Purpose::LoopEnd(id))),
        }
        Ok(question)
    }

    /// Back to the beginning of a loop's body, or behind its end.
    fn go_on(&mut self, plan: &Plan, values: &Values, id: LoopId, end: LoopEnd) -> Result<(), Error> {
        let looped = &plan.frame.loops[id.0];
        let most = at_most(values, &looped.at_most)?;
        let Some((_, iteration)) = self.around.last_mut() else { return Ok(()) };
        *iteration += 1;
        self.finished[id.0] += 1;
        let iterations = *iteration;
        if end == LoopEnd::Cut && u64::from(iterations) < most {
            self.at = looped.begin + 1;
            return Ok(());
        }
        self.around.pop();
        self.at = looped.end + 1;
        let is_asked = self.counting == Counting::Exact;
        if let Some(until) = until(plan, looped.until).filter(|_| is_asked) {
            Looped { until, rounds: iterations, end }.note(&mut self.loops);
        }
        Ok(())
    }

    /// The words that the host decides by; `None`: it decides nothing, and the cursor has moved.
    fn decide(
        &mut self,
        plan: &Plan,
        values: &Values,
        decision: &Decision,
        flipped: u32,
    ) -> Result<Option<Question>, Error> {
        let command = self.at;
        self.at += 1;
        if self.counting == Counting::Reserved {
            return Ok(None);
        }
        let question = Question::Words(spans(plan, values, decision, flipped)?);
        self.asked = Some((question.clone(), Purpose::Decision(command)));
        Ok(Some(question))
    }
}

fn decision(plan: &Plan, command: usize) -> Option<&Decision> {
    match &plan.frame.commands.get(command)?.action {
        Action::Host(decision) => Some(decision),
        _ => None,
    }
}

fn at_most(values: &Values, at_most: &Quantity) -> Result<u64, Error> {
    Ok(values.evaluate(at_most, "the iterations of a loop")?.min(u64::from(u32::MAX)))
}

/// The pass that stands for a query, which may be asked in several places of a frame.
fn query(plan: &Plan, pass: PassId) -> PassId {
    plan.pass_id(&plan.passes[pass.0].anchor).unwrap_or(pass)
}

fn spans(plan: &Plan, values: &Values, decision: &Decision, flipped: u32) -> Result<Vec<Span>, Error> {
    let span = |range: &fragbuf_codegen::Range| {
        let what = format!("the words that the host function `{}` reads", decision.name);
        let (first, count) = (values.evaluate(&range.first, &what)?, values.evaluate(&range.count, &what)?);
        let planned = &plan.resources[range.resource.0];
        let limit = values.evaluate(&planned.words, &what)?;
        if first.saturating_add(count) > limit {
            return Err(Error::BadValue {
                name: format!(
                    "what the host function `{}` reads of `{}`, words {first} to {},",
                    decision.name,
                    planned.resource.name,
                    first.saturating_add(count) - 1
                ),
                wanted: format!("within its {limit} words"),
            });
        }
        Ok(Span { resource: plan.frame.physical(range.resource, flipped), first, count })
    };
    decision.reads.iter().map(span).collect()
}

/// Calls a host function and sets what it decides.
fn apply(
    plan: &Plan,
    decision: &Decision,
    (words, spans): (&[u32], &[Span]),
    values: &mut Values,
) -> Result<(), Error> {
    let mut padded = words.to_vec();
    padded.resize(spans.iter().map(|span| span.count as usize).sum(), 0);
    let (mut reads, mut rest) = (Vec::new(), padded.as_slice());
    for span in spans {
        let (read, behind) = rest.split_at(span.count as usize);
        reads.push(read);
        rest = behind;
    }
    let decided = (decision.function.0)(&HostCall { reads, symbol: &|name| values.named(name) });
    let decided = || decision.sets.iter().zip(&decided);
    for (id, &value) in decided() {
        let symbol = plan.symbols.get(*id);
        let (least, most) = symbol.range;
        if !(least..=most).contains(&value) {
            return Err(Error::BadValue {
                name: format!("`{}`, which the host function `{}` sets to {value},", symbol.name, decision.name),
                wanted: format!("from {least} to {most}"),
            });
        }
    }
    // All of them or none: after an error the values are those of before.
    decided().for_each(|(id, value)| values.set(*id, *value));
    Ok(())
}

/// What a loop waits for, in words; `None`: for nothing.
fn until(plan: &Plan, until: LoopUntil) -> Option<String> {
    match until {
        LoopUntil::Times => None,
        LoopUntil::WordIsZero(id) => Some(format!("`{}` is zero", plan.resources[id.0].resource.name)),
        LoopUntil::NoSamples(id) => Some(format!("no sample passes in `{}`", plan.passes[id.0].anchor)),
    }
}

/// The iterations of a loop at most, whatever the frame: k is the greatest that the code serves.
pub fn most_iterations(plan: &Plan) -> Result<u32, Error> {
    bounds(plan)?.into_iter().try_fold(1, |most, bound| Ok(most.max(bound)))
}

/// Runs of passes in a frame at most: a pass runs once for every iteration of each loop around it.
pub fn most_runs(plan: &Plan) -> Result<u64, Error> {
    let bounds = bounds(plan)?;
    let (mut around, mut runs) = (vec![1u64], 0u64);
    for command in &plan.frame.commands {
        let now = around.last().copied().unwrap_or(1);
        match command.action {
            Action::Loop(id) => around.push(now.saturating_mul(bounds[id.0].into())),
            Action::LoopEnd(_) => drop(around.pop()),
            Action::Pass(_) => runs = runs.saturating_add(now),
            _ => {}
        }
    }
    Ok(runs)
}

fn bounds(plan: &Plan) -> Result<Vec<u32>, Error> {
    let values = Values::of_code(plan);
    plan.frame.loops.iter().map(|looped| values.word(&looped.at_most, "the iterations of a loop")).collect()
}
