//! k from a histogram of depth complexity, a memory budget and a hit ratio (K15 §4.2, Eq. 4-7, corrected).
//!
//! Input: the number of pixels with each number of fragments, and the bytes that a k needs. Output: the least k that keeps
//! the wanted part of the fragments, or the greatest that the budget allows. All numbers are integers. The paper's Eq. 6
//! read literally always gives the k of the budget, and its constraint forgets that the budget is in MiB.

use crate::vocabulary::HostCall;

/// The number of bins of a histogram. The last counts the pixels with this many fragments or more.
pub const BINS: usize = 1024;

/// The number of pixels with each number of fragments.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Histogram {
    /// Bin `c - 1` is the number of pixels with `c` fragments.
    bins: Vec<u64>,
    fragments: u64,
}

/// A predicted k.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Prediction {
    /// The fragments that a pixel keeps.
    pub k: u32,
    /// The greatest k within the budget.
    pub k_budget: u32,
    /// Whether `k` keeps the wanted part of the fragments.
    pub goal_met: bool,
    /// The fragments that `k` keeps, in all pixels.
    pub kept: u64,
    /// The bytes that `k` needs.
    pub bytes: u64,
}

/// The wanted part of the fragments: a numerator and a denominator, more than 0 and at most 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct HitRatio(pub u64, pub u64);

/// Not even one fragment per pixel fits into the budget.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BudgetTooSmall {
    /// The bytes that one fragment per pixel needs.
    pub needed: u64,
    /// The bytes of the budget.
    pub budget: u64,
}

impl Histogram {
    /// Returns the histogram of pixels with these numbers of fragments.
    pub fn of_pixels(fragments: impl IntoIterator<Item = u32>) -> Self {
        let mut histogram = Histogram { bins: vec![0; BINS], fragments: 0 };
        for count in fragments.into_iter().filter(|count| *count > 0) {
            histogram.bins[(count as usize).min(BINS) - 1] += 1;
            histogram.fragments += u64::from(count);
        }
        histogram
    }

    /// Returns the histogram of the words of the resource `histogram`: the bins, and the fragments beyond the last bin's of
    /// their pixels. Missing words count as 0.
    pub fn of_words(words: &[u32]) -> Self {
        let mut bins: Vec<u64> = words.iter().take(BINS).map(|pixels| u64::from(*pixels)).collect();
        bins.resize(BINS, 0);
        let beyond = words.get(BINS).map_or(0, |beyond| u64::from(*beyond));
        let fragments = (1..).zip(&bins).fold(beyond, |sum, (count, pixels)| sum + count * pixels);
        Histogram { bins, fragments }
    }

    /// Returns the bins: bin `c - 1` is the number of pixels with `c` fragments, the last that of pixels with 1024 or more.
    pub fn bins(&self) -> &[u64] {
        &self.bins
    }

    /// Returns the number of all fragments.
    pub fn fragments(&self) -> u64 {
        self.fragments
    }

    /// Returns the fragments that are kept if each pixel keeps at most `k`, from 1 to 1024.
    pub fn hits(&self, k: u32) -> u64 {
        (1..).zip(&self.bins).map(|(count, pixels)| u64::from(k).min(count) * pixels).sum()
    }

    /// Predicts k, from 1 to `most`. `bytes` returns what a k needs if pixels keep so many fragments in all; it must not
    /// shrink as these grow. Without fragments k is 1.
    pub fn predict(
        &self,
        HitRatio(numerator, denominator): HitRatio,
        budget: u64,
        most: u32,
        bytes: &dyn Fn(u32, u64) -> u64,
    ) -> Result<Prediction, BudgetTooSmall> {
        let needed = |k: u32| bytes(k, self.hits(k));
        let most = most.clamp(1, BINS as u32);
        if needed(1) > budget {
            return Err(BudgetTooSmall { needed: needed(1), budget });
        }
        let k_budget = first(most, |k| needed(k) > budget) - 1;
        let is_enough = |k: u32| {
            u128::from(self.hits(k)) * u128::from(denominator) >= u128::from(self.fragments) * u128::from(numerator)
        };
        let k = first(k_budget, is_enough).min(k_budget);
        Ok(Prediction { k, k_budget, goal_met: is_enough(k), kept: self.hits(k), bytes: needed(k) })
    }
}

/// Returns the first number from 1 to `end` that holds, or `end + 1`. No number may fail after one that holds.
pub(crate) fn first(end: u32, holds: impl Fn(u32) -> bool) -> u32 {
    let (mut low, mut high) = (1, end + 1);
    while low < high {
        let middle = low + (high - low) / 2;
        if holds(middle) { high = middle } else { low = middle + 1 }
    }
    low
}

