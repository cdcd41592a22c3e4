//! The guide. Read it in this order; each chapter can also be read alone.
//!
//! 1. [`describe`]: payload, criterion, constraints, choices, effect; in a file, in Rust, by a program.
//! 2. [`axes`]: every choice with its values, [`language`]: the reference of the closure language, and [`effects`]: descriptions of the papers'
//!    effects, and how to write your own.
//! 3. [`generate`]: files for engines, build scripts, tiers.
//! 4. [`manifest`]: how an engine in any language runs a frame.
//! 5. [`run`]: images and statistics from the command line, [`playground`]: a page that shows both while you type, [`site`]: static pages
//!    for a web host.
//! 6. [`memory`]: k from a memory budget and a hit ratio, and [`peeling`]: every fragment in little memory.
//! 7. [`figures`]: experiments of the papers, with the comparison of their trends.
//! 8. [`embed`]: frames in your own engine, [`material`]: a shader of your own that stores fragments, [`browser`]: frames on a web page,
//!    [`opengl`]: frames by OpenGL and OpenGL ES, [`vulkan`]: a host for Vulkan, part by part, [`bevy`]: a plugin for Bevy.
//! 9. [`extend`]: your own storage, snapshots.
//! 10. [`check`]: the checker, which runs the fragments of a pixel in every interleaving.
//! 11. [`verdict`]: what a verdict of the checker means, and what it does not.
//! 12. [`editor`]: a language server for your editor.
//! 13. [`diagnostics`]: error messages, and how to read them; [`codes`]: every code with its cause, an example and the fix;
//!     [`counters`]: what a frame counts, with the cause of each loss and the fix.

#[doc = include_str!("guide/describe.md")]
pub mod describe {}
#[doc = include_str!("guide/language.md")]
pub mod language {}
#[doc = include_str!("guide/axes.md")]
pub mod axes {}
#[doc = include_str!("guide/effects.md")]
pub mod effects {}
#[doc = include_str!("guide/generate.md")]
pub mod generate {}
#[doc = include_str!("guide/manifest.md")]
pub mod manifest {}
#[doc = include_str!("guide/run.md")]
pub mod run {}
#[doc = include_str!("guide/playground.md")]
pub mod playground {}
#[doc = include_str!("guide/site.md")]
pub mod site {}
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
#[doc = include_str!("guide/browser.md")]
pub mod browser {}
#[doc = include_str!("guide/opengl.md")]
pub mod opengl {}
#[doc = include_str!("guide/vulkan.md")]
pub mod vulkan {}
#[doc = include_str!("guide/bevy.md")]
pub mod bevy {}
#[doc = include_str!("guide/extend.md")]
pub mod extend {}
#[doc = include_str!("guide/check.md")]
pub mod check {}
#[doc = include_str!("guide/verdict.md")]
pub mod verdict {}
#[doc = include_str!("guide/editor.md")]
pub mod editor {}
#[doc = include_str!("guide/diagnostics.md")]
pub mod diagnostics {}
#[doc = include_str!("guide/codes.md")]
#[doc = include_str!("guide/model_warnings.md")]
pub mod codes {}

#[doc = include_str!("guide/counters.md")]
pub mod counters {}

/// The chapters whose sections explain a name, as Markdown: diagnostics of descriptions, those of models, and counters.
const EXPLAINED: [&str; 3] =
    [include_str!("guide/codes.md"), include_str!("guide/model_warnings.md"), include_str!("guide/counters.md")];

/// Returns the sections about the code of a diagnostic, from the chapter [`codes`], or about a counter, from the chapter [`counters`].
/// Descriptions and models share two codes.
pub fn explanation(name: &str) -> Option<String> {
    let heading = format!("## `{name}`\n");
    let section = |part: &&'static str| {
        let start = part.find(&heading)?;
        let rest = part.get(start + heading.len()..)?;
        let end = rest.find("\n## ").map_or(rest.len(), |end| end + 1);
        part.get(start..start + heading.len() + end)
    };
    let sections: Vec<&str> = EXPLAINED.iter().filter_map(section).collect();
    (!sections.is_empty()).then(|| sections.join("\n"))
}
