//! A checked description. Only [`crate::check`] creates a [`Variant`], so a value of this type is proof of the check.

use std::fmt::Write as _;
use std::ops::Deref;
use std::sync::Arc;

use fragbuf_templates::vocabulary::{
    Capability, DescriptionValues, Feature, Formula, KeptFragments, Merges, Row, Soundness,
};

use crate::check::description_values;
use crate::{Attribute, Diagnostics, Image, SourceSpan, Spanned, Texture, Uniform, UserFunction};

/// A checked fragment buffer.
#[derive(Clone, Debug, PartialEq)]
pub struct Variant(Description);

/// The data of a [`Variant`]. Only the wrapper is proof of the check.
#[derive(Clone, Debug, PartialEq)]
pub struct Description {
    /// The buffer's name.
    pub name: Spanned<String>,
    /// The preset.
    pub technique: Option<String>,
    /// The payload, in the user's order; one attribute is `depth`.
    pub attributes: Vec<Attribute>,
    /// Values that are constant during a pass.
    pub uniforms: Vec<Uniform>,
    /// Textures that the caller supplies.
    pub textures: Vec<Texture>,
    /// The number of fragments that a pixel keeps; `None`: all.
    pub keep: Option<u32>,
    /// The span of this number, if the description gives it.
    pub keep_span: Option<SourceSpan>,
    /// h(f); `None`: depth.
    pub criterion: Option<UserFunction>,
    /// A fragment is admitted iff all return true.
    pub constraints: Vec<UserFunction>,
    /// The effect as a closure; `None`: the effect chosen on the axis `resolve`.
    pub resolve: Option<UserFunction>,
    /// The effect as a closure over two neighbouring fragments.
    pub between: Option<UserFunction>,
    /// Images that are computed before the effect, in order.
    pub images: Vec<Image>,
    /// Functions that the closures call.
    pub helpers: Vec<UserFunction>,
    /// One entry per axis, in the order of the axes.
    pub choices: Vec<AxisChoice>,
    /// What the description declares and nothing uses.
    pub warnings: Diagnostics,
}

/// The rows chosen on one axis, in order of preference.
#[derive(Clone, Debug, PartialEq)]
pub struct AxisChoice {
    /// The axis.
    pub axis: String,
    /// The span of the choice; if the description does not choose, that of the preset or the buffer's name.
    pub span: SourceSpan,
    /// At least one.
    pub alternatives: Vec<SelectedRow>,
}

/// One row, with the options that the user set.
#[derive(Clone, Debug, PartialEq)]
pub struct SelectedRow {
    /// The row, shared by all plans of the variant.
    pub row: Arc<Row>,
    /// Parameter and value, for each option that is set.
    pub options: Vec<(String, u32)>,
}

/// One row per axis; a plan is made from it.
#[derive(Clone, Debug, PartialEq)]
pub struct Selection {
    /// In the order of the axes.
    pub rows: Vec<SelectedRow>,
}

impl Variant {
    pub(crate) fn new(description: Description) -> Self {
        Variant(description)
    }

    /// Returns the values without the extra words of rows.
    fn own_values(&self) -> DescriptionValues {
        description_values(&self.attributes, self.criterion.as_ref(), self.resolve.as_ref(), self.keep)
    }

    /// Returns the values that the conditions of the selection's rows read.
    pub fn description_values(&self, selection: &Selection) -> DescriptionValues {
        let rows = selection.rows.iter().map(|selected| &*selected.row);
        with_extra_words(self.own_values(), rows)
    }

    /// Returns the rows for a target with the features `target`: on each axis, the first alternative that it supports.
    /// `Err`: the last alternative of an axis, and the feature that it needs.
    pub fn select(&self, target: &[Feature]) -> Result<Selection, MissingFeature> {
        let given = self.own_values();
        let mut rows = Vec::with_capacity(self.choices.len());
        for chosen in &self.choices {
            let mut unsupported = None;
            for selected in &chosen.alternatives {
                match selected.needs(&given).find(|feature| !target.contains(feature)) {
                    None => {
                        rows.push(selected.clone());
                        unsupported = None;
                        break;
                    }
                    Some(feature) => {
                        let (axis, value) = (chosen.axis.clone(), selected.row.key.clone());
                        unsupported = Some(MissingFeature { axis, value, feature });
                    }
                }
            }
            if let Some(unsupported) = unsupported {
                return Err(unsupported);
            }
        }
        Ok(Selection { rows })
    }

