//! A frame of two pixels: its memory, and everything that comes before and after the fragments under test.
//!
//! In: a subject and how much room there is. Out: memory, step by step, and what a pixel holds. Nothing here runs at once
//! with anything else.

use fragbuf_codegen::FIRST_BINDING;
use fragbuf_frame::{Decision, Symbols, resource};
use fragbuf_interpreter::{Dispatch, Exit, Machine, Program, Sequential, Space, dispatch};
use fragbuf_templates::vocabulary::{Host, Kind, Step};

use crate::subject::{Runnable, Subject};
use crate::texels::{Alone, textures};
use crate::turns::Turn;

/// One row of words per binding; what is not a buffer is empty.
pub(crate) type Memory = Vec<Vec<u32>>;

/// Pixels of the frame, which is one row: the one under test, and a neighbour that must stay as it is.
pub(crate) const WIDTH: u32 = 2;

/// What memory holds before anybody has written to it: neither zero nor a sentinel, a better key than any, and, as key and as
/// what stands beside it, an entry whose checksum is right.
pub(crate) const STALE: u32 = 20;

/// Depth of a pixel where nothing is opaque.
const NOTHING_OPAQUE: u32 = 1f32.to_bits();

/// A frame on its way.
#[derive(Clone, Debug)]
pub(crate) struct Frame<'s> {
    pub(crate) subject: &'s Subject,
    pub(crate) memory: Memory,
    pub(crate) symbols: Symbols,
    /// The most that host steps allocate.
    pub(crate) reserved: Option<u32>,
    /// What host steps would allocate.
    pub(crate) asked: Option<u64>,
    /// The round of the loop that ends when a word is zero.
    round: u32,
}

/// How the fragments of a pass are given: one row of words per input.
pub(crate) type Fragments<'a> = dyn Fn(&Runnable) -> Vec<Vec<Vec<u32>>> + 'a;

impl<'s> Frame<'s> {
    /// Memory before the first step. What no symbol sizes yet is empty.
    pub(crate) fn new(subject: &'s Subject, symbols: Symbols) -> Result<Self, String> {
        let count = FIRST_BINDING as usize + subject.plan.resources.len();
        let memory = vec![Vec::new(); count];
        let mut frame = Frame { subject, memory, symbols, reserved: None, asked: None, round: 0 };
        frame.memory[1] = vec![subject.uniform.to_bits(); 256];
        frame.memory[2] = vec![0; 16];
        frame.allocate()?;
        Ok(frame)
    }

    /// Gives room to whatever can be sized by now, and tells the programs.
    fn allocate(&mut self) -> Result<(), String> {
        let plan = &self.subject.plan;
        for (planned, words) in plan.resources.iter().zip(&mut self.memory[FIRST_BINDING as usize..]) {
            let size = self.symbols.evaluate(plan, &planned.words, &planned.resource.name);
            // What the caller brings is filled: nothing is nearer than the far plane.
            let value = if planned.is_brought() { NOTHING_OPAQUE } else { STALE };
            words.resize((size.map_err(|error| error.to_string())? as usize).max(1), value);
        }
        self.enter(0)
    }

    /// Puts something opaque of this depth into a pixel, in all that the caller brings.
    pub(crate) fn set_opaque(&mut self, pixel: u32, depth: f32) {
        let resources = &self.subject.plan.resources;
        for (planned, words) in resources.iter().zip(&mut self.memory[FIRST_BINDING as usize..]) {
            if let Some(word) = words.get_mut(pixel as usize).filter(|_| planned.is_brought()) {
                *word = depth.to_bits();
            }
        }
    }

    /// Does turns, beginning with that of the number `from`, up to the turn `to`; whether it came to that, or to the end.
    /// Geometry passes insert `fragments`.
    pub(crate) fn advance(&mut self, from: usize, to: usize, fragments: &Fragments<'_>) -> Result<bool, String> {
        let subject = self.subject;
        let mut number = from;
        while let Some(turn) = subject.turns.get(number) {
            if number == to {
                return Ok(true);
            }
            match turn {
                Turn::Step { step, round } => {
                    self.enter(*round)?;
                    self.step(step, number, fragments)?;
                    number += 1;
                }
                Turn::Again { from, word, at_most } => {
                    let is_over = self.memory[FIRST_BINDING as usize + word].first().is_none_or(|word| *word == 0);
                    let rounds = self.symbols.evaluate(&subject.plan, at_most, "the rounds of a loop");
                    let rounds = rounds.map_err(|error| error.to_string())?;
                    let goes_on = !is_over && u64::from(self.round) + 1 < rounds;
                    self.round = if goes_on { self.round + 1 } else { 0 };
                    number = if goes_on { *from } else { number + 1 };
                }
            }
        }
        Ok(false)
    }

    fn step(&mut self, step: &Step, number: usize, fragments: &Fragments<'_>) -> Result<(), String> {
        match step {
            Step::Clear { resource, value } => self.resource(resource)?.fill(*value),
            Step::Pass(_) => {
                if let Some(runnable) = self.subject.passes.iter().find(|other| other.turn == number) {
                    self.pass(runnable, fragments)?;
                }
            }
            Step::Host(host) => self.decide(host)?,
            Step::Copy { .. } | Step::Swap(..) | Step::Repeat(_) => {
                return Err("the checker does not run copies and exchanges yet".to_owned());
            }
        }
        Ok(())
    }

