//! The closures and helpers of a description as Rust functions, made of the user's own tokens: the compiler judges them
//! too, and a program can call them.
//!
//! In: functions as written. Out: a module `functions` in which everything is passed by value, as in the language, and
//! functions over references around it. Where anything is wrong the compiler gets the signatures alone, because it would
//! only repeat what was said; editors get the bodies, to complete in them.

use fragbuf_syntax::{Role, Written};
use proc_macro2::{Delimiter, TokenStream, TokenTree};
use quote::{format_ident, quote};

use crate::module::{Bodies, Source};

/// Both layers.
pub(crate) fn all(source: &Source) -> TokenStream {
    let first_of_role = |index: usize, written: &Written| {
        let earlier = source.written.iter().take(index);
        earlier.into_iter().all(|other| other.role != written.role)
    };
    let written = || source.written.iter().enumerate().filter(|(index, one)| first_of_role(*index, one));
    let outer = written().map(|(_, one)| outer(one, source));
    let inner = written().map(|(_, one)| inner(one, source));
    let serving = &source.front.serving;
    let functions = quote! {
        /// The functions in the user's own words: values go in and out as in the language.
        pub mod functions {
            use super::{Fragment, Uniforms};
            use #serving::glam::swizzles::{Vec2Swizzles as _, Vec3Swizzles as _, Vec4Swizzles as _};
            use #serving::glam::{Vec2, Vec3, Vec4, vec2, vec3, vec4};
            // The module, for `f32::consts`; the type of the same name is there all the same.
            use ::core::f32;

            #(#inner)*
        }
    };
    let functions = match source.bodies {
        Bodies::Compiled => functions,
        // Inside a macro call, tokens that are no Rust do not disturb the compiler.
        Bodies::ForEditors => quote! { #[cfg(rust_analyzer)] #serving::as_written! { #functions } },
    };
    quote! { #(#outer)* #functions }
}

/// What a role's function is called, what it takes and gives.
struct Shape {
    /// Its name in `functions`, as in the generated WGSL.
    inner: proc_macro2::Ident,
    outer: proc_macro2::Ident,
    about: &'static str,
    first: TokenStream,
    reference: TokenStream,
    result: TokenStream,
}

fn shape(role: &Role, source: &Source) -> Option<Shape> {
    let serving = &source.front.serving;
    let one = (quote! { Fragment }, quote! { &Fragment });
    let list = (quote! { #serving::Fragments<'_, Fragment> }, quote! { &[Fragment] });
    let (inner, outer, about, (first, reference), result) = match role {
        Role::Criterion => {
            let result = quote! { ::core::primitive::f32 };
            let about = "The value by which the worst fragment, the one of the greatest, is found.";
            (format_ident!("criterion"), format_ident!("criterion"), about, one, result)
        }
        Role::Admit(index) => {
            let result = quote! { ::core::primitive::bool };
            let about = "Whether a fragment may enter, as far as this constraint goes.";
            (format_ident!("admit_{index}"), format_ident!("constraint_{index}"), about, one, result)
        }
        Role::Resolve => {
            let result = quote! { #serving::glam::Vec4 };
            let about = "What becomes of the kept fragments of a pixel, in the order in which they are handed over.";
            (format_ident!("resolve"), format_ident!("resolve"), about, list, result)
        }
        Role::Helper(_) => return None,
    };
    Some(Shape { inner, outer, about, first, reference, result })
}

fn outer(written: &Written, source: &Source) -> TokenStream {
    let Some(Shape { inner, outer, about, reference, result, .. }) = shape(&written.role, source) else {
        return TokenStream::new();
    };
    let serving = &source.front.serving;
    let first = match written.role {
        Role::Resolve => quote! { #serving::Fragments::new(first) },
        _ => quote! { *first },
    };
    let call = quote! { functions::#inner(#first, *uniforms) };
    let body = match source.bodies {
        Bodies::Compiled => call,
        Bodies::ForEditors => quote! {
            #[cfg(rust_analyzer)]
            { return #call; }
            #[cfg(not(rust_analyzer))]
            { let _ = (first, uniforms); ::core::unreachable!() }
        },
    };
    quote! {
        #[doc = #about]
        pub fn #outer(first: #reference, uniforms: &Uniforms) -> #result { #body }
    }
}

fn inner(written: &Written, source: &Source) -> TokenStream {
    let Some(Shape { inner, about, first, result, .. }) = shape(&written.role, source) else {
        let tokens = &written.tokens;
        return quote! {
            /// A helper function.
            pub #tokens
        };
    };
    let Closure { parameters, body } = Closure::of(&written.tokens);
    let mut names = parameters.into_iter().filter(|name| !name.is_empty()).chain([quote! { _ }, quote! { _ }]);
    let (one, two) = (names.next(), names.next());
    quote! {
        #[doc = #about]
        pub fn #inner(#one: #first, #two: Uniforms) -> #result #body
    }
}

/// The parts of a closure that a function is made of.
struct Closure {
    /// Their names, with `mut`, without types.
    parameters: Vec<TokenStream>,
    /// A block.
    body: TokenStream,
}

impl Closure {
    fn of(tokens: &TokenStream) -> Self {
        let tokens: Vec<TokenTree> = tokens.clone().into_iter().skip(1).collect();
        let bar = tokens.iter().position(|token| is_sign(token, '|')).unwrap_or(tokens.len());
        let (parameters, rest) = tokens.split_at(bar);
        let name =
            |parameter: &[TokenTree]| parameter.iter().take_while(|token| !is_sign(token, ':')).cloned().collect();
        let parameters = parameters.split(|token| is_sign(token, ',')).map(name).collect();
        Closure { parameters, body: block(rest.get(1..).unwrap_or_default()) }
    }
}

/// The body of a closure as the block of a function.
fn block(tokens: &[TokenTree]) -> TokenStream {
    let is_block =
        |token: &TokenTree| matches!(token, TokenTree::Group(group) if group.delimiter() == Delimiter::Brace);
    let has_type = tokens.first().is_some_and(|token| is_sign(token, '-'))
        && tokens.get(1).is_some_and(|token| is_sign(token, '>'));
    match tokens {
        [only] if is_block(only) => quote! { #only },
        [.., last] if has_type && is_block(last) => quote! { #last },
        // In parentheses: what begins with a block is no statement here.
        _ => quote! { { (#(#tokens)*) } },
    }
}

fn is_sign(token: &TokenTree, sign: char) -> bool {
    matches!(token, TokenTree::Punct(punct) if punct.as_char() == sign)
}
