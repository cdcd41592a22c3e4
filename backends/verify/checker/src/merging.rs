//! Checks entries that an overflow row has merged from several fragments.
//!
//! Input: what a pixel holds, the fragments that it was made from, and what it would hold without merging. Output: whether
//! the entries are a merge of those fragments. Merged colours depend on the order of arrival, so they are not computed.
//! Checked are all other words, which entries may have a merged colour, and the transmittance of all entries together.

use fragbuf_model::Format;
use fragbuf_templates::vocabulary::{BlendedEntries, Merges, PromisedKeys};

use crate::subject::Subject;

/// Which entries may be merged, and which of their words are colours.
#[derive(Clone, Debug)]
pub(crate) struct Merging {
    keys: PromisedKeys,
    blended: BlendedEntries,
    /// Words of an entry that hold the blended attribute.
    color: Vec<usize>,
    format: Format,
}

type Entry = Vec<u32>;

impl Merging {
    /// Returns how a subject merges fragments. `None`: it does not.
    pub(crate) fn new(subject: &Subject) -> Option<Self> {
        let Merges { attribute, keys, blended } = subject.plan.selection.merges()?;
        let values = (1..).zip(&subject.plan.layout.values);
        let words: Vec<_> = values.filter(|(_, word)| word.member.name == *attribute).collect();
        let format = words.first()?.1.member.format;
        Some(Merging { keys: *keys, blended: *blended, color: words.iter().map(|(at, _)| *at).collect(), format })
    }

    /// Returns whether `kept` is a merge of `fragments`, of which `expected` would be kept without merging.
    pub(crate) fn allows(&self, kept: &[Entry], fragments: &[Entry], expected: &[Entry]) -> bool {
        let has_expected_keys = match self.keys {
            PromisedKeys::All => keys(kept) == keys(expected),
            PromisedKeys::Best => nearest(kept) == nearest(fragments),
        };
        has_expected_keys
            && is_contained(&self.masked(kept), &self.masked(fragments))
            && self.merges_allowed_entries(kept, fragments, expected)
            && kept.len() == expected.len()
            && self.has_same_transmittance(kept, fragments)
    }

    /// Returns whether all entries but those that may be merged are whole fragments.
    fn merges_allowed_entries(&self, kept: &[Entry], fragments: &[Entry], expected: &[Entry]) -> bool {
        if self.blended == BlendedEntries::Any {
            return true;
        }
        if fragments.len() == expected.len() {
            return is_contained(kept, fragments);
        }
        let worst = expected.iter().map(|entry| entry[0]).max();
        let is_merged = |at: usize| {
            let others = [&kept[..at], &kept[at + 1..]].concat();
            Some(kept[at][0]) == worst && is_contained(&others, fragments)
        };
        (0..kept.len()).any(is_merged)
    }

    /// Returns whether the product of the transmittances is unchanged, within the rounding of every merge.
    fn has_same_transmittance(&self, kept: &[Entry], fragments: &[Entry]) -> bool {
        let transmittance = |entries: &[Entry]| entries.iter().map(|entry| 1.0 - self.alpha(entry)).product::<f64>();
        let step = match self.format {
            Format::Rgba8 => 1.0 / 255.0,
            Format::Rgba16 => 1.0 / 65535.0,
            _ => 1.0e-6,
        };
        let merges = fragments.len().saturating_sub(kept.len()) as f64;
        // The factors of the two products are in different orders.
        (transmittance(kept) - transmittance(fragments)).abs() <= merges * 0.51 * step + 1.0e-9
    }

    fn alpha(&self, entry: &[u32]) -> f64 {
        let last = self.color.last().map_or(0, |at| entry[*at]);
        match self.format {
            Format::Rgba8 => f64::from(last >> 24) / 255.0,
            Format::Rgba16 => f64::from(last >> 16) / 65535.0,
            _ => f64::from(f32::from_bits(last)),
        }
    }

    /// Returns the entries with their colours set to zero.
    fn masked(&self, entries: &[Entry]) -> Vec<Entry> {
        let masked = |entry: &Entry| -> Entry {
            let words = entry.iter().enumerate();
            words.map(|(at, word)| if self.color.contains(&at) { 0 } else { *word }).collect()
        };
        entries.iter().map(masked).collect()
    }
}

fn keys(entries: &[Entry]) -> Vec<u32> {
    let mut keys: Vec<u32> = entries.iter().map(|entry| entry[0]).collect();
    keys.sort_unstable();
    keys
}

fn nearest(entries: &[Entry]) -> Option<u32> {
    entries.iter().map(|entry| entry[0]).min()
}

/// Returns whether `all` contains every entry of `some` at least as often.
fn is_contained(some: &[Entry], all: &[Entry]) -> bool {
    let times = |entries: &[Entry], entry: &Entry| entries.iter().filter(|other| *other == entry).count();
    some.iter().all(|entry| times(some, entry) <= times(all, entry))
}
