//! The steps of a frame with its loops written out.
//!
//! In: a plan. Out: its steps, one after the other, each with its round and the number of its pass. A loop whose end is
//! found out while the frame runs stays one step: who runs the frame sees to its rounds. Nothing is run here.

use fragbuf_codegen::Plan;
use fragbuf_templates::vocabulary::{Repeat, Step, Until};

use crate::{Error, unsupported};

/// One step, once.
#[derive(Clone, Copy, Debug)]
pub struct Turn<'p> {
    /// The step; a [`Step::Repeat`] only where nobody knows its rounds beforehand.
    pub step: &'p Step,
    /// The round of the loop that it is in; 0 outside of any.
    pub round: u32,
    /// The number of its pass, or of the next one, in the order of [`Plan::passes`].
    pub pass: usize,
}

/// Steps of a plan, the first pass among which has the number `pass`. `Err`: a loop's rounds have no value, or too great a
/// one.
pub fn unrolled<'p>(plan: &Plan, steps: &'p [Step], pass: usize) -> Result<Vec<Turn<'p>>, Error> {
    let mut turns = Vec::new();
    unroll(plan, steps, 0, pass, &mut turns)?;
    Ok(turns)
}

/// Adds the turns of one round; the number of the first pass after them.
fn unroll<'p>(
    plan: &Plan,
    steps: &'p [Step],
    round: u32,
    mut pass: usize,
    turns: &mut Vec<Turn<'p>>,
) -> Result<usize, Error> {
    for step in steps {
        match step {
            Step::Repeat(repeat) if let Until::Times(_) = repeat.until => {
                for round in 0..rounds(plan, repeat)? {
                    unroll(plan, &repeat.body, round, pass, turns)?;
                }
            }
            _ => turns.push(Turn { step, round, pass }),
        }
        pass += passes(step);
    }
    Ok(pass)
}

/// Rounds that a loop has at most.
pub fn rounds(plan: &Plan, repeat: &Repeat) -> Result<u32, Error> {
    let formula = match &repeat.until {
        Until::Times(times) => times,
        _ => &repeat.at_most,
    };
    let rounds = formula.evaluate(&|symbol| plan.bound.value(symbol));
    let rounds = rounds.map_err(|error| Error::Formula { what: "the rounds of a loop".to_owned(), error })?;
    u32::try_from(rounds).map_err(|_| unsupported(format!("a loop of {rounds} rounds")))
}

/// Passes of a step, those inside loops included.
fn passes(step: &Step) -> usize {
    match step {
        Step::Pass(_) => 1,
        Step::Repeat(repeat) => repeat.body.iter().map(passes).sum(),
        _ => 0,
    }
}
