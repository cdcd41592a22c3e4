//! The schedule of a failure, in a form that a person can follow.
//!
//! Input: steps of a search. Output: one line per step, with the fragment, what it did to which word, and the template line
//! that did it. This is plain data; the command line prints it.

use fragbuf_codegen::FIRST_BINDING;
use fragbuf_frame::COUNTERS_RESOURCE;
use fragbuf_interpreter::{Access, Atomic, Buffer, Bytecode, Event, Operation, Reply};
use fragbuf_templates::COUNTERS;
use fragbuf_templates::vocabulary::Element;

use crate::case_run::CaseRun;
use crate::case_setup::CaseSetup;
use crate::context::SearchContext;
use crate::memory::memory_index;
use crate::programs::CheckedSource;
use crate::progress::RunOn;
use crate::runner::Runner;
use crate::search::{Failure, FailureKind, RUN_ON};
use crate::state::{State, Status, StepError};

/// A failure, step by step.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Schedule {
    /// The case: the initial fragments, and how the new ones compare with them.
    pub case: String,
    /// The concurrent fragments, as (name, words).
    pub fragments: Vec<(String, String)>,
    /// The fragments that the pixel initially holds, in order of arrival.
    pub initial_fragments: Vec<String>,
    /// The steps.
    pub steps: Vec<ScheduleStep>,
    /// What is wrong after the last step.
    pub violation: String,
    /// The accesses of a data race.
    pub race: Option<Race>,
}

/// Two accesses of the same word that nothing orders. At least one writes, and at least one is not
/// atomic.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Race {
    /// The word, by the name of its variable and its indices.
    pub word: String,
    /// The earlier access.
    pub first: ScheduleStep,
    /// The later access.
    pub second: ScheduleStep,
}

/// One step.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ScheduleStep {
    /// The fragment's name: A, B, …
    pub fragment: String,
    /// What it does.
    pub action: String,
    /// The file and line: of a template, of the description or of the shader.
    pub location: String,
}

/// Names of memory and of values, for one case.
pub(crate) struct Names<'a> {
    pub(crate) resource: &'a dyn Fn(&Buffer, u32) -> String,
    pub(crate) value: &'a dyn Fn(u64) -> String,
}

/// A step that was performed again.
struct Replayed {
    number: usize,
    access: Option<Access>,
    step: ScheduleStep,
}

/// Returns the schedule of a failure, without the names of the case and of the fragments.
pub(crate) fn failing_schedule(
    context: &SearchContext<'_>,
    first: &State,
    failure: &Failure,
    source: &CheckedSource,
    names: &Names<'_>,
) -> Schedule {
    let replayed = replay(context, first, failure, source, names);
    let race = race(&failure.kind, &replayed, context, names);
    Schedule {
        case: String::new(),
        fragments: Vec::new(),
        initial_fragments: Vec::new(),
        violation: violation(&failure.kind, context, source, race.as_ref()),
        steps: replayed.into_iter().map(|replayed| replayed.step).collect(),
        race,
    }
}

/// Runs the steps of a failure again and describes them.
fn replay(
    context: &SearchContext<'_>,
    first: &State,
    failure: &Failure,
    source: &CheckedSource,
    names: &Names<'_>,
) -> Vec<Replayed> {
    let mut runner = Runner::new(context);
    let mut state = first.clone();
    let mut steps = Vec::new();
    for (fragment, choice) in &failure.steps {
        let Status::Before { stop, .. } = state.fragments[*fragment].clone() else { break };
        let (event, at) = (stop.event, stop.at);
        let location = code_location(context.program, at, source);
        let number = *fragment;
        if *choice == RUN_ON {
            let action = "runs on alone, and observes the latest writes, until it changes something or leaves its loop";
            let step = ScheduleStep { fragment: letter(number), action: action.to_owned(), location };
            steps.push(Replayed { number, access: None, step });
            let RunOn::Moved(next) = context.run_on(&mut runner, &state, *fragment) else { break };
            state = next;
            continue;
        }
        let (reply, next) = match context.step(&mut runner, &state, *fragment, *choice) {
            Ok(stepped) => (stepped.reply, Some(stepped.state)),
            Err(_) => (Reply::Stop, None),
        };
        let is_helper = context.helper == Some(*fragment);
        let mut action = action(&event, reply, *choice, context.program, names);
        if is_helper && !matches!(event, Event::Access(access) if !access.writes()) {
            action.push_str(", without effect: a helper invocation");
        }
        let access = if let Event::Access(access) = event { Some(access) } else { None };
        let step = ScheduleStep { fragment: letter(number), action, location };
        steps.push(Replayed { number, access, step });
        match next {
            Some(next) => state = next,
            None => break,
        }
    }
    steps
}

