//! Measures what a table of a paper states by formulas: draws of the scene and the hit ratio R_h, on scenes of known
//! depths.
//!
//! Input: the table and scenes. Output: a value per technique, scene and property, beside that of the paper's formula.
//! On the CPU device, so that a run gives the same values again.

use fragbuf::Registry;
use fragbuf::vocabulary::Formula;
use fragbuf_cpu::FragmentOrder;
use fragbuf_frame::LoopEnd;
use fragbuf_templates::{PaperRow, PaperTable, Property};

use super::Figure;
use super::coplanar::kept;
use super::experiment::{Experiment, MeasuredScenes};
use super::run::Run;
use crate::cli::coplanarity::Coplanarity;
use crate::cli::input::Input;
use crate::cli::output::Failure;
use crate::cli::paper_table::passes;
use crate::cli::rendering::{RenderRequest, render_quietly};
use crate::cli::statistics::FragmentCounts;
use crate::cli::view::{SceneView, View};

/// A value that was measured.
pub(super) struct Measured {
    pub(super) key: &'static str,
    pub(super) name: &'static str,
    pub(super) property: MeasuredProperty,
    /// The fragments of each depth in the scene.
    pub(super) coplanar: u32,
    /// That of the paper's formula.
    pub(super) paper: Option<String>,
    pub(super) found: String,
    /// `None`: the paper has no formula that could be evaluated.
    pub(super) agrees: Option<bool>,
    pub(super) reason: Option<&'static str>,
}

/// What is measured.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum MeasuredProperty {
    /// The iterations of the outermost loop. The paper has none of its own: they follow from its draws.
    Iterations,
    Draws,
    HitRatio,
}

impl MeasuredProperty {
    pub(super) const ALL: [MeasuredProperty; 3] =
        [MeasuredProperty::Iterations, MeasuredProperty::Draws, MeasuredProperty::HitRatio];

    pub(super) fn heading(self) -> &'static str {
        match self {
            MeasuredProperty::Iterations => "iterations",
            MeasuredProperty::Draws => "draws",
            MeasuredProperty::HitRatio => "R_h",
        }
    }
}

/// Measures every row of a table on every scene. Returns the values and the name of the device.
pub(super) fn measure(
    scenes: &MeasuredScenes,
    table: &'static PaperTable,
    (options, experiment): (&Figure, &Experiment),
) -> Result<(Vec<Measured>, String), Failure> {
    let side = options.size.unwrap_or(scenes.side);
    let mut run = Run::new(options, experiment, Some(FragmentOrder::default()), &[])?;
    let mut all = Vec::new();
    for (number, coplanar) in scenes.coplanar.iter().enumerate() {
        let scene = format!("builtin:layers,n={},coplanar={coplanar}", scenes.depths);
        run.show(number as f64 / scenes.coplanar.len() as f64, &scene);
        let view = run.view(scene, scenes.camera, (side, side), options.memory)?;
        let (scene_view, _) = view.scene_views(&[])?;
        let fragments = Coplanarity::measure_on((&view, &mut run.selection), &scene_view, &run.silent)?.fragments;
        for row in table.rows {
            let frame = frame(row.key, fragments, (&view, &scene_view), &mut run)?;
            all.extend(frame.compared(row, table, (scenes.depths, *coplanar)));
        }
    }
    Ok((all, run.selection.name()))
}

/// What a frame of a technique tells.
struct Frame {
    /// The iterations of the loop that a condition ends.
    iterations: Option<u32>,
    draws: u64,
    hit_ratio: f64,
    k: Option<u32>,
}

/// Draws a scene with so many fragments.
fn frame(
    technique: &str,
    fragments: u64,
    (view, scene): (&View, &SceneView),
    run: &mut Run<'_>,
) -> Result<Frame, Failure> {
    let mut input = Input::read(technique, &Registry::builtin())?;
    let request = RenderRequest { count_all: true, ..RenderRequest::new(technique) };
    let result = render_quietly(&request, &mut input, (view, &mut run.selection), scene, &run.silent)?;
    let hit_ratio = match FragmentCounts::of(&result) {
        Some(counts) => counts.hit_ratio,
        None => kept(technique, (view, scene), run)? as f64 / fragments.max(1) as f64,
    };
    let reports = &result.stats.loops;
    if let Some(report) = reports.iter().find(|report| report.end == LoopEnd::LimitReached) {
        return Err(Failure::Device(format!(
            "{technique}: the loop until {} stopped at its limit of {} iterations: measure scenes of fewer depths",
            report.until, report.iterations
        )));
    }
    let iterations = reports.first().map(|report| report.iterations);
    let (outside, inside) = passes(&result.plan);
    let draws = outside + inside * u64::from(iterations.unwrap_or(0));
    Ok(Frame { iterations, draws, hit_ratio, k: result.stats.k })
}

