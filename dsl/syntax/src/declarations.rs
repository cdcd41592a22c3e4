//! The declarations of attributes, uniforms and textures.
//!
//! Input: names and type names as written. Output: attributes, uniforms and textures with unique names. Formats and types are those
//! of `fragbuf_model`.

use fragbuf_model::{Attribute, Diagnostic, Format, Spanned, Texture, TextureDimension, Uniform, UniformType, codes};

use crate::foreign_names::{self, Replacement};
use crate::names;
use crate::report::{FIRST, Report};
use crate::unknown_name;

/// `name: type`, both as written.
pub(crate) struct Declaration {
    pub name: Spanned<String>,
    pub type_name: Spanned<String>,
}

/// Returns the attributes, and the names of those with an unknown format.
pub(crate) fn attributes(declarations: Vec<Declaration>, report: &mut Report) -> (Vec<Attribute>, Vec<String>) {
    let formats = Format::ALL.map(|format| (format.keyword(), format));
    let what = Declared { name: "attribute", foreign: foreign_names::attribute_format };
    let (known, invalid) = resolve_types(declarations, &what, &formats, report);
    (known.into_iter().map(|(name, format)| Attribute { name, format }).collect(), invalid)
}

/// Returns the uniforms, and the names of those with an unknown type.
pub(crate) fn uniforms(declarations: Vec<Declaration>, report: &mut Report) -> (Vec<Uniform>, Vec<String>) {
    let types = UniformType::ALL.map(|ty| (ty.keyword(), ty));
    let what = Declared { name: "uniform", foreign: foreign_names::uniform_type };
    let (known, invalid) = resolve_types(declarations, &what, &types, report);
    (known.into_iter().map(|(name, kind)| Uniform { name, kind }).collect(), invalid)
}

/// Returns the textures, and the names of those with an unknown dimension.
pub(crate) fn textures(declarations: Vec<Declaration>, report: &mut Report) -> (Vec<Texture>, Vec<String>) {
    let dimensions = TextureDimension::ALL.map(|dimension| (dimension.keyword(), dimension));
    let what = Declared { name: "texture", foreign: foreign_names::texture_dimension };
    let (known, invalid) = resolve_types(declarations, &what, &dimensions, report);
    (known.into_iter().map(|(name, dimension)| Texture { name, dimension }).collect(), invalid)
}

/// Whether a name of a type of another language is more often that of an attribute.
pub(crate) fn is_usual_name(word: &str) -> bool {
    matches!(word, "color" | "colour" | "normal")
}

/// What a block declares.
struct Declared {
    name: &'static str,
    /// Returns the help for a type of a shading language.
    foreign: fn(&str) -> Option<Replacement>,
}

type NamedTypes<T> = Vec<(Spanned<String>, Spanned<T>)>;

/// Returns each name with its type, without duplicates, and separately the names with an unknown type.
fn resolve_types<T: Copy>(
    declarations: Vec<Declaration>,
    &Declared { name: what, foreign }: &Declared,
    types: &[(&str, T)],
    report: &mut Report,
) -> (NamedTypes<T>, Vec<String>) {
    let mut seen: Vec<Spanned<String>> = Vec::new();
    let (mut known, mut invalid) = (Vec::new(), Vec::new());
    for Declaration { name, type_name } in declarations {
        let is_type = |word: &str| types.iter().any(|(keyword, _)| *keyword == word);
        if is_type(&name.value)
            && !is_type(&type_name.value)
            && foreign(&type_name.value).is_none_or(|_| is_usual_name(&type_name.value))
        {
            let message = format!("unknown {what} type `{}`", type_name.value);
            let help = format!("the name is before the colon: write `{}: {}`", type_name.value, name.value);
            report.error(codes::UNKNOWN_FORMAT, &type_name.span, message, help);
            invalid.push(type_name.value);
            continue;
        }
        let name = names::declared(&name, what, report);
        if let Some(first) = seen.iter().find(|other| other.value == name.value) {
            let message = format!("duplicate {what} `{}`", name.value);
            let diagnostic = Diagnostic::new(codes::DUPLICATE, &name.span, message, "rename one of them");
            report.push(diagnostic.label(&first.span, FIRST));
            continue;
        }
        seen.push(name.clone());
        match types.iter().find(|(keyword, _)| *keyword == type_name.value) {
            Some((_, ty)) => known.push((name, Spanned::new(*ty, type_name.span))),
            None => {
                let message = format!("unknown {what} type `{}`", type_name.value);
                let keywords: Vec<&str> = types.iter().map(|(keyword, _)| *keyword).collect();
                let help = foreign(&type_name.value)
                    .map(|foreign| foreign.help)
                    .unwrap_or_else(|| unknown_name::help(&type_name.value, &keywords));
                report.error(codes::UNKNOWN_FORMAT, &type_name.span, message, help);
                invalid.push(name.value);
            }
        }
    }
    (known, invalid)
}
