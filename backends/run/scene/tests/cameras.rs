//! Tests of cameras: where they project known points.
#![allow(missing_docs, reason = "tests are read, not documented")]
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test fails by panicking")]

use fragbuf_scene::{Camera, CameraError, Eye, FIELD_OF_VIEW, Limits, Scene};

/// Loads an OBJ whose triangles have these corners.
fn scene(corners: &[[f64; 3]]) -> Scene {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("m.obj");
    let vertices: String = corners.iter().map(|[x, y, z]| format!("v {x:e} {y:e} {z:e}\n")).collect();
    let faces: String = (1..=corners.len()).step_by(3).map(|i| format!("f {i} {} {}\n", i + 1, i + 2)).collect();
    std::fs::write(&path, vertices + &faces).unwrap();
    fragbuf_scene::load(&path, [1.0; 4], &Limits::default()).unwrap()
}

/// Two triangles whose bounds are the cube from -1 to 1, moved and scaled.
fn cube(origin: [f64; 3], scale: f64) -> Scene {
    let corners =
        [[-1.0, -1.0, -1.0], [1.0, -1.0, -1.0], [1.0, 1.0, -1.0], [-1.0, -1.0, 1.0], [1.0, 1.0, 1.0], [-1.0, 1.0, 1.0]];
    scene(&corners.map(|corner| [0, 1, 2].map(|axis| origin[axis] + scale * corner[axis])))
}

/// Projects a point of the model: x and y from -1 to 1, the depth, and w, which is the distance along the view.
fn project(camera: &Camera, scene: &Scene, point: [f64; 3]) -> [f64; 4] {
    let matrix = camera.view_projection.map(f64::from);
    let [x, y, z] = [0, 1, 2].map(|axis| (point[axis] - scene.placement.origin[axis]) / scene.placement.unit);
    let row = |row: usize| matrix[row] * x + matrix[4 + row] * y + matrix[8 + row] * z + matrix[12 + row];
    [row(0) / row(3), row(1) / row(3), row(2) / row(3), row(3)]
}

fn looking(scene: &Scene, eye: [f64; 3], target: Option<[f64; 3]>) -> Result<Camera, CameraError> {
    Camera::looking(&[scene], 1.0, (eye, target), 90.0)
}

#[track_caller]
fn assert_near(found: &[f64], expected: &[f64]) {
    assert!(found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1.0e-4), "{found:?}, not {expected:?}");
}

#[test]
fn a_placed_camera_projects_known_points() {
    let made = cube([0.0; 3], 1.0);
    let camera = looking(&made, [0.0, 0.0, 5.0], Some([0.0; 3])).unwrap();
    assert_near(&project(&camera, &made, [0.0, 0.0, 0.0])[..2], &[0.0, 0.0]);
    // The tangent of half of 90 degrees is 1.
    assert_near(&project(&camera, &made, [5.0, 0.0, 0.0])[..2], &[1.0, 0.0]);
    assert_near(&project(&camera, &made, [0.0, 2.5, 0.0])[..2], &[0.0, 0.5]);
    assert_near(&project(&camera, &made, [2.0, 0.0, 1.0])[..2], &[0.5, 0.0]);
    // The field of view is the vertical one.
    let wide = Camera::looking(&[&made], 2.0, ([0.0, 0.0, 5.0], None), 60.0).unwrap();
    let edge = 5.0 * 30.0_f64.to_radians().tan();
    assert_near(&project(&wide, &made, [2.0 * edge, edge, 0.0])[..2], &[1.0, 1.0]);
    assert_eq!(camera.eye, Eye::At([0.0, 0.0, 5.0]));
    for corner in [[-1.0, -1.0, -1.0], [1.0, 1.0, 1.0]] {
        assert!((0.0..1.0).contains(&project(&camera, &made, corner)[2]), "near and far planes hold the scene");
    }
}

#[test]
fn points_are_those_of_the_model_wherever_it_is() {
    let points = [[0.5, 0.25, 1.0], [-1.0, 1.0, -1.0]];
    let near = cube([0.0; 3], 1.0);
    let expected = looking(&near, [2.0, 3.0, 4.0], Some([0.0, 0.5, 0.0])).unwrap();
    for (origin, scale) in [([447_000.25, 5_411_000.5, 12.0], 0.125), ([0.0; 3], 1.0e9), ([3.0e8, 0.0, 0.0], 0.01)] {
        let far = cube(origin, scale);
        let moved = |point: [f64; 3]| [0, 1, 2].map(|axis| origin[axis] + scale * point[axis]);
        let camera = looking(&far, moved([2.0, 3.0, 4.0]), Some(moved([0.0, 0.5, 0.0]))).unwrap();
        for point in points {
            let [found, expected] = [project(&camera, &far, moved(point)), project(&expected, &near, point)];
            assert_near(&found[..3], &expected[..3]);
        }
    }
}

