//! The specification of a pixel's final state, computed from the fragments and the rows' reference model only.
//!
//! Input: the fragments of a pixel, what it holds in the end, the counters. Output: correct, wrong but permitted by the
//! declared hazards, or wrong with a description. The order of fragments is computed here independently of the templates
//! and the generated code.

use std::ops::RangeInclusive;

use fragbuf_model::counted;
use fragbuf_templates::vocabulary::{Equivalence, Permits, Tearing};
use fragbuf_templates::{COUNTERS, CounterKind};

use crate::kept_set::KeptSet;
use crate::memory::STALE;
use crate::search::StateVerdict;

/// The words that tell ids apart: the key, and the first value word.
const ID_WORDS: usize = 2;

/// The specification of one pixel.
#[derive(Clone, Debug)]
pub(crate) struct Specification {
    pub(crate) kept_set: KeptSet,
    /// What the rows declare may go wrong, hazard by hazard.
    pub(crate) hazards: Vec<Permits>,
    /// How many fragments may overflow the pool.
    pub(crate) overflows: RangeInclusive<u32>,
    /// Whether the retry limit is so low that fragments may time out.
    pub(crate) may_time_out: bool,
    /// Whether fragments can be culled without being counted as a loss.
    pub(crate) culls: bool,
    /// Whether a later iteration keeps what is culled or displaced.
    pub(crate) keeps_later: bool,
    /// Whether every event is counted, culled and displaced fragments included.
    pub(crate) counts_events: bool,
    /// k, where the storage may be given the k best only, so that all others may be culled.
    pub(crate) k_best_only: Option<usize>,
    /// Words of every fragment of this pixel.
    pub(crate) fragments: Vec<Vec<u32>>,
    /// The number of fragments of the neighbour.
    pub(crate) neighbours: u32,
    /// How many of those overflow the pool.
    pub(crate) neighbours_lost: u32,
    /// Fragments of this pixel that an opaque surface hides.
    pub(crate) occluded: u32,
}

/// The counters of this pixel.
#[derive(Clone, Copy, Debug, Default)]
struct Counts {
    generated: u32,
    culled: u32,
    emitted: u32,
    lost: u32,
    timed_out: u32,
    overflowed: u32,
    occluded: u32,
}

impl Counts {
    /// Returns the number of fragments that timed out or did not fit, whatever their keys.
    fn dropped(self) -> usize {
        (self.timed_out + self.overflowed) as usize
    }
}

impl Specification {
    /// Returns the verdict on a pixel that holds `kept`, in the order in which it is read out.
    pub(crate) fn verdict(&self, kept: &[Vec<u32>], counters: &[u32]) -> StateVerdict {
        let (counts, permits) = (self.counts(counters), self.permits(counters));
        if let Some(text) = self.forbidden_drop(counts, &permits) {
            return StateVerdict::Wrong(text);
        }
        let Some(text) = self.violation(kept, counts) else { return StateVerdict::Correct };
        // A merge is part of the specification, and excuses nothing else.
        let has_hazards = permits.is_something() && self.kept_set.merging.is_none();
        match has_hazards && self.is_permitted(kept, counts, &permits) {
            true => StateVerdict::Hazard(text),
            false => StateVerdict::Wrong(text),
        }
    }

    /// Returns what the hazards permit together for these counters.
    fn permits(&self, counters: &[u32]) -> Permits {
        let is_counted = |name: &str| {
            let mut known = COUNTERS.iter().zip(counters);
            known.any(|((known, ..), count)| *known == name && *count > 0)
        };
        let hazards = self.hazards.iter();
        let active = hazards.filter(|hazard| hazard.where_counted.as_ref().is_none_or(|name| is_counted(name)));
        Permits::together(active)
    }

