//! A triangle on the pixel grid: the samples that it covers, and the weights of its corners at a sample.
//!
//! Coverage uses integers in 256ths of a pixel and the top-left rule: triangles with a common edge cover each sample of the
//! edge exactly once.

use crate::clip::Corner;

/// 256ths of a pixel.
pub(crate) const SUBPIXELS: i64 = 256;

/// Returns the standard sample positions of the graphics APIs, in 256ths of a pixel from its top left corner.
pub(crate) fn sample_positions(samples: u32) -> &'static [(i64, i64)] {
    match samples {
        2 => &[(192, 192), (64, 64)],
        4 => &[(96, 32), (224, 96), (32, 160), (160, 224)],
        8 => &[(144, 80), (112, 176), (208, 144), (80, 48), (48, 208), (16, 112), (176, 240), (240, 16)],
        _ => &[PIXEL_CENTRE],
    }
}

/// The centre of a pixel.
pub(crate) const PIXEL_CENTRE: (i64, i64) = (128, 128);

/// A triangle after setup.
#[derive(Clone, Debug)]
pub(crate) struct Triangle {
    /// The corners in 256ths of a pixel, ordered so that the area is positive.
    corners: [(i64, i64); 3],
    /// Added to the edge functions: 0 if the triangle covers the samples on the edge, else -1.
    bias: [i64; 3],
    plane: WeightPlane,
    depths: [f32; 3],
    /// 1 / w.
    inverse_w: [f32; 3],
    /// The first word of each corner in the vertex list.
    pub(crate) vertices: [u32; 3],
    /// The first word of the provoking vertex: the source of flat attributes.
    pub(crate) provoking: u32,
    pub(crate) primitive: u32,
    pub(crate) is_front: bool,
}

/// The weights of the corners at one sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Weights {
    /// Linear in screen space, of the second and third corner.
    pub(crate) linear: [f64; 2],
    /// Perspective-correct, of the second and third corner.
    pub(crate) perspective: [f32; 2],
    /// 1 / w.
    pub(crate) inverse_w: f32,
    pub(crate) depth: f32,
}

/// A corner of a triangle.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Vertex {
    /// In clip space.
    pub(crate) position: [f32; 4],
    /// Its first word in the vertex list.
    pub(crate) words: u32,
}

impl Triangle {
    /// Sets up a triangle. `None`: its area is zero.
    pub(crate) fn new(vertices: [Vertex; 3], provoking: u32, primitive: u32, size: (u32, u32)) -> Option<Self> {
        let screen = vertices.map(|vertex| ScreenVertex::of(&vertex, size));
        let area = edge(screen[0].snapped, screen[1].snapped, screen[2].snapped);
        if area == 0 {
            return None;
        }
        // Counter-clockwise with y upwards is the front. Screen y points down, so its area is negative.
        let is_front = area < 0;
        let [a, b, c] = if is_front { [screen[0], screen[2], screen[1]] } else { screen };
        let corners = [a.snapped, b.snapped, c.snapped];
        let bias = std::array::from_fn(|index| {
            let (from, to) = (corners[(index + 1) % 3], corners[(index + 2) % 3]);
            let (x, y) = (to.0 - from.0, to.1 - from.1);
            let is_top_or_left = y < 0 || (y == 0 && x > 0);
            if is_top_or_left { 0 } else { -1 }
        });
        Some(Triangle {
            corners,
            bias,
            plane: WeightPlane::of([a, b, c], area.unsigned_abs()),
            depths: [a.depth, b.depth, c.depth],
            inverse_w: [a.inverse_w, b.inverse_w, c.inverse_w],
            vertices: [a.words, b.words, c.words],
            provoking,
            primitive,
            is_front,
        })
    }

    /// Returns the bounding box within the frame, as pixels `x0..x1` and `y0..y1`.
    pub(crate) fn bounds(&self, (width, height): (u32, u32)) -> [u32; 4] {
        let of = |values: [i64; 3], end: u32| {
            let least = values.iter().copied().min().unwrap_or(0).div_euclid(SUBPIXELS);
            let greatest = values.iter().copied().max().unwrap_or(0).div_euclid(SUBPIXELS) + 1;
            [least.clamp(0, end.into()) as u32, greatest.clamp(0, end.into()) as u32]
        };
        let [x0, x1] = of(self.corners.map(|corner| corner.0), width);
        let [y0, y1] = of(self.corners.map(|corner| corner.1), height);
        [x0, x1, y0, y1]
    }

    /// Returns whether the triangle may touch the pixels `x0..x1`, `y0..y1`: false only if all are outside one edge.
    pub(crate) fn may_touch(&self, [x0, x1, y0, y1]: [u32; 4]) -> bool {
        let [left, right, top, bottom] = [x0, x1, y0, y1].map(|pixel| i64::from(pixel) * SUBPIXELS);
        (0..3).all(|index| {
            let (from, to) = (self.corners[(index + 1) % 3], self.corners[(index + 2) % 3]);
            let (x, y) = (to.0 - from.0, to.1 - from.1);
            // The corner of the rectangle that is farthest inside.
            let corner = (if y < 0 { right } else { left }, if x > 0 { bottom } else { top });
            edge(from, to, corner) >= 0
        })
    }