#[test]
fn a_vertical_view_has_an_upper_edge() {
    let made = cube([0.0; 3], 1.0);
    let down = looking(&made, [0.0, 5.0, 0.0], None).unwrap();
    assert_near(&project(&down, &made, [1.0, 0.0, -1.0])[..2], &[0.2, 0.2]);
    let up = looking(&made, [0.0, -5.0, 0.0], None).unwrap();
    assert_near(&project(&up, &made, [1.0, 0.0, 1.0])[..2], &[0.2, 0.2]);
    for (elevation, z) in [(90.0, -1.0), (-90.0, 1.0)] {
        let orbit = Camera::orbit(&[&made], 1.0, [0.0, elevation], FIELD_OF_VIEW);
        let [x, y, ..] = project(&orbit, &made, [0.0, 0.0, z]);
        assert!(x.abs() < 1.0e-5 && y > 0.5, "{elevation}: {x} {y}");
    }
}

#[test]
fn an_eye_inside_of_the_scene_sees_what_is_in_front() {
    let made = cube([0.0; 3], 1.0);
    let camera = looking(&made, [0.0; 3], Some([0.0, 0.0, -1.0])).unwrap();
    let [x, y, depth, distance] = project(&camera, &made, [1.0, 1.0, -1.0]);
    assert_near(&[x, y, distance], &[1.0, 1.0, 1.0]);
    assert!((0.9..1.0).contains(&depth), "{depth}");
    assert!(project(&camera, &made, [0.0, 0.0, 1.0])[3] < 0.0, "behind the eye");
    assert!(project(&camera, &made, [0.0, 0.0, -1.0e-5])[2] < 0.0, "in front of the near plane");
    // A scene behind the eye has an image, though an empty one.
    let away = looking(&made, [0.0, 0.0, 3.0], Some([0.0, 0.0, 4.0])).unwrap();
    assert!(away.view_projection.iter().all(|value| value.is_finite()));
}

#[test]
fn cameras_without_a_view_are_errors() {
    let made = cube([0.0; 3], 1.0);
    assert_eq!(looking(&made, [1.0, 2.0, 3.0], Some([1.0, 2.0, 3.0])), Err(CameraError::NoDirection));
    assert_eq!(looking(&made, [0.0; 3], None), Err(CameraError::NoDirection), "the eye is at the centre");
    assert_eq!(looking(&made, [0.0, 0.0, 1.0e6], None), Err(CameraError::TooFar));
    assert_eq!(looking(&cube([0.0; 3], 1.0e-300), [1.0e300, 0.0, 0.0], None), Err(CameraError::TooFar));
}

#[test]
fn an_orbit_frames_the_scene_from_its_direction() {
    let made = cube([0.0; 3], 1.0);
    let points = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    // The directions in which x, y and z point in the image, and the axis that points to the eye.
    for (angles, expected, axis) in [
        ([0.0, 0.0], [[1, 0], [0, 1], [0, 0]], 2),
        ([90.0, 0.0], [[0, 0], [0, 1], [-1, 0]], 0),
        ([180.0, 0.0], [[-1, 0], [0, 1], [0, 0]], 2),
        ([-90.0, 0.0], [[0, 0], [0, 1], [1, 0]], 0),
        ([360.0, 0.0], [[1, 0], [0, 1], [0, 0]], 2),
        ([0.0, 90.0], [[1, 0], [0, 0], [0, -1]], 1),
        ([90.0, 90.0], [[0, -1], [0, 0], [-1, 0]], 1),
    ] {
        let camera = Camera::orbit(&[&made], 1.0, angles, FIELD_OF_VIEW);
        for (point, expected) in points.iter().zip(expected) {
            let [x, y, ..] = project(&camera, &made, *point);
            let sign = |value: f64| if value.abs() < 1.0e-4 { 0 } else { value.signum() as i32 };
            assert_eq!([sign(x), sign(y)], expected, "{angles:?} {point:?}: {x} {y}");
        }
        let [near, far] =
            [1.0, -1.0].map(|side: f64| project(&camera, &made, points[axis].map(|value| side * value))[3]);
        let is_negative = matches!(angles, [180.0, 0.0] | [-90.0, 0.0]);
        assert_eq!(near > far, is_negative, "{angles:?}: {near} {far}");
    }
    for (azimuth, elevation, fov) in [(30.0, 20.0, 40.0), (200.0, -70.0, 10.0), (-45.0, 90.0, 120.0), (0.0, 0.0, 0.1)] {
        for aspect in [0.5, 2.0] {
            let camera = Camera::orbit(&[&made], aspect, [azimuth, elevation], fov);
            let mut reach = 0.0_f64;
            for position in made.objects.iter().flat_map(|object| &object.positions) {
                let [x, y, z, _] = project(&camera, &made, position.map(f64::from));
                assert!(
                    x.abs() <= 1.0 && y.abs() <= 1.0 && (0.0..=1.0).contains(&z),
                    "{azimuth} {aspect}: {x} {y} {z}"
                );
                reach = reach.max(x.abs()).max(y.abs());
            }
            assert!(reach > 0.9, "{azimuth} {aspect}: {reach}");
        }
    }
}

/// The view of `framing` is the orbit of these angles.
#[test]
fn the_three_quarter_view_is_an_orbit() {
    let made = cube([0.0; 3], 1.0);
    let azimuth = 0.55_f64.atan2(1.0).to_degrees();
    let elevation = 0.45_f64.atan2(0.55_f64.hypot(1.0)).to_degrees();
    let orbit = Camera::orbit(&[&made], 1.5, [azimuth, elevation], FIELD_OF_VIEW).view_projection.map(f64::from);
    assert_near(&orbit, &Camera::framing(&[&made], 1.5).view_projection.map(f64::from));
}
