//! What hazards do to a pixel, as far as it can be said without knowing a technique.
//!
//! In: a hazard's name. Out: its effect. The names are words of the vocabulary, as those of facts are: a row that takes one
//! for a hazard of its own means this by it, and a check of the row lets it do this and nothing else.

/// What a hazard lets a pixel hold in the end.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Effect {
    /// A fragment that should be there is not, and no counter says so.
    Lost,
    /// A fragment stands there several times.
    Duplicate,
    /// Every word of an entry is that word of some fragment of the pixel, but not all of one.
    Torn,
    /// A word beside a key is what stood there before the frame.
    Stale,
    /// Entries are not in the order that the row promises.
    Unsorted,
    /// Of fragments with equal keys one is kept, and the others are counted.
    EqualKeys,
    /// Of fragments that nothing tells apart one is kept, and the others are counted.
    EqualFragments,
    /// Every word of an entry is that word of some fragment with its key, but not all of one.
    TornEquals,
    /// Fragments that are not kept, as they should not be, are counted nowhere.
    Uncounted,
    /// A fragment that is not kept is counted several times.
    CountedTwice,
    /// A fragment is given up after its tries, and counted, though nobody waits for a lock.
    GivenUp,
    /// Where the counter `unsettled` is not 0, entries are lost, double or torn.
    Unsettled,
    /// Of the fragments in one of k equal ranges of depth the best is kept, and the others are counted. The ranges go from
    /// `NEAR_MILLIONTHS` to `FAR_MILLIONTHS`, constants of the row; what lies outside belongs to the first or the last.
    OnePerRange,
    /// The colour of the farthest entry is its own over those of fragments that are not kept: which of them lies before which
    /// depends on the order of arrival, how much light all together let through does not. All else is as promised.
    MergedFarthest,
    /// Entries are as many as promised and in order, the nearest is among them, and the others are any: where two were
    /// neighbours, the nearer stays, and its colour is its own over the other's. How much light all together let through
    /// does not depend on the order of arrival.
    MergedNeighbours,
    /// What a pixel shows, but not what it holds, depends on the order of arrival.
    ShowsArrival,
}

/// Every name that says an effect.
const NAMES: [(&str, Effect); 16] = [
    ("lost-update", Effect::Lost),
    ("duplicate", Effect::Duplicate),
    ("torn", Effect::Torn),
    ("stale", Effect::Stale),
    ("unsorted", Effect::Unsorted),
    ("equal-keys", Effect::EqualKeys),
    ("equal-fragments", Effect::EqualFragments),
    ("torn-equal-keys", Effect::TornEquals),
    ("uncounted", Effect::Uncounted),
    ("counted-twice", Effect::CountedTwice),
    ("given-up", Effect::GivenUp),
    ("unsettled", Effect::Unsettled),
    ("one-per-range", Effect::OnePerRange),
    ("merged-farthest", Effect::MergedFarthest),
    ("merged-neighbours", Effect::MergedNeighbours),
    ("shows-arrival", Effect::ShowsArrival),
];

impl Effect {
    /// The effect of a hazard of this name; `None`: the name says nothing that can be checked.
    pub fn of(name: &str) -> Option<Self> {
        NAMES.iter().find(|(known, _)| *known == name).map(|(_, effect)| *effect)
    }

    /// Whether it comes of a race: fragments that come one after the other never show it.
    pub fn is_a_races(self) -> bool {
        !matches!(
            self,
            Effect::EqualKeys
                | Effect::EqualFragments
                | Effect::OnePerRange
                | Effect::MergedFarthest
                | Effect::MergedNeighbours
                | Effect::ShowsArrival
        )
    }
}
