//! The language of fragment buffers, whole: `.fragbuf` files ([`parse`]), the macro [`fragment_buffer!`], and the
//! [`builder`]. Equal descriptions make equal [`Draft`]s and have the same mistakes, whichever door they come through.
//!
//! This crate is the language's facade: it re-exports, and holds the little that expanded code needs at run time. It
//! depends on no GPU crate: `fragbuf` adds the generation of passes.
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
//!     .admit(closure!(|f, u| f.depth < u.far));
//! assert_eq!(built.draft(), Ok(glass::draft()));
//! ```

pub mod builder;
mod expanded;

pub use expanded::{Fragments, UniformValue};
pub use fragbuf_model::{Diagnostic, Diagnostics, Draft, Origin, Variant, check};
pub use fragbuf_syntax::{Captured, Parsed, parse};
pub use fragbuf_templates::Registry;
pub use glam;

#[doc(hidden)]
pub use fragbuf_macros as macros;

/// A fragment buffer described in Rust: the grammar of `.fragbuf` files, a visibility and documentation in front.
///
/// It becomes a module named after the buffer (`MostVisible`: `most_visible`) with
///
/// * `Fragment`, the attributes in [`glam`]'s types, and `Uniforms`, laid out as on the GPU, with `SIZE` and `bytes()`;
/// * `criterion`, `constraint_0` …, `resolve`: the closures as functions, as far as the description has them; its helper
///   functions in `functions`;
/// * `bindings`: the numbers of uniform blocks and buffers in the bind group, as far as they are the same on every target;
/// * `draft()` and `variant()`: the description as data, with the places where it was written.
///
/// The functions are Rust's: where a shader goes on with some value (a sum that overflows, an index beyond the list, a
/// `clamp` with crossed bounds), they panic as Rust does.
///
/// A mistake is an error at the user's own token, `[code] message` with a way out. The description is checked against
/// fragbuf's own registry; one that needs rows of a user's belongs into a file or the builder.
#[macro_export]
macro_rules! fragment_buffer {
    ($($description:tt)*) => { $crate::macros::fragment_buffer! { [$crate] $($description)* } };
}

/// These items, as they are.
#[doc(hidden)]
#[macro_export]
macro_rules! as_written {
    ($($items:tt)*) => { $($items)* };
}

/// A closure for the [`builder`], captured with its places: `closure!(|f| f.depth - 0.25 * f.color.w)`.
#[macro_export]
macro_rules! closure {
    ($($closure:tt)*) => { $crate::macros::closure! { [$crate] $($closure)* } };
}

/// A helper function for the [`builder`], captured with its places: `function!(fn twice(x: f32) -> f32 { x * 2.0 })`.
#[macro_export]
macro_rules! function {
    ($($function:tt)*) => { $crate::macros::function! { [$crate] $($function)* } };
}
