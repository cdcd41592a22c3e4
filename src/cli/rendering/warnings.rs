//! Warnings about what a rendered image lacks, each with what to change.
//!
//! Input: the result of a rendering. Output: lines on stderr. A line that advises to raise an option names it as `--set` takes it.

use fragbuf::Plan;
use fragbuf::vocabulary::Parameter;
use fragbuf_codegen::LoopUntil;
use fragbuf_frame::{Counter, Counters, LoopEnd, LoopReport, OUT_OF_ORDER, PARTIAL_COVERAGE, Value};
use fragbuf_model::counted;
use fragbuf_scene::Scene;
use fragbuf_templates::SHOWN_LAYER;

use super::result::{FrameStats, RenderResult};
use crate::cli::output::warn;

/// The counter of fragments that a loop left at its limit.
const NOT_CONVERGED: &str = "not_converged";

/// The counter of fragments that gave up after too many attempts.
const TIMED_OUT: &str = "timed_out";

impl RenderResult {
    /// Prints a warning for everything that the image lacks. `uniforms` are those that the command line sets.
    pub(super) fn warn(&self, description: &str, uniforms: &[(String, Value)], scene: &Scene) {
        let warn = |text: &str| warn(&format!("{description}: {text}"));
        if self.stats.pixels.iter().all(|[_, _, _, alpha]| *alpha == 0.0) {
            warn(&format!("the image is empty{}", self.reason_of_empty(uniforms, scene)));
        }
        if self.opaque.is_some() && !self.plan.resources.iter().any(|planned| planned.is_opaque_depth()) {
            warn("it does not read the opaque depth buffer, so fragments behind opaque surfaces are visible");
        }
        let iterations = advice(&self.plan, |parameter| limits_iterations(&self.plan, parameter));
        let mut unfinished = unfinished_loops(&self.stats, &iterations).peekable();
        let has_unfinished = unfinished.peek().is_some();
        unfinished.for_each(|text| warn(&text));
        let attempts = advice(&self.plan, |parameter| parameter.is_retry_limit);
        for counter in self.counted_events().filter(|counter| counter.count > 0) {
            if counter.is_loss() {
                let advice = match counter.name {
                    // The line about the loop has the advice.
                    NOT_CONVERGED if !has_unfinished => &iterations,
                    TIMED_OUT => &attempts,
                    _ => "",
                };
                let (lost, name) = (counted(counter.count, "fragment"), counter.name);
                warn(&format!("{lost} lost: {name}{advice}; `fragbuf explain {name}` explains the counter"));
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

    fn counted_events(&self) -> impl Iterator<Item = &Counter> {
        self.stats.counters.iter().flat_map(|counters| &counters.0)
    }

    /// Returns why the image is empty, as far as the frame tells, or else what to check: the camera, and what the description has of constraints
    /// and uniforms that are 0.
    fn reason_of_empty(&self, uniforms: &[(String, Value)], scene: &Scene) -> String {
        let mut colors = scene.objects.iter().flat_map(|object| &object.colors);
        if colors.all(|[_, _, _, alpha]| *alpha == 0.0) {
            return ", because all colours of the scene have the alpha 0".to_owned();
        }
        let count = |name: &str| self.stats.counters.as_ref().map_or(0, |counters| counters.get(name));
        let lost = self.stats.counters.as_ref().map_or(0, Counters::lost);
        if lost > 0 || self.stats.loops.iter().any(|report| report.end == LoopEnd::LimitReached) {
            return ", because the frame is incomplete: the camera sees fragments, and the following warnings say why they are missing"
                .to_owned();
        }
        if let Some((_, number)) = self.plan.constants.iter().find(|(name, _)| *name == SHOWN_LAYER) {
            return format!(", because no pixel has the layer {number}: choose a lesser one, from 0");
        }
        // Unless every event is counted, these are 0.
        match (count("generated"), count("occluded")) {
            (0, 0) => format!(": {}", self.checks_of_empty(uniforms)),
            (0, hidden) => format!(", because the opaque scene hides all fragments, {hidden}: check the camera"),
            (generated, _) => format!(
                ", although {} met the constraints: the effect gives every pixel the alpha 0{}",
                counted(generated, "fragment"),
                self.zero_uniforms(uniforms)
            ),
        }
    }

    fn checks_of_empty(&self, uniforms: &[(String, Value)]) -> String {
        let constraints = if self.plan.variant.constraints.is_empty() { "" } else { " and the `where` constraints" };
        format!("check the camera{constraints}{}", self.zero_uniforms(uniforms))
    }

    /// Returns the clause about uniforms that are 0.
    fn zero_uniforms(&self, uniforms: &[(String, Value)]) -> String {
        let is_set = |name: &str| uniforms.iter().any(|(other, value)| other == name && !value.is_zero());
        let all = self.plan.variant.uniforms.iter().map(|uniform| &uniform.name.value);
        let zero: Vec<String> = all.filter(|name| !is_set(name)).map(|name| format!("`{name}`")).collect();
        match zero.as_slice() {
            [] => String::new(),
            [one] => format!("; the uniform {one} is 0 unless `--uniform` sets it"),
            several => format!("; the uniforms {} are 0 unless `--uniform` sets them", several.join(", ")),
        }
    }
}

/// Returns one message per loop that reached its limit.
fn unfinished_loops(stats: &FrameStats, advice: &str) -> impl Iterator<Item = String> {
    let unfinished = stats.loops.iter().filter(|report| report.end == LoopEnd::LimitReached);
    unfinished.map(move |LoopReport { until, iterations, .. }| {
        let limit = counted(*iterations, "iteration");
        format!("the loop until {until} stopped at its limit of {limit}: the image is incomplete{advice}")
    })
}

/// Whether a parameter limits the iterations of a loop that a condition ends.
fn limits_iterations(plan: &Plan, parameter: &Parameter) -> bool {
    let symbol = plan.symbols.find(&parameter.constant);
    let mut loops = plan.frame.loops.iter().filter(|looped| looped.until != LoopUntil::Times);
    symbol.is_some_and(|symbol| loops.any(|looped| looped.max_iterations.mentions(symbol)))
}

/// Returns the advice to raise the options of a plan that are `meant`; empty if there is none below its greatest value.
fn advice(plan: &Plan, meant: impl Fn(&Parameter) -> bool) -> String {
    let rows = plan.selection.rows.iter().map(|selected| &selected.row);
    let options = rows.flat_map(|row| row.parameters.iter().map(move |parameter| (&row.axis, parameter)));
    let raised = options.filter(|(_, parameter)| meant(parameter)).filter_map(|(axis, parameter)| {
        let (_, now) = plan.constants.iter().find(|(name, _)| *name == parameter.constant)?;
        let greatest = parameter.range.1;
        let more = now.saturating_mul(2).clamp(1, greatest);
        (more > *now).then(|| format!("`--set {axis}.{}={more}` (at most {greatest})", parameter.name))
    });
    let raised: Vec<String> = raised.collect();
    if raised.is_empty() { String::new() } else { format!("; raise the limit with {}", raised.join(" or ")) }
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
        let messages: Vec<String> = unfinished_loops(&stats, "; raise it").collect();
        assert!(
            messages.len() == 1
                && messages[0].ends_with("stopped at its limit of 7 iterations: the image is incomplete; raise it"),
            "{messages:?}"
        );
    }
}
