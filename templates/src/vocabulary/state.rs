//! Fixed-function state of a pass: depth and stencil tests, targets, samples. Plans and manifests contain it; devices
//! and engines set it.

use super::Formula;

/// Fixed-function state of a pass.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct State {
    /// The depth test; `None`: off.
    pub depth: Option<DepthState>,
    /// The stencil test; `None`: off.
    pub stencil: Option<StencilState>,
    /// The colour targets, in the order of their locations.
    pub targets: Vec<ColorTarget>,
    /// The samples; `None`: one.
    pub samples: Option<Samples>,
}

/// The depth test of a pass.
#[derive(Clone, Debug, PartialEq)]
pub struct DepthState {
    /// The attachment.
    pub resource: String,
    /// The test.
    pub compare: Compare,
    /// Whether fragments that pass write their depth.
    pub write: bool,
    /// Whether the test must run before the shader.
    pub early: bool,
}

/// The stencil test of a pass.
#[derive(Clone, Debug, PartialEq)]
pub struct StencilState {
    /// The attachment.
    pub resource: String,
    /// The test of the reference against the stored value.
    pub compare: Compare,
    /// The operation of a fragment that fails.
    pub fail: StencilOperation,
    /// The operation of a fragment that passes.
    pub pass: StencilOperation,
    /// The reference value.
    pub reference: Formula,
}

/// An operation on the stored stencil value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StencilOperation {
    /// Keeps it.
    Keep,
    /// Sets it to the reference.
    Replace,
    /// Decrements it, clamped at zero.
    DecrementClamp,
}

/// A comparison of a depth or stencil test.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Compare {
    /// Always passes.
    Always,
    /// New < stored.
    Less,
    /// New ≤ stored.
    LessEqual,
    /// New = stored.
    Equal,
    /// New > stored.
    Greater,
    /// New ≥ stored.
    GreaterEqual,
}

/// A colour target of a pass.
#[derive(Clone, Debug, PartialEq)]
pub struct ColorTarget {
    /// The attachment; `output` is the target of the caller.
    pub resource: String,
    /// How the new value is combined with the old.
    pub blend: Blend,
}

/// How a colour target blends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Blend {
    /// The new value.
    Replace,
    /// new + (1 − new.alpha) · old: premultiplied *over*.
    Over,
    /// old + (1 − old.alpha) · new: premultiplied *under*, for front-to-back order.
    Under,
    /// The greater, per channel.
    Max,
    /// The lesser, per channel.
    Min,
    /// The sum.
    Add,
}

/// The samples of a pass.
#[derive(Clone, Debug, PartialEq)]
pub struct Samples {
    /// The number per pixel.
    pub count: Formula,
    /// The bit mask of samples that are written.
    pub mask: Formula,
    /// Which samples a triangle covers.
    pub coverage: Coverage,
}

/// Which samples of a multisampled pixel a triangle covers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Coverage {
    /// The samples inside the triangle.
    PerSample,
    /// All samples if the pixel centre is inside: multisample coverage is off, and no fragment has partial coverage.
    /// OpenGL supports it; on other devices, fragments at edges cover some samples.
    WholePixel,
}
