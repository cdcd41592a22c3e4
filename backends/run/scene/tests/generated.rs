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
        "no scene `builtin:bunny`: the scenes are cubes, slabs, layers, marbles, hairball, needles, slivers, tets, particles, part, building, knot"
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

/// Returns the triangles of an object by their positions.
fn triangles(object: &fragbuf_scene::Object) -> Vec<[[f32; 3]; 3]> {
    object.triangles.iter().map(|corners| corners.map(|index| object.positions[index as usize])).collect()
}

/// Returns the volume within triangles whose front side is outside.
fn volume(triangles: &[[[f32; 3]; 3]]) -> f64 {
    let one = |[a, b, c]: &[[f32; 3]; 3]| {
        let [a, b, c] = [a, b, c].map(|point| point.map(f64::from));
        a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0])
    };
    triangles.iter().map(one).sum::<f64>() / 6.0
}

/// Checks that every edge belongs to two triangles, once in each direction: the triangles are closed, and have one orientation.
fn assert_closed(triangles: &[[[f32; 3]; 3]], what: &str) {
    let mut edges = std::collections::BTreeMap::new();
    let key = |point: [f32; 3]| point.map(|axis| (axis + 0.0).to_bits());
    for [a, b, c] in triangles {
        for (from, to) in [(a, b), (b, c), (c, a)] {
            *edges.entry((key(*from), key(*to))).or_insert(0) += 1;
        }
    }
    let is_matched = |((from, to), count): (&([u32; 3], [u32; 3]), &i32)| edges.get(&(*to, *from)) == Some(count);
    assert!(edges.iter().all(is_matched), "{what}");
}

#[test]
fn tets_are_the_faces_of_a_body_with_a_scalar() {
    let attribute = |name: &str, components: usize, is_integer: bool| fragbuf_scene::AttributeRequest {
        name: name.to_owned(),
        components,
        is_integer,
        is_optional: false,
    };
    let requests =
        [attribute("boundary", 1, true), attribute("Scalar", 1, false), attribute("scalar_gradient", 3, false)];
    for (name, body) in [("tets,n=8", 1.37), ("tets,n=8,hole=0", 4.19)] {
        let made =
            fragbuf_scene::open_with(&format!("builtin:{name}"), [1.0; 4], &requests, &Limits::default()).unwrap();
        let [object] = made.objects.as_slice() else { panic!("{name}") };
        let [boundary, scalar, gradient] = object.attributes.as_slice() else { panic!("{name}") };
        assert_eq!((boundary.len(), gradient.len()), (object.positions.len(), 3 * object.positions.len()));
        let scalars: Vec<f32> = scalar.iter().map(|word| f32::from_bits(*word)).collect();
        assert!(scalars.iter().all(|value| (0.0..=1.0).contains(value)) && scalars.contains(&1.0), "{name}");
        assert!(gradient.iter().any(|word| f32::from_bits(*word).abs() > 0.5), "{name}");
        // All corners of a triangle are of the surface, or none is.
        let (surface, inside): (Vec<[u32; 3]>, Vec<[u32; 3]>) =
            object.triangles.iter().partition(|corners| boundary[corners[0] as usize] == 1);
        let is = |corners: &[u32; 3], value: u32| corners.iter().all(|index| boundary[*index as usize] == value);
        assert!(surface.iter().all(|corners| is(corners, 1)) && inside.iter().all(|corners| is(corners, 0)), "{name}");
        assert!(inside.len() > surface.len(), "{name}");
        let surface = triangles(&fragbuf_scene::Object { triangles: surface, ..object.clone() });
        assert_closed(&surface, name);
        assert!((0.85..1.0).contains(&(volume(&surface) / body)), "{name}: {}", volume(&surface));
    }
    let missing =
        fragbuf_scene::open_with("builtin:tets", [1.0; 4], &[attribute("heat", 1, false)], &Limits::default());
    assert!(matches!(missing, Err(Error::MissingAttribute { available, .. }) if available.len() == 3));
    let limits = Limits { memory: 1 << 20, ..Limits::default() };
    let large = open("builtin:tets,n=48", [1.0; 4], &limits);
    assert!(matches!(large, Err(Error::TooLarge { .. })), "{large:?}");
}

/// The front side of each triangle is where its normals point, and bodies are closed.
#[test]
fn bodies_are_closed_with_their_front_outside() {
    for name in ["cubes", "marbles,n=4", "particles,n=20", "part", "part,sides=8", "building,storeys=2,rooms=3"] {
        for object in scene(name).objects {
            let of = triangles(&object);
            if !name.starts_with("building") && !name.starts_with("marbles") {
                assert_closed(&of, &format!("{name}: {}", object.name));
                assert!(volume(&of) > 0.0, "{name}: {}", object.name);
            }
            for (corners, [a, b, c]) in object.triangles.iter().zip(&of) {
                let [a, b, c] = [a, b, c].map(|point| glam::Vec3::from_array(*point));
                let front = (b - a).cross(c - a).normalize_or_zero();
                let is_front = |index: u32| front.dot(object.normals[index as usize].into()) > 0.5;
                assert!(corners.iter().all(|index| is_front(*index)), "{name}: {}", object.name);
            }
        }
    }
    // The volumes of the block and of the slot.
    let part = scene("part");
    let volumes: Vec<f64> = part.objects.iter().map(|object| volume(&triangles(object))).collect();
    assert!((volumes[0] - 2.25).abs() < 1.0e-6 && (volumes[4] - 0.052).abs() < 1.0e-6, "{volumes:?}");
}

#[test]
fn particles_have_a_scalar_a_centre_and_a_radius() {
    let attribute = |name: &str, components: usize| fragbuf_scene::AttributeRequest {
        name: name.to_owned(),
        components,
        is_integer: false,
        is_optional: false,
    };
    let requests = [attribute("scalar", 1), attribute("radius", 1), attribute("centre", 3)];
    let made = fragbuf_scene::open_with("builtin:particles,n=50", [1.0; 4], &requests, &Limits::default()).unwrap();
    assert_eq!(made.objects.len(), 50);
    for object in &made.objects {
        for (index, position) in object.positions.iter().enumerate() {
            let number = |attribute: usize, at: usize| f32::from_bits(object.attributes[attribute][at]);
            let offset: f32 = (0..3).map(|axis| (position[axis] - number(2, 3 * index + axis)).powi(2)).sum();
            assert!((offset.sqrt() - number(1, index)).abs() < 1.0e-5);
            assert!((0.0..=1.0).contains(&number(0, index)));
        }
    }
}

/// Rooms share the planes of their walls: opposite triangles of neighbours have equal corners.
#[test]
fn walls_of_a_building_lie_in_shared_planes() {
    let made = scene("building,storeys=3,rooms=4");
    assert_eq!(made.objects.len(), 48);
    let mut found = std::collections::BTreeMap::new();
    for mut corners in made.objects.iter().flat_map(triangles) {
        corners.sort_by(|a, b| a.partial_cmp(b).unwrap());
        *found.entry(corners.map(|point| point.map(|axis| (axis + 0.0).to_bits()))).or_insert(0) += 1;
    }
    // Walls inside: 3 per row of 4 rooms in both directions, and 2 floors between 3 storeys.
    let inside = 2 * (3 * 4 * 3 * 2 + 2 * 16);
    assert_eq!(found.values().filter(|count| **count == 2).count(), inside);
}
