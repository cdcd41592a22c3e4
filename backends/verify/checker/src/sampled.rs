//! Textures as functions that read a pixel out see them: texel by texel and sample by sample.
//!
//! In: the words of a texture, its format and its size. Out: four numbers of a texel. Nothing is filtered or written.

use fragbuf_interpreter::{Event, Place, Reply, Sequential, Shared};
use fragbuf_templates::vocabulary::TextureFormat;

/// A texture's words.
pub(crate) struct Sampled<'a> {
    words: &'a [u32],
    format: Option<TextureFormat>,
    size: [u32; 2],
}

/// Whether texels of this format are whole words, halves of one, or floats: what a storage keeps fragments in.
pub(crate) fn is_read(format: TextureFormat) -> bool {
    !matches!(format, TextureFormat::Rgba8Unorm | TextureFormat::Rgba16Float)
}

impl<'a> Sampled<'a> {
    pub(crate) fn new(words: &'a [u32], format: Option<TextureFormat>, size: [u32; 2]) -> Self {
        Sampled { words, format, size }
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

    /// Columns, rows, samples.
    fn extent(&self) -> [u32; 3] {
        let [width, height] = self.size;
        let words = width as usize * height as usize * self.format.map_or(1, TextureFormat::words) as usize;
        [width, height, (self.words.len() / words.max(1)) as u32]
    }
}

/// The memory of one invocation that runs by itself.
pub(crate) struct Reader<'a> {
    buffers: Sequential<'a>,
    textures: &'a [Sampled<'a>],
}

impl<'a> Reader<'a> {
    /// Buffers and textures by the program's numbers.
    pub(crate) fn new(buffers: &'a mut [Vec<u32>], textures: &'a [Sampled<'a>]) -> Self {
        Reader { buffers: Sequential { buffers }, textures }
    }
}

impl Shared for Reader<'_> {
    fn length(&self, buffer: u16) -> u32 {
        self.buffers.length(buffer)
    }

    fn constant(&self, place: Place) -> u32 {
        self.buffers.constant(place)
    }

    fn texel(&self, texture: u16, place: [u32; 3]) -> Option<[u32; 4]> {
        self.textures.get(usize::from(texture))?.texel(place)
    }

    fn extent(&self, texture: u16) -> [u32; 3] {
        self.textures.get(usize::from(texture)).map_or([0; 3], Sampled::extent)
    }

    fn event(&mut self, event: &Event) -> Reply {
        self.buffers.event(event)
    }
}
