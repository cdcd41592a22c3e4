//! One case, tried: memory is brought to the prior state, the fragments are set off, ends are judged.
//!
//! In: a subject and a case. Out: what the search found. The judge reads a pixel out through the storage's own functions
//! after the remaining steps of the frame have been done.

use std::collections::HashMap;

use fragbuf_codegen::FIRST_BINDING;
use fragbuf_interpreter::{Exit, Machine, Program};

use crate::case::Case;
use crate::explore::{Failure, Found, Judge, What, explore};
use crate::fragments::{Fragment, at_pixel, deciding_words};
use crate::frame::{Frame, Memory, run_alone};
use crate::model::Model;
use crate::policy::Policy;
use crate::state::{Ground, Home, Mishap, State};
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
}

/// A case that is set up.
pub(crate) struct Trial<'s> {
    pub(crate) subject: &'s Subject,
    pub(crate) case: Case,
    pub(crate) ground: Ground<'s>,
    pub(crate) first: Result<State, Mishap>,
    judge: EndJudge<'s>,
}

impl<'s> Trial<'s> {
    /// Does everything that comes before the fragments under test.
    pub(crate) fn new(subject: &'s Subject, case: Case, neighbour: &Fragment, search: &Search) -> Result<Self, String> {
        let mut frame = Frame::new(subject, case.symbols.clone());
        frame.reserved = case.reserved;
        let runnable = &subject.passes[case.pass];
        if let Some(text) = search.model.refusal(&runnable.program) {
            return Err(text);
        }
        let others = |runnable: &Runnable, with_new: usize| {
            let beside = at_pixel(neighbour, &runnable.program, 1);
            let all = std::iter::once(&beside).chain(&case.prior).chain(case.new.iter().take(with_new));
            all.map(|fragment| fragment.inputs.clone()).collect::<Vec<_>>()
        };
        let seen = case.new.len() - usize::from(case.has_unseen || case.has_helper);
        frame.advance(0, runnable.step, &|runnable| others(runnable, seen))?;
        frame.enter(runnable.round);
        for inputs in others(runnable, 0) {
            frame.insert(runnable, &inputs)?;
        }
        let (mut ground, words) = ground(subject, &runnable.program, &frame.memory, search.model);
        ground.helper = case.has_helper.then(|| case.new.len() - 1);
        let real = &case.new[..case.new.len() - usize::from(case.has_helper)];
        let machines = case.new.iter().map(|fragment| machine(&runnable.program, &fragment.inputs)).collect();
        let first = ground.start(words, machines);
        let fragments = case.prior.iter().chain(real).map(|fragment| fragment.words.clone()).collect();
        let k = case.symbols.k.unwrap_or(u32::MAX) as usize;
        let policy = Policy {
            k: (!subject.keeps_all()).then_some(k),
            deciding: deciding_words(subject),
            too_many: case.too_many + u32::from(case.has_unseen),
            may_give_up: search.may_give_up,
            culls: subject.turns_away(),
            handed: subject.is_handed_the_best().then_some(k),
            fragments,
            neighbours: 1,
            neighbours_lost: u32::from(case.reserved.is_some()),
        };
        let judge = EndJudge {
            frame,
            step: runnable.step + 1,
            homes: homes_by_memory(&runnable.program, &ground),
            rest: real.to_vec(),
            prior: case.prior.clone(),
            neighbour: neighbour.clone(),
            beside: case.reserved.map_or(vec![neighbour.words.clone()], |_| Vec::new()),
            policy,
            is_racy: subject.is_racy(),
            known: HashMap::new(),
        };
        Ok(Trial { subject, case, ground, first, judge })
    }

    /// Searches.
    pub(crate) fn run(&mut self, search: &Search) -> Found {
        match &self.first {
            Err(mishap) => {
                let what = What::Mishap(0, *mishap);
                let failure = Some(Failure { steps: Vec::new(), what });
                Found { states: 1, is_whole: true, failure }
            }
            Ok(first) => match search.seeds {
                Some(seeds) => walk(&self.ground, first, &mut self.judge, seeds),
                None => explore(&self.ground, first.clone(), &mut self.judge, search.limit),
            },
        }
    }

    /// The words that the steps of a failure leave.
    pub(crate) fn end_of(&self, failure: &Failure) -> Vec<u32> {
        let Ok(first) = &self.first else { return Vec::new() };
        let mut machine = Machine::new(self.ground.program);
        let mut state = first.clone();
        for (fragment, choice) in &failure.steps {
            match self.ground.step(&mut machine, &state, *fragment, *choice) {
                Ok((next, _)) => state = next,
                Err(_) => break,
            }
        }
        state.words
    }

