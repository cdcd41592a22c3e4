//! The scene of the effects: boxes that face the camera, and a tilted octahedron, in a frame that the camera sees along z.
//!
//! Faces of the boxes have depths in common: two begin at the same depth, and one ends where another begins. Others cross at an angle.

/// The width and height of the frame. Positions in pixels are exact in clip space, because they are powers of two.
pub const SIZE: [u32; 2] = [32, 32];

/// Particles: centre and radius in clip space, and colour.
pub const BALLS: [([f64; 3], f64, [u8; 3]); 4] = [
    ([-0.3125, 0.125, 0.4], 0.38, [230, 70, 50]),
    ([0.1875, 0.25, 0.5], 0.4, [60, 180, 90]),
    ([0.0625, -0.3125, 0.45], 0.36, [50, 90, 220]),
    ([0.4375, -0.1875, 0.62], 0.35, [220, 190, 60]),
];

/// A triangle. Its corners are counter-clockwise in the image if its front faces the camera.
pub struct Triangle {
    /// In clip space, where w is 1.
    pub corners: [[f64; 3]; 3],
    /// Unit vector out of the solid.
    pub normal: [f64; 3],
    pub id: u32,
    /// Whether it is on the surface of its solid, and not between two tetrahedra of it.
    pub is_boundary: bool,
    /// Straight red, green, blue and alpha. Of equal depths, the lesser colour word is nearer, which is that of the lesser id.
    pub color: [u8; 4],
}

impl Triangle {
    /// Returns the distances of a point of the triangle from the lines through its edges, which are opposite to its corners.
    pub fn edge_distances(&self, point: [f64; 3]) -> [f64; 3] {
        std::array::from_fn(|edge| {
            let [from, to] = [self.corners[(edge + 1) % 3], self.corners[(edge + 2) % 3]];
            let along = unit(sub(to, from));
            let across = sub(sub(point, from), scale(along, dot(sub(point, from), along)));
            dot(across, across).sqrt()
        })
    }
}

/// The triangles of solids.
pub struct Solids {
    pub triangles: Vec<Triangle>,
}

impl Solids {
    /// Returns closed solids.
    pub fn closed() -> Self {
        let mut solids = Solids { triangles: Vec::new() };
        solids.aligned([3.0, 4.0, 0.25], [19.0, 21.0, 0.75], 0, [230, 70, 50, 60]);
        solids.aligned([11.0, 9.0, 0.25], [29.0, 27.0, 0.5], 1, [60, 180, 90, 90]);
        solids.aligned([6.0, 2.0, 0.0625], [15.0, 12.0, 0.25], 2, [50, 90, 220, 120]);
        solids.octahedron(
            [16.0, 17.0, 0.45],
            [[9.25, 3.0, 0.12], [-4.25, 8.75, 0.15], [3.25, -5.0, 0.33]],
            3,
            [220, 190, 60, 150],
        );
        // An object that is no operand of a boolean expression.
        solids.aligned([22.0, 3.0, 0.125], [30.0, 14.0, 0.625], 40, [150, 60, 170, 200]);
        solids
    }

    /// Returns the same solids with a sheet, behind whose surface is nothing.
    pub fn open() -> Self {
        let mut solids = Solids::closed();
        let [a, b, c, d] = [[1.0, 16.0, 0.375], [1.0, 31.0, 0.5], [14.0, 31.0, 0.625], [14.0, 16.0, 0.5]];
        // Behind the sheet, so that its front faces the camera.
        let inside = [8.0, 24.0, 1.0];
        solids.outward([a, b, c], &[inside], 4, [90, 210, 220, 180]);
        solids.outward([a, c, d], &[inside], 4, [90, 210, 220, 180]);
        solids
    }

    /// Returns two octahedra, each divided into eight tetrahedra around a point in it. A face between two of them occurs once.
    pub fn mesh() -> Self {
        let mut solids = Solids { triangles: Vec::new() };
        let axes = [[10.25, 2.0, 0.06], [-3.25, 10.75, 0.04], [2.25, -3.0, 0.17]];
        solids.tetrahedra([14.0, 15.0, 0.28], axes, 0);
        solids.tetrahedra([18.0, 16.0, 0.72], [[9.75, -4.0, 0.05], [5.25, 9.25, 0.03], [-2.75, 1.5, 0.18]], 1);
        solids
    }

