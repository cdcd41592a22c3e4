//! The event counters of a frame, by name.

use fragbuf_templates::{COUNTERS, CounterKind};

/// The vocabulary's name for the resource that holds the counters.
pub const COUNTERS_RESOURCE: &str = "counters";

/// The counter of fragments that did not fit into a pool.
pub const POOL_EXHAUSTED: &str = "pool_exhausted";

/// The counter of fragments that a stream composited too late.
pub const OUT_OF_ORDER: &str = "out_of_order";

/// The counter of fragments that cover their pixel partially, where routing expects whole pixels.
pub const PARTIAL_COVERAGE: &str = "partial_coverage";

/// The counters of a frame. With `counters: losses`, the default, only losses are counted; the others, `displaced` too, stay 0.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Counters(pub Vec<Counter>);

/// One counter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Counter {
    /// Its name, one of [`fragbuf_templates::COUNTERS`].
    pub name: &'static str,
    /// What each event means for the image.
    pub kind: CounterKind,
    /// The events of the frame.
    pub count: u32,
}

impl Counters {
    /// Returns the counters of each slice.
    pub fn per_slice(words: &[u32]) -> Vec<Self> {
        words.chunks(COUNTERS.len()).map(Counters::from_words).collect()
    }

    /// Returns the sums over all slices.
    pub fn sum(words: &[u32]) -> Self {
        let mut sums = vec![0_u32; COUNTERS.len()];
        for slice in words.chunks(COUNTERS.len()) {
            for (sum, count) in sums.iter_mut().zip(slice) {
                *sum = sum.saturating_add(*count);
            }
        }
        Counters::from_words(&sums)
    }

    /// Returns the sums of the counters of slices.
    pub fn total(slices: &[Counters]) -> Self {
        let mut total = Counters::from_words(&[0; COUNTERS.len()]);
        for slice in slices {
            for (sum, counter) in total.0.iter_mut().zip(&slice.0) {
                sum.count = sum.count.saturating_add(counter.count);
            }
        }
        total
    }

    /// Returns the counters of one slice.
    pub fn from_words(words: &[u32]) -> Self {
        let counters = COUNTERS.iter().zip(words);
        Counters(counters.map(|(&(name, kind, _), &count)| Counter { name, kind, count }).collect())
    }

    /// Returns the events of the counter `name`; 0 for an unknown name.
    pub fn get(&self, name: &str) -> u32 {
        self.0.iter().find(|counter| counter.name == name).map_or(0, |counter| counter.count)
    }

    /// Returns the number of lost fragments, for any reason. Displaced fragments are not lost.
    pub fn lost(&self) -> u64 {
        self.0.iter().filter(|counter| counter.is_loss()).map(|counter| u64::from(counter.count)).sum()
    }
}

impl Counter {
    /// Returns whether each event is a fragment that is missing from the image.
    pub fn is_loss(&self) -> bool {
        self.kind == CounterKind::Loss
    }
}
