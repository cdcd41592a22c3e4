//! Runs the invocations of a workgroup in lanes, from barrier to barrier.

use super::machine::LaneMachine;
use super::memory::LaneMemory;
use super::set::LANES;
use crate::bytecode::Bytecode;
use crate::workgroup::{DispatchEnd, invocation_id};

/// The machines of the invocations of a workgroup.
#[derive(Clone, Debug)]
pub struct LaneWorkgroup<'p> {
    program: &'p Bytecode,
    /// A machine per group of lanes; without barriers one that runs them in turn.
    machines: Vec<LaneMachine<'p>>,
}

impl<'p> LaneWorkgroup<'p> {
    /// Creates the machines. `None`: the program has too many words.
    pub fn new(program: &'p Bytecode) -> Option<Self> {
        let machine = LaneMachine::new(program)?;
        let count = if program.has_barriers() { invocations(program).div_ceil(LANES) } else { 1 };
        Some(LaneWorkgroup { program, machines: vec![machine; count] })
    }

    /// Runs one of `groups` workgroups. Workgroup memory has its initial words.
    pub fn run<M: LaneMemory>(&mut self, group: [u32; 3], groups: [u32; 3], memory: &M) -> DispatchEnd {
        let total = invocations(self.program);
        let mut end = DispatchEnd::Ended;
        for first in (0..total).step_by(LANES * self.machines.len()) {
            match self.run_from(first, total, (group, groups), memory) {
                DispatchEnd::Ended => {}
                access @ DispatchEnd::OutOfBounds(_) => end = access,
                other => return other,
            }
        }
        end
    }

    /// Runs as many invocations as the machines have lanes.
    fn run_from<M: LaneMemory>(
        &mut self,
        first: usize,
        total: usize,
        groups: ([u32; 3], [u32; 3]),
        memory: &M,
    ) -> DispatchEnd {
        for (machine, first) in self.machines.iter_mut().zip((first..total).step_by(LANES)) {
            let count = LANES.min(total - first);
            machine.restart(count);
            set_ids(machine, self.program, first..first + count, groups);
        }
        let invocations = total.min(first + LANES * self.machines.len()) - first;
        let mut end = DispatchEnd::Ended;
        loop {
            let mut stopped = 0;
            for machine in &mut self.machines {
                if let Err(at) = machine.run(memory) {
                    return DispatchEnd::Endless(at);
                }
                stopped += machine.stopped().lanes();
                if let Some(access) = machine.out_of_bounds.take() {
                    end = DispatchEnd::OutOfBounds(access);
                }
            }
            match stopped {
                0 => return end,
                stopped if stopped < invocations => return DispatchEnd::DivergentBarrier,
                _ => {}
            }
        }
    }
}

/// Sets the ids of consecutive invocations, one per lane.
fn set_ids(
    machine: &mut LaneMachine<'_>,
    program: &Bytecode,
    invocations: std::ops::Range<usize>,
    (group, groups): ([u32; 3], [u32; 3]),
) {
    for input in &program.inputs {
        for (lane, invocation) in invocations.clone().enumerate() {
            let Some(id) = invocation_id(program, input, invocation as u32, group, groups) else { continue };
            let words = machine.words_mut(input.words.clone());
            words.iter_mut().zip(id).for_each(|(word, id)| word[lane] = id);
        }
    }
}

fn invocations(program: &Bytecode) -> usize {
    program.workgroup_size.iter().map(|length| *length as usize).product()
}
