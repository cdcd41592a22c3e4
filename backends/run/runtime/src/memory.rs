//! The memory of a frame: a buffer or a texture per resource, allocated all together or not at all. A buffer has the bytes of the
//! plan's formula. A texture has the size of the frame, independent of slices. The caller supplies external textures.

use fragbuf_codegen::{Plan, PlannedResource};
use fragbuf_frame::{MemoryLimits, Values};
use fragbuf_templates::vocabulary::{Access, Element, TextureDimension};

use crate::Error;
use crate::error_scope::in_error_scope;
use crate::texture::create_texture;

/// The buffers and textures of a plan's resources at one size.
#[derive(Clone)]
pub(crate) struct Memory {
    /// One per resource.
    allocations: Vec<Allocation>,
}

#[derive(Clone)]
struct Allocation {
    object: DeviceObject,
    /// 0: the buffer is a placeholder for an empty resource, because WebGPU cannot bind an empty buffer.
    size: u64,
}

#[derive(Clone)]
enum DeviceObject {
    Buffer(wgpu::Buffer),
    Texture(wgpu::Texture),
    /// A placeholder for an external texture that the caller has not set yet.
    MissingTexture(wgpu::Texture),
}

/// The bytes of a placeholder for an empty resource.
const PLACEHOLDER: u64 = 16;

impl Memory {
    /// Allocates memory for `values` within the limits. Objects of the right size come from `old`.
    pub(crate) async fn allocate(
        device: &wgpu::Device,
        (plan, limits): (&Plan, &MemoryLimits),
        values: &Values,
        old: Option<&Memory>,
    ) -> Result<Self, Error> {
        let sizes = limits.sizes(plan, values)?;
        let mut allocations = Vec::with_capacity(sizes.len());
        for (index, (size, planned)) in sizes.into_iter().zip(&plan.resources).enumerate() {
            let old = old.and_then(|old| old.allocations.get(index));
            allocations.push(allocate(device, plan, planned, (values, size), old).await?);
        }
        Ok(Memory { allocations })
    }

    /// Returns the buffer to bind for a resource that is no texture. It is a placeholder if the resource is empty.
    pub(crate) fn buffer_to_bind(&self, index: usize) -> Option<&wgpu::Buffer> {
        match &self.allocations.get(index)?.object {
            DeviceObject::Buffer(buffer) => Some(buffer),
            DeviceObject::Texture(_) | DeviceObject::MissingTexture(_) => None,
        }
    }

    /// Returns the buffer of a resource that is not empty.
    pub(crate) fn buffer(&self, index: usize) -> Option<&wgpu::Buffer> {
        self.allocations.get(index).filter(|allocation| allocation.size > 0)?;
        self.buffer_to_bind(index)
    }

    /// Returns the texture of a resource; `None` for a buffer, and for an external texture that the caller has not set.
    pub(crate) fn texture(&self, index: usize) -> Option<&wgpu::Texture> {
        match &self.allocations.get(index)?.object {
            DeviceObject::Texture(texture) => Some(texture),
            DeviceObject::Buffer(_) | DeviceObject::MissingTexture(_) => None,
        }
    }

    /// Returns the texture to bind for a resource that is a texture. It is a placeholder if the caller has not set one.
    pub(crate) fn texture_to_bind(&self, index: usize) -> Option<&wgpu::Texture> {
        match &self.allocations.get(index)?.object {
            DeviceObject::Texture(texture) | DeviceObject::MissingTexture(texture) => Some(texture),
            DeviceObject::Buffer(_) => None,
        }
    }

    /// Sets an external texture, whose properties have been checked.
    pub(crate) fn set_texture(&mut self, index: usize, texture: &wgpu::Texture) {
        if let Some(allocation) = self.allocations.get_mut(index) {
            allocation.object = DeviceObject::Texture(texture.clone());
        }
    }

    /// Returns the number of an external texture that the caller has not set.
    pub(crate) fn missing_texture(&self) -> Option<usize> {
        self.allocations.iter().position(|allocation| matches!(allocation.object, DeviceObject::MissingTexture(_)))
    }

