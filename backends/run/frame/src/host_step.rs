//! Host steps: the words that a host function reads, and the symbols that it sets.

use fragbuf_codegen::{Action, Decision, Plan, Range};
use fragbuf_templates::vocabulary::HostCall;

use crate::memory::buffer_bytes;
use crate::step::{HostRead, WordRange};
use crate::{Error, Values};

/// Returns the host step of a command.
pub(crate) fn decision(plan: &Plan, command: usize) -> Option<&Decision> {
    match &plan.frame.commands.get(command)?.action {
        Action::Host(decision) => Some(decision),
        _ => None,
    }
}

/// Returns the words that a host step reads, in physical resources.
pub(crate) fn word_ranges(
    plan: &Plan,
    values: &Values,
    decision: &Decision,
    flipped: u32,
) -> Result<Vec<WordRange>, Error> {
    let word_range = |range: &Range| {
        let what = format!("the words that the host function `{}` reads", decision.name);
        let (first, count) = (values.evaluate(&range.first, &what)?, values.evaluate(&range.count, &what)?);
        let planned = &plan.resources[range.resource.0];
        let limit = values.evaluate(&planned.words, &what)?;
        if first.saturating_add(count) > limit {
            return Err(Error::BadValue {
                name: format!(
                    "what the host function `{}` reads of `{}`, words {first} to {},",
                    decision.name,
                    planned.resource.name,
                    first.saturating_add(count) - 1
                ),
                expected: format!("within its {limit} words"),
            });
        }
        Ok(WordRange { resource: plan.frame.physical(range.resource, flipped), first, count })
    };
    decision.reads.iter().map(word_range).collect()
}

/// Runs a host step that a frame did not wait for, with the words that the frame has read for it, and sets the symbols that it decides.
/// Missing words count as 0. An error leaves the values unchanged.
pub fn decide(plan: &Plan, read: &HostRead, words: &[u32], values: &mut Values) -> Result<(), Error> {
    match decision(plan, read.command) {
        Some(decision) => apply(plan, decision, (words, &read.ranges), values),
        None => Ok(()),
    }
}

/// Calls a host function and sets the symbols that it decides. Missing words count as 0.
pub(crate) fn apply(
    plan: &Plan,
    decision: &Decision,
    (words, ranges): (&[u32], &[WordRange]),
    values: &mut Values,
) -> Result<(), Error> {
    let mut padded = words.to_vec();
    padded.resize(ranges.iter().map(|range| range.count as usize).sum(), 0);
    let (mut reads, mut rest) = (Vec::new(), padded.as_slice());
    for range in ranges {
        let (read, behind) = rest.split_at(range.count as usize);
        reads.push(read);
        rest = behind;
    }
    let bytes = |assumed: &[(&str, u64)]| {
        let known = assumed.iter().filter_map(|(name, value)| Some((plan.symbols.find(name)?, *value)));
        let values = known.fold(values.clone(), |values, (id, value)| values.with(id, value));
        buffer_bytes(plan, &values).ok()
    };
    let call = HostCall { reads, symbol: &|name| values.named(name), bytes: &bytes };
    let results =
        (decision.function.0)(&call).map_err(|message| Error::Host { function: decision.name.to_string(), message })?;
    let decided = || decision.sets.iter().zip(&results);
    for (id, &value) in decided() {
        let symbol = plan.symbols.get(*id);
        let (least, most) = symbol.range;
        if !(least..=most).contains(&value) {
            return Err(Error::BadValue {
                name: format!("`{}`, which the host function `{}` sets to {value},", symbol.name, decision.name),
                expected: format!("from {least} to {most}"),
            });
        }
    }
    // All symbols are set or none: after an error the values are unchanged.
    decided().for_each(|(id, value)| values.set(*id, *value));
    Ok(())
}
