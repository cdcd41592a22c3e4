//! Draws the charts of a sweep as SVG: medians with quartiles on logarithmic axes, and one legend for all charts.

use plotters::coord::combinators::BindKeyPoints;
use plotters::prelude::*;

use super::experiment::{Chart, Experiment, Measure, Panel, Passes, Sweep};
use super::point::{Measurement, Outcome, Point};
use super::spread::{Spread, spread};
use super::style::{Area, COLORS, FONT, MUTED, TITLE, failure, marker, ticks, titled};
use crate::cli::output::Failure;

/// The size of a chart, and of the strip at the right.
const CHART: (u32, u32) = (400, 310);
const LEGEND: u32 = 170;

/// The greatest number of charts in a row.
const COLUMNS: usize = 3;

/// Returns the charts of a sweep.
pub(super) fn svg(experiment: &Experiment, sweep: &Sweep, points: &[Point], device: &str) -> Result<String, Failure> {
    let lines = sweep.charts.len().div_ceil(COLUMNS).max(1);
    let columns = sweep.charts.len().div_ceil(lines).max(1);
    let size = (CHART.0 * columns as u32 + LEGEND, TITLE + CHART.1 * lines as u32);
    let mut text = String::new();
    {
        let root = SVGBackend::with_string(&mut text, size).into_drawing_area();
        let title = format!("{}: {}", experiment.paper, experiment.title);
        let how = format!("{device}; median of the repeats with quartiles; both axes are logarithmic");
        let body = titled(&root, title, (how, MUTED))?;
        let (charts, side) = body.split_horizontally(CHART.0 * columns as u32);
        let labels = labels(sweep);
        for (area, chart) in charts.split_evenly((lines, columns)).iter().zip(sweep.charts) {
            let panel = sweep.panels.iter().find(|panel| panel.name == chart.panel);
            if let Some(panel) = panel {
                draw(area, chart, panel, points, &labels)?;
            }
        }
        legend(&side, &labels, points)?;
        root.present().map_err(failure)?;
    }
    Ok(text)
}

/// Returns the labels of all series of the charts, each once. The index is that of the style.
fn labels(sweep: &Sweep) -> Vec<&'static str> {
    let mut labels: Vec<&str> = Vec::new();
    for series in sweep.panels.iter().flat_map(|panel| panel.series) {
        if !labels.contains(&series.label) {
            labels.push(series.label);
        }
    }
    labels
}

/// Returns the numbers of a point, by repeat.
fn samples(measured: &Measurement, measure: Measure) -> Vec<f64> {
    let mebibytes = measured.bytes as f64 / f64::from(1 << 20);
    match measure {
        Measure::Time(passes) => measured.samples(passes),
        Measure::TimePerMebibyte => measured.samples(Passes::All).into_iter().map(|time| time / mebibytes).collect(),
        Measure::Mebibytes => vec![mebibytes],
    }
}

/// Returns the unit of a chart.
fn unit(measure: Measure) -> &'static str {
    match measure {
        Measure::Time(_) => "ms",
        Measure::TimePerMebibyte => "ms / MiB",
        Measure::Mebibytes => "MiB",
    }
}

/// Returns the measured spreads of a series by value.
fn measured(points: &[Point], panel: &str, series: &str, measure: Measure) -> Vec<(f64, Spread)> {
    let of = points.iter().filter(|point| point.panel == panel && point.series == series);
    let spread_of = |point: &Point| match &point.outcome {
        Outcome::Measured(measured) => {
            let found = spread(&samples(measured, measure)).filter(|spread| spread.median > 0.0)?;
            Some((f64::from(point.x), found))
        }
        Outcome::Unavailable(_) => None,
    };
    of.filter_map(spread_of).collect()
}

