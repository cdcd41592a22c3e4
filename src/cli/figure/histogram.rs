//! Draws a histogram of depth complexity with values of k marked. The number of pixels is logarithmic: a few deep pixels decide k.

use fragbuf_templates::Histogram;
use plotters::coord::combinators::BindKeyPoints;
use plotters::prelude::*;

use super::style::{Area, COLORS, FONT, MUTED, failure, ticks};
use crate::cli::output::Failure;

/// Draws the histogram and a vertical line per k, right of the bar of k fragments.
pub(crate) fn draw(
    area: &Area<'_>,
    caption: &str,
    histogram: &Histogram,
    ks: &[(u32, RGBColor)],
) -> Result<(), Failure> {
    let bins = histogram.bins();
    let deepest = bins.iter().rposition(|pixels| *pixels > 0).map_or(1, |bin| bin + 1) as f64;
    let last = ks.iter().map(|(k, _)| f64::from(*k)).fold(deepest, f64::max) + 1.0;
    let most = bins.iter().copied().max().unwrap_or(0).max(1) as f64;
    let range = 0.5..2.0 * most;
    let mut chart = ChartBuilder::on(area)
        .caption(caption, (FONT, 14))
        .margin(8)
        .x_label_area_size(36)
        .y_label_area_size(56)
        .build_cartesian_2d(0.0..last, range.clone().log_scale().with_key_points(ticks(&range)))
        .map_err(failure)?;
    let mut mesh = chart.configure_mesh();
    mesh.max_light_lines(0).disable_x_mesh().x_desc("fragments per pixel").y_desc("pixels").axis_style(MUTED);
    mesh.label_style((FONT, 11)).x_label_formatter(&|x| format!("{x:.0}")).y_label_formatter(&|y| format!("{y}"));
    // With no more labels than whole numbers, no label is a fraction.
    mesh.x_labels((last as usize + 1).min(11));
    mesh.draw().map_err(failure)?;
    let bars = (1..).zip(bins).filter(|(_, pixels)| **pixels > 0).map(|(count, pixels)| {
        let count = f64::from(count);
        Rectangle::new([(count - 0.4, range.start), (count + 0.4, *pixels as f64)], COLORS[0].filled())
    });
    chart.draw_series(bars).map_err(failure)?;
    for (k, color) in ks {
        let x = f64::from(*k) + 0.5;
        let line = PathElement::new(vec![(x, range.start), (x, range.end)], color.stroke_width(2));
        chart.draw_series([line]).map_err(failure)?;
    }
    Ok(())
}