    /// Tells the programs the round of the loop that they are in.
    pub(crate) fn enter(&mut self, round: u32) -> Result<(), String> {
        let words = self.symbols.frame_words(&self.subject.plan, 0, self.round + round);
        self.memory[0] = words.map_err(|error| error.to_string())?;
        Ok(())
    }

    fn resource(&mut self, name: &str) -> Result<&mut Vec<u32>, String> {
        let index = resource(&self.subject.plan, name).map_err(|error| error.to_string())?;
        Ok(&mut self.memory[FIRST_BINDING as usize + index])
    }

    /// The host reads, decides, and makes room, but no more than is reserved.
    fn decide(&mut self, host: &Host) -> Result<(), String> {
        let plan = &self.subject.plan;
        let decision = Decision::of(host, plan).map_err(|error| error.to_string())?;
        let mut read = Vec::new();
        for (resource, place) in &decision.reads {
            let at = self.symbols.evaluate(plan, place, &host.function).map_err(|error| error.to_string())?;
            let word = self.memory[FIRST_BINDING as usize + resource].get(at as usize);
            read.push(*word.ok_or_else(|| format!("word {at}, which the host reads, is not there"))?);
        }
        decision.apply(&read, &mut self.symbols);
        self.asked = self.symbols.counted.iter().filter_map(|(_, room)| *room).max();
        if let Some(most) = self.reserved.map(u64::from) {
            self.symbols.counted.iter_mut().for_each(|(_, room)| *room = room.map(|room| room.min(most)));
        }
        self.allocate()
    }

    fn pass(&mut self, runnable: &Runnable, fragments: &Fragments<'_>) -> Result<(), String> {
        match &runnable.pass.kind {
            Kind::Compute { groups } => {
                let mut counts = [1; 3];
                for (count, formula) in counts.iter_mut().zip(groups) {
                    let groups = self.symbols.evaluate(&self.subject.plan, formula, &runnable.pass.anchor);
                    *count = groups.map_err(|error| error.to_string())? as u32;
                }
                let end = with_buffers(&runnable.program, &mut self.memory, |buffers| {
                    dispatch(&runnable.program, counts, buffers)
                });
                if end != Dispatch::Ended {
                    return Err(format!("pass `{}` does not run through: {end:?}", runnable.pass.anchor));
                }
            }
            Kind::Geometry => {
                for inputs in fragments(runnable) {
                    self.insert(runnable, &inputs)?;
                }
            }
            Kind::Fullscreen => {}
        }
        Ok(())
    }

    /// Runs one fragment by itself.
    pub(crate) fn insert(&mut self, runnable: &Runnable, inputs: &[Vec<u32>]) -> Result<(), String> {
        let mut machine = Machine::new(&runnable.program);
        inputs.iter().enumerate().for_each(|(number, words)| machine.set_input(number, words));
        match run_alone(&mut machine, &mut self.memory)? {
            Exit::Ended | Exit::Discarded => Ok(()),
            other => Err(format!("a fragment of pass `{}` does not end: {other:?}", runnable.pass.anchor)),
        }
    }

    /// What a pixel holds, in the storage's own order. `Err`: its list has no end, or reads out of bounds.
    pub(crate) fn read_out(&mut self, pixel: u32) -> Result<Vec<Vec<u32>>, String> {
        let read_out = &self.subject.read_out;
        read_out.entries(&mut self.memory, [WIDTH, 1], pixel).map_err(|error| error.to_string())
    }
}

/// Runs a machine to its end, with memory to itself.
pub(crate) fn run_alone(machine: &mut Machine<'_>, memory: &mut Memory) -> Result<Exit, String> {
    let textures = textures(machine.program(), memory);
    let exit = with_buffers(machine.program(), memory, |buffers| {
        machine.run(&mut Alone { buffers: Sequential { buffers }, textures })
    });
    match machine.fault.take() {
        Some(_) => Err("an index is out of bounds".to_owned()),
        None => Ok(exit),
    }
}

/// Lends a program its buffers, in its own order.
pub(crate) fn with_buffers<T>(program: &Program, memory: &mut Memory, work: impl FnOnce(&mut [Vec<u32>]) -> T) -> T {
    let home = |binding| Subject::memory_of(binding);
    let mut buffers: Vec<Vec<u32>> = program
        .buffers
        .iter()
        .map(|buffer| match buffer.space {
            Space::Workgroup => vec![0; buffer.words as usize],
            _ => memory.get_mut(home(buffer.binding)).map(std::mem::take).unwrap_or_default(),
        })
        .collect();
    let result = work(&mut buffers);
    for (buffer, words) in program.buffers.iter().zip(buffers) {
        if let Some(home) = memory.get_mut(home(buffer.binding)).filter(|_| buffer.space != Space::Workgroup) {
            *home = words;
        }
    }
    result
}
