//! A frame that is drawn repeatedly, to measure its time.
//!
//! Input: the frame that a device has drawn. Output: the times of its passes, from one more frame per call. Nothing is compiled, allocated
//! or redrawn meanwhile.

use std::time::Instant;

use fragbuf_frame::PassTime;

use super::cpu::CpuFrame;
#[cfg(feature = "gpu")]
use super::gpu::GpuFrame;
use crate::cli::output::Failure;

/// A frame with a device that has everything to draw it again.
#[cfg_attr(not(feature = "figures"), allow(dead_code, reason = "figures draw frames again"))]
pub(crate) enum PreparedFrame {
    Cpu(Box<CpuFrame>),
    #[cfg(feature = "gpu")]
    Gpu(Box<GpuFrame>),
}

#[cfg_attr(not(feature = "figures"), allow(dead_code, reason = "figures draw frames again"))]
impl PreparedFrame {
    /// Draws the frame again.
    pub(crate) fn draw(&mut self) -> Result<FrameTime, Failure> {
        match self {
            PreparedFrame::Cpu(frame) => frame.draw(),
            #[cfg(feature = "gpu")]
            PreparedFrame::Gpu(frame) => frame.draw(),
        }
    }
}

/// The time of one frame.
#[cfg_attr(not(feature = "figures"), allow(dead_code, reason = "figures draw frames again"))]
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct FrameTime {
    /// The times that the device measured, in the order of the plan; empty if it measures none.
    pub(crate) passes: Vec<PassTime>,
    /// The time from the first command until the host has the times of the passes, in milliseconds, by the clock of the host.
    pub(crate) host: f64,
}

#[cfg_attr(not(feature = "figures"), allow(dead_code, reason = "figures draw frames again"))]
impl FrameTime {
    /// Measures a function that draws a frame and returns the times of its passes.
    pub(super) fn measure(draw: impl FnOnce() -> Result<Vec<PassTime>, Failure>) -> Result<Self, Failure> {
        let start = Instant::now();
        let passes = draw()?;
        Ok(FrameTime { passes, host: 1.0e3 * start.elapsed().as_secs_f64() })
    }
}
