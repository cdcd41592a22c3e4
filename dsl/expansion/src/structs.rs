//! The structs of a description: `Fragment`, which a closure sees, and `Uniforms`, which lie on the GPU as in memory.
//!
//! In: attributes and uniforms of a draft. Out: structs of glam's types, and assertions that every uniform lies where
//! [`UniformBlock`] says. What was refused is not there.

use fragbuf_model::{Draft, Format, Spanned, Uniform, UniformBlock, UniformType};
use proc_macro2::{Ident, Literal, TokenStream};
use quote::{format_ident, quote};

use crate::module::Source;
use crate::{names, place};

/// `Fragment`.
pub(crate) fn fragment(source: &Source) -> TokenStream {
    let derives = derives();
    let fields = attributes(source.draft).into_iter().map(|(name, format)| {
        let field = field(name, source);
        let kind = attribute_type(format, &source.front.serving);
        let words = if format.words() == 1 { "word" } else { "words" };
        let about = format!("`{}`: {} {words} of 32 bits in memory.", format.keyword(), format.words());
        quote! { #[doc = #about] pub #field: #kind }
    });
    quote! {
        /// What a fragment carries, as the closures see it.
        #derives
        pub struct Fragment { #(#fields),* }
    }
}

/// The attributes of a draft, the papers' payload where it says none.
fn attributes(draft: &Draft) -> Vec<(Spanned<String>, Format)> {
    if draft.attributes.is_empty() {
        let named = |name: &str| Spanned::new(name.to_owned(), draft.name.origin.clone());
        return vec![(named("color"), Format::Rgba8), (named("depth"), Format::F32)];
    }
    draft.attributes.iter().map(|attribute| (attribute.name.clone(), attribute.format.value)).collect()
}

/// `Uniforms`, its layout asserted, and its bytes.
pub(crate) fn uniforms(source: &Source) -> TokenStream {
    let serving = &source.front.serving;
    let uniforms = &source.draft.uniforms;
    let block = UniformBlock::of(uniforms);
    let derives = derives();
    let size = Literal::usize_unsuffixed(block.size as usize);
    let (mut fields, mut assertions, mut writes) = (Vec::new(), Vec::new(), Vec::new());
    let mut paddings = Paddings { uniforms, count: 0 };
    let mut end = 0;
    for (uniform, offset) in uniforms.iter().zip(&block.offsets) {
        fields.extend(paddings.next(end, *offset));
        let kind = uniform.kind.value;
        let name = field(uniform.name.clone(), source);
        let written = uniform_type(kind, serving);
        let about = format!("`{}` at byte {offset}.", kind.keyword());
        fields.push(quote! { #[doc = #about] pub #name: #written });
        end = offset + kind.size();
        let (from, to) = (Literal::usize_unsuffixed(*offset as usize), Literal::usize_unsuffixed(end as usize));
        assertions.push(quote! { ::core::assert!(::core::mem::offset_of!(Uniforms, #name) == #from); });
        writes.push(quote! { #serving::UniformValue::write(self.#name, &mut bytes[#from..#to]); });
    }
    fields.extend(paddings.next(end, block.size));
    quote! {
        /// The description's own uniforms, laid out as in WGSL's uniform address space. Padding between them is for
        /// `..Default::default()`.
        #derives
        #[repr(C)]
        pub struct Uniforms { #(#fields),* }

        impl Uniforms {
            /// Bytes of the uniform block.
            pub const SIZE: ::core::primitive::usize = #size;

            /// The block as it goes into a uniform buffer.
            #[allow(unused_mut)]
            pub fn bytes(&self) -> [::core::primitive::u8; #size] {
                let mut bytes = [0; #size];
                #(#writes)*
                bytes
            }
        }

        const _: () = {
            #(#assertions)*
            ::core::assert!(::core::mem::size_of::<Uniforms>() == #size);
        };
    }
}

/// The fields that fill gaps, named so that no uniform has their names.
struct Paddings<'a> {
    uniforms: &'a [Uniform],
    count: usize,
}

impl Paddings<'_> {
    fn next(&mut self, end: u32, offset: u32) -> Option<TokenStream> {
        let words = Literal::usize_unsuffixed(offset.checked_sub(end).filter(|gap| *gap > 0)? as usize / 4);
        let name = loop {
            let name = format_ident!("_padding_{}", self.count);
            self.count += 1;
            if self.uniforms.iter().all(|uniform| name != uniform.name.value) {
                break name;
            }
        };
        Some(quote! { #[doc(hidden)] pub #name: [::core::primitive::u32; #words] })
    }
}

fn derives() -> TokenStream {
    quote! {
        #[derive(
            ::core::clone::Clone, ::core::marker::Copy, ::core::fmt::Debug, ::core::default::Default,
            ::core::cmp::PartialEq
        )]
    }
}

/// A field that an editor finds at the user's own word.
fn field(name: Spanned<String>, source: &Source) -> Ident {
    names::identifier(&name.value, place::span(&name.origin, &source.front.tokens))
}

fn attribute_type(format: Format, serving: &TokenStream) -> TokenStream {
    match format {
        Format::F32 => quote! { ::core::primitive::f32 },
        Format::U32 => quote! { ::core::primitive::u32 },
        Format::Vec2 => quote! { #serving::glam::Vec2 },
        Format::Vec3 | Format::Octahedral => quote! { #serving::glam::Vec3 },
        Format::Vec4 | Format::Rgba8 | Format::Rgba16 => quote! { #serving::glam::Vec4 },
    }
}

fn uniform_type(kind: UniformType, serving: &TokenStream) -> TokenStream {
    match kind {
        UniformType::F32 => quote! { ::core::primitive::f32 },
        UniformType::U32 => quote! { ::core::primitive::u32 },
        UniformType::I32 => quote! { ::core::primitive::i32 },
        UniformType::Vec2 => quote! { #serving::glam::Vec2 },
        UniformType::Vec3 => quote! { #serving::glam::Vec3 },
        UniformType::Vec4 => quote! { #serving::glam::Vec4 },
    }
}
