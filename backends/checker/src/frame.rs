//! A frame of two pixels: its memory, and everything that comes before and after the fragments under test.
//!
//! In: a subject and how much room there is. Out: memory, step by step, and what a pixel holds. Nothing here runs at once
//! with anything else.

use fragbuf_codegen::FIRST_BINDING;
use fragbuf_interpreter::{Dispatch, Exit, Machine, Program, Sequential, Space, dispatch};
use fragbuf_templates::vocabulary::{Kind, Step};

use crate::subject::{Runnable, Subject};

/// One row of words per binding; what is not a buffer is empty.
pub(crate) type Memory = Vec<Vec<u32>>;

/// Pixels of the frame: the one under test, and a neighbour that must stay as it is.
pub(crate) const WIDTH: u32 = 2;

/// Fragments that a walk over a pixel reads before it is said to have no end.
const LONGEST: usize = 256;

/// What memory holds before anybody has written to it: neither zero nor a sentinel, and a better key than any.
const STALE: u32 = 17;

/// Values of symbols.
#[derive(Clone, Debug)]
pub(crate) struct Symbols {
    pub(crate) k: Option<u32>,
    pub(crate) fragments: Option<u32>,
    pub(crate) kept: Option<u32>,
}

/// The value of a symbol, where it has one by now.
pub(crate) fn value(subject: &Subject, symbols: &Symbols, symbol: &str) -> Option<u64> {
    match symbol {
        "width" => Some(WIDTH.into()),
        "height" => Some(1),
        "pixels" => subject.plan.pixels().evaluate(&|symbol| value(subject, symbols, symbol)).ok(),
        "k" => symbols.k.map(u64::from),
        "fragments" => symbols.fragments.map(u64::from),
        "kept" => symbols.kept.map(u64::from),
        // Slots of each pixel: the one under test gets all the room but the neighbour's.
        "n" => symbols.fragments.map(|fragments| u64::from(fragments.saturating_sub(WIDTH - 1))),
        _ => subject.plan.bound.value(symbol),
    }
}

/// A frame on its way.
#[derive(Clone, Debug)]
pub(crate) struct Frame<'s> {
    pub(crate) subject: &'s Subject,
    pub(crate) memory: Memory,
    pub(crate) symbols: Symbols,
    /// The most that host steps allocate.
    pub(crate) reserved: Option<u32>,
}

impl<'s> Frame<'s> {
    /// Memory before the first step. What no symbol sizes yet is empty.
    pub(crate) fn new(subject: &'s Subject, symbols: Symbols) -> Self {
        let count = FIRST_BINDING as usize + subject.plan.resources.len();
        let mut frame = Frame { subject, memory: vec![Vec::new(); count], symbols, reserved: None };
        // Every component of every uniform is 1: constraints by a bound admit something.
        frame.memory[1] = vec![1f32.to_bits(); 256];
        frame.memory[2] = vec![0; 16];
        frame.allocate();
        frame
    }

    /// Gives room to whatever can be sized by now, and tells the programs.
    fn allocate(&mut self) {
        let (subject, symbols) = (self.subject, self.symbols.clone());
        for (planned, words) in subject.plan.resources.iter().zip(&mut self.memory[FIRST_BINDING as usize..]) {
            if let Ok(size) = planned.words.evaluate(&|symbol| value(subject, &symbols, symbol)) {
                words.resize((size as usize).max(1), STALE);
            }
        }
        let fields = subject.plan.frame.iter();
        self.memory[0] = fields.map(|field| value(subject, &symbols, field).unwrap_or(0) as u32).collect();
    }