    /// Returns the biased edge functions at a sample; the triangle covers it if none is negative.
    #[inline]
    pub(crate) fn edges(&self, x: u32, y: u32, offset: (i64, i64)) -> [i64; 3] {
        let sample = (i64::from(x) * SUBPIXELS + offset.0, i64::from(y) * SUBPIXELS + offset.1);
        let [a, b, c] = self.corners;
        [edge(b, c, sample) + self.bias[0], edge(c, a, sample) + self.bias[1], edge(a, b, sample) + self.bias[2]]
    }

    /// Returns the increments of the edge functions from a pixel to its right neighbour.
    pub(crate) fn steps(&self) -> [i64; 3] {
        let [a, b, c] = self.corners;
        [(b.1 - c.1) * SUBPIXELS, (c.1 - a.1) * SUBPIXELS, (a.1 - b.1) * SUBPIXELS]
    }

    /// Returns the weights of the corners at a sample.
    #[inline]
    pub(crate) fn weights(&self, x: u32, y: u32, offset: (i64, i64)) -> Weights {
        let linear = self.plane.at(f64::from(x) + offset.0 as f64 / 256.0, f64::from(y) + offset.1 as f64 / 256.0);
        let depth = self.mixed(self.depths, linear).clamp(0.0, 1.0) as f32;
        let w = self.inverse_w;
        if w[0] == w[1] && w[0] == w[2] {
            let perspective = linear.map(|share| share as f32);
            return Weights { linear, perspective, inverse_w: w[0], depth };
        }
        let inverse_w = self.mixed(w, linear);
        let perspective = [1, 2].map(|corner| (linear[corner - 1] * f64::from(w[corner]) / inverse_w) as f32);
        Weights { linear, perspective, inverse_w: inverse_w as f32, depth }
    }

    /// Interpolates linearly; exact if the three values are equal.
    fn mixed(&self, values: [f32; 3], shares: [f64; 2]) -> f64 {
        let [a, b, c] = values.map(f64::from);
        a + shares[0] * (b - a) + shares[1] * (c - a)
    }
}

/// The weights of the second and third corner as linear functions of screen space. They use the exact corners, not the snapped
/// ones, so depth does not depend on snapping and steep triangles intersect at the right pixels.
#[derive(Clone, Debug)]
struct WeightPlane {
    origin: [f64; 2],
    /// The derivatives by x and y of each weight.
    slopes: [[f64; 2]; 2],
}

impl WeightPlane {
    fn of(corners: [ScreenVertex; 3], snapped_area: u64) -> Self {
        let exact = corners.map(|corner| corner.exact.map(f64::from));
        let snapped_area = snapped_area as f64 / (SUBPIXELS * SUBPIXELS) as f64;
        let plane = WeightPlane::through(exact);
        // A sliver that snapping widened or flipped uses the snapped corners.
        match plane {
            Some((area, plane)) if (0.5..2.0).contains(&(area / snapped_area)) => plane,
            _ => {
                let snapped = corners
                    .map(|corner| [corner.snapped.0, corner.snapped.1].map(|axis| axis as f64 / SUBPIXELS as f64));
                WeightPlane::through(snapped)
                    .map_or(WeightPlane { origin: snapped[0], slopes: [[0.0; 2]; 2] }, |(_, plane)| plane)
            }
        }
    }

    /// Returns twice the area, and the plane.
    fn through([a, b, c]: [[f64; 2]; 3]) -> Option<(f64, Self)> {
        let (b, c) = ([b[0] - a[0], b[1] - a[1]], [c[0] - a[0], c[1] - a[1]]);
        let area = b[0] * c[1] - b[1] * c[0];
        let slopes = [[c[1] / area, -c[0] / area], [-b[1] / area, b[0] / area]];
        (area > 0.0).then_some((area, WeightPlane { origin: a, slopes }))
    }

    #[inline]
    fn at(&self, x: f64, y: f64) -> [f64; 2] {
        let (x, y) = (x - self.origin[0], y - self.origin[1]);
        self.slopes.map(|[by_x, by_y]| by_x * x + by_y * y)
    }
}

/// A corner in screen space.
#[derive(Clone, Copy)]
struct ScreenVertex {
    /// The position in pixels.
    exact: [f32; 2],
    /// The position rounded to 256ths of a pixel.
    snapped: (i64, i64),
    depth: f32,
    inverse_w: f32,
    words: u32,
}

impl ScreenVertex {
    fn of(vertex: &Vertex, (width, height): (u32, u32)) -> Self {
        let [x, y, z, w] = vertex.position;
        let inverse_w = 1.0 / w;
        let (half_width, half_height) = (0.5 * width as f32, 0.5 * height as f32);
        let screen = (x * inverse_w * half_width + half_width, half_height - y * inverse_w * half_height);
        let snap = |value: f32| (f64::from(value) * SUBPIXELS as f64).round() as i64;
        let snapped = (snap(screen.0), snap(screen.1));
        ScreenVertex { exact: [screen.0, screen.1], snapped, depth: z * inverse_w, inverse_w, words: vertex.words }
    }
}

/// Returns twice the signed area of the three points; positive if `at` is to the right of the edge, with y downwards.
#[inline]
fn edge(from: (i64, i64), to: (i64, i64), at: (i64, i64)) -> i64 {
    (to.0 - from.0) * (at.1 - from.1) - (to.1 - from.1) * (at.0 - from.0)
}

/// Triangulates a polygon as a fan around its first corner.
pub(crate) fn fan(polygon: &[Corner]) -> impl Iterator<Item = [usize; 3]> {
    (2..polygon.len()).map(|last| [0, last - 1, last])
}
