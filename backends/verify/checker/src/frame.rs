//! A frame of two pixels: its memory, and everything that runs before and after the fragments under test.
//!
//! Input: a subject and the size of its pools. Output: memory after each step, and what a pixel holds. Nothing here runs
//! concurrently.

use fragbuf_codegen::{FIRST_BINDING, PassId, ResourceId, SymbolId};
use fragbuf_frame::{Cursor, FrameStep, HostWait, PassRun, Readbacks, Values, WordRange, resource_bytes};
use fragbuf_interpreter::{DispatchEnd, Exit};
use fragbuf_templates::vocabulary::Kind;

use crate::memory::{Memory, STALE, WIDTH, memory_index, with_buffers};
use crate::programs::{FullscreenProgram, Runnable};
use crate::report::code_location;
use crate::sequential::{machine_with, run_alone};
use crate::subject::Subject;

/// The word of a pixel in every external texture: the far plane, which no opaque surface is nearer than, and the greatest importance.
const EXTERNAL: u32 = 1f32.to_bits();

/// A frame between two of its steps.
#[derive(Clone, Debug)]
pub(crate) struct Frame<'s> {
    pub(crate) subject: &'s Subject,
    pub(crate) memory: Memory,
    pub(crate) values: Values,
    /// The most that host steps allocate.
    pub(crate) allocation_limit: Option<u32>,
    /// What host steps would allocate without that limit.
    pub(crate) requested: Option<u64>,
    cursor: Cursor,
    /// The exchanges of the frame whose resources have been swapped in memory.
    flipped: u32,
    /// Samples that passed in the last run of each pass.
    samples: Vec<u32>,
    /// What iterations have kept of each pixel, where each keeps what earlier ones displaced.
    gathered: [Vec<Vec<u32>>; WIDTH as usize],
}

/// Returns the fragments of a pass, each as a vector of words per input.
pub(crate) type FragmentInputs<'a> = dyn Fn(&Runnable) -> Vec<Vec<Vec<u32>>> + 'a;

impl<'s> Frame<'s> {
    /// Returns a frame before its first step. A resource whose size is not known yet is empty.
    pub(crate) fn new(subject: &'s Subject, values: Values) -> Result<Self, String> {
        let plan = &subject.plan;
        let memory = vec![Vec::new(); FIRST_BINDING as usize + plan.resources.len()];
        let cursor = Cursor::new(plan, Readbacks::Enabled, 0);
        let samples = vec![0; plan.passes.len()];
        let gathered = [const { Vec::new() }; WIDTH as usize];
        let (allocation_limit, requested, flipped) = (None, None, 0);
        let mut frame =
            Frame { subject, memory, values, allocation_limit, requested, cursor, flipped, samples, gathered };
        frame.memory[1] = subject.uniforms.iter().copied().cycle().take(256).collect();
        frame.memory[2] = vec![0; 16];
        frame.allocate()?;
        Ok(frame)
    }

    /// Returns whether everything but the subject is equal.
    pub(crate) fn is_same(&self, other: &Frame<'_>) -> bool {
        self.memory == other.memory
            && self.values == other.values
            && (self.allocation_limit, self.requested) == (other.allocation_limit, other.requested)
            && self.cursor == other.cursor
            && self.flipped == other.flipped
            && self.samples == other.samples
            && self.gathered == other.gathered
    }

    /// Allocates every resource whose size is known by now, and updates the uniform buffer of the frame.
    fn allocate(&mut self) -> Result<(), String> {
        let plan = &self.subject.plan;
        let sizes = resource_bytes(plan, &self.values).map_err(|error| error.to_string())?;
        let memory = self.memory[FIRST_BINDING as usize..].iter_mut();
        for ((planned, (_, bytes)), words) in plan.resources.iter().zip(sizes).zip(memory) {
            // External textures begin without opaque surfaces, and with pixels of the greatest importance.
            let value = if planned.is_external() { EXTERNAL } else { STALE };
            // A texture of the description has a row of texels that are 1, 0, 0, 0.
            let length = if planned.is_of_description() { WIDTH as usize } else { bytes as usize / 4 };
            words.resize(length.max(1), value);
        }
        self.set_iteration(0)
    }

    /// Sets the opaque depth of a pixel in every external depth buffer.
    pub(crate) fn set_opaque(&mut self, pixel: u32, depth: f32) {
        let resources = &self.subject.plan.resources;
        for (planned, words) in resources.iter().zip(&mut self.memory[FIRST_BINDING as usize..]) {
            if let Some(word) = words.get_mut(pixel as usize).filter(|_| planned.is_opaque_depth()) {
                *word = depth.to_bits();
            }
        }
    }

