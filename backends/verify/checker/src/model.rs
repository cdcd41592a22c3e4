//! The memory models.
//!
//! *Sequential*: every access is performed at once, in the order of the schedule.
//!
//! *Relaxed*: the Vulkan memory model at device scope, with relaxed atomic operations and acquire-release fences, in the form of
//! `relaxed`. Load buffering is left out: no load or read-modify-write observes a write that is executed later.

/// A memory model.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Model {
    /// Sequential consistency: every access is performed at once.
    Sequential,
    /// A store may become visible later, and accesses of different words may be reordered.
    Relaxed,
}
