//! What a pixel may hold in the end, worked out from its fragments alone: the reference model that rows state.
//!
//! In: which fragments stay, what is merged, what may go wrong. Out: nothing; a checker compares end states with it, and a
//! plan's summary follows from it. Neither knows a row: whatever a technique promises is said in these parts.

use super::{Formula, Text};

/// Which of a pixel's fragments stay.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Kept {
    /// Which of a group.
    pub side: Side,
    /// How many of a group, over `k`; `None`: all.
    pub most: Option<Formula>,
    /// The number of a fragment's group, below the number of a pixel's entries; `None`: all fragments are one group. Over `k`,
    /// constants of rows, `key` (the word that orders fragments) and `depth_millionths` (the key read as a depth).
    pub group: Option<Formula>,
}

/// What only the groups of fragments are over.
pub const KEY_SYMBOLS: [&str; 2] = ["key", "depth_millionths"];

/// An end of the order of fragments.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// The better stay.
    Best,
    /// The worse stay: the better leave, and are handed on.
    Worst,
}

impl Kept {
    /// Every fragment.
    pub const fn all() -> Self {
        Kept { side: Side::Best, most: None, group: None }
    }

    /// The k best.
    pub const fn best() -> Self {
        Kept { side: Side::Best, most: Some(Formula(Text::Borrowed("k"))), group: None }
    }

    /// The k worst.
    pub const fn worst() -> Self {
        Kept { side: Side::Worst, most: Some(Formula(Text::Borrowed("k"))), group: None }
    }

    /// The best of each group.
    pub const fn best_of_each(group: &'static str) -> Self {
        let one = Some(Formula(Text::Borrowed("1")));
        Kept { side: Side::Best, most: one, group: Some(Formula(Text::Borrowed(group))) }
    }
}

/// How entries become one. Which colours are blended in which order is left open; how much light all entries together let
/// through is not.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Merges {
    /// The attribute that is blended, with its opacity last; all else of an entry is one fragment's.
    pub attribute: Text,
    /// Whose keys are promised.
    pub keys: PromisedKeys,
    /// Which entries may be made of several fragments.
    pub blended: Blended,
}

/// Whose keys are those of the fragments that would stay without merging.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PromisedKeys {
    /// Every entry's.
    All,
    /// The best entry's; the others are some fragments', as many as promised.
    Best,
}

/// Entries that may be made of several fragments.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Blended {
    /// One with the worst key, and none where no fragment is missing.
    Worst,
    /// Any.
    Any,
}

/// What a hazard lets a pixel hold or show in the end, against what the rows promise. Parts that several hazards state add up.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Permits {
    /// It takes a race: fragments that come one after the other never show it.
    pub needs_race: bool,
    /// It shows only where this counter is not 0.
    pub where_counted: Option<Text>,
    /// A fragment that should be there is not, and no counter says so.
    pub lost: bool,
    /// A fragment stands there several times.
    pub duplicate: bool,
    /// Every word of an entry is that word of some fragment, but not all of one.
    pub torn: Torn,
    /// A word beside a key is what stood there before the frame.
    pub stale: bool,
    /// Entries are not in the order that the row promises.
    pub unsorted: bool,
    /// Of fragments that are alike one is kept, and the others are counted.
    pub one_of: Alike,
    /// Fragments that are not kept, as they should not be, are counted nowhere.
    pub uncounted: bool,
    /// A fragment that is not kept is counted several times.
    pub counted_twice: bool,
    /// A fragment is given up after its tries, and counted, though nobody waits for a lock.
    pub gives_up: bool,
    /// What a pixel shows, but not what it holds, depends on the order of arrival.
    pub shows_arrival: bool,
}

/// Whose words an entry may be made of.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum Torn {
    /// One fragment's.
    #[default]
    No,
    /// Those of fragments with its key.
    EqualKeys,
    /// Those of any fragments.
    Any,
}

/// Which fragments are alike.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum Alike {
    /// None: each stays.
    #[default]
    None,
    /// Those that nothing tells apart.
    Fragments,
    /// Those with equal keys.
    Keys,
}