    /// Whether a failed end state is one that the rows state.
    pub(crate) fn is_within_hazards(&mut self, words: &[u32]) -> bool {
        let Ok((kept, _, counters)) = self.judge.read(words) else { return false };
        // Only races may lose a fragment uncounted.
        let counted = self.judge.is_racy || self.judge.policy.fault_of_any(&kept, &counters).is_none();
        counted && self.judge.policy.is_within_hazards(&kept)
    }
}

fn machine<'p>(program: &'p Program, inputs: &[Vec<u32>]) -> Machine<'p> {
    let mut machine = Machine::new(program);
    inputs.iter().enumerate().for_each(|(number, words)| machine.set_input(number, words));
    machine
}

/// What the states of a trial share, and the words of the first.
fn ground<'s>(subject: &Subject, program: &'s Program, memory: &Memory, model: Model) -> (Ground<'s>, Vec<u32>) {
    let (homes, words, ordered) = Ground::lay_out(program, memory);
    let has_fences = subject.has_fences && model == Model::Late;
    (Ground { program, homes, fixed: memory.clone(), ordered, model, has_fences, helper: None }, words)
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

struct EndJudge<'s> {
    frame: Frame<'s>,
    step: usize,
    homes: Vec<(usize, usize, usize)>,
    rest: Vec<Fragment>,
    prior: Vec<Fragment>,
    neighbour: Fragment,
    /// What the neighbouring pixel must hold.
    beside: Vec<Vec<u32>>,
    policy: Policy,
    is_racy: bool,
    known: HashMap<Vec<u32>, Option<String>>,
}

/// What two pixels hold, and the counters.
type ReadOut = (Vec<Vec<u32>>, Vec<Vec<u32>>, Vec<u32>);

impl EndJudge<'_> {
    /// Finishes the frame from these words and reads both pixels.
    fn read(&mut self, words: &[u32]) -> Result<ReadOut, String> {
        let mut frame = self.frame.clone();
        for (memory, first, count) in &self.homes {
            frame.memory[*memory].copy_from_slice(&words[*first..first + count]);
        }
        let end = frame.subject.steps.len();
        frame.advance(self.step, end, &|runnable| {
            let beside = at_pixel(&self.neighbour, &runnable.program, 1);
            let all = std::iter::once(&beside).chain(&self.prior).chain(&self.rest);
            all.map(|fragment| fragment.inputs.clone()).collect()
        })?;
        let kept = frame.read_out(0)?;
        let beside = frame.read_out(1)?;
        let plan = &frame.subject.plan;
        let counters = plan.resources.iter().position(|planned| planned.resource.name == "counters");
        let counters = counters.map(|at| frame.memory[FIRST_BINDING as usize + at].clone());
        Ok((kept, beside, counters.unwrap_or_default()))
    }

    fn fault(&mut self, words: &[u32]) -> Option<String> {
        match self.read(words) {
            Err(text) => Some(text),
            Ok((_, beside, _)) if beside != self.beside => Some("the neighbouring pixel has changed".to_owned()),
            Ok((kept, _, counters)) if !self.frame.subject.is_known() => self.policy.fault_of_any(&kept, &counters),
            Ok((kept, _, counters)) => self.policy.fault(&kept, &counters),
        }
    }
}

impl Judge for EndJudge<'_> {
    fn instant(&mut self, words: &[u32]) -> Option<String> {
        let bound = self.frame.subject.bound.as_ref().filter(|_| !self.is_racy)?;
        for (memory, first, count) in &self.homes {
            self.frame.memory[*memory].copy_from_slice(&words[*first..first + count]);
        }
        let mut machine = Machine::new(bound);
        machine.set_input(0, &[0]);
        match run_alone(&mut machine, &mut self.frame.memory) {
            Ok(Exit::Ended) => {}
            _ => return Some("the bound cannot be read".to_owned()),
        }
        let (found, least) = (machine.result()[0], self.policy.least_bound());
        (found < least).then(|| {
            format!("storage_bound is {found:08x}, and the key {least:08x} of a fragment that must stay exceeds it")
        })
    }

    fn end(&mut self, words: &[u32]) -> Option<String> {
        if let Some(known) = self.known.get(words) {
            return known.clone();
        }
        let fault = self.fault(words);
        self.known.insert(words.to_vec(), fault.clone());
        fault
    }
}
