//! Resources, passes and capabilities that several storages share.

use crate::vocabulary::{Access, Blend, Capability, Element, Pass, Resource, Step};

/// Returns keys and value words as separate resources: the early cull reads one atomic key, and the critical section
/// reads the other words with plain loads.
pub(super) fn array_resources(keys: &'static str) -> Vec<Resource> {
    vec![
        Resource::new("keys", Element::Word, keys).by("slot", "k").by("pixel", "pixels"),
        Resource::new("entries", Element::Value, "the value words of the fragments")
            .by("slot", "k")
            .by("pixel", "pixels"),
    ]
}

/// The capabilities of arrays of the k best that replace the worst entry inside a critical section.
pub(super) const REPLACES_WORST: [Capability; 8] = [
    Capability::KeepsBest,
    Capability::KeepsEqualKeys,
    Capability::AcceptsKBestOnly,
    Capability::ConservativeBound,
    Capability::DisplacesUnderLock,
    Capability::CanReplace,
    Capability::Indexed,
    Capability::ReportsWholeFragments,
];

/// The capabilities of arrays of k slots per pixel, with keys as a resource of their own.
pub(super) const SLOTS: [Capability; 2] = [Capability::SlotsPerPixel, Capability::KeyPerSlot];

/// Returns the pass that resets every pixel by writing these resources.
pub(super) fn reset(resources: &[&str]) -> Step {
    Step::Pass(resources.iter().fold(reset_pass(), |pass, resource| pass.uses(resource, Access::Plain)))
}

/// Returns the pass that computes a colour per pixel by reading these resources.
pub(super) fn resolve(resources: &[&str]) -> Step {
    let pass = Pass::fullscreen("resolve", "resolve").target("output", Blend::Over);
    Step::Pass(resources.iter().fold(pass, |pass, resource| pass.uses(resource, Access::Read)))
}

/// Returns the reset pass without resources.
pub(super) fn reset_pass() -> Pass {
    Pass::compute("reset", "reset", "ceil_div(width, 8)", "ceil_div(height, 8)")
}
