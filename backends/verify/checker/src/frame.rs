//! A frame of two pixels: its memory, and everything that comes before and after the fragments under test.
//!
//! In: a subject and how much room there is. Out: memory, step by step, and what a pixel holds. Nothing here runs at once
//! with anything else.

use fragbuf_codegen::{FIRST_BINDING, PassId, ResourceId, SymbolId};
use fragbuf_frame::{Counting, Cursor, Question, Run, Span, Turn, Values, bytes};
use fragbuf_interpreter::{Dispatch, Exit, Machine, Program, Sequential, Space, dispatch};
use fragbuf_templates::vocabulary::Kind;

use crate::subject::{Runnable, Subject};
use crate::texels::{Alone, textures};

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
    pub(crate) values: Values,
    /// The most that host steps allocate.
    pub(crate) reserved: Option<u32>,
    /// What host steps would allocate.
    pub(crate) asked: Option<u64>,
    cursor: Cursor,
    /// The exchanges of the frame whose resources have changed places in memory.
    flipped: u32,
    /// Samples that passed in the last run of each pass.
    samples: Vec<u32>,
}

/// How the fragments of a pass are given: one row of words per input.
pub(crate) type Fragments<'a> = dyn Fn(&Runnable) -> Vec<Vec<Vec<u32>>> + 'a;

impl<'s> Frame<'s> {
    /// Memory before the first step. What no symbol sizes yet is empty.
    pub(crate) fn new(subject: &'s Subject, values: Values) -> Result<Self, String> {
        let plan = &subject.plan;
        let memory = vec![Vec::new(); FIRST_BINDING as usize + plan.resources.len()];
        // What host steps count is counted: nobody reserves anything.
        let cursor = Cursor::new(plan, Counting::Exact, 0);
        let samples = vec![0; plan.passes.len()];
        let mut frame = Frame { subject, memory, values, reserved: None, asked: None, cursor, flipped: 0, samples };
        frame.memory[1] = vec![subject.uniform.to_bits(); 256];
        frame.memory[2] = vec![0; 16];
        frame.allocate()?;
        Ok(frame)
    }

