//! A group of fragments that run at once, in the lanes of one machine.
//!
//! Fragments join in submission order. If the shader writes memory, a group has at most one fragment of a pixel, so the fragments of a pixel
//! take effect one after the other. Fragments of different pixels share only words that tiles, which run in parallel, share as well.

use fragbuf_interpreter::{LANES, LaneMachine};

use crate::fragment_stage::{FragmentPosition, FragmentStage};
use crate::schedule::PixelFragment;
use crate::tile::SIDE;

/// The words of a set of the pixels of a tile.
const WORDS: usize = (SIDE * SIDE) as usize / u64::BITS as usize;

/// A group of fragments of a tile.
pub(crate) struct LaneGroup<'a> {
    pub(crate) machine: LaneMachine<'a>,
    /// The fragments, by lane.
    pub(crate) fragments: Vec<PixelFragment<'a>>,
    /// The result of one fragment.
    pub(crate) result: Vec<u32>,
    /// The pixels of the fragments, as a bit set.
    pixels: [u64; WORDS],
    /// Whether a group may have several fragments of a pixel.
    may_share_pixels: bool,
}

impl<'a> LaneGroup<'a> {
    /// Creates an empty group. `None`: the program does not run in lanes.
    pub(crate) fn of(stage: &FragmentStage<'a>) -> Option<Self> {
        let machine = LaneMachine::new(stage.program)?;
        let may_share_pixels = stage.program.buffers.iter().all(|buffer| !buffer.is_written || buffer.commutes);
        let (fragments, result) = (Vec::with_capacity(LANES), vec![0; stage.program.result.len()]);
        Some(LaneGroup { machine, fragments, result, pixels: [0; WORDS], may_share_pixels })
    }

    /// Returns whether another fragment of the pixel can join.
    pub(crate) fn has_lane_for(&self, position: &FragmentPosition) -> bool {
        let (word, bit) = pixel(position);
        self.fragments.len() < LANES && (self.may_share_pixels || self.pixels[word] & bit == 0)
    }

    /// Adds a fragment.
    pub(crate) fn push(&mut self, stage: &FragmentStage<'a>, (triangle, position): PixelFragment<'a>) {
        stage.set_lane(&mut self.machine, self.fragments.len(), triangle, &position);
        let (word, bit) = pixel(&position);
        self.pixels[word] |= bit;
        self.fragments.push((triangle, position));
    }

    /// Removes all fragments.
    pub(crate) fn clear(&mut self) {
        self.fragments.clear();
        self.pixels = [0; WORDS];
    }
}

/// Returns the word and the bit of a pixel in a set.
fn pixel(position: &FragmentPosition) -> (usize, u64) {
    let number = (position.y % SIDE * SIDE + position.x % SIDE) as usize;
    (number / u64::BITS as usize, 1 << (number % u64::BITS as usize))
}
