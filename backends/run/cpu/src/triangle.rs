//! One triangle on the grid of pixels: which samples it covers, and what its corners weigh there.
//!
//! In: positions in clip space. Out: answers per sample. Coverage is whole numbers in 256ths of a pixel, so that triangles
//! that share an edge share no sample and leave none out: a sample on an edge belongs to the triangle whose top or left edge it is.

use crate::clip::Corner;

/// 256ths of a pixel.
pub(crate) const SUBPIXELS: i64 = 256;

/// Where a pixel is sampled, in 256ths from its top left: the standard places of the graphics APIs.
pub(crate) fn sample_places(samples: u32) -> &'static [(i64, i64)] {
    match samples {
        2 => &[(192, 192), (64, 64)],
        4 => &[(96, 32), (224, 96), (32, 160), (160, 224)],
        8 => &[(144, 80), (112, 176), (208, 144), (80, 48), (48, 208), (16, 112), (176, 240), (240, 16)],
        _ => &[MIDDLE],
    }
}

/// The middle of a pixel.
pub(crate) const MIDDLE: (i64, i64) = (128, 128);

/// A triangle, ready to be sampled.
#[derive(Clone, Debug)]
pub(crate) struct Triangle {
    /// Corners in 256ths of a pixel, turned so that the area is positive.
    corners: [(i64, i64); 3],
    /// Added to an edge's function: 0 where the edge's own samples are the triangle's, else -1.
    bias: [i64; 3],
    plane: Plane,
    depths: [f32; 3],
    /// 1 / w.
    inverse_w: [f32; 3],
    /// Where the words of each corner are, in the list of vertices.
    pub(crate) vertices: [u32; 3],
    /// The vertex that flat attributes come from.
    pub(crate) provoking: u32,
    pub(crate) primitive: u32,
    pub(crate) is_front: bool,
}

/// What the corners weigh at one sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Weights {
    /// On the screen; those of the second and third corner.
    pub(crate) linear: [f64; 2],
    /// In space.
    pub(crate) perspective: [f32; 2],
    /// 1 / w.
    pub(crate) inverse_w: f32,
    pub(crate) depth: f32,
}

/// A corner of a triangle and where its words are.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Vertex {
    /// In clip space.
    pub(crate) position: [f32; 4],
    pub(crate) words: u32,
}

impl Triangle {
    /// `None`: it has no area.
    pub(crate) fn new(vertices: [Vertex; 3], provoking: u32, primitive: u32, size: (u32, u32)) -> Option<Self> {
        let placed = vertices.map(|vertex| Placed::of(&vertex, size));
        let area = edge(placed[0].place, placed[1].place, placed[2].place);
        if area == 0 {
            return None;
        }
        // Counter-clockwise is the front, with y upwards; on the screen y goes down, and that is a negative area.
        let is_front = area < 0;
        let [a, b, c] = if is_front { [placed[0], placed[2], placed[1]] } else { placed };
        let corners = [a.place, b.place, c.place];
        let bias = std::array::from_fn(|index| {
            let (from, to) = (corners[(index + 1) % 3], corners[(index + 2) % 3]);
            let (x, y) = (to.0 - from.0, to.1 - from.1);
            let is_top_or_left = y < 0 || (y == 0 && x > 0);
            if is_top_or_left { 0 } else { -1 }
        });
        Some(Triangle {
            corners,
            bias,
            plane: Plane::of([a, b, c], area.unsigned_abs()),
            depths: [a.depth, b.depth, c.depth],
            inverse_w: [a.inverse_w, b.inverse_w, c.inverse_w],
            vertices: [a.words, b.words, c.words],
            provoking,
            primitive,
            is_front,
        })
    }

    /// The pixels around it, `x0..x1` and `y0..y1`, inside the frame.
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

    /// Whether it can touch the pixels `x0..x1`, `y0..y1`: false only where all of them lie beyond one edge.
    pub(crate) fn may_touch(&self, [x0, x1, y0, y1]: [u32; 4]) -> bool {
        let [left, right, top, bottom] = [x0, x1, y0, y1].map(|pixel| i64::from(pixel) * SUBPIXELS);
        (0..3).all(|index| {
            let (from, to) = (self.corners[(index + 1) % 3], self.corners[(index + 2) % 3]);
            let (x, y) = (to.0 - from.0, to.1 - from.1);
            // The rectangle's corner that is farthest inside.
            let place = (if y < 0 { right } else { left }, if x > 0 { bottom } else { top });
            edge(from, to, place) >= 0
        })
    }

