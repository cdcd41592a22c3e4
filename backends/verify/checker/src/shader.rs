//! Checks any wgpu shader: invocations of one entry point, in every interleaving.
//!
//! Input: WGSL source and the name of an entry point. Output: a [`Report`]. Memory begins at zero, or as the caller gives it.
//! A function `holds() -> bool` of the same source must return true in every final state. Without one, only data races,
//! deadlocks, livelocks and indices out of bounds are failures.

use fragbuf_codegen::{Notes, PassSource, Profile, SourceMap};
use fragbuf_interpreter::{Bytecode, Exit, Machine, Options, Space, Unsupported};
use fragbuf_model::SourceSpan;
use fragbuf_targets::{Checked, check};
use naga::{Binding, BuiltIn, ScalarKind};

use crate::context::SearchContext;
use crate::memory::{Memory, memory_index};
use crate::programs::{CheckedSource, MARKERS};
use crate::random_walk::walk;
use crate::reduced::explore_reduced;
use crate::report::{Names, Schedule, letter, steps, violation};
use crate::search::{Property, StateVerdict};
use crate::sequential::run_alone;
use crate::verdict::{Error, Limits, Report};

/// A shader to check.
#[derive(Clone, Debug)]
pub struct Shader<'a> {
    /// The file's name, for messages.
    pub file: &'a str,
    /// Its WGSL source.
    pub source: &'a str,
    /// The entry point: a fragment or a compute stage.
    pub entry: &'a str,
    /// The first words of buffers, by name; all others are zero.
    pub fill: &'a [(String, Vec<u32>)],
}

/// The function that returns whether a final state is correct.
const HOLDS: &str = "holds";

/// Words of a buffer of unspecified length, if `fill` gives no more.
const UNSIZED: usize = 64;

/// Checks a shader with as many invocations as `limits` gives. Calls of `memory_fence()`, `critical_begin()` and
/// `critical_end()` have the same meaning as in fragbuf's templates.
pub fn check_shader(shader: &Shader<'_>, limits: &Limits) -> Result<Report, Error> {
    let checked = validated(shader)?;
    let program = entry_point(&checked, shader)?;
    let holds = holds(&checked, shader)?;
    if program.buffers.iter().any(|buffer| buffer.space == Space::Workgroup) {
        let text = "the checker does not support workgroup variables: invocations share buffers only";
        return Err(Error::Unable(text.to_owned()));
    }
    let memory = memory(&[Some(&program), holds.as_ref()], shader);
    let source =
        CheckedSource { text: shader.source.to_owned(), lines: SourceMap::default(), file: shader.file.to_owned() };
    let mut report = Report::new(limits);
    for &count in &limits.fragments {
        let (mut context, words) = SearchContext::new(&program, &memory, limits.model);
        context.has_weak_exchange = true;
        context.is_reduced = limits.reduce;
        let machines = (0..count).map(|number| invocation(&program, number)).collect();
        let first = context
            .start(words, machines)
            .map_err(|error| Error::Unable(format!("an invocation fails before its first access: {error:?}")))?;
        let mut property = HoldsProperty { holds: holds.as_ref(), memory: memory.clone(), context: &context };
        let result = match limits.random_schedules {
            Some(seeds) => walk(&context, &first, &mut property, seeds),
            None => explore_reduced(&context, first.clone(), &mut property, limits.states),
        };
        report.cases += 1;
        report.states += result.states;
        report.is_exhaustive &= result.is_exhaustive;
        if let Some(failure) = &result.failure {
            let resource = |memory: usize, word: u32| resource_name(&program, memory, word);
            let names = Names { resource: &resource, value: &|value| value.to_string() };
            report.failure = Some(Schedule {
                case: format!("{count} invocations of {}", shader.entry),
                fragments: (0..count as usize).map(|at| (letter(at), format!("invocation {at}"))).collect(),
                initial_fragments: Vec::new(),
                steps: steps(&context, &first, failure, &source, &names),
                violation: violation(&failure.kind, &context, &source),
            });
            break;
        }
    }
    Ok(report)
}

