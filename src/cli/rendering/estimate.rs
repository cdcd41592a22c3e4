//! Estimates the time of a frame on the CPU device, from what is known before drawing, to decide between it and a software driver.
//!
//! Input: a scene with its camera, the size of the frame, and the variants to render. Output: the work, and whether a software driver is
//! likely to be faster. `src/README.md` has the rule, and the measured times that its constants follow.

use fragbuf::vocabulary::Kind;
use fragbuf::{Registry, Selection, Variant, plan};

use crate::cli::view::SceneView;

/// The seconds that one core needs for a fragment, a triangle, and a pixel of a pass over the whole frame.
const FRAGMENT: f64 = 0.3e-6;
const TRIANGLE: f64 = 0.35e-6;
const PIXEL: f64 = 0.08e-6;

/// The seconds of work from which a software driver is faster. It needs about as long to start and to compile, and works faster then.
const DRIVER_START: f64 = 0.6;

/// The work of all frames of a command.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Work {
    /// The fragments of the scene, from the areas of its triangles in the image.
    fragments: f64,
    /// Seconds on the CPU device.
    seconds: f64,
}

impl Work {
    pub(super) fn of(scene: &SceneView, size: (u32, u32), variants: &[Variant], registry: &Registry) -> Self {
        let triangles = scene.scene.triangles() as f64;
        let fragments = fragments(scene, size);
        let pixels = f64::from(size.0) * f64::from(size.1);
        let of = |variant: &Variant| {
            // An invalid variant is an error of the rendering.
            let plan = plan(variant, &Selection::first(variant), registry).ok()?;
            let draws = plan.passes.iter().filter(|pass| pass.kind == Kind::Geometry).count();
            let others = plan.passes.len() - draws;
            Some(draws as f64 * (FRAGMENT * fragments + TRIANGLE * triangles) + others as f64 * PIXEL * pixels)
        };
        Work { fragments, seconds: variants.iter().filter_map(of).sum() }
    }

    /// Returns whether a software driver is likely to be faster.
    pub(super) fn is_faster_on_a_driver(self) -> bool {
        self.seconds > DRIVER_START
    }

    /// Returns the number of fragments with two digits, in words.
    pub(super) fn in_words(self) -> String {
        let unit = 10.0_f64.powf(self.fragments.max(10.0).log10().floor() - 1.0);
        format!("about {} fragments", (self.fragments / unit).round() * unit)
    }
}

/// Estimates the fragments of a scene: the areas of its triangles in pixels, as far as their bounds are within the frame.
fn fragments(view: &SceneView, (width, height): (u32, u32)) -> f64 {
    let matrix = view.camera.view_projection.map(f64::from);
    let (width, height) = (f64::from(width), f64::from(height));
    let project = |position: &[f32; 3]| {
        let [x, y, z] = position.map(f64::from);
        let row = |row: usize| matrix[row] * x + matrix[4 + row] * y + matrix[8 + row] * z + matrix[12 + row];
        let w = row(3);
        (w > 0.0).then(|| [(row(0) / w + 1.0) * 0.5 * width, (row(1) / w + 1.0) * 0.5 * height])
    };
    let mut sum = 0.0;
    for object in &view.scene.objects {
        let points: Vec<Option<[f64; 2]>> = object.positions.iter().map(project).collect();
        for triangle in &object.triangles {
            let corners = triangle.map(|corner| points.get(corner as usize).copied().flatten());
            sum += match corners {
                [Some(a), Some(b), Some(c)] => visible_area([a, b, c], [width, height]),
                [None, None, None] => 0.0,
                // It crosses the plane of the eye: unknown, and seldom.
                _ => 0.5 * width * height,
            };
        }
    }
    sum
}

/// Returns the area of a triangle, in the proportion in which its bounds are within the frame.
fn visible_area([a, b, c]: [[f64; 2]; 3], frame: [f64; 2]) -> f64 {
    let area = 0.5 * ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])).abs();
    let share = |axis: usize| {
        let (least, greatest) = (a[axis].min(b[axis]).min(c[axis]), a[axis].max(b[axis]).max(c[axis]));
        let inside = greatest.min(frame[axis]) - least.max(0.0);
        if greatest > least { (inside / (greatest - least)).max(0.0) } else { 0.0 }
    };
    area * share(0) * share(1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use fragbuf_scene::{Camera, Object, Scene};

    fn view(positions: Vec<[f32; 3]>) -> SceneView {
        let triangles =
            (0..positions.len() as u32 / 3).map(|index| [0, 1, 2].map(|corner| 3 * index + corner)).collect();
        let scene = Scene { objects: vec![Object { positions, triangles, ..Object::default() }], ..Scene::default() };
        SceneView::new(scene, Camera::clip())
    }

    #[test]
    fn fragments_are_the_areas_within_the_frame() {
        let half = vec![[-1.0, -1.0, 0.5], [1.0, -1.0, 0.5], [-1.0, 1.0, 0.5]];
        assert_eq!(fragments(&view(half.clone()), (40, 20)), 400.0);
        // Half of the bounds are on the right of the frame, and then all.
        let moved = |by: f32| half.iter().map(|[x, y, z]| [x + by, *y, *z]).collect::<Vec<_>>();
        assert_eq!(fragments(&view(moved(1.0)), (40, 20)), 200.0);
        assert_eq!(fragments(&view(moved(2.5)), (40, 20)), 0.0);
        assert_eq!(fragments(&view([half.clone(), half].concat()), (40, 20)), 800.0);
    }

    #[test]
    fn work_grows_with_the_frame_and_the_draws() {
        let registry = Registry::builtin();
        let variant = |key: &str| {
            let draft = fragbuf::Draft::from_technique(key, &fragbuf::SourceSpan::new(key, 1, 1));
            fragbuf::check(&draft, &registry).ok()
        };
        let quad = view(vec![[-1.0, -1.0, 0.5], [3.0, -1.0, 0.5], [-1.0, 3.0, 0.5]]);
        let work = |key: &str, side: u32| {
            let variants: Vec<Variant> = variant(key).into_iter().collect();
            Work::of(&quad, (side, side), &variants, &registry)
        };
        let one_draw = work("ab_ll", 64);
        assert!(!one_draw.is_faster_on_a_driver() && work("ab_ll", 2048).is_faster_on_a_driver());
        // Regions of exact size are counted by a first draw.
        assert!(work("ab_sb", 64).seconds > 1.5 * one_draw.seconds);
        assert_eq!(one_draw.in_words(), "about 2000 fragments");
    }
}
