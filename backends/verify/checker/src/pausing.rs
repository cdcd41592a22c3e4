//! What a machine meets between two states of a search: memory that answers one event and stops at the next.
//!
//! In: the words of a state and the answer to the event that the machine stands before. Out: the machine at its next event.
//! Nothing here decides which event happens.

use fragbuf_interpreter::{Access, Event, Place, Reply, Shared};

use crate::frame::WIDTH;
use crate::state::{Ground, Home, joined};
use crate::subject::Subject;
use crate::texels::texel;

/// Answers one event, then stops. What commutes happens at once: no order of it can be told from another.
pub(crate) struct Pausing<'a, 'p> {
    pub(crate) ground: &'a Ground<'p>,
    pub(crate) reply: Option<u64>,
    pub(crate) words: &'a mut [u32],
    pub(crate) is_idle: bool,
}

impl Shared for Pausing<'_, '_> {
    fn length(&self, buffer: u16) -> u32 {
        match self.ground.homes[usize::from(buffer)] {
            Home::Fixed(number) => self.ground.fixed[number].len() as u32,
            Home::Moving { words, .. } => words as u32,
        }
    }

    fn constant(&self, place: Place) -> u32 {
        match self.ground.homes[usize::from(place.buffer)] {
            Home::Fixed(number) => self.ground.fixed[number].get(place.word as usize).copied().unwrap_or(0),
            Home::Moving { first, .. } => self.words.get(first + place.word as usize).copied().unwrap_or(0),
        }
    }

    fn texel(&self, texture: u16, place: [u32; 3]) -> Option<[u32; 4]> {
        let texture = self.ground.program.textures.get(usize::from(texture))?;
        texel(self.ground.fixed.get(Subject::memory_of(texture.binding))?, place)
    }

    fn extent(&self, _texture: u16) -> [u32; 3] {
        [WIDTH, 1, 1]
    }

    fn event(&mut self, event: &Event) -> Reply {
        match event {
            Event::Access(access) => {
                if let Home::Moving { first, commutes: true, .. } = self.ground.homes[usize::from(access.place.buffer)]
                {
                    if self.is_idle {
                        return Reply::Done(0);
                    }
                    return Reply::Done(apply(access, &mut self.words[first + access.place.word as usize..]));
                }
            }
            Event::Fence if !self.ground.has_fences => return Reply::Done(0),
            _ => {}
        }
        self.reply.take().map_or(Reply::Stop, Reply::Done)
    }
}

/// Lets an access happen at once; the old value.
pub(crate) fn apply(access: &Access, words: &mut [u32]) -> u64 {
    let old = joined(words, access.words);
    if access.writes() {
        let new = access.new_value(old);
        words[0] = new as u32;
        if access.words == 2 {
            words[1] = (new >> 32) as u32;
        }
    }
    old
}
