//! The number of a fragment's triangle: its place in the scene's list, whatever is clipped, dropped or left out before it.

use fragbuf_cpu::Order;
use fragbuf_templates::vocabulary::{
    Access, Capability, Compare, Element, Objects, Pass, Resource, Step, TextureFormat,
};

use crate::peeling::depth;
use crate::stage::{Triangle, code, device, draw_objects, quad, storage, texture};

const NUMBERED: &str = "
@fragment
fn numbered(varyings: Varyings, @builtin(primitive_index) number: u32) {
    let before = numbers_atomic_max(pixel_index(varyings.position.xy), 1u + number);
}
";

const BOXES: &str = "
@fragment
fn boxes() {}
";

/// Triangles 0 and 1 cover pixels from 0 to 4, 2 and 3 those from 4 to 8; 4 lies between 8 and 12, half of it before the near plane; 5 and 6
/// cover the rest.
fn scene() -> Vec<Triangle> {
    let color = [1.0; 4];
    let clipped = Triangle { corners: [[8.0, 0.0, -0.5], [8.0, 16.0, 0.5], [12.0, 16.0, 0.5]], color };
    let mut scene = [quad([0, 4, 0, 16], 0.25, color), quad([4, 8, 0, 16], 0.5, color)].concat();
    scene.push(clipped);
    scene.extend(quad([12, 16, 0, 16], 0.75, color));
    scene
}

/// Numbers, plus one, along a row of pixels.
fn row(objects: Objects, boxes: Option<Pass>, y: usize) -> Vec<u32> {
    let numbered = Pass { objects, ..Pass::geometry("numbered", "numbered").uses("numbers", Access::Atomic) };
    let mut rows = storage(
        vec![
            texture("behind", TextureFormat::Depth32Float).cleared(0.4f32.to_bits()),
            Resource::new("numbers", Element::Word, "").by("pixel", "pixels").cleared(0),
        ],
        boxes.into_iter().chain([numbered]).map(Step::Pass).collect(),
    );
    rows.needs = vec![Capability::PrimitiveIndex];
    let code = code(rows, &[("numbered", NUMBERED), ("boxes", BOXES)], None).unwrap_or_else(|error| panic!("{error}"));
    let mut device = device(&code, Order::Submission);
    draw_objects(&mut device, &scene(), &[0..6, 6..12, 12..15, 15..21]);
    device.words("numbers").unwrap()[16 * y..16 * (y + 1)].to_vec()
}

#[test]
fn triangles_have_their_place_in_the_list() {
    // Below the diagonals lie the even ones of each quad.
    let seen = row(Objects::All, None, 15);
    assert_eq!(seen, [1, 1, 1, 1, 3, 3, 3, 3, 5, 5, 5, 5, 6, 6, 6, 6]);
    // Depth is 0 in the clipped triangle's middle: above it nothing is left.
    let seen = row(Objects::All, None, 0);
    assert_eq!(seen, [2, 2, 2, 2, 4, 4, 4, 4, 0, 0, 0, 0, 7, 7, 7, 7]);
}

#[test]
fn what_is_dropped_changes_no_number() {
    let mut boxes = Pass { objects: Objects::Boxes, ..Pass::geometry("boxes", "boxes") };
    boxes.state.depth = depth("behind", Compare::Greater, false);
    let seen = row(Objects::Visible("boxes".to_owned()), Some(boxes), 15);
    assert_eq!(seen, [0, 0, 0, 0, 3, 3, 3, 3, 5, 5, 5, 5, 6, 6, 6, 6]);
}
