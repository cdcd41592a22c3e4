//! The types that every renderer takes: what the command line asks for, and the task for one device.

use fragbuf::Variant;
use fragbuf_frame::LaggedValues;

use super::opaque::OpaqueScene;
use crate::cli::memory::Budget;
use crate::cli::progress::Progress;
use crate::cli::view::{SceneView, View};

/// A description with its changes, as given on the command line.
pub(crate) struct RenderRequest<'a> {
    pub(crate) description: &'a str,
    pub(crate) set: &'a [(String, String)],
    pub(crate) uniforms: &'a [(String, String)],
    /// Whether every event is counted if the description does not choose on `counters`.
    pub(crate) count_all: bool,
    /// The opaque scene, which is rendered first.
    pub(crate) opaque: Option<&'a SceneView>,
    /// The bytes of other images that the command holds meanwhile.
    pub(crate) held: u64,
    /// The decisions of the previous frame of an animation that lag.
    pub(crate) lagged: Option<&'a LaggedValues>,
    /// Resources whose words are read after the frame; of several slices, those of the last.
    pub(crate) words: &'a [&'a str],
}

impl<'a> RenderRequest<'a> {
    /// Returns the request for a description without changes, of which losses are counted.
    pub(crate) const fn new(description: &'a str) -> Self {
        RenderRequest {
            description,
            set: &[],
            uniforms: &[],
            count_all: false,
            opaque: None,
            held: 0,
            lagged: None,
            words: &[],
        }
    }
}

/// One checked description to render on one device.
pub(super) struct RenderTask<'a> {
    pub(super) request: &'a RenderRequest<'a>,
    pub(super) view: &'a View,
    pub(super) scene: &'a SceneView,
    pub(super) progress: &'a Progress,
    pub(super) variant: &'a Variant,
    pub(super) opaque: Option<&'a OpaqueScene<'a>>,
    /// The memory that is left for vertices, images and frames.
    pub(super) memory: Budget,
}

/// The state that redraws of one request share.
#[derive(Default)]
pub(super) struct RedrawState {
    /// Frames drawn so far.
    pub(super) frames: u32,
    /// Fragments to reserve in the pool; `None` before a frame has shown how many are needed.
    pub(super) pool_size: Option<u32>,
    /// The rows of a slice; `None`: as many as fit.
    pub(super) slice: Option<u32>,
    /// The rows of a slice of the last device; `None` before the first.
    pub(super) rows: Option<u32>,
}

impl RedrawState {
    /// Halves the slices of the last device, because what they hold does not fit; returns whether they can be halved. Before the first
    /// device they cannot: it has as many rows as fit. Half as many rows have fewer fragments, so the former size of the pool is void.
    pub(super) fn halve(&mut self) -> bool {
        let Some(rows) = self.rows.filter(|rows| *rows > 1) else { return false };
        let half = Some(rows.div_ceil(2));
        (self.rows, self.slice, self.pool_size) = (half, half, None);
        true
    }
}
