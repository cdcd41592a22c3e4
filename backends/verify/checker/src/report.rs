//! What a check says: verdicts, and a failure's schedule as a person can follow it.
//!
//! In: steps of a search. Out: one line per step, with the fragment, what it did to which word, and the line of the
//! template that did it. Plain data; how it is drawn is the command line's affair.

use fragbuf_codegen::{FIRST_BINDING, LineOrigin};
use fragbuf_interpreter::{Atomic, Event, Machine, Operation, Program};
use fragbuf_templates::COUNTERS;
use fragbuf_templates::vocabulary::Element;

use crate::explore::{Failure, What};
use crate::state::{Ground, Mishap, Status};
use crate::subject::{Source, Subject};
use crate::trial::Trial;

/// A failure, step by step.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Schedule {
    /// The case: what is there before, and how the new fragments lie to it.
    pub case: String,
    /// The fragments that come at once, as (name, words).
    pub fragments: Vec<(String, String)>,
    /// What is there before, in the order of arrival.
    pub prior: Vec<String>,
    /// The steps.
    pub steps: Vec<Line>,
    /// What is wrong after the last.
    pub fault: String,
}

/// One step.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Line {
    /// The fragment's name: A, B, …
    pub fragment: String,
    /// What it does.
    pub action: String,
    /// The template, the description or the text, and the line.
    pub place: String,
}

/// Names of memory and of values, for one trial.
pub(crate) struct Names<'a> {
    pub(crate) resource: &'a dyn Fn(usize, u32) -> String,
    pub(crate) value: &'a dyn Fn(u64) -> String,
}

/// The steps of a failure, run again and written down.
pub(crate) fn lines(
    ground: &Ground<'_>,
    first: &crate::state::State,
    failure: &Failure,
    source: &Source,
    names: &Names<'_>,
) -> Vec<Line> {
    let mut machine = Machine::new(ground.program);
    let mut state = first.clone();
    let mut lines = Vec::new();
    for (fragment, choice) in &failure.steps {
        let Status::Before { event, at, .. } = state.fragments[*fragment].clone() else { break };
        let stepped = ground.step(&mut machine, &state, *fragment, *choice);
        let (seen, next) = match stepped {
            Ok((next, seen)) => (seen, Some(next)),
            Err(_) => (0, None),
        };
        let is_helper = ground.helper == Some(*fragment);
        let mut action = said(&event, seen, *choice, ground.program, names);
        if is_helper && !matches!(event, Event::Access(access) if !access.writes()) {
            action.push_str(", without effect: a helper invocation");
        }
        lines.push(Line { fragment: letter(*fragment), action, place: place(ground.program, at, source) });
        match next {
            Some(next) => state = next,
            None => break,
        }
    }
    lines
}

/// A, B, C, …
pub(crate) fn letter(fragment: usize) -> String {
    char::from_u32('A' as u32 + fragment as u32).map_or_else(|| fragment.to_string(), String::from)
}

fn said(event: &Event, seen: u64, choice: u32, program: &Program, names: &Names<'_>) -> String {
    let access = match event {
        Event::Access(access) => access,
        Event::Fence => return "fence".to_owned(),
        Event::CriticalBegin => return "enters the critical section".to_owned(),
        Event::CriticalEnd => return "leaves the critical section".to_owned(),
        Event::Barrier => return "barrier".to_owned(),
    };
    let memory = Subject::memory_of(program.buffers[usize::from(access.place.buffer)].binding);
    let place = (names.resource)(memory, access.place.word);
    let value = |value: u64| (names.value)(value);
    match access.operation {
        Operation::Load if choice > 0 => format!("reads {place}: still {}", value(seen)),
        Operation::Load => format!("reads {place}: {}", value(seen)),
        Operation::Store if choice > 0 => {
            format!("writes {} to {place}, overtaken by a later write", value(access.value))
        }
        Operation::Store => format!("writes {} to {place}", value(access.value)),
        Operation::Atomic(function) => {
            let what = match function {
                Atomic::Exchange => format!("exchanges {place} for {}", value(access.value)),
                Atomic::CompareExchange => {
                    format!("exchanges {place} for {} if it is {}", value(access.value), value(access.expected))
                }
                other => format!("atomic {} of {} on {place}", word(other), value(access.value)),
            };
            format!("{what}: it was {}", value(seen))
        }
    }
}

fn word(function: Atomic) -> String {
    format!("{function:?}").to_lowercase()
}

/// The line of a template or of the user's that an instruction comes from; generated accessors are passed over.
pub(crate) fn place(program: &Program, at: u32, source: &Source) -> String {
    let lines = program.trace(at).into_iter().map(|span| span.location(&source.text).line_number as usize);
    let lines: Vec<usize> = lines.collect();
    for line in &lines {
        match source.lines.origin(*line) {
            LineOrigin::Source { name, line } if !name.starts_with("generated/") => return format!("{name}:{line}"),
            LineOrigin::User(origin) => return origin.to_string(),
            _ => {}
        }
    }
    let file = if source.file.is_empty() { "generated" } else { &source.file };
    lines.first().map_or_else(String::new, |line| format!("{file}:{line}"))
}

