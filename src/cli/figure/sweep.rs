//! Runs a sweep: measures every series at every value, in turns.
//!
//! Input: a row and the options of the command. Output: points, which are also written to the CSV file after each group of values, so that a later
//! run can resume. All series are prepared first, at as many values as fit into the memory budget. Then each of the repeats draws one frame
//! of each, so the load of the machine is the same for all, and ratios of pairs within a repeat are free of it.

use std::collections::VecDeque;
use std::path::Path;

use fragbuf::Registry;
use fragbuf_frame::PassTime;

use super::Figure;
use super::csv;
use super::experiment::{Axis, Panel, Series, Side, Sweep, at};
use super::point::{COLUMNS, Measurement, Outcome, Point, points, rows};
use super::run::{QUICK_SIDE, Run, changes, description, unavailable};
use crate::cli::input::Input;
use crate::cli::output::{self, Failure};
use crate::cli::rendering::{FrameTime, PreparedFrame, RenderRequest, RenderResult, prepare};
use crate::cli::view::{SceneView, View};

/// The frames of a series that are drawn and not counted, after the frame that finds its capacity.
pub(super) const WARM_UP: u32 = 2;

/// The name of the only pass where the device measures no times.
const HOST_CLOCK: &str = "frame by the host's clock";

/// Measures the points that the CSV file does not have yet, and returns all of them.
pub(super) fn measure(sweep: &Sweep, run: &mut Run<'_>) -> Result<Vec<Point>, Failure> {
    let path = run.file("csv");
    let mut found = resumed(sweep, run, &path);
    let quick = run.options.quick;
    let missing = |panel: &Panel, found: &[Point]| -> VecDeque<u32> {
        values(panel.axis, quick).iter().copied().filter(|x| !is_complete(panel, *x, found)).collect()
    };
    let total: usize = sweep.panels.iter().map(|panel| missing(panel, &found).len()).sum();
    let mut done = 0;
    for panel in sweep.panels {
        let mut waiting = missing(panel, &found);
        found.retain(|point| point.panel != panel.name || !waiting.contains(&point.x));
        while !waiting.is_empty() {
            let before = waiting.len();
            run.share = (done as f64 / total as f64, before as f64 / total as f64);
            found.extend(group(panel, &mut waiting, run)?);
            done += before - waiting.len();
            sort(sweep, &mut found);
            write(sweep, run, &path, &found)?;
        }
    }
    Ok(found)
}

/// Returns the values of an axis.
fn values(axis: Axis, quick: bool) -> &'static [u32] {
    if quick { axis.quick } else { axis.values }
}

/// Returns the scene, the camera and the size of a panel in words.
pub(super) fn setup(panel: &Panel, options: &Figure) -> String {
    let [full, quick] = panel.scene;
    let (scene, values) = if options.quick { (quick, panel.axis.quick) } else { (full, panel.axis.values) };
    let side = match panel.side {
        Side::Swept => "{x}".to_owned(),
        Side::Fixed(_) => side(panel.side, 0, options).to_string(),
    };
    let values: Vec<String> = values.iter().map(u32::to_string).collect();
    let symbol = panel.axis.symbol;
    let text = format!("{}: {scene}, camera {}, {side} x {side} pixels, {symbol} = ", panel.name, panel.camera);
    format!("{}{}", text.replace("{x}", symbol), values.join(" "))
}

/// Returns the pixels along a side at a value.
fn side(side: Side, x: u32, options: &Figure) -> u32 {
    match side {
        Side::Swept => x,
        Side::Fixed(_) if options.quick => QUICK_SIDE,
        Side::Fixed(side) => options.size.unwrap_or(side),
    }
}

