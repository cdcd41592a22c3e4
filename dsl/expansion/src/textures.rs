//! The struct of textures and images, and the parameter by which closures read them beside the uniforms.
//!
//! Input: the textures and images of a draft. Output: `Textures`, which a program fills, and `Inputs`, which closures see as `u`; nothing
//! for a description without textures and images.

use fragbuf_model::{Draft, TextureDimension};
use proc_macro2::TokenStream;
use quote::quote;

use crate::module_source::ModuleSource;
use crate::structs::field;

/// Whether closures read textures or images.
pub(crate) fn has_textures(draft: &Draft) -> bool {
    !draft.textures.is_empty() || !draft.images.is_empty()
}

/// Returns the structs.
pub(crate) fn textures(source: &ModuleSource) -> TokenStream {
    let draft = source.draft;
    if !has_textures(draft) {
        return TokenStream::new();
    }
    let serving = &source.input.serving;
    let textures = draft.textures.iter().map(|texture| {
        let ty = match texture.dimension.value {
            TextureDimension::D2 => quote! { #serving::Texture2d<'a> },
            TextureDimension::D3 => quote! { #serving::Texture3d<'a> },
        };
        (field(texture.name.clone(), source), ty)
    });
    let images = draft.images.iter().map(|image| (field(image.name.clone(), source), quote! { #serving::Image<'a> }));
    let (names, types): (Vec<_>, Vec<_>) = textures.chain(images).unzip();
    quote! {
        /// The textures of the description, and its images as the closure of a pixel sees them.
        #[derive(::core::clone::Clone, ::core::marker::Copy, ::core::fmt::Debug, ::core::default::Default)]
        pub struct Textures<'a> {
            #(#[allow(missing_docs)] pub #names: #types),*
        }

        /// What closures see as `u`: the textures, the images and the uniforms.
        #[derive(::core::clone::Clone, ::core::marker::Copy, ::core::fmt::Debug)]
        pub struct Inputs<'a> {
            __uniforms: Uniforms,
            #(#[allow(missing_docs)] pub #names: #types),*
        }

        impl<'a> Inputs<'a> {
            /// Joins uniforms and textures.
            pub fn new(uniforms: Uniforms, textures: Textures<'a>) -> Self {
                Inputs { __uniforms: uniforms, #(#names: textures.#names),* }
            }
        }

        impl ::core::ops::Deref for Inputs<'_> {
            type Target = Uniforms;

            fn deref(&self) -> &Uniforms {
                &self.__uniforms
            }
        }
    }
}
