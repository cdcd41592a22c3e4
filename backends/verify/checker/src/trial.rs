//! One case, tried: memory is brought to the prior state, the fragments are set off, ends are judged.
//!
//! In: a subject and a case. Out: what the search found. The judge reads a pixel out through the storage's own functions
//! after the remaining steps of the frame have been done. Where a loop brings the frame back to the pass under test, every
//! end of one round is the beginning of a search of the next.

use std::borrow::Cow;
use std::collections::hash_map::Entry;
use std::collections::{HashMap, HashSet};

use fragbuf_codegen::FIRST_BINDING;
use fragbuf_frame::COUNTERS_RESOURCE;
use fragbuf_interpreter::{Exit, Machine, Program};
use fragbuf_templates::COUNTERS;
use fragbuf_templates::vocabulary::Fact;

use crate::case::Case;
use crate::explore::{End, Failure, Found, Judge, Step, What, explore};
use crate::fragments::{Fragment, at_pixel, farthest};
use crate::frame::{Frame, Memory, WIDTH, run_alone};
use crate::model::Model;
use crate::policy::{Finding, Policy};
use crate::promise::Promise;
use crate::state::{Ground, Home, Mishap, State};
use crate::stream::{Left, Stream};
use crate::subject::{Runnable, Subject};
use crate::walk::walk;

/// How to search.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Search {
    pub(crate) model: Model,
    /// Single schedules instead of all orders.
    pub(crate) seeds: Option<u32>,
    pub(crate) limit: usize,
    pub(crate) may_give_up: bool,
    /// Whether fragments come one after the other, in every order, so that no race excuses anything.
    pub(crate) one_by_one: bool,
}

impl Search {
    /// The same without races.
    pub(crate) fn without_races(self) -> Search {
        Search { model: Model::Sequential, one_by_one: true, ..self }
    }
}

/// A case that is set up.
pub(crate) struct Trial<'s> {
    pub(crate) subject: &'s Subject,
    pub(crate) case: Case,
    pub(crate) rounds: Vec<Round<'s>>,
    neighbour: Fragment,
    /// Comes to every pass, and lies behind something opaque in the pixel under test; `None`: nothing asks for that.
    hidden: Option<Fragment>,
    policy: Policy,
    /// Fragments of the pixel that a pass counts, where the rows say that one does.
    counted: Option<usize>,
}

/// One beginning of the pass under test.
pub(crate) struct Round<'s> {
    pub(crate) ground: Ground<'s>,
    pub(crate) first: Result<State, Mishap>,
    /// The round that it comes after, and the steps there.
    pub(crate) before: Option<(usize, Vec<Step>)>,
    /// The frame up to here.
    frame: Frame<'s>,
}

/// What a trial found.
pub(crate) struct Outcome {
    pub(crate) states: usize,
    pub(crate) is_whole: bool,
    /// The first failure and its round.
    pub(crate) failure: Option<(usize, Failure)>,
    /// The first end that is no worse than the rows state.
    pub(crate) stated: Option<(usize, Failure)>,
}

impl<'s> Trial<'s> {
    /// Does everything that comes before the fragments under test.
    pub(crate) fn new(subject: &'s Subject, case: Case, neighbour: &Fragment, search: &Search) -> Result<Self, String> {
        let real = case.new.len() - usize::from(case.has_helper);
        let counted = case.prior.len() + real - usize::from(case.room.has_unseen);
        let counted = subject.plan.selection.offers().contains(&Fact::Counted).then_some(counted);
        let fragments = case.prior.iter().chain(&case.new[..real]).map(|fragment| fragment.words.clone()).collect();
        let policy = Policy {
            promise: Promise::new(subject, case.k),
            hazards: subject.permits().filter(|permits| !search.one_by_one || !permits.needs_race).cloned().collect(),
            short: case.room.short.clone(),
            may_give_up: search.may_give_up,
            culls: subject.turns_away(),
            handed: case.k.filter(|_| subject.is_handed_the_best()).map(|k| k as usize),
            fragments,
            neighbours: 1,
            neighbours_lost: case.room.neighbours_lost,
            hidden: u32::from(subject.hides()),
        };
        let mut frame = Frame::new(subject, case.room.values.clone())?;
        frame.reserved = case.room.reserved;
        let program = &subject.passes[case.pass].program;
        let hidden = farthest(case.prior.iter().chain(&case.new), program).filter(|_| subject.hides());
        if let Some((depth, _)) = hidden {
            frame.set_opaque(case.pixel, depth);
        }
        let (neighbour, hidden) = (neighbour.clone(), hidden.map(|(_, behind)| behind));
        let mut trial = Trial { subject, case, rounds: Vec::new(), neighbour, hidden, policy, counted };
        let seen = trial.case.new.len() - usize::from(trial.case.room.has_unseen || trial.case.has_helper);
        if !frame.advance(trial.runnable(), &|runnable| trial.inputs(runnable, &trial.case.new[..seen]))? {
            return Err(format!("the frame never comes to the pass `{}`", trial.runnable().pass.anchor));
        }
        trial.begin(frame, None, search)?;
        Ok(trial)
    }

