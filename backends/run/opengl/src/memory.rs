//! The buffers and textures of a plan.

use std::ptr::from_ref;

use glow::HasContext as _;

use crate::manifest::{Resource, Texture};
use crate::{Context, Error};

/// The memory of one resource.
#[derive(Clone, Copy)]
pub enum Memory {
    Buffer { buffer: glow::Buffer, words: u64 },
    Texture { texture: glow::Texture, kind: u32, format: Format },
}

/// A texture format of the manifest as OpenGL names it.
#[derive(Clone, Copy, PartialEq)]
pub struct Format {
    internal: u32,
    /// The framebuffer attachment, of colour formats the first.
    pub attachment: u32,
}

impl Format {
    pub const OUTPUT: Format = Format { internal: glow::RGBA32F, attachment: glow::COLOR_ATTACHMENT0 };

    fn named(name: &str) -> Result<Self, Error> {
        let (internal, attachment) = match name {
            "r32uint" => (glow::R32UI, glow::COLOR_ATTACHMENT0),
            "rg16uint" => (glow::RG16UI, glow::COLOR_ATTACHMENT0),
            "r32float" => (glow::R32F, glow::COLOR_ATTACHMENT0),
            "rg32float" => (glow::RG32F, glow::COLOR_ATTACHMENT0),
            "rgba8unorm" => (glow::RGBA8, glow::COLOR_ATTACHMENT0),
            "rgba16float" => (glow::RGBA16F, glow::COLOR_ATTACHMENT0),
            "depth32float" => (glow::DEPTH_COMPONENT32F, glow::DEPTH_ATTACHMENT),
            "depth24plus-stencil8" => (glow::DEPTH24_STENCIL8, glow::DEPTH_STENCIL_ATTACHMENT),
            _ => return Err(Error(format!("unknown texture format `{name}`"))),
        };
        Ok(Format { internal, attachment })
    }

    fn is_integer(self) -> bool {
        [glow::R32UI, glow::RG16UI].contains(&self.internal)
    }
}

impl Memory {
    /// Creates a buffer of `words` words.
    pub fn buffer(gl: &glow::Context, words: u64) -> Result<Self, Error> {
        let bytes = words.max(1).checked_mul(4).and_then(|bytes| i32::try_from(bytes).ok());
        let bytes = bytes.ok_or_else(|| Error(format!("a buffer of {words} words is more than 2 GiB")))?;
        // SAFETY: the context is current.
        unsafe {
            let buffer = gl.create_named_buffer().map_err(Error)?;
            gl.named_buffer_data_size(buffer, bytes, glow::DYNAMIC_COPY);
            Ok(Memory::Buffer { buffer, words })
        }
    }

    /// Creates a buffer with these words.
    pub fn of_words(gl: &glow::Context, words: &[u32]) -> Result<Self, Error> {
        let memory = Memory::buffer(gl, words.len() as u64)?;
        if let Memory::Buffer { buffer, .. } = memory {
            let bytes: Vec<u8> = words.iter().flat_map(|word| word.to_le_bytes()).collect();
            // SAFETY: the context is current, and the buffer has room for the words.
            unsafe { gl.named_buffer_sub_data_u8_slice(buffer, 0, &bytes) };
        }
        Ok(memory)
    }

    /// Creates a texture with the size of the frame.
    pub fn texture(gl: &glow::Context, format: Format, samples: u64, [width, height]: [i32; 2]) -> Result<Self, Error> {
        let kind = if samples > 1 { glow::TEXTURE_2D_MULTISAMPLE } else { glow::TEXTURE_2D };
        // SAFETY: the context is current.
        unsafe {
            let texture = gl.create_named_texture(kind).map_err(Error)?;
            gl.bind_texture(kind, Some(texture));
            if samples > 1 {
                gl.tex_storage_2d_multisample(kind, samples as i32, format.internal, width, height, true);
            } else {
                gl.tex_storage_2d(kind, 1, format.internal, width, height);
                // Shaders read single texels.
                gl.tex_parameter_i32(kind, glow::TEXTURE_MIN_FILTER, glow::NEAREST as i32);
                gl.tex_parameter_i32(kind, glow::TEXTURE_MAG_FILTER, glow::NEAREST as i32);
            }
            if format.attachment == glow::DEPTH_STENCIL_ATTACHMENT {
                gl.tex_parameter_i32(kind, glow::DEPTH_STENCIL_TEXTURE_MODE, glow::STENCIL_INDEX as i32);
            }
            gl.bind_texture(kind, None);
            Ok(Memory::Texture { texture, kind, format })
        }
    }

    /// Creates the memory of a resource. `value` evaluates a formula.
    pub fn of(
        gl: &glow::Context,
        resource: &Resource,
        size: [i32; 2],
        value: &dyn Fn(&str) -> Result<u64, Error>,
    ) -> Result<Self, Error> {
        match &resource.texture {
            None => Memory::buffer(gl, value(&resource.words)?),
            Some(Texture { format, samples, .. }) => Memory::texture(gl, Format::named(format)?, value(samples)?, size),
        }
    }

    pub fn delete(self, gl: &glow::Context) {
        // SAFETY: the context is current and nothing is drawn from the object.
        unsafe {
            match self {
                Memory::Buffer { buffer, .. } => gl.delete_buffer(buffer),
                Memory::Texture { texture, .. } => gl.delete_texture(texture),
            }
        }
    }

    /// Binds the memory to its block or unit.
    pub fn bind(self, gl: &glow::Context, binding: u32) {
        // SAFETY: the context is current.
        unsafe {
            match self {
                Memory::Buffer { buffer, .. } => {
                    gl.bind_buffer_base(glow::SHADER_STORAGE_BUFFER, binding, Some(buffer))
                }
                Memory::Texture { texture, .. } => gl.bind_texture_unit(binding, Some(texture)),
            }
        }
    }

