//! Textures that the caller brings, as the programs under test read them: a number for each pixel of the frame.
//!
//! In: memory, of which a texture is a row like any other. Out: texels. No program writes one, so nothing here is an event.

use fragbuf_interpreter::{Event, Place, Program, Reply, Sequential, Shared};

use crate::frame::WIDTH;
use crate::subject::Subject;

/// Memory of an invocation that runs by itself.
pub(crate) struct Alone<'a> {
    pub(crate) buffers: Sequential<'a>,
    /// The words of textures, by the program's numbers.
    pub(crate) textures: Vec<Vec<u32>>,
}

/// The words of a program's textures.
pub(crate) fn textures(program: &Program, memory: &[Vec<u32>]) -> Vec<Vec<u32>> {
    let words = |home: usize| memory.get(home).cloned().unwrap_or_default();
    program.textures.iter().map(|texture| words(Subject::memory_of(texture.binding))).collect()
}

/// The texel at a column and a row, of one sample.
pub(crate) fn texel(words: &[u32], [x, y, sample]: [u32; 3]) -> Option<[u32; 4]> {
    let is_inside = x < WIDTH && y == 0 && sample == 0;
    words.get(x as usize).filter(|_| is_inside).map(|word| [*word, 0, 0, 0])
}

impl Shared for Alone<'_> {
    fn length(&self, buffer: u16) -> u32 {
        self.buffers.length(buffer)
    }

    fn constant(&self, place: Place) -> u32 {
        self.buffers.constant(place)
    }

    fn texel(&self, texture: u16, place: [u32; 3]) -> Option<[u32; 4]> {
        texel(self.textures.get(usize::from(texture))?, place)
    }

    fn extent(&self, _texture: u16) -> [u32; 3] {
        [WIDTH, 1, 1]
    }

    fn event(&mut self, event: &Event) -> Reply {
        self.buffers.event(event)
    }
}
