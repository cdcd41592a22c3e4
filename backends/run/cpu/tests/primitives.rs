//! The primitive index: the position of the triangle in the list of the scene, whatever is clipped or dropped before it.

use fragbuf_cpu::FragmentOrder;
use fragbuf_templates::vocabulary::{Access, Compare, Element, Feature, Objects, Pass, Resource, Step, TextureFormat};

use crate::peeling_loop::depth;
use crate::stage::{Triangle, code, device, draw_objects, quad, storage, texture};

const NUMBERED: &str = "
@fragment
fn numbered(inputs: FragmentInput, @builtin(primitive_index) number: u32) {
    let before = numbers_atomic_max(pixel_index(inputs.position.xy), 1u + number);
}
";

const BOXES: &str = "
@fragment
fn boxes() {}
";

/// Triangles 0 and 1 cover columns 0 to 4, 2 and 3 columns 4 to 8. Triangle 4 is between 8 and 12, half of it in front of the
/// near plane; 5 and 6 cover the rest.
fn scene() -> Vec<Triangle> {
    let color = [1.0; 4];
    let clipped = Triangle { corners: [[8.0, 0.0, -0.5], [8.0, 16.0, 0.5], [12.0, 16.0, 0.5]], color };
    let mut scene = [quad([0, 4, 0, 16], 0.25, color), quad([4, 8, 0, 16], 0.5, color)].concat();
    scene.push(clipped);
    scene.extend(quad([12, 16, 0, 16], 0.75, color));
    scene
}

/// Returns the primitive indices plus one along a pixel row.
fn row(objects: Objects, boxes: Option<Pass>, y: usize) -> Vec<u32> {
    let numbered = Pass { objects, ..Pass::geometry("numbered", "numbered").uses("numbers", Access::Atomic) };
    let mut rows = storage(
        vec![
            texture("behind", TextureFormat::Depth32Float).cleared(0.4f32.to_bits()),
            Resource::new("numbers", Element::Word, "").by("pixel", "pixels").cleared(0),
        ],
        boxes.into_iter().chain([numbered]).map(Step::Pass).collect(),
    );
    rows.needs = vec![Feature::PrimitiveIndex];
    let code = code(rows, &[("numbered", NUMBERED), ("boxes", BOXES)], None).unwrap_or_else(|error| panic!("{error}"));
    let mut device = device(&code, FragmentOrder::Submission);
    draw_objects(&mut device, &scene(), &[0..6, 6..12, 12..15, 15..21]);
    device.words("numbers").unwrap()[16 * y..16 * (y + 1)].to_vec()
}

#[test]
fn primitive_indices_are_positions_in_the_list() {
    // The even triangle of each quad is below the diagonal.
    let seen = row(Objects::All, None, 15);
    assert_eq!(seen, [1, 1, 1, 1, 3, 3, 3, 3, 5, 5, 5, 5, 6, 6, 6, 6]);
    // Depth is 0 at half the height of the clipped triangle: nothing is left above.
    let seen = row(Objects::All, None, 0);
    assert_eq!(seen, [2, 2, 2, 2, 4, 4, 4, 4, 0, 0, 0, 0, 7, 7, 7, 7]);
}

#[test]
fn dropped_objects_do_not_change_primitive_indices() {
    let mut boxes = Pass { objects: Objects::Boxes, ..Pass::geometry("boxes", "boxes") };
    boxes.state.depth = depth("behind", Compare::Greater, false);
    let seen = row(Objects::Visible("boxes".to_owned()), Some(boxes), 15);
    assert_eq!(seen, [0, 0, 0, 0, 3, 3, 3, 3, 5, 5, 5, 5, 6, 6, 6, 6]);
}
