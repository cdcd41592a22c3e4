//! Draws the coplanarity of scenes: heat maps in the colours of D13, Fig. 13, with C_p, and the hit ratio of a technique.
//!
//! Input: a row. Output: a CSV file with a line per scene, and an SVG with a heat map per scene and the legend. On the CPU device, so that a run
//! gives the same images again.
//!
//! A technique whose depth test is fixed function counts no fragments. So its hit ratio follows from its image: every fragment has the
//! same alpha, and n blended fragments let (1 - alpha)^n of the light behind pass.

use fragbuf::Registry;
use fragbuf_cpu::FragmentOrder;

use super::Figure;
use super::claim::{Finding, sentence};
use super::csv::{self, Row};
use super::experiment::{CoplanarCheck, CoplanarScenes, Experiment};
use super::run::{QUICK_SIDE, Run};
use super::svg::{Anchor, Svg};
use crate::cli::coplanarity::{COLORS, Coplanarity};
use crate::cli::input::Input;
use crate::cli::output::Failure;
use crate::cli::picture;
use crate::cli::rendering::{RenderRequest, render_quietly};
use crate::cli::view::{SceneView, View};

const COLUMNS: [&str; 9] =
    ["scene", "generated", "pixels", "covered", "coplanar", "c_p", "fragments", "r_h", "pixels_by_coplanar_fragments"];

/// The alpha of every fragment, a multiple of 1/255, in which techniques store it. It keeps hundreds of fragments apart.
const ALPHA: f64 = 2.0 / 255.0;

/// A scene with its coplanarity, and the fragments that the technique has blended.
struct Measured {
    label: &'static str,
    scene: &'static str,
    coplanarity: Coplanarity,
    kept: u64,
}

impl Measured {
    fn hit_ratio(&self) -> f64 {
        self.kept as f64 / self.coplanarity.fragments.max(1) as f64
    }
}

/// Runs an experiment and returns its sentence.
pub(super) fn run(row: &CoplanarScenes, options: &Figure, experiment: &Experiment) -> Result<String, Failure> {
    let side = if options.quick { QUICK_SIDE } else { options.size.unwrap_or(row.side) };
    let details =
        [format!("{}, camera {}, {side} x {side} pixels, every fragment of alpha 2/255", row.technique, row.camera)];
    let mut run = Run::new(options, experiment, Some(FragmentOrder::default()), &details)?;
    let mut all = Vec::new();
    for (number, coplanar) in row.scenes.iter().enumerate() {
        run.show(number as f64 / row.scenes.len() as f64, coplanar.label);
        let [full, quick] = coplanar.scene;
        let scene = if options.quick { quick } else { full };
        let view = run.view(scene.to_owned(), row.camera, (side, side), options.memory)?;
        let (scene_view, _) = view.scene_views(&[])?;
        let coplanarity = Coplanarity::measure_on((&view, &mut run.selection), &scene_view, &run.silent)?;
        let kept = kept(row.technique, (&view, &scene_view), &mut run)?;
        all.push(Measured { label: coplanar.label, scene, coplanarity, kept });
    }
    let rows: Vec<Row> = all.iter().map(|found| line(found, side)).collect();
    csv::write(&run.file("csv"), &run.header, &COLUMNS, &rows)?;
    csv::write_text(&run.file("svg"), &sheet(experiment, side, &all, &run.selection.name())?)?;
    let findings: Vec<(&str, Finding)> =
        row.claims.iter().map(|claim| (claim.statement, finding(claim.check, &all))).collect();
    Ok(sentence(experiment.paper, &run.selection.name(), &findings))
}

/// Returns the fragments that a technique blends, for payloads with a `color`. All of them get [`ALPHA`].
pub(super) fn kept(technique: &str, (view, scene): (&View, &SceneView), run: &mut Run<'_>) -> Result<u64, Failure> {
    let mut view = view.clone();
    view.attributes = vec![("color".to_owned(), format!("1,1,1,{ALPHA}"))];
    let mut input = Input::read(technique, &Registry::builtin())?;
    let request = RenderRequest::new(technique);
    let result = render_quietly(&request, &mut input, (&view, &mut run.selection), scene, &run.silent)?;
    Ok(result.stats.pixels.iter().map(|[_, _, _, alpha]| blended(f64::from(*alpha))).sum())
}

/// Returns the number of fragments whose blending has an alpha.
fn blended(alpha: f64) -> u64 {
    ((1.0 - alpha).ln() / (1.0 - ALPHA).ln()).round() as u64
}

fn line(found: &Measured, side: u32) -> Row {
    let coplanarity = &found.coplanarity;
    let bins = coplanarity.histogram().iter().map(u64::to_string).collect::<Vec<_>>().join(" ");
    vec![
        found.label.to_owned(),
        found.scene.to_owned(),
        (u64::from(side) * u64::from(side)).to_string(),
        coplanarity.covered().to_string(),
        coplanarity.coplanar().to_string(),
        format!("{:.4}", coplanarity.probability()),
        coplanarity.fragments.to_string(),
        format!("{:.4}", found.hit_ratio()),
        bins,
    ]
}

