//! Renders the variants of an experiment, and compares their images with that of the first.
//!
//! Input: a row. Output: a CSV file with the numbers of different pixels and lost fragments, and an SVG with the first image and a heat map
//! per variant, all on one scale. On the CPU device the order of fragments is that of the row, so that a run gives the same images again;
//! a GPU has its own.

use fragbuf::Registry;
use fragbuf_scene::DepthOrder;

use super::Figure;
use super::claim::{Finding, sentence};
use super::csv::{self, Row};
use super::experiment::{Expected, Experiment, ImageClaim, Images, Shown, Triangles, Variant};
use super::run::{QUICK_SIDE, Run, changes, description, unavailable};
use super::svg::{Anchor, Svg};
use crate::cli::compare::Difference;
use crate::cli::input::Input;
use crate::cli::output::Failure;
use crate::cli::picture;
use crate::cli::rendering::{RenderRequest, render_quietly};
use crate::cli::view::{SceneView, View};

const COLUMNS: [&str; 10] = [
    "variant",
    "description",
    "triangles",
    "different_pixels",
    "pixels",
    "max_error",
    "psnr_db",
    "generated",
    "lost",
    "unavailable",
];

/// The size of an image in the SVG, the space around it, and the strip at the top.
const PANEL: u32 = 220;
const GAP: u32 = 16;
const HEAD: u32 = 56;

/// The height of a panel with its two lines of text, and the panels in a line.
const LINE: u32 = PANEL + 52;
const COLUMNS_OF_PANELS: u32 = 4;

/// The image of a variant, and its difference from the reference.
struct Rendered {
    pixels: Vec<[f32; 4]>,
    difference: Difference,
    generated: Option<u32>,
    lost: Option<u64>,
}

/// Runs an experiment and returns its sentence.
pub(super) fn run(images: &Images, options: &Figure, experiment: &Experiment) -> Result<String, Failure> {
    let [full, quick] = images.scene;
    let (scene, side) = match options.quick {
        true => (quick, QUICK_SIDE),
        false => (full, options.size.unwrap_or(images.side)),
    };
    let details = [format!("{scene}, camera {}, {side} x {side} pixels, every event counted", images.camera)];
    let mut run = Run::new(options, experiment, Some(images.order), &details)?;
    let view = run.view(scene.to_owned(), images.camera, (side, side), options.memory)?;
    let (as_modelled, _) = view.scene_views(&[])?;
    let by_centroid = images.variants.iter().any(|variant| variant.triangles == Triangles::ByCentroid);
    let by_centroid = by_centroid.then(|| sorted(&view)).transpose()?;
    let mut rendered: Vec<(Variant, Result<Rendered, String>)> = Vec::new();
    for (number, variant) in images.variants.iter().enumerate() {
        run.show(number as f64 / images.variants.len() as f64, variant.series.label);
        let scene = match (variant.triangles, &by_centroid) {
            (Triangles::ByCentroid, Some(sorted)) => sorted,
            _ => &as_modelled,
        };
        let reference = match rendered.first() {
            Some((_, Ok(reference))) => Some(&reference.pixels[..]),
            _ => None,
        };
        let image = draw(variant, (&view, scene), reference, &mut run)?;
        rendered.push((*variant, image));
    }
    let rows: Vec<Row> = rendered.iter().map(|(variant, image)| row(variant, image)).collect();
    csv::write(&run.file("csv"), &run.header, &COLUMNS, &rows)?;
    let sheet = sheet((experiment, images), side, &rendered, &run.selection.name())?;
    csv::write_text(&run.file("svg"), &sheet)?;
    let findings: Vec<(&str, Finding)> =
        images.claims.iter().map(|claim| (claim.statement, finding(claim, &rendered))).collect();
    Ok(sentence(experiment.paper, &run.selection.name(), &findings))
}

/// Returns the scene with its triangles from front to back.
fn sorted(view: &View) -> Result<SceneView, Failure> {
    let (mut scene, _) = view.scene_views(&[])?;
    scene.scene.presort(&scene.camera, DepthOrder::NearestFirst);
    Ok(scene)
}

