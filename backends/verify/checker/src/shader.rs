//! Any wgpu shader: invocations of one entry point, in every order.
//!
//! In: a WGSL text and the name of an entry point. Out: a [`Report`]. Memory begins at zero, or as the caller says. What
//! is right is a function `holds() -> bool` of the same text, asked at every end; without one, only data races, waits
//! without end and indices out of bounds are failures.

use fragbuf_targets::{Checked, check};
use fragbuf_codegen::{LineMap, Notes, PassText, Profile};
use fragbuf_interpreter::{Exit, Machine, Options, Program, Space, Unsupported};
use fragbuf_model::Origin;
use naga::{Binding, BuiltIn, ScalarKind};

use crate::explore::{End, Judge, explore};
use crate::frame::{Memory, run_alone};
use crate::report::{Names, Schedule, fault, letter, lines};
use crate::state::{Ground, Home};
use crate::subject::{MARKERS, Source, Subject};
use crate::verdict::{Error, Limits, Report};
use crate::walk::walk;

/// A shader to check.
#[derive(Clone, Debug)]
pub struct Shader<'a> {
    /// The file's name, for messages.
    pub file: &'a str,
    /// Its text.
    pub text: &'a str,
    /// The entry point: a fragment or a compute stage.
    pub entry: &'a str,
    /// The first words of buffers, by name; all others are zero.
    pub fill: &'a [(String, Vec<u32>)],
}

/// The function that says whether an end is right.
const HOLDS: &str = "holds";

/// Words of a buffer whose length the shader leaves open, if `fill` says no more.
const OPEN: usize = 64;

/// Checks a shader with as many invocations as `limits` says. Calls of `memory_fence()`, `critical_begin()` and
/// `critical_end()` are what they are in fragbuf's templates.
pub fn check_shader(shader: &Shader<'_>, limits: &Limits) -> Result<Report, Error> {
    let checked = parsed(shader)?;
    let program = program(&checked, shader.entry, shader)?;
    let module = checked.module();
    let has_holds = module.functions.iter().any(|(_, function)| function.name.as_deref() == Some(HOLDS));
    let options = Options { markers: &MARKERS, ..Options::default() };
    let holds = match has_holds {
        true => Some(
            Program::function(module, checked.info(), HOLDS, &options).map_err(|faults| refused(&faults, shader))?,
        ),
        false => None,
    };
    if program.buffers.iter().any(|buffer| buffer.space == Space::Workgroup) {
        return Err(Error::Unable(
            "the checker runs no workgroup variables: invocations share buffers alone".to_owned(),
        ));
    }
    let memory = memory(&[Some(&program), holds.as_ref()], shader);
    let source = Source { text: shader.text.to_owned(), lines: LineMap::default(), file: shader.file.to_owned() };
    let mut report = Report::new(limits);
    for &count in &limits.fragments {
        let (ground, words) = Ground::new(&program, &memory, limits.model);
        let machines = (0..count).map(|number| invocation(&program, number)).collect();
        let mut judge = ShaderJudge { holds: holds.as_ref(), memory: memory.clone(), ground: &ground };
        let found = match ground.start(words, machines) {
            Err(mishap) => {
                return Err(Error::Unable(format!("an invocation does not get to its first access: {mishap:?}")));
            }
            Ok(first) => {
                let found = match limits.seeds {
                    Some(seeds) => walk(&ground, &first, &mut judge, seeds),
                    None => explore(&ground, first.clone(), &mut judge, limits.states),
                };
                if let Some(failure) = &found.failure {
                    let resource = |memory: usize, word: u32| named(&program, memory, word);
                    let names = Names { resource: &resource, value: &|value| value.to_string() };
                    report.failure = Some(Schedule {
                        case: format!("{count} invocations of {}", shader.entry),
                        fragments: (0..count as usize).map(|at| (letter(at), format!("invocation {at}"))).collect(),
                        prior: Vec::new(),
                        steps: lines(&ground, &first, failure, &source, &names),
                        fault: fault(&failure.what, &ground, &source),
                    });
                }
                found
            }
        };
        report.cases += 1;
        report.states += found.states;
        report.is_whole &= found.is_whole;
        if report.failure.is_some() {
            break;
        }
    }
    Ok(report)
}