/// Returns the points of an earlier run with the same header, and prints how many there are.
fn resumed(sweep: &Sweep, run: &Run<'_>, path: &Path) -> Vec<Point> {
    let Ok(text) = std::fs::read_to_string(path) else { return Vec::new() };
    let (comments, rows) = csv::parse(&text);
    if comments != run.header {
        output::note(&format!("{} is of another run and is replaced", path.display()));
        return Vec::new();
    }
    let mut found = points(&rows);
    let expected = |point: &Point| {
        let panel = sweep.panels.iter().find(|panel| panel.name == point.panel);
        panel.is_some_and(|panel| values(panel.axis, run.options.quick).contains(&point.x))
    };
    found.retain(expected);
    output::note(&format!(
        "{} has {} points of an earlier run, which are not measured again",
        path.display(),
        found.len()
    ));
    found
}

/// Returns whether every series has its point.
fn is_complete(panel: &Panel, x: u32, found: &[Point]) -> bool {
    let has = |series: &Series| {
        found.iter().any(|point| {
            point.panel == panel.name
                && point.series == series.label
                && point.x == x
                && point.description == description(series, x)
        })
    };
    panel.series.iter().all(has)
}

/// Orders points as the row does.
fn sort(sweep: &Sweep, found: &mut [Point]) {
    let rank = |point: &Point| {
        let panel = sweep.panels.iter().position(|panel| panel.name == point.panel);
        let series =
            panel.and_then(|panel| sweep.panels.get(panel)?.series.iter().position(|s| s.label == point.series));
        (panel, point.x, series)
    };
    found.sort_by_key(rank);
}

fn write(sweep: &Sweep, run: &Run<'_>, path: &Path, found: &[Point]) -> Result<(), Failure> {
    let reference = |point: &Point| {
        let panel = sweep.panels.iter().find(|panel| panel.name == point.panel)?;
        let first = panel.series.first()?.label;
        let same = |other: &&Point| other.panel == point.panel && other.x == point.x && other.series == first;
        match &found.iter().find(same)?.outcome {
            Outcome::Measured(measured) => Some(measured),
            Outcome::Unavailable(_) => None,
        }
    };
    let lines: Vec<csv::Row> = found.iter().flat_map(|point| rows(point, reference(point))).collect();
    csv::write(path, &run.header, &COLUMNS, &lines)
}

/// Measures all series of a panel, at as many of the waiting values as are in memory together: those share the load of the machine.
fn group(panel: &Panel, waiting: &mut VecDeque<u32>, run: &mut Run<'_>) -> Result<Vec<Point>, Failure> {
    let whole = run.options.memory.whole();
    let mut prepared: Vec<(u32, Series, Result<Prepared, String>)> = Vec::new();
    let (mut bytes, values) = (0, waiting.len() * panel.series.len());
    // A value needs at most the rest of the budget.
    while bytes <= whole / 4
        && let Some(x) = waiting.pop_front()
    {
        let [full, quick] = panel.scene;
        let (scene, side) = (at(if run.options.quick { quick } else { full }, x), side(panel.side, x, run.options));
        let memory = run.options.memory.without(whole / 4, "other values")?.divided(panel.series.len() as u64);
        let view = run.view(scene, panel.camera, (side, side), memory)?;
        let scene = match view.scene_views(&[]) {
            Ok((scene, _)) => scene,
            Err(failure) => {
                let reason = unavailable(failure)?;
                prepared.extend(panel.series.iter().map(|series| (x, *series, Err(reason.clone()))));
                continue;
            }
        };
        for series in panel.series {
            let what = format!("{}, {} = {x}", series.label, panel.axis.symbol);
            run.show(0.5 * prepared.len() as f64 / values as f64, &what);
            let ready = Prepared::new(series, x, (&view, &scene), run)?;
            bytes += ready.as_ref().map_or(0, |ready| ready.result.stats.bytes + scene.scene.bytes());
            prepared.push((x, *series, ready));
        }
    }
    draw(&mut prepared, run)?;
    let point = |(x, series, prepared): (u32, Series, Result<Prepared, String>)| {
        let outcome = match prepared {
            Ok(ready) => Outcome::Measured(ready.measurement()),
            Err(reason) => Outcome::Unavailable(reason),
        };
        let (panel, series, description) = (panel.name.to_owned(), series.label.to_owned(), description(&series, x));
        Point { panel, series, x, description, outcome }
    };
    Ok(prepared.into_iter().map(point).collect())
}