    /// Advances to the next run of the pass `until`, or to the end of the frame; returns whether it reached the pass.
    /// Geometry passes on the way insert `fragments`.
    pub(crate) fn advance(&mut self, until: &Runnable, fragments: &FragmentInputs<'_>) -> Result<bool, String> {
        loop {
            let mut ahead = self.cursor.clone();
            let step = ahead.next(&self.subject.plan, &self.values).map_err(|error| error.to_string())?;
            match step {
                None => {
                    self.exchange(ahead.flipped(&self.subject.plan));
                    return Ok(false);
                }
                Some(FrameStep::Pass(run)) if until.is_of(run) => {
                    self.samples[run.pass.0] = 0;
                    self.exchange(run.flipped);
                    self.set_iteration(run.iteration)?;
                    return Ok(true);
                }
                Some(step) => {
                    self.cursor = ahead;
                    self.run_step(step, fragments)?;
                }
            }
        }
    }

    /// Returns the k that a host step has decided, where a host step of the plan decides it.
    pub(crate) fn decided_k(&self) -> Option<u32> {
        let decides = self.subject.plan.frame.decisions().any(|decision| decision.sets.contains(&SymbolId::K));
        self.values.k().filter(|_| decides)
    }

    /// Moves the cursor past the pass that comes next, and counts the samples that passed in it.
    pub(crate) fn skip_pass(&mut self, samples: u32) -> Result<(), String> {
        let step = self.cursor.next(&self.subject.plan, &self.values).map_err(|error| error.to_string())?;
        if let Some(FrameStep::Pass(run)) = step {
            self.samples[run.pass.0] += samples;
        }
        Ok(())
    }

    fn run_step(&mut self, step: FrameStep, fragments: &FragmentInputs<'_>) -> Result<(), String> {
        match step {
            FrameStep::Clear { resource, value } => self.physical(resource).fill(value),
            FrameStep::Copy { from, to } => {
                let words = self.physical(from).clone();
                *self.physical(to) = words;
            }
            FrameStep::Pass(run) => {
                self.exchange(run.flipped);
                self.set_iteration(run.iteration)?;
                self.samples[run.pass.0] = 0;
                if let Some(runnable) = self.subject.passes.iter().find(|other| other.is_of(run)) {
                    self.run_pass(runnable, run, fragments)?;
                }
                if let Some(program) = self.subject.accumulating(run.pass) {
                    self.accumulate(program)?;
                }
            }
            FrameStep::Wait(wait) => self.supply(wait)?,
            // The cursor of the checker waits for every decision.
            FrameStep::Read(_) | FrameStep::Condition(_) => {}
        }
        Ok(())
    }

    /// Returns the words of the uniform buffer of the frame for a slice.
    pub(crate) fn frame_words(&self, slice: u32) -> Result<Vec<u32>, String> {
        self.values.frame_words(&self.subject.plan, slice, 0).map_err(|error| error.to_string())
    }

    /// Swaps resources in memory so that these exchanges are flipped.
    fn exchange(&mut self, flipped: u32) {
        for (number, [a, b]) in self.subject.plan.frame.exchanges.iter().enumerate() {
            if (self.flipped ^ flipped) >> number & 1 == 1 {
                self.memory.swap(FIRST_BINDING as usize + a.0, FIRST_BINDING as usize + b.0);
            }
        }
        self.flipped = flipped;
    }

    /// Returns the words of a physical resource.
    fn physical(&mut self, resource: ResourceId) -> &mut Vec<u32> {
        let logical = self.subject.plan.frame.physical(resource, self.flipped);
        &mut self.memory[FIRST_BINDING as usize + logical.0]
    }

    /// Writes the uniform buffer of the frame for an iteration.
    fn set_iteration(&mut self, iteration: u32) -> Result<(), String> {
        let words = self.values.frame_words(&self.subject.plan, 0, iteration);
        self.memory[0] = words.map_err(|error| error.to_string())?;
        Ok(())
    }

    /// Supplies the words that the cursor waits for. A host step allocates no more than the allocation limit.
    fn supply(&mut self, wait: HostWait) -> Result<(), String> {
        let words = match &wait {
            HostWait::Samples(PassId(pass)) => vec![self.samples[*pass]],
            // The scene is one object, and is never dropped.
            HostWait::Objects(_) => vec![1],
            HostWait::Words(ranges) => {
                ranges.iter().map(|range| self.words(*range)).collect::<Result<Vec<_>, _>>()?.concat()
            }
        };
        let plan = &self.subject.plan;
        let decision = self.cursor.pending_decision(plan);
        let mut values = self.values.clone();
        self.cursor.supply(plan, &words, &mut values).map_err(|error| error.to_string())?;
        let Some(decision) = decision else { return Ok(()) };
        // A budget could allow no greater k than that of the case.
        if let (Some(most), Some(decided)) = (self.values.k(), values.k())
            && decision.sets.contains(&SymbolId::K)
        {
            values.set(SymbolId::K, decided.min(most).into());
        }
        let sizes: Vec<SymbolId> = decision.sets.iter().copied().filter(|id| *id != SymbolId::K).collect();
        self.requested = sizes.iter().filter_map(|id| values.get(*id)).max().or(self.requested);
        if let Some(most) = self.allocation_limit.map(u64::from) {
            for id in sizes {
                let requested = values.get(id).unwrap_or(0);
                values.set(id, requested.min(most));
            }
        }
        self.values = values;
        self.allocate()
    }

