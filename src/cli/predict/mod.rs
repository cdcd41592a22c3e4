//! `fragbuf predict`: the k that a memory budget and a hit ratio give for a scene (K15 §4.2).
//!
//! Input: a description, a scene and a view. Output: k, the greatest k within the budget, bytes and hit ratio. A device counts the
//! fragments; bytes are those of the plan's formulas for buffers.

#[cfg(feature = "figures")]
mod plot;

use std::path::PathBuf;

use fragbuf::vocabulary::Row;
use fragbuf::{Form, Plan, Registry, Request, TARGETS, Variant, generate};
use fragbuf_codegen::SymbolId;
use fragbuf_frame::{Values, buffer_bytes};
use fragbuf_model::MAX_K;
use fragbuf_templates::{BudgetTooSmall, Histogram, HitRatio, Prediction};
use serde_json::json;

use super::assignment::assignment;
use super::attributes::{check_sources, model_attributes};
use super::camera::CameraRequest;
use super::device::DeviceRequest;
use super::input::Input;
use super::memory::{self, Budget};
use super::output::{self, Failure};
use super::progress::Progress;
use super::rendering::{RenderRequest, render, select};
use super::view::{self, View, scenes};

#[derive(clap::Args)]
#[command(after_help = scenes())]
pub(crate) struct Predict {
    /// Technique key or .fragbuf file, with k slots per pixel or with exact regions
    description: String,
    /// Change the description: axis=value or axis.option=value
    #[arg(long = "set", value_name = "NAME=VALUE", value_parser = assignment)]
    set: Vec<(String, String)>,
    /// Model file (.obj, .ply, .gltf, .glb, also .gz), or a generated scene: builtin:NAME[,parameter=value]
    #[arg(long, value_name = "PATH|builtin:NAME")]
    scene: String,
    /// Size of the image in pixels
    #[arg(long, value_name = "WxH", default_value = "512x512", value_parser = view::size)]
    size: (u32, u32),
    /// Camera, as for `render`
    #[arg(long, default_value = "auto", value_name = "auto|clip|orbit:AZIMUTH,ELEVATION|eye:X,Y,Z")]
    camera: CameraRequest,
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
    /// SVG file to write the histogram to, with k marked
    #[cfg(feature = "figures")]
    #[arg(long, value_name = "SVG")]
    plot: Option<PathBuf>,
    /// Print JSON on stdout
    #[arg(long)]
    json: bool,
}

impl Predict {
    pub(crate) fn run(&self) -> Result<(), Failure> {
        let registry = Registry::builtin();
        let mut input = Input::read(&self.description, &registry)?;
        let plan = self.plan(&mut input, &registry)?;
        let histogram = self.count(&mut input, &registry)?;
        let mut values = Values::new(&plan, self.size);
        let evaluate = |values: &Values| buffer_bytes(&plan, values);
        // The sizes of resources that follow neither k nor the kept fragments must have a value.
        values.set(SymbolId::K, 1);
        values.set(SymbolId::KEPT, 0);
        evaluate(&values).map_err(|error| Failure::Input(error.to_string()))?;
        let bytes = |k: u32, kept: u64| {
            let values = values.with(SymbolId::K, k.into()).with(SymbolId::KEPT, kept);
            evaluate(&values).unwrap_or(u64::MAX)
        };
        let budget = self.budget.whole();
        let prediction = histogram.predict(self.hit_ratio, budget, plan.capacity(), &bytes);
        let prediction = prediction.map_err(|BudgetTooSmall { needed, budget }| {
            Failure::Device(format!(
                "one fragment per pixel needs {needed} bytes, and `--budget` is {budget} bytes: raise it, or use a smaller image"
            ))
        })?;
        #[cfg(feature = "figures")]
        if let Some(path) = &self.plot {
            let svg = plot::svg(&self.title(), &histogram, &prediction)?;
            std::fs::write(path, svg).map_err(|error| Failure::Files(format!("{}: {error}", path.display())))?;
        }
        output::print(&match self.json {
            true => output::json(&self.statistics(&histogram, &prediction)),
            false => self.sentence(&histogram, &prediction),
        })
    }

