//! Runs dispatches in lanes, for tests.

use std::sync::atomic::{AtomicU32, Ordering};

use fragbuf_interpreter::{Access, Bytecode, DispatchEnd, LaneMemory, LaneWorkgroup, Space};

/// The buffers of a program, by number.
pub struct Buffers(pub Vec<Vec<AtomicU32>>);

impl Buffers {
    pub fn of(buffers: &[Vec<u32>]) -> Self {
        Buffers(buffers.iter().map(|words| words.iter().map(|word| AtomicU32::new(*word)).collect()).collect())
    }

    pub fn words(&self) -> Vec<Vec<u32>> {
        self.0.iter().map(|words| words.iter().map(|word| word.load(Ordering::Relaxed)).collect()).collect()
    }
}

impl LaneMemory for Buffers {
    fn words(&self, buffer: u16) -> &[AtomicU32] {
        &self.0[usize::from(buffer)]
    }

    fn wide(&self, access: &Access) -> u64 {
        let words = &self.0[usize::from(access.address.buffer)][access.address.word as usize..][..2];
        let old = u64::from(words[0].load(Ordering::Relaxed)) | u64::from(words[1].load(Ordering::Relaxed)) << 32;
        if access.writes() {
            let new = access.new_value(old);
            words[0].store(new as u32, Ordering::Relaxed);
            words[1].store((new >> 32) as u32, Ordering::Relaxed);
        }
        old
    }

    fn texel(&self, _texture: u16, _coordinates: [u32; 3]) -> Option<[u32; 4]> {
        None
    }

    fn extent(&self, _texture: u16) -> [u32; 3] {
        [0; 3]
    }
}

/// Runs `groups` workgroups, one after the other, as `fragbuf_interpreter::dispatch` does. Those of one invocation become the invocations of
/// one workgroup, so that they share machines.
pub fn dispatch_in_lanes(program: &Bytecode, groups: [u32; 3], buffers: &mut Vec<Vec<u32>>) -> DispatchEnd {
    let (mut program, mut groups) = (program.clone(), groups);
    if program.workgroup_size == [1; 3] {
        std::mem::swap(&mut program.workgroup_size, &mut groups);
    }
    let memory = Buffers::of(buffers);
    let mut workgroup = LaneWorkgroup::new(&program).unwrap();
    let mut outcome = DispatchEnd::Ended;
    let numbers = (0..groups[2]).flat_map(|z| (0..groups[1]).flat_map(move |y| (0..groups[0]).map(move |x| [x, y, z])));
    for group in numbers {
        for (buffer, words) in program.buffers.iter().zip(&memory.0) {
            if buffer.space == Space::Workgroup {
                words.iter().for_each(|word| word.store(buffer.initial, Ordering::Relaxed));
            }
        }
        match workgroup.run(group, groups, &memory) {
            DispatchEnd::Ended => {}
            DispatchEnd::OutOfBounds(access) => outcome = DispatchEnd::OutOfBounds(access),
            other => {
                outcome = other;
                break;
            }
        }
    }
    *buffers = memory.words();
    outcome
}
