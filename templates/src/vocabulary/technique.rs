//! Techniques: named points on the axes, which descriptions can start from.

/// A technique of a paper.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Technique {
    /// The keyword of the language.
    pub key: String,
    /// The paper's name for it.
    pub title: &'static str,
    /// Paper and section.
    pub paper: &'static str,
    /// What it does, in one line.
    pub summary: &'static str,
    /// The default number of fragments kept.
    pub keep: KeepDefault,
    /// The choices as (axis, value); the value can be `a else b`.
    pub choices: Vec<(&'static str, &'static str)>,
}

/// The number of fragments that a technique keeps by default.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum KeepDefault {
    /// Every fragment.
    All,
    /// The k best.
    Best(u32),
}