fn draw(area: &Area<'_>, chart: &Chart, panel: &Panel, points: &[Point], labels: &[&str]) -> Result<(), Failure> {
    let lines: Vec<(&str, Vec<(f64, Spread)>)> = panel
        .series
        .iter()
        .map(|series| (series.label, measured(points, panel.name, series.label, chart.measure)))
        .collect();
    let all = || lines.iter().flat_map(|(_, line)| line);
    let bounds = |values: &mut dyn Iterator<Item = f64>, margin: f64| {
        let (least, greatest) = values.fold((f64::INFINITY, 0.0_f64), |(a, b), value| (a.min(value), b.max(value)));
        (least > 0.0 && least.is_finite()).then(|| least / margin..greatest * margin)
    };
    let x_range = bounds(&mut all().map(|(x, _)| *x), 1.15);
    let y_range =
        bounds(&mut all().flat_map(|(_, spread)| [spread.quartiles[0].max(1.0e-4), spread.quartiles[1]]), 1.3);
    let (Some(x_range), Some(y_range)) = (x_range, y_range) else {
        let text = format!("{}: no measured point", chart.title);
        return area.draw(&Text::new(text, (60, 40), (FONT, 14).into_font().color(&MUTED))).map_err(failure);
    };
    let mut x_ticks: Vec<f64> = all().map(|(x, _)| *x).collect();
    x_ticks.sort_by(f64::total_cmp);
    x_ticks.dedup();
    let y_ticks = ticks(&y_range);
    let mut context = ChartBuilder::on(area)
        .caption(chart.title, (FONT, 15))
        .margin(10)
        .margin_right(22)
        .x_label_area_size(42)
        .y_label_area_size(62)
        .build_cartesian_2d(x_range.log_scale().with_key_points(x_ticks), y_range.log_scale().with_key_points(y_ticks))
        .map_err(failure)?;
    context
        .configure_mesh()
        .light_line_style(TRANSPARENT)
        .bold_line_style(MUTED.mix(0.25))
        .x_desc(panel.axis.label)
        .y_desc(unit(chart.measure))
        .axis_desc_style((FONT, 13))
        .label_style((FONT, 12))
        .x_label_formatter(&|x| format!("{x:.0}"))
        .y_label_formatter(&|y| format!("{y}"))
        .draw()
        .map_err(failure)?;
    for (label, line) in &lines {
        let style = labels.iter().position(|known| known == label).unwrap_or(0);
        let color = COLORS[style % COLORS.len()];
        let medians = line.iter().map(|(x, spread)| (*x, spread.median));
        context.draw_series(LineSeries::new(medians.clone(), color.stroke_width(2))).map_err(failure)?;
        let bars = line.iter().map(|(x, Spread { quartiles: [low, high], .. })| {
            PathElement::new(vec![(*x, low.max(1.0e-4)), (*x, *high)], color.stroke_width(1))
        });
        context.draw_series(bars).map_err(failure)?;
        context.draw_series(medians.map(|at| marker(at, style, color))).map_err(failure)?;
    }
    Ok(())
}

/// Draws the legend. A series that the device cannot run has a note instead of a line.
fn legend(area: &Area<'_>, labels: &[&str], points: &[Point]) -> Result<(), Failure> {
    for (style, label) in labels.iter().enumerate() {
        let (y, color) = (40 + 22 * style as i32, COLORS[style % COLORS.len()]);
        let is_measured = |point: &Point| point.series == *label && matches!(point.outcome, Outcome::Measured(_));
        if points.iter().any(is_measured) {
            let line = PathElement::new(vec![(6, y), (34, y)], color.stroke_width(2));
            area.draw(&line).map_err(failure)?;
            area.draw(&marker((20, y), style, color)).map_err(failure)?;
            let text = (*label).to_owned();
            area.draw(&Text::new(text, (42, y - 7), (FONT, 13).into_font().color(&BLACK))).map_err(failure)?;
        } else {
            area.draw(&Text::new("none:", (6, y - 7), (FONT, 11).into_font().color(&MUTED))).map_err(failure)?;
            let text = (*label).to_owned();
            area.draw(&Text::new(text, (42, y - 7), (FONT, 13).into_font().color(&MUTED))).map_err(failure)?;
        }
    }
    Ok(())
}