impl Frame {
    /// Returns the values beside those of the paper, for so many depths of so many fragments.
    fn compared(
        &self,
        row: &'static PaperRow,
        table: &'static PaperTable,
        (depths, coplanar): (u32, u32),
    ) -> Vec<Measured> {
        let symbol = |name: &str| match name {
            "D" => Some(u64::from(depths)),
            "c" => Some(u64::from(coplanar)),
            "f" => Some(u64::from(depths) * u64::from(coplanar)),
            "k" => self.k.map(u64::from),
            _ => None,
        };
        let range = |property: Property| {
            let mut cells = table.columns.iter().zip(row.cells);
            let (_, cell) = cells.find(|(column, _)| column.property == property)?;
            range(cell, &symbol)
        };
        let reason = |property: Property| row.reasons.iter().find(|(of, _)| *of == property).map(|(_, reason)| *reason);
        let of = |property, paper: Option<[f64; 2]>, found: f64, of: Property| {
            let agrees = paper.map(|[least, most]| (least - 1e-6..=most + 1e-6).contains(&found));
            let paper = paper.map(|[least, most]| match least == most {
                true => number(least),
                false => format!("{} to {}", number(least), number(most)),
            });
            let reason = reason(of).filter(|_| agrees == Some(false));
            Measured { key: row.key, name: row.name, property, coplanar, paper, found: number(found), agrees, reason }
        };
        let iterations = self.iterations.map(|iterations| {
            of(MeasuredProperty::Iterations, None, f64::from(iterations), Property::PassesPerIteration)
        });
        let others = [
            of(
                MeasuredProperty::Draws,
                range(Property::TotalPasses).map(|range| range.map(f64::ceil)),
                self.draws as f64,
                Property::TotalPasses,
            ),
            of(
                MeasuredProperty::HitRatio,
                // Slots for more fragments than there are keep no more.
                range(Property::HitRatio).map(|range| range.map(|ratio| ratio.min(1.0))),
                self.hit_ratio,
                Property::HitRatio,
            ),
        ];
        iterations.into_iter().chain(others).collect()
    }
}

/// Returns a number with up to four decimals.
fn number(value: f64) -> String {
    format!("{value:.4}").trim_end_matches('0').trim_end_matches('.').to_owned()
}

/// Returns the least and the greatest value of `formula`, `formula to formula`, where a formula may be a quotient of
/// two. `None`: it has a symbol without a value, or is none.
fn range(text: &str, symbol: &dyn Fn(&str) -> Option<u64>) -> Option<[f64; 2]> {
    let (least, most) = text.split_once(" to ").unwrap_or((text, text));
    let value = |text: &str| Formula::from(text.to_owned()).evaluate(symbol).ok().map(|value| value as f64);
    let quotient = |text: &str| match text.split_once(" / ") {
        Some((numerator, denominator)) => Some(value(numerator)? / value(denominator)?.max(1.0)),
        None => value(text),
    };
    let (least, most) = (quotient(least)?, quotient(most)?);
    Some([least.min(most), most])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn formulas_of_a_table_have_values() {
        let symbol = |name: &str| match name {
            "D" => Some(9),
            "f" => Some(18),
            "k" => Some(32),
            _ => None,
        };
        assert_eq!(range("D / f", &symbol), Some([0.5; 2]));
        assert_eq!(range("ceil_div(D, 8) to ceil_div(D, 2)", &symbol), Some([2.0, 5.0]));
        assert_eq!(range("k / f to 1", &symbol), Some([1.0, 1.0]));
        assert_eq!(range("overflow to 1", &symbol), None);
        assert_eq!(range("1 to k; 1 to 2k", &symbol), None);
    }

    #[test]
    fn numbers_have_no_idle_decimals() {
        assert_eq!([10.0, 0.5, 1.0 / 9.0].map(number), ["10", "0.5", "0.1111"]);
    }
}
