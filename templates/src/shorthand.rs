//! Names of hazards that stand for a part of the reference model in the header of a user's file, which has no other
//! syntax for it.
//!
//! Input: a name. Output: what the rows of fragbuf with a hazard of this name declare. The checker never reads names.

use crate::overflow::{MERGED_FARTHEST, MERGED_NEIGHBOURS};
use crate::storage::DEPTH_RANGE;
use crate::vocabulary::{KeptFragments, Merges, Permits};

/// The part of the reference model that a hazard's name stands for in the header of a user's file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Shorthand {
    /// What can go wrong.
    Permits(Permits),
    /// Which fragments are kept.
    Keeps(KeptFragments),
    /// How entries are merged.
    Merges(Merges),
}

impl Shorthand {
    /// Every name with a meaning.
    pub const ALL: [(&str, Shorthand); 16] = [
        ("lost-update", Shorthand::Permits(Permits::LOST)),
        ("duplicate", Shorthand::Permits(Permits::DUPLICATE)),
        ("torn", Shorthand::Permits(Permits::TORN)),
        ("stale", Shorthand::Permits(Permits::STALE)),
        ("unsorted", Shorthand::Permits(Permits::UNSORTED)),
        ("equal-keys", Shorthand::Permits(Permits::ONE_OF_EQUAL_KEYS)),
        ("equal-fragments", Shorthand::Permits(Permits::ONE_OF_EQUAL_FRAGMENTS)),
        ("torn-equal-keys", Shorthand::Permits(Permits::TORN_EQUAL_KEYS)),
        ("uncounted", Shorthand::Permits(Permits::UNCOUNTED)),
        ("counted-twice", Shorthand::Permits(Permits::COUNTED_TWICE)),
        ("timed-out", Shorthand::Permits(Permits::TIMED_OUT)),
        ("not-converged", Shorthand::Permits(Permits::NOT_CONVERGED)),
        ("order-dependent", Shorthand::Permits(Permits::ORDER_DEPENDENT)),
        ("one-per-range", Shorthand::Keeps(KeptFragments::best_of_each(DEPTH_RANGE))),
        ("merged-farthest", Shorthand::Merges(MERGED_FARTHEST)),
        ("merged-neighbours", Shorthand::Merges(MERGED_NEIGHBOURS)),
    ];

    /// Returns the meaning of a name; `None` if it is not a shorthand.
    pub fn of(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|(known, _)| *known == name).map(|(_, shorthand)| shorthand)
    }
}
