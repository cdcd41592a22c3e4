//! Predicts k for views of a scene: histograms of depth complexity with the predicted k marked.
//!
//! Input: a row. Output: a CSV file with one line per view and goal, and an SVG with a histogram per view.

use fragbuf::Registry;
use fragbuf_templates::{Histogram, HitRatio, Prediction};
use plotters::prelude::*;

use super::Figure;
use super::claim::{Finding, sentence};
use super::csv::{self, Row};
use super::experiment::{Experiment, Goal, PredictionCheck, Predictions};
use super::histogram;
use super::run::{QUICK_SIDE, Run};
use super::style::{COLORS, MUTED, TITLE, failure, titled};
use crate::cli::input::Input;
use crate::cli::output::Failure;
use crate::cli::predict::{Predictor, count, hits};

const COLUMNS: [&str; 11] = [
    "view",
    "camera",
    "budget_bytes",
    "wanted",
    "k",
    "k_budget",
    "goal_met",
    "bytes",
    "hit_ratio",
    "fragments",
    "histogram",
];

/// The size of a histogram.
const CHART: (u32, u32) = (400, 300);

/// A view with its histogram, and the prediction for each goal.
struct Predicted {
    label: &'static str,
    camera: &'static str,
    histogram: Histogram,
    goals: Vec<(Goal, Prediction)>,
}

/// Runs an experiment and returns its sentence.
pub(super) fn run(row: &Predictions, options: &Figure, experiment: &Experiment) -> Result<String, Failure> {
    let [full, quick] = row.scene;
    let (scene, side) = match options.quick {
        true => (quick, QUICK_SIDE),
        false => (full, options.size.unwrap_or(row.side)),
    };
    let details = [format!("{scene}, {}, {side} x {side} pixels", row.technique)];
    let run = Run::new(options, experiment, None, &details)?;
    let registry = Registry::builtin();
    let mut input = Input::read(row.technique, &registry)?;
    let predictor = Predictor::new((row.technique, &[]), (side, side), &mut input, &registry)?;
    let mut views = Vec::new();
    for (number, (label, camera)) in row.views.iter().enumerate() {
        run.show(number as f64 / row.views.len() as f64, label);
        let view = run.view(scene.to_owned(), camera, (side, side), options.memory)?;
        let (histogram, _) = count((row.technique, &[]), &view, &mut input, &registry, &[])?;
        let predict = |goal: &Goal| {
            let budget = goal.bytes_per_pixel * u64::from(side) * u64::from(side);
            Ok((*goal, predictor.predict(&histogram, budget, HitRatio(goal.percent.into(), 100))?))
        };
        let goals = row.goals.iter().map(predict).collect::<Result<Vec<_>, Failure>>()?;
        views.push(Predicted { label, camera, histogram, goals });
    }
    let rows: Vec<Row> = views.iter().flat_map(|view| lines(view, side)).collect();
    csv::write(&run.file("csv"), &run.header, &COLUMNS, &rows)?;
    csv::write_text(&run.file("svg"), &svg(experiment, &run.selection.name(), &views)?)?;
    let findings: Vec<(&str, Finding)> =
        row.claims.iter().map(|claim| (claim.statement, finding(claim.check, &views))).collect();
    Ok(sentence(experiment.paper, &run.selection.name(), &findings))
}

/// Returns a line per goal.
fn lines(view: &Predicted, side: u32) -> impl Iterator<Item = Row> {
    let bins = view.histogram.bins();
    let deepest = bins.iter().rposition(|pixels| *pixels > 0).map_or(0, |bin| bin + 1);
    let bins = bins[..deepest].iter().map(u64::to_string).collect::<Vec<_>>().join(" ");
    view.goals.iter().map(move |(goal, Prediction { k, k_budget, goal_met, kept, bytes })| {
        vec![
            view.label.to_owned(),
            view.camera.to_owned(),
            (goal.bytes_per_pixel * u64::from(side) * u64::from(side)).to_string(),
            format!("{:.2}", f64::from(goal.percent) / 100.0),
            k.to_string(),
            k_budget.to_string(),
            if *goal_met { "yes" } else { "no" }.to_owned(),
            bytes.to_string(),
            format!("{:.4}", hits(&view.histogram, *kept)),
            view.histogram.fragments().to_string(),
            bins.clone(),
        ]
    })
}

