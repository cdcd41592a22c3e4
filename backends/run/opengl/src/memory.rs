//! The buffers and textures of a plan.

use fragbuf_follow::Texels;
use fragbuf_follow::manifest::{Texture, ViewDimension};
use glow::HasContext as _;

use crate::api::fill;
use crate::{Context, Error};

/// The memory of one resource.
#[derive(Clone, Copy)]
pub enum Memory {
    Buffer { buffer: glow::Buffer, bytes: u64 },
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
    pub const fn color(internal: u32) -> Self {
        Format { internal, attachment: glow::COLOR_ATTACHMENT0 }
    }

    fn named(name: &str) -> Result<Self, Error> {
        let internal = match name {
            "r32uint" => glow::R32UI,
            "rg16uint" => glow::RG16UI,
            "r32float" => glow::R32F,
            "rg32float" => glow::RG32F,
            "rgba8unorm" => glow::RGBA8,
            "rgba16float" => glow::RGBA16F,
            "depth32float" => {
                return Ok(Format { internal: glow::DEPTH_COMPONENT32F, attachment: glow::DEPTH_ATTACHMENT });
            }
            "depth24plus-stencil8" => {
                return Ok(Format { internal: glow::DEPTH24_STENCIL8, attachment: glow::DEPTH_STENCIL_ATTACHMENT });
            }
            _ => return Err(Error(format!("unknown texture format `{name}`"))),
        };
        Ok(Format::color(internal))
    }

    /// The parts that a copy copies.
    fn planes(self) -> u32 {
        match self.attachment {
            glow::DEPTH_ATTACHMENT => glow::DEPTH_BUFFER_BIT,
            glow::DEPTH_STENCIL_ATTACHMENT => glow::DEPTH_BUFFER_BIT | glow::STENCIL_BUFFER_BIT,
            _ => glow::COLOR_BUFFER_BIT,
        }
    }

    fn is_integer(self) -> bool {
        [glow::R32UI, glow::RG16UI].contains(&self.internal)
    }
}

impl Memory {
    /// Creates a buffer of whole words. `name` is for the message about one that is too large.
    pub fn buffer(gl: &glow::Context, name: &str, bytes: u64) -> Result<Self, Error> {
        let size = i32::try_from(bytes).map_err(|_| {
            Error(format!(
                "`{name}` needs {bytes} bytes, more than 2 GiB: set a smaller `fragments`, or draw a smaller frame"
            ))
        })?;
        // SAFETY: the context is current.
        unsafe {
            let buffer = gl.create_buffer().map_err(Error)?;
            gl.bind_buffer(glow::COPY_WRITE_BUFFER, Some(buffer));
            gl.buffer_data_size(glow::COPY_WRITE_BUFFER, size, glow::DYNAMIC_COPY);
            Ok(Memory::Buffer { buffer, bytes })
        }
    }

    /// Creates a buffer with these words.
    pub fn of_words(gl: &glow::Context, words: &[u32]) -> Result<Self, Error> {
        let memory = Memory::buffer(gl, "words", 4 * words.len().max(1) as u64)?;
        if let Memory::Buffer { buffer, .. } = memory {
            let bytes: Vec<u8> = words.iter().flat_map(|word| word.to_le_bytes()).collect();
            // SAFETY: the context is current, and the buffer has room for the words.
            unsafe {
                gl.bind_buffer(glow::COPY_WRITE_BUFFER, Some(buffer));
                gl.buffer_sub_data_u8_slice(glow::COPY_WRITE_BUFFER, 0, &bytes);
            }
        }
        Ok(memory)
    }

