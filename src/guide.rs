//! The guide. Read it in this order; each chapter stands alone.
//!
//! 1. [`describe`]: payload, criterion, constraints, choices, effect; in a file, in Rust, by a program.
//! 2. [`axes`]: every choice with its values, and [`language`]: what closures can say.
//! 3. [`generate`]: files for engines, build scripts, tiers.
//! 4. [`manifest`]: how an engine in any language runs a frame.
//! 5. [`run`]: pictures and figures from the command line.
//! 6. [`embed`]: frames in an engine of yours.
//! 7. [`extend`]: a storage of your own, snapshots.
//! 8. [`check`]: every order in which fragments of a pixel can come, tried.
//! 9. [`refusals`]: what goes wrong, and how to read it.

#[doc = include_str!("guide/describe.md")]
pub mod describe {}
#[doc = include_str!("guide/language.md")]
pub mod language {}
#[doc = include_str!("guide/axes.md")]
pub mod axes {}
#[doc = include_str!("guide/generate.md")]
pub mod generate {}
#[doc = include_str!("guide/manifest.md")]
pub mod manifest {}
#[doc = include_str!("guide/run.md")]
pub mod run {}
#[cfg(feature = "pictures")]
#[doc = include_str!("guide/embed.md")]
pub mod embed {}
#[doc = include_str!("guide/extend.md")]
pub mod extend {}
#[doc = include_str!("guide/check.md")]
pub mod check {}
#[doc = include_str!("guide/refusals.md")]
pub mod refusals {}
