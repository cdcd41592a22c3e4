//! A set of lanes, and masks of lanes.

/// The invocations that a [`LaneMachine`](super::LaneMachine) runs at once.
pub const LANES: usize = 16;

/// A word of every lane.
pub(crate) type Lanes = [u32; LANES];

/// The bit of each lane.
const BITS: Lanes = {
    let mut bits = [0; LANES];
    let mut lane = 0;
    while lane < LANES {
        bits[lane] = 1 << lane;
        lane += 1;
    }
    bits
};

/// A set of lanes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LaneSet(u32);

impl LaneSet {
    /// Returns the first `count` lanes.
    pub fn first(count: usize) -> Self {
        LaneSet((1u32 << count.min(LANES)) - 1)
    }

    /// Returns the lanes whose word is zero.
    #[inline]
    pub(super) fn zeros(words: &Lanes) -> Self {
        let mut bits = [0; LANES];
        for lane in 0..LANES {
            bits[lane] = if words[lane] == 0 { BITS[lane] } else { 0 };
        }
        LaneSet(bits.iter().fold(0, |all, bit| all | bit))
    }

    /// Returns whether the set has no lanes.
    pub fn is_empty(self) -> bool {
        self.0 == 0
    }

    /// Returns the number of lanes.
    pub fn lanes(self) -> usize {
        self.0.count_ones() as usize
    }

    /// Returns whether the set has a lane.
    pub fn contains(self, lane: usize) -> bool {
        self.0 >> lane & 1 == 1
    }

    pub(super) fn and(self, other: Self) -> Self {
        LaneSet(self.0 & other.0)
    }

    pub(super) fn or(self, other: Self) -> Self {
        LaneSet(self.0 | other.0)
    }

    pub(super) fn without(self, other: Self) -> Self {
        LaneSet(self.0 & !other.0)
    }

    /// Returns a mask per lane: all bits are set in the lanes of the set.
    pub(super) fn mask(self) -> Lanes {
        let mut mask = [0; LANES];
        for (lane, word) in mask.iter_mut().enumerate() {
            *word = if self.0 & BITS[lane] != 0 { u32::MAX } else { 0 };
        }
        mask
    }
}

/// Removes lane after lane, in ascending order.
impl Iterator for LaneSet {
    type Item = usize;

    #[inline]
    fn next(&mut self) -> Option<usize> {
        if self.0 == 0 {
            return None;
        }
        let lane = self.0.trailing_zeros() as usize % LANES;
        self.0 &= self.0 - 1;
        Some(lane)
    }
}
