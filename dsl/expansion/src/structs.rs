//! The structs of a description: `Fragment`, the parameter of closures, and `Uniforms`, laid out as on the GPU.
//!
//! Input: attributes and uniforms of a draft, without those that have an error. Output: structs of glam's types, and
//! assertions that every uniform has the offset that [`UniformBlock`] gives it.

use fragbuf_model::{Attribute, Draft, Format, Spanned, Uniform, UniformBlock, UniformType};
use proc_macro2::{Ident, Literal, TokenStream};
use quote::{format_ident, quote};

use crate::module_source::ModuleSource;
use crate::{names, span};

/// Returns the struct `Fragment`.
pub(crate) fn fragment(source: &ModuleSource) -> TokenStream {
    let derives = derives();
    let fields = attributes(source.draft).into_iter().map(|attribute| {
        let format = attribute.format.value;
        let field = field(attribute.name, source);
        let kind = attribute_type(format, &source.input.serving);
        let words = if format.words() == 1 { "word" } else { "words" };
        let about = format!("`{}`: {} {words} of 32 bits in memory.", format.keyword(), format.words());
        quote! { #[doc = #about] pub #field: #kind }
    });
    quote! {
        /// The attributes of a fragment, with the types that closures see.
        #derives
        pub struct Fragment { #(#fields),* }
    }
}

/// Returns the attributes of a draft, or the papers' payload if it gives none.
fn attributes(draft: &Draft) -> Vec<Attribute> {
    if draft.attributes.is_empty() { draft.papers_payload() } else { draft.attributes.clone() }
}

/// Returns the struct `Uniforms`, the assertions of its layout, and its bytes.
pub(crate) fn uniforms(source: &ModuleSource) -> TokenStream {
    let serving = &source.input.serving;
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
        let rust_type = uniform_type(kind, serving);
        let about = format!("`{}` at byte {offset}.", kind.keyword());
        fields.push(quote! { #[doc = #about] pub #name: #rust_type });
        end = offset + kind.size();
        let (from, to) = (Literal::usize_unsuffixed(*offset as usize), Literal::usize_unsuffixed(end as usize));
        assertions.push(quote! { ::core::assert!(::core::mem::offset_of!(Uniforms, #name) == #from); });
        writes.push(quote! { #serving::UniformValue::write(self.#name, &mut bytes[#from..#to]); });
    }
    fields.extend(paddings.next(end, block.size));
    quote! {
        /// The uniforms of the description, laid out as in WGSL's uniform address space. Write padding as
        /// `..Default::default()`.
        #derives
        #[repr(C)]
        pub struct Uniforms { #(#fields),* }

        impl Uniforms {
            /// The size of the uniform block in bytes.
            pub const SIZE: ::core::primitive::usize = #size;

            /// Returns the contents of the uniform buffer.
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

/// The padding fields; their names differ from those of all uniforms.
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

/// Returns the identifier of a field, with the span of the user's token, so that editors find it there.
pub(crate) fn field(name: Spanned<String>, source: &ModuleSource) -> Ident {
    names::identifier(&name.value, span::token_span(&name.span, &source.input.tokens))
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
