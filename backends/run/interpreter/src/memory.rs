//! Shared memory as one invocation accesses it: it sends events and receives replies.
//!
//! A memory model implements [`SharedMemory`]. [`Sequential`] is the simplest: every access takes effect at once.

/// The address of a word in a buffer.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct WordAddress {
    /// The number of the buffer in the program.
    pub buffer: u16,
    /// The index of the word.
    pub word: u32,
}

/// The operation of an access.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Operation {
    /// A read.
    Load,
    /// A write.
    Store,
    /// An atomic read and write.
    Atomic(Atomic),
}

/// The function of an atomic operation: it computes the new value from the old one and the operand.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[allow(missing_docs, reason = "WGSL's own names")]
pub enum Atomic {
    Add,
    Subtract,
    And,
    Or,
    ExclusiveOr,
    Min,
    Max,
    SignedMin,
    SignedMax,
    Exchange,
    CompareExchange,
}

/// One access to shared memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Access {
    /// The address of the first word.
    pub address: WordAddress,
    /// The operation.
    pub operation: Operation,
    /// The width in words: 1 or 2.
    pub words: u8,
    /// Whether the word is declared atomic. A concurrent plain access is a data race.
    pub is_atomic: bool,
    /// The value to write, or the operand.
    pub value: u64,
    /// The expected old value of a compare-exchange.
    pub expected: u64,
}

impl Access {
    /// Returns whether the access can change memory.
    pub fn writes(&self) -> bool {
        self.operation != Operation::Load
    }

    /// Returns the new value of the word if its old value is `old`.
    pub fn new_value(&self, old: u64) -> u64 {
        let mask = if self.words == 1 { u64::from(u32::MAX) } else { u64::MAX };
        let signed = |value: u64| if self.words == 1 { i64::from(value as u32 as i32) } else { value as i64 };
        let new = match self.operation {
            Operation::Load => old,
            Operation::Store => self.value,
            Operation::Atomic(function) => match function {
                Atomic::Add => old.wrapping_add(self.value),
                Atomic::Subtract => old.wrapping_sub(self.value),
                Atomic::And => old & self.value,
                Atomic::Or => old | self.value,
                Atomic::ExclusiveOr => old ^ self.value,
                Atomic::Min => old.min(self.value),
                Atomic::Max => old.max(self.value),
                Atomic::SignedMin => signed(old).min(signed(self.value)) as u64,
                Atomic::SignedMax => signed(old).max(signed(self.value)) as u64,
                Atomic::Exchange => self.value,
                Atomic::CompareExchange if old == self.expected => self.value,
                Atomic::CompareExchange => old,
            },
        };
        new & mask
    }
}

/// The memory whose accesses a workgroup barrier orders.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Barrier {
    /// Storage buffers.
    pub storage: bool,
    /// Workgroup variables.
    pub workgroup: bool,
}

/// An operation that other invocations can observe, before it takes effect.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Event {
    /// An access to writable memory.
    Access(Access),
    /// A memory fence.
    Fence,
    /// A workgroup barrier.
    Barrier(Barrier),
    /// The beginning of the interlock.
    CriticalBegin,
    /// The end of the interlock.
    CriticalEnd,
}

/// The answer to an event.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reply {
    /// The operation has taken effect. A load or an atomic operation returns the old value.
    Done(u64),
    /// A weak compare-exchange has failed although the word holds the expected value, which is given.
    Failed(u64),
    /// The machine stops before the operation.
    Stop,
}

/// Memory as seen by one invocation.
pub trait SharedMemory {
    /// Returns the length of a buffer in words.
    fn length(&self, buffer: u16) -> u32;
    /// Returns a word of a buffer that the program does not write.
    fn constant(&self, address: WordAddress) -> u32;
    /// Returns the four channels of the texel at a column, row, and sample or level. `None`: out of bounds.
    fn texel(&self, _texture: u16, _coordinates: [u32; 3]) -> Option<[u32; 4]> {
        None
    }
    /// Returns the columns, rows, and samples or slices of a texture.
    fn extent(&self, _texture: u16) -> [u32; 3] {
        [0; 3]
    }
    /// Performs an operation, or stops the machine before it.
    fn event(&mut self, event: &Event) -> Reply;
}

/// Sequentially consistent memory: every access takes effect at once. Machines stop at barriers.
pub struct Sequential<'a> {
    /// The buffers, by their numbers in the program.
    pub buffers: &'a mut [Vec<u32>],
}

impl Sequential<'_> {
    fn read(&self, address: WordAddress, words: u8) -> u64 {
        let buffer = &self.buffers[usize::from(address.buffer)];
        let word = |offset: u32| u64::from(buffer.get((address.word + offset) as usize).copied().unwrap_or(0));
        if words == 1 { word(0) } else { word(0) | word(1) << 32 }
    }
}

impl SharedMemory for Sequential<'_> {
    fn length(&self, buffer: u16) -> u32 {
        self.buffers[usize::from(buffer)].len() as u32
    }

    fn constant(&self, address: WordAddress) -> u32 {
        self.read(address, 1) as u32
    }

    fn event(&mut self, event: &Event) -> Reply {
        match event {
            Event::Access(access) => {
                let old = self.read(access.address, access.words);
                let new = access.new_value(old);
                if access.writes() {
                    let buffer = &mut self.buffers[usize::from(access.address.buffer)];
                    for offset in 0..u32::from(access.words) {
                        if let Some(word) = buffer.get_mut((access.address.word + offset) as usize) {
                            *word = (new >> (32 * offset)) as u32;
                        }
                    }
                }
                Reply::Done(old)
            }
            Event::Barrier(_) => Reply::Stop,
            Event::Fence | Event::CriticalBegin | Event::CriticalEnd => Reply::Done(0),
        }
    }
}
