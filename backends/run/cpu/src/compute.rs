//! Runs compute passes: workgroups in parallel, the invocations of each on one thread.
//!
//! Workgroups share only buffers.

use std::sync::atomic::AtomicU32;
use std::sync::{Mutex, PoisonError};

use fragbuf_interpreter::{Bytecode, DispatchEnd, OutOfBoundsAccess, Space, workgroup};
use rayon::prelude::*;

use crate::memory::words;
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

/// Runs a dispatch; returns an access out of bounds, if there was one.
pub(crate) fn compute(
    program: &Bytecode,
    view: &View<'_>,
    groups: [u32; 3],
) -> Result<Option<OutOfBoundsAccess>, ComputeError> {
    let total: u64 = groups.iter().map(|count| u64::from(*count)).product();
    let out_of_bounds: Mutex<Option<OutOfBoundsAccess>> = Mutex::default();
    (0..total.div_ceil(CHUNK)).into_par_iter().try_for_each(|chunk| {
        for number in chunk * CHUNK..((chunk + 1) * CHUNK).min(total) {
            let (x, y) = (u64::from(groups[0]), u64::from(groups[1]));
            let group = [number % x, number / x % y, number / (x * y)].map(|index| index as u32);
            match run_workgroup(program, view, group, groups) {
                DispatchEnd::Ended => {}
                DispatchEnd::OutOfBounds(new) => {
                    out_of_bounds.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(new);
                }
                DispatchEnd::Endless(at) => return Err(ComputeError::Endless(at)),
                DispatchEnd::DivergentBarrier => return Err(ComputeError::DivergentBarrier),
            }
        }
        Ok(())
    })?;
    Ok(out_of_bounds.into_inner().unwrap_or_else(PoisonError::into_inner))
}

fn run_workgroup(program: &Bytecode, view: &View<'_>, group: [u32; 3], groups: [u32; 3]) -> DispatchEnd {
    let local: Vec<Vec<AtomicU32>> = program
        .buffers
        .iter()
        .map(|buffer| match buffer.space {
            Space::Workgroup => words(&vec![buffer.initial; buffer.words as usize]),
            _ => Vec::new(),
        })
        .collect();
    let buffers = program.buffers.iter().zip(view.buffers.iter().zip(&local));
    let buffers = buffers.map(|(buffer, (shared, local))| match buffer.space {
        Space::Workgroup => local.as_slice(),
        _ => *shared,
    });
    workgroup(
        program,
        group,
        groups,
        &mut View { buffers: buffers.collect(), textures: view.textures.clone(), wide: view.wide },
    )
}
