//! Compares generated GLSL with other projects' own shaders: one context of OpenGL, one scene, frames in turns.
//!
//! Input: a row, the checkout of a project, and the descriptions of its techniques (`backends/run/opengl/peers`). Output: a CSV file with one
//! line per technique and scene, and an SVG of the ratios. A technique whose files the checkout lacks has a line with the reason.

use std::collections::BTreeMap;
use std::path::Path;
use std::time::Duration;

use fragbuf::{Form, Generation, Registry, Request, generate, manifest};
use fragbuf_opengl_host::{
    Comparison, Context, Description, Error, Host, Object, PROJECTS, Peer, Scene, WARM_UP, compare,
};

use super::Figure;
use super::csv::{self, Row};
use super::experiment::{Experiment, PeerScene, Peers};
use super::run::QUICK_SIDE;
use super::spread::{Spread, ratios, spread};
use super::svg::{Anchor, Svg};
use crate::cli::attributes::geometry;
use crate::cli::camera::CameraRequest;
use crate::cli::device::DeviceRequest;
use crate::cli::input::Input;
use crate::cli::output::Failure;
use crate::cli::progress::Progress;
use crate::cli::targets;
use crate::cli::view::View;

const COLUMNS: [&str; 18] = [
    "scene",
    "project",
    "technique",
    "description",
    "ours_ms",
    "ours_q1",
    "ours_q3",
    "theirs_ms",
    "theirs_q1",
    "theirs_q3",
    "ratio",
    "ratio_q1",
    "ratio_q3",
    "difference",
    "our_passes",
    "their_passes",
    "changes",
    "unavailable",
];

/// The fragments per pixel that the descriptions of peers have memory for.
const CAPACITY: u64 = 64;

/// One technique on one scene.
struct Point {
    scene: &'static str,
    project: &'static str,
    technique: String,
    description: String,
    /// What was changed in the project's source.
    changes: String,
    /// `Err`: the reason why nothing was measured.
    outcome: Result<Comparison, String>,
}

/// Runs an experiment and returns its sentence.
pub(super) fn run(peers: &Peers, options: &Figure, experiment: &Experiment) -> Result<String, Failure> {
    let Some(folder) = options.peer.as_deref() else {
        let sources: Vec<&str> = PROJECTS.iter().map(|project| project.source).collect();
        let help = format!("give its folder, `--peer DIR`, for example a checkout of {}", sources.join(" or "));
        return Err(Failure::Usage(format!(
            "`figure {}` runs the shaders of another project: {help}",
            experiment.name
        )));
    };
    let device_name = Context::surfaceless().map_err(device)?.name.clone();
    if !folder.is_dir() {
        return Err(Failure::Files(format!("{} is not a folder: give a checkout to `--peer`", folder.display())));
    }
    let side = options.size.unwrap_or(if options.quick { QUICK_SIDE } else { peers.side });
    let progress = Progress::new();
    let (mut points, count) =
        (Vec::new(), peers.scenes.len() * PROJECTS.iter().map(|one| one.descriptions.len()).sum::<usize>());
    for scene in peers.scenes {
        for project in &PROJECTS {
            for text in project.descriptions {
                let description = Description::parse(text).map_err(device)?;
                let share = points.len() as f64 / count as f64;
                progress.set_fraction(
                    || format!("{}: {} on {}", experiment.name, description.technique, scene.name),
                    share,
                );
                // The memory of a context ends with it.
                let context = Context::surfaceless().map_err(device)?;
                let outcome = measure(&context, &description, (scene, side), (folder, options))?;
                let changes = description.set.iter().map(|(name, value)| format!(" {name}={value}"));
                points.push(Point {
                    scene: scene.name,
                    project: project.name,
                    description: std::iter::once(description.technique.clone()).chain(changes).collect(),
                    technique: description.technique,
                    changes: description.note,
                    outcome,
                });
            }
        }
    }
    let build = if cfg!(debug_assertions) { "debug" } else { "release" };
    let mut header = vec![
        format!("fragbuf {}, figure {}", env!("CARGO_PKG_VERSION"), experiment.name),
        format!("{}: {}", experiment.paper, experiment.title),
        format!("device: {} (OpenGL); {build} build; {side} x {side} pixels", device_name),
        format!("each point: {WARM_UP} warm-up frames, {} measured frames of each side in turns", options.repeats()),
    ];
    header.extend(PROJECTS.iter().map(|project| format!("{}: {}, {}", project.name, project.paper, project.source)));
    let file = |extension: &str| options.out.join(format!("{}.{extension}", experiment.name));
    csv::write(&file("csv"), &header, &COLUMNS, &points.iter().map(row).collect::<Vec<_>>())?;
    csv::write_text(&file("svg"), &drawing(experiment, &device_name, &points))?;
    Ok(sentence(experiment, &device_name, &points))
}