/// What went wrong, in words.
pub(crate) fn fault(what: &What, ground: &Ground<'_>, source: &Source) -> String {
    match what {
        What::Outcome(text) => text.clone(),
        What::Instant(text) => format!("at this instant {text}"),
        What::Race(one, other) => format!(
            "a data race: {} and {} are about to touch the same word, one of them writes, and not both by atomic operations",
            letter(*one),
            letter(*other)
        ),
        What::Waiting(fragments) => {
            let names: Vec<String> = fragments.iter().map(|fragment| letter(*fragment)).collect();
            format!("{} waits for ever: nobody is left to change what it waits for", names.join(", "))
        }
        What::Circling(fragments) => {
            let names: Vec<String> = fragments.iter().map(|fragment| letter(*fragment)).collect();
            format!("from here no order of steps lets all of {} end: they go round for ever", names.join(", "))
        }
        What::Mishap(fragment, mishap) => {
            let what = match mishap {
                Mishap::OutOfBounds(at) => format!("goes out of bounds at {}", place(ground.program, *at, source)),
                Mishap::Endless => "goes round for ever without touching memory".to_owned(),
                Mishap::Barrier => "waits at a barrier".to_owned(),
            };
            format!("{} {what}", letter(*fragment))
        }
    }
}

/// The schedule of a failure in one round of a trial: the rounds before it, and its own steps.
pub(crate) fn schedule(trial: &Trial<'_>, round: usize, failure: &Failure) -> Schedule {
    let subject = trial.subject;
    let source = &subject.passes[trial.case.pass].source;
    let resource = |memory: usize, word: u32| resource(subject, &trial.case, memory, word);
    let value = |value: u64| value_name(trial, value);
    let names = Names { resource: &resource, value: &value };
    let mut steps = Vec::new();
    let mut chain = vec![(round, failure.clone())];
    while let Some((before, taken)) = chain.last().and_then(|(round, _)| trial.rounds[*round].before.clone()) {
        chain.push((before, Failure { steps: taken, what: failure.what.clone() }));
    }
    for (round, failure) in chain.iter().rev() {
        let round = &trial.rounds[*round];
        if let Ok(first) = &round.first {
            steps.extend(lines(&round.ground, first, failure, source, &names));
        }
    }
    let words = |words: &[u32]| words.iter().map(|word| format!("{word:08x}")).collect::<Vec<_>>().join(" ");
    let rounds = if chain.len() > 1 { format!(", drawn {} times", chain.len()) } else { String::new() };
    Schedule {
        case: format!("{}{rounds}", trial.case.what),
        fragments: trial.case.new.iter().enumerate().map(|(at, new)| (letter(at), words(&new.words))).collect(),
        prior: trial.case.prior.iter().map(|prior| words(&prior.words)).collect(),
        steps,
        fault: fault(&failure.what, &trial.rounds[round].ground, source),
    }
}

/// `keys[slot 0, pixel 1]`
fn resource(subject: &Subject, case: &crate::case::Case, memory: usize, word: u32) -> String {
    let index = memory.checked_sub(FIRST_BINDING as usize);
    let Some(planned) = index.and_then(|index| subject.plan.resources.get(index)) else {
        return format!("binding {memory}, word {word}");
    };
    if planned.resource.name == "counters" {
        return COUNTERS
            .get(word as usize)
            .map_or_else(|| format!("counter {word}"), |(name, _, _)| format!("the counter {name}"));
    }
    let layout = &subject.plan.layout;
    let mut fields: Vec<&str> = layout.beside.iter().map(|word| word.field.as_str()).collect();
    match planned.resource.element {
        Element::Entry => fields.insert(0, "key"),
        Element::Beside => {}
        _ => fields.clear(),
    }
    let width = fields.len().max(1) as u32;
    let mut element = word / width;
    let mut parts = Vec::new();
    for (extent, length) in planned.resource.extents.iter().zip(&planned.lengths).rev() {
        let length = case.room.values.word(length, &extent.name).unwrap_or(u32::MAX).max(1);
        parts.push(format!("{} {}", extent.name, element % length));
        element /= length;
    }
    parts.reverse();
    let field = fields.get((word % width) as usize).map_or(String::new(), |field| format!(".{field}"));
    let index = if parts.is_empty() { String::new() } else { format!("[{}]", parts.join(", ")) };
    format!("{}{index}{field}", planned.resource.name)
}

/// A value, and whose it is.
fn value_name(trial: &Trial<'_>, value: u64) -> String {
    let layout = &trial.subject.plan.layout;
    let fields: Vec<&str> =
        std::iter::once("key").chain(layout.beside.iter().map(|word| word.field.as_str())).collect();
    let prior = (1..).zip(&trial.case.prior).map(|(number, fragment)| (format!("{number}"), fragment));
    let new = trial.case.new.iter().enumerate().map(|(at, fragment)| (letter(at), fragment));
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
