//! Draws a histogram of depth complexity as SVG, with the predicted k and the k of the budget.

use fragbuf_templates::{Histogram, Prediction};
use plotters::prelude::*;

use crate::cli::figure::style::{COLORS, FONT, MUTED, failure};
use crate::cli::output::Failure;

const SIZE: (u32, u32) = (640, 400);
const TITLE: u32 = 58;

/// Returns the drawing.
pub(super) fn svg(title: &str, histogram: &Histogram, prediction: &Prediction) -> Result<String, Failure> {
    let Prediction { k, k_budget, .. } = *prediction;
    let bins = histogram.bins();
    let deepest = bins.iter().rposition(|pixels| *pixels > 0).map_or(1, |bin| bin + 1) as f64;
    let most = bins.iter().copied().max().unwrap_or(0).max(1) as f64;
    let right = deepest.max(f64::from(k)) + 1.0;
    let mut text = String::new();
    {
        let root = SVGBackend::with_string(&mut text, SIZE).into_drawing_area();
        root.fill(&WHITE).map_err(failure)?;
        let (head, body) = root.split_vertically(TITLE);
        head.draw(&Text::new(title.to_owned(), (16, 12), (FONT, 16).into_font().color(&BLACK))).map_err(failure)?;
        let marks = format!("k = {k}; the budget allows k = {k_budget}");
        head.draw(&Text::new(marks, (16, 36), (FONT, 13).into_font().color(&COLORS[1]))).map_err(failure)?;
        let mut chart = ChartBuilder::on(&body)
            .margin(12)
            .x_label_area_size(40)
            .y_label_area_size(64)
            .build_cartesian_2d(0.0..right, 0.0..1.05 * most)
            .map_err(failure)?;
        let mut mesh = chart.configure_mesh();
        mesh.max_light_lines(0).disable_x_mesh().x_desc("fragments per pixel").y_desc("pixels").axis_style(MUTED);
        mesh.label_style((FONT, 12))
            .x_label_formatter(&|x| format!("{x:.0}"))
            .y_label_formatter(&|y| format!("{y:.0}"));
        mesh.draw().map_err(failure)?;
        let bars = (1..).zip(bins).filter(|(_, pixels)| **pixels > 0).map(|(count, pixels)| {
            let count = f64::from(count);
            Rectangle::new([(count - 0.4, 0.0), (count + 0.4, *pixels as f64)], COLORS[0].filled())
        });
        chart.draw_series(bars).map_err(failure)?;
        let line = |k: f64| PathElement::new(vec![(k + 0.5, 0.0), (k + 0.5, 1.05 * most)], COLORS[1].stroke_width(2));
        chart.draw_series([line(f64::from(k))]).map_err(failure)?;
        root.present().map_err(failure)?;
    }
    Ok(text)
}
