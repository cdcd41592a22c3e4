//! The order of triangles by centroids, and the subdivision of long ones.
#![allow(missing_docs, reason = "tests are read, not documented")]
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

use std::collections::{BTreeMap, BTreeSet};

use fragbuf_scene::{AttributeRequest, Camera, DepthOrder, Limits, Object, Scene, TriangleId, open};

fn scene(name: &str) -> Scene {
    open(&format!("builtin:{name}"), [1.0; 4], &Limits::default()).unwrap()
}

type Point = [f32; 3];

/// Returns the corners of the triangles in the order of the scene.
fn corners(scene: &Scene) -> Vec<[Point; 3]> {
    let of = |object: &Object| {
        let corner = |index: u32| object.positions[index as usize];
        object.triangles.iter().map(|triangle| triangle.map(corner)).collect::<Vec<_>>()
    };
    scene.objects.iter().flat_map(of).collect()
}

fn area([a, b, c]: &[Point; 3]) -> f64 {
    let [a, b, c] = [a, b, c].map(|point| glam::Vec3::from_array(*point).as_dvec3());
    0.5 * (b - a).cross(c - a).length()
}

/// Returns the length of the longest edge over the height on it.
fn aspect(triangle: &[Point; 3]) -> f64 {
    let [a, b, c] = triangle.map(|point| glam::Vec3::from_array(point).as_dvec3());
    let longest = a.distance(b).max(b.distance(c)).max(c.distance(a));
    longest * longest / (2.0 * area(triangle))
}

/// Returns how many triangles each edge has, by the positions of its ends.
fn edges(scene: &Scene) -> BTreeMap<BTreeSet<[u32; 3]>, u32> {
    let mut edges = BTreeMap::new();
    for [a, b, c] in corners(scene) {
        for ends in [[a, b], [b, c], [c, a]] {
            *edges.entry(ends.map(|end| end.map(f32::to_bits)).into()).or_default() += 1;
        }
    }
    edges
}

#[test]
fn triangles_are_ordered_by_the_depth_of_their_centroids() {
    for (name, camera) in [("cubes", "orbit"), ("slivers,n=3", "orbit"), ("layers,n=9", "clip")] {
        let mut made = scene(name);
        let camera = match camera {
            "clip" => Camera::clip(),
            _ => Camera::orbit(&[&made], 1.5, [40.0, 20.0], 50.0),
        };
        let objects = made.objects.clone();
        // The distance along the view, from the fourth row of the matrix; for `clip` z itself.
        let m = camera.view_projection.map(f64::from);
        let row = if camera == Camera::clip() { 2 } else { 3 };
        let depth = |id: &TriangleId| -> f64 {
            let object = &made.objects[id.object as usize];
            let triangle = object.triangles[id.triangle as usize];
            let points = triangle.map(|corner| object.positions[corner as usize].map(f64::from));
            points.iter().map(|[x, y, z]| m[row] * x + m[4 + row] * y + m[8 + row] * z + m[12 + row]).sum::<f64>() / 3.0
        };
        let mut orders = Vec::new();
        for first in [DepthOrder::NearestFirst, DepthOrder::FarthestFirst] {
            let mut sorted = made.clone();
            sorted.presort(&camera, first);
            let ids: BTreeSet<TriangleId> = sorted.order.iter().copied().collect();
            assert!(ids.len() == sorted.order.len() && ids.len() == made.triangles(), "{name}: each triangle once");
            let sign = if first == DepthOrder::NearestFirst { 1.0 } else { -1.0 };
            let depths: Vec<f64> = sorted.order.iter().map(|id| sign * depth(id)).collect();
            assert!(depths.windows(2).all(|pair| pair[0] <= pair[1] + 1.0e-5), "{name}, {first:?}");
            orders.push(sorted.order);
            assert_eq!(sorted.objects, objects, "{name}: objects and their ids stay");
        }
        assert_ne!(orders[0], orders[1]);
        made.presort(&camera, DepthOrder::NearestFirst);
        let again = made.order.clone();
        made.presort(&camera, DepthOrder::NearestFirst);
        assert_eq!(made.order, again);
    }
}

/// Triangles at the same place keep the order of the model in both directions.
#[test]
fn equal_centroids_keep_their_order() {
    let mut made = scene("layers,n=2,coplanar=5");
    for first in [DepthOrder::NearestFirst, DepthOrder::FarthestFirst] {
        made.presort(&Camera::clip(), first);
        // The quads of a plane are five objects of two triangles, one above and one below the diagonal.
        for plane in [0..5, 5..10] {
            for triangle in [0, 1] {
                let of = made.order.iter().filter(|id| id.triangle == triangle && plane.contains(&id.object));
                let objects: Vec<u32> = of.map(|id| id.object).collect();
                assert_eq!(objects, plane.clone().collect::<Vec<_>>(), "{first:?}");
            }
        }
    }
}