/// Draws the frames of all series in turns.
fn draw(prepared: &mut [(u32, Series, Result<Prepared, String>)], run: &Run<'_>) -> Result<(), Failure> {
    let (frames, count) = (WARM_UP + run.options.repeats(), prepared.len());
    for frame in 0..frames {
        for (number, (_, _, prepared)) in prepared.iter_mut().enumerate() {
            let part = f64::from(frame) + number as f64 / count as f64;
            run.show(0.5 + 0.5 * part / f64::from(frames), &format!("frame {} of {frames}", frame + 1));
            if let Ok(ready) = prepared
                && let Err(reason) = ready.draw(frame >= WARM_UP)
            {
                *prepared = Err(unavailable(reason)?);
            }
        }
    }
    Ok(())
}

/// A series that is ready to be drawn repeatedly, and its times so far.
struct Prepared {
    frame: PreparedFrame,
    result: RenderResult,
    times: Vec<FrameTime>,
}

impl Prepared {
    /// Draws the series until its capacity is known, and prepares its frame without counters. The inner `Err` is the reason why the
    /// device cannot run it.
    fn new(
        series: &Series,
        x: u32,
        (view, scene): (&View, &SceneView),
        run: &mut Run<'_>,
    ) -> Result<Result<Self, String>, Failure> {
        let registry = Registry::builtin();
        let set = changes(series, x);
        let mut input = Input::read(series.technique, &registry)?;
        let variant = match input.variant(&set, &registry) {
            Ok(variant) => variant,
            Err(failure) => return unavailable(failure).map(Err),
        };
        if let Some(missing) = run.selection.missing(&variant, &registry) {
            return Ok(Err(missing));
        }
        let request = RenderRequest { set: &set, ..RenderRequest::new(series.technique) };
        match prepare(&request, &mut input, (view, &mut run.selection), scene, &run.silent) {
            Ok((mut result, frame)) => {
                result.stats.pixels = Vec::new();
                Ok(Ok(Prepared { frame, result, times: Vec::new() }))
            }
            Err(failure) => unavailable(failure).map(Err),
        }
    }

    /// Draws a frame, and keeps its time if it counts.
    fn draw(&mut self, counts: bool) -> Result<(), Failure> {
        let time = self.frame.draw()?;
        self.times.extend(Some(time).filter(|_| counts));
        Ok(())
    }

    /// Returns the times by pass.
    fn measurement(self) -> Measurement {
        let is_timed = |time: &FrameTime| !time.passes.is_empty() && time.passes.iter().all(|pass| pass.untimed == 0);
        let passes = match self.times.first() {
            Some(first) if self.times.iter().all(is_timed) => {
                let of = |(number, pass): (usize, &PassTime)| {
                    let times = self.times.iter().filter_map(|time| time.passes.get(number));
                    (pass.pass.clone(), times.map(|pass| rounded(pass.milliseconds)).collect())
                };
                first.passes.iter().enumerate().map(of).collect()
            }
            _ => vec![(HOST_CLOCK.to_owned(), self.times.iter().map(|time| rounded(time.host)).collect())],
        };
        Measurement {
            passes,
            bytes: self.result.stats.bytes,
            slices: self.result.stats.slices,
            lost: self.result.stats.counters.as_ref().map(|counters| counters.lost()),
            target: self.result.target.to_owned(),
        }
    }
}

/// Rounds milliseconds to what the CSV file has, so that a resumed run computes the same statistics.
fn rounded(milliseconds: f64) -> f64 {
    (1.0e4 * milliseconds).round() / 1.0e4
}
