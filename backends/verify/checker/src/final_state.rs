//! Checks the final states of a case against its specification.
//!
//! Input: the words of a state. Output: a verdict. The remaining steps of the frame run first. Then the pixel is read out
//! through the storage's own functions.

use std::collections::{HashMap, HashSet};
use std::ops::Range;

use fragbuf_codegen::FIRST_BINDING;
use fragbuf_frame::COUNTERS_RESOURCE;
use fragbuf_interpreter::Exit;
use fragbuf_model::counted;
use fragbuf_templates::COUNTERS;

use crate::case_setup::CaseSetup;
use crate::context::SearchContext;
use crate::frame::Frame;
use crate::memory::{WIDTH, memory_index};
use crate::search::{Property, StateVerdict};
use crate::sequential::{machine_with, run_alone};
use crate::specification::Specification;
use crate::stream::{Emitted, Stream};

/// Index in memory, first word in a state and number of words of a buffer that states hold.
type StateBuffer = (usize, usize, usize);

/// The property that final states meet the specification, and that the bound of an early cull is never too low.
pub(crate) struct FinalStateProperty<'c, 's> {
    setup: &'c CaseSetup<'s>,
    frame: Frame<'s>,
    buffers: Vec<StateBuffer>,
    /// The least bound of an early cull that rejects no fragment that must be kept. `None`: no bound is checked.
    least_bound: Option<u32>,
    /// The words that the bound reads.
    watched: Vec<Range<usize>>,
    /// The contents of these words whose bound is not too low.
    bounded: HashSet<Vec<u32>>,
    /// The present content.
    content: Vec<u32>,
    known: HashMap<Vec<u32>, StateVerdict>,
    /// What the pixel may have emitted, by the number of fragments that timed out. `None`: not computed yet.
    emitted: Option<Vec<Vec<Emitted>>>,
    /// The frame before the next iteration of the pass, by the words of the final state.
    pub(crate) next_iterations: HashMap<Vec<u32>, Frame<'s>>,
}

impl<'c, 's> FinalStateProperty<'c, 's> {
    /// Returns the property for one iteration of a case. `frame`: the frame before the pass under test.
    pub(crate) fn new(setup: &'c CaseSetup<'s>, context: &SearchContext<'_>, frame: Frame<'s>) -> Self {
        let has_bound = setup.subject.bound.is_some() && !setup.subject.is_racy();
        let buffers: Vec<_> = context.state_buffers().collect();
        FinalStateProperty {
            setup,
            watched: if has_bound { watched(setup, &buffers).collect() } else { Vec::new() },
            least_bound: has_bound.then(|| setup.specification_in(&frame).least_bound()),
            frame,
            buffers,
            bounded: HashSet::new(),
            content: Vec::new(),
            known: HashMap::new(),
            emitted: None,
            next_iterations: HashMap::new(),
        }
    }

    /// Runs the remaining steps of the frame from these words, reads both pixels and returns the verdict.
    fn verdict(&mut self, words: &[u32]) -> Result<StateVerdict, String> {
        let setup = self.setup;
        let mut frame = self.frame.clone();
        for (index, first, count) in &self.buffers {
            frame.memory[*index].copy_from_slice(&words[*first..first + count]);
        }
        // Where a loop waits for samples, the number of samples that passed follows the words in memory.
        let in_memory: usize = self.buffers.iter().map(|(_, _, count)| count).sum();
        frame.skip_pass(words.get(in_memory).copied().unwrap_or(0))?;
        if frame.advance(setup.runnable(), &|runnable| setup.inputs(runnable, setup.real_fragments()))? {
            self.next_iterations.insert(words.to_vec(), frame);
            return Ok(StateVerdict::NextIteration);
        }
        let specification = setup.specification_at_end(&frame);
        if let (Some(requested), Some(stored)) = (frame.requested, setup.stored_in(&frame))
            && requested != stored
        {
            let text =
                format!("the host step allocates {}, and {stored} would be needed", counted(requested, "fragment"));
            return Ok(StateVerdict::Wrong(text));
        }
        let kept = frame.read_out(setup.case.pixel)?;
        let neighbours = frame.read_out(WIDTH - 1 - setup.case.pixel)?;
        let is_lost = setup.specification.neighbours_lost > 0;
        if neighbours != if is_lost { Vec::new() } else { vec![setup.neighbour.words.clone()] } {
            return Ok(StateVerdict::Wrong("other fragments are read from the neighbouring pixel: an access reached its words, or the functions that read a pixel are wrong"
                    .to_owned()));
        }
        let plan = &frame.subject.plan;
        let counters = plan.resources.iter().position(|planned| planned.resource.name == COUNTERS_RESOURCE);
        let counters = counters.map_or(&[][..], |at| &frame.memory[FIRST_BINDING as usize + at]);
        match specification.verdict(&kept, counters) {
            StateVerdict::Correct => {
                let wrong = self.emission_violation(&frame, &specification, counters)?;
                Ok(wrong.map_or(StateVerdict::Correct, StateVerdict::Wrong))
            }
            verdict => Ok(verdict),
        }
    }

