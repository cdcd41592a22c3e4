//! The memory of a checked frame: a vector of words per binding, for a frame of two pixels.
//!
//! A program addresses its buffers by its own numbers. [`with_buffers`] passes them to it in that order.

use fragbuf_interpreter::{Bytecode, Space};

/// A vector of words per binding. A binding that is neither a buffer nor a texture is empty.
pub(crate) type Memory = Vec<Vec<u32>>;

/// Pixels of the frame, which has one row: the pixel under test, and a neighbour that must not change.
pub(crate) const WIDTH: u32 = 2;

/// The content of memory before the first write. It is neither zero nor a sentinel, and as a key it is better than any other.
/// A key and a value word of this content form an entry whose checksum is right.
pub(crate) const STALE: u32 = 20;

/// Returns the index of a binding in [`Memory`]. Groups follow each other.
pub(crate) fn memory_index(binding: Option<(u32, u32)>) -> usize {
    binding.map_or(usize::MAX, |(group, binding)| (group * 64 + binding) as usize)
}

/// Moves a program's buffers out of memory, in the program's order, calls `work` with them and moves them back.
pub(crate) fn with_buffers<T>(program: &Bytecode, memory: &mut Memory, work: impl FnOnce(&mut [Vec<u32>]) -> T) -> T {
    let mut buffers: Vec<Vec<u32>> = program
        .buffers
        .iter()
        .map(|buffer| match buffer.space {
            Space::Workgroup => vec![buffer.initial; buffer.words as usize],
            _ => memory.get_mut(memory_index(buffer.binding)).map(std::mem::take).unwrap_or_default(),
        })
        .collect();
    let result = work(&mut buffers);
    for (buffer, words) in program.buffers.iter().zip(buffers) {
        let binding = memory.get_mut(memory_index(buffer.binding));
        if let Some(binding) = binding.filter(|_| buffer.space != Space::Workgroup) {
            *binding = words;
        }
    }
    result
}

/// The layout of textures in memory: rows of texels, whose other channels are zero.
#[derive(Clone, Copy, Debug)]
pub(crate) struct TexelLayout {
    pub(crate) width: u32,
    pub(crate) height: u32,
    pub(crate) channels: u32,
}

impl TexelLayout {
    /// External textures have one word per pixel of the frame.
    pub(crate) const FRAME: TexelLayout = TexelLayout { width: WIDTH, height: 1, channels: 1 };

    /// Returns a texel. Textures have one sample and one level.
    pub(crate) fn texel(self, words: &[u32], [x, y, sample]: [u32; 3]) -> Option<[u32; 4]> {
        if x >= self.width || y >= self.height || sample > 0 {
            return None;
        }
        let first = (y * self.width + x) * self.channels;
        let channel = |channel: u32| words.get((first + channel) as usize).copied().filter(|_| channel < self.channels);
        channel(0).map(|value| [value, channel(1).unwrap_or(0), channel(2).unwrap_or(0), channel(3).unwrap_or(0)])
    }
}
