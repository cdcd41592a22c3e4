//! Compute passes: workgroups in parallel, the invocations of each on one thread.
//!
//! In: a program, its memory, the number of workgroups. Out: changed memory. Workgroups share nothing but buffers.

use std::sync::atomic::AtomicU32;
use std::sync::{Mutex, PoisonError};

use fragbuf_interpreter::{Dispatch, Fault, Program, Space, workgroup};
use rayon::prelude::*;

use crate::memory::words;
use crate::view::View;

/// Workgroups that one thread takes at a time.
const CHUNK: u64 = 16;

/// Dispatches; an index out of bounds, if there was one. `Err`: why it does not end.
pub(crate) fn compute(program: &Program, view: &View<'_>, groups: [u32; 3]) -> Result<Option<Fault>, &'static str> {
    let total: u64 = groups.iter().map(|count| u64::from(*count)).product();
    let fault: Mutex<Option<Fault>> = Mutex::default();
    (0..total.div_ceil(CHUNK)).into_par_iter().try_for_each(|chunk| {
        for number in chunk * CHUNK..((chunk + 1) * CHUNK).min(total) {
            let (x, y) = (u64::from(groups[0]), u64::from(groups[1]));
            let group = [number % x, number / x % y, number / (x * y)].map(|index| index as u32);
            match one(program, view, group, groups) {
                Dispatch::Ended => {}
                Dispatch::Fault(new) => {
                    fault.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(new);
                }
                Dispatch::Endless => return Err("an invocation goes round for ever"),
                Dispatch::DivergentBarrier => return Err("some wait at a barrier that others never reach"),
            }
        }
        Ok(())
    })?;
    Ok(fault.into_inner().unwrap_or_else(PoisonError::into_inner))
}

fn one(program: &Program, view: &View<'_>, group: [u32; 3], groups: [u32; 3]) -> Dispatch {
    let own: Vec<Vec<AtomicU32>> = program
        .buffers
        .iter()
        .map(|buffer| match buffer.space {
            Space::Workgroup => words(&vec![0; buffer.words as usize]),
            _ => Vec::new(),
        })
        .collect();
    let buffers = program.buffers.iter().zip(view.buffers.iter().zip(&own));
    let buffers = buffers.map(|(buffer, (shared, own))| match buffer.space {
        Space::Workgroup => own.as_slice(),
        _ => *shared,
    });
    workgroup(
        program,
        group,
        groups,
        &mut View { buffers: buffers.collect(), textures: view.textures.clone(), wide: view.wide },
    )
}
