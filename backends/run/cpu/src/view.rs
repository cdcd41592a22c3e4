//! The memory of one program: its buffers and textures by number. Every access takes effect at once.

use std::sync::atomic::{AtomicU32, Ordering};
use std::sync::{Mutex, PoisonError};

use fragbuf_interpreter::{Access, Event, LaneMemory, Reply, SharedMemory, WordAddress};

use crate::bound_texture::BoundTexture;

/// The buffers and textures of a program, by their numbers.
#[derive(Clone)]
pub(crate) struct View<'a> {
    pub(crate) buffers: Vec<&'a [AtomicU32]>,
    pub(crate) textures: Vec<BoundTexture<'a>>,
    /// Locked during 64-bit accesses, which are two words here.
    pub(crate) wide: &'a Mutex<()>,
}

impl View<'_> {
    fn word(&self, address: WordAddress) -> &AtomicU32 {
        &self.buffers[usize::from(address.buffer)][address.word as usize]
    }

    /// Performs an access; returns the old value.
    pub(crate) fn access(&self, access: &Access) -> u64 {
        if access.words == 1 { access.perform(self.word(access.address)).into() } else { self.perform_wide(access) }
    }

    fn perform_wide(&self, access: &Access) -> u64 {
        let _guard = self.wide.lock().unwrap_or_else(PoisonError::into_inner);
        let low = self.word(access.address);
        let high = self.word(WordAddress { word: access.address.word + 1, ..access.address });
        let old = u64::from(low.load(Ordering::Relaxed)) | u64::from(high.load(Ordering::Relaxed)) << 32;
        if access.writes() {
            let new = access.new_value(old);
            low.store(new as u32, Ordering::Relaxed);
            high.store((new >> 32) as u32, Ordering::Relaxed);
        }
        old
    }
}

impl SharedMemory for View<'_> {
    #[inline]
    fn length(&self, buffer: u16) -> u32 {
        self.buffers[usize::from(buffer)].len() as u32
    }

    #[inline]
    fn constant(&self, address: WordAddress) -> u32 {
        self.word(address).load(Ordering::Relaxed)
    }

    fn texel(&self, texture: u16, coordinates: [u32; 3]) -> Option<[u32; 4]> {
        self.textures[usize::from(texture)].texel(coordinates)
    }

    fn extent(&self, texture: u16) -> [u32; 3] {
        self.textures[usize::from(texture)].extent()
    }

    #[inline]
    fn event(&mut self, event: &Event) -> Reply {
        match event {
            Event::Access(access) => Reply::Done(self.access(access)),
            Event::Barrier(_) => Reply::Stop,
            Event::Fence | Event::CriticalBegin | Event::CriticalEnd => Reply::Done(0),
        }
    }
}

impl LaneMemory for View<'_> {
    #[inline]
    fn words(&self, buffer: u16) -> &[AtomicU32] {
        self.buffers[usize::from(buffer)]
    }

    fn wide(&self, access: &Access) -> u64 {
        self.perform_wide(access)
    }

    fn texel(&self, texture: u16, coordinates: [u32; 3]) -> Option<[u32; 4]> {
        self.textures[usize::from(texture)].texel(coordinates)
    }

    fn extent(&self, texture: u16) -> [u32; 3] {
        self.textures[usize::from(texture)].extent()
    }
}
