//! Counts the fragments of a scene on a device, and predicts k from the plan of a description.

use fragbuf::vocabulary::{Row, Technique};
use fragbuf::{Draft, Form, Plan, Registry, Request, SourceSpan, TARGETS, Variant, check, generate};
use fragbuf_codegen::SymbolId;
use fragbuf_frame::{Values, buffer_bytes};
use fragbuf_model::MAX_K;
use fragbuf_templates::{BudgetTooSmall, Histogram, HitRatio, Prediction};

use crate::cli::attributes::{check_sources, model_attributes};
use crate::cli::input::Input;
use crate::cli::output::Failure;
use crate::cli::progress::Progress;
use crate::cli::rendering::{RenderRequest, render_quietly, select};
use crate::cli::uniforms;
use crate::cli::view::{SceneView, View};

/// A description and its changes.
type Changed<'a> = (&'a str, &'a [(String, String)]);

/// Predicts k for one description and size.
pub(crate) struct Predictor {
    plan: Plan,
    size: (u32, u32),
}

impl Predictor {
    /// Plans the description for the greatest k that it can have.
    pub(crate) fn new(
        (description, set): Changed<'_>,
        size: (u32, u32),
        input: &mut Input,
        registry: &Registry,
    ) -> Result<Self, Failure> {
        let mut k = MAX_K;
        let variant = loop {
            match input.variant(&with_k(set, k), registry) {
                Ok(variant) => break variant,
                // Some storages take only small k.
                Err(_) if k > 1 => k /= 2,
                Err(failure) => return Err(failure),
            }
        };
        let targets: Vec<_> = TARGETS.iter().collect();
        let request = Request { targets: &targets, form: Form::Program, prefix: "", group: 0 };
        let generation = generate(&variant, &request, registry).map_err(|errors| input.failure(errors))?;
        let plan = generation.plans.into_iter().next().map(|planned| planned.plan);
        let plan = plan.ok_or_else(|| Failure::Input(format!("{description}: no target can express it")))?;
        Ok(Predictor { plan, size })
    }

    /// Predicts k within a budget of bytes.
    pub(crate) fn predict(&self, histogram: &Histogram, budget: u64, ratio: HitRatio) -> Result<Prediction, Failure> {
        let values = Values::new(&self.plan, self.size).with(SymbolId::FRAGMENTS, histogram.fragments());
        let bytes = |k: u32, kept: u64| {
            let values = values.with(SymbolId::K, k.into()).with(SymbolId::KEPT, kept);
            buffer_bytes(&self.plan, &values)
        };
        // The sizes of resources that follow neither k nor the kept fragments must have a value.
        bytes(1, 0).map_err(|error| Failure::Input(error.to_string()))?;
        let bytes = |k: u32, kept: u64| bytes(k, kept).unwrap_or(u64::MAX);
        let prediction = histogram.predict(ratio, budget, self.plan.capacity(), &bytes);
        prediction.map_err(|BudgetTooSmall { needed, budget }| {
            Failure::Device(format!(
                "one fragment per pixel needs {needed} bytes, and `--budget` is {budget} bytes: raise it, or use a smaller image"
            ))
        })
    }
}

/// Counts the fragments of the scene of a view: a frame that keeps one fragment per pixel. Returns the scene, too.
pub(crate) fn count(
    (description, set): Changed<'_>,
    view: &View,
    input: &mut Input,
    registry: &Registry,
    uniforms: &[(String, String)],
) -> Result<(Histogram, SceneView), Failure> {
    let (set, variant) = with_histogram((description, set), input, registry)?;
    let progress = Progress::new();
    progress.set_message(format!("loading {}", view.scene));
    uniforms::check(uniforms, &variant)?;
    uniforms::warn_unset(description, uniforms, &variant);
    let (scene, _) = view.scene_views(&model_attributes(&[&variant], &view.attributes)?)?;
    check_sources(&[&variant], &scene.scene, &view.attributes)?;
    let words = &["histogram"];
    let request = RenderRequest { set: &set, uniforms, words, ..RenderRequest::new(description) };
    let mut selection = select(view, &scene, &mut [(&request, input)])?;
    let result = render_quietly(&request, input, (view, &mut selection), &scene, &progress)?;
    if result.stats.slices > 1 {
        return Err(Failure::Device(format!(
            "counting needs {} slices within `--memory`, and only one can be counted: raise `--memory`, or use a smaller image",
            result.stats.slices
        )));
    }
    Ok((Histogram::of_words(result.stats.words.first().map_or(&[], Vec::as_slice)), scene))
}

fn with_k(set: &[(String, String)], k: u32) -> Vec<(String, String)> {
    [set, &[("k".to_owned(), k.to_string())]].concat()
}

/// Chooses k = 1, and the first row of `allocation` with a budget that the description can have.
fn with_histogram(
    (description, set): Changed<'_>,
    input: &mut Input,
    registry: &Registry,
) -> Result<(Vec<(String, String)>, Variant), Failure> {
    const BUDGET: &str = "budget";
    let has_budget = |row: &&Row| row.parameters.iter().any(|parameter| parameter.name == BUDGET);
    let rows = || registry.rows_of("allocation").filter(has_budget);
    for row in rows() {
        let added = [("allocation", row.key.as_str()), ("allocation.budget", GREATEST_BUDGET)];
        let added = added.map(|(name, value)| (name.to_owned(), value.to_owned()));
        let set = [with_k(set, 1).as_slice(), &added].concat();
        if let Ok(variant) = input.variant(&set, registry) {
            return Ok((set, variant));
        }
    }
    // A failure of the description itself has its own message.
    let variant = input.variant(set, registry)?;
    let span = SourceSpan::new(description, 1, 1);
    let is_predictable = |technique: &&Technique| {
        rows().any(|row| {
            let mut draft = Draft::from_technique(&technique.key, &span);
            let is_set = [("k", "1"), ("allocation", row.key.as_str())]
                .iter()
                .all(|(name, value)| draft.set(name, value, &span).is_ok());
            is_set && check(&draft, registry).is_ok()
        })
    };
    let techniques: Vec<&str> =
        registry.techniques().iter().filter(is_predictable).map(|technique| technique.key.as_str()).collect();
    Err(Failure::Input(format!(
        "{description}: {}. `predict` takes storages that keep min(f, k) of the f fragments of a pixel, in k slots per pixel or in exact regions: {}",
        reason(&variant),
        techniques.join(", ")
    )))
}

/// Returns why no k of a description follows from the numbers of fragments.
fn reason(variant: &Variant) -> String {
    if variant.keep.is_none() {
        return "it keeps every fragment, so it has no k".to_owned();
    }
    let storage =
        variant.choices.iter().filter(|chosen| chosen.axis == "storage").flat_map(|chosen| &chosen.alternatives);
    let keys: Vec<String> = storage.map(|selected| format!("`storage: {}`", selected.row.key)).collect();
    format!("what {} keeps and its memory do not follow from k and the numbers of fragments alone", keys.join(" or "))
}

/// The greatest budget of a description, in MiB: the frame that counts keeps one fragment per pixel anyway.
const GREATEST_BUDGET: &str = "1048576";