    /// Does the steps from `from` up to that of the number `to`. Geometry passes insert `fragments`.
    pub(crate) fn advance(
        &mut self,
        from: usize,
        to: usize,
        fragments: &dyn Fn(&Runnable) -> Vec<Vec<Vec<u32>>>,
    ) -> Result<(), String> {
        let subject = self.subject;
        for (number, (step, round)) in subject.steps.iter().enumerate().take(to).skip(from) {
            self.enter(*round);
            match step {
                Step::Clear { resource, value } => self.resource(resource)?.fill(*value),
                Step::Pass(_) => {
                    if let Some(runnable) = subject.passes.iter().find(|other| other.step == number) {
                        self.pass(runnable, fragments)?;
                    }
                }
                Step::Host(host) => {
                    for (read, set) in host.reads.iter().zip(&host.sets) {
                        let decided = self.host_value(read)?;
                        let room = self.reserved.map_or(decided, |room| room.min(decided));
                        match set.as_str() {
                            "fragments" => self.symbols.fragments = Some(room),
                            "kept" => self.symbols.kept = Some(room),
                            other => return Err(format!("the checker does not know what sets `{other}`")),
                        }
                    }
                    self.allocate();
                }
                Step::Copy { .. } | Step::Swap(..) | Step::Repeat(_) => {
                    return Err("the checker does not run copies, exchanges or loops of unknown length yet".to_owned());
                }
            }
        }
        Ok(())
    }

    /// Tells the programs the round of the loop that they are in.
    pub(crate) fn enter(&mut self, round: u32) {
        let fields = self.subject.plan.frame.iter();
        for (field, word) in fields.zip(&mut self.memory[0]) {
            if field == "iteration" {
                *word = round;
            }
        }
    }

    fn resource(&mut self, name: &str) -> Result<&mut Vec<u32>, String> {
        let found = self.subject.plan.resources.iter().position(|planned| planned.resource.name == name);
        let index = found.ok_or_else(|| format!("no resource `{name}`"))?;
        Ok(&mut self.memory[FIRST_BINDING as usize + index])
    }

    /// `offsets[pixels]`
    fn host_value(&mut self, read: &str) -> Result<u32, String> {
        let (name, place) = read.split_once('[').unwrap_or((read, "0]"));
        let place = fragbuf_templates::vocabulary::Formula::from(place.trim_end_matches(']').to_owned());
        let (subject, symbols) = (self.subject, self.symbols.clone());
        let at = place.evaluate(&|symbol| value(subject, &symbols, symbol)).map_err(|error| error.to_string())?;
        let words = self.resource(name)?;
        words.get(at as usize).copied().ok_or_else(|| format!("`{read}` is not there"))
    }

    fn pass(&mut self, runnable: &Runnable, fragments: &dyn Fn(&Runnable) -> Vec<Vec<Vec<u32>>>) -> Result<(), String> {
        let (subject, symbols) = (self.subject, self.symbols.clone());
        match &runnable.pass.kind {
            Kind::Compute { groups } => {
                let mut counts = [1; 3];
                for (count, formula) in counts.iter_mut().zip(groups) {
                    let groups = formula.evaluate(&|symbol| value(subject, &symbols, symbol));
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
        let subject = self.subject;
        let mut entries = Vec::new();
        loop {
            // A walk may count what it passes over: only that of the last, which goes through to the end, is kept.
            let before = self.memory.clone();
            let cursor = self.ask(&subject.walk, &[pixel, entries.len() as u32])?[0];
            if cursor == u32::MAX {
                return Ok(entries);
            }
            if entries.len() == LONGEST {
                return Err("reading the pixel out never ends".to_owned());
            }
            self.memory = before;
            entries.push(self.ask(&subject.read, &[pixel, cursor])?);
        }
    }

    fn ask(&mut self, program: &Program, arguments: &[u32]) -> Result<Vec<u32>, String> {
        let mut machine = Machine::new(program);
        for (number, word) in arguments.iter().enumerate() {
            machine.set_input(number, &[*word]);
        }
        match run_alone(&mut machine, &mut self.memory)? {
            Exit::Ended => Ok(machine.result().to_vec()),
            _ => Err("reading the pixel out never ends".to_owned()),
        }
    }
}

/// Runs a machine to its end, with memory to itself.
pub(crate) fn run_alone(machine: &mut Machine<'_>, memory: &mut Memory) -> Result<Exit, String> {
    let exit = with_buffers(machine.program(), memory, |buffers| machine.run(&mut Sequential { buffers }));
    match machine.fault.take() {
        Some(_) => Err("an index is out of bounds".to_owned()),
        None => Ok(exit),
    }
}

/// Lends a program its buffers, in its own order.
fn with_buffers<T>(program: &Program, memory: &mut Memory, work: impl FnOnce(&mut [Vec<u32>]) -> T) -> T {
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
