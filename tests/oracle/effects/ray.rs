//! A ray through the centre of a pixel: what it hits, and the parts between.

use super::solids::{SIZE, Solids, Triangle, cross, dot, sub};

/// The least distance of the centre of a pixel from an edge, in pixels: rasterisers round positions.
const EDGE: f64 = 1.0 / 512.0;

/// Depths of a device that differ by less may be in another order.
const NEARLY: f64 = 1e-4;

/// Depths that differ by less are equal.
const EQUAL: f64 = 1e-12;

/// A ray along z.
pub struct Ray<'a> {
    pub solids: &'a Solids,
    /// From the nearest to the farthest. Of equal depths, the lesser id is first.
    pub hits: Vec<Hit<'a>>,
    point: [f64; 2],
    pixel: [u32; 2],
}

/// A point where a ray hits a triangle.
pub struct Hit<'a> {
    pub depth: f64,
    pub triangle: &'a Triangle,
}

impl Hit<'_> {
    /// Returns the value of a point from those of the corners of the triangle, between which it is linear.
    pub fn interpolated<const N: usize>(&self, point: [f64; 3], of: impl Fn([f64; 3]) -> [f64; N]) -> [f64; N] {
        let [a, b, c] = self.triangle.corners;
        let area = |p: [f64; 3], q: [f64; 3]| {
            let side = cross(sub(p, point), sub(q, point));
            dot(side, side).sqrt()
        };
        let parts = [area(b, c), area(c, a), area(a, b)];
        let values = [a, b, c].map(of);
        let whole: f64 = parts.iter().sum();
        std::array::from_fn(|i| (0..3).map(|corner| parts[corner] * values[corner][i]).sum::<f64>() / whole)
    }
}

/// A part of a ray between two depths at which it hits something.
pub struct Span {
    pub from: f64,
    pub to: f64,
}

impl<'a> Ray<'a> {
    /// Returns the ray of a pixel; `None`: it passes an edge, or surfaces that nearly touch.
    pub fn through(solids: &'a Solids, [x, y]: [u32; 2]) -> Option<Self> {
        let clip = |at: u32, size: u32| (2.0 * f64::from(at) + 1.0) / f64::from(size) - 1.0;
        let point = [clip(x, SIZE[0]), -clip(y, SIZE[1])];
        let mut hits = Vec::new();
        for triangle in &solids.triangles {
            hits.extend(hit(triangle, point)?);
        }
        hits.sort_by(|a, b| a.depth.total_cmp(&b.depth));
        order_equal(&mut hits);
        let gaps = hits.windows(2).map(|pair| pair[1].depth - pair[0].depth);
        if gaps.into_iter().any(|gap| (EQUAL..NEARLY).contains(&gap)) {
            return None;
        }
        Some(Ray { solids, hits, point, pixel: [x, y] })
    }

    /// Returns the ray of a pixel so many columns to the right and rows below; beyond the border, of the nearest one.
    pub fn neighbour(&self, [right, down]: [i32; 2]) -> Option<Self> {
        let clamped = |at: u32, by: i32, size: u32| at.saturating_add_signed(by).min(size - 1);
        Ray::through(self.solids, [clamped(self.pixel[0], right, SIZE[0]), clamped(self.pixel[1], down, SIZE[1])])
    }

    /// Returns the parts between different depths, from near to far.
    pub fn spans(&self) -> Vec<Span> {
        let spans = self.hits.windows(2).map(|pair| Span { from: pair[0].depth, to: pair[1].depth });
        spans.filter(|span| span.to - span.from > EQUAL).collect()
    }

    /// Returns how many solids of these ids contain the middle of a part.
    pub fn containing(&self, span: &Span, is_meant: impl Fn(u32) -> bool) -> u32 {
        self.solids.containing([self.point[0], self.point[1], 0.5 * (span.from + span.to)], is_meant)
    }

    /// Whether a solid contains the point of a depth: whether its surface has another number of crossings before it.
    pub fn is_inside(&self, depth: f64) -> bool {
        let surface = self.hits.iter().filter(|hit| hit.triangle.is_boundary && hit.depth < depth);
        surface.count() % 2 == 1
    }

    /// Returns the hits at a depth.
    pub fn at(&self, depth: f64) -> impl Iterator<Item = &Hit<'a>> {
        self.hits.iter().filter(move |hit| (hit.depth - depth).abs() < EQUAL)
    }

    /// Returns the distance of a hit from the nearest edge of its triangle.
    pub fn edge_distance(&self, hit: &Hit<'_>) -> f64 {
        hit.triangle.edge_distances(self.position(hit.depth)).into_iter().fold(f64::INFINITY, f64::min)
    }

    /// Returns the position of a depth.
    pub fn position(&self, depth: f64) -> [f64; 3] {
        [self.point[0], self.point[1], depth]
    }
}

/// Sorts hits of equal depths by id.
fn order_equal(hits: &mut [Hit<'_>]) {
    hits.chunk_by_mut(|a, b| b.depth - a.depth < EQUAL).for_each(|equal| equal.sort_by_key(|hit| hit.triangle.id));
}

/// Returns the point of a triangle at a position of the image, if there is one. `None` outside: the position is at an edge.
fn hit(triangle: &Triangle, [x, y]: [f64; 2]) -> Option<Option<Hit<'_>>> {
    let [a, b, c] = triangle.corners;
    let area = |p: [f64; 3], q: [f64; 3], r: [f64; 2]| (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]);
    let whole = area(a, b, [c[0], c[1]]);
    // A triangle that is seen from its side covers nothing.
    if whole.abs() < EQUAL {
        return Some(None);
    }
    let sides = [(b, c), (c, a), (a, b)];
    let areas = sides.map(|(p, q)| area(p, q, [x, y]) / whole);
    // The distance to a side, in pixels, on its inner side positive.
    let distances: [f64; 3] = std::array::from_fn(|i| {
        let (p, q) = sides[i];
        let [across, down] = [q[0] - p[0], q[1] - p[1]];
        areas[i] * whole.abs() / across.hypot(down) * f64::from(SIZE[0]) / 2.0
    });
    let nearest = distances.into_iter().fold(f64::INFINITY, f64::min);
    if nearest.abs() < EDGE {
        return None;
    }
    let depth = areas[0] * a[2] + areas[1] * b[2] + areas[2] * c[2];
    Some((nearest > 0.0).then_some(Hit { depth, triangle }))
}
