//! Techniques with changes, checked in one line.

use fragbuf_targets::{TARGETS, Target};
use fragbuf_checker::{Error, Limits, Model, Report, check_variant};
use fragbuf_model::{Diagnostics, Draft, Origin, Variant, check};
use fragbuf_templates::Registry;

pub(crate) fn target(name: &str) -> &'static Target {
    TARGETS.iter().find(|target| target.name == name).unwrap()
}

/// A technique with `--set` changes; every event is counted.
pub(crate) fn variant(key: &str, set: &[(&str, &str)], registry: &Registry) -> Result<Variant, Diagnostics> {
    let origin = Origin::new("test", 1, 1);
    let mut draft = Draft::from_technique(key, &origin);
    for (name, value) in [("counters", "all")].iter().chain(set) {
        draft.set(name, value, &origin).unwrap();
    }
    check(&draft, registry)
}

/// Up to `fragments` at once.
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
