//! The reference model that rows declare: which contents a pixel may have in a final state, given its fragments.
//!
//! A row declares which fragments are kept, how entries are merged, and what can go wrong. The checker compares final
//! states with the model, and the summary of a plan follows from it. Neither reads the keys of rows.

use super::{Formula, Text};

/// Which of a pixel's fragments are kept.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct KeptFragments {
    /// Which fragments of a group.
    pub side: Side,
    /// The number kept of a group, over `k`; `None`: all.
    pub most: Option<Formula>,
    /// The index of a fragment's group, less than the number of a pixel's entries if `most_groups` sets no limit; `None`:
    /// all fragments are one group. Over `k`, constants of rows and [`KEY_SYMBOLS`].
    pub group: Option<Formula>,
    /// The most groups, over `k`: in the order of their indices, the last of them includes all further ones; `None`: no
    /// limit.
    pub most_groups: Option<Formula>,
}

/// Symbols that only the groups of fragments use: the word that orders fragments; the key as a depth, in millionths and
/// in units of 2^-24; the least and the greatest of the pixel's depths in these units.
pub const KEY_SYMBOLS: [&str; 5] = ["key", "depth_millionths", "depth_steps", "nearest_steps", "farthest_steps"];

/// An end of the order of fragments.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// The better fragments are kept.
    Best,
    /// The worse fragments are kept; the better leave and are passed on.
    Worst,
}

impl KeptFragments {
    /// Keeps every fragment.
    pub const fn all() -> Self {
        KeptFragments { side: Side::Best, most: None, group: None, most_groups: None }
    }

    /// Keeps the k best.
    pub const fn best() -> Self {
        let k = Some(Formula(Text::Borrowed("k")));
        KeptFragments { side: Side::Best, most: k, group: None, most_groups: None }
    }

    /// Keeps the k worst.
    pub const fn worst() -> Self {
        let k = Some(Formula(Text::Borrowed("k")));
        KeptFragments { side: Side::Worst, most: k, group: None, most_groups: None }
    }

    /// Keeps the best of each group.
    pub const fn best_of_each(group: &'static str) -> Self {
        let one = Some(Formula(Text::Borrowed("1")));
        KeptFragments { side: Side::Best, most: one, group: Some(Formula(Text::Borrowed(group))), most_groups: None }
    }

    /// Keeps the best of each of k groups, the last of which includes all further ones.
    pub const fn best_of_each_of_k(group: &'static str) -> Self {
        let (one, k) = (Some(Formula(Text::Borrowed("1"))), Some(Formula(Text::Borrowed("k"))));
        KeptFragments { side: Side::Best, most: one, group: Some(Formula(Text::Borrowed(group))), most_groups: k }
    }
}

/// How entries are merged. The order in which colours are blended is not specified; the transmittance of all entries
/// together is.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Merges {
    /// The attribute that is blended, with its opacity last; the other words of an entry come from one fragment.
    pub attribute: Text,
    /// The entries whose keys are specified.
    pub keys: PromisedKeys,
    /// The entries that can be merged from several fragments.
    pub blended: BlendedEntries,
}

/// The entries whose keys equal those of the fragments kept without merging.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PromisedKeys {
    /// Every entry.
    All,
    /// The best entry. The keys of the others are those of some fragments, in the specified number.
    Best,
}

/// Entries that can be merged from several fragments.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BlendedEntries {
    /// One entry with the worst key, if a fragment is missing.
    Worst,
    /// Any entry.
    Any,
}

