//! The example `material` renders the image that rays through the centres of pixels give, whatever the technique and the order of
//! the objects.

use std::collections::BTreeSet;

use fragbuf::{Form, Registry, Request, generate, parse, target};
use fragbuf_runtime::headless::Choice;
use fragbuf_runtime::{PoolSize, Sizing, wgpu};

#[path = "../examples/material/main.rs"]
#[allow(dead_code, reason = "an example has a `main`")]
mod example;

use example::scene::{self, Vertex};
use example::{BACKGROUND, NEAR, Picture, render};

const SIZE: (u32, u32) = (120, 90);

/// The centre of a pixel, and points around it. A driver may move vertices by 1/256 of a pixel.
const POINTS: [(f64, f64); 5] = [(0.5, 0.5), (0.46, 0.46), (0.54, 0.46), (0.46, 0.54), (0.54, 0.54)];

/// The surface at one depth of a ray.
#[derive(Clone, Copy)]
struct Layer {
    depth: f64,
    object: usize,
    color: [f64; 4],
}

/// The layers of a ray, nearest first.
type Ray = Vec<Layer>;

#[test]
fn a_material_of_the_host_gives_the_image_of_rays_in_every_order() {
    let rays = rays();
    let certain: Vec<(usize, &Ray)> =
        rays.iter().enumerate().filter_map(|(n, rays)| Some((n, certain(rays)?))).collect();
    let covered = |count: usize| certain.iter().filter(|(_, ray)| ray.len() >= count).count();
    assert!(certain.len() > 9 * rays.len() / 10 && covered(1) > 4000 && covered(4) > 500, "{} pixels", certain.len());
    // The objects intersect: either is nearer in some pixels, so no order of objects gives this image by blending.
    for (a, b) in [(0, 1), (1, 2), (2, 0)] {
        let is_before = |ray: &Ray, a, b| ray.windows(2).any(|pair| (pair[0].object, pair[1].object) == (a, b));
        let count = |a, b| certain.iter().filter(|(_, ray)| is_before(ray, a, b)).count();
        assert!(count(a, b) > 50 && count(b, a) > 50, "objects {a} and {b}");
    }
    for (technique, sizing) in [
        ("kplus_array", Sizing::Auto),
        ("ab_sb", Sizing::Auto),
        ("ab_ll", Sizing::Auto),
        // The first frame loses fragments.
        ("ab_ll", Sizing::Reserve(PoolSize::Fragments(100))),
    ] {
        for order in [[0, 1, 2], [2, 1, 0], [1, 2, 0]] {
            let picture = Picture { technique, device: Choice::Cpu, size: SIZE, sizing, order };
            let image = render(&picture).unwrap_or_else(|error| panic!("{technique}: {error}"));
            for (number, ray) in &certain {
                let (found, expected) = (image[*number], blended(ray));
                let error = (0..3).map(|c| (f64::from(found[c]) - expected[c]).abs()).fold(0.0, f64::max);
                let (x, y) = (*number as u32 % SIZE.0, *number as u32 / SIZE.0);
                assert!(error < 2.0 / 255.0, "{technique}, {order:?}, pixel {x}, {y}: {found:?}, not {expected:?}");
            }
        }
    }
}

/// A technique without a module form is an error with a reason.
#[test]
fn a_technique_without_a_module_form_is_an_error() {
    let picture =
        Picture { technique: "z_buffer", device: Choice::Cpu, size: SIZE, sizing: Sizing::Auto, order: [0, 1, 2] };
    let error = render(&picture).unwrap_err().to_string();
    assert!(error.contains("`storage: depth_tested` requires generated entry points"), "{error}");
}

/// Returns the ray of the centre, if it meets the same objects in the same order as the rays around it, and no more layers than
/// `kplus_array` keeps.
fn certain(rays: &[Ray; 5]) -> Option<&Ray> {
    let objects = |ray: &Ray| ray.iter().map(|layer| layer.object).collect::<Vec<_>>();
    (rays.iter().all(|ray| objects(ray) == objects(&rays[0])) && rays[0].len() <= 8).then_some(&rays[0])
}

/// Blends layers over the background.
fn blended(ray: &Ray) -> [f64; 3] {
    let mut through = 1.0;
    let mut sum = [0.0; 3];
    for Layer { color: [r, g, b, a], .. } in ray {
        sum = std::array::from_fn(|c| sum[c] + through * a * [r, g, b][c]);
        through *= 1.0 - a;
    }
    let wgpu::Color { r, g, b, .. } = BACKGROUND;
    std::array::from_fn(|c| sum[c] + through * [r, g, b][c])
}