    /// Creates a texture with the size of the frame.
    pub fn texture(gl: &glow::Context, format: Format, samples: u64, [width, height]: [i32; 2]) -> Result<Self, Error> {
        let kind = if samples > 1 { glow::TEXTURE_2D_MULTISAMPLE } else { glow::TEXTURE_2D };
        // SAFETY: the context is current.
        unsafe {
            let texture = gl.create_texture().map_err(Error)?;
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

    /// Creates a texture of the manifest with the size of the frame.
    pub fn texture_of(gl: &glow::Context, texture: &Texture, samples: u64, size: [i32; 2]) -> Result<Self, Error> {
        Memory::texture(gl, Format::named(&texture.format)?, samples, size)
    }

    /// Creates a texture of the description.
    pub fn of_texels(gl: &glow::Context, texels: &Texels<'_>, dimension: ViewDimension) -> Result<Self, Error> {
        let [width, height, slices] = texels.size.map(|side| side as i32);
        let kind = match dimension {
            ViewDimension::D2 => glow::TEXTURE_2D,
            ViewDimension::D3 => glow::TEXTURE_3D,
        };
        let format = Format::color(glow::RGBA32F);
        let bytes = texels.bytes();
        let data = glow::PixelUnpackData::Slice(Some(&bytes));
        // SAFETY: the context is current, and there are as many texels as the texture has.
        unsafe {
            let texture = gl.create_texture().map_err(Error)?;
            gl.bind_texture(kind, Some(texture));
            let channels = (glow::RGBA, glow::FLOAT);
            match dimension {
                ViewDimension::D2 => {
                    gl.tex_storage_2d(kind, 1, format.internal, width, height);
                    gl.tex_sub_image_2d(kind, 0, 0, 0, width, height, channels.0, channels.1, data);
                }
                ViewDimension::D3 => {
                    gl.tex_storage_3d(kind, 1, format.internal, width, height, slices);
                    gl.tex_sub_image_3d(kind, 0, 0, 0, 0, width, height, slices, channels.0, channels.1, data);
                }
            }
            // Shaders read single texels.
            gl.tex_parameter_i32(kind, glow::TEXTURE_MIN_FILTER, glow::NEAREST as i32);
            gl.tex_parameter_i32(kind, glow::TEXTURE_MAG_FILTER, glow::NEAREST as i32);
            gl.bind_texture(kind, None);
            Ok(Memory::Texture { texture, kind, format })
        }
    }

    /// The bytes of a buffer.
    pub fn bytes(self) -> u64 {
        match self {
            Memory::Buffer { bytes, .. } => bytes,
            Memory::Texture { .. } => 0,
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
                Memory::Texture { texture, kind, .. } => {
                    gl.active_texture(glow::TEXTURE0 + binding);
                    gl.bind_texture(kind, Some(texture));
                }
            }
        }
    }

    /// Sets every word to `value`, and every texel to `texel`. Leaves another framebuffer bound.
    pub fn clear(self, context: &Context, value: u32, texel: &serde_json::Value) {
        let gl = &context.gl;
        let format = match self {
            Memory::Buffer { buffer, bytes } => return fill(gl, context.desktop.as_ref(), buffer, bytes / 4, value),
            Memory::Texture { format, .. } => format,
        };
        // SAFETY: the context is current.
        unsafe {
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

    /// Writes a number per texel of a texture of floats or depths.
    pub fn write(self, gl: &glow::Context, texels: &[f32], [width, height]: [i32; 2]) {
        let Memory::Texture { texture, kind, format } = self else { return };
        let channel = if format.attachment == glow::DEPTH_ATTACHMENT { glow::DEPTH_COMPONENT } else { glow::RED };
        let bytes: Vec<u8> = texels.iter().flat_map(|texel| texel.to_le_bytes()).collect();
        let data = glow::PixelUnpackData::Slice(Some(&bytes));
        // SAFETY: the context is current, and there are as many texels as the texture has.
        unsafe {
            gl.bind_texture(kind, Some(texture));
            gl.tex_sub_image_2d(kind, 0, 0, 0, width, height, channel, glow::FLOAT, data);
        }
    }

    /// Attaches a texture to the bound framebuffer, a colour format as the attachment of this index. Returns the attachment.
    pub fn attach(self, gl: &glow::Context, index: u32) -> Option<u32> {
        self.attach_to(gl, glow::FRAMEBUFFER, index)
    }

    fn attach_to(self, gl: &glow::Context, framebuffer: u32, index: u32) -> Option<u32> {
        let Memory::Texture { texture, kind, format } = self else { return None };
        let is_color = format.attachment == glow::COLOR_ATTACHMENT0;
        let attachment = if is_color { format.attachment + index } else { format.attachment };
        // SAFETY: the context is current.
        unsafe { gl.framebuffer_texture_2d(framebuffer, attachment, kind, Some(texture), 0) };
        Some(attachment)
    }

    /// Copies the memory of `from`, which has the same shape. Leaves another framebuffer bound.
    pub fn copy_from(self, gl: &glow::Context, from: Memory, [width, height]: [i32; 2]) -> Result<(), Error> {
        // SAFETY: the context is current and both have the same shape.
        unsafe {
            match (from, self) {
                (Memory::Buffer { buffer: from, bytes }, Memory::Buffer { buffer: to, .. }) => {
                    gl.bind_buffer(glow::COPY_READ_BUFFER, Some(from));
                    gl.bind_buffer(glow::COPY_WRITE_BUFFER, Some(to));
                    gl.copy_buffer_sub_data(glow::COPY_READ_BUFFER, glow::COPY_WRITE_BUFFER, 0, 0, bytes as i32);
                }
                (Memory::Texture { format, .. }, Memory::Texture { .. }) => {
                    let [source, destination] =
                        [gl.create_framebuffer().map_err(Error)?, gl.create_framebuffer().map_err(Error)?];
                    gl.bind_framebuffer(glow::READ_FRAMEBUFFER, Some(source));
                    gl.bind_framebuffer(glow::DRAW_FRAMEBUFFER, Some(destination));
                    from.attach_to(gl, glow::READ_FRAMEBUFFER, 0);
                    self.attach_to(gl, glow::DRAW_FRAMEBUFFER, 0);
                    let (w, h) = (width, height);
                    gl.blit_framebuffer(0, 0, w, h, 0, 0, w, h, format.planes(), glow::NEAREST);
                    gl.delete_framebuffer(source);
                    gl.delete_framebuffer(destination);
                }
                _ => {}
            }
        }
        Ok(())
    }

    /// Reads all texels of a colour texture of floats: red, green, blue and alpha, row by row from the top. Leaves another framebuffer
    /// bound.
    pub fn texels(self, gl: &glow::Context, [width, height]: [i32; 2]) -> Result<Vec<[f32; 4]>, Error> {
        let mut bytes = vec![0; 16 * (width * height) as usize];
        // SAFETY: the context is current, and `bytes` has room for every texel.
        unsafe {
            let framebuffer = gl.create_framebuffer().map_err(Error)?;
            gl.bind_framebuffer(glow::READ_FRAMEBUFFER, Some(framebuffer));
            self.attach_to(gl, glow::READ_FRAMEBUFFER, 0);
            let pixels = glow::PixelPackData::Slice(Some(&mut bytes));
            gl.read_pixels(0, 0, width, height, glow::RGBA, glow::FLOAT, pixels);
            gl.delete_framebuffer(framebuffer);
        }
        let channel =
            |bytes: &[u8], index: usize| f32::from_le_bytes(std::array::from_fn(|byte| bytes[4 * index + byte]));
        Ok(bytes.chunks_exact(16).map(|texel| std::array::from_fn(|index| channel(texel, index))).collect())
    }

    /// Reads words of a buffer.
    pub fn words(self, gl: &glow::Context, first: u64, count: u64) -> Vec<u32> {
        let Memory::Buffer { buffer, bytes } = self else { return Vec::new() };
        let count = count.min((bytes / 4).saturating_sub(first)) as usize;
        let mut result = vec![0_u32; count];
        if count == 0 {
            return result;
        }
        // SAFETY: the context is current, the range lies inside the buffer, and so many bytes are mapped. OpenGL aligns a mapped
        // buffer, so that the offset of a word is a multiple of its alignment.
        unsafe {
            gl.bind_buffer(glow::COPY_READ_BUFFER, Some(buffer));
            let (offset, bytes) = (4 * first as i32, 4 * count as i32);
            let mapped = gl.map_buffer_range(glow::COPY_READ_BUFFER, offset, bytes, glow::MAP_READ_BIT);
            // A buffer that cannot be mapped leaves an error of OpenGL, which the end of the frame reports.
            if !mapped.is_null() {
                std::ptr::copy_nonoverlapping(mapped, result.as_mut_ptr().cast(), 4 * count);
                gl.unmap_buffer(glow::COPY_READ_BUFFER);
            }
        }
        result
    }
}
