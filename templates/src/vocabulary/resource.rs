//! What a technique keeps in memory.

use super::{Formula, Text};

/// One buffer or texture.
#[derive(Clone, Debug, PartialEq)]
pub struct Resource {
    /// Its name; generated accessors are `<name>_load`, `<name>_store`, `<name>_atomic_…`.
    pub name: String,
    /// What one element is.
    pub element: Element,
    /// The index, slowest part first. The length is the product; none is a single element.
    pub extents: Vec<Extent>,
    /// What it holds when a frame begins.
    pub init: Init,
    /// How long its contents matter.
    pub life: Life,
    /// One line for the reader of a plan.
    pub summary: Text,
}

/// One part of an index.
#[derive(Clone, Debug, PartialEq)]
pub struct Extent {
    /// The accessor parameter.
    pub name: String,
    /// How many.
    pub length: Formula,
}

/// What one element of a resource is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Element {
    /// A 32-bit word.
    Word,
    /// A 64-bit word.
    Word64,
    /// All words of a fragment, the key first.
    Entry,
    /// The words of a fragment beside its key. No words at all where the key is the whole payload.
    Beside,
    /// A texel of a frame-sized texture. An extent `sample` says how many samples a pixel has; without it there is one.
    Texture(TextureFormat),
    /// The words of a fragment beside its key, each in a texture of its own of this format. The plan has one resource for
    /// each; what a pass does with the name it does with all of them.
    BesideTextures(TextureFormat),
    /// The same for all words of a fragment, the key first.
    EntryTextures(TextureFormat),
}

/// Texture formats that passes attach or sample.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TextureFormat {
    /// One unsigned word.
    R32Uint,
    /// One unsigned word as two halves, the lower first: unlike whole words, it may have several samples.
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
    /// 32-bit words of a texel.
    pub fn words(self) -> u32 {
        match self {
            TextureFormat::Rg32Float | TextureFormat::Rgba16Float => 2,
            _ => 1,
        }
    }
}

/// What a resource holds when a frame begins.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Init {
    /// Every word is this value.
    Clear(u32),
    /// Whatever it held: a pass of the plan writes before any reads.
    Keep,
    /// The host writes it. A texture is the host's own: it is brought as it is, and is no memory of the plan's.
    Host,
}

/// How long a resource's contents matter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Life {
    /// One frame; the memory may serve others after it.
    Frame,
    /// From frame to frame.
    Persistent,
}

impl Resource {
    /// Whether its size depends on this symbol.
    pub fn mentions(&self, symbol: &str) -> bool {
        self.extents.iter().any(|extent| extent.length.mentions(symbol))
    }

    /// A buffer of `element`s without extents, kept from nothing.
    pub fn new(name: &str, element: Element, summary: impl Into<Text>) -> Self {
        Resource {
            name: name.to_owned(),
            element,
            extents: Vec::new(),
            init: Init::Keep,
            life: Life::Frame,
            summary: summary.into(),
        }
    }

    /// Adds an index part inside those already there.
    pub fn by(mut self, name: &str, length: impl Into<Formula>) -> Self {
        self.extents.push(Extent { name: name.to_owned(), length: length.into() });
        self
    }

    /// Cleared to `value` when a frame begins.
    pub fn cleared(mut self, value: u32) -> Self {
        self.init = Init::Clear(value);
        self
    }

    /// Kept from frame to frame.
    pub fn persistent(mut self) -> Self {
        self.life = Life::Persistent;
        self
    }
}
