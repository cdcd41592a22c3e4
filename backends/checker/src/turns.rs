//! The steps of a plan as they are run: one after the other, loops of a known number of rounds written out.
//!
//! In: a plan. Out: turns. A loop that ends when a word is zero stands there once, and behind it the turn that goes back.
//! Other loops are refused.

use fragbuf_codegen::Plan;
use fragbuf_frame::{resource, unrolled, unsupported};
use fragbuf_templates::vocabulary::{Formula, Step, Until};

/// What is done at one turn.
#[allow(clippy::large_enum_variant, reason = "nearly all turns are steps")]
#[derive(Clone, Debug)]
pub(crate) enum Turn {
    /// A step, in this round of the loop that has been written out around it; 0 outside of any.
    Step { step: Step, round: u32 },
    /// Back to the turn `from`, until the first word of a resource of the plan is zero. How often may rest on the frame.
    Again { from: usize, word: usize, at_most: Formula },
}

/// The turns of a plan.
pub(crate) fn turns(plan: &Plan) -> Result<Vec<Turn>, fragbuf_frame::Error> {
    let mut turns = Vec::new();
    for turn in unrolled(plan, &plan.steps, 0)? {
        let Step::Repeat(repeat) = turn.step else {
            turns.push(Turn::Step { step: turn.step.clone(), round: turn.round });
            continue;
        };
        let Until::Zero(name) = &repeat.until else {
            return Err(unsupported("a loop that ends when no sample passes".to_owned()));
        };
        let from = turns.len();
        for step in &repeat.body {
            if let Step::Repeat(_) = step {
                return Err(unsupported("a loop inside one that ends when a word is zero".to_owned()));
            }
            turns.push(Turn::Step { step: step.clone(), round: 0 });
        }
        turns.push(Turn::Again { from, word: resource(plan, name)?, at_most: repeat.at_most.clone() });
    }
    Ok(turns)
}
