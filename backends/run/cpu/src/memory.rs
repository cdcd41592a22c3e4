//! The words of a frame: a list per resource, as long as the plan's formula says.
//!
//! Words are atomic because tiles run in parallel and share pools and counters; all accesses are relaxed, since nothing is
//! handed from pixel to pixel but by single words.

use std::sync::atomic::{AtomicU32, Ordering};

use fragbuf_codegen::{Plan, ResourceId};
use fragbuf_frame::{Values, bytes};

use crate::Error;

/// Words that threads share.
pub(crate) type Words = Vec<AtomicU32>;

/// All resources of a plan, each where passes look for it: resources that stand for each other have changed places.
#[derive(Debug, Default)]
pub(crate) struct Memory {
    pub(crate) resources: Vec<Words>,
    /// The exchanges of the frame whose resources have changed places.
    pub(crate) flipped: u32,
}

impl Memory {
    /// Gives every resource the size that `values` say; those that have it already keep their words, the others are zero.
    pub(crate) fn resize(&mut self, plan: &Plan, values: &Values) -> Result<(), Error> {
        let sizes = bytes(plan, values)?;
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

    /// Puts the resources of every exchange where a pass looks for them that sees these exchanges flipped.
    pub(crate) fn arrange(&mut self, plan: &Plan, flipped: u32) {
        for (number, [a, b]) in plan.frame.exchanges.iter().enumerate() {
            if (self.flipped ^ flipped) >> number & 1 == 1 {
                self.resources.swap(a.0, b.0);
            }
        }
        self.flipped = flipped;
    }

    /// The words of a physical resource, wherever they are by now.
    pub(crate) fn physical(&mut self, plan: &Plan, resource: ResourceId) -> &mut Words {
        let place = plan.frame.physical(resource, self.flipped);
        &mut self.resources[place.0]
    }

    /// Sets every word of a physical resource.
    pub(crate) fn clear(&mut self, plan: &Plan, resource: ResourceId, value: u32) {
        self.physical(plan, resource).iter_mut().for_each(|word| *word.get_mut() = value);
    }

    /// One physical resource over another.
    pub(crate) fn copy(&mut self, plan: &Plan, from: ResourceId, to: ResourceId) {
        let words: Vec<u32> = read(self.physical(plan, from));
        self.physical(plan, to).iter_mut().zip(words).for_each(|(word, value)| *word.get_mut() = value);
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
