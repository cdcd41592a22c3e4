//! The resources of a plan: a list of words per resource, sized by the plan's formulas.
//!
//! Words are atomic because tiles run in parallel and share pools and counters. All accesses are relaxed, because pixels
//! communicate only through single words.

use std::sync::atomic::{AtomicU32, Ordering};

use fragbuf_codegen::{Plan, ResourceId};
use fragbuf_frame::{Values, resource_bytes};

use crate::Error;

/// Words that several threads access.
pub(crate) type Words = Vec<AtomicU32>;

/// All resources of a plan, in the order in which passes use them: exchanged resources are swapped.
#[derive(Debug, Default)]
pub(crate) struct Memory {
    pub(crate) resources: Vec<Words>,
    /// The exchanges of the frame whose resources are swapped, as a bit mask.
    pub(crate) flipped: u32,
}

impl Memory {
    /// Resizes every resource to its size under `values`. A resource whose size changes becomes zero; the others keep their
    /// words.
    pub(crate) fn resize(&mut self, plan: &Plan, values: &Values) -> Result<(), Error> {
        let sizes = resource_bytes(plan, values)?;
        self.resources.resize_with(sizes.len(), Vec::new);
        for (words, (name, bytes)) in self.resources.iter_mut().zip(sizes) {
            if words.len() as u64 * 4 != bytes {
                *words = Vec::new();
                *words = zeros(name, bytes)?;
            }
        }
        Ok(())
    }

    /// Returns the size of all resources in bytes.
    pub(crate) fn bytes(&self) -> u64 {
        self.resources.iter().map(|words| 4 * words.len() as u64).sum()
    }

    /// Swaps the resources of exchanges so that those in `flipped` are swapped and the others are not.
    pub(crate) fn arrange(&mut self, plan: &Plan, flipped: u32) {
        for (number, [a, b]) in plan.frame.exchanges.iter().enumerate() {
            if (self.flipped ^ flipped) >> number & 1 == 1 {
                self.resources.swap(a.0, b.0);
            }
        }
        self.flipped = flipped;
    }

    /// Returns the words of a physical resource, swapped or not.
    pub(crate) fn physical(&mut self, plan: &Plan, resource: ResourceId) -> &mut Words {
        let current = plan.frame.physical(resource, self.flipped);
        &mut self.resources[current.0]
    }

    /// Sets every word of a physical resource.
    pub(crate) fn clear(&mut self, plan: &Plan, resource: ResourceId, value: u32) {
        self.physical(plan, resource).iter_mut().for_each(|word| *word.get_mut() = value);
    }

    /// Copies a physical resource to another.
    pub(crate) fn copy(&mut self, plan: &Plan, from: ResourceId, to: ResourceId) {
        let words: Vec<u32> = read(self.physical(plan, from));
        self.physical(plan, to).iter_mut().zip(words).for_each(|(word, value)| *word.get_mut() = value);
    }
}

/// Allocates zero words.
pub(crate) fn zeros(name: &str, bytes: u64) -> Result<Words, Error> {
    let out_of_memory = || Error::OutOfMemory { what: format!("`{name}`"), bytes };
    let count = usize::try_from(bytes / 4).ok().filter(|count| *count < u32::MAX as usize).ok_or_else(out_of_memory)?;
    let mut words = Vec::new();
    words.try_reserve_exact(count).map_err(|_| out_of_memory())?;
    words.resize_with(count, AtomicU32::default);
    Ok(words)
}

/// Returns the values of words.
pub(crate) fn read(words: &[AtomicU32]) -> Vec<u32> {
    words.iter().map(|word| word.load(Ordering::Relaxed)).collect()
}

/// Returns words with these values.
pub(crate) fn words(values: &[u32]) -> Words {
    values.iter().map(|value| AtomicU32::new(*value)).collect()
}
