//! The builder: a program describes a fragment buffer at run time, part by part.
//!
//! Input: names, formats, and closures that `closure!` captured, each with the span of the call. Output: the [`Draft`] that
//! a file or the macro gives for the same description, or every error. `fragbuf-syntax` checks grammar and types, and
//! lowers closures.

mod choice;
mod function;

pub use fragbuf_model::KeepCount;
use fragbuf_model::{Diagnostics, Draft, SourceSpan, Spanned, Variant};
use fragbuf_syntax::{Parsed, Part, Parts, assemble};
use fragbuf_templates::Registry;
use std::panic::Location;

pub use crate::{closure, function};
pub use choice::{Value, value};
pub use fragbuf_model::{Format, OptionValue, TextureDimension, UniformType};
pub use function::{Closure, Function};

/// A description that is built part by part. As in a file, only the order of attributes, of uniforms and of constraints
/// matters.
#[derive(Clone, Debug)]
#[must_use = "call `.draft()` or `.variant()`"]
pub struct Buffer {
    parts: Parts,
}

impl Buffer {
    /// Starts `buffer Name`; the name is an UpperCamel identifier.
    #[track_caller]
    pub fn named(name: impl Into<String>) -> Self {
        Buffer { parts: Parts { name: at_caller(name.into()), preset: None, items: Vec::new() } }
    }

    /// Sets `from technique`, a technique of the registry. A later call replaces it.
    #[track_caller]
    pub fn from(mut self, technique: impl Into<String>) -> Self {
        self.parts.preset = Some(at_caller(technique.into()));
        self
    }

    /// Adds an attribute to `fragment { }`. Without any, the payload is `color: rgba8, depth: f32`.
    #[track_caller]
    pub fn attribute(self, name: impl Into<String>, format: Format) -> Self {
        let name = at_caller(name.into());
        self.with(Part::Attribute(name, format))
    }

    /// Adds a uniform to `uniform { }`.
    #[track_caller]
    pub fn uniform(self, name: impl Into<String>, kind: UniformType) -> Self {
        let name = at_caller(name.into());
        self.with(Part::Uniform(name, kind))
    }

    /// Adds a texture to `texture { }`, which the caller supplies.
    #[track_caller]
    pub fn texture(self, name: impl Into<String>, dimension: TextureDimension) -> Self {
        let name = at_caller(name.into());
        self.with(Part::Texture(name, dimension))
    }

    /// Sets `keep 8;`, or `keep all;` with [`KeepCount::All`].
    #[track_caller]
    pub fn keep(self, count: impl Into<KeepCount>) -> Self {
        let count = at_caller(count.into());
        self.with(Part::Keep(count, None))
    }

    /// Sets `keep 8 least |f| …;`: a pixel keeps the fragments with the least values.
    #[track_caller]
    pub fn keep_least(self, count: impl Into<KeepCount>, criterion: Closure) -> Self {
        let count = at_caller(count.into());
        self.with(Part::Keep(count, Some(criterion.0)))
    }

    /// Adds `where |f, u| …;`: a fragment is admitted iff all constraints are true.
    pub fn constraint(self, constraint: Closure) -> Self {
        self.with(Part::Constraint(constraint.0))
    }

    /// Adds the choice `axis: value { option: number } else value;`.
    #[track_caller]
    pub fn choose(self, axis: impl Into<String>, value: impl Into<Value>) -> Self {
        let axis = at_caller(axis.into());
        let choice = value.into().on(axis);
        self.with(Part::Choice(choice))
    }

    /// Sets `resolve |fragments, u| { … }`. A named effect is a choice: `.choose("resolve", "over")`.
    #[track_caller]
    pub fn resolve(self, effect: Closure) -> Self {
        let span = at_caller(()).span;
        self.with(Part::Resolve(effect.0, span))
    }

    /// Sets `between |front, back, gap, u| { … }`: the effect as the value of two neighbouring fragments.
    #[track_caller]
    pub fn between(self, effect: Closure) -> Self {
        let span = at_caller(()).span;
        self.with(Part::Between(effect.0, span))
    }

    /// Adds `image name |fragments, u| { … }`, which later images and the effect can read.
    #[track_caller]
    pub fn image(self, name: impl Into<String>, image: Closure) -> Self {
        let name = at_caller(name.into());
        self.with(Part::Image(name, image.0))
    }

    /// Adds `fn name(…) -> … { … }`, which closures and other helpers can call.
    pub fn helper(self, function: Function) -> Self {
        self.with(Part::Helper(function.0))
    }

    /// Parses the description: the draft without the parts that have errors, and all diagnostics.
    pub fn parse(&self) -> Parsed {
        assemble(&self.parts)
    }

    /// Returns the draft, or all errors in its names and closures.
    pub fn draft(&self) -> Result<Draft, Diagnostics> {
        let Parsed { draft, diagnostics } = self.parse();
        let draft = draft.unwrap_or_else(|| Draft::empty(self.parts.name.clone()));
        diagnostics.into_result(draft)
    }

    /// Checks the description. Returns the variant, or all errors.
    pub fn variant(&self, registry: &Registry) -> Result<Variant, Diagnostics> {
        self.parse().check(registry)
    }

    fn with(mut self, part: Part) -> Self {
        self.parts.items.push(part);
        self
    }
}

/// Returns a value with the span of the caller.
#[track_caller]
fn at_caller<T>(value: T) -> Spanned<T> {
    let location = Location::caller();
    Spanned::new(value, SourceSpan::new(location.file(), location.line(), location.column()))
}
