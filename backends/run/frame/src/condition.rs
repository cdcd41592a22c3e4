//! Conditions that the device evaluates, so that no frame waits for its loops.
//!
//! Input: a plan whose loops end on conditions, and whose queries drop objects. Output: steps that update words on the device; the passes
//! of a loop depend on them ([`PassRun::conditional`](crate::PassRun::conditional)). An API without conditional rendering zeroes the
//! instance counts of indirect draws.
//!
//! A frame records as many iterations as the description allows. Those after the end of a loop clear and copy resources and exchange their
//! names, and no pass of them draws. A row must give the same image either way: see [`Until`](fragbuf_templates::vocabulary::Until).

use fragbuf_codegen::{Action, LoopId, LoopUntil, PassId, Plan};
use fragbuf_templates::vocabulary::{Access, Objects};

use crate::cursor::until;
use crate::{Error, LoopEnd, LoopReport, WordRange};

/// Who ends the loops of a frame on their conditions and drops the objects whose boxes are hidden.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Conditions {
    /// The host, which waits for the device after every iteration.
    #[default]
    OnHost,
    /// The device. The frame does not wait: it records as many iterations as the description allows, and those after the end of a loop
    /// draw nothing. Recording them costs time, so a description should allow no more than its scene needs.
    OnDevice,
}

/// An update of the device's words.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Condition {
    /// A loop begins: its passes draw if those of the loop around it do.
    Begin {
        /// The loop.
        id: LoopId,
        /// The loop around it that ends on a condition.
        around: Option<LoopId>,
    },
    /// An iteration ends: the loop is over if the word is 0.
    End {
        /// The loop.
        id: LoopId,
        /// The word that its condition tests.
        word: ConditionWord,
        /// Whether no further iteration is recorded.
        is_last: bool,
    },
    /// The boxes of objects were drawn: those of which no sample passed are dropped until the slice ends, unless the loop is over.
    Objects {
        /// The pass that drew the boxes.
        pass: PassId,
        /// The loop around it that ends on a condition.
        around: Option<LoopId>,
    },
}

/// The word that the condition of a loop tests.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ConditionWord {
    /// A word of a resource.
    Word(WordRange),
    /// The samples that passed in the last run of this pass.
    Samples(PassId),
}

/// The words that a device keeps for each loop, in the order of the plan's loops: not 0 while its passes draw; its iterations over all
/// slices; not 0 if it was cut.
pub const LOOP_WORDS: usize = 3;

/// Checks that the device can skip the passes of the plan's loops.
pub fn check_conditions(plan: &Plan, conditions: Conditions) -> Result<(), Error> {
    if conditions == Conditions::OnHost {
        return Ok(());
    }
    for looped in plan.frame.loops.iter().filter(|looped| looped.until != LoopUntil::Times) {
        for command in &plan.frame.commands[looped.begin..looped.end] {
            let Action::Pass(id) = command.action else { continue };
            let pass = &plan.passes[id.0];
            if pass.uses.iter().any(|usage| usage.access == Access::Indirect) {
                return Err(Error::Unsupported {
                    what: format!(
                        "`{}`, a pass with arguments of its own, in a loop that ends on the device",
                        pass.name
                    ),
                    help: "use `Conditions::OnHost`".to_owned(),
                });
            }
        }
    }
    Ok(())
}

/// Returns the passes that draw the boxes of objects; those of one name count as one.
pub fn object_queries(plan: &Plan) -> Vec<PassId> {
    let boxes = plan.passes.iter().filter(|pass| pass.objects == Objects::Boxes);
    let mut queries: Vec<PassId> = Vec::new();
    for id in boxes.filter_map(|pass| plan.pass_id(&pass.name)) {
        if !queries.contains(&id) {
            queries.push(id);
        }
    }
    queries
}

/// Returns the reports on the loops, from the words that the device keeps ([`LOOP_WORDS`]).
pub fn loop_reports(plan: &Plan, words: &[u32]) -> Vec<LoopReport> {
    let mut reports = Vec::new();
    for (looped, words) in plan.frame.loops.iter().zip(words.chunks_exact(LOOP_WORDS)) {
        let (Some(until), &[_, iterations, is_cut]) = (until(plan, looped.until), words) else { continue };
        if iterations > 0 {
            let end = if is_cut == 0 { LoopEnd::ConditionMet } else { LoopEnd::LimitReached };
            LoopReport { until, iterations, end }.merge_into(&mut reports);
        }
    }
    reports
}
