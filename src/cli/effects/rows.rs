//! The rows of the effects. A row is data.

use super::Effect;

/// Returns a row. Its description is the file of this name.
macro_rules! row {
    ($name:literal, $summary:literal, $source:literal, reads: $reads:expr, $arguments:expr) => {
        Effect {
            name: $name,
            summary: $summary,
            source: $source,
            path: concat!("examples/effects/", $name, ".fragbuf"),
            text: include_str!(concat!("../../../examples/effects/", $name, ".fragbuf")),
            reads: $reads,
            arguments: $arguments,
        }
    };
}

/// Every effect.
pub(crate) const EFFECTS: &[Effect] = &[row!(
    "transparency",
    "surfaces of one opacity, composited front to back",
    "B06 §4.1",
    reads: None,
    &[
        ("--scene", "builtin:marbles,n=160"),
        ("--size", "960x540"),
        ("--shading", "unlit"),
        ("--uniform", "alpha=0.35"),
        ("--set", "samples=coverage"),
    ]
)];
