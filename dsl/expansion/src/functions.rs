//! The closures and helpers of a description as Rust functions, made of the user's own tokens: the compiler checks them
//! too, and a program can call them.
//!
//! Input: the tokens of the functions. Output: a module `functions` in which everything is passed by value, as in the language,
//! and functions over references that call it. If the description has an error, the compiler gets only the signatures,
//! because it would repeat the diagnostics of the bodies. Editors get the bodies, to complete in them.

use fragbuf_syntax::{FunctionTokens, Role};
use proc_macro2::{Delimiter, TokenStream, TokenTree};
use quote::{format_ident, quote};

use crate::module_source::{Bodies, ModuleSource};
use crate::textures::has_textures;

/// Returns the functions over references and the module `functions`.
pub(crate) fn functions(source: &ModuleSource) -> TokenStream {
    // Of functions with the same role, which is an error, only the first is emitted.
    let is_first_of_role = |index: usize, function: &FunctionTokens| {
        source.functions[..index].iter().all(|earlier| earlier.role != function.role)
    };
    let functions = || source.functions.iter().enumerate().filter(|(index, one)| is_first_of_role(*index, one));
    let by_reference = functions().map(|(_, one)| by_reference(one, source));
    let by_value = functions().map(|(_, one)| by_value(one, source));
    let serving = &source.input.serving;
    // With textures, the uniforms and the textures are one parameter.
    let uniforms = match has_textures(source.draft) {
        true => quote! { Inputs as Uniforms },
        false => quote! { Uniforms },
    };
    let module = quote! {
        /// The functions as the user wrote them; parameters and results are passed by value, as in the language.
        pub mod functions {
            use super::#uniforms;
            use super::Fragment;
            use #serving::glam::swizzles::{Vec2Swizzles as _, Vec3Swizzles as _, Vec4Swizzles as _};
            use #serving::glam::{Vec2, Vec3, Vec4, vec2, vec3, vec4};
            // The module, for `f32::consts`; the primitive type stays in scope.
            use ::core::f32;

            #(#by_value)*
        }
    };
    let module = match source.bodies {
        Bodies::Compiled => module,
        // The compiler does not parse tokens inside a macro call, so they need not be Rust.
        Bodies::ForEditors => quote! { #[cfg(rust_analyzer)] #serving::as_written! { #module } },
    };
    quote! { #(#by_reference)* #module }
}

/// The name, the parameters and the result of the function of a role.
struct FunctionSignature {
    /// The name in `functions`, as in the generated WGSL.
    inner_name: proc_macro2::Ident,
    name: proc_macro2::Ident,
    about: &'static str,
    parameters: Vec<Parameter>,
    result: TokenStream,
}

/// A parameter before the uniforms.
struct Parameter {
    name: proc_macro2::Ident,
    /// The type in `functions`.
    by_value: TokenStream,
    /// The type in the function over references.
    by_reference: TokenStream,
    /// The argument that the function over references passes on.
    passed: TokenStream,
}

fn signature(role: &Role, source: &ModuleSource) -> Option<FunctionSignature> {
    let serving = &source.input.serving;
    let fragment = |name: &str| {
        let name = format_ident!("{name}");
        let passed = quote! { *#name };
        Parameter { name, by_value: quote! { Fragment }, by_reference: quote! { &Fragment }, passed }
    };
    let fragments = || Parameter {
        name: format_ident!("fragments"),
        by_value: quote! { #serving::Fragments<'_, Fragment> },
        by_reference: quote! { &[Fragment] },
        passed: quote! { #serving::Fragments::new(fragments) },
    };
    let color = || quote! { #serving::glam::Vec4 };
    let (inner_name, name, about, parameters, result) = match role {
        Role::Criterion => {
            let result = quote! { ::core::primitive::f32 };
            let about = "The criterion: the fragment with the greatest value is the worst.";
            (format_ident!("criterion"), format_ident!("criterion"), about, vec![fragment("fragment")], result)
        }
        Role::Constraint(index) => {
            let result = quote! { ::core::primitive::bool };
            let about = "Whether a fragment meets this constraint.";
            (
                format_ident!("admit_{index}"),
                format_ident!("constraint_{index}"),
                about,
                vec![fragment("fragment")],
                result,
            )
        }
        Role::Resolve => {
            let about = "The result of a pixel from its kept fragments, in the given order.";
            (format_ident!("resolve"), format_ident!("resolve"), about, vec![fragments()], color())
        }
        Role::Between => {
            let about = "The premultiplied colour from a fragment to the next, `gap` behind it in depth.";
            let float = quote! { ::core::primitive::f32 };
            let name = format_ident!("gap");
            let gap = Parameter { by_value: float.clone(), by_reference: float, passed: quote! { gap }, name };
            let parameters = vec![fragment("front"), fragment("back"), gap];
            (format_ident!("between"), format_ident!("between"), about, parameters, color())
        }
        Role::Image(image) => {
            let about = "The value of an image at a pixel, from its kept fragments, in the given order.";
            let name = format_ident!("image_{image}");
            (name.clone(), name, about, vec![fragments()], color())
        }
        Role::Helper(_) => return None,
    };
    Some(FunctionSignature { inner_name, name, about, parameters, result })
}

fn by_reference(function: &FunctionTokens, source: &ModuleSource) -> TokenStream {
    let Some(signature) = signature(&function.role, source) else { return TokenStream::new() };
    let FunctionSignature { inner_name, name, about, parameters, result } = signature;
    let passed = parameters.iter().map(|parameter| &parameter.passed);
    let names = parameters.iter().map(|parameter| &parameter.name);
    let types = parameters.iter().map(|parameter| &parameter.by_reference);
    let (inputs, textures) = match has_textures(source.draft) {
        true => (quote! { Inputs::new(*uniforms, *textures) }, quote! { , textures: &Textures<'_> }),
        false => (quote! { *uniforms }, TokenStream::new()),
    };
    let unused = parameters.iter().map(|parameter| &parameter.name);
    let call = quote! { functions::#inner_name(#(#passed,)* #inputs) };
    let body = match source.bodies {
        Bodies::Compiled => call,
        Bodies::ForEditors => quote! {
            #[cfg(rust_analyzer)]
            { return #call; }
            #[cfg(not(rust_analyzer))]
            { let _ = (#(#unused,)* uniforms); ::core::unreachable!() }
        },
    };
    quote! {
        #[doc = #about]
        pub fn #name(#(#names: #types,)* uniforms: &Uniforms #textures) -> #result { #body }
    }
}

fn by_value(function: &FunctionTokens, source: &ModuleSource) -> TokenStream {
    let Some(signature) = signature(&function.role, source) else {
        let tokens = &function.tokens;
        return quote! {
            /// A helper function.
            pub #tokens
        };
    };
    let FunctionSignature { inner_name, about, parameters: given, result, .. } = signature;
    let Closure { parameters, body } = Closure::of(&function.tokens);
    let mut names = parameters.into_iter().filter(|name| !name.is_empty()).chain(std::iter::repeat(quote! { _ }));
    let first =
        given.iter().map(|parameter| &parameter.by_value).zip(names.by_ref()).map(|(ty, name)| quote! { #name: #ty });
    let first: Vec<TokenStream> = first.collect();
    let uniforms = names.next();
    quote! {
        #[doc = #about]
        pub fn #inner_name(#(#first,)* #uniforms: Uniforms) -> #result #body
    }
}

/// The parts of a closure that a function is made of.
struct Closure {
    /// The names of the parameters, with `mut`, without types.
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

/// Returns the body of a closure as the block of a function.
fn block(tokens: &[TokenTree]) -> TokenStream {
    let is_block =
        |token: &TokenTree| matches!(token, TokenTree::Group(group) if group.delimiter() == Delimiter::Brace);
    let has_type = tokens.first().is_some_and(|token| is_sign(token, '-'))
        && tokens.get(1).is_some_and(|token| is_sign(token, '>'));
    match tokens {
        [only] if is_block(only) => quote! { #only },
        [.., last] if has_type && is_block(last) => quote! { #last },
        // In parentheses: an expression that begins with a block is not parsed as a statement.
        _ => quote! { { (#(#tokens)*) } },
    }
}

fn is_sign(token: &TokenTree, sign: char) -> bool {
    matches!(token, TokenTree::Punct(punct) if punct.as_char() == sign)
}
