//! Which end states are legal: what the variant states, worked out from the fragments alone.
//!
//! In: the fragments of a pixel, what it holds afterwards, the counters. Out: right, wrong by a hazard that the rows state,
//! or wrong, in words. The order over fragments is stated here anew, apart from the templates and from what is generated.

use std::ops::RangeInclusive;

use fragbuf_templates::COUNTERS;
use fragbuf_templates::vocabulary::{Alike, Permits, Torn};

use crate::frame::STALE;
use crate::promise::Promise;

/// What is promised for one pixel.
#[derive(Clone, Debug)]
pub(crate) struct Policy {
    pub(crate) promise: Promise,
    /// What the rows state that may go wrong, hazard by hazard.
    pub(crate) hazards: Vec<Permits>,
    /// How many fragments may find no room.
    pub(crate) short: RangeInclusive<u32>,
    /// Whether tries are bounded so low that fragments may be given up.
    pub(crate) may_give_up: bool,
    /// Whether fragments can be turned away without being counted as a loss.
    pub(crate) culls: bool,
    /// Where the storage may be handed so many of the best alone: those beyond can be turned away, kept by no one.
    pub(crate) handed: Option<usize>,
    /// Words of every fragment of this pixel, and how many the neighbour got.
    pub(crate) fragments: Vec<Vec<u32>>,
    pub(crate) neighbours: u32,
    /// How many of those find no room.
    pub(crate) neighbours_lost: u32,
    /// Fragments of this pixel that something opaque hides.
    pub(crate) hidden: u32,
}

/// What is to be said of an end.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Finding {
    Right,
    /// Not what is promised, in words, but a hazard that the rows state.
    Stated(String),
    Wrong(String),
}

/// What the counters say of this pixel.
#[derive(Clone, Copy, Debug, Default)]
struct Counts {
    generated: u32,
    culled: u32,
    emitted: u32,
    lost: u32,
    given_up: u32,
    no_room: u32,
    occluded: u32,
}

impl Counts {
    /// Fragments that were given up or found no room, whatever their keys.
    fn gone(self) -> usize {
        (self.given_up + self.no_room) as usize
    }
}

impl Policy {
    /// What is to be said of a pixel that holds `kept`, in the order in which it is read out.
    pub(crate) fn finding(&self, kept: &[Vec<u32>], counters: &[u32]) -> Finding {
        let (counts, permits) = (self.counts(counters), self.permits(counters));
        if let Some(text) = self.miscarried(counts, &permits) {
            return Finding::Wrong(text);
        }
        let Some(text) = self.fault(kept, counts) else { return Finding::Right };
        // That fragments merge is part of the promise, and excuses nothing that is not.
        let is_excused = permits.is_something() && self.promise.merging.is_none();
        let is_stated = is_excused && self.is_stated(kept, counts, &permits);
        if is_stated { Finding::Stated(text) } else { Finding::Wrong(text) }
    }

    /// What may go wrong where the counters say this.
    fn permits(&self, counters: &[u32]) -> Permits {
        let is_counted = |name: &str| {
            let mut known = COUNTERS.iter().zip(counters);
            known.any(|((known, ..), count)| *known == name && *count > 0)
        };
        let hazards = self.hazards.iter();
        Permits::together(hazards.filter(|hazard| hazard.where_counted.as_ref().is_none_or(|name| is_counted(name))))
    }

    /// What is wrong whatever the rows state: fragments were given up, or found no room, or were hidden, that should not.
    fn miscarried(&self, counts: Counts, permits: &Permits) -> Option<String> {
        let counts_all = counts.generated > 0;
        if counts_all && counts.occluded != self.hidden || counts.occluded > self.hidden {
            return Some(format!(
                "{} fragments are counted as behind something opaque, and should be {}",
                counts.occluded, self.hidden
            ));
        }
        if counts.given_up > 0 && !self.may_give_up && !permits.gives_up {
            return Some(format!("{} fragments gave up waiting for the lock", counts.given_up));
        }
        // Who gives up has not asked for room.
        let (least, most) = (self.short.start().saturating_sub(counts.given_up), *self.short.end());
        if !(least..=most).contains(&counts.no_room) {
            let wanted = if least == most { least.to_string() } else { format!("from {least} to {most}") };
            return Some(format!("{} fragments found no room, and should be {wanted}", counts.no_room));
        }
        (counts.gone() > self.fragments.len()).then(|| "more fragments are counted than there are".to_owned())
    }

