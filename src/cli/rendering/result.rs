//! The result of a rendering: the image, the statistics of its frame, and warnings about what the image lacks.

use fragbuf::Plan;
use fragbuf::vocabulary::Capability;
use fragbuf_frame::{Counters, LaggedValues, LoopEnd, LoopReport, OUT_OF_ORDER, PARTIAL_COVERAGE, PassTime, Value};
use fragbuf_model::counted;
use fragbuf_scene::Scene;

use crate::cli::output::warn;

/// The option of an axis that sets how many layers a resolve pass holds. Layers beyond it are counted as `layers_exceeded`.
const LAYERS: &str = "layers";

/// An image, its statistics, and the device and plan that produced it.
pub(crate) struct RenderResult {
    pub(crate) stats: FrameStats,
    /// The image of the opaque scene, if there is one.
    pub(super) opaque: Option<Vec<[f32; 4]>>,
    pub(crate) device: String,
    pub(crate) backend: String,
    /// The target whose shaders the device ran.
    pub(crate) target: &'static str,
    pub(crate) plan: Plan,
    /// Frames drawn until every fragment fitted.
    pub(crate) frames: u32,
}

/// The pixels and statistics of one frame.
pub(crate) struct FrameStats {
    /// Premultiplied linear colours.
    pub(crate) pixels: Vec<[f32; 4]>,
    pub(crate) counters: Option<Counters>,
    pub(crate) times: Option<Vec<PassTime>>,
    /// Bytes allocated at one time.
    pub(crate) bytes: u64,
    pub(crate) slices: u32,
    /// Loops that end when a condition is met.
    pub(crate) loops: Vec<LoopReport>,
    /// The fragments that a pixel of the last slice keeps at most; `None`: all.
    pub(crate) k: Option<u32>,
    /// Whether an earlier frame decided k.
    pub(crate) is_lagged: bool,
    /// The decisions for the next frame.
    pub(crate) lagged: Option<LaggedValues>,
    /// The words that the request reads.
    pub(crate) words: Vec<Vec<u32>>,
}

impl FrameStats {
    /// Returns one message per loop that reached its limit.
    fn unfinished_loops(&self) -> impl Iterator<Item = String> {
        let unfinished = self.loops.iter().filter(|report| report.end == LoopEnd::LimitReached);
        unfinished.map(|LoopReport { until, iterations, .. }| {
            let limit = counted(*iterations, "iteration");
            format!("the loop until {until} stopped at its limit of {limit}: the image is incomplete")
        })
    }
}

impl RenderResult {
    /// Returns the option that makes the resolve pass hold more layers, with twice the present value. `None` if all layers
    /// fitted or the option is at its maximum.
    pub(super) fn more_layers(&self) -> Option<(String, u32)> {
        self.stats.counters.as_ref().filter(|counters| counters.get("layers_exceeded") > 0)?;
        self.plan.selection.rows.iter().find_map(|selected| {
            let parameter = selected.row.parameters.iter().find(|parameter| parameter.name == LAYERS)?;
            let (_, now) = self.plan.constants.iter().find(|(name, _)| *name == parameter.constant)?;
            let more = (2 * now).min(parameter.range.1);
            (more > *now).then(|| (format!("{}.{LAYERS}", selected.row.axis), more))
        })
    }

    /// Returns whether every event was counted, and not losses alone.
    pub(crate) fn counts_everything(&self) -> bool {
        self.plan.selection.provides().contains(&Capability::CountsEvents)
    }

    /// Prints a warning for everything that the image lacks. `uniforms` are those that the command line sets.
    pub(super) fn warn(&self, description: &str, uniforms: &[(String, Value)], scene: &Scene) {
        let warn = |text: &str| warn(&format!("{description}: {text}"));
        if self.stats.pixels.iter().all(|[_, _, _, alpha]| *alpha == 0.0) {
            let mut colors = scene.objects.iter().flat_map(|object| &object.colors);
            warn(&match colors.all(|[_, _, _, alpha]| *alpha == 0.0) {
                true => "the image is empty, because all colours of the scene have the alpha 0".to_owned(),
                false => format!("the image is empty: {}", self.reasons_of_empty(uniforms)),
            });
        }
        if self.opaque.is_some() && !self.plan.resources.iter().any(|planned| planned.is_opaque_depth()) {
            warn("it does not read the opaque depth buffer, so fragments behind opaque surfaces are visible");
        }
        self.stats.unfinished_loops().for_each(|text| warn(&text));
        for counter in self.stats.counters.iter().flat_map(|counters| &counters.0).filter(|counter| counter.count > 0) {
            if counter.is_loss() {
                warn(&format!("{} lost: {}", counted(counter.count, "fragment"), counter.name));
            }
            if counter.name == OUT_OF_ORDER {
                warn(&format!(
                    "{} arrived after farther ones had been composited; draw from front to back, or keep more",
                    counted(counter.count, "fragment")
                ));
            }
            if counter.name == PARTIAL_COVERAGE {
                warn(&format!(
                    "{} cover only a part of the pixel: at edges of triangles, pixels may show other fragments than the first",
                    counted(counter.count, "fragment")
                ));
            }
        }
    }
}

impl RenderResult {
    /// Returns what to check if the image is empty: the camera, and what the description has of constraints and uniforms that are 0.
    fn reasons_of_empty(&self, uniforms: &[(String, Value)]) -> String {
        let variant = &self.plan.variant;
        let is_set = |name: &str| uniforms.iter().any(|(other, value)| other == name && !value.is_zero());
        let zero: Vec<String> = variant
            .uniforms
            .iter()
            .filter(|uniform| !is_set(&uniform.name.value))
            .map(|uniform| format!("`{}`", uniform.name.value))
            .collect();
        let constraints = if variant.constraints.is_empty() { "" } else { " and the `where` constraints" };
        let uniforms = match zero.as_slice() {
            [] => String::new(),
            [one] => format!("; the uniform {one} is 0 unless `--uniform` sets it"),
            several => format!("; the uniforms {} are 0 unless `--uniform` sets them", several.join(", ")),
        };
        format!("check the camera{constraints}{uniforms}")
    }
}

/// Returns how many layers a resolve pass holds, if the description or `--set` chooses it.
pub(super) fn fixed_layers(variant: &fragbuf::Variant) -> Option<u32> {
    let selected = variant.choices.iter().flat_map(|chosen| &chosen.alternatives);
    let mut options = selected.flat_map(|selected| &selected.options);
    options.find(|(name, _)| name == LAYERS).map(|(_, layers)| *layers)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn warns_when_a_loop_reaches_its_limit() {
        let report = |end| LoopReport { until: "`left` is zero".to_owned(), iterations: 7, end };
        let loops = vec![report(LoopEnd::ConditionMet), report(LoopEnd::LimitReached)];
        let stats = FrameStats {
            pixels: Vec::new(),
            counters: None,
            times: None,
            bytes: 0,
            slices: 1,
            loops,
            k: None,
            is_lagged: false,
            lagged: None,
            words: Vec::new(),
        };
        let messages: Vec<String> = stats.unfinished_loops().collect();
        assert!(
            messages.len() == 1 && messages[0].contains("until `left` is zero stopped at its limit of 7"),
            "{messages:?}"
        );
    }
}