    /// Describes counted fragments that must not be dropped, whatever the hazards permit: timed out, overflowed or occluded.
    fn forbidden_drop(&self, counts: Counts, permits: &Permits) -> Option<String> {
        let generated = self.fragments.len() as u32 + self.neighbours;
        if self.counts_events && counts.generated != generated {
            return Some(format!("{} counted as generated, expected {generated}", fragments_are(counts.generated)));
        }
        if self.counts_events && counts.occluded != self.occluded || counts.occluded > self.occluded {
            return Some(format!("{} counted as occluded, expected {}", fragments_are(counts.occluded), self.occluded));
        }
        if counts.timed_out > 0 && !self.may_time_out && !permits.times_out {
            return Some(format!("{} timed out, expected none", counted(counts.timed_out, "fragment")));
        }
        // A fragment that timed out has not allocated.
        let (mut least, mut most) = (self.overflows.start().saturating_sub(counts.timed_out), *self.overflows.end());
        if self.keeps_later {
            // Every iteration may count a fragment that a later one keeps, and need not store as many as there are.
            (least, most) = (0, u32::MAX);
        }
        if !(least..=most).contains(&counts.overflowed) {
            let expected = if least == most { least.to_string() } else { format!("{least} to {most}") };
            return Some(format!("{} did not fit, expected {expected}", counted(counts.overflowed, "fragment")));
        }
        let is_too_many = counts.dropped() > self.fragments.len() && !self.keeps_later;
        is_too_many.then(|| "more fragments are counted as lost than there are".to_owned())
    }

    /// Describes what violates the specification, hazards aside.
    fn violation(&self, kept: &[Vec<u32>], counts: Counts) -> Option<String> {
        if self.kept_set.is_unknown() {
            let out_of_order = || {
                let is_in_order = self.kept_set.has_keys_in_order(kept);
                (!is_in_order)
                    .then(|| format!("the entries are not in order: {}", listed(&kept.iter().collect::<Vec<_>>())))
            };
            let unknown = self.unknown_entry(kept).or_else(out_of_order);
            return unknown.or_else(|| self.counter_mismatch(kept.len() as u32, counts));
        }
        let survivors = self.certain_survivors(kept);
        let missing = self.missing_sets(counts.dropped()).filter(|out| out & survivors == 0);
        if !missing.map(|out| self.without(out)).any(|surviving| self.is_kept_set_of(kept, &surviving)) {
            return Some(self.difference(kept, counts.dropped()));
        }
        if !self.kept_set.is_in_order(kept) {
            return Some(format!("the entries are not in order: {}", listed(&kept.iter().collect::<Vec<_>>())));
        }
        self.counter_mismatch(kept.len() as u32, counts)
    }

    /// Describes an entry that matches no fragment, or is kept more often than its fragment arrived.
    fn unknown_entry(&self, kept: &[Vec<u32>]) -> Option<String> {
        let wrong = kept.iter().find(|entry| times(kept, entry) > times(&self.fragments, entry))?;
        Some(format!("the pixel holds {}, which matches no fragment", listed(&[wrong])))
    }

    /// Returns every set of fragments that can remain when `dropped` of them are lost.
    pub(crate) fn surviving_sets(&self, dropped: usize) -> impl Iterator<Item = Vec<Vec<u32>>> {
        self.missing_sets(dropped).map(|out| self.without(out))
    }

    /// Returns every set of fragments that can be missing when `dropped` of them are lost, as bits.
    fn missing_sets(&self, dropped: usize) -> impl Iterator<Item = u32> {
        // A later iteration may keep a fragment that timed out, or did not fit, in an earlier one.
        let least = if self.keeps_later { 0 } else { dropped };
        let dropped = dropped.min(self.fragments.len());
        let can_be_missing = move |out: &u32| (least..=dropped).any(|dropped| self.can_be_missing(*out, dropped));
        (0..1u32 << self.fragments.len()).filter(can_be_missing)
    }

    fn without(&self, out: u32) -> Vec<Vec<u32>> {
        let remaining = (0..self.fragments.len()).filter(|at| out >> at & 1 == 0);
        remaining.map(|at| self.fragments[at].clone()).collect()
    }

