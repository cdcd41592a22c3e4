//! What the textures and images of a description add to the plan of its rows.
//!
//! Input: a variant, and the steps of its rows. Output: a resource per texture and image, a pass per image, and their uses by the passes
//! whose closures read them.

use fragbuf_model::{Reads, UserFunction, Variant};
use fragbuf_templates::vocabulary::{Access, Element, Init, Kind, Pass, Resource, Step, Use};

use super::edit::for_each_pass;

/// The words of a value of an image: four floats.
pub(crate) const IMAGE_WORDS: u32 = 4;

/// The constant with the number of the image that a pass computes.
pub(crate) const IMAGE: &str = "IMAGE";

/// Adds the textures and images, and a use to each pass that may read one.
pub(super) fn add(variant: &Variant, steps: &mut [Step], resources: &mut Vec<Resource>) {
    for texture in &variant.textures {
        let summary = format!("the texture `{}` of the description", texture.name.value);
        let element = Element::Texels(texture.dimension.value);
        resources.push(Resource { init: Init::External, ..Resource::new(&texture.resource(), element, summary) });
    }
    for image in &variant.images {
        let summary = format!("the image `{}` of the description, as floats", image.name.value);
        let resource = Resource::new(&image.resource(), Element::Word, summary);
        resources.push(resource.by("channel", IMAGE_WORDS.to_string()).by("pixel", "pixels"));
    }
    for_each_pass(steps, &mut |pass| {
        let reads = reads(variant, pass);
        for texture in variant.textures.iter().filter(|texture| reads.textures.contains(&texture.name.value)) {
            pass.uses.push(Use::new(&texture.resource(), Access::Sampled));
        }
        for image in variant.images.iter().filter(|image| reads.images.contains(&image.name.value)) {
            pass.uses.push(Use::new(&image.resource(), Access::Read));
        }
    });
}

/// Returns the passes that compute the images: forms of the pass that computes the effect.
pub(super) fn images(variant: &Variant, effect: &Pass) -> Vec<Step> {
    let pass = |(number, image): (u32, &fragbuf_model::Image)| {
        let mut pass = effect.clone();
        pass.name = image.resource();
        pass.skeleton = format!("{}_image", effect.skeleton);
        pass.state.targets.clear();
        pass.constants.push((IMAGE.to_owned(), number));
        pass.uses.push(Use::new(&image.resource(), Access::Plain));
        Step::Pass(pass)
    };
    (0..).zip(&variant.images).map(pass).collect()
}

/// Returns the textures and images that the closures of a pass can read.
fn reads(variant: &Variant, pass: &Pass) -> Reads {
    let own = pass.constants.iter().find(|(name, _)| name == IMAGE).map(|(_, number)| *number as usize);
    let everywhere = variant.criterion.iter().chain(&variant.constraints).chain(&variant.between);
    let effect: Vec<&UserFunction> = match (&pass.kind, own) {
        (Kind::Fullscreen, Some(number)) => {
            variant.images.get(number).map(|image| &image.function).into_iter().collect()
        }
        (Kind::Fullscreen, None) => variant.resolve.iter().collect(),
        _ => Vec::new(),
    };
    let mut all = Reads::default();
    for function in everywhere.chain(effect) {
        all.textures.extend(function.reads.textures.iter().cloned());
        all.images.extend(function.reads.images.iter().cloned());
    }
    all
}
