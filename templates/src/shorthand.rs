//! Names of hazards that stand for a part of the reference model in the head of a user's file, which has no other words for it.
//!
//! In: a name. Out: what the rows of fragbuf that have a hazard of this name state. No check reads names.

use crate::overflow::{MERGED_FARTHEST, MERGED_NEIGHBOURS};
use crate::storage::DEPTH_RANGE;
use crate::vocabulary::{Kept, Merges, Permits};

/// What the name of a hazard stands for in the head of a user's file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Shorthand {
    /// What may go wrong.
    Permits(Permits),
    /// Which fragments stay.
    Keeps(Kept),
    /// How entries become one.
    Merges(Merges),
}

impl Shorthand {
    /// Every name that stands for something.
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
        ("given-up", Shorthand::Permits(Permits::GIVES_UP)),
        ("unsettled", Shorthand::Permits(Permits::UNSETTLED)),
        ("shows-arrival", Shorthand::Permits(Permits::SHOWS_ARRIVAL)),
        ("one-per-range", Shorthand::Keeps(Kept::best_of_each(DEPTH_RANGE))),
        ("merged-farthest", Shorthand::Merges(MERGED_FARTHEST)),
        ("merged-neighbours", Shorthand::Merges(MERGED_NEIGHBOURS)),
    ];

    /// What this name stands for; `None`: nothing that can be checked.
    pub fn of(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|(known, _)| *known == name).map(|(_, shorthand)| shorthand)
    }
}
