//! Fragments and helper invocations outside of the frame, or of the slice that is drawn.
//!
//! Input: a subject. Output: the first invocation that does not end, reads out of bounds or changes memory. Quads cross the
//! edges of a frame or slice, so GPUs run helper invocations beside its columns and rows. Memory may hold anything there.

use fragbuf_codegen::FIRST_BINDING;
use fragbuf_interpreter::{Bytecode, Exit};
use fragbuf_templates::vocabulary::Kind;

use crate::fragments::{Fragment, is_position};
use crate::frame::Frame;
use crate::memory::{Memory, WIDTH};
use crate::pool_case::ample_values;
use crate::report::Schedule;
use crate::sequential::{machine_with, run_alone};
use crate::subject::Subject;

/// The slices that are drawn, of one row each: the first, and one with rows on both sides.
const SLICES: [u32; 2] = [0, 3];

/// What every word of memory holds. As links, some of these form cycles.
pub(crate) const FILLS: [fn(u32) -> u32; 5] =
    [|_| 0, |_| 1, |_| u32::MAX, |at| at.wrapping_mul(0x9e37_79b1) >> 28, |at| at.wrapping_mul(0x9e37_79b1)];

/// Checks every pass that draws at the pixels around every slice; returns the first failure.
pub(crate) fn check_outside(subject: &Subject, fragment: &Fragment) -> Result<Option<Schedule>, String> {
    let base = Frame::new(subject, ample_values(subject)?)?;
    for (slice, fill) in SLICES.iter().flat_map(|slice| FILLS.map(|fill| (*slice, fill))) {
        let mut memory = base.memory.clone();
        memory[0] = base.frame_words(slice)?;
        fill_resources(subject, &mut memory, fill);
        for (pass, program) in programs(subject) {
            for position in around(slice) {
                let inputs = inputs(program, fragment, position);
                for is_helper in [false, true] {
                    if let Some(violation) = run(program, &inputs, is_helper, &mut memory) {
                        return Ok(Some(failure(pass, position, is_helper, violation)));
                    }
                }
            }
        }
    }
    Ok(None)
}

/// Returns the fragment stages of all passes that draw.
pub(crate) fn programs(subject: &Subject) -> impl Iterator<Item = (&str, &Bytecode)> {
    let geometry = subject.passes.iter().filter(|pass| pass.pass.kind == Kind::Geometry);
    let geometry = geometry.map(|runnable| (runnable.pass.name.as_str(), &runnable.program));
    geometry.chain(subject.fullscreen.iter().map(|one| (one.pass.as_str(), &one.program)))
}

/// Fills the words of every resource that is no external texture.
pub(crate) fn fill_resources(subject: &Subject, memory: &mut Memory, fill: fn(u32) -> u32) {
    let resources = subject.plan.resources.iter().zip(&mut memory[FIRST_BINDING as usize..]);
    for (_, words) in resources.filter(|(planned, _)| !planned.is_external()) {
        words.iter_mut().zip(0..).for_each(|(word, at)| *word = fill(at));
    }
}

/// Returns the pixels beside, above and below a slice of one row.
fn around(row: u32) -> impl Iterator<Item = [u32; 2]> {
    let columns = (0..=WIDTH + 1).map(move |x| [x, row + 1]);
    let above = (0..=WIDTH + 1).filter_map(move |x| Some([x, row.checked_sub(1)?]));
    let beside = (WIDTH..=WIDTH + 1).map(move |x| [x, row]);
    columns.chain(above).chain(beside)
}

/// Returns the inputs of a fragment at a pixel. In a fullscreen pass only the position matters.
pub(crate) fn inputs(program: &Bytecode, fragment: &Fragment, [x, y]: [u32; 2]) -> Vec<Vec<u32>> {
    let at = |number: usize| fragment.inputs.get(number).cloned().unwrap_or_default();
    let words = program.inputs.iter().enumerate().map(|(number, input)| match is_position(input) {
        true => [x as f32 + 0.5, y as f32 + 0.5, 0.5, 1.0].map(f32::to_bits).to_vec(),
        false => at(number),
    });
    words.collect()
}

/// Runs one invocation; returns what is wrong.
fn run(program: &Bytecode, inputs: &[Vec<u32>], is_helper: bool, memory: &mut Memory) -> Option<&'static str> {
    let before = memory.clone();
    let mut machine = machine_with(program, inputs);
    machine.is_helper = is_helper;
    match run_alone(&mut machine, memory) {
        Err(_) => Some("it reads or writes out of bounds"),
        Ok(Exit::Ended | Exit::Discarded) if *memory == before => None,
        Ok(Exit::Ended | Exit::Discarded) => Some("it changes memory"),
        Ok(_) => Some("it does not end"),
    }
}

fn failure(pass: &str, [x, y]: [u32; 2], is_helper: bool, violation: &str) -> Schedule {
    let kind = if is_helper { "a helper invocation" } else { "a fragment" };
    Schedule {
        case: format!("pass {pass}, outside of the frame or slice, with any words in memory"),
        fragments: vec![("A".to_owned(), format!("{kind} at column {x}, row {y}"))],
        initial_fragments: Vec::new(),
        steps: Vec::new(),
        violation: violation.to_owned(),
        race: None,
    }
}

#[cfg(test)]
mod tests;
