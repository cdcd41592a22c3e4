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
    /// The writes that have changed a word.
    changes: u64,
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
        let reply = self.buffers.event(event);
        self.changes += u64::from(changes(event, reply));
        reply
    }
}

/// Runs a machine to its end while no other runs. `Err`: an index is out of bounds; the machine has the access.
pub(crate) fn run_alone(machine: &mut Machine<'_>, memory: &mut Memory) -> Result<Exit, String> {
    let textures = textures(machine.program(), memory);
    let exit = with_buffers(machine.program(), memory, |buffers| {
        let mut memory = SequentialMemory { buffers: Sequential { buffers }, textures, changes: 0 };
        machine.run_or_repeat(&mut memory, |memory| memory.changes)
    });
    match &machine.out_of_bounds {
        Some(_) => Err("an index is out of bounds".to_owned()),
        None => Ok(exit),
    }
}

/// Returns whether an event has changed a word, by the reply to it.
pub(crate) fn changes(event: &Event, reply: Reply) -> bool {
    match (event, reply) {
        (Event::Access(access), Reply::Done(old)) => access.writes() && access.new_value(old) != old,
        _ => false,
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

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test fails by panicking")]
mod tests {
    use super::*;
    use crate::test_program::compiled;

    const WAITS: &str = "
@group(0) @binding(0) var<storage, read_write> word: atomic<u32>;
@compute @workgroup_size(1)
fn main() {
    loop {
        if atomicLoad(&word) != 0u {
            break;
        }
    }
    atomicStore(&word, 2u);
}
";

    /// Memory whose word becomes 1 after so many loads.
    struct Later {
        loads: u64,
        from: u64,
    }

    impl SharedMemory for Later {
        fn length(&self, _buffer: u16) -> u32 {
            1
        }

        fn constant(&self, _address: WordAddress) -> u32 {
            0
        }

        fn event(&mut self, _event: &Event) -> Reply {
            self.loads += 1;
            Reply::Done(u64::from(self.loads > self.from))
        }
    }

    #[test]
    fn a_machine_that_repeats_is_endless_unless_memory_changes() {
        let program = compiled(WAITS);
        let run = |from: u64, changes: fn(&Later) -> u64| {
            Machine::new(&program).run_or_repeat(&mut Later { loads: 0, from }, changes)
        };
        assert_eq!(run(1 << 14, |memory| memory.loads), Exit::Ended);
        assert_eq!(run(1 << 14, |_| 0), Exit::Endless);
        assert_eq!(run(100, |_| 0), Exit::Ended);
    }

    #[test]
    fn only_a_loop_that_changes_nothing_is_cut_short() {
        let alone = |source: &str| {
            let (program, mut memory) = (compiled(source), vec![vec![0]]);
            let exit = run_alone(&mut Machine::new(&program), &mut memory).unwrap();
            (exit, memory[0][0])
        };
        assert_eq!(alone(WAITS), (Exit::Endless, 0));
        let counts = WAITS.replace("atomicLoad(&word) != 0u", "atomicAdd(&word, 1u) == 20000u");
        assert_eq!(alone(&counts), (Exit::Ended, 2));
    }
}
