//! The memory that a machine uses between two states of a search: it answers one event and stops at the next.
//!
//! Input: the words of a state and the reply to the event at which the machine has stopped. Output: the machine at its next
//! event. The search chooses which event is performed.

use fragbuf_interpreter::{Access, Event, Reply, SharedMemory, WordAddress};

use crate::context::{BufferLocation, SearchContext};
use crate::memory::memory_index;
use crate::runner::CommutingWrite;

/// Memory that answers one event, then stops. Accesses that commute are performed at once, because no program can observe
/// their order.
pub(crate) struct Pausing<'a, 'p> {
    pub(crate) context: &'a SearchContext<'p>,
    pub(crate) reply: Option<Reply>,
    pub(crate) words: &'a mut [u32],
    /// Whether accesses that commute have no effect, as those of a helper invocation.
    pub(crate) is_helper: bool,
    /// The accesses that commute and were performed.
    pub(crate) commuting: &'a mut Vec<CommutingWrite>,
}

impl SharedMemory for Pausing<'_, '_> {
    fn length(&self, buffer: u16) -> u32 {
        match self.context.locations[usize::from(buffer)] {
            BufferLocation::ReadOnly(index) => self.context.read_only[index].len() as u32,
            BufferLocation::State { words, .. } => words as u32,
        }
    }

    fn constant(&self, address: WordAddress) -> u32 {
        let word = match self.context.locations[usize::from(address.buffer)] {
            BufferLocation::ReadOnly(index) => self.context.read_only[index].get(address.word as usize),
            BufferLocation::State { first, .. } => self.words.get(first + address.word as usize),
        };
        word.copied().unwrap_or(0)
    }

    fn texel(&self, texture: u16, position: [u32; 3]) -> Option<[u32; 4]> {
        let texture = self.context.program.textures.get(usize::from(texture))?;
        self.context.texels.texel(self.context.read_only.get(memory_index(texture.binding))?, position)
    }

    fn extent(&self, _texture: u16) -> [u32; 3] {
        [self.context.texels.width, self.context.texels.height, 1]
    }

    fn event(&mut self, event: &Event) -> Reply {
        match event {
            Event::Access(access) => {
                let location = self.context.locations[usize::from(access.address.buffer)];
                // Loads of one word are constants of the program. Those of two words come here.
                if let BufferLocation::ReadOnly(index) = location {
                    let words = self.context.read_only[index].get(access.address.word as usize..);
                    let words = words.filter(|words| words.len() >= usize::from(access.words));
                    return Reply::Done(words.map_or(0, |words| value(words, access.words)));
                }
                if let BufferLocation::State { first, commutes: true, .. } = location {
                    if self.is_helper {
                        return Reply::Done(0);
                    }
                    let word = first + access.address.word as usize;
                    self.commuting.push((word as u32, *access));
                    return Reply::Done(perform(access, &mut self.words[word..]));
                }
            }
            Event::Fence if !self.context.has_fences => return Reply::Done(0),
            _ => {}
        }
        self.reply.take().unwrap_or(Reply::Stop)
    }
}

/// Performs an access at once; returns the old value.
pub(crate) fn perform(access: &Access, words: &mut [u32]) -> u64 {
    let old = value(words, access.words);
    if access.writes() {
        let new = access.new_value(old);
        words[0] = new as u32;
        if access.words == 2 {
            words[1] = (new >> 32) as u32;
        }
    }
    old
}

/// Returns the value of the first word, or of the first two.
pub(crate) fn value(words: &[u32], count: u8) -> u64 {
    let low = u64::from(words[0]);
    if count == 2 { low | u64::from(words[1]) << 32 } else { low }
}
