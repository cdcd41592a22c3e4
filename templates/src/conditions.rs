//! Conditions of several rows.

use crate::vocabulary::Condition;

/// Requires depth, not a criterion, as the key.
pub(crate) fn depth_key() -> Condition {
    Condition::new(
        "depth_key",
        "depth as the key, without a criterion",
        "remove the criterion, `least |f| …`, from the `keep` line",
    )
}

/// Requires a limit.
pub(crate) fn limited() -> Condition {
    Condition::new("limited", "a limit on the fragments kept, such as `keep 8`", "write `keep 8;`")
}

/// Requires that there is no limit.
pub(crate) fn keeps_all() -> Condition {
    Condition::new("limited == 0", "every fragment, without a limit: `keep all`", "write `keep all;`")
}

/// Requires a limit of one fragment.
pub(crate) fn keeps_one() -> Condition {
    Condition::new("keep == 1", "a limit of one: `keep 1`", "write `keep 1;`")
}

/// Requires a colour to blend; `help` is the fix if there is none.
pub(crate) fn color(help: &'static str) -> Condition {
    Condition::new("color", "an attribute `color` of format rgba8, rgba16 or vec4", help)
}

/// The fix for a missing colour.
pub(crate) const ADD_COLOR: &str = "add `color: rgba8` to the fragment";

/// Requires a render target per word of a fragment: every WebGPU device has eight of one word.
pub(crate) fn word_per_target() -> Condition {
    Condition::new(
        "payload_words <= 8",
        "at most eight words in the payload, one per render target",
        "remove attributes, or choose smaller formats, until the payload has eight words",
    )
}
