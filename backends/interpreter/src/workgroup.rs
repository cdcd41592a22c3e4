//! Compute shaders, whole: every workgroup of a dispatch, one after the other.
//!
//! In: a program, its buffers, the number of workgroups. Out: the buffers as the dispatch leaves them. Inside a workgroup
//! the invocations run one after the other from barrier to barrier.

use naga::BuiltIn;

use crate::machine::{Exit, Fault, Machine};
use crate::memory::{Event, Place, Reply, Sequential, Shared};
use crate::program::{Program, Space};

/// How a dispatch ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Dispatch {
    /// All invocations ended.
    Ended,
    /// An invocation goes round for ever.
    Endless,
    /// Some invocations of a workgroup wait at a barrier that others never reach.
    DivergentBarrier,
    /// An index went out of bounds; the dispatch ran on.
    Fault(Fault),
}

/// Dispatches `groups` workgroups.
pub fn dispatch(program: &Program, groups: [u32; 3], buffers: &mut [Vec<u32>]) -> Dispatch {
    let mut worst = Dispatch::Ended;
    for z in 0..groups[2] {
        for y in 0..groups[1] {
            for x in 0..groups[0] {
                match workgroup(program, [x, y, z], groups, buffers) {
                    Dispatch::Ended => {}
                    Dispatch::Fault(fault) => worst = Dispatch::Fault(fault),
                    other => return other,
                }
            }
        }
    }
    worst
}

fn workgroup(program: &Program, group: [u32; 3], groups: [u32; 3], buffers: &mut [Vec<u32>]) -> Dispatch {
    for (buffer, words) in program.buffers.iter().zip(buffers.iter_mut()) {
        if buffer.space == Space::Workgroup {
            words.clear();
            words.resize(buffer.words as usize, 0);
        }
    }
    let mut machines = invocations(program, group, groups);
    let mut running = true;
    let mut is_first = true;
    let mut worst = Dispatch::Ended;
    let mut ended = vec![false; machines.len()];
    while running {
        let mut waiting = 0;
        for (machine, ended) in machines.iter_mut().zip(&mut ended).filter(|(_, ended)| !**ended) {
            match machine.run(&mut Passing { buffers: &mut *buffers, has_passed: is_first }) {
                Exit::Stopped(_) => waiting += 1,
                Exit::Ended | Exit::Discarded => *ended = true,
                Exit::Endless => return Dispatch::Endless,
            }
            if let Some(fault) = machine.fault.take() {
                worst = Dispatch::Fault(fault);
            }
        }
        is_first = false;
        running = waiting > 0;
        if running && waiting < machines.len() {
            return Dispatch::DivergentBarrier;
        }
    }
    worst
}

/// Memory at once, past the barrier that the machine stands at and up to the next.
struct Passing<'a> {
    buffers: &'a mut [Vec<u32>],
    has_passed: bool,
}

impl Shared for Passing<'_> {
    fn length(&self, buffer: u16) -> u32 {
        self.buffers[usize::from(buffer)].len() as u32
    }

    fn constant(&self, place: Place) -> u32 {
        self.buffers[usize::from(place.buffer)].get(place.word as usize).copied().unwrap_or(0)
    }

    fn event(&mut self, event: &Event) -> Reply {
        if *event == Event::Barrier && !self.has_passed {
            self.has_passed = true;
            return Reply::Done(0);
        }
        Sequential { buffers: &mut *self.buffers }.event(event)
    }
}

fn invocations<'p>(program: &'p Program, group: [u32; 3], groups: [u32; 3]) -> Vec<Machine<'p>> {
    let size = program.workgroup_size;
    let total = size[0] * size[1] * size[2];
    let machine = |index: u32| {
        let local = [index % size[0], index / size[0] % size[1], index / (size[0] * size[1])];
        let global = [0, 1, 2].map(|axis| group[axis] * size[axis] + local[axis]);
        let mut machine = Machine::new(program);
        for (number, input) in program.inputs.iter().enumerate() {
            let Some(naga::Binding::BuiltIn(built_in)) = &input.binding else { continue };
            match built_in {
                BuiltIn::GlobalInvocationId => machine.set_input(number, &global),
                BuiltIn::LocalInvocationId => machine.set_input(number, &local),
                BuiltIn::LocalInvocationIndex => machine.set_input(number, &[index]),
                BuiltIn::WorkGroupId => machine.set_input(number, &group),
                BuiltIn::NumWorkGroups => machine.set_input(number, &groups),
                BuiltIn::WorkGroupSize => machine.set_input(number, &size),
                _ => {}
            }
        }
        machine
    };
    (0..total).map(machine).collect()
}
