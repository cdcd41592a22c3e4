//! The memory of a frame: a buffer or a texture per resource, all of them or none. Buffers have as many bytes as the plan's
//! formula says; textures are as large as the frame, whatever its slices. Textures that the caller brings are held, not made.

use fragbuf_codegen::{Plan, Planned};
use fragbuf_frame::{Values, bytes};
use fragbuf_templates::vocabulary::{Access, Element};

use crate::Error;
use crate::scope::scoped;
use crate::texture::{create_texture, texture_bytes};

/// The buffers and textures of a plan's resources at one size.
#[derive(Clone)]
pub(crate) struct Memory {
    /// One per resource.
    held: Vec<Held>,
}

#[derive(Clone)]
struct Held {
    memory: Kind,
    /// 0: the buffer only stands in for an empty resource, because nothing empty can be bound.
    size: u64,
}

#[derive(Clone)]
enum Kind {
    Buffer(wgpu::Buffer),
    Texture(wgpu::Texture),
    /// What is bound in the place of a texture that the caller has not brought yet.
    Missing(wgpu::Texture),
}

/// Bytes of a buffer that stands in for an empty resource.
const PLACEHOLDER: u64 = 16;

impl Memory {
    /// Memory for `values`. What has the right size already is taken over from `old`.
    pub(crate) async fn allocate(
        device: &wgpu::Device,
        plan: &Plan,
        values: &Values,
        old: Option<&Memory>,
    ) -> Result<Self, Error> {
        let sizes = checked_sizes(plan, values, &device.limits())?;
        let mut held = Vec::with_capacity(sizes.len());
        for (index, (size, planned)) in sizes.into_iter().zip(&plan.resources).enumerate() {
            let old = old.and_then(|old| old.held.get(index));
            held.push(hold(device, plan, planned, (values, size), old).await?);
        }
        Ok(Memory { held })
    }

    /// What to bind for a resource that is no texture.
    pub(crate) fn buffer(&self, index: usize) -> Option<&wgpu::Buffer> {
        match &self.held.get(index)?.memory {
            Kind::Buffer(buffer) => Some(buffer),
            Kind::Texture(_) | Kind::Missing(_) => None,
        }
    }

    /// The buffer of a resource that is not empty.
    pub(crate) fn filled(&self, index: usize) -> Option<&wgpu::Buffer> {
        self.held.get(index).filter(|held| held.size > 0)?;
        self.buffer(index)
    }

    /// The texture of a resource that is one, once the caller has brought it if that is the caller's to do.
    pub(crate) fn texture(&self, index: usize) -> Option<&wgpu::Texture> {
        match &self.held.get(index)?.memory {
            Kind::Texture(texture) => Some(texture),
            Kind::Buffer(_) | Kind::Missing(_) => None,
        }
    }

    /// What to bind for a resource that is a texture.
    pub(crate) fn bound_texture(&self, index: usize) -> Option<&wgpu::Texture> {
        match &self.held.get(index)?.memory {
            Kind::Texture(texture) | Kind::Missing(texture) => Some(texture),
            Kind::Buffer(_) => None,
        }
    }

    /// Takes a texture of the caller's, which fits.
    pub(crate) fn bring(&mut self, index: usize, texture: &wgpu::Texture) {
        if let Some(held) = self.held.get_mut(index) {
            held.memory = Kind::Texture(texture.clone());
        }
    }

    /// The number of a resource that the caller has not brought yet.
    pub(crate) fn missing(&self) -> Option<usize> {
        self.held.iter().position(|held| matches!(held.memory, Kind::Missing(_)))
    }

    /// Bytes of all buffers as they are, those apart that stand in for empty resources, and of all textures as the plan
    /// counts them, but for what the caller brings.
    pub(crate) fn bytes(&self) -> u64 {
        let bytes = |held: &Held| match &held.memory {
            Kind::Buffer(buffer) => buffer.size(),
            Kind::Texture(_) | Kind::Missing(_) => held.size,
        };
        self.held.iter().filter(|held| held.size > 0).map(bytes).sum()
    }
}

async fn hold(
    device: &wgpu::Device,
    plan: &Plan,
    planned: &Planned,
    (values, size): (&Values, u64),
    old: Option<&Held>,
) -> Result<Held, Error> {
    let what = format!("`{}`", planned.resource.name);
    if let Element::Texture(format) = planned.resource.element {
        let brought = planned.is_brought();
        let size = if brought { 0 } else { texture_bytes(planned, values)? };
        let frame = (values.width(), values.height());
        let same = |texture: &wgpu::Texture| (texture.width(), texture.height()) == frame;
        let memory = match old.map(|old| &old.memory) {
            Some(Kind::Texture(texture)) if same(texture) => Kind::Texture(texture.clone()),
            _ if brought => {
                let make = || create_texture(device, plan, planned, format, (1, 1));
                Kind::Missing(scoped(device, &what, size, make).await??)
            }
            _ => {
                let make = || create_texture(device, plan, planned, format, frame);
                Kind::Texture(scoped(device, &what, size, make).await??)
            }
        };
        return Ok(Held { memory, size });
    }
    let memory = match old.filter(|held| held.size == size).map(|held| &held.memory) {
        Some(kept @ Kind::Buffer(_)) => kept.clone(),
        _ => {
            let size = if size == 0 { PLACEHOLDER } else { size };
            let make = || create(device, &planned.resource.name, size, is_indirect(plan, planned));
            Kind::Buffer(scoped(device, &what, size, make).await?)
        }
    };
    Ok(Held { memory, size })
}

/// Whether a pass takes the arguments of its draw or dispatch from a resource.
fn is_indirect(plan: &Plan, planned: &Planned) -> bool {
    let mut uses = plan.passes.iter().flat_map(|pass| &pass.uses);
    uses.any(|usage| usage.resource == planned.resource.name && usage.access == Access::Indirect)
}

fn create(device: &wgpu::Device, name: &str, size: u64, is_indirect: bool) -> wgpu::Buffer {
    let mut usage = wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC | wgpu::BufferUsages::COPY_DST;
    if is_indirect {
        usage |= wgpu::BufferUsages::INDIRECT;
    }
    device.create_buffer(&wgpu::BufferDescriptor { label: Some(name), size, usage, mapped_at_creation: false })
}

/// Bytes of every resource, each within the limits. Textures have limits of their own.
pub(crate) fn checked_sizes(plan: &Plan, values: &Values, limits: &wgpu::Limits) -> Result<Vec<u64>, Error> {
    let sizes = bytes(plan, values)?.into_iter().zip(&plan.resources);
    let checked = sizes.map(|((name, bytes), planned)| match planned.resource.element {
        Element::Texture(_) => Ok(bytes),
        _ => check(limits, name, bytes).map(|()| bytes),
    });
    checked.collect()
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
