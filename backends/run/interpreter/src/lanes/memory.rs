//! Memory as the lanes of a group access it: every access takes effect at once.

use std::sync::atomic::{AtomicU32, Ordering};

use crate::memory::{Access, Atomic, Operation};

/// Memory whose accesses take effect at once, and never stop a machine.
pub trait LaneMemory {
    /// Returns the words of a buffer; fewer than `u32::MAX`.
    fn words(&self, buffer: u16) -> &[AtomicU32];
    /// Performs an access of 64 bits within a buffer; returns the old value.
    fn wide(&self, access: &Access) -> u64;
    /// Returns the four channels of the texel at a column, row, and sample or level. `None`: out of bounds.
    fn texel(&self, texture: u16, coordinates: [u32; 3]) -> Option<[u32; 4]>;
    /// Returns the columns, rows, and samples or slices of a texture.
    fn extent(&self, texture: u16) -> [u32; 3];
}

impl Access {
    /// Performs an access of 32 bits; returns the old value, or 0 for a store.
    #[inline]
    pub fn perform(&self, word: &AtomicU32) -> u32 {
        let value = self.value as u32;
        match self.operation {
            Operation::Load => word.load(Ordering::Relaxed),
            Operation::Store => {
                word.store(value, Ordering::Relaxed);
                0
            }
            Operation::Atomic(function) => match function {
                Atomic::Add => word.fetch_add(value, Ordering::Relaxed),
                Atomic::Subtract => word.fetch_sub(value, Ordering::Relaxed),
                Atomic::And => word.fetch_and(value, Ordering::Relaxed),
                Atomic::Or => word.fetch_or(value, Ordering::Relaxed),
                Atomic::ExclusiveOr => word.fetch_xor(value, Ordering::Relaxed),
                Atomic::Min => word.fetch_min(value, Ordering::Relaxed),
                Atomic::Max => word.fetch_max(value, Ordering::Relaxed),
                Atomic::Exchange => word.swap(value, Ordering::Relaxed),
                Atomic::SignedMin | Atomic::SignedMax | Atomic::CompareExchange => {
                    let new = |old: u32| Some(self.new_value(old.into()) as u32);
                    word.fetch_update(Ordering::Relaxed, Ordering::Relaxed, new).unwrap_or_else(|old| old)
                }
            },
        }
    }
}