    /// Returns the span of what requires a feature that a target lacks: the `keep` line if the row requires it for this k only, else the
    /// choice; `None`: no axis of the description requires it.
    pub fn span_of(&self, missing: &MissingFeature) -> Option<&SourceSpan> {
        let chosen = self.choices.iter().find(|chosen| chosen.axis == missing.axis)?;
        let selected = chosen.alternatives.iter().find(|selected| selected.row.key == missing.value);
        let depends_on_k = selected.is_some_and(|selected| {
            let mut conditional = selected.row.needs_if.iter();
            !selected.row.needs.contains(&missing.feature)
                && conditional.any(|(when, feature)| *feature == missing.feature && when.mentions("keep"))
        });
        Some(self.keep_span.as_ref().filter(|_| depends_on_k).unwrap_or(&chosen.span))
    }
}

impl Deref for Variant {
    type Target = Description;

    fn deref(&self) -> &Description {
        &self.0
    }
}

/// The reason why a target does not support a variant.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MissingFeature {
    /// The axis of the row.
    pub axis: String,
    /// The key of the row.
    pub value: String,
    /// The feature that it needs.
    pub feature: Feature,
}

impl std::fmt::Display for MissingFeature {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "`{}: {}` requires {}", self.axis, self.value, self.feature.meaning())
    }
}

/// Adds the extra words of these rows to the payload.
pub(crate) fn with_extra_words<'a>(given: DescriptionValues, rows: impl Iterator<Item = &'a Row>) -> DescriptionValues {
    let extra: usize = rows.map(|row| row.extra_words.len()).sum();
    DescriptionValues { payload_words: given.payload_words + extra as u32, ..given }
}

impl SelectedRow {
    /// Returns the features that the row requires of the target, with its options and for this description.
    pub fn needs(&self, given: &DescriptionValues) -> impl Iterator<Item = Feature> {
        let value = |symbol: &str| given.value(symbol).or_else(|| self.option(symbol));
        // If a formula has no value, its feature is required.
        let holds = move |formula: &Formula| formula.evaluate(&value) != Ok(0);
        let conditional = self.row.needs_if.iter().filter(move |(when, _)| holds(when)).map(|(_, feature)| *feature);
        self.row.needs.iter().copied().chain(conditional)
    }

    /// Returns the value of the option with this constant. A default that depends on other symbols has none.
    fn option(&self, constant: &str) -> Option<u64> {
        let parameter = self.row.parameters.iter().find(|parameter| parameter.constant == *constant)?;
        let set = self.options.iter().find(|(name, _)| *name == *parameter.name);
        set.map_or_else(|| parameter.default.evaluate(&|_| None).ok(), |(_, value)| Some(u64::from(*value)))
    }
}

impl Selection {
    /// Selects the first alternative on every axis.
    pub fn first(variant: &Variant) -> Self {
        Selection { rows: variant.choices.iter().filter_map(|chosen| chosen.alternatives.first().cloned()).collect() }
    }

    /// Selects the last alternative on every axis.
    pub fn last(variant: &Variant) -> Self {
        Selection { rows: variant.choices.iter().filter_map(|chosen| chosen.alternatives.last().cloned()).collect() }
    }

    /// Returns the row on one axis.
    pub fn row(&self, axis: &str) -> Option<&SelectedRow> {
        self.rows.iter().find(|selected| selected.row.axis == axis)
    }

    /// Returns the soundness of the weakest row.
    pub fn soundness(&self) -> Soundness {
        self.rows.iter().map(|selected| selected.row.soundness).max().unwrap_or(Soundness::Atomics)
    }

    /// Returns the user files among the rows' templates, by their names in messages.
    pub fn user_files(&self) -> impl Iterator<Item = &str> {
        self.rows.iter().filter_map(|selected| selected.row.template.as_ref()?.user_file.as_deref())
    }

    /// Returns the set of kept fragments, as the storing row declares it; `None`: no row declares it.
    pub fn kept(&self) -> Option<KeptFragments> {
        self.rows.iter().find_map(|selected| selected.row.kept())
    }

    /// Returns how entries are merged, if a row merges them.
    pub fn merges(&self) -> Option<&Merges> {
        self.rows.iter().find_map(|selected| selected.row.merges.as_ref())
    }

    /// Returns the capabilities that the rows provide.
    pub fn provides(&self) -> Vec<Capability> {
        self.rows.iter().flat_map(|selected| selected.row.provides.iter().copied()).collect()
    }

    /// Returns `axis=value` for every axis, with options in brackets.
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