/// Deviations from the specification that a hazard permits in a final state. Permits of several hazards add up.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Permits {
    /// The hazard needs a race: sequential fragments never show it.
    pub needs_race: bool,
    /// The hazard occurs only if this counter is not 0.
    pub where_counted: Option<Text>,
    /// A fragment that should be kept is missing, and no counter counts it.
    pub lost: bool,
    /// A fragment is stored several times.
    pub duplicate: bool,
    /// Every word of an entry comes from a fragment, but not all from the same one.
    pub torn: Tearing,
    /// A value word is from before the frame.
    pub stale: bool,
    /// Entries are not in the order that the row declares.
    pub unsorted: bool,
    /// One of several equivalent fragments is kept, and the others are counted.
    pub one_of: Equivalence,
    /// Fragments that are rightly not kept are not counted.
    pub uncounted: bool,
    /// A fragment that is not kept is counted several times.
    pub counted_twice: bool,
    /// A fragment times out after its tries, and is counted, although no lock is involved.
    pub times_out: bool,
    /// The image of a pixel depends on the order of arrival, but its content does not.
    pub order_dependent: bool,
}

/// The fragments whose words an entry can mix.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum Tearing {
    /// No others: all words are from one fragment.
    #[default]
    No,
    /// Fragments with its key.
    EqualKeys,
    /// Any fragments.
    Any,
}

/// Which fragments are equivalent.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum Equivalence {
    /// None: each is kept.
    #[default]
    None,
    /// Fragments with equal words.
    Fragments,
    /// Fragments with equal keys and equal first value words.
    Ids,
    /// Fragments with equal keys.
    Keys,
}

impl Permits {
    /// Permits nothing.
    pub const NOTHING: Permits = Permits {
        needs_race: false,
        where_counted: None,
        lost: false,
        duplicate: false,
        torn: Tearing::No,
        stale: false,
        unsorted: false,
        one_of: Equivalence::None,
        uncounted: false,
        counted_twice: false,
        times_out: false,
        order_dependent: false,
    };
    const RACE: Permits = Permits { needs_race: true, ..Permits::NOTHING };
    /// A race loses a fragment.
    pub const LOST: Permits = Permits { lost: true, ..Permits::RACE };
    /// A race stores a fragment twice.
    pub const DUPLICATE: Permits = Permits { duplicate: true, ..Permits::RACE };
    /// A race mixes the words of fragments.
    pub const TORN: Permits = Permits { torn: Tearing::Any, ..Permits::RACE };
    /// A race mixes the words of fragments with equal keys.
    pub const TORN_EQUAL_KEYS: Permits = Permits { torn: Tearing::EqualKeys, ..Permits::RACE };
    /// A race leaves a word of an earlier frame.
    pub const STALE: Permits = Permits { stale: true, ..Permits::RACE };
    /// A race leaves entries out of order.
    pub const UNSORTED: Permits = Permits { unsorted: true, ..Permits::RACE };
    /// One of several equal keys is kept.
    pub const ONE_OF_EQUAL_KEYS: Permits = Permits { one_of: Equivalence::Keys, ..Permits::NOTHING };
    /// One of several equal fragments is kept.
    pub const ONE_OF_EQUAL_FRAGMENTS: Permits = Permits { one_of: Equivalence::Fragments, ..Permits::NOTHING };
    /// One of several fragments with equal keys and equal ids is kept.
    pub const ONE_OF_EQUAL_IDS: Permits = Permits { one_of: Equivalence::Ids, ..Permits::NOTHING };
    /// A race prevents losses from being counted.
    pub const UNCOUNTED: Permits = Permits { uncounted: true, ..Permits::RACE };
    /// A race counts a loss several times.
    pub const COUNTED_TWICE: Permits = Permits { counted_twice: true, ..Permits::RACE };
    /// A race exhausts the tries of a fragment.
    pub const TIMED_OUT: Permits = Permits { times_out: true, ..Permits::RACE };
    /// The image depends on the order of arrival.
    pub const ORDER_DEPENDENT: Permits = Permits { order_dependent: true, ..Permits::NOTHING };
    /// If the last iteration of a loop still changed a slot, races may have mixed any words of the pixel's fragments.
    pub const NOT_CONVERGED: Permits = Permits {
        where_counted: Some(Text::Borrowed("not_converged")),
        lost: true,
        duplicate: true,
        torn: Tearing::Any,
        unsorted: true,
        uncounted: true,
        ..Permits::RACE
    };

