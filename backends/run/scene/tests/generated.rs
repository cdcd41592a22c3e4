//! Generated scenes, cameras and light.
#![allow(missing_docs, reason = "tests are read, not documented")]
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

use fragbuf_scene::{BUILTIN_SCENES, Camera, Error, Eye, Limits, Scene, light, open};

fn scene(name: &str) -> Scene {
    open(&format!("builtin:{name}"), [1.0; 4], &Limits::default()).unwrap()
}

#[test]
fn every_scene_is_valid_and_deterministic() {
    for row in BUILTIN_SCENES {
        let name = if row.name == "hairball" { "hairball,strands=20" } else { row.name };
        let made = scene(name);
        assert_eq!(made, scene(name));
        for object in &made.objects {
            assert!(object.normals.len() == object.positions.len() && object.colors.len() == object.positions.len());
            assert!(object.triangles.iter().flatten().all(|index| (*index as usize) < object.positions.len()));
            assert!(object.positions.iter().flatten().all(|value| value.is_finite()));
            assert!(object.normals.iter().all(|[x, y, z]| (x * x + y * y + z * z - 1.0).abs() < 1.0e-4), "{name}");
            assert!(object.colors.iter().flatten().all(|value| (0.0..=1.0).contains(value)));
        }
    }
    assert_ne!(scene("slabs"), scene("slabs,seed=2"));
    assert_eq!(scene("slabs,n=5").objects.len(), 5);
}

#[test]
fn the_hairball_has_over_two_million_triangles() {
    let made = scene("hairball");
    assert!(made.triangles() > 2_000_000, "{}", made.triangles());
}

/// Layers cover the whole frame, and each is a plane within clip space.
#[test]
fn layers_are_planes_over_the_frame() {
    let made = scene("layers,n=200");
    assert_eq!((made.objects.len(), made.triangles()), (200, 400));
    for object in &made.objects {
        let [a, b, c, d] = object.positions[..] else { panic!("{object:?}") };
        assert_eq!([a, b, c, d].map(|[x, y, _]| (x, y)), [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]);
        assert!((a[2] + c[2] - b[2] - d[2]).abs() < 1.0e-6, "{object:?}");
        assert!([a, b, c, d].iter().all(|[_, _, z]| (0.0..=1.0).contains(z)), "{object:?}");
    }
    // The order of depths differs between corners.
    let order = |corner: usize| {
        let mut order: Vec<usize> = (0..200).collect();
        order.sort_by(|a, b| made.objects[*a].positions[corner][2].total_cmp(&made.objects[*b].positions[corner][2]));
        order
    };
    assert_ne!(order(0), order(2));
}

/// About so many per cent of the strips are two triangles; the others have cells as wide as a row. Layers are parallel planes in their order.
#[test]
fn slivers_are_long_and_do_not_intersect() {
    let made = scene("slivers,n=20,rows=10,long=30");
    assert_eq!(made.objects.len(), 20);
    let long = |object: &fragbuf_scene::Object| {
        let width = |triangle: &&[u32; 3]| {
            let x = triangle.map(|corner| object.positions[corner as usize][0]);
            x.iter().fold(-1.0_f32, |a, b| a.max(*b)) - x.iter().fold(1.0_f32, |a, b| a.min(*b))
        };
        assert!(
            object.triangles.iter().all(|triangle| [0.2, 2.0].iter().any(|w| (width(&triangle) - w).abs() < 1.0e-5))
        );
        object.triangles.iter().filter(|triangle| width(triangle) > 1.0).count() / 2
    };
    let longs: usize = made.objects.iter().map(long).sum();
    assert!((40..80).contains(&longs), "{longs} of 200");
    assert_eq!(made.triangles(), 2 * longs + 20 * (200 - longs));
    let offset = |object: &fragbuf_scene::Object| {
        let offsets: Vec<f32> = object.positions.iter().map(|[x, _, z]| z - x).collect();
        assert!(offsets.iter().all(|offset| (offset - offsets[0]).abs() < 1.0e-5));
        offsets[0]
    };
    let offsets: Vec<f32> = made.objects.iter().map(offset).collect();
    assert!(offsets.windows(2).all(|pair| pair[0] < pair[1] - 0.01), "{offsets:?}");
    assert_eq!(scene("slivers,n=3,rows=4,long=0").triangles(), 3 * 4 * 8);
}

