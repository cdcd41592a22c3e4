//! What is opaque, drawn first: transparent fragments behind it never enter, and its picture is what they are seen before.
//!
//! In: a staged scene, a device. Out: its picture, and its depths for the description that is drawn after it.

use fragbuf::vocabulary::{Fact, Init, Technique};
use fragbuf::{Plan, Registry, Variant};

use super::{UNROUNDED, in_255ths};
use crate::cli::input::Input;
use crate::cli::output::Failure;
use crate::cli::view::Stage;

/// The axis of what lies behind something opaque.
const AXIS: &str = "opaque";

/// Opaque surfaces, to be drawn first.
pub(super) struct Opaque<'a> {
    pub(super) stage: &'a Stage,
    pub(super) variant: Variant,
    pub(super) input: Input,
}

impl<'a> Opaque<'a> {
    pub(super) fn new(stage: &'a Stage, registry: &Registry) -> Result<Self, Failure> {
        let none = || Failure::Input("there is no technique that leaves the depth of the nearest fragment".to_owned());
        let mut input = Input::read(nearest(registry).ok_or_else(none)?, registry)?;
        let rounded = stage.exact && !in_255ths(&stage.scene);
        let unless_said = if rounded { &[UNROUNDED][..] } else { &[] };
        let variant = input.variant_or(&[], unless_said, registry)?;
        Ok(Opaque { stage, variant, input })
    }
}

/// The choice that turns away what lies behind something opaque: the first that has its depths brought.
pub(super) fn turned_away(registry: &Registry) -> Option<(&str, &str)> {
    let mut rows = registry.rows_of(AXIS);
    let row = rows.find(|row| row.resources.iter().any(|resource| resource.init == Init::Host))?;
    Some((AXIS, &row.key))
}

/// The technique that leaves the depth of the nearest fragment behind.
fn nearest(registry: &Registry) -> Option<&str> {
    let leaves_depth = |technique: &&Technique| {
        let mut rows = technique.choices.iter().filter_map(|(axis, key)| registry.row(axis, key));
        rows.any(|row| row.offers.contains(&Fact::LeavesDepth))
    };
    registry.techniques().iter().find(leaves_depth).map(|technique| technique.key.as_str())
}

/// The texture that a plan leaves its depths in: the one that a pass tests and writes.
pub(super) fn depths(plan: &Plan) -> Result<String, Failure> {
    let mut tests = plan.passes.iter().filter_map(|pass| pass.state.depth.as_ref());
    let written = tests.find(|test| test.write).map(|test| test.resource.clone());
    written.ok_or_else(|| Failure::Input("the opaque surfaces leave no depth behind".to_owned()))
}

/// The textures that a plan wants brought. `Err`: it wants some, and nothing opaque is drawn.
pub(super) fn brought(plan: &Plan, opaque: Option<&Opaque<'_>>) -> Result<Vec<String>, Failure> {
    let brought = plan.resources.iter().filter(|planned| planned.is_brought());
    let names: Vec<String> = brought.map(|planned| planned.resource.name.clone()).collect();
    match names.first().filter(|_| opaque.is_none()) {
        Some(name) => Err(Failure::Usage(format!(
            "the description reads `{name}`, which opaque surfaces leave behind: `fragbuf render … --opaque SCENE` draws them"
        ))),
        None => Ok(names),
    }
}

/// Premultiplied colours before others.
pub(super) fn put_before(pixels: &mut [[f32; 4]], behind: &[[f32; 4]]) {
    for (pixel, behind) in pixels.iter_mut().zip(behind) {
        let left = 1.0 - pixel[3];
        pixel.iter_mut().zip(behind).for_each(|(channel, behind)| *channel += left * behind);
    }
}
