//! Textures as the functions that read a pixel out load them: texel by texel and sample by sample.
//!
//! Input: the words of a texture, its format and its size. Output: the four components of a texel. Nothing is filtered or
//! written.

use fragbuf_interpreter::{Event, Reply, Sequential, SharedMemory, WordAddress};
use fragbuf_templates::vocabulary::TextureFormat;

use crate::sequential::changes;

/// The words of a texture, with its format and size.
pub(crate) struct SampledTexture<'a> {
    words: &'a [u32],
    format: Option<TextureFormat>,
    size: [u32; 2],
}

/// Returns whether texels of this format are whole words, halves of one, or floats: the formats that storages keep fragments in.
pub(crate) fn is_readable(format: TextureFormat) -> bool {
    !matches!(format, TextureFormat::Rgba8Unorm | TextureFormat::Rgba16Float)
}

impl<'a> SampledTexture<'a> {
    pub(crate) fn new(words: &'a [u32], format: Option<TextureFormat>, size: [u32; 2]) -> Self {
        SampledTexture { words, format, size }
    }

    fn texel(&self, [x, y, sample]: [u32; 3]) -> Option<[u32; 4]> {
        let [width, height] = self.size;
        if x >= width || y >= height {
            return None;
        }
        let texel = (sample as usize * height as usize + y as usize) * width as usize + x as usize;
        let format = self.format?;
        let first = texel * format.words() as usize;
        let [word, next] = [first, first + 1].map(|at| self.words.get(at).copied());
        let word = word?;
        Some(match format {
            TextureFormat::Rg16Uint => [word & 0xffff, word >> 16, 0, 1],
            TextureFormat::Rg32Float => [word, next?, 0, 1f32.to_bits()],
            TextureFormat::Depth24PlusStencil8 => [word & 0xff, 0, 0, 1],
            TextureFormat::R32Uint => [word, 0, 0, 1],
            _ => [word, 0, 0, 1f32.to_bits()],
        })
    }

    /// Returns columns, rows and samples.
    fn extent(&self) -> [u32; 3] {
        let [width, height] = self.size;
        let words = width as usize * height as usize * self.format.map_or(1, TextureFormat::words) as usize;
        [width, height, (self.words.len() / words.max(1)) as u32]
    }
}

/// The memory of one invocation that runs while no other does.
pub(crate) struct Reader<'a> {
    buffers: Sequential<'a>,
    textures: &'a [SampledTexture<'a>],
    /// The writes that have changed a word.
    pub(crate) changes: u64,
}

impl<'a> Reader<'a> {
    /// Takes buffers and textures in the order of the program's numbers.
    pub(crate) fn new(buffers: &'a mut [Vec<u32>], textures: &'a [SampledTexture<'a>]) -> Self {
        Reader { buffers: Sequential { buffers }, textures, changes: 0 }
    }
}

impl SharedMemory for Reader<'_> {
    fn length(&self, buffer: u16) -> u32 {
        self.buffers.length(buffer)
    }

    fn constant(&self, address: WordAddress) -> u32 {
        self.buffers.constant(address)
    }

    fn texel(&self, texture: u16, position: [u32; 3]) -> Option<[u32; 4]> {
        self.textures.get(usize::from(texture))?.texel(position)
    }

    fn extent(&self, texture: u16) -> [u32; 3] {
        self.textures.get(usize::from(texture)).map_or([0; 3], SampledTexture::extent)
    }

    fn event(&mut self, event: &Event) -> Reply {
        let reply = self.buffers.event(event);
        self.changes += u64::from(changes(event, reply));
        reply
    }
}
