//! Clears, copies, and transfers between the host and the device. Barriers have been recorded before.

use ash::vk;

use crate::access::Access;
use crate::engine::Engine;
use crate::memory::{Buffer, HostAccess, Memory, Texture, whole};
use crate::names::{aspects, is_depth, is_integer, texel_bytes};
use crate::{Error, OUTPUT};

/// Records a clear of every word to `value`, or of every texel to `texel`.
pub fn clear(
    device: &ash::Device,
    commands: vk::CommandBuffer,
    memory: &Memory,
    value: u32,
    texel: Option<&serde_json::Value>,
) {
    let nothing = serde_json::Value::Null;
    let texel = texel.unwrap_or(&nothing);
    match memory {
        // SAFETY: the command buffer is recording, and the buffer is a copy target now.
        Memory::Buffer(buffer) => unsafe {
            device.cmd_fill_buffer(commands, buffer.buffer, 0, vk::WHOLE_SIZE, value);
        },
        Memory::Texture(texture) => {
            let (image, layout) = (texture.image, Access::COPY_TARGET.layout);
            let range = [whole(aspects(texture.format))];
            if is_depth(texture.format) {
                let depth = texel["depth"].as_f64().unwrap_or(0.0) as f32;
                let stencil = texel["stencil"].as_u64().unwrap_or(0) as u32;
                let value = vk::ClearDepthStencilValue { depth, stencil };
                // SAFETY: as above.
                unsafe { device.cmd_clear_depth_stencil_image(commands, image, layout, &value, &range) };
                return;
            }
            let channel = |index: usize| texel[index].as_f64().unwrap_or(0.0);
            let value = match is_integer(texture.format) {
                true => vk::ClearColorValue { uint32: std::array::from_fn(|index| channel(index) as u32) },
                false => vk::ClearColorValue { float32: std::array::from_fn(|index| channel(index) as f32) },
            };
            // SAFETY: as above.
            unsafe { device.cmd_clear_color_image(commands, image, layout, &value, &range) };
        }
    }
}

/// Records a copy of memory to memory of the same shape.
pub fn copy(device: &ash::Device, commands: vk::CommandBuffer, pair: [&Memory; 2]) -> Result<(), Error> {
    match pair {
        [Memory::Buffer(from), Memory::Buffer(to)] => {
            let region = [vk::BufferCopy::default().size(from.bytes.min(to.bytes))];
            // SAFETY: the command buffer is recording, and the region lies in both buffers.
            unsafe { device.cmd_copy_buffer(commands, from.buffer, to.buffer, &region) };
            Ok(())
        }
        [Memory::Texture(from), Memory::Texture(to)] => {
            let layers = layers(aspects(from.format));
            let region =
                [vk::ImageCopy::default().src_subresource(layers).dst_subresource(layers).extent(extent(from))];
            let layouts = [Access::COPY_SOURCE.layout, Access::COPY_TARGET.layout];
            // SAFETY: the command buffer is recording, and both images have the size of the frame.
            unsafe { device.cmd_copy_image(commands, from.image, layouts[0], to.image, layouts[1], &region) };
            Ok(())
        }
        _ => Err(Error("a buffer is not copied to a texture".to_owned())),
    }
}

fn layers(aspect: vk::ImageAspectFlags) -> vk::ImageSubresourceLayers {
    vk::ImageSubresourceLayers { aspect_mask: aspect, mip_level: 0, base_array_layer: 0, layer_count: 1 }
}

fn extent(texture: &Texture) -> vk::Extent3D {
    vk::Extent3D { width: texture.size[0], height: texture.size[1], depth: texture.slices }
}

