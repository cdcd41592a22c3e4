//! Checks any wgpu shader: invocations of one entry point, in every interleaving.
//!
//! Input: WGSL source and the name of an entry point. Output: a [`Report`]. Memory begins at zero, or as the caller gives it.
//! A function `holds() -> bool` of the same source must return true in every final state. Without one, only data races,
//! deadlocks, livelocks, divergent barriers and loops without end are failures.

mod invocations;
mod memory;
mod source;

use std::cell::RefCell;
use std::collections::BTreeSet;

use fragbuf_interpreter::{Buffer, Bytecode, Exit, Machine, Space};
use naga::ShaderStage;

use crate::context::SearchContext;
use crate::memory::Memory;
use crate::random_walk::walk;
use crate::reduced::explore_reduced;
use crate::relaxed::REPEATED;
use crate::report::{Names, Schedule, code_location, failing_schedule, letter, step_violation};
use crate::search::{Failure, FailureKind, Property, SearchResult, StateVerdict};
use crate::sequential::run_alone;
use crate::verdict::{Error, Limits, Report};
use crate::word_name::word_path;

use invocations::{Invocations, MOST};
use source::ShaderSource;

/// A shader to check.
#[derive(Clone, Copy, Debug, Default)]
pub struct Shader<'a> {
    /// The file's name, for messages.
    pub file: &'a str,
    /// Its WGSL source.
    pub source: &'a str,
    /// The entry point: a fragment or a compute stage.
    pub entry: &'a str,
    /// The first words of buffers and the first channels of textures, by name. Other words are 0, and other channels 1.
    pub fill: &'a [(String, Vec<u32>)],
    /// Values of pipeline-overridable constants, by name or number.
    pub overrides: &'a [(String, f64)],
    /// The number of workgroups of a compute stage, if it is not to follow from the number of invocations.
    pub workgroups: Option<u32>,
}

/// The function that returns whether a final state is correct.
const HOLDS: &str = "holds";

/// Checks a shader with as many invocations as `limits` gives; a compute stage with whole workgroups where these are small. Calls
/// of `memory_fence()`, `critical_begin()` and `critical_end()` have the same meaning as in fragbuf's templates.
pub fn check_shader(shader: &Shader<'_>, limits: &Limits) -> Result<Report, Error> {
    let source = ShaderSource::new(shader)?;
    if shader.workgroups.is_some() && source.stage != ShaderStage::Compute {
        return Err(Error::Unable(format!("`{}` is not a compute stage: it has no workgroups", shader.entry)));
    }
    let programs: Vec<&Bytecode> = std::iter::once(&source.program).chain(&source.holds).collect();
    let memory = memory::memory(&programs, shader)?;
    let mut check = ShaderCheck { source: &source, memory, limits, report: Report::new(limits), has_change: false };
    source.notes().into_iter().for_each(|note| check.note(note));
    let mut all: Vec<Invocations> = Vec::new();
    for &count in &limits.fragments {
        all.extend(Invocations::sets(&source.program, source.stage, count, shader.workgroups));
    }
    all.dedup();
    if let Some(large) = all.iter().find(|invocations| invocations.count() > MOST) {
        return Err(Error::Unable(format!("{} are more than {MOST} invocations", large.description())));
    }
    for invocations in &all {
        check.run(invocations);
        if check.report.failure.is_some() {
            break;
        }
    }
    if !check.has_change && check.report.failure.is_none() {
        source.without_effect().into_iter().for_each(|note| check.note(note));
    }
    Ok(check.report)
}

/// A check of one entry point.
struct ShaderCheck<'a> {
    source: &'a ShaderSource<'a>,
    memory: Memory,
    limits: &'a Limits,
    report: Report,
    /// Whether a final state differs from the initial memory.
    has_change: bool,
}

/// What one search of a set of invocations has found.
struct Found {
    result: SearchResult,
    failure: Option<Schedule>,
    /// Whether the failure may come from invocations of a workgroup that do not run.
    is_of_part: bool,
    /// Where an index was out of bounds.
    out_of_bounds: BTreeSet<String>,
    has_forgotten: bool,
    /// Whether a final state differs from the initial memory.
    has_change: bool,
}

