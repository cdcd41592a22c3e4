//! The binding points of a plan in OpenGL, which has no bind groups: uniform blocks, storage buffers and texture units are numbered apart,
//! each from 0, whatever the bind group.
//!
//! OpenGL 4.5 promises 8 binding points for storage buffers and 16 texture units per stage, so resources that no pass uses together may
//! share a number: each takes the least that no other resource of its passes has. Then a plan needs more than 8 only if a pass does.

use fragbuf_codegen::{FIRST_BINDING, Plan, PlannedResource};
use fragbuf_templates::vocabulary::Access;

/// The binding points of the resources of one plan.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct OpenGlBindings {
    points: Vec<Point>,
}

/// The binding point of one resource.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Point {
    /// Its number in the bind group.
    binding: u32,
    /// Whether it is a texture, whose points are texture units.
    is_texture: bool,
    /// Its number in OpenGL.
    number: u32,
}

impl OpenGlBindings {
    /// Numbers the resources of a plan, in their order.
    pub fn of(plan: &Plan) -> Self {
        let mut numbered: Vec<(&PlannedResource, Point)> = Vec::new();
        for planned in plan.resources.iter().filter(|planned| is_bound(plan, planned)) {
            let is_texture = planned.is_texture();
            let is_free = |number: &u32| {
                let same = |point: &Point| point.is_texture == is_texture && point.number == *number;
                !numbered.iter().any(|(other, point)| same(point) && meet(plan, planned, other))
            };
            // One of as many numbers as there are resources is free.
            let number = (0..plan.resources.len() as u32).find(is_free).unwrap_or_default();
            numbered.push((planned, Point { binding: planned.binding, is_texture, number }));
        }
        OpenGlBindings { points: numbered.into_iter().map(|(_, point)| point).collect() }
    }

    /// Returns the binding point of a binding: of a uniform block its own number, of a resource that of its kind. `None`: no shader of
    /// the plan declares the resource.
    pub fn point(&self, binding: u32) -> Option<u32> {
        if binding < FIRST_BINDING {
            return Some(binding);
        }
        self.points.iter().find(|point| point.binding == binding).map(|point| point.number)
    }

    /// Returns how many binding points of storage buffers the plan uses.
    pub fn storage_buffers(&self) -> u32 {
        self.used(false)
    }

    /// Returns how many texture units the plan uses.
    pub fn texture_units(&self) -> u32 {
        self.used(true)
    }

    fn used(&self, is_texture: bool) -> u32 {
        let points = self.points.iter().filter(|point| point.is_texture == is_texture);
        points.map(|point| point.number + 1).max().unwrap_or(0)
    }
}

/// Tests whether a shader of the plan may declare the resource.
fn is_bound(plan: &Plan, planned: &PlannedResource) -> bool {
    let uses = plan.passes.iter().flat_map(|pass| &pass.uses);
    let mut uses = uses.filter(|usage| usage.resource == planned.resource.name);
    plan.is_declared(planned) && uses.any(|usage| declares(usage.access))
}

/// Tests whether a pass may declare both resources.
fn meet(plan: &Plan, one: &PlannedResource, other: &PlannedResource) -> bool {
    plan.passes.iter().any(|pass| {
        let declares = |planned: &PlannedResource| {
            let mut uses = pass.uses.iter().filter(|usage| usage.resource == planned.resource.name);
            uses.any(|usage| declares(usage.access))
        };
        declares(one) && declares(other)
    })
}

/// Tests whether shaders declare a resource that a pass accesses so.
fn declares(access: Access) -> bool {
    !matches!(access, Access::Attachment | Access::Indirect)
}