    /// Returns the fragments that a pixel with these entries has not lost, as bits: an entry has the deciding words of this
    /// fragment alone. A merged entry may be no fragment's.
    fn certain_survivors(&self, kept: &[Vec<u32>]) -> u32 {
        if self.kept_set.merging.is_some() {
            return 0;
        }
        let prefix = |words: &[u32]| words[..self.kept_set.deciding.min(words.len())].to_vec();
        let all: Vec<Vec<u32>> = self.fragments.iter().map(|words| prefix(words)).collect();
        let kept: Vec<Vec<u32>> = kept.iter().map(|entry| prefix(entry)).collect();
        let is_certain = |at: &usize| times(&all, &all[*at]) == 1 && kept.contains(&all[*at]);
        (0..all.len()).filter(is_certain).map(|at| 1 << at).sum()
    }

    /// Returns whether the fragments of this bit mask can be missing: `dropped` of them are lost, and the others were culled.
    fn can_be_missing(&self, out: u32, dropped: usize) -> bool {
        let Some(culled) = (out.count_ones() as usize).checked_sub(dropped) else { return false };
        let Some(k) = self.k_best_only.filter(|_| culled > 0) else { return culled == 0 };
        let mut keys: Vec<u32> = self.fragments.iter().map(|words| words[0]).collect();
        keys.sort_unstable();
        let is_beyond = |key: u32| keys.get(k.wrapping_sub(1)).is_some_and(|last| key > *last);
        let missing = self.fragments.iter().enumerate().filter(|(at, _)| out >> at & 1 == 1);
        culled <= missing.filter(|(_, words)| is_beyond(words[0])).count()
    }

    /// Returns whether `kept` is the kept set of the surviving fragments. Where only the key decides, any of the fragments
    /// with the worst kept key may be kept.
    fn is_kept_set_of(&self, kept: &[Vec<u32>], surviving: &[Vec<u32>]) -> bool {
        let expected = &self.kept_set.kept_of(surviving.to_vec())[..];
        if let Some(merging) = &self.kept_set.merging {
            return merging.allows(kept, surviving, expected);
        }
        if self.kept_set.is_exact() {
            return kept == expected;
        }
        let deciding = self.kept_set.deciding;
        prefixes(kept, deciding) == prefixes(expected, deciding)
            && kept.iter().all(|entry| times(kept, entry) <= times(&self.fragments, entry))
    }

    fn difference(&self, kept: &[Vec<u32>], dropped: usize) -> String {
        let expected = self.kept_set.kept_of(self.fragments.clone());
        let mut kept = kept.to_vec();
        kept.sort();
        let missing: Vec<&Vec<u32>> = expected.iter().filter(|entry| !kept.contains(entry)).collect();
        let unknown: Vec<&Vec<u32>> = kept.iter().filter(|entry| !self.fragments.contains(entry)).collect();
        let duplicate: Vec<&Vec<u32>> =
            kept.iter().filter(|entry| times(&kept, entry) > times(&self.fragments, entry).max(1)).collect();
        let mut text = match dropped {
            0 => String::from("wrong final state:"),
            _ => format!("wrong final state ({} timed out or did not fit):", counted(dropped, "fragment")),
        };
        let mut append = |what: &str, entries: &[&Vec<u32>]| {
            if !entries.is_empty() {
                text.push_str(&format!(" {what} {};", listed(entries)));
            }
        };
        append("missing", &missing);
        append("duplicate", &duplicate);
        append("matching no fragment", &unknown);
        text.push_str(&format!(" the pixel holds {}", listed(&kept.iter().collect::<Vec<_>>())));
        text
    }

