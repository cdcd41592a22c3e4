//! A named point on the axes: a technique of a paper, and a preset to start a description from.

/// One technique.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Technique {
    /// The word of the language.
    pub key: String,
    /// The paper's name for it.
    pub title: &'static str,
    /// Paper and section.
    pub paper: &'static str,
    /// What it does, in one line.
    pub summary: &'static str,
    /// How many fragments it keeps when nothing is said.
    pub keep: KeepDefault,
    /// Its choices, as (axis, value); the value may be `a else b`.
    pub choices: Vec<(&'static str, &'static str)>,
}

/// How many fragments a technique keeps when the description does not say.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum KeepDefault {
    /// Every one.
    All,
    /// The k best.
    Best(u32),
}