    /// The edge functions at a sample, the bias added: it is covered where none is negative.
    #[inline]
    pub(crate) fn edges(&self, x: u32, y: u32, offset: (i64, i64)) -> [i64; 3] {
        let place = (i64::from(x) * SUBPIXELS + offset.0, i64::from(y) * SUBPIXELS + offset.1);
        let [a, b, c] = self.corners;
        [edge(b, c, place) + self.bias[0], edge(c, a, place) + self.bias[1], edge(a, b, place) + self.bias[2]]
    }

    /// What an edge function grows by from one pixel to the next on its right.
    pub(crate) fn steps(&self) -> [i64; 3] {
        let [a, b, c] = self.corners;
        [(b.1 - c.1) * SUBPIXELS, (c.1 - a.1) * SUBPIXELS, (a.1 - b.1) * SUBPIXELS]
    }

    /// What the corners weigh at a sample.
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

    /// Exact where the three are equal.
    fn mixed(&self, values: [f32; 3], shares: [f64; 2]) -> f64 {
        let [a, b, c] = values.map(f64::from);
        a + shares[0] * (b - a) + shares[1] * (c - a)
    }
}

/// The weights of the second and third corner, linear on the screen. They follow the corners as they are, not as coverage has
/// rounded them: so depth does not depend on the rounding, and steep triangles meet where they should.
#[derive(Clone, Debug)]
struct Plane {
    origin: [f64; 2],
    /// By x and y, for each of the two.
    slopes: [[f64; 2]; 2],
}

impl Plane {
    fn of(corners: [Placed; 3], snapped_area: u64) -> Self {
        let exact = corners.map(|corner| corner.exact.map(f64::from));
        let snapped_area = snapped_area as f64 / (SUBPIXELS * SUBPIXELS) as f64;
        let plane = Plane::through(exact);
        // A sliver that rounding has made much wider, or turned, is taken as it was rounded.
        match plane {
            Some((area, plane)) if (0.5..2.0).contains(&(area / snapped_area)) => plane,
            _ => {
                let snapped =
                    corners.map(|corner| [corner.place.0, corner.place.1].map(|place| place as f64 / SUBPIXELS as f64));
                Plane::through(snapped).map_or(Plane { origin: snapped[0], slopes: [[0.0; 2]; 2] }, |(_, plane)| plane)
            }
        }
    }

    /// Twice the area, and the plane.
    fn through([a, b, c]: [[f64; 2]; 3]) -> Option<(f64, Self)> {
        let (b, c) = ([b[0] - a[0], b[1] - a[1]], [c[0] - a[0], c[1] - a[1]]);
        let area = b[0] * c[1] - b[1] * c[0];
        let slopes = [[c[1] / area, -c[0] / area], [-b[1] / area, b[0] / area]];
        (area > 0.0).then_some((area, Plane { origin: a, slopes }))
    }

    #[inline]
    fn at(&self, x: f64, y: f64) -> [f64; 2] {
        let (x, y) = (x - self.origin[0], y - self.origin[1]);
        self.slopes.map(|[by_x, by_y]| by_x * x + by_y * y)
    }
}

/// A corner on the screen.
#[derive(Clone, Copy)]
struct Placed {
    /// In pixels.
    exact: [f32; 2],
    /// In 256ths of a pixel.
    place: (i64, i64),
    depth: f32,
    inverse_w: f32,
    words: u32,
}

impl Placed {
    fn of(vertex: &Vertex, (width, height): (u32, u32)) -> Self {
        let [x, y, z, w] = vertex.position;
        let inverse_w = 1.0 / w;
        let (half_width, half_height) = (0.5 * width as f32, 0.5 * height as f32);
        let screen = (x * inverse_w * half_width + half_width, half_height - y * inverse_w * half_height);
        let snapped = |value: f32| (f64::from(value) * SUBPIXELS as f64).round() as i64;
        let place = (snapped(screen.0), snapped(screen.1));
        Placed { exact: [screen.0, screen.1], place, depth: z * inverse_w, inverse_w, words: vertex.words }
    }
}

/// Twice the signed area of the three; positive where `at` lies to the right of the way, with y downwards.
#[inline]
fn edge(from: (i64, i64), to: (i64, i64), at: (i64, i64)) -> i64 {
    (to.0 - from.0) * (at.1 - from.1) - (to.1 - from.1) * (at.0 - from.0)
}

/// A polygon as triangles around its first corner.
pub(crate) fn fan(polygon: &[Corner]) -> impl Iterator<Item = [usize; 3]> {
    (2..polygon.len()).map(|last| [0, last - 1, last])
}
