//! What invocations share, seen from one of them: events go out, replies come back.
//!
//! The model of memory is whoever implements [`Shared`]; [`Sequential`] is the plainest, where everything happens at once.

/// A word of a buffer.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Place {
    /// The program's number of the buffer.
    pub buffer: u16,
    /// The word, from 0.
    pub word: u32,
}

/// What is done to a place.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Operation {
    /// Read.
    Load,
    /// Write.
    Store,
    /// Read and write as one.
    Atomic(Atomic),
}

/// What an atomic operation writes, from the old value and the operand.
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
    /// Where; the first word of two where `words` is 2.
    pub place: Place,
    /// What.
    pub operation: Operation,
    /// Words, 1 or 2.
    pub words: u8,
    /// Whether the place is declared atomic. A plain access that meets another is a data race.
    pub is_atomic: bool,
    /// What is written, or the operand.
    pub value: u64,
    /// What the old value must be, for a compare-exchange.
    pub expected: u64,
}

impl Access {
    /// Whether it can change memory.
    pub fn writes(&self) -> bool {
        self.operation != Operation::Load
    }

    /// What stands there afterwards, if `old` stood there before.
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

/// Something that other invocations can notice, about to happen.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Event {
    /// An access to memory that can be written.
    Access(Access),
    /// A memory fence.
    Fence,
    /// Every invocation of the workgroup must arrive.
    Barrier,
    /// The interlock begins.
    CriticalBegin,
    /// The interlock ends.
    CriticalEnd,
}

/// The answer to an event.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reply {
    /// It has happened; the old value, for a load or an atomic operation.
    Done(u64),
    /// Not yet: the machine stops before it.
    Stop,
}

/// Memory as one invocation sees it.
pub trait Shared {
    /// Words of a buffer.
    fn length(&self, buffer: u16) -> u32;
    /// A word of a buffer that this program never writes.
    fn constant(&self, place: Place) -> u32;
    /// The four numbers of a texel: column, row, and sample or level. `None`: there is no such texel.
    fn texel(&self, _texture: u16, _place: [u32; 3]) -> Option<[u32; 4]> {
        None
    }
    /// Columns, rows and samples of a texture.
    fn extent(&self, _texture: u16) -> [u32; 3] {
        [0; 3]
    }
    /// Something is about to happen.
    fn event(&mut self, event: &Event) -> Reply;
}

/// Memory where everything happens at once, in the order in which it is asked for: one slice per buffer of the program.
/// Barriers stop.
pub struct Sequential<'a> {
    /// The buffers, by the program's numbers.
    pub buffers: &'a mut [Vec<u32>],
}

impl Sequential<'_> {
    fn read(&self, place: Place, words: u8) -> u64 {
        let buffer = &self.buffers[usize::from(place.buffer)];
        let word = |offset: u32| u64::from(buffer.get((place.word + offset) as usize).copied().unwrap_or(0));
        if words == 1 { word(0) } else { word(0) | word(1) << 32 }
    }
}

impl Shared for Sequential<'_> {
    fn length(&self, buffer: u16) -> u32 {
        self.buffers[usize::from(buffer)].len() as u32
    }

    fn constant(&self, place: Place) -> u32 {
        self.read(place, 1) as u32
    }

    fn event(&mut self, event: &Event) -> Reply {
        match event {
            Event::Access(access) => {
                let old = self.read(access.place, access.words);
                let new = access.new_value(old);
                if access.writes() {
                    let buffer = &mut self.buffers[usize::from(access.place.buffer)];
                    for offset in 0..u32::from(access.words) {
                        if let Some(word) = buffer.get_mut((access.place.word + offset) as usize) {
                            *word = (new >> (32 * offset)) as u32;
                        }
                    }
                }
                Reply::Done(old)
            }
            Event::Barrier => Reply::Stop,
            Event::Fence | Event::CriticalBegin | Event::CriticalEnd => Reply::Done(0),
        }
    }
}
