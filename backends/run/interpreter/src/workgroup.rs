//! Runs compute shaders: a whole dispatch sequentially, or one workgroup.
//!
//! The invocations of a workgroup run one after the other, from barrier to barrier.

use naga::BuiltIn;

use crate::bytecode::{Bytecode, InterfaceVariable, Space};
use crate::machine::{Exit, Machine, OutOfBoundsAccess};
use crate::memory::{Event, Reply, Sequential, SharedMemory, WordAddress};

/// The end of a dispatch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DispatchEnd {
    /// All invocations ended.
    Ended,
    /// An invocation reached the limit of backward jumps at this instruction, for [`Bytecode::trace`].
    Endless(u32),
    /// Some invocations of a workgroup wait at a barrier that the others do not reach.
    DivergentBarrier,
    /// The dispatch ended after an access out of bounds.
    OutOfBounds(OutOfBoundsAccess),
}

/// Returns the four channels of a texel of the texture with this number, at a column, row, and sample or level. `None`: out of bounds.
pub type Texels<'a> = dyn Fn(u16, [u32; 3]) -> Option<[u32; 4]> + 'a;

/// Runs `groups` workgroups, one after the other. There are no textures.
pub fn dispatch(program: &Bytecode, groups: [u32; 3], buffers: &mut [Vec<u32>]) -> DispatchEnd {
    dispatch_with_textures(program, groups, buffers, &|_, _| None)
}

/// Runs `groups` workgroups, one after the other.
pub fn dispatch_with_textures(
    program: &Bytecode,
    groups: [u32; 3],
    buffers: &mut [Vec<u32>],
    texels: &Texels<'_>,
) -> DispatchEnd {
    let mut outcome = DispatchEnd::Ended;
    for z in 0..groups[2] {
        for y in 0..groups[1] {
            for x in 0..groups[0] {
                for (buffer, words) in program.buffers.iter().zip(buffers.iter_mut()) {
                    if buffer.space == Space::Workgroup {
                        words.clear();
                        words.resize(buffer.words as usize, buffer.initial);
                    }
                }
                let mut memory = WithTextures { memory: Sequential { buffers: &mut *buffers }, texels };
                match workgroup(program, [x, y, z], groups, &mut memory) {
                    DispatchEnd::Ended => {}
                    DispatchEnd::OutOfBounds(access) => outcome = DispatchEnd::OutOfBounds(access),
                    other => return other,
                }
            }
        }
    }
    outcome
}

/// Sequential memory beside textures.
struct WithTextures<'a> {
    memory: Sequential<'a>,
    texels: &'a Texels<'a>,
}

impl SharedMemory for WithTextures<'_> {
    fn length(&self, buffer: u16) -> u32 {
        self.memory.length(buffer)
    }

    fn constant(&self, address: WordAddress) -> u32 {
        self.memory.constant(address)
    }

    fn texel(&self, texture: u16, coordinates: [u32; 3]) -> Option<[u32; 4]> {
        (self.texels)(texture, coordinates)
    }

    fn event(&mut self, event: &Event) -> Reply {
        self.memory.event(event)
    }
}

/// Runs one of `groups` workgroups. In `shared`, workgroup memory has its initial words, and machines stop at barriers.
pub fn workgroup<S: SharedMemory>(
    program: &Bytecode,
    group: [u32; 3],
    groups: [u32; 3],
    shared: &mut S,
) -> DispatchEnd {
    let size = program.workgroup_size;
    let total = size[0] * size[1] * size[2];
    if !program.has_barriers() {
        let mut machine = Machine::new(program);
        return run_without_barriers(&mut machine, (group, groups), 0..total, shared);
    }
    let mut machines: Vec<Machine<'_>> = (0..total).map(|_| Machine::new(program)).collect();
    for (index, machine) in (0..).zip(&mut machines) {
        set_invocation_ids(machine, index, group, groups);
    }
    let mut is_first = true;
    let mut outcome = DispatchEnd::Ended;
    let mut ended = vec![false; machines.len()];
    loop {
        let mut waiting = 0;
        for (machine, ended) in machines.iter_mut().zip(&mut ended).filter(|(_, ended)| !**ended) {
            match machine.run(&mut BarrierSegment { shared, has_passed: is_first }) {
                Exit::Stopped(_) => waiting += 1,
                Exit::Ended | Exit::Discarded => *ended = true,
                Exit::Endless => return DispatchEnd::Endless(machine.at()),
            }
            if let Some(access) = machine.out_of_bounds.take() {
                outcome = DispatchEnd::OutOfBounds(access);
            }
        }
        is_first = false;
        match waiting {
            0 => return outcome,
            waiting if waiting < machines.len() => return DispatchEnd::DivergentBarrier,
            _ => {}
        }
    }
}

