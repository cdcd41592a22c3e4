//! Barriers: what must be waited for before a resource is used in another way.
//!
//! Input: how a resource was used since its last write, and its next use. Output: a barrier, if one is needed. Reads
//! in one layout after the same write need none between them.

use ash::vk;

/// A use of a resource by the device.
#[derive(Clone, Copy, PartialEq, Eq)]
pub struct Access {
    pub stages: vk::PipelineStageFlags,
    pub access: vk::AccessFlags,
    /// Of a texture.
    pub layout: vk::ImageLayout,
}

/// What a barrier orders.
#[derive(Clone, Copy, PartialEq, Eq)]
pub struct Barrier {
    pub before: Access,
    pub after: Access,
}

/// The uses of a resource since its last write.
#[derive(Clone, Copy)]
pub struct State {
    /// The last write, or the change of the layout.
    written: Access,
    /// The stages that have read since.
    read: vk::PipelineStageFlags,
    /// The stages and accesses that see the last write.
    seen: (vk::PipelineStageFlags, vk::AccessFlags),
}

const WRITES: vk::AccessFlags = vk::AccessFlags::from_raw(
    vk::AccessFlags::SHADER_WRITE.as_raw()
        | vk::AccessFlags::COLOR_ATTACHMENT_WRITE.as_raw()
        | vk::AccessFlags::DEPTH_STENCIL_ATTACHMENT_WRITE.as_raw()
        | vk::AccessFlags::TRANSFER_WRITE.as_raw(),
);

impl Access {
    pub const COPY_SOURCE: Access = Access::new(
        vk::PipelineStageFlags::TRANSFER,
        vk::AccessFlags::TRANSFER_READ,
        vk::ImageLayout::TRANSFER_SRC_OPTIMAL,
    );
    pub const COPY_TARGET: Access = Access::new(
        vk::PipelineStageFlags::TRANSFER,
        vk::AccessFlags::TRANSFER_WRITE,
        vk::ImageLayout::TRANSFER_DST_OPTIMAL,
    );
    pub const HOST: Access =
        Access::new(vk::PipelineStageFlags::HOST, vk::AccessFlags::HOST_READ, vk::ImageLayout::UNDEFINED);

    pub const fn new(stages: vk::PipelineStageFlags, access: vk::AccessFlags, layout: vk::ImageLayout) -> Self {
        Access { stages, access, layout }
    }

    /// Returns both uses at once. A texture that is attached read-only and sampled has the layout of the attachment.
    pub fn and(self, other: Access) -> Access {
        Access { stages: self.stages | other.stages, access: self.access | other.access, layout: self.layout }
    }
}

impl Default for State {
    fn default() -> Self {
        let nothing =
            Access::new(vk::PipelineStageFlags::empty(), vk::AccessFlags::empty(), vk::ImageLayout::UNDEFINED);
        State { written: nothing, read: vk::PipelineStageFlags::empty(), seen: Default::default() }
    }
}

impl State {
    /// Notes the next use. Returns the barrier before it.
    pub fn change(&mut self, next: Access, is_texture: bool) -> Option<Barrier> {
        let is_other_layout = is_texture && next.layout != self.written.layout;
        let is_write = next.access.intersects(WRITES);
        let before = Access { stages: self.written.stages, ..self.written };
        if is_write || is_other_layout {
            let before = Access { stages: before.stages | self.read, ..before };
            let is_first = before.stages.is_empty() && !is_other_layout;
            let access = next.access & WRITES;
            let seen = if is_write { Default::default() } else { (next.stages, next.access) };
            let read = if is_write { vk::PipelineStageFlags::empty() } else { next.stages };
            *self = State { written: Access { access, ..next }, read, seen };
            return (!is_first).then_some(Barrier { before, after: next });
        }
        self.read |= next.stages;
        let (stages, access) = self.seen;
        if before.stages.is_empty() || stages.contains(next.stages) && access.contains(next.access) {
            return None;
        }
        self.seen = (stages | next.stages, access | next.access);
        Some(Barrier { before, after: next })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use vk::{AccessFlags as A, ImageLayout as L, PipelineStageFlags as S};

    const STORE: Access =
        Access::new(S::FRAGMENT_SHADER, A::from_raw(A::SHADER_READ.as_raw() | A::SHADER_WRITE.as_raw()), L::UNDEFINED);
    const LOAD: Access = Access::new(S::FRAGMENT_SHADER, A::SHADER_READ, L::UNDEFINED);
    const SAMPLE: Access = Access::new(S::FRAGMENT_SHADER, A::SHADER_READ, L::SHADER_READ_ONLY_OPTIMAL);

    #[test]
    fn a_read_after_a_write_waits_for_it_once() {
        let mut state = State::default();
        assert!(state.change(Access::COPY_TARGET, false).is_none());
        assert!(state.change(LOAD, false).map(|barrier| barrier.before.access) == Some(A::TRANSFER_WRITE));
        assert!(state.change(LOAD, false).is_none());
        // Another stage has not seen the write.
        assert!(state.change(Access::COPY_SOURCE, false).map(|barrier| barrier.before.stages) == Some(S::TRANSFER));
        assert!(state.change(LOAD, false).is_none());
    }

    #[test]
    fn a_write_waits_for_every_read_and_for_the_last_write() {
        let mut state = State::default();
        state.change(STORE, false);
        state.change(Access::COPY_SOURCE, false);
        let before = state.change(STORE, false).map(|barrier| (barrier.before.stages, barrier.before.access));
        assert!(before == Some((S::FRAGMENT_SHADER | S::TRANSFER, A::SHADER_WRITE)));
        assert!(state.change(STORE, false).is_some());
    }

    #[test]
    fn a_change_of_the_layout_is_a_write() {
        let mut state = State::default();
        let first = state.change(Access::COPY_TARGET, true);
        assert!(first.map(|barrier| barrier.before.layout) == Some(L::UNDEFINED));
        let second = state.change(SAMPLE, true);
        assert!(
            second.map(|barrier| (barrier.before.layout, barrier.after.layout))
                == Some((L::TRANSFER_DST_OPTIMAL, L::SHADER_READ_ONLY_OPTIMAL))
        );
        assert!(state.change(SAMPLE, true).is_none());
        let back = state.change(Access::COPY_SOURCE, true);
        assert!(back.map(|barrier| barrier.before.stages) == Some(S::FRAGMENT_SHADER));
    }
}