    /// What is wrong, hazards apart.
    fn fault(&self, kept: &[Vec<u32>], counts: Counts) -> Option<String> {
        if self.promise.is_unknown() {
            return self.foreign(kept).or_else(|| self.miscounted(kept.len() as u32, counts));
        }
        if !self.is_kept_by_some(kept, counts.gone()) {
            return Some(self.difference(kept, counts.gone()));
        }
        if !self.promise.is_in_order(kept) {
            return Some(format!("the entries are not in order: {}", listed(&kept.iter().collect::<Vec<_>>())));
        }
        self.miscounted(kept.len() as u32, counts)
    }

    /// An entry that is no fragment's, or stands there too often.
    fn foreign(&self, kept: &[Vec<u32>]) -> Option<String> {
        let wrong = kept.iter().find(|entry| times(kept, entry) > times(&self.fragments, entry))?;
        Some(format!("the pixel holds {}, which no fragment is", listed(&[wrong])))
    }

    /// Whether `kept` is what stays of some choice of all fragments but `gone`.
    fn is_kept_by_some(&self, kept: &[Vec<u32>], gone: usize) -> bool {
        self.choices(gone).any(|left| self.agrees(kept, &left))
    }

    /// The fragments without `gone` of them, in every way.
    pub(crate) fn choices(&self, gone: usize) -> impl Iterator<Item = Vec<Vec<u32>>> {
        let count = self.fragments.len();
        (0..1u32 << count)
            .filter(move |out| self.can_be_out(*out, gone))
            .map(move |out| (0..count).filter(|at| out >> at & 1 == 0).map(|at| self.fragments[at].clone()).collect())
    }

    /// Whether the fragments of this bit mask can be missing: so many are `gone`, and any others were turned away.
    fn can_be_out(&self, out: u32, gone: usize) -> bool {
        let Some(turned_away) = (out.count_ones() as usize).checked_sub(gone) else { return false };
        let Some(k) = self.handed.filter(|_| turned_away > 0) else { return turned_away == 0 };
        let mut keys: Vec<u32> = self.fragments.iter().map(|words| words[0]).collect();
        keys.sort_unstable();
        let is_beyond = |key: u32| keys.get(k.wrapping_sub(1)).is_some_and(|last| key > *last);
        let missing = self.fragments.iter().enumerate().filter(|(at, _)| out >> at & 1 == 1);
        turned_away <= missing.filter(|(_, words)| is_beyond(words[0])).count()
    }

    /// What is promised of `left`. Where only the key decides, ties at the edge may fall either way.
    fn agrees(&self, kept: &[Vec<u32>], left: &[Vec<u32>]) -> bool {
        let wanted = &self.promise.best_of(left.to_vec())[..];
        if let Some(merging) = &self.promise.merging {
            return merging.agrees(kept, left, wanted);
        }
        if self.promise.is_exact() {
            return kept == wanted;
        }
        let deciding = self.promise.deciding;
        prefixes(kept, deciding) == prefixes(wanted, deciding)
            && kept.iter().all(|entry| times(kept, entry) <= times(&self.fragments, entry))
    }

