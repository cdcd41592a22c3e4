//! The way of a frame through its slices, a cursor for each.
//!
//! In: where a frame stands. Out: the turns up to where the host must read something, or to the end. Nothing is recorded
//! here, and what can fail has failed before anything is.

use fragbuf_codegen::{Plan, PlannedPass, ResourceId};
use fragbuf_frame::{Cursor, Looped, Question, Turn, Values, unsupported};
use fragbuf_templates::vocabulary::{Access, Kind};

use crate::{Error, Renderer};

/// Where a frame stands.
#[derive(Clone, Debug)]
pub(crate) struct Place {
    slice: u32,
    pub(crate) cursor: Cursor,
    /// How the loops of finished slices have ended.
    pub(crate) loops: Vec<Looped>,
    /// The exchanges that are flipped once the frame is over.
    pub(crate) flipped: u32,
}

/// What is recorded at once.
pub(crate) struct Segment {
    pub(crate) parts: Vec<Part>,
    /// What the host must read after it; `None`: the frame is whole.
    pub(crate) question: Option<Question>,
    /// Where the frame stands then.
    pub(crate) end: Place,
}

/// One thing to record.
pub(crate) enum Part {
    /// A turn of a slice.
    Turn {
        slice: u32,
        turn: Turn,
        /// Workgroups of a compute pass; nothing for any other turn.
        groups: [u32; 3],
        /// The stencil's reference of a pass that has one.
        reference: u32,
    },
    /// A slice is whole.
    SliceEnd(u32),
}

impl Place {
    /// At the beginning of a frame.
    pub(crate) fn new(renderer: &Renderer) -> Self {
        let flipped = renderer.flipped();
        let cursor = Cursor::new(renderer.plan(), renderer.counting, flipped);
        Place { slice: 0, cursor, loops: Vec::new(), flipped }
    }

    fn next_slice(&mut self, renderer: &Renderer) {
        self.flipped = self.cursor.flipped(renderer.plan());
        self.cursor.loops().iter().for_each(|looped| looped.clone().note(&mut self.loops));
        self.slice += 1;
        self.cursor = Cursor::new(renderer.plan(), renderer.counting, renderer.flipped());
    }
}

/// The parts from `place` on, up to a question or to the end.
pub(crate) fn segment(renderer: &Renderer, mut place: Place) -> Result<Segment, Error> {
    let (plan, live) = (renderer.plan(), renderer.live());
    let mut parts = Vec::new();
    while place.slice < renderer.slices() {
        let slice = place.slice;
        let (mut groups, mut reference) = ([0; 3], 0);
        match place.cursor.next(plan, &live)? {
            None => {
                parts.push(Part::SliceEnd(slice));
                place.next_slice(renderer);
                continue;
            }
            Some(Turn::Ask(question)) => return Ok(Segment { parts, question: Some(question), end: place }),
            Some(turn) => {
                if let Turn::Pass(run) = turn {
                    let pass = &plan.passes[run.pass.0];
                    let values = live.in_iteration(run.iteration);
                    check_arguments(renderer, pass, run.flipped)?;
                    groups = workgroups(renderer, pass, &values)?;
                    if let Some(formula) = &pass.reference {
                        reference = values.word(formula, "the stencil's reference of a pass")?;
                    }
                }
                parts.push(Part::Turn { slice, turn, groups, reference });
            }
        }
    }
    Ok(Segment { parts, question: None, end: place })
}

/// Whether the buffer that says what a pass draws or dispatches, if there is one, holds that.
fn check_arguments(renderer: &Renderer, pass: &PlannedPass, flipped: u32) -> Result<(), Error> {
    let Some(id) = arguments(renderer.plan(), pass, flipped) else { return Ok(()) };
    let needed = if matches!(pass.kind, Kind::Compute { .. }) { 3 } else { 4 };
    let words = renderer.sized.memory.filled(id.0).map_or(0, |buffer| buffer.size() / 4);
    if words < needed {
        let name = &renderer.plan().resources[id.0].resource.name;
        return Err(unsupported(format!("`{name}` as arguments: it has {words} words, and needs {needed}")).into());
    }
    Ok(())
}

/// The resource that says what a pass draws or dispatches, where there is one.
pub(crate) fn arguments(plan: &Plan, pass: &PlannedPass, flipped: u32) -> Option<ResourceId> {
    let usage = pass.uses.iter().find(|usage| usage.access == Access::Indirect)?;
    Some(plan.frame.physical(plan.resource_id(&usage.resource)?, flipped))
}

fn workgroups(renderer: &Renderer, pass: &PlannedPass, values: &Values) -> Result<[u32; 3], Error> {
    let mut counts = [0; 3];
    if pass.uses.iter().any(|usage| usage.access == Access::Indirect) {
        return Ok(counts);
    }
    let what = format!("pass `{}`", pass.anchor);
    let limit = renderer.device.limits().max_compute_workgroups_per_dimension;
    for (count, groups) in counts.iter_mut().zip(&pass.groups) {
        let needed = values.evaluate(groups, &what)?;
        *count = u32::try_from(needed).ok().filter(|count| *count <= limit).ok_or_else(|| Error::TooLarge {
            what: format!("{what}, in workgroups,"),
            needed,
            limit: limit.into(),
            limit_name: "max_compute_workgroups_per_dimension",
            hint: "take a smaller frame",
        })?;
    }
    Ok(counts)
}
