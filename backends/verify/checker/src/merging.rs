//! What merging leaves of fragments, where a row states that it makes one of two.
//!
//! In: what a pixel holds, the fragments that it is made of, what would be held without merging. Out: whether that is a
//! merging of them. Colours are not worked out, because they depend on the order of arrival: what must be right is every
//! other word, which entries have a colour of their own, and how much light all of them together let through.

use fragbuf_model::Format;
use fragbuf_templates::vocabulary::{Blended, Merges, PromisedKeys};

use crate::subject::Subject;

/// Which entries are made of several fragments, and where their colours lie.
#[derive(Clone, Debug)]
pub(crate) struct Merging {
    keys: PromisedKeys,
    blended: Blended,
    /// Words of an entry that hold what is blended.
    color: Vec<usize>,
    format: Format,
}

type Entry = Vec<u32>;

impl Merging {
    /// How a subject merges; `None`: it does not.
    pub(crate) fn new(subject: &Subject) -> Option<Self> {
        let Merges { attribute, keys, blended } = subject.plan.selection.merges()?;
        let beside = (1..).zip(&subject.plan.layout.beside);
        let words: Vec<_> = beside.filter(|(_, word)| word.member.name == *attribute).collect();
        let format = words.first()?.1.member.format;
        Some(Merging { keys: *keys, blended: *blended, color: words.iter().map(|(at, _)| *at).collect(), format })
    }

    /// Whether `kept` is a merging of `left`, of which `wanted` would stay without.
    pub(crate) fn agrees(&self, kept: &[Entry], left: &[Entry], wanted: &[Entry]) -> bool {
        let has_promised_keys = match self.keys {
            PromisedKeys::All => keys(kept) == keys(wanted),
            PromisedKeys::Best => nearest(kept) == nearest(left),
        };
        has_promised_keys
            && is_contained(&self.masked(kept), &self.masked(left))
            && self.is_blended_where_it_may(kept, left, wanted)
            && kept.len() == wanted.len()
            && self.lets_through_as_much(kept, left)
    }

    /// Whether all entries but those that may be blended are whole fragments.
    fn is_blended_where_it_may(&self, kept: &[Entry], left: &[Entry], wanted: &[Entry]) -> bool {
        if self.blended == Blended::Any {
            return true;
        }
        if left.len() == wanted.len() {
            return is_contained(kept, left);
        }
        let worst = wanted.iter().map(|entry| entry[0]).max();
        let is_blended = |at: usize| {
            let others = [&kept[..at], &kept[at + 1..]].concat();
            Some(kept[at][0]) == worst && is_contained(&others, left)
        };
        (0..kept.len()).any(is_blended)
    }

    /// Whether the product of the transmittances is what it was, within the rounding of every merging.
    fn lets_through_as_much(&self, kept: &[Entry], left: &[Entry]) -> bool {
        let through = |entries: &[Entry]| entries.iter().map(|entry| 1.0 - self.alpha(entry)).product::<f64>();
        let step = match self.format {
            Format::Rgba8 => 1.0 / 255.0,
            Format::Rgba16 => 1.0 / 65535.0,
            _ => 1.0e-6,
        };
        let mergings = left.len().saturating_sub(kept.len()) as f64;
        // The products are not taken in the same order.
        (through(kept) - through(left)).abs() <= mergings * 0.51 * step + 1.0e-9
    }

    fn alpha(&self, entry: &[u32]) -> f64 {
        let last = self.color.last().map_or(0, |at| entry[*at]);
        match self.format {
            Format::Rgba8 => f64::from(last >> 24) / 255.0,
            Format::Rgba16 => f64::from(last >> 16) / 65535.0,
            _ => f64::from(f32::from_bits(last)),
        }
    }

    /// The entries without their colours.
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

/// Whether every entry of `some` stands in `all`, as often at least.
fn is_contained(some: &[Entry], all: &[Entry]) -> bool {
    let times = |entries: &[Entry], entry: &Entry| entries.iter().filter(|other| *other == entry).count();
    some.iter().all(|entry| times(some, entry) <= times(all, entry))
}