    fn words(&mut self, WordRange { resource, first, count }: WordRange) -> Result<Vec<u32>, String> {
        let words = self.physical(resource);
        let read = words.get(first as usize..(first + count) as usize);
        Ok(read.ok_or_else(|| format!("the host reads word {first}, which is out of bounds"))?.to_vec())
    }

    fn run_pass(&mut self, runnable: &Runnable, run: PassRun, fragments: &FragmentInputs<'_>) -> Result<(), String> {
        match &runnable.pass.kind {
            Kind::Compute { .. } => {
                let mut counts = [1; 3];
                let values = self.values.in_iteration(run.iteration);
                for (count, groups) in counts.iter_mut().zip(&runnable.pass.groups) {
                    let groups = values.word(groups, &runnable.pass.name);
                    *count = groups.map_err(|error| error.to_string())?;
                }
                let textures = runnable.program.textures.iter().map(|texture| memory_index(texture.binding));
                let textures = textures.map(|index| self.memory.get(index).cloned().unwrap_or_default()).collect();
                let end = with_buffers(&runnable.program, &mut self.memory, |buffers| {
                    self.subject.dispatches.run(runnable, counts, buffers, textures)
                });
                let (name, location) =
                    (&runnable.pass.name, |at| code_location(&runnable.program, at, &runnable.source));
                match end {
                    DispatchEnd::Ended => {}
                    DispatchEnd::Endless(_) => return Err(format!("pass `{name}` does not end")),
                    DispatchEnd::DivergentBarrier => {
                        return Err(format!(
                            "some invocations of pass `{name}` wait at a barrier that others do not reach"
                        ));
                    }
                    DispatchEnd::OutOfBounds(access) => {
                        return Err(format!(
                            "pass `{name}` accesses an index out of bounds at {}",
                            location(access.at)
                        ));
                    }
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

    /// Runs one fragment to its end.
    pub(crate) fn insert(&mut self, runnable: &Runnable, inputs: &[Vec<u32>]) -> Result<(), String> {
        let mut machine = machine_with(&runnable.program, inputs);
        let location = |at: u32| code_location(&runnable.program, at, &runnable.source);
        let subject = format!("a fragment of pass `{}` that runs alone", runnable.pass.name);
        match run_alone(&mut machine, &mut self.memory) {
            Ok(Exit::Ended) => {
                self.samples[runnable.id.0] += 1;
                Ok(())
            }
            Ok(Exit::Discarded) => Ok(()),
            Ok(_) => Err(format!("{subject} does not end: it repeats the loop at {}", location(machine.at()))),
            Err(error) => {
                let at = machine.out_of_bounds.map(|access| location(access.at));
                Err(format!("{subject} fails: {error}{}", at.map_or(String::new(), |at| format!(" at {at}"))))
            }
        }
    }

    /// Runs a pass that adds what each pixel holds to what earlier iterations have kept.
    fn accumulate(&mut self, pass: &FullscreenProgram) -> Result<(), String> {
        let is_first = self.subject.is_first_accumulating(pass.id);
        for pixel in 0..WIDTH {
            if is_first {
                let kept = self.stored(pixel)?;
                self.gathered[pixel as usize].extend(kept);
            }
            let position = [pixel as f32 + 0.5, 0.5, 0.5, 1.0].map(f32::to_bits).to_vec();
            let mut machine = machine_with(&pass.program, &[position]);
            match run_alone(&mut machine, &mut self.memory) {
                Ok(Exit::Ended | Exit::Discarded) => {}
                Ok(_) => return Err(format!("pass `{}` does not end", pass.pass)),
                Err(error) => return Err(format!("pass `{}` fails: {error}", pass.pass)),
            }
        }
        Ok(())
    }

    /// Returns what a pixel holds, in the storage's order: in all iterations, where each keeps what earlier ones displaced.
    /// `Err`: its list does not end, or reads out of bounds.
    pub(crate) fn read_out(&mut self, pixel: u32) -> Result<Vec<Vec<u32>>, String> {
        if self.subject.keeps_later() { Ok(self.gathered(pixel).to_vec()) } else { self.stored(pixel) }
    }

    /// Returns what earlier iterations have kept of a pixel.
    pub(crate) fn gathered(&self, pixel: u32) -> &[Vec<u32>] {
        &self.gathered[pixel as usize]
    }

    fn stored(&mut self, pixel: u32) -> Result<Vec<Vec<u32>>, String> {
        let read_out = &self.subject.read_out;
        read_out.entries(&mut self.memory, [WIDTH, 1], pixel).map_err(|error| error.to_string())
    }
}
