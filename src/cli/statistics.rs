//! The statistics of a frame as JSON, for `render --json` and `compare --json`.

use fragbuf::vocabulary::Capability;
use fragbuf_frame::{LoopEnd, LoopReport, PassTime};
use serde_json::{Map, Value, json};

use super::arrangement::Disorder;
use super::rendering::{DeviceSelection, RenderResult};
use super::view::SceneView;

/// Returns the statistics of one frame. Counts are null if the description does not count.
pub(crate) fn statistics(
    description: &str,
    result: &RenderResult,
    selection: &DeviceSelection,
    scene: &SceneView,
) -> Value {
    let stats = &result.stats;
    let times = stats.times.iter().flatten();
    let ms: Map<String, Value> = times.map(|time| (time.pass.clone(), milliseconds(time))).collect();
    let counts = FragmentCounts::of(result);
    json!({
        "description": description,
        "device": result.device,
        "device_reason": selection.reason,
        "backend": result.backend,
        "target": result.target,
        "triangles": scene.scene.triangles(),
        "disorder": scene.disorder.map(Disorder::json),
        "k": stats.k,
        "k_lagged": stats.is_lagged,
        "fragment": payload(result),
        "ms": if stats.times.is_some() { Value::from(ms) } else { Value::Null },
        "bytes": stats.bytes,
        "fragments": {
            "generated": counts.as_ref().map(|counts| counts.generated),
            "stored": counts.as_ref().map(|counts| counts.stored),
            "culled": counts.as_ref().map(|counts| counts.culled),
            "displaced": counts.as_ref().map(|counts| counts.displaced),
            "occluded": counts.as_ref().map(|counts| counts.occluded),
        },
        "lost": lost(result),
        "hit_ratio": counts.as_ref().map(|counts| counts.hit_ratio),
        "loops": stats.loops.iter().map(looped).collect::<Value>(),
        "frames": result.frames,
        "slices": stats.slices,
    })
}

/// Returns the milliseconds of a pass; null if the device could not time all of its runs.
fn milliseconds(time: &PassTime) -> Value {
    if time.untimed == 0 { time.milliseconds.into() } else { Value::Null }
}

/// Returns the attributes of a fragment, each with its format.
fn payload(result: &RenderResult) -> Value {
    let attributes = result.plan.variant.attributes.iter();
    attributes.map(|a| (a.name.value.clone(), Value::from(a.format.value.keyword()))).collect::<Map<_, _>>().into()
}

/// Returns the number of lost fragments, in total and by the counter of each kind of loss.
fn lost(result: &RenderResult) -> Value {
    let counters = result.stats.counters.as_ref();
    let losses = counters.iter().flat_map(|counters| counters.0.iter().filter(|counter| counter.is_loss()));
    let by_counter: Map<String, Value> =
        losses.map(|counter| (counter.name.to_owned(), counter.count.into())).collect();
    json!({ "total": counters.map(|counters| counters.lost()), "by_counter": by_counter })
}

/// Returns how a loop with a condition ended. A loop that ended at its `limit` left work undone.
fn looped(report: &LoopReport) -> Value {
    let end = match report.end {
        LoopEnd::ConditionMet => "condition",
        LoopEnd::LimitReached => "limit",
    };
    json!({ "until": report.until, "iterations": report.iterations, "end": end })
}

/// The fragments of a frame by what happened to them.
pub(crate) struct FragmentCounts {
    generated: u64,
    culled: u64,
    /// Fragments that better ones displaced.
    displaced: u64,
    /// Fragments behind opaque surfaces, which are not among the generated ones.
    occluded: u64,
    stored: u64,
    /// Stored fragments over generated ones.
    pub(crate) hit_ratio: f64,
}

impl FragmentCounts {
    /// Returns the fragments that are not kept although they met the constraints.
    pub(crate) fn rejected(&self) -> u64 {
        self.generated - self.stored
    }

    /// Returns `None` if some events were not counted: a fixed-function test counts nothing.
    pub(crate) fn of(result: &RenderResult) -> Option<Self> {
        let is_counted =
            result.counts_everything() && !result.plan.selection.provides().contains(&Capability::FixedFunction);
        let counters = result.stats.counters.as_ref().filter(|_| is_counted)?;
        let (generated, culled) = (u64::from(counters.get("generated")), u64::from(counters.get("culled")));
        let displaced = u64::from(counters.get("displaced"));
        let is_kept_later = result.plan.selection.provides().contains(&Capability::KeepsLater);
        let rejected = if is_kept_later { 0 } else { culled + displaced };
        let stored = generated.saturating_sub(rejected + counters.lost());
        let hit_ratio = if generated == 0 { 1.0 } else { stored as f64 / generated as f64 };
        let occluded = u64::from(counters.get("occluded"));
        Some(FragmentCounts { generated, culled, displaced, occluded, stored, hit_ratio })
    }
}