/// Returns the accesses of a data race: the last step, and the last access of the same word by the other fragment that
/// conflicts with it.
fn race(kind: &FailureKind, steps: &[Replayed], context: &SearchContext<'_>, names: &Names<'_>) -> Option<Race> {
    let FailureKind::Step(_, StepError::DataRace(other, word)) = kind else { return None };
    let (second, earlier) = steps.split_last()?;
    let access = second.access?;
    let conflicts = |step: &&Replayed| {
        let same =
            |one: &Access| context.word(one.address) == Some(*word as usize) && !(one.is_atomic && access.is_atomic);
        step.number == *other && step.access.is_some_and(|one| same(&one) && (one.writes() || access.writes()))
    };
    let first = earlier.iter().rfind(conflicts)?;
    let buffer = &context.program.buffers[usize::from(access.address.buffer)];
    let word = (names.resource)(buffer, access.address.word);
    Some(Race { word, first: first.step.clone(), second: second.step.clone() })
}

/// Returns the name of a fragment: A, B, C, …
pub(crate) fn letter(fragment: usize) -> String {
    char::from_u32('A' as u32 + fragment as u32).map_or_else(|| fragment.to_string(), String::from)
}

/// Describes an event and the value that it observed; [`Reply::Stop`] if it is a failure.
fn action(event: &Event, reply: Reply, choice: u32, program: &Bytecode, names: &Names<'_>) -> String {
    let access = match event {
        Event::Access(access) => access,
        Event::Fence => return "fence".to_owned(),
        Event::CriticalBegin => return "enters the critical section".to_owned(),
        Event::CriticalEnd => return "leaves the critical section".to_owned(),
        Event::Barrier(_) => return "passes the barrier".to_owned(),
    };
    let word = (names.resource)(&program.buffers[usize::from(access.address.buffer)], access.address.word);
    let value = |value: u64| (names.value)(value);
    let observed = match reply {
        Reply::Done(observed) | Reply::Failed(observed) => observed,
        Reply::Stop if access.operation == Operation::Store => {
            return format!("writes {} to {word}", value(access.value));
        }
        Reply::Stop if access.writes() => return format!("changes {word}"),
        Reply::Stop => return format!("reads {word}"),
    };
    match access.operation {
        Operation::Load if choice > 0 => format!("reads {word}: still {}", value(observed)),
        Operation::Load => format!("reads {word}: {}", value(observed)),
        Operation::Store if choice > 0 => {
            format!("writes {} to {word}, overtaken by a later write", value(access.value))
        }
        Operation::Store => format!("writes {} to {word}", value(access.value)),
        Operation::Atomic(function) => {
            let action = match function {
                Atomic::Exchange => format!("exchanges {word} for {}", value(access.value)),
                Atomic::CompareExchange => {
                    format!("exchanges {word} for {} if it is {}", value(access.value), value(access.expected))
                }
                other => format!("atomic {} of {} on {word}", function_name(other), value(access.value)),
            };
            match reply {
                Reply::Failed(_) => format!("{action}: it is, but the weak exchange fails"),
                _ => format!("{action}: it was {}", value(observed)),
            }
        }
    }
}

