//! The scenes: axis-aligned quads of constant depth whose edges are on pixel edges, so that coverage is known without a rasteriser.

use fragbuf_runtime::VertexInputs;

/// Pixels along each side of the frame.
pub const SIZE: u32 = 16;

/// A quad over all pixels with `x0 ≤ x < x1` and `y0 ≤ y < y1`, `y` downwards.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quad {
    pub x0: u32,
    pub y0: u32,
    pub x1: u32,
    pub y1: u32,
    pub depth: f32,
    pub color: [u8; 4],
    pub id: u32,
}

impl Quad {
    /// Returns a quad over the whole frame.
    pub fn whole(depth: f32, color: [u8; 4]) -> Self {
        Quad { x0: 0, y0: 0, x1: SIZE, y1: SIZE, depth, color, id: 0 }
    }

    pub fn at(self, x0: u32, y0: u32, x1: u32, y1: u32) -> Self {
        Quad { x0, y0, x1, y1, ..self }
    }

    pub fn named(self, id: u32) -> Self {
        Quad { id, ..self }
    }

    pub fn covers(&self, x: u32, y: u32) -> bool {
        (self.x0..self.x1).contains(&x) && (self.y0..self.y1).contains(&y)
    }

    pub fn rgba(&self) -> [f32; 4] {
        self.color.map(|channel| f32::from(channel) / 255.0)
    }
}

/// Returns the vertices of two triangles per quad, in the order of the quads.
pub fn vertices(quads: &[Quad], inputs: &VertexInputs) -> Vec<u8> {
    let mut bytes = Vec::new();
    for quad in quads {
        let clip_x = |x: u32| x as f32 / (SIZE / 2) as f32 - 1.0;
        let clip_y = |y: u32| 1.0 - y as f32 / (SIZE / 2) as f32;
        let (left, right) = (clip_x(quad.x0), clip_x(quad.x1));
        let (top, bottom) = (clip_y(quad.y0), clip_y(quad.y1));
        for [x, y] in [[left, top], [left, bottom], [right, bottom], [left, top], [right, bottom], [right, top]] {
            for input in &inputs.inputs {
                match input.name.as_str() {
                    "position" => push(&mut bytes, &[x, y, quad.depth]),
                    "color" => push(&mut bytes, &quad.rgba()),
                    // Towards the camera.
                    "normal" => push(&mut bytes, &[0.0, 0.0, 1.0]),
                    "id" => bytes.extend(quad.id.to_le_bytes()),
                    other => panic!("no value for the attribute `{other}`"),
                }
            }
        }
    }
    bytes
}

fn push(bytes: &mut Vec<u8>, values: &[f32]) {
    bytes.extend(values.iter().flat_map(|value| value.to_le_bytes()));
}
