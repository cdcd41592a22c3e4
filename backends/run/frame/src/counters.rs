//! The events of a frame, by the counters' names.

use fragbuf_templates::COUNTERS;

/// The vocabulary's name for the resource that counters are kept in.
pub const COUNTERS_RESOURCE: &str = "counters";

/// The counter of fragments that found no room.
pub const POOL_EXHAUSTED: &str = "pool_exhausted";

/// The counter of fragments that a stream composited too late.
pub const OUT_OF_ORDER: &str = "out_of_order";

/// The counter of fragments that cover their pixel in part, where routing wants whole pixels.
pub const PARTLY_COVERED: &str = "partly_covered";

/// What a frame counted. With `counters: losses`, the default, only losses are; the others stay 0.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Counters(pub Vec<Counter>);

/// One counter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Counter {
    /// Its name, one of [`fragbuf_templates::COUNTERS`].
    pub name: &'static str,
    /// Whether each event is a fragment lost.
    pub loss: bool,
    /// Events of the frame.
    pub count: u32,
}

impl Counters {
    /// Those of one slice after the other.
    pub fn each(words: &[u32]) -> Vec<Self> {
        words.chunks(COUNTERS.len()).map(Counters::from_words).collect()
    }

    /// Those of all slices together.
    pub fn sum(words: &[u32]) -> Self {
        let mut sums = vec![0_u32; COUNTERS.len()];
        for slice in words.chunks(COUNTERS.len()) {
            for (sum, count) in sums.iter_mut().zip(slice) {
                *sum = sum.saturating_add(*count);
            }
        }
        Counters::from_words(&sums)
    }

    fn from_words(words: &[u32]) -> Self {
        let counters = COUNTERS.iter().zip(words);
        Counters(counters.map(|(&(name, loss, _), &count)| Counter { name, loss, count }).collect())
    }

    /// Events of the counter `name`; 0 for a name that there is not.
    pub fn get(&self, name: &str) -> u32 {
        self.0.iter().find(|counter| counter.name == name).map_or(0, |counter| counter.count)
    }

    /// Fragments lost, for whatever reason.
    pub fn lost(&self) -> u64 {
        self.0.iter().filter(|counter| counter.loss).map(|counter| u64::from(counter.count)).sum()
    }
}