fn function_name(function: Atomic) -> String {
    format!("{function:?}").to_lowercase()
}

/// Returns the line of a template or of the user's source that an instruction comes from. Generated accessors are skipped.
pub(crate) fn code_location(program: &Bytecode, at: u32, source: &CheckedSource) -> String {
    let lines = program.trace(at).into_iter().map(|span| span.location(&source.text).line_number as usize);
    let lines: Vec<usize> = lines.collect();
    if let Some(location) = source.lines.location(&lines) {
        return location;
    }
    let file = if source.file.is_empty() { "generated" } else { &source.file };
    lines.first().map_or_else(String::new, |line| format!("{file}:{line}"))
}

/// Describes what went wrong.
fn violation(kind: &FailureKind, context: &SearchContext<'_>, source: &CheckedSource, race: Option<&Race>) -> String {
    match kind {
        FailureKind::FinalState(text) => text.clone(),
        FailureKind::Instant(text) => format!("at this instant, {text}"),
        FailureKind::Deadlock(fragments) => match &fragments[..] {
            [one] => format!("deadlock: {} waits for a value that no other fragment can change", letter(*one)),
            _ => format!("deadlock: {} wait, and none of them can change what another waits for", letters(fragments)),
        },
        FailureKind::Livelock(fragments) => match &fragments[..] {
            [one] => format!("livelock: {} can take steps for ever, but cannot end in any order of them", letter(*one)),
            _ => {
                format!("livelock: {} can take steps for ever, but in no order can all of them end", letters(fragments))
            }
        },
        FailureKind::Step(fragment, StepError::DataRace(other, _)) => {
            let (one, other) = (letter(*other), letter(*fragment));
            let places = race.map_or(format!(": {one} and {other} access the same word"), |race| {
                let access = |step: &ScheduleStep| format!("{} {} at {}", step.fragment, step.action, step.location);
                format!(" on {}: {}, and {}", race.word, access(&race.first), access(&race.second))
            });
            format!("data race{places}. They are not both atomic, and nothing orders them")
        }
        FailureKind::Step(fragment, error) => step_violation(context, *fragment, *error, source),
    }
}

/// Describes an error of one fragment.
pub(crate) fn step_violation(
    context: &SearchContext<'_>,
    fragment: usize,
    error: StepError,
    source: &CheckedSource,
) -> String {
    let fragment = letter(fragment);
    match error {
        StepError::OutOfBounds(at) => {
            format!("{fragment} accesses an index out of bounds at {}", code_location(context.program, at, source))
        }
        StepError::Endless => {
            format!("{fragment} loops without end, and no memory that it reads in the loop can change")
        }
        StepError::TooLong => format!("{fragment} loops for very long without accessing memory"),
        StepError::Barrier { waits, at, missing } => format!(
            "divergent barrier: {} waits at {}, and {} of its workgroup does not reach this barrier",
            letter(waits),
            code_location(context.program, at, source),
            letter(missing)
        ),
        StepError::DataRace(other, _) => format!("data race: {} and {fragment} access the same word", letter(other)),
    }
}

/// Returns the names of fragments: `A, B and C`.
fn letters(fragments: &[usize]) -> String {
    let letters: Vec<String> = fragments.iter().map(|one| letter(*one)).collect();
    match letters.split_last() {
        Some((last, before)) if !before.is_empty() => format!("{} and {last}", before.join(", ")),
        _ => letters.concat(),
    }
}

