//! The coordinates of a scene: those of its model, or others in which `f32` is precise and does not overflow.
//!
//! Input: the objects of a model with positions in doubles. Output: a scene. A model that is far from zero, as one at map coordinates, is
//! moved to its centre; a model that is very large or very small is scaled by a power of two. All others keep their coordinates.

use crate::Scene;
use crate::model::ModelObject;
use crate::scene::Object;

/// The coordinates of a scene: a position of the model is `origin + unit * position`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placement {
    /// The position of the scene's zero in the model.
    pub origin: [f64; 3],
    /// The length of the scene's unit in the model, a power of two.
    pub unit: f64,
}

impl Default for Placement {
    /// Returns the coordinates of the model.
    fn default() -> Self {
        Placement { origin: [0.0; 3], unit: 1.0 }
    }
}

/// The distance from zero, relative to the size, beyond which a model is moved.
const FAR: f64 = 32.0;

/// The sizes that are not scaled, as powers of two.
const SIZES: std::ops::RangeInclusive<f64> = 0.0009765625..=16384.0;

/// The greatest coordinate of a vertex. Only vertices without triangles can exceed it in the coordinates that [`Placement::of`] returns.
const GREATEST: f64 = 1.0e30;

type Bounds = ([f64; 3], [f64; 3]);

impl Placement {
    /// Returns the coordinates for a model with these bounds.
    fn of(bounds: Option<Bounds>) -> Self {
        let Some((least, greatest)) = bounds else { return Placement::default() };
        let axes = || least.into_iter().zip(greatest);
        let size = axes().map(|(least, greatest)| greatest - least).fold(0.0, f64::max);
        let far = axes().map(|(least, greatest)| least.abs().max(greatest.abs())).fold(0.0, f64::max);
        // Of a model without size, only the position matters.
        let is_moved = size > 0.0 && far > FAR * size;
        let centre = std::array::from_fn(|axis| 0.5 * least[axis] + 0.5 * greatest[axis]);
        let origin = if is_moved { centre } else { [0.0; 3] };
        let reach = if is_moved { size } else { far };
        let is_scaled = reach > 0.0 && !SIZES.contains(&reach);
        Placement { origin, unit: if is_scaled { reach.log2().floor().exp2() } else { 1.0 } }
    }

    /// Returns a position of the model in these coordinates.
    pub(crate) fn in_scene(self, position: [f64; 3]) -> [f64; 3] {
        std::array::from_fn(|axis| (position[axis] - self.origin[axis]) / self.unit)
    }

    /// Returns a vertex of the model in these coordinates.
    fn to_scene(self, position: [f64; 3]) -> [f32; 3] {
        self.in_scene(position).map(|value| value.clamp(-GREATEST, GREATEST) as f32)
    }

    /// Returns a position in the coordinates of the model.
    fn to_model(self, position: [f32; 3]) -> [f64; 3] {
        std::array::from_fn(|axis| self.origin[axis] + self.unit * f64::from(position[axis]))
    }
}

impl Placement {
    /// Returns a position of the scene in the coordinates of the model, rounded to `f32`; coordinates beyond ±10³⁰ are ±10³⁰.
    pub fn model_position(self, position: [f32; 3]) -> [f32; 3] {
        Placement::default().to_scene(self.to_model(position))
    }
}

/// Returns the scene of a model.
pub(crate) fn place(objects: Vec<ModelObject>) -> Scene {
    let placement = Placement::of(bounds(objects.iter().flat_map(ModelObject::corners)));
    let placed = |object: ModelObject| Object {
        name: object.name,
        positions: object.positions.into_iter().map(|position| placement.to_scene(position)).collect(),
        normals: object.normals,
        colors: object.colors,
        attributes: object.attributes,
        triangles: object.triangles,
    };
    Scene { objects: objects.into_iter().map(placed).collect(), placement, ..Scene::default() }
}

fn bounds(positions: impl Iterator<Item = [f64; 3]>) -> Option<Bounds> {
    positions.map(|position| (position, position)).reduce(|(least, greatest), (position, _)| {
        let pick = |choose: fn(f64, f64) -> f64, from: [f64; 3]| {
            std::array::from_fn(|axis| choose(from[axis], position[axis]))
        };
        (pick(f64::min, least), pick(f64::max, greatest))
    })
}

impl Scene {
    /// Converts the positions to the coordinates of the model. They may lose precision.
    pub fn use_model_coordinates(&mut self) {
        self.use_placement(Placement::default());
    }

    /// Converts the positions of both scenes to the same coordinates.
    pub fn share_placement(&mut self, other: &mut Scene) {
        if self.placement == other.placement {
            return;
        }
        let corners = |scene: &Scene| {
            let placement = scene.placement;
            bounds(scene.objects.iter().flat_map(Object::corners).map(|position| placement.to_model(position)))
        };
        let both = [corners(self), corners(other)].into_iter().flatten();
        let placement = Placement::of(bounds(both.flat_map(|(least, greatest)| [least, greatest])));
        self.use_placement(placement);
        other.use_placement(placement);
    }

    fn use_placement(&mut self, placement: Placement) {
        let former = std::mem::replace(&mut self.placement, placement);
        if former != placement {
            for position in self.objects.iter_mut().flat_map(|object| &mut object.positions) {
                *position = placement.to_scene(former.to_model(*position));
            }
        }
    }
}
