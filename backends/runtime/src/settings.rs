//! What a caller decides about a renderer.

/// What a caller decides. [`Settings::new`] has the usual choices; every field may be changed.
#[derive(Clone, Debug)]
pub struct Settings {
    /// The format of the view that frames are resolved into. It must be blendable.
    pub target: wgpu::TextureFormat,
    /// Width of the frame, in pixels.
    pub width: u32,
    /// Height of the frame, in pixels.
    pub height: u32,
    /// How much room is made for fragments whose number no one knows beforehand.
    pub sizing: Sizing,
    /// Rows that are drawn at once; the frame is made of so many slices, one after the other, each of which draws the
    /// whole scene. `None`: as many as the device's limits allow, which is the whole frame unless a buffer is too large.
    pub slice: Option<u32>,
    /// Whether shaders check bounds and bound loops at run time.
    pub checks: Checks,
    /// The vertex buffers of geometry passes; `None`: one, interleaved, as [`crate::VertexInputs`] says.
    pub vertices: Option<Vec<VertexBuffer>>,
    /// How geometry is put together, culled and filled.
    pub primitive: wgpu::PrimitiveState,
    /// Whether passes are timed, where the device has `TIMESTAMP_QUERY`.
    pub timestamps: bool,
}

/// How much room is made for fragments whose number no one knows beforehand. Plans without such resources ignore it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sizing {
    /// [`Sizing::Exact`] where a host step of the plan finds the number out, else room for eight fragments per pixel.
    Auto,
    /// Exactly what the frame has: it is cut where the host reads the number back and makes room.
    Exact,
    /// What the caller says. The frame is never cut; fragments beyond are counted as lost.
    Reserve(Room),
}

/// Room for the fragments of a frame, or of each slice of a frame that has several.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Room {
    /// For this many fragments.
    Fragments(u32),
    /// For as many as this many bytes hold, over all buffers whose size follows the number of fragments.
    Bytes(u64),
}

impl Sizing {
    /// Fragments per pixel that [`Sizing::Auto`] makes room for where nobody counts them.
    pub const AUTO_PER_PIXEL: u32 = 8;
}

/// Whether shaders check bounds and bound loops at run time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Checks {
    /// Only where the description has functions or files of its own: all other code comes from tested templates.
    Auto,
    /// Always.
    On,
    /// Never.
    Off,
}

/// One vertex buffer of the caller's own layout.
#[derive(Clone, Debug)]
pub struct VertexBuffer {
    /// Bytes from one vertex to the next.
    pub stride: u64,
    /// Whether it advances by vertex or by instance.
    pub step_mode: wgpu::VertexStepMode,
    /// Where the inputs lie in it.
    pub attributes: Vec<wgpu::VertexAttribute>,
}

impl Settings {
    /// A frame of `width` × `height` pixels resolved into a view of format `target`: automatic sizing and checks, no
    /// timestamps, interleaved vertices, triangle lists, nothing culled.
    pub fn new(target: wgpu::TextureFormat, width: u32, height: u32) -> Self {
        Settings {
            target,
            width,
            height,
            sizing: Sizing::Auto,
            slice: None,
            checks: Checks::Auto,
            vertices: None,
            primitive: wgpu::PrimitiveState::default(),
            timestamps: false,
        }
    }
}
