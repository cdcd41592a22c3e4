//! The words of a frame: a list per resource, as long as the plan's formula says.
//!
//! Words are atomic because tiles run in parallel and share pools and counters; all accesses are relaxed, since nothing is
//! handed from pixel to pixel but by single words.

use std::sync::atomic::{AtomicU32, Ordering};

use fragbuf_codegen::Plan;
use fragbuf_frame::{Symbols, bytes};

use crate::Error;

/// Words that threads share.
pub(crate) type Words = Vec<AtomicU32>;

/// All resources of a plan.
#[derive(Debug, Default)]
pub(crate) struct Memory {
    pub(crate) resources: Vec<Words>,
}

impl Memory {
    /// Gives every resource the size that `symbols` say; those that have it already keep their words, the others are zero.
    pub(crate) fn resize(&mut self, plan: &Plan, symbols: &Symbols) -> Result<(), Error> {
        let sizes = bytes(plan, symbols)?;
        self.resources.resize_with(sizes.len(), Vec::new);
        for (words, (name, bytes)) in self.resources.iter_mut().zip(sizes) {
            if words.len() as u64 * 4 != bytes {
                *words = Vec::new();
                *words = zeros(name, bytes)?;
            }
        }
        Ok(())
    }

    /// Bytes of all resources.
    pub(crate) fn bytes(&self) -> u64 {
        self.resources.iter().map(|words| 4 * words.len() as u64).sum()
    }

    /// Sets every word.
    pub(crate) fn clear(&mut self, resource: usize, value: u32) {
        self.resources[resource].iter_mut().for_each(|word| *word.get_mut() = value);
    }

    /// One resource over another.
    pub(crate) fn copy(&mut self, from: usize, to: usize) {
        let words: Vec<u32> = read(&self.resources[from]);
        self.resources[to].iter_mut().zip(words).for_each(|(word, value)| *word.get_mut() = value);
    }
}

/// Zero words of so many bytes.
pub(crate) fn zeros(name: &str, bytes: u64) -> Result<Words, Error> {
    let out_of_memory = || Error::OutOfMemory { what: format!("`{name}`"), bytes };
    let count = usize::try_from(bytes / 4).ok().filter(|count| *count < u32::MAX as usize).ok_or_else(out_of_memory)?;
    let mut words = Vec::new();
    words.try_reserve_exact(count).map_err(|_| out_of_memory())?;
    words.resize_with(count, AtomicU32::default);
    Ok(words)
}

/// A copy of the words as they are.
pub(crate) fn read(words: &[AtomicU32]) -> Vec<u32> {
    words.iter().map(|word| word.load(Ordering::Relaxed)).collect()
}

/// Words that hold these values.
pub(crate) fn words(values: &[u32]) -> Words {
    values.iter().map(|value| AtomicU32::new(*value)).collect()
}
