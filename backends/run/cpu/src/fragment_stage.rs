//! The fragment stage of a draw: sets the inputs of a fragment.
//!
//! A stage belongs to one thread, which runs one fragment after the other.

use fragbuf_interpreter::{Bytecode, Machine};

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
            let to = machine.words_mut(input.to.clone());
            match input.from {
                InputSource::Position => {
                    let (x, y) = (position.x as f32 + 0.5, position.y as f32 + 0.5);
                    let position = [x, y, position.weights.depth, position.weights.inverse_w];
                    to.iter_mut().zip(position).for_each(|(word, value)| *word = value.to_bits());
                }
                InputSource::FrontFacing => to[0] = triangle.is_front.into(),
                InputSource::PrimitiveIndex => to[0] = triangle.primitive,
                InputSource::SampleIndex => to[0] = position.sample,
                InputSource::SampleMask => to[0] = position.mask,
                InputSource::Flat(first) => {
                    let from = triangle.provoking as usize + first;
                    to.copy_from_slice(&self.vertices[from..from + to.len()]);
                }
                InputSource::Perspective(first) => self.mix(to, triangle, first, position.weights.perspective),
                InputSource::Linear(first) => {
                    self.mix(to, triangle, first, position.weights.linear.map(|weight| weight as f32));
                }
            }
        }
    }

    /// Interpolates linearly; exact if the corners are equal.
    fn mix(&self, to: &mut [u32], triangle: &Triangle, first: usize, weights: [f32; 2]) {
        let [a, b, c] = triangle.vertices.map(|vertex| &self.vertices[vertex as usize + first..][..to.len()]);
        for (word, ((a, b), c)) in to.iter_mut().zip(a.iter().zip(b).zip(c)) {
            let [a, b, c] = [a, b, c].map(|word| f32::from_bits(*word));
            *word = (a + weights[0] * (b - a) + weights[1] * (c - a)).to_bits();
        }
    }
}
