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

use crate::context::SearchContext;
use crate::memory::Memory;
use crate::random_walk::walk;
use crate::reduced::explore_reduced;
use crate::report::{Names, Schedule, code_location, failing_schedule, letter, step_violation};
use crate::search::{Property, SearchResult, StateVerdict};
use crate::sequential::run_alone;
use crate::state::State;
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
    let mut report = Report::new(limits);
    report.notes.extend(source.marker_note());
    let programs: Vec<&Bytecode> = std::iter::once(&source.program).chain(&source.holds).collect();
    let memory = memory::memory(&programs, shader)?;
    let mut all: Vec<Invocations> = Vec::new();
    for &count in &limits.fragments {
        all.extend(Invocations::sets(&source.program, source.stage, count, shader.workgroups));
    }
    all.dedup();
    for invocations in &all {
        if invocations.count() > MOST {
            let text = format!("{} are more than {MOST} invocations", invocations.description());
            return Err(Error::Unable(text));
        }
        report.cases += 1;
        // WGSL lets an index out of bounds reach any word of the buffer. wgpu and browsers drop the access, or clamp the index.
        for clamps in [false, true] {
            let places = check_invocations(&source, invocations, &memory, (limits, clamps), &mut report);
            for place in &places {
                let note = format!(
                    "the index at {place} may be out of bounds: it was dropped and then clamped, and a device may reach any word of the \
                     buffer"
                );
                if !report.notes.contains(&note) {
                    report.notes.push(note);
                }
            }
            if places.is_empty() || report.failure.is_some() {
                break;
            }
        }
        if report.failure.is_some() {
            break;
        }
    }
    if let Some(part) = all.iter().find(|set| !set.is_whole()) {
        report.notes.push(format!(
            "a part of the {} invocations of a workgroup runs, and no other invocation of it: what depends on the others is not checked",
            part.size()
        ));
    }
    Ok(report)
}

/// Checks one set of invocations; returns where an index was out of bounds. `clamps`: it is then that of the last element.
fn check_invocations(
    source: &ShaderSource<'_>,
    invocations: &Invocations,
    memory: &Memory,
    (limits, clamps): (&Limits, bool),
    report: &mut Report,
) -> BTreeSet<String> {
    let program = &source.program;
    let (mut context, words) = SearchContext::with_workgroups(program, memory, limits.model, invocations.workgroups());
    context.has_weak_exchange = true;
    context.is_reduced = limits.reduce;
    context.texels = memory::TEXELS;
    context.out_of_bounds = Some(RefCell::default());
    context.clamps = clamps;
    let case = format!("{} of {}", invocations.description(), source.shader.entry);
    let fragments: Vec<(String, String)> =
        (0..invocations.count()).map(|number| (letter(number as usize), invocations.name(number))).collect();
    let resource = |buffer: &Buffer, word: u32| source.word_name(buffer, word);
    let names = Names { resource: &resource, value: &|value| value.to_string() };
    match context.start(words, invocations.machines(program)) {
        Err((fragment, error)) => {
            let violation = step_violation(&context, fragment, error, &source.text);
            report.failure = Some(Schedule { case, fragments, violation, ..Schedule::default() });
        }
        Ok(first) => {
            let result = search(source, &context, &first, memory, limits);
            report.states += result.states;
            report.is_exhaustive &= result.is_exhaustive;
            if let Some(failure) = &result.failure {
                let schedule = failing_schedule(&context, &first, failure, &source.text, &names);
                report.failure = Some(Schedule { case, fragments, ..schedule });
            }
        }
    }
    if context.has_forgotten.get() {
        let note =
            "a word gets the same values again and again: a load that observes a value from long before is not checked"
                .to_owned();
        if !report.notes.contains(&note) {
            report.notes.push(note);
        }
    }
    let known = context.out_of_bounds.take().map(RefCell::into_inner).unwrap_or_default();
    known.iter().map(|at| code_location(program, *at, &source.text)).collect()
}

fn search(
    source: &ShaderSource<'_>,
    context: &SearchContext<'_>,
    first: &State,
    memory: &Memory,
    limits: &Limits,
) -> SearchResult {
    let mut property = HoldsProperty { holds: source.holds.as_ref(), memory: memory.clone(), context };
    match limits.random_schedules {
        Some(seeds) => walk(context, first, &mut property, seeds),
        None => explore_reduced(context, first.clone(), &mut property, limits.states),
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
    memory: Memory,
    context: &'a SearchContext<'p>,
}

impl Property for HoldsProperty<'_, '_> {
    fn instant(&mut self, _: &[u32]) -> Option<String> {
        None
    }

    fn final_state(&mut self, words: &[u32]) -> StateVerdict {
        let Some(holds) = self.holds else { return StateVerdict::Correct };
        for (index, first, count) in self.context.state_buffers() {
            self.memory[index].copy_from_slice(&words[first..first + count]);
        }
        let mut machine = Machine::new(holds);
        match run_alone(&mut machine, &mut self.memory) {
            Ok(Exit::Ended) if machine.result() == [1] => StateVerdict::Correct,
            Ok(Exit::Ended) => StateVerdict::Wrong(format!("`{HOLDS}` returns false")),
            Ok(_) => StateVerdict::Wrong(format!("`{HOLDS}` does not end")),
            Err(error) => StateVerdict::Wrong(format!("`{HOLDS}` fails: {error}")),
        }
    }
}
