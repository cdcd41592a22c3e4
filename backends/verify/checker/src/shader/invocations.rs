//! The invocations of a shader that a check runs, with their inputs.
//!
//! Input: the program of an entry point and a number of invocations. Output: one or more sets of invocations. Those of a
//! compute stage are whole workgroups if these are small, and otherwise a part of one workgroup or of several.

use fragbuf_interpreter::{Bytecode, Machine, set_invocation_ids};
use naga::{Binding, BuiltIn, ScalarKind, ShaderStage};

/// The greatest workgroup of which every invocation runs.
const WHOLE: u32 = 4;

/// The most invocations of a check.
pub(super) const MOST: u32 = 16;

/// Invocations that run at the same time.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Invocations {
    stage: ShaderStage,
    workgroups: u32,
    /// The invocations of each workgroup that run.
    members: u32,
    size: u32,
}

impl Invocations {
    /// Returns the sets for `count` invocations. `workgroups`: the number of workgroups, if the caller gives it.
    pub(super) fn sets(program: &Bytecode, stage: ShaderStage, count: u32, workgroups: Option<u32>) -> Vec<Self> {
        let size = program.workgroup_size.iter().fold(1u32, |size, length| size.saturating_mul(*length)).max(1);
        let set = |workgroups: u32, members: u32| Invocations { stage, workgroups, members, size };
        match (stage, workgroups) {
            (ShaderStage::Compute, Some(workgroups)) if size <= WHOLE => vec![set(workgroups, size)],
            (ShaderStage::Compute, Some(workgroups)) => vec![set(workgroups, count.div_ceil(workgroups).min(size))],
            (ShaderStage::Compute, None) if size <= WHOLE => vec![set(count.div_ceil(size), size)],
            (ShaderStage::Compute, None) => {
                let mut sets = vec![set(1, count.min(size)), set(count, 1)];
                sets.dedup();
                sets
            }
            _ => vec![Invocations { stage, workgroups: count, members: 1, size: 1 }],
        }
    }

    /// Returns how many invocations run.
    pub(super) fn count(&self) -> u32 {
        self.workgroups.saturating_mul(self.members)
    }

    /// Returns the number of each invocation's workgroup; none outside of a compute stage.
    pub(super) fn workgroups(&self) -> Vec<u32> {
        match self.stage {
            ShaderStage::Compute => (0..self.count()).map(|number| number / self.members).collect(),
            _ => Vec::new(),
        }
    }

    /// Returns the machines, in the order of their names.
    pub(super) fn machines<'p>(&self, program: &'p Bytecode) -> Vec<Machine<'p>> {
        (0..self.count()).map(|number| self.machine(program, number)).collect()
    }

    fn machine<'p>(&self, program: &'p Bytecode, number: u32) -> Machine<'p> {
        let mut machine = Machine::new(program);
        if self.stage == ShaderStage::Compute {
            let workgroup = [number / self.members, 0, 0];
            set_invocation_ids(&mut machine, number % self.members, workgroup, [self.workgroups, 1, 1]);
            return machine;
        }
        for (at, input) in program.inputs.iter().enumerate() {
            let words: Vec<u32> = match (&input.binding, input.kind) {
                (Some(Binding::BuiltIn(BuiltIn::Position { .. })), _) => {
                    [0.5, 0.5, 0.125 * (number + 1) as f32, 1.0].map(f32::to_bits).to_vec()
                }
                (Some(Binding::BuiltIn(_)), Some(ScalarKind::Bool)) => vec![number % 2],
                (Some(Binding::BuiltIn(_)), _) => vec![number, 0, 0],
                (_, Some(ScalarKind::Float)) => vec![((number + 1) as f32 / 8.0).to_bits(); input.words.len()],
                _ => vec![number + 1; input.words.len()],
            };
            machine.set_input(at, &words);
        }
        machine
    }

    /// Returns a description, such as `2 workgroups of 4 invocations`.
    pub(super) fn description(&self) -> String {
        let (workgroups, members) = (self.workgroups, self.members);
        let plural = |count: u32| if count == 1 { "" } else { "s" };
        if self.stage != ShaderStage::Compute || self.size == 1 {
            return format!("{workgroups} invocation{}", plural(workgroups));
        }
        let each = match self.is_whole() {
            true => format!("{members} invocations"),
            false => format!("{members} of {} invocations", self.size),
        };
        format!("{workgroups} workgroup{} of {each}", plural(workgroups))
    }

    /// Returns the name of an invocation.
    pub(super) fn name(&self, number: u32) -> String {
        if self.stage != ShaderStage::Compute || self.size == 1 {
            return format!("invocation {number}");
        }
        format!("invocation {} of workgroup {}", number % self.members, number / self.members)
    }

    /// Returns whether every invocation of each workgroup runs.
    pub(super) fn is_whole(&self) -> bool {
        self.members == self.size
    }

    /// Returns how many invocations of each workgroup run, and how many it has.
    pub(super) fn part(&self) -> (u32, u32) {
        (self.members, self.size)
    }
}