/// Returns the rays of every pixel.
fn rays() -> Vec<[Ray; 5]> {
    let mut rays = vec![<[Ray; 5]>::default(); (SIZE.0 * SIZE.1) as usize];
    let matrix = scene::view_projection(SIZE).to_cols_array_2d().map(|column| column.map(f64::from));
    for (object, vertices) in scene::objects().iter().enumerate() {
        for triangle in vertices.chunks_exact(3) {
            let corner = |corner: usize| clip(&matrix, &triangle[corner]);
            let corners = [corner(0), corner(1), corner(2)];
            for (x, y) in pixels(&corners) {
                for (point, ray) in POINTS.iter().zip(&mut rays[(y * SIZE.0 + x) as usize]) {
                    let at = (f64::from(x) + point.0, f64::from(y) + point.1);
                    ray.extend(hit(&corners, triangle, at).map(|(depth, color)| Layer { depth, object, color }));
                }
            }
        }
    }
    for ray in rays.iter_mut().flatten() {
        ray.retain(|layer| layer.depth > f64::from(NEAR));
        ray.sort_by(|a, b| a.depth.total_cmp(&b.depth));
    }
    rays
}

/// Returns the clip-space position of a vertex.
fn clip(matrix: &[[f64; 4]; 4], vertex: &Vertex) -> [f64; 4] {
    let position = [f64::from(vertex[0]), f64::from(vertex[1]), f64::from(vertex[2]), 1.0];
    std::array::from_fn(|row| (0..4).map(|column| matrix[column][row] * position[column]).sum())
}

/// Returns the pixels of the rectangle around a triangle. All vertices are in front of the camera.
fn pixels(corners: &[[f64; 4]; 3]) -> impl Iterator<Item = (u32, u32)> {
    let (width, height) = (f64::from(SIZE.0), f64::from(SIZE.1));
    let range = |positions: [f64; 3], end: u32| {
        let low = positions.into_iter().fold(f64::INFINITY, f64::min) - 1.0;
        let high = positions.into_iter().fold(0.0, f64::max) + 1.0;
        low.max(0.0) as u32..(high as u32 + 1).min(end)
    };
    let columns = range(corners.map(|[x, _, _, w]| (x / w + 1.0) / 2.0 * width), SIZE.0);
    let rows = range(corners.map(|[_, y, _, w]| (1.0 - y / w) / 2.0 * height), SIZE.1);
    rows.flat_map(move |y| columns.clone().map(move |x| (x, y)))
}

/// Returns depth and colour where the ray through a point of the image meets a triangle.
fn hit(corners: &[[f64; 4]; 3], triangle: &[Vertex], (x, y): (f64, f64)) -> Option<(f64, [f64; 4])> {
    let (x, y) = (2.0 * x / f64::from(SIZE.0) - 1.0, 1.0 - 2.0 * y / f64::from(SIZE.1));
    // The weights of the corners are those with which x / w and y / w are the point's.
    let u = corners.map(|corner| corner[0] - x * corner[3]);
    let v = corners.map(|corner| corner[1] - y * corner[3]);
    let weights = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
    let sum: f64 = weights.iter().sum();
    let weights = weights.map(|weight| weight / sum);
    if !weights.iter().all(|weight| *weight >= 0.0) {
        return None;
    }
    let of = |values: [f64; 3]| (0..3).map(|corner| weights[corner] * values[corner]).sum::<f64>();
    let depth = of(corners.map(|corner| corner[2])) / of(corners.map(|corner| corner[3]));
    let input = |number: usize| of([0, 1, 2].map(|corner| f64::from(triangle[corner][number])));
    Some((depth, shaded(std::array::from_fn(input))))
}

/// Returns the colour of a point of a surface: Lambert shading of stripes.
fn shaded([_, y, _, nx, ny, nz, r, g, b, a]: [f64; 10]) -> [f64; 4] {
    let [lx, ly, lz, ambient] = scene::LIGHT.map(f64::from);
    let length = (nx * nx + ny * ny + nz * nz).sqrt();
    let lambert = (nx * lx + ny * ly + nz * lz).abs() / length;
    let light = (ambient + (1.0 - ambient) * lambert) * (0.75 + 0.25 * (16.0 * y).sin());
    [r * light, g * light, b * light, a]
}

/// The chapter's table has every geometry pass of a technique in module form, with its function.
#[test]
fn the_guide_names_every_geometry_pass() {
    let registry = Registry::builtin();
    let targets = [target("wgsl-native").unwrap()];
    let request = Request { targets: &targets, form: Form::Module, prefix: "", group: 1 };
    let techniques = registry.techniques().iter().map(|technique| format!("buffer B from {} {{ }}", technique.key));
    let culls = ["z_prepass", "occupancy"].map(|cull| format!("buffer B from kplus_array {{ keep 1; cull: {cull}; }}"));
    let mut passes = BTreeSet::new();
    for text in techniques.chain(culls) {
        let variant = parse(&text, "b.fragbuf").check(&registry).unwrap_or_else(|errors| panic!("{text}: {errors}"));
        for file in generate(&variant, &request, &registry).unwrap().files {
            let functions = file.entry_points.into_iter().filter(|(stage, _)| *stage == "module");
            passes.extend(functions.map(|(_, function)| format!("| `{}` | `{function}` | ", file.pass)));
        }
    }
    let rows = include_str!("../src/guide/material.md").lines().filter(|line| line.starts_with("| `"));
    let rows: BTreeSet<String> =
        rows.map(|row| row.splitn(4, '|').take(3).collect::<Vec<_>>().join("|") + "| ").collect();
    assert_eq!(rows, passes);
}