    /// Describes what is wrong with the fragments that a pixel has emitted, where the storage emits a stream.
    fn emission_violation(
        &mut self,
        frame: &Frame<'s>,
        specification: &Specification,
        counters: &[u32],
    ) -> Result<Option<String>, String> {
        let setup = self.setup;
        let kept_set = &specification.kept_set;
        let (Some(programs), Some(most)) = (&setup.subject.stream, kept_set.stream_length()) else {
            return Ok(None);
        };
        let count = |name: &str| {
            let mut known = COUNTERS.iter().zip(counters);
            known.find(|((known, ..), _)| *known == name).map_or(0, |(_, count)| *count)
        };
        let mut memory = frame.memory.clone();
        let dropped = count("timed_out") as usize;
        if self.emitted.is_none() {
            let stream = Stream { programs, kept_set, most };
            let fragments = specification.fragments.split_at(setup.case.prior.len());
            self.emitted = Some(stream.emitted(fragments, &mut memory)?);
        }
        let mut machine = machine_with(&programs.streamed, &[vec![setup.case.pixel]]);
        if run_alone(&mut machine, &mut memory)? != Exit::Ended {
            return Err("the emitted colour cannot be read".to_owned());
        }
        let (out_of_order, color) = (count("out_of_order"), machine.result());
        let matches = |emitted: &Emitted| {
            emitted.out_of_order == out_of_order && emitted.color.as_ref().is_none_or(|known| known == color)
        };
        let is_possible =
            self.emitted.as_ref().and_then(|all| all.get(dropped)).is_some_and(|known| known.iter().any(matches));
        Ok((!is_possible).then(|| {
            let fragments = counted(out_of_order, "fragment");
            format!("no arrival order gives {fragments} out of order and the emitted colour {color:08x?}")
        }))
    }
}

/// Returns the words of the buffers that the bound reads.
fn watched<'a>(setup: &'a CaseSetup<'_>, buffers: &'a [StateBuffer]) -> impl Iterator<Item = Range<usize>> + 'a {
    let bound = setup.subject.bound.iter().flat_map(|bound| &bound.buffers);
    let read: HashSet<usize> = bound.map(|buffer| memory_index(buffer.binding)).collect();
    let buffers = buffers.iter().filter(move |(index, ..)| read.contains(index));
    buffers.map(|(_, first, count)| *first..first + count)
}

impl Property for FinalStateProperty<'_, '_> {
    fn watched(&self) -> Vec<Range<usize>> {
        self.watched.clone()
    }

    fn instant(&mut self, words: &[u32]) -> Option<String> {
        let (bound, least) = self.frame.subject.bound.as_ref().zip(self.least_bound)?;
        // The bound depends on nothing else that a fragment writes.
        self.content.clear();
        self.watched.iter().for_each(|range| self.content.extend_from_slice(&words[range.clone()]));
        if self.bounded.contains(&self.content) {
            return None;
        }
        for (index, first, count) in &self.buffers {
            self.frame.memory[*index].copy_from_slice(&words[*first..first + count]);
        }
        let mut machine = machine_with(bound, &[vec![self.setup.case.pixel]]);
        match run_alone(&mut machine, &mut self.frame.memory) {
            Ok(Exit::Ended) => {}
            _ => return Some("the bound cannot be read".to_owned()),
        }
        let found = machine.result()[0];
        if found < least {
            let text = "but a fragment that must be kept has the greater key";
            return Some(format!("storage_bound is {found:08x}, {text} {least:08x}"));
        }
        self.bounded.insert(self.content.clone());
        None
    }

    fn final_state(&mut self, words: &[u32]) -> StateVerdict {
        if let Some(known) = self.known.get(words) {
            return known.clone();
        }
        let verdict = self.verdict(words).unwrap_or_else(StateVerdict::Wrong);
        self.known.insert(words.to_vec(), verdict.clone());
        verdict
    }
}
