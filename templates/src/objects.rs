//! Axis `objects`: which objects of the scene are drawn.

use crate::vocabulary::{
    Access, Capability, Compare, DepthState, Edit, Element, Feature, Objects, Pass, Resource, Row, Step, TextureFormat,
};

pub(crate) fn rows() -> Vec<Row> {
    vec![Row::new("objects", "all", "every object, in every pass over the scene", ""), unpeeled()]
}

/// Drops objects that iterations of peeling have stored completely, by a query of each object's box at the end of an iteration.
fn unpeeled() -> Row {
    let reached = Resource::new(
        "reached",
        Element::Texture(TextureFormat::Depth32Float),
        "a depth that all fragments reach which no iteration has stored",
    );
    let test = |compare: Compare, write: bool| {
        Some(DepthState { resource: "reached".to_owned(), compare, write, early: false })
    };
    let mut depth = Pass::fullscreen("reached_depth", "reached_depth").uses("reached", Access::Attachment);
    depth.state.depth = test(Compare::Always, true);
    let mut boxes = Pass::geometry("boxes", "boxes").uses("reached", Access::Attachment);
    boxes.state.depth = test(Compare::GreaterEqual, false);
    let boxes = Pass { objects: Objects::Boxes, ..boxes };
    Row {
        resources: vec![reached.by("pixel", "pixels")],
        // Boxes are compared by depth.
        requires: vec![Capability::KeepsLater, Capability::LayersInOrder],
        // The boxes need a pipeline of their own.
        needs: vec![Feature::OwnEntryPoints],
        edits: vec![
            Edit::After("resolve".to_owned(), vec![Step::Pass(depth), Step::Pass(boxes)]),
            Edit::DrawVisible("boxes".to_owned()),
        ],
        ..Row::new(
            "objects",
            "unpeeled",
            "with `peeling`, those of which a part may be left: no part of the box of the others is behind what has been peeled",
            "D13 §3.3",
        )
    }
}
