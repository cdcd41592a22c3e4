//! The settings of a renderer.

use fragbuf_frame::{Conditions, DEFAULT_MEMORY, Decisions, Sizing};

/// The settings of a renderer. [`Settings::new`] has the defaults; every field may be changed.
#[derive(Clone, Debug)]
pub struct Settings {
    /// The format of the view that frames are resolved into. It must be blendable.
    pub target: wgpu::TextureFormat,
    /// Width of the frame, in pixels.
    pub width: u32,
    /// Height of the frame, in pixels.
    pub height: u32,
    /// How memory is sized for fragments whose number is unknown in advance.
    pub sizing: Sizing,
    /// Whether frames wait for the decisions of host steps, or use those of earlier frames ([`crate::Renderer::decide`]).
    pub decisions: Decisions,
    /// Who ends loops on their conditions and drops hidden objects. With [`Conditions::OnDevice`] no frame is suspended for them, and the
    /// scene is drawn by [`Call::draw`](crate::Call::draw) from the draws of [`Renderer::set_draws`](crate::Renderer::set_draws).
    pub conditions: Conditions,
    /// The rows of a slice. The frame is drawn slice by slice, and each slice draws the whole scene. `None`: as many rows as
    /// the device's limits and `memory` allow, which is the whole frame unless its buffers are too large.
    pub slice: Option<u32>,
    /// The bytes that a renderer may allocate on the device for a frame: the plan's buffers, its textures and the attachments of
    /// passes without one, but not external textures and the view that the frame is resolved into. A buffer that is replaced by a
    /// larger one within a frame is not counted, although it exists until the commands that use it have run. Slices are as high as
    /// `memory` allows. Default: [`DEFAULT_MEMORY`], 2 GiB.
    pub memory: u64,
    /// Whether shaders check array bounds and limit loops at run time.
    pub checks: Checks,
    /// Whether the device has interlock, as [`crate::headless::open_device`] returns it; otherwise [`Interlock::Absent`].
    pub interlock: Interlock,
    /// The vertex buffers of geometry passes; `None`: one interleaved buffer as in [`crate::VertexInputs`].
    pub vertices: Option<Vec<VertexBuffer>>,
    /// How primitives are assembled, culled and filled.
    pub primitive: wgpu::PrimitiveState,
    /// Whether passes are timed, where the device has `TIMESTAMP_QUERY`.
    pub timestamps: bool,
}

/// Whether shaders check array bounds and limit loops at run time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Checks {
    /// Only if the description has user functions or user files. All other code comes from tested templates.
    Auto,
    /// Always.
    On,
    /// Never.
    Off,
}

/// Whether a device has fragment shader interlock (`VK_EXT_fragment_shader_interlock`). wgpu has no query for it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Interlock {
    /// The device was created without it.
    Absent,
    /// The device was created with it, and with `fragmentShaderPixelInterlock` enabled.
    Enabled,
}

/// One vertex buffer of a layout that the caller chooses.
#[derive(Clone, Debug)]
pub struct VertexBuffer {
    /// The bytes from one vertex to the next.
    pub stride: u64,
    /// Whether it advances per vertex or per instance.
    pub step_mode: wgpu::VertexStepMode,
    /// The positions of the inputs in it.
    pub attributes: Vec<wgpu::VertexAttribute>,
}

impl Settings {
    /// Returns the defaults for a frame of `width` × `height` pixels in a view of format `target`: automatic sizing and checks,
    /// no interlock, no timestamps, interleaved vertices, triangle lists, no face culling.
    pub fn new(target: wgpu::TextureFormat, width: u32, height: u32) -> Self {
        Settings {
            target,
            width,
            height,
            sizing: Sizing::Auto,
            decisions: Decisions::Immediate,
            conditions: Conditions::OnHost,
            slice: None,
            memory: DEFAULT_MEMORY,
            checks: Checks::Auto,
            interlock: Interlock::Absent,
            vertices: None,
            primitive: wgpu::PrimitiveState::default(),
            timestamps: false,
        }
    }
}