impl ShaderCheck<'_> {
    /// Adds a note once.
    fn note(&mut self, note: String) {
        if !self.report.notes.contains(&note) {
            self.report.notes.push(note);
        }
    }

    /// Checks one set of invocations.
    fn run(&mut self, invocations: &Invocations) {
        self.report.cases += 1;
        // WGSL lets an index out of bounds reach any word of the buffer. wgpu and browsers drop the access, or clamp the index.
        for clamps in [false, true] {
            let found = self.search(&self.source.program, invocations, clamps);
            self.report.states += found.result.states;
            self.report.is_exhaustive &= found.result.is_exhaustive && !found.has_forgotten;
            if found.has_forgotten {
                self.note(format!(
                    "a word gets one value more than {REPEATED} times: loads that observe earlier writes of the word are not checked"
                ));
            }
            self.has_change |= found.has_change;
            for place in &found.out_of_bounds {
                self.note(format!(
                    "the index at {place} may be out of bounds: the access was dropped, then clamped; a device may reach any word of \
                     the buffer"
                ));
            }
            match found.failure {
                Some(schedule) if found.is_of_part => {
                    self.report.is_exhaustive = false;
                    self.report.has_undecided_failure = true;
                    let (members, size) = invocations.part();
                    self.note(format!(
                        "with {members} of {size} invocations of a workgroup: {}. The others do not run, so this decides nothing",
                        schedule.violation
                    ));
                }
                failure => self.report.failure = failure,
            }
            if !invocations.is_whole() {
                let (members, size) = invocations.part();
                self.note(format!(
                    "{members} of the {size} invocations of a workgroup run: what depends on the others is not checked"
                ));
            }
            if self.report.failure.is_some() {
                self.complete_schedule(invocations, clamps);
            }
            if found.out_of_bounds.is_empty() || self.report.failure.is_some() {
                break;
            }
        }
    }

    /// Adds the accesses whose order cannot be observed to the schedule of a failure. The search does not take them as steps.
    fn complete_schedule(&mut self, invocations: &Invocations, clamps: bool) {
        let mut program = self.source.program.clone();
        if !program.buffers.iter().any(|buffer| buffer.commutes) {
            return;
        }
        program.buffers.iter_mut().for_each(|buffer| buffer.commutes = false);
        if let Some(schedule) = self.search(&program, invocations, clamps).failure {
            self.report.failure = Some(schedule);
        }
    }

    /// Searches one set of invocations. `clamps`: an index out of bounds is that of the last element.
    fn search(&self, program: &Bytecode, invocations: &Invocations, clamps: bool) -> Found {
        let ShaderCheck { source, memory, limits, .. } = self;
        let (mut context, words) =
            SearchContext::with_workgroups(program, memory, limits.model, invocations.workgroups());
        context.has_weak_exchange = true;
        context.is_reduced = limits.reduce;
        context.wants_shortest = limits.shortest;
        context.texels = memory::TEXELS;
        context.out_of_bounds = Some(RefCell::default());
        context.clamps = clamps;
        let states = limits.states.min(memory::STATE_WORDS / (words.len() + 1));
        let names = Names {
            resource: &|buffer: &Buffer, word: u32| source.word_name(buffer, word),
            value: &|value| value.to_string(),
        };
        let mut has_change = true;
        let (result, schedule) = match context.start(words, invocations.machines(program)) {
            Err((fragment, error)) => {
                let failure = Some(Failure { steps: Vec::new(), kind: FailureKind::Step(fragment, error) });
                let result = SearchResult { is_exhaustive: true, failure, ..SearchResult::default() }.decided();
                let violation = step_violation(&context, fragment, error, &source.text);
                (result, Schedule { violation, ..Schedule::default() })
            }
            Ok(first) => {
                let holds = source.holds.as_ref();
                let mut property = HoldsProperty { holds, initial: memory, context: &context, has_change: false };
                let result = match limits.random_schedules {
                    Some(seeds) => walk(&context, &first, &mut property, seeds),
                    None => explore_reduced(&context, first.clone(), &mut property, states),
                };
                has_change = property.has_change;
                let result = result.decided();
                let schedule = result.failure.as_ref();
                let schedule =
                    schedule.map(|failure| failing_schedule(&context, &first, failure, &source.text, &names));
                (result, schedule.unwrap_or_default())
            }
        };
        let is_of_part = !invocations.is_whole()
            && result.failure.as_ref().is_some_and(|failure| !matches!(failure.kind, FailureKind::Step(..)));
        let failure = result.failure.as_ref().map(|_| Schedule {
            case: format!("{} of {}", invocations.description(), source.shader.entry),
            fragments: (0..invocations.count())
                .map(|number| (letter(number as usize), invocations.name(number)))
                .collect(),
            ..schedule
        });
        let known = context.out_of_bounds.take().map(RefCell::into_inner).unwrap_or_default();
        let out_of_bounds = known.iter().map(|at| code_location(program, *at, &source.text)).collect();
        Found { has_forgotten: context.has_forgotten.get(), result, failure, is_of_part, out_of_bounds, has_change }
    }
}

impl ShaderSource<'_> {
    /// Returns the name of a word, such as `heads.first[3]`.
    fn word_name(&self, buffer: &Buffer, word: u32) -> String {
        let mut variables = self.module.global_variables.iter();
        let variable = variables.find(|(_, variable)| variable.name.as_ref() == Some(&buffer.name));
        let path =
            |word: u32| variable.map_or(String::new(), |(_, variable)| word_path(&self.module, variable.ty, word));
        match buffer.space {
            Space::Workgroup => {
                let length = buffer.words.max(1);
                format!("{}{} of workgroup {}", buffer.name, path(word % length), word / length)
            }
            _ => format!("{}{}", buffer.name, path(word)),
        }
    }
}

/// The property that the shader's function `holds` returns true in final states.
struct HoldsProperty<'a, 'p> {
    holds: Option<&'a Bytecode>,
    initial: &'a Memory,
    context: &'a SearchContext<'p>,
    /// Whether a final state differs from the initial memory.
    has_change: bool,
}

impl Property for HoldsProperty<'_, '_> {
    fn instant(&mut self, _: &[u32]) -> Option<String> {
        None
    }

    fn final_state(&mut self, words: &[u32]) -> StateVerdict {
        let mut buffers = self.context.state_buffers();
        self.has_change |=
            buffers.any(|(index, first, count)| self.initial[index][..count] != words[first..first + count]);
        let Some(holds) = self.holds else { return StateVerdict::Correct };
        let mut memory = self.initial.clone();
        for (index, first, count) in self.context.state_buffers() {
            memory[index].copy_from_slice(&words[first..first + count]);
        }
        let mut machine = Machine::new(holds);
        match run_alone(&mut machine, &mut memory) {
            Ok(Exit::Ended) if machine.result() == [1] => StateVerdict::Correct,
            Ok(Exit::Ended) => StateVerdict::Wrong(format!("`{HOLDS}` returns false")),
            Ok(_) => StateVerdict::Wrong(format!("`{HOLDS}` does not end")),
            Err(error) => StateVerdict::Wrong(format!("`{HOLDS}` fails: {error}")),
        }
    }
}