    /// Returns octahedra within particles. Their corners are at quarters of pixels: some rasterisers round positions to sixteenths.
    pub fn particles() -> Self {
        let mut solids = Solids { triangles: Vec::new() };
        let pixels = |[x, y, depth]: [f64; 3]| {
            let quarter = |value: f64, size: u32| (4.0 * value * f64::from(size) / 2.0).round() / 4.0;
            [quarter(x, SIZE[0]), quarter(-y, SIZE[1]), depth]
        };
        for (id, (centre, radius, [r, g, b])) in (0..).zip(BALLS) {
            let axes =
                [[2.0, 3.0, 6.0], [3.0, -6.0, 2.0], [6.0, 2.0, -3.0]].map(|axis| pixels(scale(axis, radius / 7.0)));
            let centre = add(pixels(centre), [f64::from(SIZE[0]) / 2.0, f64::from(SIZE[1]) / 2.0, 0.0]);
            solids.octahedron(centre, axes, id, [r, g, b, 255]);
        }
        solids
    }

    fn tetrahedra(&mut self, centre: [f64; 3], axes: [[f64; 3]; 3], id: u32) {
        self.octahedron(centre, axes, id, [255; 4]);
        let tip = |bits: usize| {
            std::array::from_fn(|i| centre[i] + if bits.is_multiple_of(2) { 1.0 } else { -1.0 } * axes[bits / 2][i])
        };
        let within = [centre[0] + 1.75, centre[1] - 1.25, centre[2] + 0.03];
        for (a, b) in (0..6).flat_map(|a| (a + 1..6).map(move |b| (a, b))).filter(|(a, b)| a / 2 != b / 2) {
            self.outward([tip(a), tip(b), within], &[[16.0, 16.0, 2.0]], id, [255; 4]);
            self.triangles.last_mut().unwrap().is_boundary = false;
        }
    }

    /// Adds a box between two corners, in pixels and depths.
    fn aligned(&mut self, least: [f64; 3], most: [f64; 3], id: u32, color: [u8; 4]) {
        let corner =
            |bits: usize| std::array::from_fn(|axis| if bits >> axis & 1 == 0 { least[axis] } else { most[axis] });
        let corners: Vec<[f64; 3]> = (0..8).map(corner).collect();
        let faces = [[0, 1, 3, 2], [4, 5, 7, 6], [0, 1, 5, 4], [2, 3, 7, 6], [0, 2, 6, 4], [1, 3, 7, 5]];
        for [a, b, c, d] in faces {
            self.outward([corners[a], corners[b], corners[c]], &corners, id, color);
            self.outward([corners[a], corners[c], corners[d]], &corners, id, color);
        }
    }

    /// Adds an octahedron of three half axes.
    fn octahedron(&mut self, centre: [f64; 3], axes: [[f64; 3]; 3], id: u32, color: [u8; 4]) {
        let tip = |axis: usize, sign: f64| std::array::from_fn(|i| centre[i] + sign * axes[axis][i]);
        let tips: Vec<[f64; 3]> =
            (0..6).map(|bits| tip(bits / 2, if bits.is_multiple_of(2) { 1.0 } else { -1.0 })).collect();
        for (a, b, c) in (0..2).flat_map(|a| (2..4).flat_map(move |b| (4..6).map(move |c| (a, b, c)))) {
            self.outward([tips[a], tips[b], tips[c]], &tips, id, color);
        }
    }

    /// Adds a triangle of a convex solid, turned so that its front is outside.
    fn outward(&mut self, pixels: [[f64; 3]; 3], solid: &[[f64; 3]], id: u32, color: [u8; 4]) {
        let mut corners = pixels.map(clip);
        let count = solid.len() as f64;
        let inside = solid
            .iter()
            .map(|corner| clip(*corner))
            .fold([0.0; 3], |sum, corner| sub(sum, scale(corner, -1.0 / count)));
        let normal = unit(cross(sub(corners[1], corners[0]), sub(corners[2], corners[0])));
        let is_outward = dot(normal, sub(corners[0], inside)) > 0.0;
        // Clip space is left-handed: the cross product of corners that are counter-clockwise in the image points away from the camera.
        if is_outward {
            corners.swap(1, 2);
        }
        let normal = if is_outward { normal } else { scale(normal, -1.0) };
        self.triangles.push(Triangle { corners, normal, id, is_boundary: true, color });
    }

