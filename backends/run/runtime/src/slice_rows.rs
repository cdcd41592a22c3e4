//! The rows of a slice: as many as the device's limits allow for every buffer.

use fragbuf_codegen::Plan;
use fragbuf_frame::Values;

use crate::Error;
use crate::memory::checked_sizes;

/// Returns the rows of a slice: those that the caller requests, or the most for which every buffer is within the limits.
pub(crate) fn rows(plan: &Plan, values: &Values, slice: Option<u32>, limits: &wgpu::Limits) -> Result<u32, Error> {
    if let Some(rows) = slice {
        return Ok(rows.clamp(1, values.height().max(1)));
    }
    let attempt = |rows: u32| checked_sizes(plan, &values.with_rows(rows), limits);
    // If one row does not fit, the error names the buffer that is too large.
    attempt(1)?;
    Ok(greatest(values.height(), |rows| rows == 0 || attempt(rows).is_ok()))
}

/// Returns the greatest number up to `end` that holds. 0 must hold, and no number may hold after one that does not.
fn greatest(end: u32, holds: impl Fn(u32) -> bool) -> u32 {
    if holds(end) {
        return end;
    }
    let (mut yes, mut no) = (0, end);
    while no - yes > 1 {
        let middle = yes + (no - yes) / 2;
        if holds(middle) { yes = middle } else { no = middle }
    }
    yes
}
