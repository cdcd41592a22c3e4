//! What a variant promises to keep, as its rows' reference model says it.
//!
//! In: a subject. Out: which fragments stay of any that come, and in which order they are read. Nothing is taken from the
//! template: what it computes is worked out here from what the row states.

use fragbuf_templates::vocabulary::{Expression, Fact, Formula, Kept, Order, Side};

use crate::merging::Merging;
use crate::subject::Subject;

/// What stays of the fragments of a pixel.
#[derive(Clone, Debug)]
pub(crate) struct Promise {
    keeps: Option<Keeps>,
    /// Words of an entry that decide which is better, from the first on.
    pub(crate) deciding: usize,
    is_sorted: bool,
    /// Of fragments with equal keys those that came first are better.
    is_by_arrival: bool,
    /// Of several fragments one is made, whose colour is no one's own.
    pub(crate) merging: Option<Merging>,
}

/// What a row keeps, with the numbers of a subject.
#[derive(Clone, Debug)]
struct Keeps {
    side: Side,
    /// How many of a group; `None`: all.
    most: Option<usize>,
    /// The number of a group, over a fragment's key, k and constants of rows.
    group: Option<Expression>,
    k: Option<u32>,
    constants: Vec<(String, u32)>,
}

impl Promise {
    /// What a subject promises where it keeps `k` entries.
    pub(crate) fn new(subject: &Subject, k: Option<u32>) -> Self {
        let merging = Merging::new(subject);
        Promise {
            keeps: subject.plan.selection.kept().and_then(|kept| Keeps::new(&kept, k, subject)),
            // Colours of several fragments are no one's: keys alone are in an order.
            deciding: if merging.is_some() { 1 } else { deciding_words(subject) },
            merging,
            is_sorted: is_sorted(subject),
            is_by_arrival: order(subject) == Some(Order::Submission),
        }
    }

    /// Whether it is not known what stays.
    pub(crate) fn is_unknown(&self) -> bool {
        self.keeps.is_none()
    }

    /// The most entries that a pixel holds, where there is a limit.
    pub(crate) fn most(&self) -> Option<usize> {
        let keeps = self.keeps.as_ref()?;
        match keeps.group {
            Some(_) => keeps.k.map(|k| k as usize),
            None => keeps.most,
        }
    }

    /// Whether fragments stay and stand in one order, which arrival decides where keys do not.
    pub(crate) fn is_exact(&self) -> bool {
        self.is_by_arrival && self.is_sorted
    }

    /// How many stay where the better leave, and are handed on.
    pub(crate) fn streams(&self) -> Option<usize> {
        self.keeps.as_ref().filter(|keeps| keeps.side == Side::Worst)?.most
    }

    /// What stays of these fragments, in the order in which they came; best first.
    pub(crate) fn best_of(&self, mut fragments: Vec<Vec<u32>>) -> Vec<Vec<u32>> {
        match self.is_by_arrival {
            true => fragments.sort_by_key(|fragment| fragment[0]),
            false => fragments.sort(),
        }
        match &self.keeps {
            Some(keeps) => keeps.of(fragments),
            None => fragments,
        }
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

impl Keeps {
    /// `None`: a formula of the row has no value here.
    fn new(kept: &Kept, k: Option<u32>, subject: &Subject) -> Option<Self> {
        let group = kept.group.as_ref().map(Formula::read).transpose().ok()?;
        let constants = subject.plan.constants.clone();
        let mut keeps = Keeps { side: kept.side, most: None, group, k: Some(k.unwrap_or(1)), constants };
        keeps.most = match &kept.most {
            Some(most) => Some(most.evaluate(&|symbol| keeps.value(symbol, 0)).ok()? as usize),
            None => None,
        };
        keeps.group_of(0)?;
        Some(Keeps { k, ..keeps })
    }

    /// What stays of fragments that stand in their order, best first.
    fn of(&self, mut fragments: Vec<Vec<u32>>) -> Vec<Vec<u32>> {
        let Some(most) = self.most else { return fragments };
        let groups: Vec<Option<u64>> = fragments.iter().map(|fragment| self.group_of(fragment[0])).collect();
        let is_in = |at: usize| {
            let before = match self.side {
                Side::Best => &groups[..at],
                Side::Worst => &groups[at + 1..],
            };
            before.iter().filter(|group| **group == groups[at]).count() < most
        };
        let mut at = 0..;
        fragments.retain(|_| at.next().is_some_and(is_in));
        fragments
    }

    fn group_of(&self, key: u32) -> Option<u64> {
        let Some(group) = &self.group else { return Some(0) };
        group.evaluate(&|symbol| self.value(symbol, key)).ok()
    }

    fn value(&self, symbol: &str, key: u32) -> Option<u64> {
        match symbol {
            "k" => self.k.map(u64::from),
            "key" => Some(u64::from(key)),
            // Depths are cut down to whole millionths.
            "depth_millionths" => Some((f32::from_bits(key) * 1.0e6) as u64),
            _ => self.constants.iter().find(|(name, _)| name == symbol).map(|(_, value)| u64::from(*value)),
        }
    }
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

/// Whether the row that the plan starts from, and not a sort behind it, promises the order of depth.
fn is_sorted(subject: &Subject) -> bool {
    let plan = &subject.plan;
    let given = plan.variant.given(&plan.selection);
    let mut storages = plan.selection.rows.iter().filter(|selected| !selected.row.steps.is_empty());
    storages.any(|selected| selected.row.offers_to(&given, Fact::Sorted))
}