impl Permits {
    /// Nothing that can be checked.
    pub const NOTHING: Permits = Permits {
        needs_race: false,
        where_counted: None,
        lost: false,
        duplicate: false,
        torn: Torn::No,
        stale: false,
        unsorted: false,
        one_of: Alike::None,
        uncounted: false,
        counted_twice: false,
        gives_up: false,
        shows_arrival: false,
    };
    const RACE: Permits = Permits { needs_race: true, ..Permits::NOTHING };
    /// A race loses a fragment.
    pub const LOST: Permits = Permits { lost: true, ..Permits::RACE };
    /// A race stores a fragment twice.
    pub const DUPLICATE: Permits = Permits { duplicate: true, ..Permits::RACE };
    /// A race mixes the words of fragments.
    pub const TORN: Permits = Permits { torn: Torn::Any, ..Permits::RACE };
    /// A race mixes the words of fragments with equal keys.
    pub const TORN_EQUAL_KEYS: Permits = Permits { torn: Torn::EqualKeys, ..Permits::RACE };
    /// A race leaves a word of an earlier frame.
    pub const STALE: Permits = Permits { stale: true, ..Permits::RACE };
    /// A race leaves entries out of order.
    pub const UNSORTED: Permits = Permits { unsorted: true, ..Permits::RACE };
    /// Of equal keys one stays.
    pub const ONE_OF_EQUAL_KEYS: Permits = Permits { one_of: Alike::Keys, ..Permits::NOTHING };
    /// Of equal fragments one stays.
    pub const ONE_OF_EQUAL_FRAGMENTS: Permits = Permits { one_of: Alike::Fragments, ..Permits::NOTHING };
    /// A race keeps losses from being counted.
    pub const UNCOUNTED: Permits = Permits { uncounted: true, ..Permits::RACE };
    /// A race has a loss counted several times.
    pub const COUNTED_TWICE: Permits = Permits { counted_twice: true, ..Permits::RACE };
    /// A race exhausts the tries of a fragment.
    pub const GIVES_UP: Permits = Permits { gives_up: true, ..Permits::RACE };
    /// The picture follows the order of arrival.
    pub const SHOWS_ARRIVAL: Permits = Permits { shows_arrival: true, ..Permits::NOTHING };
    /// Where the last round of a loop still changed something, a race may have left anything of the pixel's own words.
    pub const UNSETTLED: Permits = Permits {
        where_counted: Some(Text::Borrowed("unsettled")),
        lost: true,
        duplicate: true,
        torn: Torn::Any,
        unsorted: true,
        uncounted: true,
        ..Permits::RACE
    };

    /// What either permits, where both show under the same conditions. `None`: they do not, and each keeps its own.
    pub fn and(&self, other: &Permits) -> Option<Permits> {
        let is_alike = self.needs_race == other.needs_race && self.where_counted == other.where_counted;
        let conditions =
            Permits { where_counted: self.where_counted.clone(), needs_race: self.needs_race, ..Permits::NOTHING };
        is_alike.then(|| conditions.with(self).with(other))
    }

    /// What these permit together where the conditions of all are met: it has none itself.
    pub fn together<'a>(met: impl Iterator<Item = &'a Permits>) -> Permits {
        met.fold(Permits::NOTHING, Permits::with)
    }

    /// The same conditions, and what either permits.
    fn with(self, other: &Permits) -> Permits {
        Permits {
            needs_race: self.needs_race,
            where_counted: self.where_counted,
            lost: self.lost || other.lost,
            duplicate: self.duplicate || other.duplicate,
            torn: self.torn.max(other.torn),
            stale: self.stale || other.stale,
            unsorted: self.unsorted || other.unsorted,
            one_of: self.one_of.max(other.one_of),
            uncounted: self.uncounted || other.uncounted,
            counted_twice: self.counted_twice || other.counted_twice,
            gives_up: self.gives_up || other.gives_up,
            shows_arrival: self.shows_arrival || other.shows_arrival,
        }
    }

    /// Whether it permits anything, whenever that is.
    pub fn is_something(&self) -> bool {
        Permits { needs_race: false, where_counted: None, ..self.clone() } != Permits::NOTHING
    }

    /// Whether pictures can show it, as counters do not count for that.
    pub fn shows(&self) -> bool {
        Permits { uncounted: false, counted_twice: false, ..self.clone() }.is_something()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn permits_join_under_the_same_conditions_alone() {
        let both = Permits { torn: Torn::Any, ..Permits::LOST };
        assert_eq!(Permits::LOST.and(&Permits::TORN), Some(both));
        for (one, other) in [
            (Permits::TORN, Permits::UNSETTLED),
            (Permits::UNSETTLED, Permits::TORN),
            (Permits::TORN, Permits::ONE_OF_EQUAL_KEYS),
            (Permits::ONE_OF_EQUAL_KEYS, Permits::UNCOUNTED),
        ] {
            assert_eq!(one.and(&other), None, "{one:?} {other:?}");
        }
        let all = Permits::together([Permits::UNSETTLED, Permits::STALE, Permits::ONE_OF_EQUAL_KEYS].iter());
        assert!(all.stale && all.lost && all.one_of == Alike::Keys);
        assert_eq!((all.needs_race, all.where_counted), (false, None));
    }
}
