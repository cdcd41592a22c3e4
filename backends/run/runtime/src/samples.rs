//! Samples per pixel of a pass.

use fragbuf_codegen::{Plan, PlannedPass};
use fragbuf_frame::Values;

use crate::Error;

/// Returns the samples per pixel of a pass.
pub(crate) fn sample_count(plan: &Plan, pass: &PlannedPass) -> Result<u32, Error> {
    let Some([count, _]) = &pass.samples else { return Ok(1) };
    Ok(Values::of_code(plan).word(count, "the samples of a pass")?)
}

/// Returns the sample count and mask of a pass in one iteration of a loop.
pub(crate) fn multisample(plan: &Plan, pass: &PlannedPass, iteration: u32) -> Result<wgpu::MultisampleState, Error> {
    let Some([count, mask]) = &pass.samples else { return Ok(wgpu::MultisampleState::default()) };
    let code = Values::of_code(plan).in_iteration(iteration);
    Ok(wgpu::MultisampleState {
        count: code.word(count, "the samples of a pass")?,
        mask: code.word(mask, "the sample mask of a pass")?.into(),
        alpha_to_coverage_enabled: false,
    })
}
