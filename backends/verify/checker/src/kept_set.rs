//! The set of fragments that a variant keeps, computed from its rows' reference model.
//!
//! Input: a subject. Output: which of any fragments are kept, and in which order they are read. Nothing is taken from the
//! templates: the row's declaration is evaluated here.

use std::collections::BTreeSet;

use fragbuf_templates::vocabulary::{Capability, Expression, Formula, KeptFragments, Side, TieBreak};

use crate::merging::Merging;
use crate::subject::Subject;

/// Which fragments of a pixel are kept.
#[derive(Clone, Debug)]
pub(crate) struct KeptSet {
    rule: Option<KeepRule>,
    /// Words of an entry that decide which is better, from the first on.
    pub(crate) deciding: usize,
    is_sorted: bool,
    /// Whether the earlier of two fragments with equal keys is better.
    is_by_arrival: bool,
    /// How an overflow row merges fragments, so that a colour may belong to several.
    pub(crate) merging: Option<Merging>,
}

/// The declaration of a row, with the numbers of a subject.
#[derive(Clone, Debug)]
struct KeepRule {
    side: Side,
    /// How many of a group are kept; `None`: all.
    most: Option<usize>,
    /// The number of a group, over a fragment's key, k and constants of rows.
    group: Option<Expression>,
    /// The most groups; further ones are one with the last.
    most_groups: Option<usize>,
    k: Option<u32>,
    constants: Vec<(String, u32)>,
}

impl KeptSet {
    /// Returns the kept set of a subject with `k` entries.
    pub(crate) fn new(subject: &Subject, k: Option<u32>) -> Self {
        let merging = Merging::new(subject);
        KeptSet {
            rule: subject.plan.selection.kept().and_then(|kept| KeepRule::new(&kept, k, subject)),
            // A merged colour belongs to no single fragment, so entries are ordered by their keys only.
            deciding: if merging.is_some() { 1 } else { deciding_words(subject) },
            merging,
            is_sorted: is_sorted(subject),
            is_by_arrival: tie_break(subject) == Some(TieBreak::Submission),
        }
    }

    /// Returns the kept set of all iterations together, where each keeps what earlier ones displaced.
    pub(crate) fn of_all_iterations(&self) -> KeptSet {
        let rule = self.rule.clone().map(|rule| KeepRule { most: None, ..rule });
        KeptSet { rule, ..self.clone() }
    }

    /// Returns whether the rows do not declare which fragments are kept.
    pub(crate) fn is_unknown(&self) -> bool {
        self.rule.is_none()
    }

    /// Returns whether the arrival order of fragments decides nothing.
    pub(crate) fn is_order_free(&self) -> bool {
        !self.is_by_arrival && self.merging.is_none()
    }

    /// Returns the most entries that a pixel holds, where there is a limit.
    pub(crate) fn most(&self) -> Option<usize> {
        let rule = self.rule.as_ref()?;
        match rule.group {
            Some(_) => rule.k.map(|k| k as usize),
            None => rule.most,
        }
    }

    /// Returns whether the kept fragments and their order are unique: arrival decides between equal keys.
    pub(crate) fn is_exact(&self) -> bool {
        self.is_by_arrival && self.is_sorted
    }

    /// Returns how many fragments a stream keeps: the worst are kept, and the better ones are emitted.
    pub(crate) fn stream_length(&self) -> Option<usize> {
        self.rule.as_ref().filter(|rule| rule.side == Side::Worst)?.most
    }

    /// Returns which of these fragments, given in order of arrival, are kept; best first.
    pub(crate) fn kept_of(&self, mut fragments: Vec<Vec<u32>>) -> Vec<Vec<u32>> {
        match self.is_by_arrival {
            true => fragments.sort_by_key(|fragment| fragment[0]),
            false => fragments.sort(),
        }
        match &self.rule {
            Some(rule) => rule.kept_of(fragments),
            None => fragments,
        }
    }

    /// Returns which fragments are kept if only one is kept of those whose first words are equal.
    pub(crate) fn kept_of_distinct(&self, mut fragments: Vec<Vec<u32>>, words: usize) -> Vec<Vec<u32>> {
        fragments.sort();
        fragments.dedup_by(|one, other| one.iter().zip(other.iter()).take(words).all(|(one, other)| one == other));
        self.kept_of(fragments)
    }

    /// Returns whether entries are read in the order of their keys, if the rows declare an order.
    pub(crate) fn has_keys_in_order(&self, entries: &[Vec<u32>]) -> bool {
        !self.is_sorted || entries.is_sorted_by_key(|entry| entry.first().copied())
    }

