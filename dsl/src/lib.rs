//! The language of fragment buffers with its three front ends: `.fragbuf` files ([`parse`]), the macro
//! [`fragment_buffer!`], and the [`builder`]. Equal descriptions give equal [`Draft`]s and the same diagnostics in every
//! front end.
//!
//! This crate is the facade of the language: it re-exports the other crates and defines the runtime types of expanded
//! code. It depends on no GPU crate; `fragbuf` adds the generation of passes.
//!
//! ```
//! fragbuf_dsl::fragment_buffer! {
//!     pub buffer Glass from kplus_array {
//!         fragment { color: rgba8, depth: f32 }
//!         uniform { far: f32 }
//!         keep 4 least |f| f.depth - 0.25 * f.color.w;
//!         where |f, u| f.depth < u.far;
//!     }
//! }
//!
//! let near = glass::Fragment { depth: 0.5, ..Default::default() };
//! let uniforms = glass::Uniforms { far: 0.75, ..Default::default() };
//! assert!(glass::constraint_0(&near, &uniforms));
//! assert_eq!(glass::criterion(&near, &uniforms), 0.5);
//!
//! use fragbuf_dsl::builder::{Buffer, Format, UniformType};
//! use fragbuf_dsl::closure;
//! let built = Buffer::named("Glass")
//!     .from("kplus_array")
//!     .attribute("color", Format::Rgba8)
//!     .attribute("depth", Format::F32)
//!     .uniform("far", UniformType::F32)
//!     .keep_least(4, closure!(|f| f.depth - 0.25 * f.color.w))
//!     .constraint(closure!(|f, u| f.depth < u.far));
//! assert_eq!(built.draft(), Ok(glass::draft()));
//! ```

pub mod builder;
mod expanded;
mod textures;

pub use expanded::{Fragments, UniformValue};
pub use fragbuf_model::{Diagnostic, Diagnostics, Draft, SourceSpan, Variant, check};
pub use fragbuf_syntax::{CapturedTokens, Parsed, parse};
pub use fragbuf_templates::Registry;
pub use glam;
pub use textures::{Image, Texture2d, Texture3d};

#[doc(hidden)]
pub use fragbuf_macros as macros;

/// Describes a fragment buffer in Rust, with the grammar of `.fragbuf` files; documentation and a visibility may precede it.
///
/// It emits a module named after the buffer (`MostVisible`: `most_visible`) with
///
/// * `Fragment`, the attributes in [`glam`]'s types, and `Uniforms`, laid out as on the GPU, with `SIZE` and `bytes()`;
/// * `criterion`, `constraint_0` …, `resolve`, `between`, `image_name`: the closures of the description as functions; its helper functions
///   are in `functions`;
/// * `Textures`, if closures read textures or images: a further argument of these functions;
/// * `draft()` and `variant()`: the description as data, with source spans.
///
/// `fragbuf::fragment_buffer!` emits the binding numbers of the passes in addition, in a module `bindings`.
///
/// The functions have Rust's semantics: they panic where a shader continues with some value (a sum that overflows, an index
/// beyond the list, a `clamp` with crossed bounds).
///
/// An error is a compiler error at the user's token: `[code] message`, with a help text. The description is checked against
/// fragbuf's own registry; for user files, use a `.fragbuf` file or the builder.
#[macro_export]
macro_rules! fragment_buffer {
    ($($description:tt)*) => { $crate::macros::fragment_buffer! { [$crate] $($description)* } };
}

/// Emits nothing: binding numbers follow from the plan, which the language does not have. The macro of this name in `fragbuf`
/// emits them.
#[doc(hidden)]
#[macro_export]
macro_rules! bindings {
    ($($description:tt)*) => {};
}

/// Emits the items unchanged.
#[doc(hidden)]
#[macro_export]
macro_rules! as_written {
    ($($items:tt)*) => { $($items)* };
}

/// Captures a closure for the [`builder`], with its source spans: `closure!(|f| f.depth - 0.25 * f.color.w)`.
#[macro_export]
macro_rules! closure {
    ($($closure:tt)*) => { $crate::macros::closure! { [$crate] $($closure)* } };
}

/// Captures a helper function for the [`builder`], with its source spans: `function!(fn twice(x: f32) -> f32 { x * 2.0 })`.
#[macro_export]
macro_rules! function {
    ($($function:tt)*) => { $crate::macros::function! { [$crate] $($function)* } };
}