    /// Returns the plan for the greatest k that the description can have.
    fn plan(&self, input: &mut Input, registry: &Registry) -> Result<Plan, Failure> {
        let mut k = MAX_K;
        loop {
            let set = [self.set.as_slice(), &[("k".to_owned(), k.to_string())]].concat();
            match input.variant(&set, registry) {
                Ok(variant) => {
                    let request = Request { targets: &[&TARGETS[1]], form: Form::Program, prefix: "", group: 0 };
                    let generation = generate(&variant, &request, registry).map_err(|errors| input.failure(errors))?;
                    let plan = generation.plans.into_iter().next().map(|planned| planned.plan);
                    return plan.ok_or_else(|| {
                        Failure::Input(format!("{}: no target of this device can express it", self.description))
                    });
                }
                // Some storages take only small k.
                Err(_) if k > 1 => k /= 2,
                Err(failure) => return Err(failure),
            }
        }
    }

    /// Counts the fragments of the scene: a frame that keeps one fragment per pixel.
    fn count(&self, input: &mut Input, registry: &Registry) -> Result<Histogram, Failure> {
        let one = [self.set.as_slice(), &[("k".to_owned(), "1".to_owned())]].concat();
        let (set, variant) = with_histogram(&one, input, registry)?;
        let measured = (self.device.clone(), None);
        let view = View::measured(self.scene.clone(), self.camera, self.size, measured, self.memory);
        let progress = Progress::new();
        progress.set_message(format!("loading {}", self.scene));
        let (scene, _) = view.scene_views(&model_attributes(&[&variant], &[])?)?;
        check_sources(&[&variant], &scene.scene, &[])?;
        let request = RenderRequest {
            description: &self.description,
            set: &set,
            uniforms: &[],
            count_all: false,
            opaque: None,
            held: 0,
            words: &["histogram"],
        };
        let mut selection = select(&view, &scene, &mut [(&request, input)])?;
        let result = render(&request, input, (&view, &mut selection), &scene, &progress)?;
        if result.stats.slices > 1 {
            return Err(Failure::Device(format!(
                "counting needs {} slices within `--memory`, and only one can be counted: raise `--memory`, or use a smaller image",
                result.stats.slices
            )));
        }
        Ok(Histogram::of_words(result.stats.words.first().map_or(&[], Vec::as_slice)))
    }

    fn title(&self) -> String {
        format!("{} in {}, {} x {} pixels", self.description, self.scene, self.size.0, self.size.1)
    }

    fn sentence(&self, histogram: &Histogram, prediction: &Prediction) -> String {
        let Prediction { k, k_budget, goal_met, kept, bytes } = *prediction;
        let goal = match goal_met {
            true => "the goal is met",
            false => "the goal is missed: the budget allows no greater k",
        };
        format!(
            "{}: k = {k} keeps {kept} of {} fragments ({:.4}) in {bytes} bytes; {goal}; the budget allows k = {k_budget}\n",
            self.title(),
            histogram.fragments(),
            hits(histogram, kept),
        )
    }

    fn statistics(&self, histogram: &Histogram, prediction: &Prediction) -> serde_json::Value {
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
        })
    }
}

/// Adds the first row of `allocation` with a budget that the description can have.
fn with_histogram(
    set: &[(String, String)],
    input: &mut Input,
    registry: &Registry,
) -> Result<(Vec<(String, String)>, Variant), Failure> {
    const BUDGET: &str = "budget";
    let has_budget = |row: &&Row| row.parameters.iter().any(|parameter| parameter.name == BUDGET);
    let mut refused = None;
    for row in registry.rows_of("allocation").filter(has_budget) {
        let added = [("allocation", row.key.as_str()), ("allocation.budget", GREATEST_BUDGET)];
        let added = added.map(|(name, value)| (name.to_owned(), value.to_owned()));
        let set = [set, &added].concat();
        match input.variant(&set, registry) {
            Ok(variant) => return Ok((set, variant)),
            Err(failure) => refused = refused.or(Some(failure)),
        }
    }
    Err(refused.unwrap_or_else(|| Failure::Input("no row of `allocation` has a budget".to_owned())))
}

/// The greatest budget of a description, in MiB: the frame that counts keeps one fragment per pixel anyway.
const GREATEST_BUDGET: &str = "1048576";

/// Returns the kept part of the fragments; 1 without fragments.
fn hits(histogram: &Histogram, kept: u64) -> f64 {
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
