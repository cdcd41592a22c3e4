//! Draws a histogram of depth complexity as SVG, with the predicted k and the k of the budget.

use fragbuf_templates::{Histogram, Prediction};
use plotters::prelude::*;

use crate::cli::figure::histogram;
use crate::cli::figure::style::{COLORS, failure, titled};
use crate::cli::output::Failure;

const SIZE: (u32, u32) = (640, 400);

/// Returns the drawing.
pub(super) fn svg(title: &str, histogram: &Histogram, prediction: &Prediction) -> Result<String, Failure> {
    let Prediction { k, k_budget, .. } = *prediction;
    let mut text = String::new();
    {
        let root = SVGBackend::with_string(&mut text, SIZE).into_drawing_area();
        let marks = format!("k = {k}; the budget allows k = {k_budget}");
        let body = titled(&root, title.to_owned(), (marks, COLORS[1]))?;
        histogram::draw(&body, "pixels by their number of fragments, logarithmic", histogram, &[(k, COLORS[1])])?;
        root.present().map_err(failure)?;
    }
    Ok(text)
}
