//! The points of a sweep: what was measured, or why nothing was.

use super::csv::Row;
use super::experiment::Passes;
use super::spread::{Spread, ratios, spread};

/// One series at one value of a sweep.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Point {
    pub(super) panel: String,
    pub(super) series: String,
    pub(super) x: u32,
    /// The technique with its changes.
    pub(super) description: String,
    pub(super) outcome: Outcome,
}

#[derive(Clone, Debug, PartialEq)]
pub(super) enum Outcome {
    Measured(Measurement),
    /// The reason why the device cannot run the point.
    Unavailable(String),
}

/// The repeated measurements of a point.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Measurement {
    /// The passes in the order of the plan, with the milliseconds of each repeat.
    pub(super) passes: Vec<(String, Vec<f64>)>,
    pub(super) bytes: u64,
    pub(super) slices: u32,
    /// Fragments that the frame lost; `None`: the description does not count.
    pub(super) lost: Option<u64>,
    /// The target whose shaders ran.
    pub(super) target: String,
}

impl Measurement {
    /// Returns the milliseconds of some passes together, by repeat.
    pub(super) fn samples(&self, passes: Passes) -> Vec<f64> {
        let chosen: Vec<&Vec<f64>> =
            self.passes.iter().filter(|(pass, _)| passes.contain(pass)).map(|(_, samples)| samples).collect();
        let repeats = chosen.iter().map(|samples| samples.len()).min().unwrap_or(0);
        (0..repeats).map(|repeat| chosen.iter().filter_map(|samples| samples.get(repeat)).sum()).collect()
    }
}

/// The columns of the CSV file.
pub(super) const COLUMNS: [&str; 15] = [
    "panel",
    "series",
    "x",
    "description",
    "pass",
    "median_ms",
    "q1_ms",
    "q3_ms",
    "ratio",
    "bytes",
    "slices",
    "lost",
    "target",
    "unavailable",
    "samples_ms",
];

/// The name of the sum of all passes.
const FRAME: &str = "frame";

/// Returns the lines of a point: one per pass and one for the frame. `reference` is the point whose frame the ratio refers to.
pub(super) fn rows(point: &Point, reference: Option<&Measurement>) -> Vec<Row> {
    let Point { panel, series, x, description, outcome } = point;
    let start = [panel.clone(), series.clone(), x.to_string(), description.clone()];
    let line = |cells: [String; 11]| start.iter().cloned().chain(cells).collect::<Row>();
    let empty = String::new;
    let measured = match outcome {
        Outcome::Measured(measured) => measured,
        Outcome::Unavailable(reason) => {
            let mut cells: [String; 11] = std::array::from_fn(|_| String::new());
            (cells[0], cells[9]) = (FRAME.to_owned(), reason.clone());
            return vec![line(cells)];
        }
    };
    let pass = |name: &str, samples: &[f64], ratio: String| {
        let Spread { median, quartiles: [q1, q3] } =
            spread(samples).unwrap_or(Spread { median: f64::NAN, quartiles: [f64::NAN; 2] });
        let values: Vec<String> = samples.iter().map(|value| format!("{value:.4}")).collect();
        line([
            name.to_owned(),
            format!("{median:.4}"),
            format!("{q1:.4}"),
            format!("{q3:.4}"),
            ratio,
            measured.bytes.to_string(),
            measured.slices.to_string(),
            measured.lost.map_or_else(empty, |lost| lost.to_string()),
            measured.target.clone(),
            empty(),
            values.join(" "),
        ])
    };
    let frame = measured.samples(Passes::All);
    let ratio = reference.and_then(|reference| spread(&ratios(&frame, &reference.samples(Passes::All))));
    let ratio = ratio.map_or_else(empty, |ratio| format!("{:.3}", ratio.median));
    let mut lines: Vec<Row> =
        measured.passes.iter().map(|(name, samples)| pass(name, samples, String::new())).collect();
    lines.push(pass(FRAME, &frame, ratio));
    lines
}

/// Returns the points of the lines of a CSV file. Lines that do not have the columns are left out.
pub(super) fn points(rows: &[Row]) -> Vec<Point> {
    let mut points: Vec<Point> = Vec::new();
    for row in rows {
        let Ok([panel, series, x, description, pass, _, _, _, _, bytes, slices, lost, target, reason, samples]) =
            <[String; 15]>::try_from(row.clone())
        else {
            continue;
        };
        let Ok(x) = x.parse() else { continue };
        let is_same = |point: &Point| point.panel == panel && point.series == series && point.x == x;
        if !points.last().is_some_and(is_same) {
            let outcome = match reason.is_empty() {
                true => Outcome::Measured(Measurement::default()),
                false => Outcome::Unavailable(reason),
            };
            points.push(Point { panel, series, x, description, outcome });
        }
        let Some(Point { outcome: Outcome::Measured(measured), .. }) = points.last_mut() else { continue };
        measured.bytes = bytes.parse().unwrap_or(0);
        measured.slices = slices.parse().unwrap_or(1);
        (measured.lost, measured.target) = (lost.parse().ok(), target);
        if pass != FRAME {
            let samples = samples.split_whitespace().filter_map(|value| value.parse().ok()).collect();
            measured.passes.push((pass, samples));
        }
    }
    points
}

#[cfg(test)]
mod tests {
    use super::*;

    fn point(series: &str, store: [f64; 2], resolve: [f64; 2]) -> Point {
        let passes = vec![("store".to_owned(), store.to_vec()), ("resolve".to_owned(), resolve.to_vec())];
        let measured = Measurement { passes, bytes: 64, slices: 2, lost: Some(3), target: "wgsl".to_owned() };
        let outcome = Outcome::Measured(measured);
        Point { panel: "p".to_owned(), series: series.to_owned(), x: 4, description: "a, b".to_owned(), outcome }
    }

    #[test]
    fn points_survive_the_file() {
        let reason = Outcome::Unavailable("it lacks \"interlock\"".to_owned());
        let written = [point("a", [1.0, 2.0], [3.0, 4.5]), Point { outcome: reason, ..point("b", [0.0; 2], [0.0; 2]) }];
        let lines: Vec<Row> = written.iter().flat_map(|point| rows(point, None)).collect();
        assert!(lines.len() == 4 && lines.iter().all(|line| line.len() == COLUMNS.len()));
        assert_eq!(points(&lines), written);
    }

    #[test]
    fn the_frame_is_the_sum_and_the_ratio_that_of_pairs() {
        let (a, b) = (point("a", [1.0, 2.0], [3.0, 4.0]), point("b", [2.0, 5.0], [6.0, 13.0]));
        let Outcome::Measured(reference) = &a.outcome else { unreachable!("it is measured") };
        assert_eq!(reference.samples(Passes::All), [4.0, 6.0]);
        assert_eq!(reference.samples(Passes::Except(&["store"])), [3.0, 4.0]);
        let lines = rows(&b, Some(reference));
        // The ratios of the pairs are 8/4 and 18/6.
        assert_eq!(lines.last().map(|line| (line[4].as_str(), line[8].as_str())), Some(("frame", "2.500")));
    }
}