    fn difference(&self, kept: &[Vec<u32>], gone: usize) -> String {
        let wanted = self.promise.best_of(self.fragments.clone());
        let mut kept = kept.to_vec();
        kept.sort();
        let missing: Vec<&Vec<u32>> = wanted.iter().filter(|entry| !kept.contains(entry)).collect();
        let foreign: Vec<&Vec<u32>> = kept.iter().filter(|entry| !self.fragments.contains(entry)).collect();
        let doubled: Vec<&Vec<u32>> =
            kept.iter().filter(|entry| times(&kept, entry) > times(&self.fragments, entry).max(1)).collect();
        let mut text = match gone {
            0 => String::from("the pixel does not hold what it should:"),
            _ => format!("the pixel does not hold what it should, {gone} given up or without room:"),
        };
        let mut say = |what: &str, entries: &[&Vec<u32>]| {
            if !entries.is_empty() {
                text.push_str(&format!(" {what} {};", listed(entries)));
            }
        };
        say("missing", &missing);
        say("doubled", &doubled);
        say("of no fragment", &foreign);
        text.push_str(&format!(" it holds {}", listed(&kept.iter().collect::<Vec<_>>())));
        text
    }

    /// Whether every fragment is kept, counted as lost, or counted as culled.
    fn miscounted(&self, kept: u32, counts: Counts) -> Option<String> {
        let total = self.fragments.len() as u32;
        let all_counted = counts.generated == total + self.neighbours;
        let out = total - kept.min(total);
        let counted = counts.lost + counts.culled + counts.emitted;
        let wrong = if all_counted || !self.culls { counted != out } else { counts.lost > out };
        wrong.then(|| {
            format!(
                "of {total} fragments {kept} are kept, but {} are counted as lost and {} as culled",
                counts.lost, counts.culled
            )
        })
    }

    /// Whether what is wrong is no more than the stated hazards permit.
    fn is_stated(&self, kept: &[Vec<u32>], counts: Counts, permits: &Permits) -> bool {
        let is_ordered = permits.unsorted || self.promise.is_in_order(kept);
        let is_all = permits.lost || self.choices(counts.gone()).any(|left| self.is_complete(kept, left, permits));
        let is_known = kept.iter().all(|entry| self.is_someones(entry, permits));
        is_ordered
            && is_all
            && is_known
            && self.is_often_enough(kept, permits)
            && self.is_counted(kept.len() as u32, counts, permits)
    }

    /// Whether everything that is wanted of `left` is there, and, unless things may be doubled, nothing else.
    fn is_complete(&self, kept: &[Vec<u32>], left: Vec<Vec<u32>>, permits: &Permits) -> bool {
        let loosely = permits.torn > Torn::No || permits.one_of == Alike::Keys;
        let deciding = if loosely { 1 } else { self.promise.deciding };
        let wanted = self.best_of(left, permits);
        let (kept, wanted) = (prefixes(kept, deciding), prefixes(&wanted, deciding));
        match permits.duplicate {
            true => wanted.iter().all(|entry| times(&wanted, entry) <= times(&kept, entry)),
            false => kept == wanted,
        }
    }

    /// What stays of these fragments, of those that are alike as many as are stated to.
    fn best_of(&self, left: Vec<Vec<u32>>, permits: &Permits) -> Vec<Vec<u32>> {
        match permits.one_of {
            Alike::Keys => self.promise.best_of_distinct(left, 1),
            Alike::Fragments => self.promise.best_of_distinct(left, self.promise.deciding),
            Alike::None => self.promise.best_of(left),
        }
    }

    /// Whether an entry is a fragment, as torn as it may be.
    fn is_someones(&self, entry: &[u32], permits: &Permits) -> bool {
        let may_lend = |other: &Vec<u32>| match permits.torn {
            Torn::No => false,
            Torn::EqualKeys => other[0] == entry[0],
            Torn::Any => true,
        };
        let has_word = |at: usize, word: u32| {
            let is_stale = permits.stale && at > 0 && word == STALE;
            is_stale || self.fragments.iter().any(|other| other[at] == word && may_lend(other))
        };
        self.fragments.iter().any(|other| other == entry)
            || entry.iter().enumerate().all(|(at, word)| has_word(at, *word))
    }

