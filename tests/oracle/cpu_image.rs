//! The image of the CPU device for tests of other devices, and whether the reference can judge a variant.

use fragbuf_codegen::Plan;
use fragbuf_cpu::{Device, Mesh};
use fragbuf_templates::vocabulary::{Capability, TieBreak};

use super::scene::{Quad, over_background, vertices};

/// Renders quads over an opaque background.
pub fn cpu_image(
    device: &mut Device,
    quads: &[Quad],
    size: [u32; 2],
    inputs: &[&str],
    background: [f64; 3],
) -> Vec<[f64; 3]> {
    let bytes = vertices(quads, size, inputs);
    let words: Vec<u32> = bytes.chunks_exact(4).map(|word| u32::from_le_bytes(word.try_into().unwrap())).collect();
    let indices: Vec<u32> = (0..6 * quads.len() as u32).collect();
    let picture = device.render(&Mesh { vertices: &words, indices: &indices }, &|_| {}).unwrap();
    picture.pixels.iter().map(|pixel| over_background(pixel.map(f64::from), background)).collect()
}

/// Returns how many fragments of a pixel the image of a technique shows that keeps `k`; `None`: all.
pub fn shown(plan: &Plan, k: Option<u32>) -> Option<u32> {
    k.filter(|_| !plan.selection.provides().contains(&Capability::KeepsLater))
}

/// Tests whether the image is that of the k nearest fragments, or of all: nothing is lost, words decide ties, and fragments that are
/// not kept add nothing.
pub fn is_exact(plan: &Plan) -> bool {
    let storage = &plan.selection.row("storage").unwrap().row;
    let keeps_best = [Capability::KeepsAll, Capability::KeepsBest].iter().any(|kept| storage.may_provide(*kept));
    let ties = plan.selection.row("ties").and_then(|ties| ties.row.order);
    let is_unharmed = !plan.hazards.iter().any(|hazard| hazard.permits.shows());
    let drops_others = plan.selection.row("overflow").is_none_or(|overflow| overflow.row.key == "drop");
    keeps_best && is_unharmed && drops_others && !matches!(ties, Some(TieBreak::Unordered | TieBreak::Submission))
}
