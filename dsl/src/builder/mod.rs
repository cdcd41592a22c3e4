//! The builder: a fragment buffer described by a running program, part by part.
//!
//! In: words, formats, and closures as `closure!` keeps them, each with the place where the program says it. Out: the
//! same [`Draft`] that a file or the macro gives for the same description, or every mistake. Nothing is checked here:
//! grammar, types and lowering are `fragbuf-syntax`'s.

mod choice;
mod function;

pub use fragbuf_model::KeepCount;
use fragbuf_model::{Diagnostics, Draft, Origin, Spanned, Variant};
use fragbuf_syntax::{Parsed, Part, Parts, assemble};
use fragbuf_templates::Registry;
use std::panic::Location;

pub use crate::{closure, function};
pub use choice::{Value, value};
pub use fragbuf_model::{Format, OptionValue, UniformType};
pub use function::{Closure, Function};

/// A description in the making. Order matters only where it does in a file: among attributes, uniforms and constraints.
#[derive(Clone, Debug)]
#[must_use = "a description does nothing until its draft is taken"]
pub struct Buffer {
    parts: Parts,
}

impl Buffer {
    /// `buffer Name`: an UpperCamel identifier.
    #[track_caller]
    pub fn named(name: impl Into<String>) -> Self {
        Buffer { parts: Parts { name: here(name.into()), preset: None, items: Vec::new() } }
    }

    /// `from technique`: a technique of the registry. The last call counts.
    #[track_caller]
    pub fn from(mut self, technique: impl Into<String>) -> Self {
        self.parts.preset = Some(here(technique.into()));
        self
    }

    /// A row of `fragment { }`. Without any, a fragment carries `color: rgba8` and `depth: f32`.
    #[track_caller]
    pub fn attribute(self, name: impl Into<String>, format: Format) -> Self {
        let name = here(name.into());
        self.with(Part::Attribute(name, format))
    }

    /// A row of `uniform { }`.
    #[track_caller]
    pub fn uniform(self, name: impl Into<String>, kind: UniformType) -> Self {
        let name = here(name.into());
        self.with(Part::Uniform(name, kind))
    }

    /// `keep 8;`, or `keep all;` with [`KeepCount::All`].
    #[track_caller]
    pub fn keep(self, count: impl Into<KeepCount>) -> Self {
        let count = here(count.into());
        self.with(Part::Keep(count, None))
    }

    /// `keep 8 least |f| …;`: those of the least value stay.
    #[track_caller]
    pub fn keep_least(self, count: impl Into<KeepCount>, criterion: Closure) -> Self {
        let count = here(count.into());
        self.with(Part::Keep(count, Some(criterion.0)))
    }

    /// `where |f, u| …;`: a fragment enters iff all of these are true.
    pub fn admit(self, constraint: Closure) -> Self {
        self.with(Part::Constraint(constraint.0))
    }

    /// `axis: value { option: number } else value;`
    #[track_caller]
    pub fn choose(self, axis: impl Into<String>, value: impl Into<Value>) -> Self {
        let axis = here(axis.into());
        let choice = value.into().on(axis);
        self.with(Part::Choice(choice))
    }

    /// `resolve |fragments, u| { … }`. A named effect is a choice: `.choose("resolve", "over")`.
    #[track_caller]
    pub fn resolve(self, effect: Closure) -> Self {
        let place = here(()).origin;
        self.with(Part::Resolve(effect.0, place))
    }

    /// `fn name(…) -> … { … }`, which closures and other helpers call.
    pub fn helper(self, function: Function) -> Self {
        self.with(Part::Helper(function.0))
    }

    /// The draft as far as it could be understood, with all that is wrong.
    pub fn parse(&self) -> Parsed {
        assemble(&self.parts)
    }

    /// The draft, or all that is wrong with its words and closures.
    pub fn draft(&self) -> Result<Draft, Diagnostics> {
        let Parsed { draft, diagnostics } = self.parse();
        let draft = draft.unwrap_or_else(|| Draft::empty(self.parts.name.clone()));
        diagnostics.gate(draft)
    }

    /// The variant, or all that is wrong with the description.
    pub fn variant(&self, registry: &Registry) -> Result<Variant, Diagnostics> {
        self.parse().check(registry)
    }

    fn with(mut self, part: Part) -> Self {
        self.parts.items.push(part);
        self
    }
}

/// A value at the caller's place.
#[track_caller]
pub(crate) fn here<T>(value: T) -> Spanned<T> {
    let place = Location::caller();
    Spanned::new(value, Origin::new(place.file(), place.line(), place.column()))
}