/// Every needle spans most of the depth of the scene, and their directions differ by a few degrees.
#[test]
fn needles_are_long_thin_and_nearly_parallel() {
    let made = scene("needles,n=50");
    assert_eq!((made.objects.len(), made.triangles()), (50, 150));
    let direction = |object: &fragbuf_scene::Object| {
        let [blunt, _, tip] = object.triangles[0].map(|corner| object.positions[corner as usize]);
        [0, 1, 2].map(|axis| tip[axis] - blunt[axis])
    };
    let dot = |a: [f32; 3], b: [f32; 3]| (0..3).map(|axis| a[axis] * b[axis]).sum::<f32>();
    let first = direction(&made.objects[0]);
    for object in &made.objects {
        let direction = direction(object);
        assert!((dot(direction, direction).sqrt() - 2.4).abs() < 0.05 && direction[2].abs() > 1.5, "{direction:?}");
        assert!(
            dot(direction, first).abs() / (dot(direction, direction) * dot(first, first)).sqrt() > 0.95,
            "{direction:?}"
        );
    }
}

#[test]
fn unknown_names_list_the_known_ones() {
    let error = |name: &str| match open(name, [1.0; 4], &Limits::default()) {
        Err(Error::Unknown(message)) => message,
        other => format!("{other:?}"),
    };
    assert_eq!(
        error("builtin:bunny"),
        "no scene `builtin:bunny`: the scenes are cubes, slabs, layers, marbles, hairball, needles, slivers, knot"
    );
    assert_eq!(error("builtin:slabs,k=3"), "`builtin:slabs` has no `k`: its parameters are n (16), seed (1)");
    let advice = "write a whole number from 1 to 65536, as `n=16`";
    assert_eq!(error("builtin:slabs,n=0"), format!("`builtin:slabs`: `n` has `0`: {advice}"));
    assert_eq!(error("builtin:slabs,n"), format!("`builtin:slabs`: `n` has no value: {advice}"));
    assert_eq!(error("builtin:cubes,n=3"), "`builtin:cubes` has no `n`: it has no parameters");
}

fn project(matrix: &[f32; 16], [x, y, z]: [f32; 3]) -> [f32; 3] {
    let row = |row: usize| matrix[row] * x + matrix[4 + row] * y + matrix[8 + row] * z + matrix[12 + row];
    [row(0) / row(3), row(1) / row(3), row(2) / row(3)]
}

#[test]
fn the_framing_camera_shows_the_whole_scene_at_full_size() {
    for name in ["cubes", "slabs", "marbles", "knot", "hairball,strands=9", "needles,n=40"] {
        for aspect in [0.3, 1.0, 2.5] {
            let made = scene(name);
            let camera = Camera::framing(&[&made], aspect);
            let mut reach = 0.0_f32;
            for position in made.objects.iter().flat_map(|object| &object.positions) {
                let [x, y, z] = project(&camera.view_projection, *position);
                assert!(x.abs() <= 1.0 && y.abs() <= 1.0 && (0.0..=1.0).contains(&z), "{name} {aspect}: {x} {y} {z}");
                reach = reach.max(x.abs()).max(y.abs());
            }
            assert!(reach > 0.9, "{name} {aspect}: {reach}");
        }
    }
}

#[test]
fn light_comes_from_the_eye_and_is_two_sided() {
    let mut made = scene("slabs,n=1");
    let unlit = made.objects[0].colors[0];
    light(&mut made, Eye::Along([0.0, 0.0, 1.0]));
    assert_eq!(made.objects[0].colors[0], unlit);
    light(&mut made, Eye::Along([1.0, 0.0, 0.0]));
    assert!((made.objects[0].colors[0][0] - 0.2 * unlit[0]).abs() < 1.0e-6);
    assert_eq!(made.objects[0].colors[0][3], unlit[3]);
}
