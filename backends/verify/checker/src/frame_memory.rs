//! Memory after a frame, as the functions that read a pixel out find it, and what can be wrong with it.
//!
//! In: a plan, the fields of the frame's uniform buffer, and the words of the plan's resources by name. Out: the words by binding.
//! Nothing here says what a word means.

use std::fmt;

use fragbuf_codegen::{FIRST_BINDING, Plan, SymbolId};

use crate::frame::Memory;

/// Memory after a frame: what the storage's functions read.
#[derive(Clone, Debug)]
pub struct FrameMemory {
    pub(crate) size: [u32; 2],
    pub(crate) memory: Memory,
}

/// Why a pixel cannot be read out: the storage, or the words, are wrong.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ReadOutError {
    /// The walk over the pixel comes back to a fragment that it has passed, or one call of it does not end.
    Endless,
    /// A buffer has no such word, or a texture no such texel.
    OutOfBounds,
}

impl fmt::Display for ReadOutError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            ReadOutError::Endless => "reading the pixel out never ends",
            ReadOutError::OutOfBounds => "an index is out of bounds",
        })
    }
}

impl std::error::Error for ReadOutError {}

impl FrameMemory {
    /// The memory of a frame of `size` columns and rows. `symbol` gives the fields of the frame's uniform buffer (a field
    /// without a value is 0, as `first_row` and `iteration` are); `words` gives the words of a resource, none for what the
    /// frame has not allocated. The words of a texture follow each other texel by texel, row by row from the top, sample by
    /// sample; of depth with stencil the lowest eight bits are the stencil. Buffers are those of one slice.
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