fn device(error: Error) -> Failure {
    Failure::Device(error.0)
}

/// The bytes of a fragment on both sides together, at most: words of an entry, a link, and texels of two images.
const FRAGMENT_BYTES: u64 = 32;

/// Measures one technique. The inner `Err` is the reason why the driver or the checkout does not allow it.
fn measure(
    context: &Context,
    description: &Description,
    (scene, side): (&PeerScene, u32),
    (folder, options): (&Path, &Figure),
) -> Result<Result<Comparison, String>, Failure> {
    let registry = Registry::builtin();
    let mut input = Input::read(&description.technique, &registry)?;
    let changes: Vec<(String, String)> = description.set.clone().into_iter().collect();
    let variant = input.variant(&changes, &registry)?;
    let request = Request { targets: &[targets::named("glsl")?], form: Form::Program, prefix: "", group: 0 };
    let generation = generate(&variant, &request, &registry).map_err(|errors| input.failure(errors))?;
    let Some(planned) = generation.plans.first() else { return Ok(Err("OpenGL cannot express it".to_owned())) };
    let camera: CameraRequest = scene.camera.parse().map_err(Failure::Usage)?;
    let name = scene.scene[usize::from(options.quick)].to_owned();
    let view = View::measured(name, camera, (side, side), (DeviceRequest::Cpu, None), options.memory);
    let (viewed, _) = view.scene_views(&[])?;
    let fragments = u64::from(side) * u64::from(side) * CAPACITY;
    let memory = view.memory_beside(&[&viewed])?.without(fragments * FRAGMENT_BYTES, "the memory of both sides")?;
    let geometry = geometry((&viewed.scene, &[]), &planned.plan, memory)?;
    let stride = geometry.vertices.len() / viewed.scene.vertices().max(1);
    let words =
        geometry.indices.iter().filter_map(|index| geometry.vertices.get(*index as usize * stride..)?.get(..stride));
    let vertices: Vec<u8> = words.flatten().flat_map(|word| word.to_le_bytes()).collect();
    let objects = [Object { first: 0, count: geometry.indices.len() as u32, bounds: [[-1.0; 3], [1.0; 3]] }];
    let view_projection = viewed.camera.view_projection;
    let scene = Scene { vertices: &vertices, objects: &objects, view_projection };
    Ok(run_both(context, &generation, description, (folder, side), (&scene, options.repeats()))
        .map_err(|error| error.0))
}