    /// Sets every word to `value`, and every texel to `texel`. Leaves another framebuffer bound.
    pub fn clear(self, context: &Context, value: u32, texel: &serde_json::Value) {
        let gl = &context.gl;
        // SAFETY: the context is current; a cleared buffer has whole words.
        unsafe {
            let Memory::Texture { format, .. } = self else {
                let Memory::Buffer { buffer, .. } = self else { return };
                let name = buffer.0.get();
                (context.clear_buffer)(
                    name,
                    glow::R32UI,
                    glow::RED_INTEGER,
                    glow::UNSIGNED_INT,
                    from_ref(&value).cast(),
                );
                return;
            };
            let framebuffer = gl.create_framebuffer().ok();
            gl.bind_framebuffer(glow::FRAMEBUFFER, framebuffer);
            self.attach(gl, 0);
            gl.color_mask(true, true, true, true);
            gl.depth_mask(true);
            gl.stencil_mask(0xff);
            let channels: Vec<f64> = (0..4).map(|index| texel[index].as_f64().unwrap_or(0.0)).collect();
            match format.attachment {
                glow::COLOR_ATTACHMENT0 if format.is_integer() => {
                    let words: Vec<u32> = channels.iter().map(|channel| *channel as u32).collect();
                    gl.clear_buffer_u32_slice(glow::COLOR, 0, &words);
                }
                glow::COLOR_ATTACHMENT0 => {
                    let channels: Vec<f32> = channels.iter().map(|channel| *channel as f32).collect();
                    gl.clear_buffer_f32_slice(glow::COLOR, 0, &channels);
                }
                attachment => {
                    let depth = texel["depth"].as_f64().unwrap_or(0.0) as f32;
                    let stencil = texel["stencil"].as_i64().unwrap_or(0) as i32;
                    if attachment == glow::DEPTH_ATTACHMENT {
                        gl.clear_buffer_f32_slice(glow::DEPTH, 0, &[depth]);
                    } else {
                        gl.clear_buffer_depth_stencil(glow::DEPTH_STENCIL, 0, depth, stencil);
                    }
                }
            }
            framebuffer.into_iter().for_each(|framebuffer| gl.delete_framebuffer(framebuffer));
        }
    }

    /// Attaches a texture to the bound framebuffer, a colour format as the attachment of this index. Returns the attachment.
    pub fn attach(self, gl: &glow::Context, index: u32) -> Option<u32> {
        let Memory::Texture { texture, format, .. } = self else { return None };
        let is_color = format.attachment == glow::COLOR_ATTACHMENT0;
        let attachment = if is_color { format.attachment + index } else { format.attachment };
        // SAFETY: the context is current.
        unsafe { gl.framebuffer_texture(glow::FRAMEBUFFER, attachment, Some(texture), 0) };
        Some(attachment)
    }

    /// Copies the memory of `from`, which has the same shape.
    pub fn copy_from(self, gl: &glow::Context, from: Memory, [width, height]: [i32; 2]) {
        // SAFETY: the context is current and both have the same shape.
        unsafe {
            match (from, self) {
                (Memory::Buffer { buffer: from, words }, Memory::Buffer { buffer: to, .. }) => {
                    gl.bind_buffer(glow::COPY_READ_BUFFER, Some(from));
                    gl.bind_buffer(glow::COPY_WRITE_BUFFER, Some(to));
                    gl.copy_buffer_sub_data(glow::COPY_READ_BUFFER, glow::COPY_WRITE_BUFFER, 0, 0, 4 * words as i32);
                }
                (Memory::Texture { texture: from, kind, .. }, Memory::Texture { texture: to, .. }) => {
                    gl.copy_image_sub_data(from, kind, 0, 0, 0, 0, to, kind, 0, 0, 0, 0, width, height, 1);
                }
                _ => {}
            }
        }
    }

    /// Reads all texels of a colour texture: red, green, blue and alpha, row by row from the top.
    pub fn texels(self, gl: &glow::Context, [width, height]: [i32; 2]) -> Vec<[f32; 4]> {
        let mut bytes = vec![0; 16 * (width * height) as usize];
        let Memory::Texture { texture, kind, .. } = self else { return Vec::new() };
        // SAFETY: the context is current, and `bytes` has room for every texel.
        unsafe {
            gl.bind_texture(kind, Some(texture));
            gl.get_tex_image(kind, 0, glow::RGBA, glow::FLOAT, glow::PixelPackData::Slice(Some(&mut bytes)));
        }
        let channel =
            |bytes: &[u8], index: usize| f32::from_le_bytes(std::array::from_fn(|byte| bytes[4 * index + byte]));
        bytes.chunks_exact(16).map(|texel| std::array::from_fn(|index| channel(texel, index))).collect()
    }

    /// Reads words of a buffer.
    pub fn words(self, gl: &glow::Context, first: u64, count: u64) -> Vec<u32> {
        let Memory::Buffer { buffer, words } = self else { return Vec::new() };
        let count = count.min(words.saturating_sub(first));
        let mut bytes = vec![0; 4 * count as usize];
        // SAFETY: the context is current and the range lies inside the buffer.
        unsafe {
            gl.bind_buffer(glow::COPY_READ_BUFFER, Some(buffer));
            gl.get_buffer_sub_data(glow::COPY_READ_BUFFER, 4 * first as i32, &mut bytes);
        }
        bytes.chunks_exact(4).map(|word| u32::from_le_bytes([word[0], word[1], word[2], word[3]])).collect()
    }
}