    /// If fragments remain after the last iteration, they are missing.
    pub const NOT_PEELED: Permits =
        Permits { where_counted: Some(Text::Borrowed("not_converged")), lost: true, ..Permits::NOTHING };

    /// Joins two permits with the same conditions; returns `None` if the conditions differ.
    pub fn and(&self, other: &Permits) -> Option<Permits> {
        let has_same_conditions = self.needs_race == other.needs_race && self.where_counted == other.where_counted;
        let conditions =
            Permits { where_counted: self.where_counted.clone(), needs_race: self.needs_race, ..Permits::NOTHING };
        has_same_conditions.then(|| conditions.with(self).with(other))
    }

    /// Joins permits whose conditions are all met. The result has no conditions.
    pub fn together<'a>(met: impl Iterator<Item = &'a Permits>) -> Permits {
        met.fold(Permits::NOTHING, Permits::with)
    }

    /// Adds what `other` permits, with the conditions of `self`.
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
            times_out: self.times_out || other.times_out,
            order_dependent: self.order_dependent || other.order_dependent,
        }
    }

    /// Returns whether it permits anything under its conditions.
    pub fn is_something(&self) -> bool {
        Permits { needs_race: false, where_counted: None, ..self.clone() } != Permits::NOTHING
    }

    /// Returns whether the order of arrival can change an image: not by keeping one of several fragments that are equal in all
    /// words of such a payload.
    pub fn depends_on_arrival(&self, value_words: u32) -> bool {
        let are_equal = match self.one_of {
            Equivalence::None | Equivalence::Fragments => true,
            Equivalence::Ids => value_words <= 1,
            Equivalence::Keys => value_words == 0,
        };
        !are_equal || Permits { one_of: Equivalence::None, ..self.clone() }.shows()
    }

    /// Returns whether it affects images and not only counters, other than by fragments that are counted as missing.
    pub fn shows(&self) -> bool {
        let lost = Permits { where_counted: self.where_counted.clone(), lost: true, ..Permits::NOTHING };
        let is_counted_loss = self.where_counted.is_some() && *self == lost;
        !is_counted_loss && Permits { uncounted: false, counted_twice: false, ..self.clone() }.is_something()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn permits_join_only_under_the_same_conditions() {
        let both = Permits { torn: Tearing::Any, ..Permits::LOST };
        assert_eq!(Permits::LOST.and(&Permits::TORN), Some(both));
        for (one, other) in [
            (Permits::TORN, Permits::NOT_CONVERGED),
            (Permits::NOT_CONVERGED, Permits::TORN),
            (Permits::TORN, Permits::ONE_OF_EQUAL_KEYS),
            (Permits::ONE_OF_EQUAL_KEYS, Permits::UNCOUNTED),
        ] {
            assert_eq!(one.and(&other), None, "{one:?} {other:?}");
        }
        let all = Permits::together([Permits::NOT_CONVERGED, Permits::STALE, Permits::ONE_OF_EQUAL_KEYS].iter());
        assert!(all.stale && all.lost && all.one_of == Equivalence::Keys);
        assert_eq!((all.needs_race, all.where_counted), (false, None));
    }

    #[test]
    fn one_of_equal_fragments_does_not_depend_on_arrival() {
        let at = |permits: Permits| [0, 1, 2].map(|value_words| permits.depends_on_arrival(value_words));
        assert_eq!(at(Permits::NOTHING), [false; 3]);
        assert_eq!(at(Permits::ONE_OF_EQUAL_FRAGMENTS), [false; 3]);
        assert_eq!(at(Permits::ONE_OF_EQUAL_IDS), [false, false, true]);
        assert_eq!(at(Permits::ONE_OF_EQUAL_KEYS), [false, true, true]);
        assert_eq!(at(Permits { lost: true, ..Permits::ONE_OF_EQUAL_FRAGMENTS }), [true; 3]);
    }
}
