//! A description that passed our rules. The only maker is [`crate::check`]: to hold a [`Variant`] is proof of the check.

use std::fmt::Write as _;
use std::ops::Deref;
use std::sync::Arc;

use fragbuf_templates::vocabulary::{Capability, Fact, Given, Kept, Merges, Row, Soundness};

use crate::check::given;
use crate::{Attribute, Origin, Spanned, Uniform, UserFunction};

/// A checked fragment buffer.
#[derive(Clone, Debug, PartialEq)]
pub struct Variant(Description);

/// What a [`Variant`] says. Plain data; only its wrapper is proof of anything.
#[derive(Clone, Debug, PartialEq)]
pub struct Description {
    /// The buffer's name.
    pub name: Spanned<String>,
    /// The technique that it started from.
    pub technique: Option<String>,
    /// What a fragment carries, in the user's order; one of them is `depth`.
    pub attributes: Vec<Attribute>,
    /// Values that are the same for a whole pass.
    pub uniforms: Vec<Uniform>,
    /// How many fragments a pixel keeps; `None`: all.
    pub keep: Option<u32>,
    /// h(f); `None`: depth.
    pub criterion: Option<UserFunction>,
    /// A fragment enters iff all return true.
    pub constraints: Vec<UserFunction>,
    /// The description's own effect; `None`: the one chosen on the axis `resolve`.
    pub resolve: Option<UserFunction>,
    /// Functions that the others call.
    pub helpers: Vec<UserFunction>,
    /// One entry per axis, in the order of the axes.
    pub choices: Vec<Chosen>,
}

/// The choice on one axis, in order of preference.
#[derive(Clone, Debug, PartialEq)]
pub struct Chosen {
    /// The axis.
    pub axis: String,
    /// Where it was said; the place of the preset or the name where nobody said it.
    pub origin: Origin,
    /// At least one.
    pub alternatives: Vec<Selected>,
}

/// One row, with the numbers that a user set on it.
#[derive(Clone, Debug, PartialEq)]
pub struct Selected {
    /// The row, shared by everything that is made from the variant.
    pub row: Arc<Row>,
    /// (parameter, value) for those that were set.
    pub options: Vec<(String, u32)>,
}

/// One row per axis: what a plan is made from.
#[derive(Clone, Debug, PartialEq)]
pub struct Selection {
    /// In the order of the axes.
    pub rows: Vec<Selected>,
}

impl Variant {
    pub(crate) fn proven(description: Description) -> Self {
        Variant(description)
    }

    /// What the description gives to conditions of the rows of a selection.
    pub fn given(&self, selection: &Selection) -> Given {
        let rows = selection.rows.iter().map(|selected| &*selected.row);
        with_carried(given(&self.attributes, self.criterion.as_ref(), self.keep), rows)
    }

    /// The rows for a target with the capabilities `target`: the first alternative on each axis that it can express. `Err`:
    /// the last alternative of an axis, and what it needs.
    pub fn select(&self, target: &[Capability]) -> Result<Selection, Refusal> {
        let mut rows = Vec::with_capacity(self.choices.len());
        for chosen in &self.choices {
            let mut refusal = None;
            for selected in &chosen.alternatives {
                match missing_on_target(&selected.row, target) {
                    None => {
                        rows.push(selected.clone());
                        refusal = None;
                        break;
                    }
                    Some(capability) => {
                        let (axis, value) = (chosen.axis.clone(), selected.row.key.clone());
                        refusal = Some(Refusal { axis, value, capability });
                    }
                }
            }
            if let Some(refusal) = refusal {
                return Err(refusal);
            }
        }
        Ok(Selection { rows })
    }
}

impl Deref for Variant {
    type Target = Description;

    fn deref(&self) -> &Description {
        &self.0
    }
}

/// Why a target cannot express a variant.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Refusal {
    /// The axis of the row that needs more.
    pub axis: String,
    /// The row.
    pub value: String,
    /// What it needs.
    pub capability: Capability,
}

impl std::fmt::Display for Refusal {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "`{}: {}` requires {}", self.axis, self.value, self.capability.meaning())
    }
}

/// The same with the words that these rows carry.
pub(crate) fn with_carried<'a>(given: Given, rows: impl Iterator<Item = &'a Row>) -> Given {
    let carried: usize = rows.map(|row| row.carries.len()).sum();
    Given { payload_words: given.payload_words + carried as u32, ..given }
}

fn missing_on_target(row: &Row, target: &[Capability]) -> Option<Capability> {
    row.needs.iter().copied().find(|capability| !target.contains(capability))
}

impl Selection {
    /// The first alternative on every axis.
    pub fn first(variant: &Variant) -> Self {
        Selection { rows: variant.choices.iter().filter_map(|chosen| chosen.alternatives.first().cloned()).collect() }
    }

    /// The last alternative on every axis.
    pub fn last(variant: &Variant) -> Self {
        Selection { rows: variant.choices.iter().filter_map(|chosen| chosen.alternatives.last().cloned()).collect() }
    }

    /// The row on one axis.
    pub fn row(&self, axis: &str) -> Option<&Selected> {
        self.rows.iter().find(|selected| selected.row.axis == axis)
    }

    /// What the safety of the whole rests on: the weakest of its rows.
    pub fn soundness(&self) -> Soundness {
        self.rows.iter().map(|selected| selected.row.soundness).max().unwrap_or(Soundness::Atomics)
    }

    /// The files of the user's own among the rows' templates, by their names in messages.
    pub fn own_files(&self) -> impl Iterator<Item = &str> {
        self.rows.iter().filter_map(|selected| selected.row.template.as_ref()?.own.as_deref())
    }

    /// Which fragments stay, as the row says that stores them; `None`: none says so.
    pub fn kept(&self) -> Option<Kept> {
        self.rows.iter().find_map(|selected| selected.row.kept())
    }

    /// How entries become one, where a row merges them.
    pub fn merges(&self) -> Option<&Merges> {
        self.rows.iter().find_map(|selected| selected.row.merges.as_ref())
    }

    /// Everything that the rows offer.
    pub fn offers(&self) -> Vec<Fact> {
        self.rows.iter().flat_map(|selected| selected.row.offers.iter().copied()).collect()
    }

    /// `axis=value` for every axis, options in brackets.
    pub fn describe(&self) -> String {
        let mut text = String::new();
        for selected in &self.rows {
            let separator = if text.is_empty() { "" } else { " " };
            let _ = write!(text, "{separator}{}={}", selected.row.axis, selected.row.key);
            for (name, value) in &selected.options {
                let _ = write!(text, "[{name}={value}]");
            }
        }
        text
    }
}
