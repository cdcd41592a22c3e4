//! Rows of a slice: as many as the device's limits let every buffer have.

use fragbuf_codegen::Plan;
use fragbuf_frame::Values;

use crate::Error;
use crate::memory::checked_sizes;

/// The rows of a slice: as the caller wants, or as many as every buffer is within the limits at.
pub(crate) fn rows(plan: &Plan, values: &Values, slice: Option<u32>, limits: &wgpu::Limits) -> Result<u32, Error> {
    if let Some(rows) = slice {
        return Ok(rows.clamp(1, values.height().max(1)));
    }
    let attempt = |rows: u32| checked_sizes(plan, &values.with_rows(rows), limits);
    // Not even one row: the error says what is too large.
    attempt(1)?;
    greatest(values.height(), |rows| Ok(rows == 0 || attempt(rows).is_ok()))
}

/// The greatest number up to `end` that holds, where 0 holds and none does after one that does not.
fn greatest(end: u32, holds: impl Fn(u32) -> Result<bool, Error>) -> Result<u32, Error> {
    if holds(end)? {
        return Ok(end);
    }
    let (mut yes, mut no) = (0, end);
    while no - yes > 1 {
        let middle = yes + (no - yes) / 2;
        if holds(middle)? { yes = middle } else { no = middle }
    }
    Ok(yes)
}
