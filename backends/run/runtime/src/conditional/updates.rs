//! The updates of a plan's loops and queries, as words for the compute pass.

use fragbuf_codegen::{Action, LoopId, LoopUntil, PassId, Plan};
use fragbuf_frame::{Condition, first_of_query};
use fragbuf_templates::vocabulary::Objects;

/// The bytes from one update to the next in the uniform buffer.
pub(crate) const STRIDE: u64 = 256;

/// An update that the steps of a frame may request.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Update {
    Begin { id: LoopId, around: Option<LoopId> },
    End { id: LoopId, until: LoopUntil, is_last: bool },
    Objects { query: PassId, around: Option<LoopId> },
}

/// Returns every update that a frame of the plan may request.
pub(crate) fn updates(plan: &Plan) -> Vec<Update> {
    let (mut updates, mut around) = (Vec::new(), Vec::new());
    let until = |id: &LoopId| plan.frame.loops[id.0].until;
    for command in &plan.frame.commands {
        match &command.action {
            Action::Loop(id) if until(id) != LoopUntil::Times => {
                updates.push(Update::Begin { id: *id, around: around.last().copied() });
                around.push(*id);
            }
            Action::LoopEnd(id) if until(id) != LoopUntil::Times => {
                around.pop();
                updates.extend([false, true].map(|is_last| Update::End { id: *id, until: until(id), is_last }));
            }
            Action::Pass(pass) if plan.passes[pass.0].objects == Objects::Boxes => {
                let query = first_of_query(plan, *pass);
                updates.push(Update::Objects { query, around: around.last().copied() });
            }
            _ => {}
        }
    }
    updates
}

impl Update {
    /// Whether a step requests this update.
    pub(crate) fn is_of(&self, condition: &Condition) -> bool {
        match (*self, *condition) {
            (Update::Begin { id, around }, Condition::Begin { id: of, around: outer }) => (id, around) == (of, outer),
            (Update::End { id, is_last, .. }, Condition::End { id: of, is_last: last, .. }) => {
                (id, is_last) == (of, last)
            }
            (Update::Objects { query, around }, Condition::Objects { pass, around: outer }) => {
                (query, around) == (pass, outer)
            }
            _ => false,
        }
    }

    /// Returns the words of `Update` in `conditions.wgsl`. `sizes`: the numbers of loops, queries, objects and draws.
    pub(crate) fn words(&self, queries: &[PassId], sizes: [u32; 4]) -> [u32; 12] {
        let number = |id: Option<LoopId>| id.map_or(u32::MAX, |id| id.0 as u32);
        let [kind, written, around, tested, is_last, query] = match *self {
            Update::Begin { id, around } => [0, number(Some(id)), number(around), 0, 0, 0],
            Update::End { id, until, is_last } => {
                let tested = if matches!(until, LoopUntil::NoSamples(_)) { 2 } else { 1 };
                [1, number(Some(id)), u32::MAX, tested, u32::from(is_last), 0]
            }
            Update::Objects { query, around } => {
                let query = queries.iter().position(|known| *known == query).unwrap_or_default();
                [2, number(around), number(around), 0, 0, query as u32]
            }
        };
        let [loops, boxes, objects, draws] = sizes;
        [kind, written, around, tested, is_last, query, loops, boxes, objects, draws, 0, 0]
    }
}
