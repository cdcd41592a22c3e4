//! The images, buffers and counters that a peer's shaders bind.

use std::ffi::c_void;
use std::ptr::from_ref;

use glow::HasContext as _;

use super::description::MemoryDescription;
use crate::Error;
use crate::api::Desktop;

/// A buffer or an image, where it is bound, and the value at the begin of a frame.
pub struct PeerMemory {
    binding: u32,
    kind: Kind,
    buffer: Option<glow::Buffer>,
    clear: Option<Value>,
}

enum Kind {
    Image { texture: glow::Texture, format: Format, is_layered: bool },
    Block,
    Counter,
}

/// Two channels as the bits of words.
#[derive(Clone, Copy)]
struct Value([u32; 2]);

/// The format of an image.
#[derive(Clone, Copy)]
struct Format {
    internal: u32,
    channels: u32,
    kind: u32,
    words: u32,
}

impl Format {
    fn named(name: &str) -> Result<Self, Error> {
        let (internal, channels, kind, words) = match name {
            "r32ui" => (glow::R32UI, glow::RED_INTEGER, glow::UNSIGNED_INT, 1),
            "rg32f" => (glow::RG32F, glow::RG, glow::FLOAT, 2),
            other => return Err(Error(format!("unknown image format `{other}` in the description of a peer"))),
        };
        Ok(Format { internal, channels, kind, words })
    }

    /// Returns a value of two channels: of integers as integers, where a negative one has all bits set.
    fn value(self, [first, second]: [f32; 2]) -> Value {
        let bits = |channel: f32| match self.kind {
            glow::FLOAT => channel.to_bits(),
            _ if channel < 0.0 => u32::MAX,
            _ => channel as u32,
        };
        Value([bits(first), bits(second)])
    }
}

impl PeerMemory {
    /// Creates the memory for a size of the frame.
    pub fn new(gl: &glow::Context, description: &MemoryDescription, [width, height]: [i32; 2]) -> Result<Self, Error> {
        let pixels = (width * height) as u32;
        match description {
            MemoryDescription::ImageArray { binding, format, layers, clear } => {
                let format = Format::named(format)?;
                // SAFETY: the context is current.
                let texture = unsafe {
                    let texture = gl.create_named_texture(glow::TEXTURE_2D_ARRAY).map_err(Error)?;
                    gl.bind_texture(glow::TEXTURE_2D_ARRAY, Some(texture));
                    gl.tex_storage_3d(glow::TEXTURE_2D_ARRAY, 1, format.internal, width, height, *layers as i32);
                    texture
                };
                Ok(Self::image(*binding, texture, format, true, *clear))
            }
            MemoryDescription::ImageRectangle { binding, format, clear } => {
                let format = Format::named(format)?;
                // SAFETY: the context is current.
                let texture = unsafe {
                    let texture = gl.create_named_texture(glow::TEXTURE_RECTANGLE).map_err(Error)?;
                    gl.bind_texture(glow::TEXTURE_RECTANGLE, Some(texture));
                    gl.tex_storage_2d(glow::TEXTURE_RECTANGLE, 1, format.internal, width, height);
                    texture
                };
                Ok(Self::image(*binding, texture, format, false, *clear))
            }
            MemoryDescription::ImageBuffer { binding, format, texels_per_pixel, clear } => {
                let format = Format::named(format)?;
                let buffer = buffer(gl, pixels * texels_per_pixel * format.words)?;
                // SAFETY: the context is current.
                let texture = unsafe {
                    let texture = gl.create_named_texture(glow::TEXTURE_BUFFER).map_err(Error)?;
                    gl.bind_texture(glow::TEXTURE_BUFFER, Some(texture));
                    gl.tex_buffer(glow::TEXTURE_BUFFER, format.internal, Some(buffer));
                    texture
                };
                Ok(PeerMemory { buffer: Some(buffer), ..Self::image(*binding, texture, format, false, *clear) })
            }
            MemoryDescription::Block { binding, words_per_pixel, words, clear } => {
                let buffer = buffer(gl, pixels * words_per_pixel + words)?;
                let clear = clear.map(|word| Value([word, word]));
                Ok(PeerMemory { binding: *binding, kind: Kind::Block, buffer: Some(buffer), clear })
            }
            MemoryDescription::Counter { binding } => {
                let clear = Some(Value([0, 0]));
                Ok(PeerMemory { binding: *binding, kind: Kind::Counter, buffer: Some(buffer(gl, 1)?), clear })
            }
        }
    }

    fn image(
        binding: u32,
        texture: glow::Texture,
        format: Format,
        is_layered: bool,
        clear: Option<[f32; 2]>,
    ) -> PeerMemory {
        let clear = clear.map(|channels| format.value(channels));
        PeerMemory { binding, kind: Kind::Image { texture, format, is_layered }, buffer: None, clear }
    }

    /// Sets the value at the begin of a frame.
    pub fn clear(&self, desktop: &Desktop) {
        let Some(Value(words)) = self.clear else { return };
        let data: *const c_void = from_ref(&words).cast();
        // SAFETY: the context is current, and the data are a texel of the format.
        unsafe {
            match (&self.kind, self.buffer) {
                (Kind::Image { format, .. }, Some(buffer)) => {
                    let Format { internal, channels, kind, .. } = *format;
                    (desktop.clear_buffer)(buffer.0.get(), internal, channels, kind, data);
                }
                (Kind::Image { texture, format, .. }, None) => {
                    (desktop.clear_texture)(texture.0.get(), 0, format.channels, format.kind, data);
                }
                (_, Some(buffer)) => {
                    let (channels, kind) = (glow::RED_INTEGER, glow::UNSIGNED_INT);
                    (desktop.clear_buffer)(buffer.0.get(), glow::R32UI, channels, kind, data);
                }
                (_, None) => {}
            }
        }
    }

    /// Binds the memory.
    pub fn bind(&self, gl: &glow::Context) {
        // SAFETY: the context is current.
        unsafe {
            match &self.kind {
                Kind::Image { texture, format, is_layered } => {
                    let access = glow::READ_WRITE;
                    gl.bind_image_texture(self.binding, Some(*texture), 0, *is_layered, 0, access, format.internal);
                }
                Kind::Block => gl.bind_buffer_base(glow::SHADER_STORAGE_BUFFER, self.binding, self.buffer),
                Kind::Counter => gl.bind_buffer_base(glow::ATOMIC_COUNTER_BUFFER, self.binding, self.buffer),
            }
        }
    }
}

/// Creates a buffer of this number of words.
fn buffer(gl: &glow::Context, words: u32) -> Result<glow::Buffer, Error> {
    let bytes = i32::try_from(4 * u64::from(words.max(1))).map_err(|_| Error("a peer's buffer is too large".into()))?;
    // SAFETY: the context is current.
    unsafe {
        let buffer = gl.create_named_buffer().map_err(Error)?;
        gl.named_buffer_data_size(buffer, bytes, glow::DYNAMIC_COPY);
        Ok(buffer)
    }
}
