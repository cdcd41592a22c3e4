//! The settings of a device.

use fragbuf_frame::{Conditions, DEFAULT_MEMORY, Decisions, Sizing};

/// The settings of a device. [`Settings::new`] has the defaults; every field may be changed.
#[derive(Clone, Copy, Debug)]
pub struct Settings {
    /// The width of the frame in pixels.
    pub width: u32,
    /// The height of the frame in pixels.
    pub height: u32,
    /// How pools are sized whose number of fragments is not known before the frame.
    pub sizing: Sizing,
    /// Whether frames use the decisions of their own host steps, or those of earlier frames.
    pub decisions: Decisions,
    /// Who ends loops and drops objects: the result is that of a GPU that does so by itself.
    pub conditions: Conditions,
    /// The order in which the fragments of a pixel run.
    pub order: FragmentOrder,
    /// The rows of a slice. The frame is drawn slice by slice, and each slice draws the whole mesh. `None`: as many rows as
    /// `memory` allows.
    pub slice: Option<u32>,
    /// The bytes that a frame may allocate: the plan's buffers and textures, and the image. The mesh, its transformed vertices, and the
    /// lists of one batch of its triangles, some tens of megabytes, are not part of them. With a shuffled order, a batch is the whole mesh;
    /// if its triangles and the lists of the tiles are larger than that, they must fit into the rest. Default: [`DEFAULT_MEMORY`], 2 GiB.
    pub memory: u64,
    /// Whether invocations run in lanes, where the shaders and the order allow it: faster, with the same result. `false`: one after the
    /// other.
    pub lanes: bool,
}

impl Settings {
    /// Returns the defaults for a frame of `width` × `height` pixels: automatic sizing, submission order, slices as high as 2 GiB
    /// allow.
    pub fn new(width: u32, height: u32) -> Self {
        Settings {
            width,
            height,
            sizing: Sizing::Auto,
            decisions: Decisions::Immediate,
            conditions: Conditions::OnHost,
            order: FragmentOrder::Submission,
            slice: None,
            memory: DEFAULT_MEMORY,
            lanes: true,
        }
    }
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
    /// Interleaved by a seed, as a GPU that starts fragments in submission order and has those of some consecutive triangles in flight:
    /// a fragment starts once every fragment of its pixel from a triangle that precedes its own by at least `triangles` has ended.
    Window {
        /// Selects the fragment that continues.
        seed: u64,
        /// The number of consecutive triangles whose fragments may overlap; 1 is the order of submission.
        triangles: u32,
    },
}

impl FragmentOrder {
    /// Returns the seed and the window of an interleaved order; the window of all triangles is `None`.
    pub(crate) fn interleaving(self) -> Option<(u64, Option<u32>)> {
        match self {
            FragmentOrder::Submission => None,
            FragmentOrder::Shuffled(seed) => Some((seed, None)),
            FragmentOrder::Window { seed, triangles } => Some((seed, Some(triangles))),
        }
    }
}
