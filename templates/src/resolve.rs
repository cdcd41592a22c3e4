//! Axis `resolve`: what is computed from the kept fragments.

use crate::conditions::{ADD_COLOR, color};
use crate::vocabulary::{Capability, Edit, Parameter, Row};

/// The value that stands for the closure of the description.
pub(crate) const CLOSURE: &str = "closure";

/// The value that stands for a closure over two neighbouring fragments.
pub(crate) const BETWEEN: &str = "pairs";

/// The value that stands for a closure that reads images.
pub(crate) const STEPS: &str = "after_images";

/// The constant with the number of the layer that an effect shows alone. A row on the axis `resolve` with a parameter of this constant is such an
/// effect.
pub const SHOWN_LAYER: &str = "RESOLVE_LAYER";

pub(crate) fn rows() -> Vec<Row> {
    vec![
        Row {
            template: Some(template!("resolve/over")),
            calls: vec!["samples", "peeling"],
            provides: vec![Capability::Resumes, Capability::JoinsParts],
            requires: vec![Capability::Sorted, Capability::LayersInOrder],
            conditions: vec![color(ADD_COLOR)],
            parameters: vec![Parameter::number(
                "opaque",
                "OPAQUE_THOUSANDTHS",
                "0",
                (0, 1000),
                "thousandths of the light behind, and of a channel's error: blending stops when less passes; 0: never",
            )],
            ..Row::new("resolve", "over", "colours blended front to back", "Porter & Duff 1984; K15 §4.4")
        },
        Row {
            template: Some(template!("resolve/layer")),
            calls: vec!["samples", "peeling"],
            provides: vec![Capability::Resumes, Capability::JoinsParts],
            requires: vec![Capability::Sorted],
            conditions: vec![color(ADD_COLOR)],
            parameters: vec![Parameter::number(
                "number",
                SHOWN_LAYER,
                "0",
                (0, 65_535),
                "number of the layer, from 0; with peeling: of its iteration, times the slots of one, plus the slot",
            )],
            ..Row::new(
                "resolve",
                "layer",
                "one layer alone: a fragment, or what peeling stores in one slot",
                "D13 Fig. 4",
            )
        },
        Row {
            template: Some(template!("resolve/stream")),
            requires: vec![Capability::Streams],
            conditions: vec![color(ADD_COLOR)],
            provides: vec![Capability::PairValues],
            ..Row::new(
                "resolve",
                "stream",
                "colours blended front to back as the storage passes them on",
                "B06 §4.3; Porter & Duff 1984",
            )
        },
        Row {
            template: Some(template!("resolve/complexity")),
            calls: vec!["samples"],
            parameters: vec![Parameter::number(
                "most",
                "COMPLEXITY_MOST",
                "capacity",
                (1, 4096),
                "number of fragments from which a pixel is red",
            )],
            ..Row::new("resolve", "complexity", "the number of fragments, as a heat map from blue to red", "")
        },
        Row {
            calls: vec!["samples", "peeling"],
            requires: vec![Capability::LayersInOrder],
            implies: vec![("resumable".into(), Capability::Resumes)],
            ..Row::new("resolve", CLOSURE, "the closure of the description, `resolve |fragments, u| { … }`", "")
        },
        Row {
            template: Some(template!("resolve/pairs")),
            calls: vec!["samples"],
            requires: vec![Capability::Sorted],
            provides: vec![Capability::PairValues],
            ..Row::new(
                "resolve",
                BETWEEN,
                "the closure `between` of the description, composited front to back",
                "B06 §4.3; Porter & Duff 1984",
            )
        },
        Row {
            calls: vec!["samples"],
            requires: vec![Capability::Sorted, Capability::OneResolve],
            edits: vec![Edit::Images("resolve".to_owned())],
            ..Row::new("resolve", STEPS, "the closure of the description, after its images", "")
        },
    ]
}