    /// Returns whether entries are read in the order of their deciding words, if the rows declare an order.
    pub(crate) fn is_in_order(&self, entries: &[Vec<u32>]) -> bool {
        // Where arrival decides, `is_exact` compares the sequences.
        let deciding = if self.is_by_arrival { 1 } else { self.deciding };
        let decides = |entry: &Vec<u32>| entry[..deciding.min(entry.len())].to_vec();
        !self.is_sorted || entries.is_sorted_by_key(decides)
    }
}

impl KeepRule {
    /// Evaluates a row's declaration. `None`: a formula of the row has no value here.
    fn new(kept: &KeptFragments, k: Option<u32>, subject: &Subject) -> Option<Self> {
        let group = kept.group.as_ref().map(Formula::read).transpose().ok()?;
        let constants = subject.plan.constants.clone();
        let mut rule =
            KeepRule { side: kept.side, most: None, group, most_groups: None, k: Some(k.unwrap_or(1)), constants };
        let number = |formula: &Option<Formula>| match formula {
            Some(formula) => formula.evaluate(&|symbol| rule.value(symbol, 0, &[0])).map(|value| Some(value as usize)),
            None => Ok(None),
        };
        (rule.most, rule.most_groups) = (number(&kept.most).ok()?, number(&kept.most_groups).ok()?);
        rule.group_of(0, &[0])?;
        Some(KeepRule { k, ..rule })
    }

    /// Returns which of the fragments, given best first, are kept.
    fn kept_of(&self, mut fragments: Vec<Vec<u32>>) -> Vec<Vec<u32>> {
        let Some(most) = self.most else { return fragments };
        let groups = self.groups(&fragments);
        let is_kept = |at: usize| {
            let ahead = match self.side {
                Side::Best => &groups[..at],
                Side::Worst => &groups[at + 1..],
            };
            ahead.iter().filter(|group| **group == groups[at]).count() < most
        };
        let mut at = 0..;
        fragments.retain(|_| at.next().is_some_and(is_kept));
        fragments
    }

    /// Returns the group of each fragment. Where their number is limited, those with fragments are numbered in order.
    fn groups(&self, fragments: &[Vec<u32>]) -> Vec<Option<u64>> {
        let keys: Vec<u32> = fragments.iter().map(|fragment| fragment[0]).collect();
        let groups: Vec<Option<u64>> = keys.iter().map(|key| self.group_of(*key, &keys)).collect();
        let Some(most) = self.most_groups else { return groups };
        let occupied: BTreeSet<Option<u64>> = groups.iter().copied().collect();
        let number = |group: &Option<u64>| occupied.range(..*group).count().min(most.saturating_sub(1));
        groups.iter().map(|group| Some(number(group) as u64)).collect()
    }

    /// Returns the group of a key among those of its pixel.
    fn group_of(&self, key: u32, keys: &[u32]) -> Option<u64> {
        let Some(group) = &self.group else { return Some(0) };
        group.evaluate(&|symbol| self.value(symbol, key, keys)).ok()
    }

    fn value(&self, symbol: &str, key: u32, keys: &[u32]) -> Option<u64> {
        // Depths are rounded down to multiples of 2^-24.
        let steps = |key: u32| (f32::from_bits(key).min(1.0) * 16_777_216.0) as u64;
        match symbol {
            "depth_steps" => Some(steps(key)),
            "nearest_steps" => keys.iter().min().map(|key| steps(*key)),
            "farthest_steps" => keys.iter().max().map(|key| steps(*key)),
            "k" => self.k.map(u64::from),
            "key" => Some(u64::from(key)),
            // Depths are rounded down to whole millionths.
            "depth_millionths" => Some((f32::from_bits(key) * 1.0e6) as u64),
            _ => self.constants.iter().find(|(name, _)| name == symbol).map(|(_, value)| u64::from(*value)),
        }
    }
}

/// Returns how many words decide which fragment is better, from the first on.
fn deciding_words(subject: &Subject) -> usize {
    match tie_break(subject) {
        Some(TieBreak::Unordered) => 1,
        Some(TieBreak::Payload | TieBreak::Attribute | TieBreak::Submission) | None => {
            subject.plan.layout.entry_words() as usize
        }
    }
}

fn tie_break(subject: &Subject) -> Option<TieBreak> {
    subject.plan.selection.rows.iter().find_map(|selected| selected.row.order)
}

/// Returns whether the storage row, and not a later sort, provides the order of depth. Iterations that divide the fragments
/// into slots composite each slot apart, so their order is that of slots.
fn is_sorted(subject: &Subject) -> bool {
    let plan = &subject.plan;
    if plan.selection.provides().contains(&Capability::DividesLayers) {
        return false;
    }
    let given = plan.variant.description_values(&plan.selection);
    let mut storages = plan.selection.rows.iter().filter(|selected| !selected.row.steps.is_empty());
    storages.any(|selected| selected.row.provides_to(&given, Capability::Sorted))
}
