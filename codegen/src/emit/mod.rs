//! Generates declarations, the packing of a fragment into words, the two orders over packed fragments, and the accessors of buffers
//! and textures. Any other statement belongs in a template.

mod buffers;
mod effect;
mod fragment;
mod lookups;
mod resumable;
mod surface;
mod textures;
mod user_buffers;

use fragbuf_templates::vocabulary::{Kind, Pass};

use crate::link::Source;
use crate::{Linking, Plan};

pub use user_buffers::UserBuffer;
pub(crate) use user_buffers::user_buffers;

/// Returns the generated sources of one pass. `called` are the accessors other than loads and stores that its templates mention. The linker removes other
/// unused declarations.
pub(crate) fn sources(plan: &Plan, pass: &Pass, linking: &Linking, called: &[String]) -> Vec<Source> {
    let mut sources = vec![
        Source::generated("constants", constants(plan, pass)),
        Source::generated("fragment", fragment::text(plan, pass)),
    ];
    if pass.kind == Kind::Geometry {
        sources.push(Source::generated("surface", surface::text(plan, linking)));
    }
    sources.push(Source::generated("buffers", buffers::text(plan, pass, linking, called)));
    sources.push(Source::generated("textures", textures::text(plan, pass, linking)));
    sources.push(Source::generated("lookups", lookups::text(plan, pass, linking)));
    for function in plan.variant.helpers.iter().chain(closures(plan)) {
        sources.push(Source::user(function));
    }
    sources
}

/// Returns the closures, the effect in parts if it is interrupted.
fn closures(plan: &Plan) -> impl Iterator<Item = &fragbuf_model::UserFunction> {
    let variant = &plan.variant;
    let parts = resumable::interrupted(plan);
    let whole = variant.resolve.iter().filter(move |_| parts.is_none());
    let parts = parts.into_iter().flat_map(|parts| parts.parts());
    let images = variant.images.iter().map(|image| &image.function);
    variant.criterion.iter().chain(&variant.constraints).chain(images).chain(&variant.between).chain(whole).chain(parts)
}

/// Generates the constants of the pass, and those of the plan that the pass does not replace.
fn constants(plan: &Plan, pass: &Pass) -> String {
    let is_replaced = |name: &String| pass.constants.iter().any(|(other, _)| other == name);
    let others = plan.constants.iter().filter(|(name, _)| !is_replaced(name));
    others.chain(&pass.constants).map(|(name, value)| format!("const {name} = {value}u;\n")).collect()
}