    /// Describes fragments that are neither kept nor counted as lost or culled.
    fn counter_mismatch(&self, kept: u32, counts: Counts) -> Option<String> {
        let total = self.fragments.len() as u32;
        let out = total - kept.min(total);
        let counted = counts.lost + counts.culled + counts.emitted;
        let most = if self.keeps_later { out + counts.dropped() as u32 } else { out };
        let is_missing = self.counts_events && counted < out;
        let is_wrong = is_missing || if self.counts_events { counted > most } else { counts.lost > most };
        is_wrong.then(|| {
            format!(
                "{kept} of {total} fragments are kept, but the counters report {} lost and {} culled",
                counts.lost, counts.culled
            )
        })
    }

    /// Returns whether the declared hazards permit everything that is wrong.
    fn is_permitted(&self, kept: &[Vec<u32>], counts: Counts, permits: &Permits) -> bool {
        let is_ordered = permits.unsorted || self.kept_set.is_in_order(kept);
        let mut surviving = self.surviving_sets(counts.dropped());
        let is_complete = permits.lost || surviving.any(|surviving| self.is_complete(kept, surviving, permits));
        let is_known = kept.iter().all(|entry| self.is_permitted_entry(entry, permits));
        is_ordered
            && is_complete
            && is_known
            && self.has_permitted_multiplicity(kept, permits)
            && self.has_permitted_counts(kept.len() as u32, counts, permits)
    }

    /// Returns whether the pixel holds all of the kept set of these fragments and, unless duplicates are permitted, nothing
    /// else.
    fn is_complete(&self, kept: &[Vec<u32>], surviving: Vec<Vec<u32>>, permits: &Permits) -> bool {
        let deciding = if permits.torn > Tearing::No { 1 } else { self.compared(permits.one_of) };
        let expected = self.kept_of(surviving, permits);
        let (kept, expected) = (prefixes(kept, deciding), prefixes(&expected, deciding));
        match permits.duplicate {
            true => expected.iter().all(|entry| times(&expected, entry) <= times(&kept, entry)),
            false => kept == expected,
        }
    }

    /// Returns which fragments are kept, where the hazards permit that only one of equal fragments is.
    fn kept_of(&self, fragments: Vec<Vec<u32>>, permits: &Permits) -> Vec<Vec<u32>> {
        match permits.one_of {
            Equivalence::None => self.kept_set.kept_of(fragments),
            one_of => self.kept_set.kept_of_distinct(fragments, self.compared(one_of)),
        }
    }

    /// Returns how many words tell fragments apart, from the first on.
    fn compared(&self, one_of: Equivalence) -> usize {
        match one_of {
            Equivalence::Keys => 1,
            Equivalence::Ids => ID_WORDS,
            Equivalence::None | Equivalence::Fragments => self.kept_set.deciding,
        }
    }

    /// Returns whether an entry is a fragment, or as torn as is permitted.
    fn is_permitted_entry(&self, entry: &[u32], permits: &Permits) -> bool {
        let may_contribute = |other: &Vec<u32>| match permits.torn {
            Tearing::No => false,
            Tearing::EqualKeys => other[0] == entry[0],
            Tearing::Any => true,
        };
        let has_word = |at: usize, word: u32| {
            let is_stale = permits.stale && at > 0 && word == STALE;
            is_stale || self.fragments.iter().any(|other| other[at] == word && may_contribute(other))
        };
        self.fragments.iter().any(|other| other == entry)
            || entry.iter().enumerate().all(|(at, word)| has_word(at, *word))
    }

    /// Returns whether no entry is kept more often than is permitted, and no more entries are kept than there are slots.
    fn has_permitted_multiplicity(&self, kept: &[Vec<u32>], permits: &Permits) -> bool {
        if self.kept_set.most().is_some_and(|most| kept.len() > most) {
            return false;
        }
        if permits.duplicate {
            return true;
        }
        // A torn entry belongs to no single fragment, so its words may be kept elsewhere too.
        let whole: Vec<Vec<u32>> = kept.iter().filter(|entry| self.fragments.contains(entry)).cloned().collect();
        let whole = if permits.torn == Tearing::Any { &whole[..] } else { kept };
        let words = if permits.torn == Tearing::EqualKeys { 1 } else { usize::MAX };
        let (stored, arrived) = (prefixes(whole, words), prefixes(&self.fragments, words));
        let most = |entry: &Vec<u32>| if permits.one_of > Equivalence::None { 1 } else { times(&arrived, entry) };
        let ids = prefixes(kept, self.compared(permits.one_of));
        stored.iter().all(|entry| times(&stored, entry) <= most(entry))
            && (permits.one_of < Equivalence::Ids || ids.iter().all(|id| times(&ids, id) == 1))
    }