fn finding(check: CoplanarCheck, all: &[Measured]) -> Finding {
    let decided = |holds: bool, text: String| if holds { Finding::Agrees(text) } else { Finding::Differs(text) };
    let named = |label: &str| all.iter().find(|found| found.label == label);
    match check {
        CoplanarCheck::KeepsOnePerDepth => {
            let right = all.iter().filter(|found| found.kept == found.coplanarity.depths()).count();
            decided(right == all.len(), format!("as many as depths in {right} of {} scenes", all.len()))
        }
        CoplanarCheck::FallsWithCoplanarity(labels) => {
            let mut found: Vec<(f64, f64)> = labels
                .iter()
                .filter_map(|label| named(label))
                .map(|found| (found.coplanarity.probability(), found.hit_ratio()))
                .collect();
            found.sort_by(|a, b| a.0.total_cmp(&b.0));
            if found.len() < 2 {
                return Finding::Missing("fewer than two scenes".to_owned());
            }
            let falls = found.windows(2).all(|pair| matches!(pair, [a, b] if a.0 < b.0 && a.1 > b.1));
            let texts: Vec<String> = found.iter().map(|(c_p, r_h)| format!("{r_h:.2} at {c_p:.2}")).collect();
            decided(falls, texts.join(", "))
        }
        CoplanarCheck::EveryPixelHas(label, count) => {
            let Some(found) = named(label) else { return Finding::Missing(format!("no scene {label}")) };
            let bins = found.coplanarity.histogram();
            let pixels = bins.get(count as usize).copied().unwrap_or(0);
            let covered = found.coplanarity.covered();
            decided(pixels == covered && covered > 0, format!("{pixels} of {covered} pixels"))
        }
    }
}

/// The size of an image in the SVG, the space around it, and the strip at the top.
const PANEL: u32 = 220;
const GAP: u32 = 16;
const HEAD: u32 = 56;

/// The height of a panel with its two lines of text, the panels in a line, and the height of the legend.
const LINE: u32 = PANEL + 52;
const COLUMNS_OF_PANELS: u32 = 3;
const LEGEND: u32 = 44;

/// Returns the SVG: a heat map per scene, and the legend.
fn sheet(experiment: &Experiment, side: u32, all: &[Measured], device: &str) -> Result<String, Failure> {
    let lines = (all.len() as u32).div_ceil(COLUMNS_OF_PANELS);
    let width = GAP + (PANEL + GAP) * COLUMNS_OF_PANELS;
    let mut svg = Svg::new(width, HEAD + LINE * lines + LEGEND);
    svg.text([GAP, 26], (17, "#000000", Anchor::Start), &format!("{}: {}", experiment.paper, experiment.title));
    let note =
        format!("{device}; a pixel by its number of fragments that have the depth of another one; white: no fragment");
    svg.text([GAP, 46], (12, "#5f5f5f", Anchor::Start), &note);
    for (number, found) in (0_u32..).zip(all) {
        let x = GAP + number % COLUMNS_OF_PANELS * (PANEL + GAP);
        let y = HEAD + number / COLUMNS_OF_PANELS * LINE;
        svg.text([x, y + 16], (13, "#000000", Anchor::Start), found.label);
        let numbers = format!("C_p = {:.3}, R_h = {:.3}", found.coplanarity.probability(), found.hit_ratio());
        svg.text([x, y + 32], (12, "#5f5f5f", Anchor::Start), &numbers);
        let png = picture::bytes((side, side), &mut found.coplanarity.heat(), false)?;
        svg.image([x, y + 38, PANEL, PANEL], &png);
    }
    legend(&mut svg, HEAD + LINE * lines + 8);
    Ok(svg.finish())
}

/// Draws the colours with their numbers of fragments.
fn legend(svg: &mut Svg, y: u32) {
    for (number, (least, _, [r, g, b])) in (0_u32..).zip(COLORS) {
        let x = GAP + 78 * number;
        svg.rectangle([x, y, 20, 20], &format!("#{r:02x}{g:02x}{b:02x}"));
        let is_last = number as usize == COLORS.len() - 1;
        let text = match least {
            0 => "none".to_owned(),
            _ if is_last => format!("{least} or more"),
            _ => least.to_string(),
        };
        svg.text([x + 26, y + 15], (12, "#000000", Anchor::Start), &text);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_alpha_of_an_image_tells_the_number_of_fragments() {
        for count in [0, 1, 2, 9, 40, 300] {
            let mut alpha = 0.0_f32;
            (0..count).for_each(|_| alpha += (1.0 - alpha) * ALPHA as f32);
            assert_eq!(blended(f64::from(alpha)), count);
        }
    }
}