/// Validates the shader with naga.
fn validated(shader: &Shader<'_>) -> Result<Checked, Error> {
    let pass = PassSource {
        name: shader.entry.to_owned(),
        text: shader.source.to_owned(),
        lines: SourceMap::default(),
        entry_points: Vec::new(),
        exports: Vec::new(),
        resources: Vec::new(),
        written_first: Vec::new(),
        notes: Notes::default(),
    };
    check(pass, Profile::Native, &SourceSpan::new(shader.file, 1, 1)).map_err(|diagnostics| {
        let messages: Vec<String> = diagnostics.iter().map(|one| one.message.clone()).collect();
        Error::Unable(format!("{}: {}", shader.file, messages.join("; ")))
    })
}

fn entry_point(checked: &Checked, shader: &Shader<'_>) -> Result<Bytecode, Error> {
    let options = Options { markers: &MARKERS, ..Options::default() };
    let program = Bytecode::entry_point(checked.module(), checked.info(), shader.entry, &options);
    program.and_then(Bytecode::without_textures).map_err(|unsupported| unsupported_error(&unsupported, shader))
}

/// Compiles the function `holds`, if the shader declares it.
fn holds(checked: &Checked, shader: &Shader<'_>) -> Result<Option<Bytecode>, Error> {
    let module = checked.module();
    if !module.functions.iter().any(|(_, function)| function.name.as_deref() == Some(HOLDS)) {
        return Ok(None);
    }
    let options = Options { markers: &MARKERS, ..Options::default() };
    let program = Bytecode::function(module, checked.info(), HOLDS, &options);
    program.map(Some).map_err(|unsupported| unsupported_error(&unsupported, shader))
}

fn unsupported_error(unsupported: &[Unsupported], shader: &Shader<'_>) -> Error {
    let message = |one: &Unsupported| match one.span.is_defined() {
        true => format!("{}:{}: {one}", shader.file, one.span.location(shader.source).line_number),
        false => format!("{}: {one}", shader.file),
    };
    let mut messages: Vec<String> = unsupported.iter().map(message).collect();
    messages.dedup();
    Error::Unable(messages.join("\n"))
}

/// Returns the initial content of every binding.
fn memory(programs: &[Option<&Bytecode>], shader: &Shader<'_>) -> Memory {
    let mut memory: Memory = Vec::new();
    for buffer in programs.iter().flatten().flat_map(|program| &program.buffers) {
        let index = memory_index(buffer.binding);
        if memory.len() <= index {
            memory.resize(index + 1, Vec::new());
        }
        let given = shader.fill.iter().find(|(name, _)| *name == buffer.name);
        let first: &[u32] = given.map_or(&[], |(_, words)| words);
        let least = if buffer.words == 0 { UNSIZED } else { buffer.words as usize };
        let mut words = first.to_vec();
        words.resize(first.len().max(least), 0);
        memory[index] = words;
    }
    memory
}

/// Returns an invocation with inputs that differ from those of the others.
fn invocation(program: &Bytecode, number: u32) -> Machine<'_> {
    let mut machine = Machine::new(program);
    for (at, input) in program.inputs.iter().enumerate() {
        let words: Vec<u32> = match (&input.binding, input.kind) {
            (Some(Binding::BuiltIn(BuiltIn::Position { .. })), _) => {
                [0.5, 0.5, 0.125 * (number + 1) as f32, 1.0].map(f32::to_bits).to_vec()
            }
            (Some(Binding::BuiltIn(BuiltIn::LocalInvocationId | BuiltIn::LocalInvocationIndex)), _) => vec![0; 3],
            (Some(Binding::BuiltIn(BuiltIn::NumWorkGroups)), _) => vec![u32::MAX, 1, 1],
            (Some(Binding::BuiltIn(_)), _) => vec![number, 0, 0],
            (_, Some(ScalarKind::Float)) => vec![((number + 1) as f32 / 8.0).to_bits(); input.words.len()],
            _ => vec![number + 1; input.words.len()],
        };
        machine.set_input(at, &words);
    }
    machine
}

fn resource_name(program: &Bytecode, memory: usize, word: u32) -> String {
    let buffer = program.buffers.iter().find(|buffer| memory_index(buffer.binding) == memory);
    buffer.map_or_else(|| format!("word {word}"), |buffer| format!("{}[word {word}]", buffer.name))
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