impl Engine<'_> {
    /// Waits for the device and returns words of a buffer.
    pub fn words(&mut self, name: &str, first: u64, count: u64) -> Result<Vec<u32>, Error> {
        let Some(memory @ Memory::Buffer(_)) = self.memory.get_mut(name) else {
            return Err(Error(format!("`{name}` is no buffer with memory")));
        };
        self.recorder.transition(memory, Access::COPY_SOURCE)?;
        let Memory::Buffer(buffer) = memory else { return Ok(Vec::new()) };
        let end = first.checked_add(count).and_then(|end| end.checked_mul(4));
        if end.is_none_or(|end| end > buffer.bytes) {
            let bytes = buffer.bytes;
            return Err(Error(format!("{count} words from {first} on are not in `{name}`, which has {bytes} bytes")));
        }
        if count == 0 {
            return Ok(Vec::new());
        }
        let region = [vk::BufferCopy { src_offset: 4 * first, dst_offset: 0, size: 4 * count }];
        let source = buffer.buffer;
        // SAFETY: the region lies in both buffers.
        let copy = |device: &ash::Device, commands, target| unsafe {
            device.cmd_copy_buffer(commands, source, target, &region);
        };
        let bytes = self.recorder.read(4 * count, copy)?;
        Ok(bytes.chunks_exact(4).map(|word| u32::from_le_bytes([word[0], word[1], word[2], word[3]])).collect())
    }

    /// Waits for the device and returns the image.
    pub fn image(&mut self) -> Result<Vec<[f32; 4]>, Error> {
        let Some(memory) = self.memory.get_mut(OUTPUT) else { return Ok(Vec::new()) };
        self.recorder.transition(memory, Access::COPY_SOURCE)?;
        let Memory::Texture(texture) = memory else { return Ok(Vec::new()) };
        let (image, format) = (texture.image, texture.format);
        let texel = texel_bytes(format).unwrap_or(0);
        let bytes = texel * u64::from(texture.size[0]) * u64::from(texture.size[1]);
        let region = [vk::BufferImageCopy::default()
            .image_subresource(layers(vk::ImageAspectFlags::COLOR))
            .image_extent(extent(texture))];
        // SAFETY: the buffer has room for every texel.
        let copy = |device: &ash::Device, commands, target| unsafe {
            device.cmd_copy_image_to_buffer(commands, image, Access::COPY_SOURCE.layout, target, &region);
        };
        let bytes = self.recorder.read(bytes, copy)?;
        let channel = |bytes: &[u8]| match *bytes {
            [a, b] => half(u16::from_le_bytes([a, b])),
            [a, b, c, d] => f32::from_le_bytes([a, b, c, d]),
            _ => 0.0,
        };
        let width = (texel / 4).max(1) as usize;
        let texels = bytes.chunks_exact(4 * width);
        Ok(texels.map(|texel| std::array::from_fn(|index| channel(&texel[index * width..][..width]))).collect())
    }

    /// Uploads the texels of a texture, row by row from the top, and waits for the device.
    pub fn write_texture(&mut self, mut texture: Texture, name: &str, texels: &[u8]) -> Result<(), Error> {
        let [width, height] = texture.size.map(u64::from);
        let texel = texel_bytes(texture.format);
        let wanted = texel.map(|bytes| bytes * width * height * u64::from(texture.slices));
        if wanted != Some(texels.len() as u64) {
            let wanted = wanted.map_or("a format that is written".to_owned(), |wanted| format!("{wanted} bytes"));
            return Err(Error(format!(
                "`{name}` of {width} × {height} texels needs {wanted}, not {} bytes",
                texels.len()
            )));
        }
        let usage = vk::BufferUsageFlags::TRANSFER_SRC;
        let mut source = Buffer::new(&self.gpu, "texels", texels.len() as u64, usage, HostAccess::Write)?;
        source.write(texels);
        let aspect = match is_depth(texture.format) {
            true => vk::ImageAspectFlags::DEPTH,
            false => vk::ImageAspectFlags::COLOR,
        };
        let region = [vk::BufferImageCopy::default().image_subresource(layers(aspect)).image_extent(extent(&texture))];
        let image = texture.image;
        let change = texture.state.change(Access::COPY_TARGET, true);
        self.recorder.barriers(&change.map(|barrier| (barrier, Some(&texture))).into_iter().collect::<Vec<_>>())?;
        let commands = self.recorder.commands()?;
        // SAFETY: the buffer has every texel, and lives until the commands have finished.
        unsafe {
            let layout = Access::COPY_TARGET.layout;
            self.gpu.device.cmd_copy_buffer_to_image(commands, source.buffer, image, layout, &region);
        }
        self.recorder.finish()?;
        self.cache.clear();
        self.memory.insert(name.to_owned(), Memory::Texture(texture));
        Ok(())
    }
}

/// Returns the value of a half-precision float.
fn half(bits: u16) -> f32 {
    let (sign, exponent, fraction) = (bits >> 15, i32::from(bits >> 10 & 0x1f), f32::from(bits & 0x3ff));
    let magnitude = match exponent {
        0 => fraction * 2.0_f32.powi(-24),
        0x1f if fraction == 0.0 => f32::INFINITY,
        0x1f => f32::NAN,
        _ => (1024.0 + fraction) * 2.0_f32.powi(exponent - 25),
    };
    if sign == 1 { -magnitude } else { magnitude }
}

#[cfg(test)]
mod tests {
    use super::half;

    #[test]
    fn halves_have_their_values() {
        let cases =
            [(0x3c00, 1.0), (0xc000, -2.0), (0x3555, 0.333_251_95), (0x0001, 5.960_464_5e-8), (0x7bff, 65504.0)];
        for (bits, value) in cases {
            assert_eq!(half(bits), value);
        }
        assert!(half(0x7c00).is_infinite() && half(0x7e00).is_nan());
    }
}
