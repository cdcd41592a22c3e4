//! Axis `allocation`: how many fragments per pixel memory is allocated for.

use crate::conditions::limited;
use crate::vocabulary::{
    Access, Capability, Edit, Element, Host, Init, Parameter, Pass, Resource, Row, Step, TextureFormat, Use,
};

pub(crate) fn rows() -> Vec<Row> {
    vec![
        Row {
            template: Some(template!("allocation/described")),
            ..Row::new("allocation", "described", "as the storage and the description state", "")
        },
        predicted(),
        predicted_exact(),
        by_importance(),
    ]
}

/// Counts fragments in a pass of its own.
fn predicted() -> Row {
    let complexity = Resource::new("complexity", Element::Word, "fragments of the pixel");
    let count = Pass::geometry("count_complexity", "count_complexity").uses("complexity", Access::Atomic);
    let (evaluate, decision) = prediction("complexity");
    // The bytes of k slots per pixel do not depend on the fragments, so the k of an earlier frame is within the budget, too.
    let steps = vec![Step::Pass(count), Step::Pass(evaluate), Step::Host(decision.lags())];
    Row {
        template: Some(template!("allocation/predicted")),
        resources: vec![complexity.by("pixel", "pixels").cleared(0)],
        requires: vec![Capability::SlotsPerPixel],
        edits: vec![Edit::AddResource(histogram()), Edit::First(steps)],
        ..by_histogram("predicted", "for the k that a histogram of the frame's fragments predicts within a budget")
    }
}

/// Uses the counts of a storage that counts anyway. The bytes depend on the fragments of the frame, whose sum the frame waits for before
/// it allocates regions, so k does not lag.
fn predicted_exact() -> Row {
    let (evaluate, decision) = prediction("counts");
    let steps = vec![Step::Pass(evaluate), Step::Host(decision)];
    Row {
        template: Some(template!("allocation/predicted_exact")),
        requires: vec![Capability::Counted],
        conditions: vec![limited()],
        calls: vec!["storage"],
        edits: vec![Edit::AddResource(histogram()), Edit::After("count".to_owned(), steps)],
        ..by_histogram("predicted_exact", "the same for storages that count fragments first and allocate exactly")
    }
}

/// Gives each pixel a k of its own. Uses the counts of a storage that counts anyway.
fn by_importance() -> Row {
    let summary = "the importance of the pixel, from 0 to 1";
    let importance = Resource::new("importance", Element::Texture(TextureFormat::R32Float), summary);
    let shares = Resource::new("shares", Element::Word, "pixels of an importance with bin + 1 fragments");
    let count =
        Pass::compute("count_by_importance", "count_by_importance", "ceil_div(width, 16)", "ceil_div(height, 16)");
    let count = count.uses("counts", Access::Read).uses("shares", Access::Atomic);
    let decision = Host::new("share_k").reads_all("shares").sets("k");
    Row {
        template: Some(template!("allocation/by_importance")),
        resources: vec![Resource { init: Init::External, ..importance.by("pixel", "pixels") }],
        uses: vec![Use::new("importance", Access::Sampled)],
        requires: vec![Capability::Counted, Capability::KPerPixel],
        conditions: vec![limited()],
        calls: vec!["addressing", "storage"],
        edits: vec![
            Edit::AddResource(shares.by("level", "256").by("bin", "capacity").cleared(0)),
            Edit::After("count".to_owned(), vec![Step::Pass(count), Step::Host(decision)]),
        ],
        parameters: vec![budget()],
        ..Row::new(
            "allocation",
            "by_importance",
            "for a k of each pixel, by an importance that the caller supplies, within a budget",
            "Vasilakis et al. 2017",
        )
    }
}

fn by_histogram(key: &str, summary: &'static str) -> Row {
    let parameters = vec![
        budget(),
        Parameter::number("hit_ratio", "HIT_PERCENT", "100", (1, 100), "per cent of the fragments that are to be kept"),
    ];
    Row { parameters, ..Row::new("allocation", key, summary, "K15 §4.2, Eq. 4-7, corrected") }
}

fn budget() -> Parameter {
    let summary = "MiB that the buffers of a frame or slice may have";
    Parameter::number("budget", "BUDGET_MIB", "200", (1, 1 << 20), summary)
}

/// The bins, and a word for fragments that no bin counts.
fn histogram() -> Resource {
    let summary = "pixels with bin + 1 fragments, the last bin with 1024 or more; then the fragments beyond the 1024th of their pixels";
    Resource::new("histogram", Element::Word, summary).by("bin", "1025").cleared(0)
}

/// Returns the pass that evaluates the counts, and the decision.
fn prediction(counts: &str) -> (Pass, Host) {
    let pass = Pass::compute("build_histogram", "build_histogram", "ceil_div(width, 16)", "ceil_div(height, 16)");
    let pass = pass.uses(counts, Access::Read).uses("histogram", Access::Atomic);
    (pass, Host::new("predict_k").reads_all("histogram").sets("k"))
}
