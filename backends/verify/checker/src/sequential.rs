//! Runs one machine to its end while no other runs, with the buffers and external textures of a frame.
//!
//! An external texture is a vector of words in memory, as a buffer is. No program writes one, so a texel load is no event.

use fragbuf_interpreter::{Bytecode, Event, Exit, Machine, Reply, Sequential, SharedMemory, WordAddress};

use crate::memory::{Memory, TexelLayout, WIDTH, memory_index, with_buffers};

/// The memory of an invocation that runs while no other does.
struct SequentialMemory<'a> {
    buffers: Sequential<'a>,
    /// The words of textures, by the program's numbers.
    textures: Vec<Vec<u32>>,
}

impl SharedMemory for SequentialMemory<'_> {
    fn length(&self, buffer: u16) -> u32 {
        self.buffers.length(buffer)
    }

    fn constant(&self, address: WordAddress) -> u32 {
        self.buffers.constant(address)
    }

    fn texel(&self, texture: u16, position: [u32; 3]) -> Option<[u32; 4]> {
        TexelLayout::FRAME.texel(self.textures.get(usize::from(texture))?, position)
    }

    fn extent(&self, _texture: u16) -> [u32; 3] {
        [WIDTH, 1, 1]
    }

    fn event(&mut self, event: &Event) -> Reply {
        self.buffers.event(event)
    }
}

/// Runs a machine to its end while no other runs. `Err`: an index is out of bounds.
pub(crate) fn run_alone(machine: &mut Machine<'_>, memory: &mut Memory) -> Result<Exit, String> {
    let textures = textures(machine.program(), memory);
    let exit = with_buffers(machine.program(), memory, |buffers| {
        machine.run(&mut SequentialMemory { buffers: Sequential { buffers }, textures })
    });
    match machine.out_of_bounds.take() {
        Some(_) => Err("an index is out of bounds".to_owned()),
        None => Ok(exit),
    }
}

/// Returns a machine before its first instruction, with these words in its inputs.
pub(crate) fn machine_with<'p>(program: &'p Bytecode, inputs: &[Vec<u32>]) -> Machine<'p> {
    let mut machine = Machine::new(program);
    inputs.iter().enumerate().for_each(|(number, words)| machine.set_input(number, words));
    machine
}

/// Spreads the dense words of a function's arguments over its inputs.
pub(crate) fn set_arguments(machine: &mut Machine<'_>, words: &[u32]) {
    let mut at = 0;
    for (number, input) in machine.program().inputs.iter().enumerate() {
        machine.set_input(number, &words[at.min(words.len())..]);
        at += input.words.len();
    }
}

/// Copies the words of a program's textures.
fn textures(program: &Bytecode, memory: &[Vec<u32>]) -> Vec<Vec<u32>> {
    let words = |index: usize| memory.get(index).cloned().unwrap_or_default();
    program.textures.iter().map(|texture| words(memory_index(texture.binding))).collect()
}
