//! The component of a camera, and the one that reports to it.

use std::collections::BTreeMap;
use std::sync::Arc;

use bevy::prelude::*;
use bevy::render::extract_component::ExtractComponent;
use fragbuf_follow::Error;

use super::material;
use crate::{Counters, Passes};

/// The fragments per pixel for which pools have slots, unless the description or the frame decides.
const FRAGMENTS_PER_PIXEL: f32 = 8.0;

/// Stores the transparent meshes of a camera in the buffer of a description.
#[derive(Component, Clone, ExtractComponent)]
pub struct FragmentBuffer {
    pub(super) passes: Arc<Passes>,
    pub(super) symbols: BTreeMap<String, u64>,
    pub(super) uniforms: BTreeMap<String, Vec<u8>>,
    pub(super) fragments_per_pixel: f32,
}

/// The counters of a recent frame of a camera with a [`FragmentBuffer`]. The plugin inserts it.
#[derive(Component, Clone, Debug, Default)]
pub struct FragmentCounters {
    /// The counters. If `lost` is not 0, the image is or may be wrong.
    pub counters: Counters,
    /// The bytes of all buffers and textures of the description, the resolved image and the copied depth.
    pub bytes: u64,
}

impl FragmentBuffer {
    /// Generates the passes of a description. It fails with the mistakes of the description, or with what a material of Bevy cannot give.
    pub fn new(description: &str) -> Result<Self, Error> {
        let passes = Passes::module(description)?;
        material::check(&passes)?;
        Ok(FragmentBuffer {
            passes: Arc::new(passes),
            symbols: BTreeMap::new(),
            uniforms: BTreeMap::new(),
            fragments_per_pixel: FRAGMENTS_PER_PIXEL,
        })
    }

    /// Sets a symbol of the manifest, such as `k`.
    pub fn with_symbol(mut self, name: &str, value: u64) -> Self {
        self.symbols.insert(name.to_owned(), value);
        self
    }

    /// Sets a uniform of the description: four bytes per component.
    pub fn with_uniform(mut self, name: &str, bytes: &[u8]) -> Self {
        self.uniforms.insert(name.to_owned(), bytes.to_owned());
        self
    }

    /// Sets for how many fragments per pixel, on average, pools have slots. Where the passes count fragments first, this has no effect.
    pub fn with_fragments_per_pixel(mut self, fragments: f32) -> Self {
        self.fragments_per_pixel = fragments;
        self
    }
}
