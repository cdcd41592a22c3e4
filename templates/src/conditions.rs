//! Conditions that several rows state.

use crate::vocabulary::Condition;

/// Depth, and no criterion, decides.
pub(crate) fn depth_key() -> Condition {
    Condition::new(
        "depth_key",
        "that depth decides which fragment is worst: no criterion",
        "drop the criterion, `least |f| …`, from the `keep` line",
    )
}

/// There is a k.
pub(crate) fn limited() -> Condition {
    Condition::new("limited", "a limit on what is kept: `keep 8`", "write `keep 8;`")
}

/// A pixel keeps one fragment.
pub(crate) fn keeps_one() -> Condition {
    Condition::new("keep == 1", "a limit of one: `keep 1`", "write `keep 1;`")
}

/// There is a colour to blend; `hint` says what to do where there is none.
pub(crate) fn color(hint: &'static str) -> Condition {
    Condition::new("color", "an attribute `color` of format rgba8, rgba16 or vec4", hint)
}

/// The way to have a colour.
pub(crate) const ADD_COLOR: &str = "add `color: rgba8` to the fragment";

/// Every word of a fragment has a target of its own: eight of one word are what every WebGPU device has.
pub(crate) fn word_per_target() -> Condition {
    Condition::new(
        "payload_words <= 8",
        "at most eight words in the payload: there are eight targets",
        "drop attributes, or choose smaller formats, until the payload has eight words",
    )
}
