//! `fragbuf predict`: the k that a memory budget and a hit ratio give for a scene (K15 §4.2).
//!
//! Input: a description, a scene and a view. Output: k, the greatest k within the budget, bytes and hit ratio. A device counts the
//! fragments; bytes are those of the plan's formulas for buffers.

#[cfg(feature = "figures")]
mod plot;
mod predictor;

use std::path::{Path, PathBuf};

use fragbuf::Registry;
use fragbuf_templates::{Histogram, HitRatio, Prediction};
use serde_json::json;

pub(crate) use predictor::{Predictor, count};

use super::arrangement::{self, Arrangement, Disorder};
use super::assignment::{assignment, attribute, uniform};
use super::camera::CameraRequest;
use super::coplanarity::Coplanarity;
use super::device::DeviceRequest;
use super::input::Input;
use super::memory::{self, Budget};
use super::output::{self, Failure};
use super::picture;
use super::progress::Progress;
use super::view::{self, SceneView, View, picture_path, scenes};

#[derive(clap::Args)]
#[command(after_help = scenes())]
pub(crate) struct Predict {
    /// Technique key, .fragbuf file, or `-` for a description on stdin, with k slots per pixel or exact regions
    description: String,
    /// Change the description: axis=value or axis.option=value. k and `allocation` are those that this command chooses
    #[arg(long = "set", value_name = "NAME=VALUE", value_parser = assignment)]
    set: Vec<(String, String)>,
    /// Set a uniform of the description [default: 0]
    #[arg(long = "uniform", value_name = "NAME=VALUE[,VALUE]", value_parser = uniform)]
    uniforms: Vec<(String, String)>,
    /// Model file (.obj, .ply, .gltf, .glb, .vtk, .vtu, also .gz), or a generated scene: builtin:NAME[,parameter=value]
    #[arg(long, value_name = "PATH|builtin:NAME")]
    scene: String,
    /// Size of the image in pixels
    #[arg(long, value_name = "WxH", default_value = "512x512", value_parser = view::size)]
    size: (u32, u32),
    /// Camera, as for `render`
    #[arg(long, default_value = "auto", value_name = "auto|clip|orbit:AZIMUTH,ELEVATION|eye:X,Y,Z")]
    camera: CameraRequest,
    /// Set an attribute of fragments to a value for every vertex, as for `render`
    #[arg(long = "attribute", value_name = "NAME=VALUE[,VALUE]", value_parser = attribute)]
    attributes: Vec<(String, String)>,
    #[command(flatten)]
    arrangement: Arrangement,
    /// Memory for the buffers of the description: bytes, or a number of KiB, MiB, GiB or TiB
    #[arg(long, value_name = "SIZE", default_value = "200MiB", value_parser = memory::budget)]
    budget: Budget,
    /// Part of the fragments to keep, more than 0 and at most 1
    #[arg(long, value_name = "RATIO", default_value = "1", value_parser = hit_ratio)]
    hit_ratio: HitRatio,
    /// Device that counts the fragments, as for `render`
    #[arg(long, default_value = "auto", value_name = "auto|cpu|NAME")]
    device: DeviceRequest,
    /// Memory budget for the scene and for counting, as for `render`
    #[arg(long, value_name = "SIZE", default_value = "2GiB", value_parser = memory::budget)]
    memory: Budget,
    /// Read no files that a model names, as for `render`
    #[arg(long)]
    no_references: bool,
    /// SVG file to write the histogram to, with k marked
    #[cfg(feature = "figures")]
    #[arg(long, value_name = "SVG")]
    plot: Option<PathBuf>,
    /// Measure how many fragments of a pixel have equal depths, too (D13, Fig. 13). With a file, write its heat map in the paper's colours
    #[arg(long, value_name = "PNG", num_args = 0..=1, require_equals = true, value_parser = picture_path)]
    coplanarity: Option<Option<PathBuf>>,
    /// Print JSON on stdout
    #[arg(long)]
    json: bool,
}

impl Predict {
    pub(crate) fn run(&self) -> Result<(), Failure> {
        let registry = Registry::builtin();
        if let Some((name, _)) = self.set.iter().find(|(name, _)| is_chosen_here(name)) {
            return Err(Failure::Usage(format!(
                "`predict` chooses k itself, by `--budget` and `--hit-ratio`: leave out `--set {name}`"
            )));
        }
        let mut input = Input::read(&self.description, &registry)?;
        input.variant(&self.set, &registry)?;
        let measured = (self.device.clone(), None);
        let mut view = View::measured(self.scene.clone(), self.camera, self.size, measured, self.memory);
        view.attributes.clone_from(&self.attributes);
        view.arrangement = self.arrangement;
        view.no_references = self.no_references;
        let changed = (self.description.as_str(), self.set.as_slice());
        if let Some(Some(path)) = &self.coplanarity {
            check_map(path)?;
        }
        #[cfg(feature = "figures")]
        self.plot.as_deref().map_or(Ok(()), view::check_picture)?;
        let (histogram, scene) = count(changed, &view, &mut input, &registry, &self.uniforms)?;
        if !self.json {
            arrangement::print(&scene);
        }
        if histogram.fragments() == 0 {
            output::warn(
                "no fragment is in the image: check the camera, and the constraints with their uniforms (`--uniform`)",
            );
        }
        let predictor = Predictor::new(changed, self.size, &mut input, &registry)?;
        let prediction = predictor.predict(&histogram, self.budget.whole(), self.hit_ratio)?;
        let coplanarity = self.coplanarity.as_ref().map(|map| self.coplanarity(&view, &scene, map.as_deref()));
        let coplanarity = coplanarity.transpose()?;
        #[cfg(feature = "figures")]
        if let Some(path) = &self.plot {
            let svg = plot::svg(&self.title(), &histogram, &prediction)?;
            std::fs::write(path, svg).map_err(|error| Failure::Files(format!("{}: {error}", path.display())))?;
        }
        output::print(&match self.json {
            true => output::json(&self.statistics((&histogram, &scene), &prediction, coplanarity.as_ref())),
            false => {
                let equal = coplanarity.as_ref().map(equal_depths);
                format!("{}{}", self.sentence(&histogram, &prediction), equal.unwrap_or_default())
            }
        })
    }