#[test]
fn subdivision_keeps_the_surface_and_the_budget() {
    for (name, ratios) in [
        ("slivers,n=2,rows=8,long=50", [1.0, 1.25, 2.0, 4.0, 7.5]),
        ("needles,n=40", [1.0, 1.3, 2.0, 5.0, 9.0]),
        ("marbles,n=3", [1.0, 1.01, 1.5, 2.0, 3.0]),
    ] {
        let made = scene(name);
        let whole: f64 = corners(&made).iter().map(area).sum();
        for ratio in ratios {
            let mut divided = made.clone();
            divided.subdivide(ratio);
            let budget = (made.triangles() as f64 * ratio).floor() as usize;
            assert_eq!(made.triangle_budget(ratio), budget as u64);
            let least = if ratio > 1.0 { budget - 1 } else { budget };
            assert!((least..=budget).contains(&divided.triangles()), "{name}, {ratio}: {}", divided.triangles());
            let after: f64 = corners(&divided).iter().map(area).sum();
            assert!((after - whole).abs() < 1.0e-4 * whole, "{name}, {ratio}: {after} of {whole}");
            // The poles of marbles.
            let without_area = |scene: &Scene| corners(scene).iter().filter(|triangle| area(triangle) == 0.0).count();
            assert_eq!(without_area(&divided), without_area(&made), "{name}, {ratio}");
            // The vertices of the model are where they were.
            for (before, after) in made.objects.iter().zip(&divided.objects) {
                assert_eq!(before.positions, after.positions[..before.positions.len()]);
                assert_eq!(before.colors, after.colors[..before.colors.len()]);
                assert!(after.normals.len() == after.positions.len() && after.colors.len() == after.positions.len());
            }
            assert!(divided.bytes() <= made.subdivision_bytes(ratio), "{name}, {ratio}");
        }
    }
}

/// Long triangles become shorter, and compact ones stay while there are long ones.
#[test]
fn long_triangles_are_divided_first() {
    let made = scene("slivers,n=4,rows=12,long=20");
    // The mean over the surface.
    let long = |scene: &Scene| -> f64 {
        let weighted = |triangle: &[Point; 3]| area(triangle) * (2.0 * area(triangle) * aspect(triangle)).sqrt();
        corners(scene).iter().map(weighted).sum::<f64>() / corners(scene).iter().map(area).sum::<f64>()
    };
    // The cells as they are modelled.
    let cells: BTreeSet<String> =
        corners(&made).iter().filter(|triangle| aspect(triangle) < 4.0).map(|cell| format!("{cell:?}")).collect();
    let mut before = long(&made);
    for ratio in [1.1, 1.2, 1.3] {
        let mut divided = made.clone();
        divided.subdivide(ratio);
        let after = long(&divided);
        assert!(after < before, "{ratio}: {after} after {before}");
        before = after;
        let left = corners(&divided).iter().filter(|cell| cells.contains(&format!("{cell:?}"))).count();
        assert!(cells.len() > 500 && left == cells.len(), "{ratio}: {left} of {}", cells.len());
    }
    assert!(before < 0.6 * long(&made), "{before} of {}", long(&made));
}

/// In a closed surface every edge has two triangles, before and after: there is no T-junction.
#[test]
fn a_closed_surface_stays_closed() {
    let mut made = scene("cubes");
    // Stretched, so that there is something to divide.
    made.objects.iter_mut().flat_map(|object| &mut object.positions).for_each(|[x, ..]| *x *= 9.0);
    assert!(edges(&made).values().all(|count| *count == 2));
    for ratio in [1.1, 1.7, 3.0, 20.0] {
        let mut divided = made.clone();
        divided.subdivide(ratio);
        assert!(divided.triangles() > made.triangles());
        let open: Vec<_> = edges(&divided).into_iter().filter(|(_, count)| *count != 2).collect();
        assert!(open.is_empty(), "{ratio}: {open:?}");
    }
}

/// Copies of a surface have the same vertices afterwards, so that their fragments have equal depths as before.
#[test]
fn copies_are_divided_alike() {
    let mut made = scene("layers,n=1,coplanar=6");
    made.subdivide(4.0);
    let of = |object: &Object| {
        object.triangles.iter().flatten().map(|at| object.positions[*at as usize].map(f32::to_bits)).collect()
    };
    let positions: Vec<BTreeSet<[u32; 3]>> = made.objects.iter().map(of).collect();
    assert!(positions[0].len() > 4 && positions.iter().all(|other| *other == positions[0]), "{positions:?}");
    // An edge of six triangles is too much for a budget of two more.
    let mut small = scene("layers,n=1,coplanar=6");
    small.subdivide(14.5 / 12.0);
    assert_eq!(small.triangles(), 12);
}

