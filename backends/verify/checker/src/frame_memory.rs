//! Memory after a frame, as the functions that read a pixel out use it, and the errors of reading.
//!
//! Input: a plan, the fields of the frame's uniform buffer, and the words of the plan's resources by name. Output: the words
//! by binding. Nothing here interprets a word.

use std::fmt;

use fragbuf_codegen::{FIRST_BINDING, Plan, SymbolId};

use crate::memory::Memory;

/// Memory after a frame, which the storage's functions read.
#[derive(Clone, Debug)]
pub struct FrameMemory {
    pub(crate) size: [u32; 2],
    pub(crate) memory: Memory,
}

/// Why a pixel cannot be read out: the storage or the words are wrong.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum ReadOutError {
    /// The storage's list of a pixel returns to an earlier fragment, or is too long.
    Cycle,
    /// One call of the storage's functions does not end.
    Endless {
        /// File and line of the loop.
        location: String,
    },
    /// A buffer has no such word, or a texture no such texel.
    OutOfBounds {
        /// File and line of the access.
        location: String,
    },
}

impl fmt::Display for ReadOutError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            ReadOutError::Cycle => {
                f.write_str("reading the pixel does not end: `storage_next` returns an entry that was read before")
            }
            ReadOutError::Endless { location } => {
                write!(f, "reading the pixel does not end: it repeats the loop at {location}")
            }
            ReadOutError::OutOfBounds { location } => {
                write!(f, "reading the pixel accesses an index out of bounds at {location}")
            }
        }
    }
}

impl std::error::Error for ReadOutError {}

impl FrameMemory {
    /// Returns the memory of a frame of `size` columns and rows.
    ///
    /// `symbol` gives the fields of the frame's uniform buffer. A field without a value is 0, as `first_row` and `iteration`
    /// are. `words` gives the words of a resource, and `None` for one that the frame has not allocated. The words of a
    /// texture are in the order of its texels: row by row from the top, sample by sample. The lowest eight bits of a texel
    /// of depth and stencil are the stencil. Buffers are those of one slice.
    pub fn new(
        plan: &Plan,
        size: [u32; 2],
        symbol: impl Fn(&str) -> Option<u64>,
        words: impl Fn(&str) -> Option<Vec<u32>>,
    ) -> Self {
        let field = |id: &SymbolId| u32::try_from(symbol(&plan.symbols.get(*id).name).unwrap_or(0)).unwrap_or(u32::MAX);
        let mut memory = vec![Vec::new(); FIRST_BINDING as usize];
        memory[0] = plan.fields.iter().map(field).collect();
        memory.extend(plan.resources.iter().map(|planned| words(&planned.resource.name).unwrap_or_default()));
        FrameMemory { size, memory }
    }
}