fn finding(check: PredictionCheck, views: &[Predicted]) -> Finding {
    let all = || views.iter().flat_map(|view| &view.goals);
    let decided = |holds: bool, text: String| if holds { Finding::Agrees(text) } else { Finding::Differs(text) };
    match check {
        PredictionCheck::GrowsWithGoals => {
            let is_more = |(a, b): (&Goal, &Goal)| a.percent <= b.percent && a.bytes_per_pixel <= b.bytes_per_pixel;
            let mut pairs = views.iter().flat_map(|view| view.goals.iter().map(move |goal| (view, goal)));
            let holds = pairs.all(|(view, (goal, less))| {
                view.goals.iter().filter(|(other, _)| is_more((goal, other))).all(|(_, more)| less.k <= more.k)
            });
            let ks: Vec<String> = all()
                .map(|(goal, found)| {
                    format!("{} for {} % in {} bytes per pixel", found.k, goal.percent, goal.bytes_per_pixel)
                })
                .collect();
            decided(holds, format!("k = {}", ks.join(", ")))
        }
        PredictionCheck::Adapts => {
            let ks: Vec<u32> = all().map(|(_, found)| found.k).collect();
            let differs = ks.iter().any(|k| Some(k) != ks.first());
            decided(differs, format!("k = {}", ks.iter().map(u32::to_string).collect::<Vec<_>>().join(", ")))
        }
        PredictionCheck::KeepsWithinBudget => {
            let met = all().filter(|(_, found)| found.goal_met).count();
            let within = all().all(|(_, found)| found.k <= found.k_budget);
            let most = all().map(|(_, found)| found.k_budget).max().unwrap_or(0);
            decided(
                within && met == all().count(),
                format!("in {met} of {} views; the budget allows k = {most}", all().count()),
            )
        }
    }
}

fn svg(experiment: &Experiment, device: &str, views: &[Predicted]) -> Result<String, Failure> {
    let size = (CHART.0 * views.len().max(1) as u32, TITLE + CHART.1);
    let mut text = String::new();
    {
        let root = SVGBackend::with_string(&mut text, size).into_drawing_area();
        let title = format!("{}: {}", experiment.paper, experiment.title);
        let how = format!("{device}; pixels by their number of fragments, logarithmic; vertical lines: predicted k");
        let body = titled(&root, title, (how, MUTED))?;
        for (area, view) in body.split_evenly((1, views.len().max(1))).iter().zip(views) {
            let ks = view.goals.iter().map(|(_, found)| found.k).zip(COLORS.iter().skip(1).copied().cycle());
            histogram::draw(area, view.label, &view.histogram, &ks.collect::<Vec<_>>())?;
        }
        root.present().map_err(failure)?;
    }
    Ok(text)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn view(goals: &[(u64, u32, u32, bool)]) -> Predicted {
        let goals = goals.iter().map(|(bytes_per_pixel, percent, k, goal_met)| {
            let found = Prediction { k: *k, k_budget: 9, goal_met: *goal_met, kept: 0, bytes: 0 };
            (Goal { bytes_per_pixel: *bytes_per_pixel, percent: *percent }, found)
        });
        Predicted { label: "", camera: "", histogram: Histogram::of_pixels([1]), goals: goals.collect() }
    }

    #[test]
    fn findings_follow_from_the_predictions() {
        let agrees = |check, views: &[Predicted]| matches!(finding(check, views), Finding::Agrees(_));
        let grows = PredictionCheck::GrowsWithGoals;
        assert!(agrees(grows, &[view(&[(10, 50, 2, true), (10, 90, 4, true), (20, 90, 4, true)])]));
        assert!(!agrees(grows, &[view(&[(10, 50, 5, true), (10, 90, 4, true)])]));
        // Fewer bytes for a greater ratio decide nothing.
        assert!(agrees(grows, &[view(&[(20, 50, 5, true), (10, 90, 4, false)])]));
        let (a, b) = (view(&[(10, 50, 2, true)]), view(&[(10, 50, 3, true)]));
        assert!(
            agrees(PredictionCheck::Adapts, &[a, b]) && !agrees(PredictionCheck::Adapts, &[view(&[(10, 50, 2, true)])])
        );
        let within = PredictionCheck::KeepsWithinBudget;
        assert!(agrees(within, &[view(&[(10, 50, 9, true)])]) && !agrees(within, &[view(&[(10, 50, 9, false)])]));
    }
}
