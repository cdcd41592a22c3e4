//! Runs compute passes: workgroups in parallel, the invocations of each on one thread, in lanes where the program allows it.
//!
//! Workgroups share only buffers.

use std::sync::{Mutex, PoisonError};

use fragbuf_interpreter::{Buffer, Bytecode, DispatchEnd, LaneWorkgroup, OutOfBoundsAccess, Space, workgroup};
use rayon::prelude::*;

use crate::memory::{Words, words};
use crate::view::View;

/// The workgroups that one thread takes at a time.
const CHUNK: u64 = 16;

/// Why a dispatch does not terminate.
pub(crate) enum ComputeError {
    /// An invocation reached the limit of backward jumps at this instruction.
    Endless(u32),
    /// Some invocations of a workgroup wait at a barrier that the others do not reach.
    DivergentBarrier,
}

/// Runs a dispatch, in lanes if `lanes` is set; returns an access out of bounds, if there was one.
pub(crate) fn compute(
    program: &Bytecode,
    view: &View<'_>,
    groups: [u32; 3],
    lanes: bool,
) -> Result<Option<OutOfBoundsAccess>, ComputeError> {
    let total: u64 = groups.iter().map(|count| u64::from(*count)).product();
    let out_of_bounds: Mutex<Option<OutOfBoundsAccess>> = Mutex::default();
    let chunks = (0..total.div_ceil(CHUNK)).into_par_iter();
    let local = || {
        let lanes = LaneWorkgroup::new(program).filter(|_| lanes);
        (Workgroups { program, lanes, groups }, local_buffers(program))
    };
    chunks
        .map_init(local, |(workgroups, local), chunk| {
            for number in chunk * CHUNK..((chunk + 1) * CHUNK).min(total) {
                let (x, y) = (u64::from(groups[0]), u64::from(groups[1]));
                let group = [number % x, number / x % y, number / (x * y)].map(|index| index as u32);
                match workgroups.run(view, local, group) {
                    DispatchEnd::Ended => {}
                    DispatchEnd::OutOfBounds(new) => {
                        out_of_bounds.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(new);
                    }
                    DispatchEnd::Endless(at) => return Err(ComputeError::Endless(at)),
                    DispatchEnd::DivergentBarrier => return Err(ComputeError::DivergentBarrier),
                }
            }
            Ok(())
        })
        .collect::<Result<(), _>>()?;
    Ok(out_of_bounds.into_inner().unwrap_or_else(PoisonError::into_inner))
}

/// Runs the workgroups of a thread.
struct Workgroups<'a> {
    program: &'a Bytecode,
    /// `None`: the program does not run in lanes.
    lanes: Option<LaneWorkgroup<'a>>,
    groups: [u32; 3],
}

impl Workgroups<'_> {
    fn run(&mut self, view: &View<'_>, local: &mut [Words], group: [u32; 3]) -> DispatchEnd {
        for (buffer, words) in self.program.buffers.iter().zip(local.iter_mut()) {
            words.iter_mut().for_each(|word| *word.get_mut() = buffer.initial);
        }
        let buffers = self.program.buffers.iter().zip(view.buffers.iter().zip(local.iter()));
        let buffers = buffers.map(|(buffer, (shared, local))| match buffer.space {
            Space::Workgroup => local.as_slice(),
            _ => *shared,
        });
        let mut view = View { buffers: buffers.collect(), textures: view.textures.clone(), wide: view.wide };
        match &mut self.lanes {
            Some(lanes) => lanes.run(group, self.groups, &view),
            None => workgroup(self.program, group, self.groups, &mut view),
        }
    }
}

/// Returns the words of the workgroup memory among the buffers; others are empty.
fn local_buffers(program: &Bytecode) -> Vec<Words> {
    let words_of = |buffer: &Buffer| match buffer.space {
        Space::Workgroup => words(&vec![0; buffer.words as usize]),
        _ => Vec::new(),
    };
    program.buffers.iter().map(words_of).collect()
}
