//! The look of charts: font, colours, markers and ticks.

use std::ops::Range;

use plotters::coord::Shift;
use plotters::prelude::*;

use crate::cli::output::Failure;

/// The font family.
pub(crate) const FONT: &str = "sans-serif";

/// The colour of what is not data.
pub(crate) const MUTED: RGBColor = RGBColor(95, 95, 95);

/// The colours of series, different for readers with impaired colour vision (Okabe & Ito 2008), then darker ones.
pub(crate) const COLORS: [RGBColor; 12] = [
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(230, 159, 0),
    RGBColor(86, 180, 233),
    RGBColor(60, 60, 60),
    RGBColor(120, 40, 140),
    RGBColor(150, 110, 30),
    RGBColor(170, 30, 50),
    RGBColor(90, 130, 20),
    RGBColor(20, 70, 90),
];

/// The area of a part of an image.
pub(crate) type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;

/// The height of the strip at the top of an image, in pixels.
pub(crate) const TITLE: u32 = 58;

/// Writes a title, and a line below it, at the top of a new image. Returns the area below.
pub(crate) fn titled<'a>(image: &Area<'a>, title: String, line: (String, RGBColor)) -> Result<Area<'a>, Failure> {
    image.fill(&WHITE).map_err(failure)?;
    let (head, body) = image.split_vertically(TITLE);
    head.draw(&Text::new(title, (16, 12), (FONT, 18).into_font().color(&BLACK))).map_err(failure)?;
    head.draw(&Text::new(line.0, (16, 36), (FONT, 13).into_font().color(&line.1))).map_err(failure)?;
    Ok(body)
}

/// Returns the marker of a point: filled for the first half of the colours, hollow for the others.
pub(super) fn marker<C>(at: C, style: usize, color: RGBColor) -> Circle<C, i32> {
    let is_filled = style % COLORS.len() < COLORS.len() / 2;
    let look = if is_filled { color.filled() } else { color.stroke_width(2) };
    Circle::new(at, 4, look)
}

/// Returns the ticks of a logarithmic axis: 1, 2 and 5 times the powers of ten, or the powers alone in a range of many.
pub(super) fn ticks(range: &Range<f64>) -> Vec<f64> {
    let powers = range.start.log10().floor() as i32..=range.end.log10().ceil() as i32;
    let factors: &[f64] = if powers.clone().count() > 4 { &[1.0] } else { &[1.0, 2.0, 5.0] };
    let of = |power: i32| factors.iter().map(move |factor| rounded(factor * 10.0_f64.powi(power)));
    powers.flat_map(of).filter(|tick| range.contains(tick)).collect()
}

/// Removes the digits that the product of a power of ten adds.
fn rounded(value: f64) -> f64 {
    format!("{value:.2e}").parse().unwrap_or(value)
}

/// Converts an error of the drawing.
pub(crate) fn failure<E: std::error::Error + Send + Sync>(error: DrawingAreaErrorKind<E>) -> Failure {
    Failure::Files(format!("the chart: {error}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_numbers_within_the_range() {
        assert_eq!(ticks(&(0.3..30.0)), [0.5, 1.0, 2.0, 5.0, 10.0, 20.0]);
        assert_eq!(ticks(&(0.05..9000.0)), [0.1, 1.0, 10.0, 100.0, 1000.0]);
    }
}
