//! k by the importance of pixels and a memory budget (Vasilakis et al. 2017): the most important pixels keep k fragments, the others a share
//! of k in proportion to their importance, and every pixel one at least.
//!
//! Input: the number of pixels by importance and fragments, and the bytes that a k needs. Output: the greatest k that the budget allows.

use crate::prediction::first;
use crate::vocabulary::HostCall;

/// The greatest importance. The least is 0.
const MOST_IMPORTANT: u64 = 255;

/// The host function `share_k`: reads the pixels by importance and fragments, and returns the greatest k whose regions fit into the budget, or
/// a smaller one that keeps as many fragments.
pub(crate) fn share_k(call: &HostCall<'_>) -> Result<Vec<u64>, String> {
    let value = |name: &str| (call.symbol)(name).ok_or_else(|| format!("`{name}` has no value"));
    let (budget, capacity) = (value("BUDGET_MIB")? << 20, value("capacity")?);
    let most = u32::try_from(capacity.min(value("keep")?)).unwrap_or(u32::MAX);
    let words = call.reads.first().copied().unwrap_or_default();
    let kept = |k: u32| kept(words, capacity, k);
    // A size without a value is beyond any budget.
    let bytes = |k: u32| (call.bytes)(&[("k", k.into()), ("kept", kept(k))]).unwrap_or(u64::MAX);
    if bytes(1) > budget {
        return Err(format!(
            "one fragment per pixel needs {} bytes, and the budget of `allocation` is {budget} bytes: raise `budget`, or draw a smaller \
             frame or lower slices",
            bytes(1)
        ));
    }
    let k_budget = first(most, |k| bytes(k) > budget) - 1;
    let enough = kept(k_budget);
    Ok(vec![first(k_budget, |k| kept(k) == enough).into()])
}

/// Returns the fragments that are kept in all pixels. Word `capacity * importance + f - 1` is the number of pixels with this importance and
/// f fragments.
fn kept(words: &[u32], capacity: u64, k: u32) -> u64 {
    let levels = words.chunks(usize::try_from(capacity).unwrap_or(usize::MAX).max(1));
    let of_level = |(importance, pixels): (u64, &[u32])| {
        let slots = slots(importance, k);
        (1..).zip(pixels).map(|(fragments, pixels)| slots.min(fragments) * u64::from(*pixels)).sum::<u64>()
    };
    (0..).zip(levels).map(of_level).sum()
}

/// Returns the fragments that a pixel keeps at most.
fn slots(importance: u64, k: u32) -> u64 {
    (importance * u64::from(k)).div_ceil(MOST_IMPORTANT).max(1)
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test fails by a panic")]
mod tests {
    use super::*;

    /// Four pixels of full importance with 1, 2, 3 and 4 fragments; one of a third with 4; one of none with 2.
    fn words() -> Vec<u32> {
        let mut words = vec![0; 256 * 4];
        words[255 * 4..].fill(1);
        words[85 * 4 + 3] = 1;
        words[1] = 1;
        words
    }

    /// Returns k if the budget has memory for this many fragments.
    fn k(words: &[u32], fragments: u64, keep: u64) -> Result<u64, String> {
        let bytes = |assumed: &[(&str, u64)]| Some(assumed[1].1 * ((1 << 20) / fragments));
        let symbol = |name: &str| match name {
            "BUDGET_MIB" => Some(1),
            "capacity" => Some(4),
            _ => Some(keep),
        };
        Ok(share_k(&HostCall { reads: vec![words], symbol: &symbol, bytes: &bytes })?[0])
    }

    #[test]
    fn shares_are_rounded_up() {
        let shares = |k| [0, 1, 85, 86, 254, 255].map(|importance| slots(importance, k));
        assert_eq!((shares(1), shares(3), shares(8)), ([1; 6], [1, 1, 1, 2, 3, 3], [1, 1, 3, 3, 8, 8]));
    }

    #[test]
    fn kept_fragments_are_counted() {
        let kept: Vec<u64> = (1..=4).map(|k| kept(&words(), 4, k)).collect();
        // 4, 7, 9 and 10 of the important pixels; 1, 1, 1 and 2 of the next; 1.
        assert_eq!(kept, [6, 9, 11, 13]);
    }

    #[test]
    fn k_is_the_greatest_within_the_budget_that_keeps_more() {
        let words = words();
        for (fragments, expected) in [(6, 1), (8, 1), (9, 2), (12, 3), (13, 4), (99, 4)] {
            assert_eq!(k(&words, fragments, 4), Ok(expected), "{fragments}");
        }
        assert_eq!(k(&words, 99, 3), Ok(3));
        assert!(k(&words, 5, 4).unwrap_err().contains("one fragment per pixel needs"));
        let mut shallow = vec![0; 256 * 4];
        shallow[200 * 4] = 7;
        assert_eq!((k(&shallow, 99, 4), k(&[], 99, 4)), (Ok(1), Ok(1)));
    }
}
