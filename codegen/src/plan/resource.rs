//! Resources of a plan and their sizes.

use fragbuf_templates::vocabulary::{Element, Expression, Formula, FormulaError, Init, Resource, TextureFormat};

use crate::Quantity;

/// A resource of a plan.
#[derive(Clone, Debug, PartialEq)]
pub struct PlannedResource {
    /// The resource of the row, with the name of its instance.
    pub resource: Resource,
    /// Its binding in every pass.
    pub binding: u32,
    /// Its size in words, as one formula.
    pub words: Quantity,
    /// The lengths of its extents.
    pub lengths: Vec<Quantity>,
    /// The word that it stores, for one of several textures of a fragment.
    pub part: Option<Part>,
}

impl PlannedResource {
    /// Tests whether it is an external texture: the caller owns its memory and writes it.
    pub fn is_external(&self) -> bool {
        self.resource.init == Init::External && self.is_texture()
    }

    /// Tests whether it is a texture, not a buffer.
    pub fn is_texture(&self) -> bool {
        matches!(self.resource.element, Element::Texture(_) | Element::Texels(_))
    }

    /// Tests whether it is a texture of the description, which has a size of its own.
    pub fn is_of_description(&self) -> bool {
        matches!(self.resource.element, Element::Texels(_))
    }

    /// Tests whether it is the external depth buffer of opaque surfaces.
    pub fn is_opaque_depth(&self) -> bool {
        self.is_external() && self.resource.element == Element::Texture(TextureFormat::Depth32Float)
    }

    /// Tests whether it is a texture with several samples per pixel.
    pub fn is_multisampled(&self) -> bool {
        self.sample_count().is_some()
    }

    /// Returns the number of samples per pixel of a multisampled texture.
    pub fn sample_count(&self) -> Option<&Quantity> {
        let mut extents = self.resource.extents.iter().zip(&self.lengths);
        let length = extents.find(|(extent, _)| extent.name == SAMPLE).map(|(_, length)| length);
        length.filter(|_| matches!(self.resource.element, Element::Texture(_)))
    }
}

/// The name of the extent that counts samples.
const SAMPLE: &str = "sample";

/// One word of a resource that is one in a row and one texture per word in a plan.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Part {
    /// The name of the resource in the row.
    pub of: String,
    /// The field of the word in `Packed`.
    pub field: String,
}

/// Returns the size of a resource in words: the product of its extents and of the words of an element.
pub(super) fn size(resource: &Resource) -> Result<Formula, FormulaError> {
    let mut factors: Vec<Formula> = resource.extents.iter().map(|extent| extent.length.clone()).collect();
    match resource.element {
        // The caller allocates it.
        Element::Texels(_) => return Ok("0".into()),
        Element::Word => {}
        Element::Word64 => factors.push("2".into()),
        Element::Entry => factors.push("entry_words".into()),
        Element::Value => factors.push("value_words".into()),
        Element::Texture(format) if format.words() == 1 => {}
        Element::Texture(format) => factors.push(format.words().to_string().into()),
        Element::ValueTextures(_) => factors.push("value_words".into()),
        Element::EntryTextures(_) => factors.push("entry_words".into()),
    }
    let texts: Vec<String> = factors
        .iter()
        .enumerate()
        .map(|(index, factor)| parenthesised(factor, index == 0))
        .collect::<Result<_, _>>()?;
    let text = if texts.is_empty() { "1".to_owned() } else { texts.join(" * ") };
    Ok(text.into())
}

/// Returns a factor of a product, in parentheses if the product would have another value without them.
fn parenthesised(factor: &Formula, is_first: bool) -> Result<String, FormulaError> {
    let is_closed = is_closed(&factor.read()?, is_first);
    Ok(if is_closed { factor.to_string() } else { format!("({factor})") })
}

/// Tests whether a factor needs no parentheses: its operators bind as closely as a product. Only the first factor may divide, because
/// a later division would also divide the factors before it.
fn is_closed(factor: &Expression, is_first: bool) -> bool {
    match factor {
        Expression::Apply("*" | "/", _) => is_first || !begins_with_quotient(factor),
        Expression::Apply(operator, _) => operator.starts_with(|sign: char| sign.is_ascii_alphabetic()),
        _ => true,
    }
}

/// Tests whether the leftmost operation of a product is a division. Sums in a product have parentheses already.
fn begins_with_quotient(factor: &Expression) -> bool {
    match factor {
        Expression::Apply("*", parts) => begins_with_quotient(&parts[0]),
        Expression::Apply(operator, _) => *operator == "/",
        _ => false,
    }
}