/// Attributes that are linear over a triangle are linear over its parts; integers are those of the first vertex of the triangle.
#[test]
fn attributes_are_interpolated() {
    let linear = |[x, y, z]: Point, scale: f32| scale * (0.1 + 0.2 * x - 0.3 * y + 0.05 * z);
    let positions: Vec<Point> = vec![[0.0, 0.0, 0.0], [8.0, 0.5, 1.0], [0.2, 1.0, -1.0], [7.0, 3.0, 2.0]];
    let request = |name: &str, components, is_integer| AttributeRequest {
        name: name.to_owned(),
        components,
        is_integer,
        is_optional: false,
    };
    let colors = positions.iter().map(|at| [1.0, 2.0, 3.0, 4.0].map(|scale| linear(*at, scale))).collect();
    let heat = positions.iter().flat_map(|at| [linear(*at, 5.0).to_bits(), linear(*at, -6.0).to_bits()]).collect();
    let object = Object {
        name: String::new(),
        normals: vec![[0.0, 0.0, 1.0]; 4],
        colors,
        attributes: vec![heat, vec![10, 20, 30, 40]],
        triangles: vec![[0, 1, 2], [3, 2, 1]],
        positions,
    };
    let attributes = vec![request("heat", 2, false), request("part", 1, true)];
    let mut made = Scene { objects: vec![object], attributes, ..Scene::default() };
    made.subdivide(20.0);
    let object = &made.objects[0];
    assert_eq!(made.triangles(), 40);
    assert!(
        object.attributes[0].len() == 2 * object.positions.len()
            && object.attributes[1].len() == object.positions.len()
    );
    let near = |a: f32, b: f32| (a - b).abs() < 1.0e-4;
    for (vertex, at) in object.positions.iter().enumerate() {
        for (channel, scale) in [1.0, 2.0, 3.0, 4.0].into_iter().enumerate() {
            assert!(near(object.colors[vertex][channel], linear(*at, scale)), "vertex {vertex}");
        }
        for (component, scale) in [5.0, -6.0].into_iter().enumerate() {
            let value = f32::from_bits(object.attributes[0][2 * vertex + component]);
            assert!(near(value, linear(*at, scale)), "vertex {vertex}");
        }
    }
    // The triangles of each half, by the side of the common edge on which their centroid is.
    let mut parts = [0, 0];
    for (index, triangle) in object.triangles.iter().enumerate() {
        let first = object.attributes[1][triangle[0] as usize];
        let points = triangle.map(|corner| object.positions[corner as usize]);
        let centroid = [0, 1, 2].map(|axis| points.iter().map(|point| point[axis]).sum::<f32>() / 3.0);
        // The edge from (8, 0.5) to (0.2, 1.0).
        let is_far = (centroid[0] - 8.0) * 0.5 + (centroid[1] - 0.5) * 7.8 > 0.0;
        assert_eq!(first, if is_far { 40 } else { 10 }, "triangle {index}: {centroid:?}");
        parts[usize::from(is_far)] += 1;
    }
    assert!(parts.iter().all(|count| *count > 1), "{parts:?}");
}

/// What cannot be divided stays: triangles without area, and those whose edges have no position between their ends.
#[test]
fn degenerate_triangles_stay() {
    let next = f32::from_bits(1.0_f32.to_bits() + 1);
    let positions: Vec<Point> =
        vec![[0.0; 3], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0], [0.0; 3], [1.0, 1.0, 1.0], [next, 1.0, 1.0], [1.0, next, 1.0]];
    let object = Object {
        normals: vec![[0.0, 0.0, 1.0]; positions.len()],
        colors: vec![[1.0; 4]; positions.len()],
        triangles: vec![[0, 1, 2], [0, 3, 1], [0, 0, 0], [4, 5, 6]],
        positions,
        ..Object::default()
    };
    let made = Scene { objects: vec![object], ..Scene::default() };
    let mut divided = made.clone();
    divided.subdivide(100.0);
    assert_eq!(divided, made);
    for ratio in [0.5, f64::NAN, -1.0] {
        divided.subdivide(ratio);
        assert_eq!(divided, made);
    }
    let mut empty = Scene::default();
    empty.subdivide(3.0);
    empty.presort(&Camera::clip(), DepthOrder::NearestFirst);
    assert_eq!(empty, Scene::default());
}
