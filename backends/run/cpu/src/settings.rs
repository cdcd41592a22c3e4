//! The settings of a device.

use fragbuf_frame::Sizing;

/// The size of a frame, the sizing of its pools and the order of its fragments.
#[derive(Clone, Copy, Debug)]
pub struct Settings {
    /// The width of the frame in pixels.
    pub width: u32,
    /// The height of the frame in pixels.
    pub height: u32,
    /// How pools are sized whose number of fragments is not known before the frame.
    pub sizing: Sizing,
    /// The order in which the fragments of a pixel run.
    pub order: FragmentOrder,
}

/// The order in which the fragments of a pixel run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum FragmentOrder {
    /// One after the other, in submission order.
    #[default]
    Submission,
    /// Permuted and interleaved from one shared access to the next, by this seed. Fixed-function operations keep the
    /// submission order, as on every device: early tests precede all shaders of the pixel, late tests and blending follow
    /// them.
    Shuffled(u64),
}