    /// Whether nothing stands there more often than it may, and no more than there is room for.
    fn is_often_enough(&self, kept: &[Vec<u32>], permits: &Permits) -> bool {
        if self.promise.most().is_some_and(|most| kept.len() > most) {
            return false;
        }
        if permits.duplicate {
            return true;
        }
        // Torn entries are nobody's, and words of theirs may stand elsewhere too.
        let whole: Vec<Vec<u32>> = kept.iter().filter(|entry| self.fragments.contains(entry)).cloned().collect();
        let whole = if permits.torn == Torn::Any { &whole[..] } else { kept };
        let words = if permits.torn == Torn::EqualKeys { 1 } else { usize::MAX };
        let (held, sent) = (prefixes(whole, words), prefixes(&self.fragments, words));
        let most = |entry: &Vec<u32>| if permits.one_of > Alike::None { 1 } else { times(&sent, entry) };
        let keys = prefixes(kept, 1);
        held.iter().all(|entry| times(&held, entry) <= most(entry))
            && (permits.one_of != Alike::Keys || keys.iter().all(|key| times(&keys, key) == 1))
    }

    /// Whether the counters say what they can: nobody counts what a race has lost, and an entry that stands there twice may
    /// be displaced twice.
    fn is_counted(&self, kept: u32, counts: Counts, permits: &Permits) -> bool {
        let total = self.fragments.len() as u32;
        let counted = counts.lost + counts.culled + counts.emitted;
        if permits.uncounted {
            return permits.duplicate || kept + counts.lost <= total;
        }
        if permits.counted_twice {
            return permits.lost || self.culls || kept + counted >= total;
        }
        match (permits.lost, permits.duplicate) {
            (false, false) => self.miscounted(kept, counts).is_none(),
            (is_lossy, is_doubling) => {
                counted <= total
                    && (is_doubling || kept + counted <= total)
                    && (is_lossy || self.culls || kept + counted >= total)
            }
        }
    }

    /// The least bound that turns away none of the fragments that stay.
    pub(crate) fn least_bound(&self) -> u32 {
        let best = self.best_of(self.fragments.clone(), &self.permits(&[]));
        best.last().map_or(0, |entry| entry[0])
    }

    fn counts(&self, counters: &[u32]) -> Counts {
        let mut counts = Counts::default();
        for ((name, is_loss, _), count) in COUNTERS.iter().zip(counters) {
            if *is_loss {
                counts.lost += count;
            }
            match *name {
                "generated" => counts.generated = *count,
                "culled" => counts.culled = *count,
                "emitted" => counts.emitted = *count,
                "spin_exhausted" => counts.given_up = *count,
                "pool_exhausted" => counts.no_room = *count,
                "occluded" => counts.occluded = *count,
                _ => {}
            }
        }
        counts.no_room = counts.no_room.wrapping_sub(self.neighbours_lost);
        counts.lost = counts.lost.wrapping_sub(self.neighbours_lost);
        counts
    }
}

/// The first words of entries, in order.
fn prefixes(entries: &[Vec<u32>], words: usize) -> Vec<Vec<u32>> {
    let mut prefixes: Vec<Vec<u32>> = entries.iter().map(|entry| entry.iter().take(words).copied().collect()).collect();
    prefixes.sort();
    prefixes
}

fn times(entries: &[Vec<u32>], entry: &Vec<u32>) -> usize {
    entries.iter().filter(|other| *other == entry).count()
}

/// Entries as their words.
fn listed(entries: &[&Vec<u32>]) -> String {
    let entry = |words: &&Vec<u32>| {
        let words: Vec<String> = words.iter().map(|word| format!("{word:08x}")).collect();
        format!("({})", words.join(" "))
    };
    if entries.is_empty() { "nothing".to_owned() } else { entries.iter().map(entry).collect::<Vec<_>>().join(" ") }
}