/// The host function `predict_k`: reads a histogram, and returns k within the budget and the hit ratio of the description.
pub(crate) fn predict_k(call: &HostCall<'_>) -> Result<Vec<u64>, String> {
    let histogram = Histogram::of_words(call.reads.first().copied().unwrap_or_default());
    let value = |name: &str| (call.symbol)(name).ok_or_else(|| format!("`{name}` has no value"));
    let (budget, percent) = (value("BUDGET_MIB")? << 20, value("HIT_PERCENT")?);
    // The capacity of the code may be greater than the k of the description.
    let most = u32::try_from(value("capacity")?.min(value("keep")?)).unwrap_or(u32::MAX);
    // A size without a value is beyond any budget.
    let bytes = |k: u32, kept: u64| {
        let assumed = [("k", k.into()), ("kept", kept), ("fragments", histogram.fragments())];
        (call.bytes)(&assumed).unwrap_or(u64::MAX)
    };
    match histogram.predict(HitRatio(percent, 100), budget, most, &bytes) {
        Ok(prediction) => Ok(vec![prediction.k.into()]),
        Err(BudgetTooSmall { needed, budget }) => Err(format!(
            "one fragment per pixel needs {needed} bytes, and the budget of `allocation` is {budget} bytes: raise `budget`, or draw a \
             smaller frame or lower slices"
        )),
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test fails by a panic")]
mod tests {
    use super::*;

    /// The example of the corrected equations: 16 pixels, 22 fragments.
    fn example() -> Histogram {
        Histogram::of_pixels([1, 1, 1, 1, 2, 2, 5, 9, 0, 0, 0, 0, 0, 0, 0, 0])
    }

    fn fixed(budget: u64, ratio: HitRatio) -> Result<Prediction, BudgetTooSmall> {
        example().predict(ratio, budget, 1024, &|k, _| 16 * (8 * u64::from(k) + 8))
    }

    #[test]
    fn hits_are_those_of_the_example() {
        let hits: Vec<u64> = (1..=9).map(|k| example().hits(k)).collect();
        assert_eq!(hits, [8, 12, 14, 16, 18, 19, 20, 21, 22]);
        assert_eq!(example().fragments(), 22);
    }

    #[test]
    fn fixed_allocation() {
        let huge = 1 << 40;
        assert_eq!(fixed(huge, HitRatio(90, 100)).unwrap().k, 7);
        assert_eq!(fixed(huge, HitRatio(20, 22)).unwrap().k, 7);
        assert_eq!(fixed(huge, HitRatio(95, 100)).unwrap().k, 8);
        let missed = fixed(768, HitRatio(95, 100)).unwrap();
        assert_eq!(missed, Prediction { k: 5, k_budget: 5, goal_met: false, kept: 18, bytes: 768 });
        assert_eq!(fixed(256, HitRatio(95, 100)).unwrap().k, 1);
        assert_eq!(fixed(255, HitRatio(95, 100)), Err(BudgetTooSmall { needed: 256, budget: 255 }));
    }

    #[test]
    fn exact_allocation() {
        let predict = |budget| example().predict(HitRatio(95, 100), budget, 1024, &|_, kept| 8 * kept + 12 * 16);
        let prediction = predict(340).unwrap();
        assert_eq!((prediction.k_budget, prediction.bytes), (5, 336));
        assert!(predict(8 * 8 + 12 * 16 - 1).is_err());
    }

    #[test]
    fn the_sizes_of_the_paper() {
        let k = |width: u64, height: u64| {
            let bytes = |k: u32, _| width * height * (8 * u64::from(k) + 8);
            Histogram::of_pixels([2000]).predict(HitRatio(1, 1), 200 << 20, 1024, &bytes).unwrap().k_budget
        };
        assert_eq!((k(1024, 768), k(1024, 1024)), (32, 24));
    }

    #[test]
    fn no_fragments_need_one_slot() {
        let nothing = Histogram::of_pixels([0, 0]).predict(HitRatio(1, 1), 100, 8, &|k, _| u64::from(k)).unwrap();
        assert_eq!(nothing, Prediction { k: 1, k_budget: 8, goal_met: true, kept: 0, bytes: 1 });
    }

    #[test]
    fn words_hold_deep_pixels() {
        let mut words = vec![0_u32; BINS + 1];
        (words[2], words[BINS - 1], words[BINS]) = (5, 2, 3000 - 1024 + 10);
        let histogram = Histogram::of_words(&words);
        assert_eq!(histogram, Histogram::of_pixels([3, 3, 3, 3, 3, 3000, 1034]));
        assert_eq!(histogram.hits(1024), 15 + 2048);
    }

    /// Every k is tried, on histograms of random pixels.
    #[test]
    fn equal_to_trying_every_k() {
        let mut state = 1_u64;
        let mut below = |most: u64| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            (state >> 33) % most
        };
        for _ in 0..300 {
            let pixels: Vec<u32> =
                (0..20).map(|_| [0, 1, 2, 7, 40, 1500][below(6) as usize] + below(4) as u32).collect();
            let histogram = Histogram::of_pixels(pixels.iter().copied());
            let kept = |k: u32| pixels.iter().map(|count| u64::from(*count.min(&k))).sum::<u64>();
            let (x, y, budget) = (1 + below(16), below(50), 1 + below(60_000));
            let (ratio, most) = (HitRatio(1 + below(100), 100), 1 + below(1024) as u32);
            let exact = below(2) == 1;
            let bytes = |k: u32, kept: u64| if exact { x * kept + 20 * y } else { 20 * (x * u64::from(k) + y) };
            let fitting: Vec<u32> = (1..=most).filter(|k| bytes(*k, kept(*k)) <= budget).collect();
            let predicted = histogram.predict(ratio, budget, most, &bytes);
            let Some(k_budget) = fitting.last().copied() else {
                assert!(predicted.is_err());
                continue;
            };
            let goal = fitting.iter().copied().find(|k| kept(*k) * 100 >= histogram.fragments() * ratio.0);
            let k = goal.unwrap_or(k_budget);
            let expected =
                Prediction { k, k_budget, goal_met: goal.is_some(), kept: kept(k), bytes: bytes(k, kept(k)) };
            assert_eq!(predicted, Ok(expected), "{pixels:?}");
        }
    }
}