    /// Returns the bytes of all buffers without placeholders, as wgpu reports them, and of all textures but external ones, by
    /// the plan's formulas.
    pub(crate) fn bytes(&self) -> u64 {
        let bytes = |allocation: &Allocation| match &allocation.object {
            DeviceObject::Buffer(buffer) => buffer.size(),
            DeviceObject::Texture(_) | DeviceObject::MissingTexture(_) => allocation.size,
        };
        self.allocations.iter().filter(|allocation| allocation.size > 0).map(bytes).sum()
    }
}

/// Creates a texture of one texel, to bind until the caller sets a texture of the description.
fn placeholder(device: &wgpu::Device, name: &str, dimension: TextureDimension) -> wgpu::Texture {
    device.create_texture(&wgpu::TextureDescriptor {
        label: Some(name),
        size: wgpu::Extent3d { width: 1, height: 1, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: match dimension {
            TextureDimension::D2 => wgpu::TextureDimension::D2,
            TextureDimension::D3 => wgpu::TextureDimension::D3,
        },
        format: wgpu::TextureFormat::Rgba8Unorm,
        usage: wgpu::TextureUsages::TEXTURE_BINDING,
        view_formats: &[],
    })
}

async fn allocate(
    device: &wgpu::Device,
    plan: &Plan,
    planned: &PlannedResource,
    (values, size): (&Values, u64),
    old: Option<&Allocation>,
) -> Result<Allocation, Error> {
    let what = format!("`{}`", planned.resource.name);
    if let Element::Texels(dimension) = planned.resource.element {
        let object = match old.map(|old| &old.object) {
            Some(kept @ (DeviceObject::Texture(_) | DeviceObject::MissingTexture(_))) => kept.clone(),
            _ => {
                let make = || placeholder(device, &planned.resource.name, dimension);
                DeviceObject::MissingTexture(in_error_scope(device, &what, size, make).await?)
            }
        };
        return Ok(Allocation { object, size });
    }
    if let Element::Texture(format) = planned.resource.element {
        let is_external = planned.is_external();
        let frame = (values.width(), values.height());
        let same = |texture: &wgpu::Texture| (texture.width(), texture.height()) == frame;
        let object = match old.map(|old| &old.object) {
            Some(DeviceObject::Texture(texture)) if same(texture) => DeviceObject::Texture(texture.clone()),
            _ if is_external => {
                let make = || create_texture(device, plan, planned, format, (1, 1));
                DeviceObject::MissingTexture(in_error_scope(device, &what, size, make).await??)
            }
            _ => {
                let make = || create_texture(device, plan, planned, format, frame);
                DeviceObject::Texture(in_error_scope(device, &what, size, make).await??)
            }
        };
        return Ok(Allocation { object, size });
    }
    let object = match old.filter(|old| old.size == size).map(|old| &old.object) {
        Some(kept @ DeviceObject::Buffer(_)) => kept.clone(),
        _ => {
            let size = if size == 0 { PLACEHOLDER } else { size };
            let make = || create_buffer(device, &planned.resource.name, size, is_indirect(plan, planned));
            DeviceObject::Buffer(in_error_scope(device, &what, size, make).await?)
        }
    };
    Ok(Allocation { object, size })
}

/// Whether a pass reads the arguments of its draw or dispatch from a resource.
fn is_indirect(plan: &Plan, planned: &PlannedResource) -> bool {
    let mut uses = plan.passes.iter().flat_map(|pass| &pass.uses);
    uses.any(|usage| usage.resource == planned.resource.name && usage.access == Access::Indirect)
}

fn create_buffer(device: &wgpu::Device, name: &str, size: u64, is_indirect: bool) -> wgpu::Buffer {
    let mut usage = wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC | wgpu::BufferUsages::COPY_DST;
    if is_indirect {
        usage |= wgpu::BufferUsages::INDIRECT;
    }
    device.create_buffer(&wgpu::BufferDescriptor { label: Some(name), size, usage, mapped_at_creation: false })
}
