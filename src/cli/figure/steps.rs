//! Shows how a buffer is built: what a row of pixels holds after each object of a scene.
//!
//! Input: a row. Output: a CSV file with one line per kept fragment and step, and an SVG with one line of pixels per step. The CPU device
//! renders the first object, the first two, and so on, and the storage's own functions read the pixels, so no layout is repeated here.

use std::sync::Arc;

use fragbuf::{Profile, Registry};
use fragbuf_checker::{FrameMemory, ReadOut};
use fragbuf_cpu::{Code, Device, Mesh, Settings};

use super::Figure;
use super::claim::{Finding, sentence};
use super::csv::{self, Row};
use super::experiment::{Experiment, Steps};
use super::run::{changes, description};
use super::svg::{Anchor, Svg};
use crate::cli::attributes::geometry;
use crate::cli::camera::CameraRequest;
use crate::cli::device::DeviceRequest;
use crate::cli::input::Input;
use crate::cli::output::Failure;
use crate::cli::view::View;

const COLUMNS: [&str; 6] = ["step", "object", "pixel", "slot", "depth", "is_new"];

/// The depths that a pixel holds, in the order of the storage.
type Pixel = Vec<f32>;

/// The state of the row of pixels after an object.
struct Step {
    object: String,
    pixels: Vec<Pixel>,
}

/// Runs an experiment and returns its sentence.
pub(super) fn run(steps: &Steps, options: &Figure, experiment: &Experiment) -> Result<String, Failure> {
    let camera: CameraRequest = steps.camera.parse().map_err(Failure::Usage)?;
    let size = (steps.side, steps.side);
    let device = (DeviceRequest::Cpu, None);
    let view = View::measured(steps.scene.to_owned(), camera, size, device, options.memory);
    let states = states(steps, &view)?;
    let header = [
        format!("fragbuf {}, figure {}", env!("CARGO_PKG_VERSION"), experiment.name),
        format!("{}: {}", experiment.paper, experiment.title),
        format!(
            "{}, {}, camera {}, row {} of {} x {} pixels, on the CPU device",
            description(&steps.series, steps.k),
            steps.scene,
            steps.camera,
            steps.row,
            steps.side,
            steps.side
        ),
    ];
    let file = |extension: &str| options.out.join(format!("{}.{extension}", experiment.name));
    csv::write(&file("csv"), &header, &COLUMNS, &rows(&states, steps.k))?;
    csv::write_text(&file("svg"), &drawing(experiment, steps, &states))?;
    Ok(sentence(experiment.paper, "the CPU device", &findings(&states, steps.k as usize)))
}

/// Renders every prefix of the scene, and reads the row of pixels.
fn states(steps: &Steps, view: &View) -> Result<Vec<Step>, Failure> {
    let registry = Registry::builtin();
    let mut input = Input::read(steps.series.technique, &registry)?;
    let variant = input.variant(&changes(&steps.series, steps.k), &registry)?;
    let code = Arc::new(Code::of(&variant, &registry)?);
    let read_out = ReadOut::new(&code.plan, Profile::Native, &registry).map_err(|errors| input.failure(errors))?;
    let (scene, _) = view.scene_views(&[])?;
    let geometry = geometry((&scene.scene, &[]), &code.plan, view.memory_beside(&[&scene])?)?;
    let mut states = vec![Step { object: "none".to_owned(), pixels: vec![Pixel::new(); steps.side as usize] }];
    for (object, range) in scene.scene.objects.iter().zip(&geometry.objects) {
        let indices = geometry.indices.get(..range.end as usize).unwrap_or(&geometry.indices);
        let mut device = Device::new(code.clone(), Settings::new(steps.side, steps.side))?;
        device.set_camera(&scene.camera.view_projection);
        device.render(&Mesh { vertices: &geometry.vertices, indices }, &|_| {})?;
        let size = [steps.side; 2];
        let mut frame = FrameMemory::new(&code.plan, size, |name| device.symbol(name), |name| device.words(name));
        let mut pixels = Vec::new();
        for x in 0..steps.side {
            let kept = read_out.pixel(&mut frame, [x, steps.row]);
            let kept = kept.map_err(|error| Failure::Device(format!("pixel {x}: {error}")))?;
            // The key of a depth is its bits.
            let depths = kept.iter().filter_map(|words| words.first().map(|key| f32::from_bits(*key)));
            pixels.push(depths.collect());
        }
        if states.last().is_none_or(|last| last.pixels != pixels) {
            states.push(Step { object: object.name.clone(), pixels });
        }
    }
    Ok(states)
}

/// Returns the first slot of a pixel: the last slots fill first.
fn first_slot(pixel: &Pixel, k: u32) -> u32 {
    k.saturating_sub(pixel.len() as u32)
}

/// Returns whether a pixel did not hold a depth before a step.
fn is_new(states: &[Step], step: usize, x: usize, depth: f32) -> bool {
    let before = step.checked_sub(1).and_then(|before| states.get(before)?.pixels.get(x));
    !before.is_some_and(|pixel| pixel.contains(&depth))
}

fn rows(states: &[Step], k: u32) -> Vec<Row> {
    let mut rows = Vec::new();
    for (number, step) in states.iter().enumerate() {
        for (x, pixel) in step.pixels.iter().enumerate() {
            for (slot, depth) in (first_slot(pixel, k)..).zip(pixel) {
                let is_new = if is_new(states, number, x, *depth) { "yes" } else { "no" };
                let start = [number.to_string(), step.object.clone(), x.to_string(), slot.to_string()];
                rows.push(start.into_iter().chain([format!("{depth:.6}"), is_new.to_owned()]).collect());
            }
        }
    }
    rows
}

