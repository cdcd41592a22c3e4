//! What tests of every host share: techniques as variants, the scene as objects, and the expected image.

use std::sync::Arc;

use fragbuf_codegen::{Arrival, Plan};
use fragbuf_cpu::{Code, Device, Settings};
use fragbuf_follow::Object;
use fragbuf_model::{Draft, SourceSpan, Variant, check};
use fragbuf_templates::Registry;
use fragbuf_templates::vocabulary::{KeepDefault, Technique, TieBreak};

use super::cpu_image::{cpu_image, is_exact, shown};
use super::scene::{Quad, image, image_in_order};

pub const BACKGROUND: [f64; 3] = [0.2, 0.4, 0.6];

pub const IDENTITY: [f32; 16] = [1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0];

/// Returns a technique with these settings, if they are legal.
pub fn variant(key: &str, set: &[(&str, &str)]) -> Option<Variant> {
    let span = SourceSpan::new(key, 1, 1);
    let mut draft = Draft::from_technique(key, &span);
    for (name, value) in set {
        draft.set(name, value, &span).ok()?;
    }
    check(&draft, &Registry::builtin()).ok()
}

/// Returns the k that tests use for a technique.
pub fn k_of(technique: &Technique) -> Option<u32> {
    match technique.keep {
        KeepDefault::All => None,
        KeepDefault::Best(most) => Some(most.min(4)),
    }
}

/// Whether the driver of this name may run several fragments of a pixel at once. Software drivers run one after the other.
pub fn is_parallel(driver: &str) -> bool {
    ["llvmpipe", "softpipe", "SwiftShader"].iter().all(|name| !driver.contains(name))
}

/// Returns an object per quad. Their boxes hide nothing.
pub fn objects(quads: &[Quad]) -> Vec<Object> {
    let object = |index| Object { first: 6 * index, count: 6, bounds: [[-1.0, -1.0, 0.0], [1.0, 1.0, 1.0]] };
    (0..quads.len() as u32).map(object).collect()
}

/// Returns the image of the reference, which shares no code with the templates; `None`: the plan states that it loses fragments.
pub fn reference(plan: &Plan, quads: &[Quad], k: Option<u32>, size: [u32; 2]) -> Option<Vec<[f64; 3]>> {
    if is_exact(plan) {
        return Some(image(quads, size, shown(plan, k), BACKGROUND));
    }
    let is_in_order = plan.arrival() == Arrival::Submission && plan.hazards.is_empty() && is_by_order(plan);
    is_in_order.then(|| image_in_order(quads, size, k, BACKGROUND))
}

/// Returns the image of the CPU device. `textures` has a number per pixel for each external texture.
pub fn on_cpu(
    plan: &Plan,
    inputs: &[String],
    textures: &[(String, Vec<f32>)],
    (quads, size): (&[Quad], [u32; 2]),
) -> Vec<[f64; 3]> {
    let code = Code::of(&plan.variant, &Registry::builtin()).unwrap_or_else(|error| panic!("{error}"));
    let mut cpu = Device::new(Arc::new(code), Settings::new(size[0], size[1])).unwrap();
    textures.iter().for_each(|(name, texels)| cpu.set_texture(name, texels).unwrap());
    cpu_image(&mut cpu, quads, size, &inputs.iter().map(String::as_str).collect::<Vec<_>>(), BACKGROUND)
}

/// Whether the order of submission decides ties.
fn is_by_order(plan: &Plan) -> bool {
    plan.selection.row("ties").and_then(|ties| ties.row.order) == Some(TieBreak::Submission)
}
