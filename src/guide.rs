//! The guide. Read it in this order; each chapter can also be read alone.
//!
//! 1. [`describe`]: payload, criterion, constraints, choices, effect; in a file, in Rust, by a program.
//! 2. [`axes`]: every choice with its values, and [`language`]: the reference of the closure language.
//! 3. [`generate`]: files for engines, build scripts, tiers.
//! 4. [`manifest`]: how an engine in any language runs a frame.
//! 5. [`run`]: images and statistics from the command line.
//! 6. [`memory`]: k from a memory budget and a hit ratio, and [`peeling`]: every fragment in little memory.
//! 7. [`figures`]: experiments of the papers, with the comparison of their trends.
//! 8. [`embed`]: frames in your own engine, and [`material`]: a shader of your own that stores fragments.
//! 9. [`extend`]: your own storage, snapshots.
//! 10. [`check`]: the checker, which runs the fragments of a pixel in every interleaving.
//! 11. [`verdict`]: what a verdict of the checker means, and what it does not.
//! 12. [`diagnostics`]: error messages, and how to read them; [`codes`]: every code with its cause, an example and the fix.

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
#[doc = include_str!("guide/memory.md")]
pub mod memory {}
#[doc = include_str!("guide/peeling.md")]
pub mod peeling {}
#[doc = include_str!("guide/figures.md")]
pub mod figures {}
#[cfg(feature = "gpu")]
#[doc = include_str!("guide/embed.md")]
pub mod embed {}
#[cfg(feature = "gpu")]
#[doc = include_str!("guide/material.md")]
pub mod material {}
#[doc = include_str!("guide/extend.md")]
pub mod extend {}
#[doc = include_str!("guide/check.md")]
pub mod check {}
#[doc = include_str!("guide/verdict.md")]
pub mod verdict {}
#[doc = include_str!("guide/diagnostics.md")]
pub mod diagnostics {}
#[doc = include_str!("guide/codes.md")]
#[doc = include_str!("guide/model_warnings.md")]
pub mod codes {}

/// The chapter [`codes`] as Markdown: descriptions, then models.
const CODES: [&str; 2] = [include_str!("guide/codes.md"), include_str!("guide/model_warnings.md")];

/// Returns the sections about a code of a diagnostic, from the chapter [`codes`]. Descriptions and models share two codes.
pub fn explanation(code: &str) -> Option<String> {
    let heading = format!("## `{code}`\n");
    let section = |part: &&'static str| {
        let start = part.find(&heading)?;
        let rest = part.get(start + heading.len()..)?;
        let end = rest.find("\n## ").map_or(rest.len(), |end| end + 1);
        part.get(start..start + heading.len() + end)
    };
    let sections: Vec<&str> = CODES.iter().filter_map(section).collect();
    (!sections.is_empty()).then(|| sections.join("\n"))
}
