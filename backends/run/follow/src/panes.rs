//! The scene that the programs of the hosts draw: overlapping panes of glass.

use crate::Object;
use crate::manifest::VertexInput;

/// Depth and straight colour of each pane, in the order of drawing, which is not that of depths.
const PANES: [(f32, [f32; 4]); 6] = [
    (0.6, [0.9, 0.2, 0.2, 0.5]),
    (0.3, [0.2, 0.8, 0.3, 0.5]),
    (0.8, [0.2, 0.3, 0.9, 0.5]),
    (0.1, [0.9, 0.8, 0.2, 0.3]),
    (0.9, [0.6, 0.2, 0.8, 0.6]),
    (0.5, [0.2, 0.8, 0.8, 0.4]),
];

/// The greatest number of panes over a pixel.
pub const DEEPEST: u64 = PANES.len() as u64;

/// Returns the vertices of all panes in clip space, for a frame of this size. Inputs other than position and colour are zero.
pub fn vertices(inputs: &[VertexInput], size: [u32; 2]) -> Vec<u8> {
    let pane = |(index, pane)| pane_vertices(index, pane, (inputs, size[1] as f32 / size[0].max(1) as f32));
    (0..).zip(PANES).flat_map(pane).collect()
}

/// Returns an object per pane. Their boxes hide nothing.
pub fn objects() -> Vec<Object> {
    let object = |index| Object { first: 6 * index, count: 6, bounds: [[-1.0, -1.0, 0.0], [1.0, 1.0, 1.0]] };
    (0..PANES.len() as u32).map(object).collect()
}

/// Returns two triangles. Each pane is turned by a sixth of a circle against the one before.
fn pane_vertices(index: u32, (depth, color): (f32, [f32; 4]), (inputs, aspect): (&[VertexInput], f32)) -> Vec<u8> {
    let (sin, cos) = (index as f32 * std::f32::consts::FRAC_PI_3).sin_cos();
    let corner = |[x, y]: [f32; 2]| [(x * cos - y * sin) * aspect, x * sin + y * cos, depth];
    let (left, right, top, bottom) = (-0.2, 0.8, 0.45, -0.45);
    let corners = [[left, top], [left, bottom], [right, bottom], [left, top], [right, bottom], [right, top]];
    let vertex = |at: [f32; 2]| {
        inputs.iter().flat_map(move |input| match input.name.as_str() {
            "position" => corner(at).to_vec(),
            "color" => color.to_vec(),
            _ => vec![0.0; input.components()],
        })
    };
    corners.into_iter().flat_map(vertex).flat_map(f32::to_le_bytes).collect()
}