    /// Returns whether the counters are possible. A fragment that a race has lost is not counted, and an entry that is kept
    /// twice may be displaced and counted twice.
    fn has_permitted_counts(&self, kept: u32, counts: Counts, permits: &Permits) -> bool {
        let total = self.fragments.len() as u32;
        let counted = counts.lost + counts.culled + counts.emitted;
        // A fragment that an iteration has dropped may be kept or counted again by a later one.
        let most = if self.keeps_later { total + counts.dropped() as u32 } else { total };
        if permits.uncounted {
            return permits.duplicate || kept + counts.lost <= most;
        }
        if permits.counted_twice {
            return permits.lost || !self.counts_events || self.culls || kept + counted >= total;
        }
        match (permits.lost, permits.duplicate) {
            (false, false) => self.counter_mismatch(kept, counts).is_none(),
            (is_lossy, has_duplicates) => {
                counted <= most
                    && (has_duplicates || kept + counted <= most)
                    && (is_lossy || !self.counts_events || self.culls || kept + counted >= total)
            }
        }
    }

    /// Returns the least bound that culls no fragment of the kept set.
    pub(crate) fn least_bound(&self) -> u32 {
        let kept = self.kept_of(self.fragments.clone(), &self.permits(&[]));
        kept.last().map_or(0, |entry| entry[0])
    }

    fn counts(&self, counters: &[u32]) -> Counts {
        let mut counts = Counts::default();
        for ((name, kind, _), count) in COUNTERS.iter().zip(counters) {
            if *kind == CounterKind::Loss || *kind == CounterKind::Displaced && !self.keeps_later {
                counts.lost += count;
            }
            match *name {
                "generated" => counts.generated = *count,
                "culled" => counts.culled = *count,
                "emitted" => counts.emitted = *count,
                "timed_out" => counts.timed_out = *count,
                "pool_exhausted" => counts.overflowed = *count,
                "occluded" => counts.occluded = *count,
                _ => {}
            }
        }
        if self.keeps_later {
            counts.culled = 0;
        }
        counts.overflowed = counts.overflowed.wrapping_sub(self.neighbours_lost);
        counts.lost = counts.lost.wrapping_sub(self.neighbours_lost);
        counts
    }
}

/// Returns the first words of entries, sorted.
fn prefixes(entries: &[Vec<u32>], words: usize) -> Vec<Vec<u32>> {
    let mut prefixes: Vec<Vec<u32>> = entries.iter().map(|entry| entry.iter().take(words).copied().collect()).collect();
    prefixes.sort();
    prefixes
}

fn times(entries: &[Vec<u32>], entry: &Vec<u32>) -> usize {
    entries.iter().filter(|other| *other == entry).count()
}

/// Prints entries as their words.
fn listed(entries: &[&Vec<u32>]) -> String {
    let entry = |words: &&Vec<u32>| {
        let words: Vec<String> = words.iter().map(|word| format!("{word:08x}")).collect();
        format!("({})", words.join(" "))
    };
    if entries.is_empty() { "nothing".to_owned() } else { entries.iter().map(entry).collect::<Vec<_>>().join(" ") }
}

/// Returns a number of fragments with its verb.
fn fragments_are(count: u32) -> String {
    format!("{} {}", counted(count, "fragment"), if count == 1 { "is" } else { "are" })
}