fn run_both(
    context: &Context,
    generation: &Generation,
    description: &Description,
    (folder, side): (&Path, u32),
    (scene, repeats): (&Scene<'_>, u32),
) -> Result<Comparison, Error> {
    let files: BTreeMap<&str, &[u8]> =
        generation.files.iter().map(|file| (file.path.as_str(), file.bytes.as_slice())).collect();
    let ours = |path: &str| {
        let bytes = files.get(path).ok_or_else(|| Error(format!("no generated file {path}")))?;
        String::from_utf8(bytes.to_vec()).map_err(|error| Error(format!("{path}: {error}")))
    };
    let theirs = |path: &str| {
        let path = folder.join(&description.root).join(path);
        std::fs::read_to_string(&path).map_err(|error| Error(format!("{}: {error}", path.display())))
    };
    let mut peer = Peer::new(context, description, &theirs, [side, side])?;
    let mut host = Host::new(context, &manifest(generation, 0).to_string(), &ours, [side, side])?;
    host.set_symbol("fragments", u64::from(side) * u64::from(side) * CAPACITY)?;
    // Both sides read a position and a colour per vertex.
    compare(context, (&mut host, scene), (&mut peer, scene), repeats)
}

/// Returns times in milliseconds.
fn milliseconds(times: &[Duration]) -> Vec<f64> {
    times.iter().map(|time| 1.0e3 * time.as_secs_f64()).collect()
}

/// Returns the ratio of our time to theirs.
fn ratio(point: &Point) -> Option<Spread> {
    let measured = point.outcome.as_ref().ok()?;
    spread(&ratios(&milliseconds(&measured.ours), &milliseconds(&measured.theirs)))
}

fn row(point: &Point) -> Row {
    let start = [point.scene, point.project, &point.technique, &point.description].map(str::to_owned);
    let cells: Vec<String> = match &point.outcome {
        Err(_) => vec![String::new(); 12],
        Ok(measured) => {
            let numbers = |found: Option<Spread>| match found {
                Some(Spread { median, quartiles: [q1, q3] }) => [median, q1, q3].map(|value| format!("{value:.3}")),
                None => Default::default(),
            };
            let passes = |passes: &[(String, Duration)]| {
                let pass = |(name, time): &(String, Duration)| format!("{name} {:.3}", 1.0e3 * time.as_secs_f64());
                passes.iter().map(pass).collect::<Vec<_>>().join("; ")
            };
            let [ours, theirs] = [&measured.ours, &measured.theirs].map(|times| numbers(spread(&milliseconds(times))));
            let last =
                [format!("{:.5}", measured.difference), passes(&measured.our_passes), passes(&measured.their_passes)];
            ours.into_iter().chain(theirs).chain(numbers(ratio(point))).chain(last).collect()
        }
    };
    let reason = point.outcome.as_ref().err().cloned().unwrap_or_default();
    start.into_iter().chain(cells).chain([point.changes.clone(), reason]).collect()
}

/// Returns the sentence: the median of the ratios, and the techniques that are slower than the peer's.
fn sentence(experiment: &Experiment, device: &str, points: &[Point]) -> String {
    let measured: Vec<(&Point, Spread)> = points.iter().filter_map(|point| Some((point, ratio(point)?))).collect();
    let medians: Vec<f64> = measured.iter().map(|(_, ratio)| ratio.median).collect();
    let Some(median) = spread(&medians) else {
        let reason = points.iter().find_map(|point| point.outcome.as_ref().err()).map_or("", String::as_str);
        return format!("{}, on {device}: nothing is measured ({reason}).", experiment.paper);
    };
    // A ratio whose quartiles enclose 1 decides nothing.
    let slower = measured.iter().filter(|(_, ratio)| ratio.quartiles[0] > 1.0);
    let slower: Vec<String> =
        slower.map(|(point, ratio)| format!("{} on {} ({:.2})", point.technique, point.scene, ratio.median)).collect();
    let slower =
        if slower.is_empty() { "none is slower".to_owned() } else { format!("slower are {}", slower.join(", ")) };
    let difference =
        points.iter().filter_map(|point| point.outcome.as_ref().ok()).map(|one| one.difference).fold(0.0, f32::max);
    format!(
        "{}, on {device}: our frames take {:.2} of the time of the project's own shaders (median of {} of {} points, from {:.2} to {:.2}); \
         {slower}; the images differ by at most {difference:.5}.",
        experiment.paper,
        median.median,
        measured.len(),
        points.len(),
        medians.iter().copied().fold(f64::INFINITY, f64::min),
        medians.iter().copied().fold(0.0, f64::max),
    )
}

const LINE: u32 = 22;
const TOP: u32 = 66;
/// Where bars begin, and the pixels of the ratio 1.
const LEFT: u32 = 190;
const UNIT: u32 = 220;

/// Returns the ratios as bars.
fn drawing(experiment: &Experiment, device: &str, points: &[Point]) -> String {
    let mut svg = Svg::new(LEFT + 2 * UNIT + 90, TOP + LINE * points.len() as u32 + 30);
    svg.text([16, 24], (17, "#000000", Anchor::Start), &format!("{}: {}", experiment.paper, experiment.title));
    svg.text(
        [16, 44],
        (12, "#5f5f5f", Anchor::Start),
        &format!("{device}; less than 1: ours is faster; bars end at 2"),
    );
    for (line, point) in (0..).zip(points) {
        let y = TOP + LINE * line;
        let name = format!("{}, {}", point.technique, point.scene);
        svg.text([16, y + 14], (12, "#000000", Anchor::Start), &name);
        let Some(ratio) = ratio(point) else {
            svg.text([LEFT, y + 14], (12, "#5f5f5f", Anchor::Start), "not measured");
            continue;
        };
        let width = (f64::from(UNIT) * ratio.median.min(2.0)) as u32;
        svg.rectangle([LEFT, y + 2, width, LINE - 6], if ratio.median <= 1.0 { "#0072b2" } else { "#d55e00" });
        svg.text([LEFT + 2 * UNIT + 12, y + 14], (12, "#000000", Anchor::Start), &format!("{:.2}", ratio.median));
    }
    svg.rectangle([LEFT + UNIT, TOP - 4, 1, LINE * points.len() as u32 + 4], "#000000");
    svg.text([LEFT + UNIT, TOP + LINE * points.len() as u32 + 16], (12, "#5f5f5f", Anchor::Middle), "1");
    svg.finish()
}