    fn runnable(&self) -> &'s Runnable {
        &self.subject.passes[self.case.pass]
    }

    /// What is promised in a frame, whose k a host step may have decided.
    fn policy_in(&self, frame: &Frame<'_>) -> Cow<'_, Policy> {
        match frame.decided_k() {
            None => Cow::Borrowed(&self.policy),
            Some(k) => Cow::Owned(Policy {
                promise: Promise::new(self.subject, Some(k)),
                handed: self.subject.is_handed_the_best().then_some(k as usize),
                ..self.policy.clone()
            }),
        }
    }

    /// What the host must allocate in a frame, where the rows say that a pass counts it: the pixel's fragments and the
    /// neighbour's.
    fn wanted_in(&self, frame: &Frame<'_>) -> Option<u64> {
        let k = frame.decided_k().or(self.case.k);
        self.counted.map(|counted| k.map_or(counted, |k| counted.min(k as usize)) as u64 + 1)
    }

    /// The inputs of the neighbour, of what something opaque hides, of what was there before, and of `new`.
    fn inputs(&self, runnable: &Runnable, new: &[Fragment]) -> Vec<Vec<Vec<u32>>> {
        let pixel = self.case.pixel;
        let beside = (&self.neighbour, WIDTH - 1 - pixel);
        let own = self.hidden.iter().chain(&self.case.prior).chain(new);
        let all = std::iter::once(beside).chain(own.map(|fragment| (fragment, pixel)));
        all.map(|(fragment, pixel)| at_pixel(fragment, &runnable.program, pixel).inputs).collect()
    }

    /// Sets the fragments off where the frame stands before the pass under test.
    fn begin(
        &mut self,
        mut frame: Frame<'s>,
        before: Option<(usize, Vec<Step>)>,
        search: &Search,
    ) -> Result<(), String> {
        let (model, one_by_one) = (search.model, search.one_by_one);
        let runnable = self.runnable();
        for inputs in self.inputs(runnable, &[]) {
            frame.insert(runnable, &inputs)?;
        }
        let (mut ground, words) = ground(self.subject, &runnable.program, &frame.memory, model);
        ground.one_by_one = one_by_one;
        ground.counts_samples = runnable.is_awaited;
        ground.helper = self.case.has_helper.then(|| self.case.new.len() - 1);
        let new = self.case.new.iter().map(|fragment| at_pixel(fragment, &runnable.program, self.case.pixel));
        let machines = new.map(|fragment| machine(&runnable.program, &fragment.inputs)).collect();
        let first = ground.start(words, machines);
        self.rounds.push(Round { ground, first, before, frame });
        Ok(())
    }

    /// Searches, round after round.
    pub(crate) fn run(&mut self, search: &Search) -> Result<Outcome, String> {
        let mut outcome = Outcome { states: 0, is_whole: true, failure: None, stated: None };
        let mut known: HashSet<Memory> = HashSet::new();
        let mut at = 0;
        while at < self.rounds.len() && outcome.failure.is_none() {
            let (found, frames) = self.search(at, search);
            outcome.states += found.states;
            outcome.is_whole &= found.is_whole;
            outcome.failure = found.failure.map(|failure| (at, failure));
            outcome.stated = outcome.stated.or(found.stated.map(|failure| (at, failure)));
            for (words, steps) in found.goes_on {
                let Some(frame) = frames.get(&words).filter(|frame| known.insert(frame.memory.clone())) else {
                    continue;
                };
                self.begin(frame.clone(), Some((at, steps)), search)?;
            }
            at += 1;
        }
        Ok(outcome)
    }

    /// Searches one round. Also: the frame, come back to the pass, for every end that goes on.
    fn search(&self, at: usize, search: &Search) -> (Found, HashMap<Vec<u32>, Frame<'s>>) {
        let round = &self.rounds[at];
        let first = match &round.first {
            Err(mishap) => {
                let what = What::Mishap(0, *mishap);
                let failure = Some(Failure { steps: Vec::new(), what });
                return (Found { states: 1, is_whole: true, failure, ..Found::default() }, HashMap::new());
            }
            Ok(first) => first,
        };
        let homes = homes_by_memory(round.ground.program, &round.ground);
        let mut judge = EndJudge {
            trial: self,
            frame: round.frame.clone(),
            homes,
            is_racy: self.subject.is_racy(),
            known: HashMap::new(),
            left: HashMap::new(),
            goes_on: HashMap::new(),
        };
        let found = match search.seeds {
            Some(seeds) => walk(&round.ground, first, &mut judge, seeds),
            None => explore(&round.ground, first.clone(), &mut judge, search.limit),
        };
        (found, judge.goes_on)
    }
}

