//! Partial-order reduction of the relaxed model: steps that can come first without losing a behaviour.
//!
//! Input: a state. Output: a fragment whose next step may be followed alone, before the steps of all others. Then the other
//! orders of that step need not be explored. These steps can come first:
//!
//! * A fence: it changes the views of its fragment only.
//! * The end of a critical section: it changes the views of its fragment only, and lets others enter, which they can do in no
//!   earlier state.
//! * A plain access: it observes and follows the last write. A conflicting access that is not ordered by happens-before is a
//!   data race in either order.
//! * An atomic store: no load has to observe it, and every store and read-modify-write can still take the positions before it
//!   in modification order that it could take without it.
//!
//! Atomic loads and read-modify-writes cannot come first, because they may observe writes that other fragments execute later.
//! Nor can a store of a word that the property observes at every instant: memory between two such stores depends on their order.

use fragbuf_interpreter::{Event, Operation};

use crate::context::SearchContext;
use crate::model::Model;
use crate::state::{State, Status};
use crate::watched::WatchedWords;

/// Returns a fragment whose next step can come first, and whether that step is in a loop.
pub(crate) fn independent(
    context: &SearchContext<'_>,
    watched: &WatchedWords,
    state: &State,
    running: &[usize],
) -> Option<(usize, bool)> {
    if context.model != Model::Relaxed || !context.is_reduced {
        return None;
    }
    running.iter().find_map(|&fragment| match &state.fragments[fragment] {
        Status::Before { stop, .. }
            if comes_first(context, watched, &stop.event, fragment) && !may_forget(context, state, &stop.event) =>
        {
            Some((fragment, context.program.is_in_loop(stop.at)))
        }
        _ => None,
    })
}

/// Returns whether a step may remove writes that others can still observe, so that its order matters.
fn may_forget(context: &SearchContext<'_>, state: &State, event: &Event) -> bool {
    let Event::Access(access) = event else { return false };
    access.is_atomic
        && access.operation == Operation::Store
        && context.word(access.address).is_some_and(|word| state.may_forget(word, access.value))
}

fn comes_first(context: &SearchContext<'_>, watched: &WatchedWords, event: &Event, fragment: usize) -> bool {
    // A helper invocation observes what memory holds at the time, so the order of all writes matters to it.
    let writes_first = context.helper.is_none();
    match event {
        Event::Fence => true,
        _ if context.helper == Some(fragment) => false,
        Event::CriticalEnd => true,
        Event::Access(access) => match access.operation {
            Operation::Load => !access.is_atomic,
            Operation::Store => writes_first && !watched.contains(context, access),
            Operation::Atomic(_) => false,
        },
        Event::CriticalBegin | Event::Barrier(_) => false,
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test fails by panicking")]
mod tests;