    /// Measures the coplanarity of the scene, and writes its heat map.
    fn coplanarity(&self, view: &View, scene: &SceneView, map: Option<&Path>) -> Result<Coplanarity, Failure> {
        let progress = Progress::new();
        let found = Coplanarity::measure(view, scene, &progress)?;
        map.map_or(Ok(()), |path| picture::write(path, self.size, &mut found.heat(), false))?;
        Ok(found)
    }

    fn title(&self) -> String {
        format!("{} in {}, {} x {} pixels", self.description, self.scene, self.size.0, self.size.1)
    }

    fn sentence(&self, histogram: &Histogram, prediction: &Prediction) -> String {
        let Prediction { k, k_budget, goal_met, kept, bytes } = *prediction;
        let goal = if goal_met { "the goal is met" } else { "the goal is missed" };
        format!(
            "{}: k = {k} keeps {kept} of {} fragments ({:.4}) in {bytes} bytes; {goal}; the budget allows k = {k_budget}\n",
            self.title(),
            histogram.fragments(),
            hits(histogram, kept),
        )
    }

    fn statistics(
        &self,
        (histogram, scene): (&Histogram, &SceneView),
        prediction: &Prediction,
        coplanarity: Option<&Coplanarity>,
    ) -> serde_json::Value {
        let Prediction { k, k_budget, goal_met, kept, bytes } = *prediction;
        json!({
            "description": self.description,
            "scene": self.scene,
            "width": self.size.0,
            "height": self.size.1,
            "budget": self.budget.whole(),
            "k": k,
            "k_budget": k_budget,
            "goal_met": goal_met,
            "bytes": bytes,
            "hit_ratio": hits(histogram, kept),
            "fragments": histogram.fragments(),
            "kept": kept,
            "histogram": histogram.bins(),
            "disorder": scene.disorder.map(Disorder::json),
            "coplanarity": coplanarity.map(Coplanarity::probability),
            "coplanar_histogram": coplanarity.map(Coplanarity::histogram),
        })
    }
}

/// Whether a change is one that this command makes itself.
fn is_chosen_here(name: &str) -> bool {
    name == "k" || name.split('.').next() == Some("allocation")
}

/// Checks the path of a heat map, before anything is counted.
fn check_map(path: &Path) -> Result<(), Failure> {
    match picture::is_stdout(path) {
        true => Err(Failure::Usage("`predict` prints on stdout: give a file to `--coplanarity=`".to_owned())),
        false => view::check_picture(path),
    }
}

/// Returns the line about fragments of equal depths.
fn equal_depths(found: &Coplanarity) -> String {
    format!(
        "coplanarity: C_p = {:.4}, {} of {} covered pixels have fragments of equal depths\n",
        found.probability(),
        found.coplanar(),
        found.covered()
    )
}

/// Returns the kept part of the fragments; 1 without fragments.
pub(crate) fn hits(histogram: &Histogram, kept: u64) -> f64 {
    match histogram.fragments() {
        0 => 1.0,
        fragments => kept as f64 / fragments as f64,
    }
}

/// Parses a decimal number exactly: `0.95` is 95 / 100.
fn hit_ratio(text: &str) -> Result<HitRatio, String> {
    const EXPECTED: &str = "write a number above 0 and at most 1 with up to nine decimals, such as 0.95";
    let (whole, decimals) = text.trim().split_once('.').unwrap_or((text.trim(), ""));
    let is_number = |digits: &str| digits.len() <= 9 && digits.bytes().all(|digit| digit.is_ascii_digit());
    if !is_number(whole) || !is_number(decimals) || whole.len() + decimals.len() == 0 {
        return Err(EXPECTED.to_owned());
    }
    let denominator = 10_u64.pow(decimals.len() as u32);
    let value = |digits: &str| digits.parse::<u64>().unwrap_or(0);
    let numerator = value(whole) * denominator + value(decimals);
    match (1..=denominator).contains(&numerator) {
        true => Ok(HitRatio(numerator, denominator)),
        false => Err(EXPECTED.to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ratios_are_exact() {
        assert_eq!(hit_ratio("0.95"), Ok(HitRatio(95, 100)));
        assert_eq!(
            (hit_ratio("1"), hit_ratio("1.0"), hit_ratio(".5")),
            (Ok(HitRatio(1, 1)), Ok(HitRatio(10, 10)), Ok(HitRatio(5, 10)))
        );
        for text in ["0", "0.0", "1.01", "-0.5", "95%", "", ".", "nan", "0.1234567891", "1e-1"] {
            assert!(hit_ratio(text).is_err(), "{text}");
        }
    }
}