/// Returns what the paper states about the figure.
fn findings(states: &[Step], k: usize) -> Vec<(&'static str, Finding)> {
    let Some(last) = states.last() else { return Vec::new() };
    let (slots, used) = (k * last.pixels.len(), last.pixels.iter().map(Vec::len).sum::<usize>());
    let wasted = format!("{} of {slots} slots of the row stay empty", slots.saturating_sub(used));
    let wasted = if used < slots { Finding::Agrees(wasted) } else { Finding::Differs(wasted) };
    let full = || states.iter().flat_map(|step| &step.pixels).filter(|pixel| pixel.len() == k);
    let holds = |pixel: &&Pixel| pixel.iter().all(|depth| pixel.first().is_some_and(|first| depth <= first));
    let (count, right) = (full().count(), full().filter(holds).count());
    let text = format!("in {right} of {count} states of full pixels");
    let worst = match (count, count == right) {
        (0, _) => Finding::Missing("no pixel is full".to_owned()),
        (_, true) => Finding::Agrees(text),
        (_, false) => Finding::Differs(text),
    };
    vec![
        ("memory is wasted at pixels of fewer than k fragments", wasted),
        ("the first slot of a full pixel holds its farthest fragment", worst),
    ]
}

/// The size of a slot, the space between pixels, and the strips at the left and at the top.
const SLOT: [u32; 2] = [26, 20];
const SPACE: u32 = 10;
const LEFT: u32 = 100;
const TOP: u32 = 84;

/// Returns the drawing: a line per step, a block per pixel, a cell per slot with its depth in hundredths.
fn drawing(experiment: &Experiment, steps: &Steps, states: &[Step]) -> String {
    let block = SLOT[0] * steps.k + SPACE;
    let (width, height) = (LEFT + block * steps.side + 16, TOP + (SLOT[1] + 6) * states.len() as u32 + 16);
    let mut svg = Svg::new(width, height);
    svg.text([16, 24], (17, "#000000", Anchor::Start), &format!("{}: {}", experiment.paper, experiment.title));
    let note = "a line per object, a block per pixel, a cell per slot; depth in hundredths, darker is farther; framed: new in this step; \
                grey: empty";
    svg.text([16, 44], (12, "#5f5f5f", Anchor::Start), note);
    for x in 0..steps.side {
        let middle = LEFT + block * x + (block - SPACE) / 2;
        svg.text([middle, TOP - 10], (11, "#5f5f5f", Anchor::Middle), &format!("pixel {x}"));
    }
    for (number, step) in states.iter().enumerate() {
        let y = TOP + (SLOT[1] + 6) * number as u32;
        svg.text([16, y + 14], (12, "#000000", Anchor::Start), &step.object);
        for (x, pixel) in step.pixels.iter().enumerate() {
            let left = LEFT + block * x as u32;
            svg.rectangle([left, y, SLOT[0] * steps.k - 2, SLOT[1]], "#e8e8e8");
            for (slot, depth) in (first_slot(pixel, steps.k)..).zip(pixel) {
                let at = left + SLOT[0] * slot;
                if is_new(states, number, x, *depth) {
                    svg.rectangle([at - 2, y - 2, SLOT[0] + 2, SLOT[1] + 4], "#d55e00");
                }
                let shade = 1.0 - depth.clamp(0.0, 1.0);
                let channel = |from: f32, to: f32| (from + (to - from) * shade).round() as u8;
                let color =
                    format!("#{:02x}{:02x}{:02x}", channel(30.0, 200.0), channel(80.0, 230.0), channel(140.0, 250.0));
                svg.rectangle([at, y, SLOT[0] - 2, SLOT[1]], &color);
                let ink = if shade < 0.5 { "#ffffff" } else { "#000000" };
                let hundredths = format!("{:.0}", 100.0 * depth);
                svg.text([at + SLOT[0] / 2 - 1, y + 14], (11, ink, Anchor::Middle), &hundredths);
            }
        }
    }
    svg.finish()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn findings_follow_from_the_states() {
        let step =
            |pixels: &[&[f32]]| Step { object: String::new(), pixels: pixels.iter().map(|p| p.to_vec()).collect() };
        let texts = |states: &[Step]| findings(states, 2).into_iter().map(|(_, finding)| finding).collect::<Vec<_>>();
        let agrees = |text: &str| Finding::Agrees(text.to_owned());
        let good = [step(&[&[], &[]]), step(&[&[0.7, 0.2], &[0.5]])];
        let expected = [agrees("1 of 4 slots of the row stay empty"), agrees("in 1 of 1 states of full pixels")];
        assert_eq!(texts(&good), expected);
        let bad = [step(&[&[0.2, 0.7], &[0.5, 0.1]])];
        let expected = ["0 of 4 slots of the row stay empty", "in 1 of 2 states of full pixels"];
        assert_eq!(texts(&bad), expected.map(|text| Finding::Differs(text.to_owned())));
        assert!(is_new(&good, 1, 0, 0.7) && !is_new(&[step(&[&[0.7]]), step(&[&[0.7]])], 1, 0, 0.7));
    }
}