/// Returns the schedule of a failure in one iteration of a case: the iterations before it, and its own steps.
pub(crate) fn schedule(run: &CaseRun<'_>, iteration: usize, failure: &Failure) -> Schedule {
    let setup = &run.setup;
    let source = &setup.runnable().source;
    let resource = |buffer: &Buffer, word: u32| resource_name(setup, memory_index(buffer.binding), word);
    let value = |value: u64| value_name(setup, value);
    let names = Names { resource: &resource, value: &value };
    let mut chain = vec![(iteration, failure.clone())];
    while let Some((before, taken)) = chain.last().and_then(|(at, _)| run.iterations[*at].before.clone()) {
        chain.push((before, Failure { steps: taken, kind: failure.kind.clone() }));
    }
    let (mut all, mut last) = (Vec::new(), None);
    for (at, failure) in chain.iter().rev() {
        let iteration = &run.iterations[*at];
        match &iteration.first {
            Ok(first) => {
                let part = failing_schedule(&iteration.context, first, failure, source, &names);
                all.extend(part.steps.clone());
                last = Some(part);
            }
            Err((fragment, error)) => {
                let violation = step_violation(&iteration.context, *fragment, *error, source);
                last = Some(Schedule { violation, ..Schedule::default() });
            }
        }
    }
    let Schedule { violation, race, .. } = last.unwrap_or_default();
    let words = |words: &[u32]| words.iter().map(|word| format!("{word:08x}")).collect::<Vec<_>>().join(" ");
    let drawn = if chain.len() > 1 { format!(", drawn {} times", chain.len()) } else { String::new() };
    Schedule {
        case: format!("{}{drawn}", setup.case.description),
        fragments: setup.case.new.iter().enumerate().map(|(at, new)| (letter(at), words(&new.words))).collect(),
        initial_fragments: setup.case.prior.iter().map(|prior| words(&prior.words)).collect(),
        steps: all,
        violation,
        race,
    }
}

/// Returns the name of a word, such as `keys[slot 0, pixel 1]`.
fn resource_name(setup: &CaseSetup<'_>, memory: usize, word: u32) -> String {
    let plan = &setup.subject.plan;
    let index = memory.checked_sub(FIRST_BINDING as usize);
    let Some(planned) = index.and_then(|index| plan.resources.get(index)) else {
        return format!("binding {memory}, word {word}");
    };
    if planned.resource.name == COUNTERS_RESOURCE {
        return COUNTERS
            .get(word as usize)
            .map_or_else(|| format!("counter {word}"), |(name, _, _)| format!("the counter {name}"));
    }
    let mut fields: Vec<&str> = plan.layout.values.iter().map(|word| word.field.as_str()).collect();
    match planned.resource.element {
        Element::Entry => fields.insert(0, "key"),
        Element::Value => {}
        _ => fields.clear(),
    }
    let width = fields.len().max(1) as u32;
    let mut element = word / width;
    let mut parts = Vec::new();
    for (extent, length) in planned.resource.extents.iter().zip(&planned.lengths).rev() {
        let length = setup.case.pool.values.word(length, &extent.name).unwrap_or(u32::MAX).max(1);
        parts.push(format!("{} {}", extent.name, element % length));
        element /= length;
    }
    parts.reverse();
    let field = fields.get((word % width) as usize).map_or(String::new(), |field| format!(".{field}"));
    let index = if parts.is_empty() { String::new() } else { format!("[{}]", parts.join(", ")) };
    format!("{}{index}{field}", planned.resource.name)
}

/// Prints a value, with the fragment that it belongs to.
fn value_name(setup: &CaseSetup<'_>, value: u64) -> String {
    let layout = &setup.subject.plan.layout;
    let fields: Vec<&str> =
        std::iter::once("key").chain(layout.values.iter().map(|word| word.field.as_str())).collect();
    let prior = (1..).zip(&setup.case.prior).map(|(number, fragment)| (format!("{number}"), fragment));
    let new = setup.case.new.iter().enumerate().map(|(at, fragment)| (letter(at), fragment));
    for (name, fragment) in new.chain(prior) {
        if let Some(at) = fragment.words.iter().position(|word| u64::from(*word) == value) {
            return format!("{value:08x} ({name}'s {})", fields.get(at).copied().unwrap_or("word"));
        }
    }
    match value {
        0..=4096 => value.to_string(),
        _ => format!("{value:08x}"),
    }
}