/// Runs the invocations of a workgroup without barriers on one machine.
fn run_without_barriers<S: SharedMemory>(
    machine: &mut Machine<'_>,
    (group, groups): ([u32; 3], [u32; 3]),
    indices: std::ops::Range<u32>,
    shared: &mut S,
) -> DispatchEnd {
    let mut outcome = DispatchEnd::Ended;
    for index in indices {
        machine.restart();
        set_invocation_ids(machine, index, group, groups);
        if machine.run(shared) == Exit::Endless {
            return DispatchEnd::Endless(machine.at());
        }
        if let Some(access) = machine.out_of_bounds.take() {
            outcome = DispatchEnd::OutOfBounds(access);
        }
    }
    outcome
}

/// Memory for the segment from the barrier at which the machine stopped to the next barrier.
struct BarrierSegment<'a, S> {
    shared: &'a mut S,
    has_passed: bool,
}

impl<S: SharedMemory> SharedMemory for BarrierSegment<'_, S> {
    fn length(&self, buffer: u16) -> u32 {
        self.shared.length(buffer)
    }

    fn constant(&self, address: WordAddress) -> u32 {
        self.shared.constant(address)
    }

    fn texel(&self, texture: u16, coordinates: [u32; 3]) -> Option<[u32; 4]> {
        self.shared.texel(texture, coordinates)
    }

    fn extent(&self, texture: u16) -> [u32; 3] {
        self.shared.extent(texture)
    }

    fn event(&mut self, event: &Event) -> Reply {
        if matches!(event, Event::Barrier(_)) && !self.has_passed {
            self.has_passed = true;
            return Reply::Done(0);
        }
        self.shared.event(event)
    }
}

/// Sets the ids of an invocation with this index in one of `groups` workgroups.
pub fn set_invocation_ids(machine: &mut Machine<'_>, index: u32, group: [u32; 3], groups: [u32; 3]) {
    let program = machine.program();
    for (number, input) in program.inputs.iter().enumerate() {
        if let Some(id) = invocation_id(program, input, index, group, groups) {
            machine.set_input(number, &id);
        }
    }
}

/// Returns the id that an input is, of an invocation with this index in one of `groups` workgroups; the first words of it, if the input has
/// fewer. `None`: it is no id.
pub(crate) fn invocation_id(
    program: &Bytecode,
    input: &InterfaceVariable,
    index: u32,
    group: [u32; 3],
    groups: [u32; 3],
) -> Option<[u32; 3]> {
    let Some(naga::Binding::BuiltIn(built_in)) = &input.binding else { return None };
    let size = program.workgroup_size;
    let local = [index % size[0], index / size[0] % size[1], index / (size[0] * size[1])];
    Some(match built_in {
        BuiltIn::GlobalInvocationId => [0, 1, 2].map(|axis| group[axis] * size[axis] + local[axis]),
        BuiltIn::LocalInvocationId => local,
        BuiltIn::LocalInvocationIndex => [index; 3],
        BuiltIn::WorkGroupId => group,
        BuiltIn::NumWorkGroups => groups,
        BuiltIn::WorkGroupSize => size,
        _ => return None,
    })
}