fn machine<'p>(program: &'p Program, inputs: &[Vec<u32>]) -> Machine<'p> {
    let mut machine = Machine::new(program);
    inputs.iter().enumerate().for_each(|(number, words)| machine.set_input(number, words));
    machine
}

/// What the states of a trial share, and the words of the first.
fn ground<'s>(subject: &Subject, program: &'s Program, memory: &Memory, model: Model) -> (Ground<'s>, Vec<u32>) {
    let (mut ground, words) = Ground::new(program, memory, model);
    ground.has_fences &= subject.has_fences;
    ground.by_submission = subject.has_ordered_interlock;
    (ground, words)
}

/// (memory, first moving word, words) for every buffer that moves.
fn homes_by_memory(program: &Program, ground: &Ground<'_>) -> Vec<(usize, usize, usize)> {
    let homes = program.buffers.iter().zip(&ground.homes);
    homes
        .filter_map(|(buffer, home)| match home {
            Home::Moving { first, words, .. } => Some((Subject::memory_of(buffer.binding), *first, *words)),
            Home::Fixed(_) => None,
        })
        .collect()
}

struct EndJudge<'t, 's> {
    trial: &'t Trial<'s>,
    frame: Frame<'s>,
    homes: Vec<(usize, usize, usize)>,
    is_racy: bool,
    known: HashMap<Vec<u32>, End>,
    /// What may have left the pixel, by how many were given up.
    left: HashMap<usize, Vec<Left>>,
    /// Where the frame stands when it has come back to the pass, by the words of the end.
    goes_on: HashMap<Vec<u32>, Frame<'s>>,
}

