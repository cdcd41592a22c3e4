//! Buffers and textures of a technique.

use super::{Formula, Text, TextureDimension};

/// A buffer or texture.
#[derive(Clone, Debug, PartialEq)]
pub struct Resource {
    /// The name. Generated accessors are `<name>_load`, `<name>_store`, `<name>_atomic_…`.
    pub name: String,
    /// The type of one element.
    pub element: Element,
    /// The parts of the index, slowest first. The length is the product; without extents it is one element.
    pub extents: Vec<Extent>,
    /// The content at the beginning of a frame.
    pub init: Init,
    /// How long the content is needed.
    pub lifetime: Lifetime,
    /// A line for readers of a plan.
    pub summary: Text,
}

/// One part of an index.
#[derive(Clone, Debug, PartialEq)]
pub struct Extent {
    /// The parameter of the accessor.
    pub name: String,
    /// The length.
    pub length: Formula,
}

/// The type of one element of a resource.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Element {
    /// A 32-bit word.
    Word,
    /// A 64-bit word.
    Word64,
    /// All words of a fragment, the key first.
    Entry,
    /// The value words of a fragment: all words but the key. There are none if the key is the whole payload.
    Value,
    /// A texel of a frame-sized texture. An extent `sample` gives the number of samples; without it there is one.
    Texture(TextureFormat),
    /// A texture of the description, of any size, with four float channels and one level. The caller supplies it.
    Texels(TextureDimension),
    /// The value words of a fragment, one per texture of this format. The plan has a resource for each texture, and a
    /// use of the resource applies to all of them.
    ValueTextures(TextureFormat),
    /// All words of a fragment, the key first, one per texture of this format.
    EntryTextures(TextureFormat),
}

/// Texture formats that passes attach or sample.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TextureFormat {
    /// One unsigned word.
    R32Uint,
    /// One unsigned word as two halves, the lower first: unlike whole words it can be multisampled.
    Rg16Uint,
    /// One float.
    R32Float,
    /// Two floats.
    Rg32Float,
    /// Four 8-bit channels.
    Rgba8Unorm,
    /// Four half floats.
    Rgba16Float,
    /// 32-bit float depth.
    Depth32Float,
    /// 24-bit depth and 8-bit stencil.
    Depth24PlusStencil8,
}

impl TextureFormat {
    /// Returns the number of 32-bit words of a texel.
    pub fn words(self) -> u32 {
        match self {
            TextureFormat::Rg32Float | TextureFormat::Rgba16Float => 2,
            _ => 1,
        }
    }
}

/// The content of a resource at the beginning of a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Init {
    /// Every word is this value.
    Clear(u32),
    /// The previous content. A pass of the plan writes the resource before another reads it.
    Keep,
    /// Content that the host supplies. A texture belongs to the host and is not part of the plan's memory.
    External,
}

/// How long the content of a resource is needed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Lifetime {
    /// One frame, or one iteration of a loop that restarts. The memory can be reused afterwards.
    Frame,
    /// One frame, over all iterations of a loop that restarts.
    AllIterations,
    /// Across frames.
    Persistent,
}

impl Resource {
    /// Returns whether the size depends on this symbol.
    pub fn mentions(&self, symbol: &str) -> bool {
        self.extents.iter().any(|extent| extent.length.mentions(symbol))
    }

    /// Makes a resource of one `element` without extents or initial content.
    pub fn new(name: &str, element: Element, summary: impl Into<Text>) -> Self {
        Resource {
            name: name.to_owned(),
            element,
            extents: Vec::new(),
            init: Init::Keep,
            lifetime: Lifetime::Frame,
            summary: summary.into(),
        }
    }

    /// Adds an extent that varies faster than the existing ones.
    pub fn by(mut self, name: &str, length: impl Into<Formula>) -> Self {
        self.extents.push(Extent { name: name.to_owned(), length: length.into() });
        self
    }

    /// Clears the resource to `value` at the beginning of a frame.
    pub fn cleared(mut self, value: u32) -> Self {
        self.init = Init::Clear(value);
        self
    }

    /// Keeps the content over all iterations of a loop that restarts.
    pub fn over_iterations(mut self) -> Self {
        self.lifetime = Lifetime::AllIterations;
        self
    }

    /// Keeps the content across frames.
    pub fn persistent(mut self) -> Self {
        self.lifetime = Lifetime::Persistent;
        self
    }
}
