//! Compute shaders: every workgroup of a dispatch, one after the other, or any one of them.
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

/// Dispatches `groups` workgroups, one after the other.
pub fn dispatch(program: &Program, groups: [u32; 3], buffers: &mut [Vec<u32>]) -> Dispatch {
    let mut worst = Dispatch::Ended;
    for z in 0..groups[2] {
        for y in 0..groups[1] {
            for x in 0..groups[0] {
                for (buffer, words) in program.buffers.iter().zip(buffers.iter_mut()) {
                    if buffer.space == Space::Workgroup {
                        words.clear();
                        words.resize(buffer.words as usize, 0);
                    }
                }
                match workgroup(program, [x, y, z], groups, &mut Sequential { buffers: &mut *buffers }) {
                    Dispatch::Ended => {}
                    Dispatch::Fault(fault) => worst = Dispatch::Fault(fault),
                    other => return other,
                }
            }
        }
    }
    worst
}

/// Runs one of `groups` workgroups. The memory of the workgroup is zero in `shared`, which stops at barriers.
pub fn workgroup<S: Shared>(program: &Program, group: [u32; 3], groups: [u32; 3], shared: &mut S) -> Dispatch {
    let size = program.workgroup_size;
    let total = size[0] * size[1] * size[2];
    if !program.has_barriers() {
        let mut machine = Machine::new(program);
        return alone(&mut machine, (group, groups), 0..total, shared);
    }
    let mut machines: Vec<Machine<'_>> = (0..total).map(|_| Machine::new(program)).collect();
    for (index, machine) in (0..).zip(&mut machines) {
        number(machine, index, group, groups);
    }
    let mut is_first = true;
    let mut worst = Dispatch::Ended;
    let mut ended = vec![false; machines.len()];
    loop {
        let mut waiting = 0;
        for (machine, ended) in machines.iter_mut().zip(&mut ended).filter(|(_, ended)| !**ended) {
            match machine.run(&mut Passing { shared, has_passed: is_first }) {
                Exit::Stopped(_) => waiting += 1,
                Exit::Ended | Exit::Discarded => *ended = true,
                Exit::Endless => return Dispatch::Endless,
            }
            if let Some(fault) = machine.fault.take() {
                worst = Dispatch::Fault(fault);
            }
        }
        is_first = false;
        match waiting {
            0 => return worst,
            waiting if waiting < machines.len() => return Dispatch::DivergentBarrier,
            _ => {}
        }
    }
}

/// Invocations that never wait for each other, by one machine.
fn alone<S: Shared>(
    machine: &mut Machine<'_>,
    (group, groups): ([u32; 3], [u32; 3]),
    indices: std::ops::Range<u32>,
    shared: &mut S,
) -> Dispatch {
    let mut worst = Dispatch::Ended;
    for index in indices {
        machine.restart();
        number(machine, index, group, groups);
        if machine.run(shared) == Exit::Endless {
            return Dispatch::Endless;
        }
        if let Some(fault) = machine.fault.take() {
            worst = Dispatch::Fault(fault);
        }
    }
    worst
}

/// Memory at once, past the barrier that the machine stands at and up to the next.
struct Passing<'a, S> {
    shared: &'a mut S,
    has_passed: bool,
}

impl<S: Shared> Shared for Passing<'_, S> {
    fn length(&self, buffer: u16) -> u32 {
        self.shared.length(buffer)
    }

    fn constant(&self, place: Place) -> u32 {
        self.shared.constant(place)
    }

    fn texel(&self, texture: u16, place: [u32; 3]) -> Option<[u32; 4]> {
        self.shared.texel(texture, place)
    }

    fn extent(&self, texture: u16) -> [u32; 3] {
        self.shared.extent(texture)
    }

    fn event(&mut self, event: &Event) -> Reply {
        if *event == Event::Barrier && !self.has_passed {
            self.has_passed = true;
            return Reply::Done(0);
        }
        self.shared.event(event)
    }
}

/// Tells an invocation who it is.
fn number(machine: &mut Machine<'_>, index: u32, group: [u32; 3], groups: [u32; 3]) {
    let program = machine.program();
    let size = program.workgroup_size;
    let local = [index % size[0], index / size[0] % size[1], index / (size[0] * size[1])];
    let global = [0, 1, 2].map(|axis| group[axis] * size[axis] + local[axis]);
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
}
