//! What a caller decides about a renderer.

use fragbuf_frame::Sizing;

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
    /// Whether the device has interlock: what [`crate::headless::open_device`] said, or [`Interlock::Absent`].
    pub interlock: Interlock,
    /// The vertex buffers of geometry passes; `None`: one, interleaved, as [`crate::VertexInputs`] says.
    pub vertices: Option<Vec<VertexBuffer>>,
    /// How geometry is put together, culled and filled.
    pub primitive: wgpu::PrimitiveState,
    /// Whether passes are timed, where the device has `TIMESTAMP_QUERY`.
    pub timestamps: bool,
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

/// Whether a device has fragment shader interlock (`VK_EXT_fragment_shader_interlock`). wgpu cannot be asked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Interlock {
    /// The device was made without it.
    Absent,
    /// The device was made with it, and its `fragmentShaderPixelInterlock` is on.
    Enabled,
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
    /// interlock, no timestamps, interleaved vertices, triangle lists, nothing culled.
    pub fn new(target: wgpu::TextureFormat, width: u32, height: u32) -> Self {
        Settings {
            target,
            width,
            height,
            sizing: Sizing::Auto,
            slice: None,
            checks: Checks::Auto,
            interlock: Interlock::Absent,
            vertices: None,
            primitive: wgpu::PrimitiveState::default(),
            timestamps: false,
        }
    }
}
