//! Fixed-function state of a pass: depth and stencil tests, targets, samples. In: what rows say. Out: nothing; plans and
//! manifests carry it, devices and engines set it.

use super::Formula;

/// Fixed-function state of a pass.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct State {
    /// Depth test; `None`: off.
    pub depth: Option<DepthState>,
    /// Stencil test; `None`: off.
    pub stencil: Option<StencilState>,
    /// Colour targets, in the order of their locations.
    pub targets: Vec<Target>,
    /// Samples; `None`: one.
    pub samples: Option<Samples>,
}

/// Depth test of a pass.
#[derive(Clone, Debug, PartialEq)]
pub struct DepthState {
    /// The attachment.
    pub resource: String,
    /// The test.
    pub compare: Compare,
    /// Whether passing fragments write their depth.
    pub write: bool,
    /// Whether the test must come before the shader.
    pub early: bool,
}

/// Stencil test of a pass.
#[derive(Clone, Debug, PartialEq)]
pub struct StencilState {
    /// The attachment.
    pub resource: String,
    /// The test of the reference against the stored value.
    pub compare: Compare,
    /// What a failing fragment does.
    pub fail: StencilOperation,
    /// What a passing fragment does.
    pub pass: StencilOperation,
    /// The reference value.
    pub reference: Formula,
}

/// What the stencil test does to the stored value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StencilOperation {
    /// Leaves it.
    Keep,
    /// Sets it to the reference.
    Replace,
    /// One less, never below zero.
    DecrementClamp,
}

/// Comparisons of depth and stencil tests.
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

/// One colour target of a pass.
#[derive(Clone, Debug, PartialEq)]
pub struct Target {
    /// The attachment; `output` is the caller's.
    pub resource: String,
    /// How the new value meets the old.
    pub blend: Blend,
}

/// How a colour target blends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Blend {
    /// The new value stands.
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

/// Samples of a pass.
#[derive(Clone, Debug, PartialEq)]
pub struct Samples {
    /// Per pixel.
    pub count: Formula,
    /// Which are written, as a bit mask.
    pub mask: Formula,
    /// Which of them a triangle covers.
    pub coverage: Coverage,
}

/// Which samples of a pixel a triangle covers, where there are several.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Coverage {
    /// Those that lie inside of it.
    PerSample,
    /// All, where the pixel's middle lies inside: multisample coverage is switched off, and no fragment is half there.
    /// OpenGL can do it; where a device cannot, fragments at edges cover some samples.
    WholePixel,
}
