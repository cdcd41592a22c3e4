//! The buffers of a frame: one per resource, as many bytes as the plan's formula says, all of them or none.

use fragbuf_codegen::Plan;
use fragbuf_frame::{Symbols, bytes};

use crate::Error;
use crate::scope::scoped;

/// The buffers of a plan's resources at one size.
pub(crate) struct Memory {
    /// One per resource.
    held: Vec<Held>,
}

struct Held {
    buffer: wgpu::Buffer,
    /// 0: the buffer only stands in for an empty resource, because nothing empty can be bound.
    size: u64,
}

/// Bytes of a buffer that stands in for an empty resource.
const PLACEHOLDER: u64 = 16;

impl Memory {
    /// Buffers for `symbols`. Those that have the right size already are taken over from `old`.
    pub(crate) async fn allocate(
        device: &wgpu::Device,
        plan: &Plan,
        symbols: &Symbols,
        old: Option<&Memory>,
    ) -> Result<Self, Error> {
        let sizes = checked_sizes(plan, symbols, &device.limits())?;
        let mut held = Vec::with_capacity(sizes.len());
        for (index, (size, planned)) in sizes.into_iter().zip(&plan.resources).enumerate() {
            let kept = old.and_then(|old| old.held.get(index)).filter(|held| held.size == size);
            let buffer = match kept {
                Some(kept) => kept.buffer.clone(),
                None => {
                    let name = &planned.resource.name;
                    let make = || create(device, name, if size == 0 { PLACEHOLDER } else { size });
                    scoped(device, &format!("`{name}`"), size, make).await?
                }
            };
            held.push(Held { buffer, size });
        }
        Ok(Memory { held })
    }

    /// What to bind for a resource.
    pub(crate) fn buffer(&self, index: usize) -> Option<&wgpu::Buffer> {
        self.held.get(index).map(|held| &held.buffer)
    }

    /// The buffer of a resource that is not empty.
    pub(crate) fn filled(&self, index: usize) -> Option<&wgpu::Buffer> {
        self.held.get(index).filter(|held| held.size > 0).map(|held| &held.buffer)
    }

    /// Bytes of all buffers as they are, those apart that stand in for empty resources.
    pub(crate) fn bytes(&self) -> u64 {
        self.held.iter().filter(|held| held.size > 0).map(|held| held.buffer.size()).sum()
    }
}

fn create(device: &wgpu::Device, name: &str, size: u64) -> wgpu::Buffer {
    let usage = wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC | wgpu::BufferUsages::COPY_DST;
    device.create_buffer(&wgpu::BufferDescriptor { label: Some(name), size, usage, mapped_at_creation: false })
}

/// Bytes of every resource, each within the limits.
pub(crate) fn checked_sizes(plan: &Plan, symbols: &Symbols, limits: &wgpu::Limits) -> Result<Vec<u64>, Error> {
    bytes(plan, symbols)?.into_iter().map(|(name, bytes)| check(limits, name, bytes).map(|()| bytes)).collect()
}

fn check(limits: &wgpu::Limits, name: &str, needed: u64) -> Result<(), Error> {
    let binding = (limits.max_storage_buffer_binding_size, "max_storage_buffer_binding_size, in bytes");
    let buffer = (limits.max_buffer_size, "max_buffer_size, in bytes");
    let (limit, limit_name) = if binding.0 <= buffer.0 { binding } else { buffer };
    if needed <= limit {
        return Ok(());
    }
    Err(Error::TooLarge {
        what: format!("`{name}`"),
        needed,
        limit,
        limit_name,
        hint: "take a smaller frame or lower slices, keep fewer fragments, reserve less, or request a device with the adapter's own limits",
    })
}