/// Renders a variant. The inner `Err` is the reason why the device cannot.
fn draw(
    variant: &Variant,
    (view, scene): (&View, &SceneView),
    reference: Option<&[[f32; 4]]>,
    run: &mut Run<'_>,
) -> Result<Result<Rendered, String>, Failure> {
    let registry = Registry::builtin();
    let set = changes(&variant.series, 0);
    let mut input = Input::read(variant.series.technique, &registry)?;
    let description = variant.series.technique;
    let request = RenderRequest { set: &set, count_all: true, ..RenderRequest::new(description) };
    let result = match render_quietly(&request, &mut input, (view, &mut run.selection), scene, &run.silent) {
        Ok(result) => result,
        Err(failure) => return unavailable(failure).map(Err),
    };
    let shown = result.stats.pixels.iter().map(|pixel| picture::displayed(*pixel, view.background, false));
    let pixels: Vec<[f32; 4]> = shown.collect();
    let compared = reference.unwrap_or(&pixels);
    let difference = Difference::of(compared.iter().copied().zip(pixels.iter().copied()));
    let counters = result.stats.counters.as_ref();
    let (generated, lost) = (counters.map(|all| all.get("generated")), counters.map(|all| all.lost()));
    Ok(Ok(Rendered { pixels, difference, generated, lost }))
}

fn row(variant: &Variant, image: &Result<Rendered, String>) -> Row {
    let triangles = match variant.triangles {
        Triangles::AsModelled => "as modelled",
        Triangles::ByCentroid => "by centroid",
    };
    let numbers = match image {
        Ok(Rendered { pixels, difference, generated, lost }) => [
            difference.count.to_string(),
            pixels.len().to_string(),
            format!("{:.4}", difference.greatest),
            difference.psnr().map_or("infinite".to_owned(), |psnr| format!("{psnr:.2}")),
            generated.map_or(String::new(), |count| count.to_string()),
            lost.map_or(String::new(), |count| count.to_string()),
            String::new(),
        ],
        Err(reason) => {
            let mut cells: [String; 7] = std::array::from_fn(|_| String::new());
            cells[6] = reason.clone();
            cells
        }
    };
    let start = [variant.series.label.to_owned(), description(&variant.series, 0), triangles.to_owned()];
    start.into_iter().chain(numbers).collect()
}

/// Returns the SVG: the reference, then a heat map or the image of each other variant.
fn sheet(
    (experiment, images): (&Experiment, &Images),
    side: u32,
    rendered: &[(Variant, Result<Rendered, String>)],
    device: &str,
) -> Result<String, Failure> {
    let others = || rendered.iter().skip(1);
    let differences = others().filter_map(|(_, image)| image.as_ref().ok());
    let greatest = differences.map(|image| image.difference.greatest).fold(0.0, f32::max);
    let count = rendered.len() as u32;
    let width = GAP + (PANEL + GAP) * count.clamp(2, COLUMNS_OF_PANELS);
    let mut svg = Svg::new(width, HEAD + LINE * count.div_ceil(COLUMNS_OF_PANELS));
    let title = format!("{}: {}", experiment.paper, experiment.title);
    svg.text([GAP, 26], (17, "#000000", Anchor::Start), &title);
    let third = greatest / 3.0;
    let scale = match images.shown {
        Shown::Differences => format!(
            "{device}; difference from the first image: black 0, red {third:.2}, yellow {:.2}, white {greatest:.2}",
            2.0 * third
        ),
        Shown::Images => device.to_owned(),
    };
    svg.text([GAP, 46], (12, "#5f5f5f", Anchor::Start), &scale);
    for (number, (variant, image)) in (0_u32..).zip(rendered) {
        let x = GAP + number % COLUMNS_OF_PANELS * (PANEL + GAP);
        let y = HEAD + number / COLUMNS_OF_PANELS * LINE;
        svg.text([x, y + 16], (13, "#000000", Anchor::Start), variant.series.label);
        match image {
            Ok(image) => {
                let is_map = number > 0 && images.shown == Shown::Differences;
                let png = match is_map {
                    false => picture::bytes((side, side), &mut image.pixels.iter().copied(), false)?,
                    true => picture::bytes((side, side), &mut image.difference.heat_up_to(greatest), true)?,
                };
                svg.image([x, y + 38, PANEL, PANEL], &png);
                let below = match (number, images.shown) {
                    (0, _) => "reference".to_owned(),
                    (_, Shown::Differences) => differing(image),
                    (_, Shown::Images) => description(&variant.series, 0),
                };
                svg.text([x, y + 32], (12, "#5f5f5f", Anchor::Start), &below);
            }
            Err(reason) => svg.text([x, y + 32], (12, "#5f5f5f", Anchor::Start), reason),
        }
    }
    Ok(svg.finish())
}

