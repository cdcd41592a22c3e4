//! The resources of a plan: a list of words per resource, sized by the plan's formulas. A buffer has the size of a slice, a texture
//! that of the frame. A slice clears and copies its own rows of a texture.
//!
//! Words are atomic because tiles run in parallel and share pools and counters. All accesses are relaxed, because pixels
//! communicate only through single words.

use std::ops::Range;
use std::sync::atomic::{AtomicU32, Ordering};

use fragbuf_codegen::{Plan, ResourceId};
use fragbuf_frame::{BufferLimit, MemoryLimits, Values};
use fragbuf_templates::vocabulary::Element;

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

/// The memory of a frame beside the plan's resources: the image, and the output of a slice.
const IMAGE: u64 = size_of::<[f32; 4]>() as u64;

/// Returns the limits of this device. Words of a buffer have addresses of 32 bits.
pub(crate) fn memory_limits(budget: u64) -> MemoryLimits {
    MemoryLimits {
        budget,
        buffer: BufferLimit {
            bytes: 4 * (u32::MAX as u64 - 1),
            name: "addresses of 32 bits, in bytes",
            help: "use a smaller frame or lower slices, keep fewer fragments, or reserve less",
        },
        copies_external: true,
        per_pixel: IMAGE,
        per_slice_pixel: IMAGE,
        per_slice: 0,
    }
}

/// The rows of a slice.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Slice {
    pub(crate) rows: Range<u32>,
    /// The width and the height of the frame.
    pub(crate) size: (u32, u32),
}

impl Slice {
    /// Returns the index of the first pixel in the frame.
    pub(crate) fn first_pixel(&self) -> usize {
        self.rows.start as usize * self.size.0 as usize
    }

    /// Returns the number of pixels.
    pub(crate) fn pixels(&self) -> usize {
        self.rows.len() * self.size.0 as usize
    }
}

impl Memory {
    /// Resizes every resource to its size under `values`. A resource whose size changes becomes zero; the others keep their
    /// words. `Err`: the limits do not allow it, and nothing has changed; or the system is out of memory, and the resource that the error
    /// names is empty.
    pub(crate) fn resize(&mut self, plan: &Plan, values: &Values, limits: &MemoryLimits) -> Result<(), Error> {
        let sizes = limits.sizes(plan, values)?;
        self.resources.resize_with(sizes.len(), Vec::new);
        for ((words, bytes), planned) in self.resources.iter_mut().zip(sizes).zip(&plan.resources) {
            if words.len() as u64 * 4 != bytes {
                *words = Vec::new();
                *words = zeros(&planned.resource.name, bytes)?;
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

    /// Sets every word of a slice in a physical resource.
    pub(crate) fn clear(&mut self, plan: &Plan, resource: ResourceId, value: u32, slice: &Slice) {
        let words = self.physical(plan, resource);
        for range in ranges(plan, resource, slice, words.len()) {
            words.iter_mut().skip(range.start).take(range.len()).for_each(|word| *word.get_mut() = value);
        }
    }

    /// Copies a slice of a physical resource to another.
    pub(crate) fn copy(&mut self, plan: &Plan, from: ResourceId, to: ResourceId, slice: &Slice) {
        // Taken out, because both are in one list.
        let source = std::mem::take(self.physical(plan, from));
        let words = self.physical(plan, to);
        for range in ranges(plan, to, slice, words.len()) {
            let pairs = words.iter_mut().zip(&source).skip(range.start).take(range.len());
            pairs.for_each(|(word, value)| *word.get_mut() = value.load(Ordering::Relaxed));
        }
        *self.physical(plan, from) = source;
    }
}

/// Returns the ranges of a slice in the words of a resource: all words of a buffer, and the rows of every sample of a texture.
fn ranges(plan: &Plan, resource: ResourceId, slice: &Slice, words: usize) -> Vec<Range<usize>> {
    let element = plan.resources.get(resource.0).map(|planned| planned.resource.element);
    let Some(Element::Texture(format)) = element else { return std::iter::once(0..words).collect() };
    let texel = format.words() as usize;
    let sample = (slice.size.0 as usize * slice.size.1 as usize * texel).max(1);
    let (first, length) = (slice.first_pixel() * texel, slice.pixels() * texel);
    (0..words / sample).map(|number| number * sample + first..number * sample + first + length).collect()
}

/// Allocates zero words.
pub(crate) fn zeros(name: &str, bytes: u64) -> Result<Words, Error> {
    let out_of_memory = || Error::OutOfMemory { what: format!("`{name}`"), bytes };
    let count = usize::try_from(bytes / 4).map_err(|_| out_of_memory())?;
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
