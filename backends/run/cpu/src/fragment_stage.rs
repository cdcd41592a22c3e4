//! The fragment stage of a draw: sets the inputs of a fragment.
//!
//! A stage belongs to one thread, which runs one fragment or one group of fragments after the other.

use fragbuf_interpreter::{Bytecode, LaneMachine, Machine};

use crate::interface::{FragmentInput, InputSource};
use crate::triangle::{Triangle, Weights};

/// The program, inputs and vertices that all fragments of a draw share.
#[derive(Clone, Copy)]
pub(crate) struct FragmentStage<'a> {
    pub(crate) program: &'a Bytecode,
    pub(crate) inputs: &'a [FragmentInput],
    /// The words of all vertices.
    pub(crate) vertices: &'a [u32],
}

/// The position of a fragment: its pixel, weights and samples.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FragmentPosition {
    /// The column and row of the pixel.
    pub(crate) x: u32,
    pub(crate) y: u32,
    pub(crate) weights: Weights,
    /// Covered samples.
    pub(crate) mask: u32,
    /// The sample that it runs for; 0 if it runs once per pixel.
    pub(crate) sample: u32,
}

impl<'a> FragmentStage<'a> {
    /// Creates a machine for the fragments of the stage.
    pub(crate) fn machine(&self) -> Machine<'a> {
        Machine::new(self.program)
    }

    /// Restarts a machine with the inputs of a fragment.
    #[inline]
    pub(crate) fn begin(&self, machine: &mut Machine<'_>, triangle: &Triangle, position: &FragmentPosition) {
        machine.restart();
        for input in self.inputs {
            let words = machine.words_mut(input.to.clone());
            self.input(input.from, words.len(), triangle, position, |number, value| words[number] = value);
        }
    }

    /// Sets the inputs of a fragment in a lane of a machine.
    #[inline]
    pub(crate) fn set_lane(
        &self,
        machine: &mut LaneMachine<'_>,
        lane: usize,
        triangle: &Triangle,
        position: &FragmentPosition,
    ) {
        for input in self.inputs {
            let words = machine.words_mut(input.to.clone());
            self.input(input.from, words.len(), triangle, position, |number, value| words[number][lane] = value);
        }
    }

    /// Calls `set` with the number and value of each of the `count` words of an input.
    #[inline(always)]
    fn input(
        &self,
        source: InputSource,
        count: usize,
        triangle: &Triangle,
        position: &FragmentPosition,
        mut set: impl FnMut(usize, u32),
    ) {
        match source {
            InputSource::Position => {
                let (x, y) = (position.x as f32 + 0.5, position.y as f32 + 0.5);
                let position = [x, y, position.weights.depth, position.weights.inverse_w];
                position.iter().enumerate().take(count).for_each(|(number, value)| set(number, value.to_bits()));
            }
            InputSource::FrontFacing => set(0, triangle.is_front.into()),
            InputSource::PrimitiveIndex => set(0, triangle.primitive),
            InputSource::SampleIndex => set(0, position.sample),
            InputSource::SampleMask => set(0, position.mask),
            InputSource::Flat(first) => {
                let from = &self.vertices[triangle.provoking as usize + first..][..count];
                from.iter().enumerate().for_each(|(number, word)| set(number, *word));
            }
            InputSource::Perspective(first) => self.mix(count, triangle, first, position.weights.perspective, set),
            InputSource::Linear(first) => {
                self.mix(count, triangle, first, position.weights.linear.map(|weight| weight as f32), set);
            }
        }
    }

    /// Interpolates linearly; exact if the corners are equal.
    #[inline(always)]
    fn mix(&self, count: usize, triangle: &Triangle, first: usize, weights: [f32; 2], mut set: impl FnMut(usize, u32)) {
        let [a, b, c] = triangle.vertices.map(|vertex| &self.vertices[vertex as usize + first..][..count]);
        for (number, ((a, b), c)) in a.iter().zip(b).zip(c).enumerate() {
            let [a, b, c] = [a, b, c].map(|word| f32::from_bits(*word));
            set(number, (a + weights[0] * (b - a) + weights[1] * (c - a)).to_bits());
        }
    }
}