    /// Returns the vertices for the inputs of these names, in their order. The first is the position in clip space.
    pub fn vertices(&self, inputs: &[&str]) -> Vec<u8> {
        let mut bytes = Vec::new();
        for triangle in &self.triangles {
            for corner in triangle.corners {
                for input in inputs {
                    let mut push =
                        |values: &[f64]| bytes.extend(values.iter().flat_map(|value| (*value as f32).to_le_bytes()));
                    match *input {
                        "position" => push(&corner),
                        "color" => push(&triangle.color.map(|channel| f64::from(channel) / 255.0)),
                        "edges" => push(&triangle.edge_distances(corner)),
                        "normal" => push(&triangle.normal),
                        "centre" => push(&BALLS[triangle.id as usize].0),
                        "radius" => push(&[BALLS[triangle.id as usize].1]),
                        "id" => bytes.extend(triangle.id.to_le_bytes()),
                        "scalar" => push(&[scalar(corner)]),
                        "scalar_gradient" => push(&gradient(corner)),
                        "boundary" => bytes.extend(u32::from(triangle.is_boundary).to_le_bytes()),
                        "front" => bytes.extend(u32::from(triangle.normal[2] < 0.0).to_le_bytes()),
                        other => panic!("no value for the attribute `{other}`"),
                    }
                }
            }
        }
        bytes
    }

    /// Returns the number of vertices.
    pub fn count(&self) -> u32 {
        3 * self.triangles.len() as u32
    }

    /// Returns how many solids of these ids contain a point: the sum of the solid angles of their triangles over that of the sphere (van
    /// Oosterom and Strackee 1983).
    pub fn containing(&self, point: [f64; 3], is_meant: impl Fn(u32) -> bool) -> u32 {
        let angle = |triangle: &Triangle| {
            let [a, b, c] = triangle.corners.map(|corner| sub(corner, point));
            let [la, lb, lc] = [a, b, c].map(|side| dot(side, side).sqrt());
            let volume = dot(a, cross(b, c));
            2.0 * volume.atan2(la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb)
        };
        let sum: f64 = self.triangles.iter().filter(|triangle| is_meant(triangle.id)).map(angle).sum();
        let number = -sum / (4.0 * std::f64::consts::PI);
        assert!((number - number.round()).abs() < 1e-6 && number > -0.5, "winding number {number} at {point:?}");
        number.round() as u32
    }
}

/// Returns the scalar of a vertex of a mesh, from 0 to 1. Between vertices it is linear.
pub fn scalar([x, y, depth]: [f64; 3]) -> f64 {
    0.5 + 0.45 * (5.0 * x + 1.0).sin() * (4.0 * y - 9.0 * depth).cos()
}

/// Returns the gradient of a vertex of a mesh. Tests need no true one.
pub fn gradient([x, y, depth]: [f64; 3]) -> [f64; 3] {
    [0.3 + x, 0.8 - y, 0.2 - 3.0 * depth]
}

/// Returns the position in clip space of one in pixels.
fn clip([x, y, depth]: [f64; 3]) -> [f64; 3] {
    [2.0 * x / f64::from(SIZE[0]) - 1.0, 1.0 - 2.0 * y / f64::from(SIZE[1]), depth]
}

pub fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|i| a[i] * b[i]).sum()
}

pub fn sub(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|i| a[i] - b[i])
}

pub fn add(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|i| a[i] + b[i])
}

pub fn scale(a: [f64; 3], factor: f64) -> [f64; 3] {
    a.map(|value| factor * value)
}

pub fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

pub fn unit(a: [f64; 3]) -> [f64; 3] {
    scale(a, 1.0 / dot(a, a).sqrt())
}
