//! Measures the disorder of the fragments of a scene by the budget of a subdivision.
//!
//! Input: a row. Output: a CSV file with a line per budget, and an SVG with bars beside the paper's values. Disorder is the greatest distance of a
//! fragment from its place in the order of depths, over all pixels. The CPU device counts it, so a run gives the same numbers again.

use super::Figure;
use super::claim::{Finding, sentence};
use super::csv::{self, Row};
use super::experiment::{Disorder, Experiment};
use super::run::{QUICK_SIDE, Run};
use super::svg::{Anchor, Svg};
use crate::cli::arrangement::Arrangement;
use crate::cli::output::Failure;
use fragbuf_cpu::FragmentOrder;

const COLUMNS: [&str; 5] = ["budget", "triangles", "disorder_as_modelled", "disorder", "disorder_in_paper"];

/// The disorder at a budget.
struct Point {
    /// In per cent of the triangles of the model.
    budget: u32,
    triangles: usize,
    as_modelled: u32,
    sorted: u32,
    paper: Option<u32>,
}

/// Runs an experiment and returns its sentence.
pub(super) fn run(row: &Disorder, options: &Figure, experiment: &Experiment) -> Result<String, Failure> {
    let [full, quick] = row.scene;
    let (scene, side) = match options.quick {
        true => (quick, QUICK_SIDE),
        false => (full, options.size.unwrap_or(row.side)),
    };
    let details = [format!("{scene}, camera {}, {side} x {side} pixels, sorted from front to back", row.camera)];
    let run = Run::new(options, experiment, Some(FragmentOrder::Submission), &details)?;
    let mut points = Vec::new();
    for (number, (budget, paper)) in row.budgets.iter().enumerate() {
        run.show(number as f64 / row.budgets.len() as f64, &format!("budget {}", ratio(*budget)));
        let mut view = run.view(scene.to_owned(), row.camera, (side, side), options.memory)?;
        view.arrangement = Arrangement::sorted(f64::from(*budget) / 100.0);
        let (scene, _) = view.scene_views(&[])?;
        let measured = scene.disorder.ok_or_else(|| {
            Failure::Device(
                "the fragments do not fit into memory: raise `--memory`, or use a smaller `--size`".to_owned(),
            )
        })?;
        let (as_modelled, sorted) = (measured.before, measured.after);
        points.push(Point { budget: *budget, triangles: scene.scene.triangles(), as_modelled, sorted, paper: *paper });
    }
    let rows: Vec<Row> = points.iter().map(line).collect();
    csv::write(&run.file("csv"), &run.header, &COLUMNS, &rows)?;
    csv::write_text(&run.file("svg"), &bars(experiment, &run.selection.name(), &points))?;
    Ok(sentence(experiment.paper, &run.selection.name(), &findings(&points)))
}

/// Returns a budget as the factor of the paper.
fn ratio(budget: u32) -> String {
    format!("{:.1}", f64::from(budget) / 100.0)
}

fn line(point: &Point) -> Row {
    vec![
        ratio(point.budget),
        point.triangles.to_string(),
        point.as_modelled.to_string(),
        point.sorted.to_string(),
        point.paper.map_or(String::new(), |paper| paper.to_string()),
    ]
}

/// Returns what the paper states about the table.
fn findings(points: &[Point]) -> Vec<(&'static str, Finding)> {
    let decided = |holds: bool, text: String| if holds { Finding::Agrees(text) } else { Finding::Differs(text) };
    let (Some(first), Some(last)) = (points.first(), points.last()) else { return Vec::new() };
    let falls =
        points.windows(2).all(|pair| matches!(pair, [a, b] if b.sorted <= a.sorted)) && last.sorted < first.sorted;
    let all: Vec<String> = points.iter().map(|point| format!("{} at {}", point.sorted, ratio(point.budget))).collect();
    vec![
        ("the maximum disorder falls with the budget", decided(falls, all.join(", "))),
        ("no disorder is left with twelve times as many triangles", decided(last.sorted == 0, last.sorted.to_string())),
    ]
}

/// The sizes of the drawing: a line of two bars, the space for the names, and the length of the greatest bar.
const LINE: u32 = 46;
const LEFT: u32 = 120;
const LENGTH: u32 = 420;
const TOP: u32 = 64;

/// Returns the SVG: two bars per budget, ours and the paper's.
fn bars(experiment: &Experiment, device: &str, points: &[Point]) -> String {
    let values = || points.iter().flat_map(|point| [Some(point.sorted), point.paper]).flatten();
    let greatest = values().max().unwrap_or(1).max(1);
    let mut svg = Svg::new(LEFT + LENGTH + 60, TOP + LINE * points.len() as u32 + 16);
    svg.text([16, 24], (17, "#000000", Anchor::Start), &format!("{}: {}", experiment.paper, experiment.title));
    let note =
        format!("{device}; triangles over those of the model, and the maximum disorder: blue here, grey in the paper");
    svg.text([16, 44], (12, "#5f5f5f", Anchor::Start), &note);
    for (number, point) in (0_u32..).zip(points) {
        let y = TOP + LINE * number;
        let name = format!("{} ({})", ratio(point.budget), point.triangles);
        svg.text([16, y + 24], (12, "#000000", Anchor::Start), &name);
        for (line, value, color) in [(0, Some(point.sorted), "#0072b2"), (1, point.paper, "#a0a0a0")] {
            let Some(value) = value else { continue };
            let (top, length) = (y + 18 * line, LENGTH * value / greatest);
            svg.rectangle([LEFT, top, length.max(2), 16], color);
            svg.text([LEFT + length + 8, top + 13], (12, "#000000", Anchor::Start), &value.to_string());
        }
    }
    svg.finish()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn findings_follow_from_the_points() {
        let points = |sorted: [u32; 3]| -> Vec<Point> {
            let point = |(budget, sorted)| Point { budget, triangles: 1, as_modelled: 9, sorted, paper: None };
            [100, 150, 1200].into_iter().zip(sorted).map(point).collect()
        };
        let agree = |sorted: [u32; 3]| -> Vec<bool> {
            findings(&points(sorted)).iter().map(|(_, finding)| matches!(finding, Finding::Agrees(_))).collect()
        };
        assert_eq!(agree([8, 3, 0]), [true, true]);
        assert_eq!(agree([8, 8, 1]), [true, false]);
        assert_eq!(agree([8, 2, 3]), [false, false]);
        assert_eq!(agree([9, 9, 9]), [false, false]);
    }
}