fn parsed(shader: &Shader<'_>) -> Result<Checked, Error> {
    let pass = PassText {
        anchor: shader.entry.to_owned(),
        text: shader.text.to_owned(),
        lines: LineMap::default(),
        entry_points: Vec::new(),
        exports: Vec::new(),
        resources: Vec::new(),
        written_first: Vec::new(),
        notes: Notes::default(),
    };
    check(pass, Profile::Native, &Origin::new(shader.file, 1, 1)).map_err(|faults| {
        let texts: Vec<String> = faults.iter().map(|fault| fault.message.clone()).collect();
        Error::Unable(format!("{}: {}", shader.file, texts.join("; ")))
    })
}

fn program(checked: &Checked, entry: &str, shader: &Shader<'_>) -> Result<Program, Error> {
    let options = Options { markers: &MARKERS, ..Options::default() };
    let program = Program::entry_point(checked.module(), checked.info(), entry, &options);
    program.and_then(Program::without_textures).map_err(|faults| refused(&faults, shader))
}

fn refused(faults: &[Unsupported], shader: &Shader<'_>) -> Error {
    let text = |fault: &Unsupported| match fault.span.is_defined() {
        true => format!("{}:{}: {fault}", shader.file, fault.span.location(shader.text).line_number),
        false => format!("{}: {fault}", shader.file),
    };
    let mut texts: Vec<String> = faults.iter().map(text).collect();
    texts.dedup();
    Error::Unable(texts.join("\n"))
}

/// What every binding holds before.
fn memory(programs: &[Option<&Program>], shader: &Shader<'_>) -> Memory {
    let mut memory: Memory = Vec::new();
    for buffer in programs.iter().flatten().flat_map(|program| &program.buffers) {
        let home = Subject::memory_of(buffer.binding);
        if memory.len() <= home {
            memory.resize(home + 1, Vec::new());
        }
        let filled = shader.fill.iter().find(|(name, _)| *name == buffer.name);
        let first: &[u32] = filled.map_or(&[], |(_, words)| words);
        let open = if buffer.words == 0 { OPEN } else { 0 };
        let length = first.len().max(buffer.words as usize).max(open);
        let mut words = first.to_vec();
        words.resize(length, 0);
        memory[home] = words;
    }
    memory
}

/// An invocation with inputs of its own.
fn invocation<'p>(program: &'p Program, number: u32) -> Machine<'p> {
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

fn named(program: &Program, memory: usize, word: u32) -> String {
    let buffer = program.buffers.iter().find(|buffer| Subject::memory_of(buffer.binding) == memory);
    buffer.map_or_else(|| format!("word {word}"), |buffer| format!("{}[word {word}]", buffer.name))
}

struct ShaderJudge<'a, 'p> {
    holds: Option<&'a Program>,
    memory: Memory,
    ground: &'a Ground<'p>,
}

impl Judge for ShaderJudge<'_, '_> {
    fn instant(&mut self, _: &[u32]) -> Option<String> {
        None
    }

    fn end(&mut self, words: &[u32]) -> End {
        let Some(holds) = self.holds else { return End::Right };
        for (buffer, home) in self.ground.program.buffers.iter().zip(&self.ground.homes) {
            if let Home::Moving { first, words: count, .. } = home {
                let memory = &mut self.memory[Subject::memory_of(buffer.binding)];
                memory.copy_from_slice(&words[*first..first + count]);
            }
        }
        let mut machine = Machine::new(holds);
        match run_alone(&mut machine, &mut self.memory) {
            Ok(Exit::Ended) if machine.result() == [1] => End::Right,
            Ok(Exit::Ended) => End::Wrong(format!("`{HOLDS}` gives false")),
            _ => End::Wrong(format!("`{HOLDS}` does not end, or goes out of bounds")),
        }
    }
}
