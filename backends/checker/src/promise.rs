//! What a variant promises to keep, as its rows' facts and hazards say it.
//!
//! In: a subject. Out: which fragments stay of any that come, and in which order they are read. Nothing is taken from the
//! template: what it computes is stated here anew.

use fragbuf_templates::vocabulary::{Effect, Fact, Order};

use crate::merging::Merging;
use crate::subject::Subject;

/// What stays of the fragments of a pixel.
#[derive(Clone, Debug)]
pub(crate) struct Promise {
    keeps: Keeps,
    /// Words of an entry that decide which is better, from the first on.
    pub(crate) deciding: usize,
    is_sorted: bool,
    /// Of fragments with equal keys those that came first are better.
    is_by_arrival: bool,
    /// Of several fragments one is made, whose colour is no one's own.
    pub(crate) merging: Option<Merging>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Keeps {
    All,
    Best(usize),
    /// The farthest: the nearest leave, in a stream.
    Last(usize),
    PerRange(Ranges),
    Unknown,
}

/// `count` equal ranges of depth, in millionths.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Ranges {
    count: u64,
    near: u64,
    far: u64,
}

impl Promise {
    /// What a subject promises where it keeps `k` entries.
    pub(crate) fn new(subject: &Subject, k: Option<u32>) -> Self {
        let offers = subject.plan.selection.offers();
        let k = k.map_or(usize::MAX, |k| k as usize);
        let keeps = if offers.contains(&Fact::KeepsAll) {
            Keeps::All
        } else if offers.contains(&Fact::KeepsBest) {
            Keeps::Best(k)
        } else if offers.contains(&Fact::Streams) {
            Keeps::Last(k)
        } else if effects(subject).contains(&Effect::OnePerRange) {
            ranges(subject, k).map_or(Keeps::Unknown, Keeps::PerRange)
        } else {
            Keeps::Unknown
        };
        let merging = Merging::new(subject);
        Promise {
            keeps,
            // Colours of several fragments are no one's: keys alone are in an order.
            deciding: if merging.is_some() { 1 } else { deciding_words(subject) },
            merging,
            is_sorted: is_sorted(subject),
            is_by_arrival: order(subject) == Some(Order::Submission),
        }
    }

    /// Whether it is not known what stays.
    pub(crate) fn is_unknown(&self) -> bool {
        self.keeps == Keeps::Unknown
    }

    /// The most entries that a pixel holds, where there is a limit.
    pub(crate) fn most(&self) -> Option<usize> {
        match self.keeps {
            Keeps::Best(k) | Keeps::Last(k) => Some(k),
            Keeps::PerRange(ranges) => Some(ranges.count as usize),
            Keeps::All | Keeps::Unknown => None,
        }
    }

    /// Whether fragments stay and stand in one order, which arrival decides where keys do not.
    pub(crate) fn is_exact(&self) -> bool {
        self.is_by_arrival && self.is_sorted
    }

    /// Whether what leaves is composited.
    pub(crate) fn streams(&self) -> Option<usize> {
        match self.keeps {
            Keeps::Last(k) => Some(k),
            _ => None,
        }
    }

    /// What stays of these fragments, in the order in which they came; best first.
    pub(crate) fn best_of(&self, mut fragments: Vec<Vec<u32>>) -> Vec<Vec<u32>> {
        match self.is_by_arrival {
            true => fragments.sort_by_key(|fragment| fragment[0]),
            false => fragments.sort(),
        }
        match self.keeps {
            Keeps::Best(k) => fragments.truncate(k),
            Keeps::Last(k) => drop(fragments.drain(..fragments.len().saturating_sub(k))),
            Keeps::PerRange(ranges) => fragments.dedup_by_key(|fragment| ranges.of(fragment[0])),
            Keeps::All | Keeps::Unknown => {}
        }
        fragments
    }

    /// What stays where of fragments whose first words are equal one does.
    pub(crate) fn best_of_distinct(&self, mut fragments: Vec<Vec<u32>>, words: usize) -> Vec<Vec<u32>> {
        fragments.sort();
        fragments.dedup_by(|one, other| one.iter().zip(other.iter()).take(words).all(|(one, other)| one == other));
        self.best_of(fragments)
    }

    /// Whether entries are read in the order of what decides, if that is promised.
    pub(crate) fn is_in_order(&self, entries: &[Vec<u32>]) -> bool {
        // Where arrival decides, sequences are compared elsewhere.
        let deciding = if self.is_by_arrival { 1 } else { self.deciding };
        let decides = |entry: &Vec<u32>| entry[..deciding.min(entry.len())].to_vec();
        !self.is_sorted || entries.is_sorted_by_key(decides)
    }
}

impl Ranges {
    /// How many of the borders between ranges a depth has reached.
    fn of(self, key: u32) -> u64 {
        // Depths are cut down to whole millionths; what lies before the first range is in it, and behind the last in that.
        let depth = (f32::from_bits(key) * 1.0e6) as u64;
        let into = depth.saturating_sub(self.near);
        (1..self.count).filter(|border| into * self.count >= border * (self.far - self.near)).count() as u64
    }
}

/// Effects of the hazards that a subject's rows state.
pub(crate) fn effects(subject: &Subject) -> Vec<Effect> {
    subject.plan.hazards.iter().filter_map(|hazard| Effect::of(&hazard.name)).collect()
}

/// The words that decide which fragment is better, from the first on.
pub(crate) fn deciding_words(subject: &Subject) -> usize {
    match order(subject) {
        Some(Order::Unordered) => 1,
        Some(Order::Payload | Order::Attribute | Order::Submission) | None => {
            subject.plan.layout.entry_words() as usize
        }
    }
}

fn order(subject: &Subject) -> Option<Order> {
    subject.plan.selection.rows.iter().find_map(|selected| selected.row.order)
}

fn ranges(subject: &Subject, k: usize) -> Option<Ranges> {
    let constant = |name: &str| subject.plan.constants.iter().find(|(known, _)| known == name).map(|(_, value)| *value);
    let (near, far) = (u64::from(constant("NEAR_MILLIONTHS")?), u64::from(constant("FAR_MILLIONTHS")?));
    Some(Ranges { count: k as u64, near, far: far.max(near + 1) })
}

/// Whether the row that the plan starts from, and not a sort behind it, promises the order of depth.
fn is_sorted(subject: &Subject) -> bool {
    let plan = &subject.plan;
    let given = plan.variant.given(&plan.selection);
    let mut storages = plan.selection.rows.iter().filter(|selected| !selected.row.steps.is_empty());
    storages.any(|selected| selected.row.offers_to(&given, Fact::Sorted))
}
