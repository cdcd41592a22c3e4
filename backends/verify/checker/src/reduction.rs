//! Partial-order reduction of the relaxed model: steps that can come first without losing a behaviour.
//!
//! Input: a state. Output: a fragment whose next step may be followed alone, before the steps of all others. Then the other
//! orders of that step need not be explored. Three kinds of steps can come first:
//!
//! * A fence, and the end of a critical section: they change the views of their fragment only, and disable no other step.
//! * A plain access: it observes and follows the last write. A conflicting access that is not ordered by happens-before is a
//!   data race in either order.
//! * An atomic store: no load has to observe it, and every store and read-modify-write can still take the positions before it
//!   in modification order that it could take without it.
//!
//! Atomic loads and read-modify-writes cannot come first, because they may observe writes that other fragments execute later.

use fragbuf_interpreter::{Event, Operation};

use crate::context::SearchContext;
use crate::model::Model;
use crate::state::{State, Status};

/// Returns a fragment whose next step can come first, and whether that step is in a loop.
pub(crate) fn independent(context: &SearchContext<'_>, state: &State, running: &[usize]) -> Option<(usize, bool)> {
    if context.model != Model::Relaxed || !context.is_reduced {
        return None;
    }
    running.iter().find_map(|&fragment| match &state.fragments[fragment] {
        Status::Before { event, at, .. } if comes_first(context, event, fragment) => {
            Some((fragment, context.program.is_in_loop(*at)))
        }
        _ => None,
    })
}

fn comes_first(context: &SearchContext<'_>, event: &Event, fragment: usize) -> bool {
    // A helper invocation observes what memory holds at the time, so the order of all writes matters to it.
    let writes_first = context.helper.is_none();
    match event {
        Event::Fence => true,
        _ if context.helper == Some(fragment) => false,
        Event::CriticalEnd => true,
        Event::Access(access) => match access.operation {
            Operation::Load => !access.is_atomic,
            Operation::Store => writes_first,
            Operation::Atomic(_) => false,
        },
        Event::CriticalBegin | Event::Barrier => false,
    }
}