    /// Gives room to whatever can be sized by now, and tells the programs.
    fn allocate(&mut self) -> Result<(), String> {
        let plan = &self.subject.plan;
        let sizes = bytes(plan, &self.values).map_err(|error| error.to_string())?;
        let memory = self.memory[FIRST_BINDING as usize..].iter_mut();
        for ((planned, (_, bytes)), words) in plan.resources.iter().zip(sizes).zip(memory) {
            // What the caller brings is filled: nothing is nearer than the far plane.
            let value = if planned.is_brought() { NOTHING_OPAQUE } else { STALE };
            words.resize((bytes as usize / 4).max(1), value);
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

    /// Goes on up to a run of the pass `until`; whether it came to that, or to the end of the frame. Geometry passes insert
    /// `fragments`.
    pub(crate) fn advance(&mut self, until: &Runnable, fragments: &Fragments<'_>) -> Result<bool, String> {
        loop {
            let mut ahead = self.cursor.clone();
            let turn = ahead.next(&self.subject.plan, &self.values).map_err(|error| error.to_string())?;
            match turn {
                None => {
                    self.arrange(ahead.flipped(&self.subject.plan));
                    return Ok(false);
                }
                Some(Turn::Pass(run)) if until.is_of(run) => {
                    self.samples[run.pass.0] = 0;
                    self.arrange(run.flipped);
                    self.enter(run.iteration)?;
                    return Ok(true);
                }
                Some(turn) => {
                    self.cursor = ahead;
                    self.turn(turn, fragments)?;
                }
            }
        }
    }

    /// The k that a host step has decided, where the plan has one that does.
    pub(crate) fn decided_k(&self) -> Option<u32> {
        let decides = self.subject.plan.frame.decisions().any(|decision| decision.sets.contains(&SymbolId::K));
        self.values.k().filter(|_| decides)
    }

    /// Goes past the pass that the frame stands before, in which so many samples more have passed.
    pub(crate) fn pass_by(&mut self, samples: u32) -> Result<(), String> {
        let turn = self.cursor.next(&self.subject.plan, &self.values).map_err(|error| error.to_string())?;
        if let Some(Turn::Pass(run)) = turn {
            self.samples[run.pass.0] += samples;
        }
        Ok(())
    }

    fn turn(&mut self, turn: Turn, fragments: &Fragments<'_>) -> Result<(), String> {
        match turn {
            Turn::Clear { resource, value } => self.physical(resource).fill(value),
            Turn::Copy { from, to } => {
                let words = self.physical(from).clone();
                *self.physical(to) = words;
            }
            Turn::Pass(run) => {
                self.arrange(run.flipped);
                self.enter(run.iteration)?;
                self.samples[run.pass.0] = 0;
                if let Some(runnable) = self.subject.passes.iter().find(|other| other.is_of(run)) {
                    self.pass(runnable, run, fragments)?;
                }
            }
            Turn::Ask(question) => self.answer(question)?,
        }
        Ok(())
    }

    /// Puts the resources of every exchange where a pass looks for them that sees these exchanges flipped.
    fn arrange(&mut self, flipped: u32) {
        for (number, [a, b]) in self.subject.plan.frame.exchanges.iter().enumerate() {
            if (self.flipped ^ flipped) >> number & 1 == 1 {
                self.memory.swap(FIRST_BINDING as usize + a.0, FIRST_BINDING as usize + b.0);
            }
        }
        self.flipped = flipped;
    }

    /// The words of a physical resource.
    fn physical(&mut self, resource: ResourceId) -> &mut Vec<u32> {
        let place = self.subject.plan.frame.physical(resource, self.flipped);
        &mut self.memory[FIRST_BINDING as usize + place.0]
    }

    /// Tells the programs the iteration that they are in.
    pub(crate) fn enter(&mut self, iteration: u32) -> Result<(), String> {
        let words = self.values.frame_words(&self.subject.plan, 0, iteration);
        self.memory[0] = words.map_err(|error| error.to_string())?;
        Ok(())
    }

    /// Answers what the frame must know: for the host, no more memory than is reserved.
    fn answer(&mut self, question: Question) -> Result<(), String> {
        let words = match &question {
            Question::Samples(PassId(pass)) => vec![self.samples[*pass]],
            // The scene is one object, and never dropped.
            Question::Objects(_) => vec![1],
            Question::Words(spans) => {
                spans.iter().map(|span| self.words(*span)).collect::<Result<Vec<_>, _>>()?.concat()
            }
        };
        let plan = &self.subject.plan;
        let decision = self.cursor.decides(plan);
        let mut values = self.values.clone();
        self.cursor.answer(plan, &words, &mut values).map_err(|error| error.to_string())?;
        let Some(decision) = decision else { return Ok(()) };
        let memory: Vec<SymbolId> = decision.sets.iter().copied().filter(|id| *id != SymbolId::K).collect();
        self.asked = memory.iter().filter_map(|id| values.get(*id)).max().or(self.asked);
        if let Some(most) = self.reserved.map(u64::from) {
            for id in memory {
                let asked = values.get(id).unwrap_or(0);
                values.set(id, asked.min(most));
            }
        }
        self.values = values;
        self.allocate()
    }

    fn words(&mut self, Span { resource, first, count }: Span) -> Result<Vec<u32>, String> {
        let words = self.physical(resource);
        let read = words.get(first as usize..(first + count) as usize);
        Ok(read.ok_or_else(|| format!("word {first}, which the host reads, is not there"))?.to_vec())
    }

    fn pass(&mut self, runnable: &Runnable, run: Run, fragments: &Fragments<'_>) -> Result<(), String> {
        match &runnable.pass.kind {
            Kind::Compute { .. } => {
                let mut counts = [1; 3];
                let values = self.values.in_iteration(run.iteration);
                for (count, groups) in counts.iter_mut().zip(&runnable.pass.groups) {
                    let groups = values.word(groups, &runnable.pass.anchor);
                    *count = groups.map_err(|error| error.to_string())?;
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
            Exit::Ended => {
                self.samples[runnable.id.0] += 1;
                Ok(())
            }
            Exit::Discarded => Ok(()),
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
