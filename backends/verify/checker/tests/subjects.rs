//! Checks a technique with changes in one call.

use fragbuf_checker::{Error, Limits, Model, Report, check_variant};
use fragbuf_model::{Diagnostics, Draft, SourceSpan, Variant, check};
use fragbuf_targets::{TARGETS, Target};
use fragbuf_templates::Registry;

pub(crate) fn target(name: &str) -> &'static Target {
    TARGETS.iter().find(|target| target.name == name).unwrap()
}

/// Returns a technique with `--set` changes. Every event is counted.
pub(crate) fn variant(key: &str, set: &[(&str, &str)], registry: &Registry) -> Result<Variant, Diagnostics> {
    let span = SourceSpan::new("test", 1, 1);
    let mut draft = Draft::from_technique(key, &span);
    for (name, value) in [("counters", "all")].iter().chain(set) {
        draft.set(name, value, &span).unwrap();
    }
    check(&draft, registry)
}

/// Returns limits of two to `fragments` concurrent fragments.
pub(crate) fn limits(fragments: u32, model: Model) -> Limits {
    Limits { fragments: (2..=fragments).collect(), model, ..Limits::default() }
}

pub(crate) fn report(
    key: &str,
    set: &[(&str, &str)],
    target_name: &str,
    limits: &Limits,
    registry: &Registry,
) -> Result<Report, Error> {
    let variant = variant(key, set, registry)?;
    check_variant(&variant, target(target_name), registry, limits, &mut |_| {})
}
