//! Tests names that users may choose and targets reserve: the mangling table against naga's lists.

use fragbuf::Registry;
use fragbuf_model::{Attribute, Draft, Format, SourceSpan, Spanned, mangled};

use crate::cases::generated;
use crate::validators::validate;

fn attribute(name: &str, format: Format) -> Attribute {
    let span = SourceSpan::new("names", 1, 1);
    Attribute { name: Spanned::new(name.to_owned(), span.clone()), format: Spanned::new(format, span) }
}

/// Generates a payload of these attributes for every target and validates it.
fn generates(names: &[&str]) {
    let mut draft = Draft::from_technique("kplus_array", &SourceSpan::new("names", 1, 1));
    draft.attributes = vec![attribute("color", Format::Rgba8), attribute("depth", Format::F32)];
    draft.attributes.extend(names.iter().map(|name| attribute(name, Format::U32)));
    let variant = fragbuf::check(&draft, &Registry::builtin()).unwrap_or_else(|diagnostics| panic!("{diagnostics}"));
    validate(generated(&variant).files.iter());
}

#[test]
fn every_reserved_name_of_wgsl_is_mangled() {
    use naga::keywords::wgsl::{BUILTIN_IDENTIFIERS, RESERVED};
    assert!(RESERVED.len() > 150 && BUILTIN_IDENTIFIERS.len() > 150);
    for word in RESERVED.iter().chain(BUILTIN_IDENTIFIERS) {
        assert_ne!(mangled(word), *word, "{word}");
    }
}

/// Keywords of GLSL, HLSL and Metal are valid WGSL names, which each printer must replace.
#[test]
fn keywords_of_every_target_can_be_attributes() {
    let words = [
        "sample",
        "buffer",
        "flat",
        "input",
        "output",
        "main",
        "mix",
        "texture",
        "uint",
        "float4",
        "half",
        "kernel",
        "device",
        "groupshared",
        "register",
        "lock",
        "noise",
        "image2D",
        "vec3",
        "fn",
        "while",
        "override",
        "self",
        "matrix",
        "length",
        "gl_Position",
        "layers",
        "gathered",
        "keys",
        "entries",
        "pixel",
        "better",
        "key",
        "position",
        "fragment",
        "vertex",
    ];
    for group in words.chunks(6) {
        generates(group);
    }
}