impl<'s> EndJudge<'_, 's> {
    /// The frame with these words in memory.
    fn frame_of(&self, words: &[u32]) -> Frame<'s> {
        let mut frame = self.frame.clone();
        for (memory, first, count) in &self.homes {
            frame.memory[*memory].copy_from_slice(&words[*first..first + count]);
        }
        frame
    }

    /// Finishes the frame from these words, reads both pixels and judges.
    fn judged(&mut self, words: &[u32]) -> Result<End, String> {
        let trial = self.trial;
        let mut frame = self.frame_of(words);
        let real = &trial.case.new[..trial.case.new.len() - usize::from(trial.case.has_helper)];
        // Behind the words in memory stand the samples that passed, where a loop waits for them.
        let moving: usize = self.homes.iter().map(|(_, _, count)| count).sum();
        frame.pass_by(words.get(moving).copied().unwrap_or(0))?;
        if frame.advance(trial.runnable(), &|runnable| trial.inputs(runnable, real))? {
            self.goes_on.insert(words.to_vec(), frame);
            return Ok(End::GoesOn);
        }
        let policy = trial.policy_in(&frame);
        if let (Some(asked), Some(wanted)) = (frame.asked, trial.wanted_in(&frame))
            && asked != wanted
        {
            return Ok(End::Wrong(format!("room is made for {asked} fragments, and {wanted} are stored")));
        }
        let kept = frame.read_out(trial.case.pixel)?;
        let beside = frame.read_out(WIDTH - 1 - trial.case.pixel)?;
        let is_lost = trial.policy.neighbours_lost > 0;
        if beside != if is_lost { Vec::new() } else { vec![trial.neighbour.words.clone()] } {
            return Ok(End::Wrong("the neighbouring pixel has changed".to_owned()));
        }
        let plan = &frame.subject.plan;
        let counters = plan.resources.iter().position(|planned| planned.resource.name == COUNTERS_RESOURCE);
        let counters = counters.map_or(&[][..], |at| &frame.memory[FIRST_BINDING as usize + at]);
        Ok(match policy.finding(&kept, counters) {
            Finding::Right => self.streamed(&frame, &policy, counters)?.map_or(End::Right, End::Wrong),
            Finding::Stated(text) => End::Stated(text),
            Finding::Wrong(text) => End::Wrong(text),
        })
    }

    /// What is wrong with what has left a pixel, where the storage hands fragments on.
    fn streamed(&mut self, frame: &Frame<'s>, policy: &Policy, counters: &[u32]) -> Result<Option<String>, String> {
        let trial = self.trial;
        let (Some(programs), Some(most)) = (&trial.subject.stream, policy.promise.streams()) else {
            return Ok(None);
        };
        let count = |wanted: &str| {
            let mut known = COUNTERS.iter().zip(counters);
            known.find(|((name, _, _), _)| *name == wanted).map_or(0, |(_, count)| *count)
        };
        let mut memory = frame.memory.clone();
        let gone = count("spin_exhausted") as usize;
        if let Entry::Vacant(place) = self.left.entry(gone) {
            let stream = Stream { programs, promise: &policy.promise, most };
            let fragments = policy.fragments.split_at(trial.case.prior.len());
            place.insert(stream.left(fragments, gone, &mut memory)?);
        }
        let mut machine = Machine::new(&programs.streamed);
        machine.set_input(0, &[trial.case.pixel]);
        if run_alone(&mut machine, &mut memory)? != Exit::Ended {
            return Err("the colour of what has left cannot be read".to_owned());
        }
        let (late, color) = (count("out_of_order"), machine.result());
        let is_right = |left: &Left| left.late == late && left.color.as_ref().is_none_or(|known| known == color);
        let is_known = self.left.get(&gone).is_some_and(|known| known.iter().any(is_right));
        Ok((!is_known).then(|| {
            format!(
                "in no order of the fragments {late} come out of order and {color:08x?} is the colour that they leave"
            )
        }))
    }
}

impl Judge for EndJudge<'_, '_> {
    fn instant(&mut self, words: &[u32]) -> Option<String> {
        let bound = self.frame.subject.bound.as_ref().filter(|_| !self.is_racy)?;
        for (memory, first, count) in &self.homes {
            self.frame.memory[*memory].copy_from_slice(&words[*first..first + count]);
        }
        let mut machine = Machine::new(bound);
        machine.set_input(0, &[self.trial.case.pixel]);
        match run_alone(&mut machine, &mut self.frame.memory) {
            Ok(Exit::Ended) => {}
            _ => return Some("the bound cannot be read".to_owned()),
        }
        let (found, least) = (machine.result()[0], self.trial.policy_in(&self.frame).least_bound());
        (found < least).then(|| {
            format!("storage_bound is {found:08x}, and the key {least:08x} of a fragment that must stay exceeds it")
        })
    }

    fn end(&mut self, words: &[u32]) -> End {
        if let Some(known) = self.known.get(words) {
            return known.clone();
        }
        let end = self.judged(words).unwrap_or_else(End::Wrong);
        self.known.insert(words.to_vec(), end.clone());
        end
    }
}
