//! The dispatches of compute passes that have run. Many cases and final states run a pass with equal memory.
//!
//! Input: a pass and its buffers. Output: the buffers after it. A dispatch depends on nothing else.

use std::collections::HashMap;
use std::sync::{Mutex, PoisonError};

use fragbuf_interpreter::{DispatchEnd, dispatch};

use crate::programs::Runnable;

/// The number of the pass, its iteration, its workgroups and its buffers.
type Key = (usize, Option<u32>, [u32; 3], Vec<Vec<u32>>);

/// The buffers after each dispatch that has run and ended.
#[derive(Debug, Default)]
pub(crate) struct Dispatches(Mutex<HashMap<Key, Vec<Vec<u32>>>>);

/// The most dispatches that are remembered.
const MOST: usize = 1 << 12;

impl Dispatches {
    /// Runs a pass with `groups` workgroups.
    pub(crate) fn run(&self, runnable: &Runnable, groups: [u32; 3], buffers: &mut [Vec<u32>]) -> DispatchEnd {
        let key = (runnable.id.0, runnable.iteration, groups, buffers.to_vec());
        if let Some(known) = self.0.lock().unwrap_or_else(PoisonError::into_inner).get(&key) {
            buffers.clone_from_slice(known);
            return DispatchEnd::Ended;
        }
        let end = dispatch(&runnable.program, groups, buffers);
        let mut known = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if end == DispatchEnd::Ended && known.len() < MOST {
            known.insert(key, buffers.to_vec());
        }
        end
    }
}
