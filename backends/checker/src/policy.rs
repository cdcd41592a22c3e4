//! Which end states are legal: what the variant states, worked out from the fragments alone.
//!
//! In: the fragments of a pixel, what it holds afterwards, the counters. Out: what is wrong, in words. The order over
//! fragments is stated here anew, apart from the templates and from what is generated.

use fragbuf_templates::COUNTERS;

/// What is promised for one pixel.
#[derive(Clone, Debug)]
pub(crate) struct Policy {
    /// How many of the best stay; all, if none is said.
    pub(crate) k: Option<usize>,
    /// Words of an entry that decide, from the first on.
    pub(crate) deciding: usize,
    /// Fragments that a pool has no room for.
    pub(crate) too_many: u32,
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
}

/// What the counters say.
#[derive(Clone, Copy, Debug, Default)]
struct Counts {
    generated: u32,
    culled: u32,
    lost: u32,
    given_up: u32,
    no_room: u32,
}

impl Policy {
    /// What is wrong with a pixel that holds `kept`.
    pub(crate) fn fault(&self, kept: &[Vec<u32>], counters: &[u32]) -> Option<String> {
        let mut counts = counts(counters);
        counts.no_room = counts.no_room.wrapping_sub(self.neighbours_lost);
        counts.lost = counts.lost.wrapping_sub(self.neighbours_lost);
        if counts.given_up > 0 && !self.may_give_up {
            return Some(format!("{} fragments gave up waiting for the lock", counts.given_up));
        }
        if counts.no_room != self.too_many {
            return Some(format!("{} fragments found no room, and should be {}", counts.no_room, self.too_many));
        }
        let gone = (counts.given_up + counts.no_room) as usize;
        if gone > self.fragments.len() || !self.is_kept_by_some(kept, gone) {
            return Some(self.difference(kept, gone));
        }
        self.miscounted(kept.len() as u32, counts)
    }

    /// What is wrong with a pixel that holds `kept`, whatever its storage promises: fragments that nobody sent, or twice, or
    /// torn, and fragments that went uncounted.
    pub(crate) fn fault_of_any(&self, kept: &[Vec<u32>], counters: &[u32]) -> Option<String> {
        let wrong = kept.iter().find(|entry| times(kept, entry) > times(&self.fragments, entry));
        match wrong {
            Some(entry) => {
                let words: Vec<String> = entry.iter().map(|word| format!("{word:08x}")).collect();
                Some(format!("the pixel holds ({}), which no fragment is", words.join(" ")))
            }
            None => self.miscounted(kept.len() as u32, counts(counters)),
        }
    }

    /// Whether `kept` is what stays of some choice of all fragments but `gone`.
    fn is_kept_by_some(&self, kept: &[Vec<u32>], gone: usize) -> bool {
        let count = self.fragments.len();
        (0..1u32 << count).filter(|out| self.can_be_out(*out, gone)).any(|out| {
            let left = (0..count).filter(|at| out >> at & 1 == 0).map(|at| self.fragments[at].clone()).collect();
            self.agrees(kept, self.best_of(left))
        })
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

    /// What stays of these fragments, best first.
    fn best_of(&self, mut fragments: Vec<Vec<u32>>) -> Vec<Vec<u32>> {
        fragments.sort();
        fragments.truncate(self.k.unwrap_or(usize::MAX));
        fragments
    }

    /// The same multiset. Where only the key decides, ties at the edge may fall either way.
    fn agrees(&self, kept: &[Vec<u32>], wanted: Vec<Vec<u32>>) -> bool {
        let mut kept = kept.to_vec();
        kept.sort();
        if self.deciding >= kept.first().map_or(0, Vec::len) {
            return kept == wanted;
        }
        let decides =
            |entries: &[Vec<u32>]| entries.iter().map(|entry| entry[..self.deciding].to_vec()).collect::<Vec<_>>();
        let mut left = self.fragments.clone();
        decides(&kept) == decides(&wanted)
            && kept.iter().all(|entry| match left.iter().position(|other| other == entry) {
                Some(at) => {
                    left.swap_remove(at);
                    true
                }
                None => false,
            })
    }

    fn difference(&self, kept: &[Vec<u32>], gone: usize) -> String {
        let wanted = self.best_of(self.fragments.clone());
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
        let counted = counts.lost + counts.culled;
        let wrong = if all_counted || !self.culls { counted != out } else { counts.lost > out };
        wrong.then(|| {
            format!(
                "of {total} fragments {kept} are kept, but {} are counted as lost and {} as culled",
                counts.lost, counts.culled
            )
        })
    }

    /// Whether `kept` is one of the things that races by design may leave: every word is some fragment's.
    pub(crate) fn is_within_hazards(&self, kept: &[Vec<u32>]) -> bool {
        kept.iter().all(|entry| {
            entry.iter().enumerate().all(|(at, word)| self.fragments.iter().any(|fragment| fragment[at] == *word))
        })
    }

    /// The least bound that turns away none of the fragments that stay.
    pub(crate) fn least_bound(&self) -> u32 {
        let best = self.best_of(self.fragments.clone());
        best.last().map_or(0, |entry| entry[0])
    }
}

fn times(entries: &[Vec<u32>], entry: &Vec<u32>) -> usize {
    entries.iter().filter(|other| *other == entry).count()
}

fn counts(counters: &[u32]) -> Counts {
    let mut counts = Counts::default();
    for ((name, is_loss, _), count) in COUNTERS.iter().zip(counters) {
        if *is_loss {
            counts.lost += count;
        }
        match *name {
            "generated" => counts.generated = *count,
            "culled" => counts.culled = *count,
            "spin_exhausted" => counts.given_up = *count,
            "pool_exhausted" => counts.no_room = *count,
            _ => {}
        }
    }
    counts
}

/// Entries as their words.
fn listed(entries: &[&Vec<u32>]) -> String {
    let entry = |words: &&Vec<u32>| {
        let words: Vec<String> = words.iter().map(|word| format!("{word:08x}")).collect();
        format!("({})", words.join(" "))
    };
    if entries.is_empty() { "nothing".to_owned() } else { entries.iter().map(entry).collect::<Vec<_>>().join(" ") }
}
