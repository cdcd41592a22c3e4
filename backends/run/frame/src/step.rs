//! The steps of a frame, and the words that the host supplies between them.

use fragbuf_codegen::{LoopId, PassId, ResourceId};

use crate::Condition;

/// The next step for the device.
#[derive(Clone, Debug, PartialEq)]
pub enum FrameStep {
    /// Set every word of a resource to `value`.
    Clear {
        /// The resource.
        resource: ResourceId,
        /// The word.
        value: u32,
    },
    /// Copy one resource to another.
    Copy {
        /// The resource to read.
        from: ResourceId,
        /// The resource to write.
        to: ResourceId,
    },
    /// Run a pass.
    Pass(PassRun),
    /// Supply words ([`Cursor::supply`](crate::Cursor::supply)); the frame continues then.
    Wait(HostWait),
    /// Copy words for a host step whose decision takes effect in a later frame ([`decide`](crate::decide)); the frame continues at once.
    Read(HostRead),
    /// Update the words on the device that decide which passes draw ([`Conditions::OnDevice`](crate::Conditions::OnDevice)).
    Condition(Condition),
}

/// The words of a host step that the frame does not wait for.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct HostRead {
    /// The index of the host step among the commands of the plan.
    pub(crate) command: usize,
    /// The words, one range after the other.
    pub ranges: Vec<WordRange>,
}

/// One run of a pass.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PassRun {
    /// The pass.
    pub pass: PassId,
    /// The iteration of the innermost loop around it; 0 outside loops.
    pub iteration: u32,
    /// The flipped exchanges of the frame, one bit each. They select the physical resources of the pass:
    /// [`LoweredFrame::physical`](fragbuf_codegen::LoweredFrame::physical).
    pub flipped: u32,
    /// The innermost loop around it whose condition the device evaluates: the pass draws nothing once that loop is over.
    pub conditional: Option<LoopId>,
}

/// The words that the host must supply before the frame continues.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum HostWait {
    /// Words of resources, one range after the other.
    Words(Vec<WordRange>),
    /// One word: 0 if no sample passed in the last run of this pass.
    Samples(PassId),
    /// One word per object: 0 if no sample of its box passed in the last run of this pass and the box does not cross the near
    /// plane.
    Objects(PassId),
}

/// A range of words of a resource.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct WordRange {
    /// The resource.
    pub resource: ResourceId,
    /// The first word.
    pub first: u64,
    /// The number of words.
    pub count: u64,
}