/// Returns the number of different pixels in words.
fn differing(image: &Rendered) -> String {
    let (count, all) = (image.difference.count, image.pixels.len());
    format!("{count} of {all} pixels {}", if count == 1 { "differs" } else { "differ" })
}

fn finding(claim: &ImageClaim, rendered: &[(Variant, Result<Rendered, String>)]) -> Finding {
    let image = |label: &str| match rendered.iter().find(|(variant, _)| variant.series.label == label) {
        Some((_, Ok(image))) => Ok(image),
        Some((_, Err(reason))) => Err(format!("{label}: {reason}")),
        None => Err(format!("no variant {label}")),
    };
    let found = image(claim.variant).and_then(|found| match claim.expected {
        Expected::Equal => Ok((found.difference.count == 0, differing(found))),
        Expected::Different => Ok((found.difference.count > 0, differing(found))),
        Expected::FewerThan(other) => {
            let other = image(other)?;
            let text = format!("{} instead of {} pixels differ", found.difference.count, other.difference.count);
            Ok((found.difference.count < other.difference.count, text))
        }
        Expected::Same(other) => {
            let other = image(other)?;
            let pairs = found.pixels.iter().copied().zip(other.pixels.iter().copied());
            let count = Difference::of(pairs).count;
            Ok((count == 0, format!("{count} of {} pixels differ", found.pixels.len())))
        }
    });
    match found {
        Ok((true, text)) => Finding::Agrees(text),
        Ok((false, text)) => Finding::Differs(text),
        Err(reason) => Finding::Missing(reason),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cli::figure::experiment::Series;

    /// Returns a variant whose image differs from the reference in so many of four pixels.
    fn rendered(label: &'static str, different: usize) -> (Variant, Result<Rendered, String>) {
        let series = Series { label, technique: "", set: &[] };
        let pixels: Vec<[f32; 4]> = (0..4).map(|pixel| [if pixel < different { 1.0 } else { 0.0 }; 4]).collect();
        let difference = Difference::of(pixels.iter().map(|pixel| (*pixel, [0.0; 4])));
        let image = Rendered { pixels, difference, generated: None, lost: None };
        (Variant { series, triangles: Triangles::AsModelled }, Ok(image))
    }

    #[test]
    fn statements_hold_or_not_by_the_number_of_pixels() {
        let all = [rendered("few", 1), rendered("many", 3), rendered("none", 0)];
        let check = |variant, expected| finding(&ImageClaim { statement: "", variant, expected }, &all);
        let agrees = |text: &str| Finding::Agrees(text.to_owned());
        let differs = |text: &str| Finding::Differs(text.to_owned());
        assert_eq!(check("few", Expected::Different), agrees("1 of 4 pixels differs"));
        assert_eq!(check("few", Expected::Equal), differs("1 of 4 pixels differs"));
        assert_eq!(check("none", Expected::Equal), agrees("0 of 4 pixels differ"));
        assert_eq!(check("none", Expected::Different), differs("0 of 4 pixels differ"));
        assert_eq!(check("few", Expected::FewerThan("many")), agrees("1 instead of 3 pixels differ"));
        assert_eq!(check("many", Expected::FewerThan("few")), differs("3 instead of 1 pixels differ"));
        assert_eq!(check("few", Expected::Same("few")), agrees("0 of 4 pixels differ"));
        assert_eq!(check("few", Expected::Same("many")), differs("2 of 4 pixels differ"));
        assert_eq!(check("few", Expected::FewerThan("other")), Finding::Missing("no variant other".to_owned()));
    }
}
