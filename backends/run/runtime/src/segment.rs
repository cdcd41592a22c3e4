//! Advances a frame through its slices, with one [`Cursor`] per slice.
//!
//! Input: a position in a frame. Output: the actions up to the next wait for the host, or to the end. This module records nothing,
//! and all errors occur here, before anything is recorded.

use fragbuf_codegen::{Plan, PlannedPass, ResourceId};
use fragbuf_frame::{Conditions, Cursor, FrameStep, HostWait, LoopReport, Readbacks, Values, unsupported};
use fragbuf_templates::vocabulary::{Access, Kind};

use crate::Error;
use crate::memory::Memory;

/// The inputs of a frame's steps, which stay the same within a segment.
pub(crate) struct FrameInputs<'a> {
    pub(crate) plan: &'a Plan,
    pub(crate) values: Values,
    pub(crate) memory: &'a Memory,
    pub(crate) readbacks: Readbacks,
    pub(crate) conditions: Conditions,
    /// The exchanges that the previous frame left flipped.
    pub(crate) flipped: u32,
    /// The device's limit on workgroups per dimension.
    pub(crate) max_workgroups: u32,
}

/// The position of a frame in its actions: slice, next action and loop iteration.
#[derive(Clone, Debug)]
pub(crate) struct FrameCursor {
    pub(crate) slice: u32,
    pub(crate) cursor: Cursor,
    /// Reports on the loops of finished slices.
    pub(crate) loops: Vec<LoopReport>,
    /// The exchanges that are flipped at the end of the frame.
    pub(crate) flipped: u32,
}

/// The actions that are recorded without an intermediate readback.
pub(crate) struct Segment {
    pub(crate) parts: Vec<SegmentPart>,
    /// The words that the host must supply after the segment; `None` at the end of the frame.
    pub(crate) wait: Option<HostWait>,
    /// The position after the segment.
    pub(crate) end: FrameCursor,
}

/// One part of a segment.
pub(crate) enum SegmentPart {
    Action(ActionRun),
    /// The end of a slice.
    SliceEnd(u32),
}

/// One run of an action in a slice.
pub(crate) struct ActionRun {
    pub(crate) slice: u32,
    pub(crate) step: FrameStep,
    /// The workgroups of a compute pass; 0 for any other step.
    pub(crate) groups: [u32; 3],
    /// The stencil reference of a pass that has one.
    pub(crate) reference: u32,
}

impl FrameCursor {
    /// Returns the beginning of a frame.
    pub(crate) fn new(plan: &Plan, readbacks: Readbacks, conditions: Conditions, flipped: u32) -> Self {
        let cursor = Cursor::new(plan, readbacks, flipped).with_conditions(conditions);
        FrameCursor { slice: 0, cursor, loops: Vec::new(), flipped }
    }

    fn next_slice(&mut self, inputs: &FrameInputs<'_>) {
        self.flipped = self.cursor.flipped(inputs.plan);
        self.cursor.loops().iter().for_each(|looped| looped.clone().merge_into(&mut self.loops));
        self.slice += 1;
        self.cursor = Cursor::new(inputs.plan, inputs.readbacks, inputs.flipped).with_conditions(inputs.conditions);
    }
}

/// Returns the parts from `position` up to the next wait, or to the end.
pub(crate) fn segment(inputs: &FrameInputs<'_>, mut position: FrameCursor) -> Result<Segment, Error> {
    let mut parts = Vec::new();
    while position.slice < inputs.values.slices() {
        let slice = position.slice;
        match position.cursor.next(inputs.plan, &inputs.values)? {
            None => {
                parts.push(SegmentPart::SliceEnd(slice));
                position.next_slice(inputs);
            }
            Some(FrameStep::Wait(wait)) => return Ok(Segment { parts, wait: Some(wait), end: position }),
            Some(step) => parts.push(SegmentPart::Action(action_run(inputs, slice, step)?)),
        }
    }
    Ok(Segment { parts, wait: None, end: position })
}

fn action_run(inputs: &FrameInputs<'_>, slice: u32, step: FrameStep) -> Result<ActionRun, Error> {
    let (mut groups, mut reference) = ([0; 3], 0);
    if let FrameStep::Pass(run) = step {
        let pass = &inputs.plan.passes[run.pass.0];
        let values = inputs.values.in_iteration(run.iteration);
        check_arguments(inputs, pass, run.flipped)?;
        groups = workgroups(inputs, pass, &values)?;
        if run.conditional.is_some() && groups[2] > 1 {
            let what = format!(
                "`{}`, a pass with workgroups in three dimensions, in a loop that ends on the device",
                pass.name
            );
            return Err(Error::Unsupported { what, help: "use `Conditions::OnHost`".to_owned() });
        }
        if let Some(formula) = &pass.reference {
            reference = values.word(formula, "the stencil's reference of a pass")?;
        }
    }
    Ok(ActionRun { slice, step, groups, reference })
}

/// Checks that the buffer with the arguments of an indirect draw or dispatch is large enough.
fn check_arguments(inputs: &FrameInputs<'_>, pass: &PlannedPass, flipped: u32) -> Result<(), Error> {
    let Some(id) = arguments(inputs.plan, pass, flipped) else { return Ok(()) };
    let needed = if matches!(pass.kind, Kind::Compute { .. }) { 3 } else { 4 };
    let words = inputs.memory.buffer(id.0).map_or(0, |buffer| buffer.size() / 4);
    if words < needed {
        let name = &inputs.plan.resources[id.0].resource.name;
        return Err(unsupported(format!("`{name}` as arguments: it has {words} words, and needs {needed}")).into());
    }
    Ok(())
}

/// Returns the physical resource with the arguments of an indirect draw or dispatch.
pub(crate) fn arguments(plan: &Plan, pass: &PlannedPass, flipped: u32) -> Option<ResourceId> {
    let usage = pass.uses.iter().find(|usage| usage.access == Access::Indirect)?;
    Some(plan.frame.physical(plan.resource_id(&usage.resource)?, flipped))
}

fn workgroups(inputs: &FrameInputs<'_>, pass: &PlannedPass, values: &Values) -> Result<[u32; 3], Error> {
    let mut counts = [0; 3];
    if pass.uses.iter().any(|usage| usage.access == Access::Indirect) {
        return Ok(counts);
    }
    let what = format!("pass `{}`", pass.name);
    let limit = inputs.max_workgroups;
    for (count, groups) in counts.iter_mut().zip(&pass.groups) {
        let needed = values.evaluate(groups, &what)?;
        *count = u32::try_from(needed).ok().filter(|count| *count <= limit).ok_or_else(|| Error::TooLarge {
            what: format!("{what}, in workgroups,"),
            needed,
            limit: limit.into(),
            limit_name: "max_compute_workgroups_per_dimension",
            help: "use a smaller frame",
            shrinks_with_rows: true,
        })?;
    }
    Ok(counts)
}
