//! The host functions of built-in rows. Each takes the words that its step reads and returns the values of the
//! symbols that it sets.

use crate::{Error, Values};

/// Calls a host function.
pub fn call(function: &str, words: &[u32], values: &Values) -> Result<Vec<u64>, Error> {
    match function {
        "allocate" => Ok(words.iter().copied().map(u64::from).collect()),
        "predict_k" => Ok(vec![predict_k(words, values)?]),
        "share_k" => Ok(vec![share_k(words, values)?]),
        _ => Err(Error(format!("the manifest names the host function `{function}`, which this host does not have"))),
    }
}

/// Returns the least k that keeps the wanted part of the fragments, or the greatest whose buffers fit into the
/// budget. The words are 1024 bins, the pixels with 1, 2, … fragments, and the fragments beyond the 1024th of their
/// pixels.
fn predict_k(words: &[u32], values: &Values) -> Result<u64, Error> {
    let bins = words.get(..1024).unwrap_or(words);
    let beyond = words.get(1024).map_or(0, |beyond| u64::from(*beyond));
    let kept = |k: u64| (1..).zip(bins).map(|(count, pixels)| k.min(count) * u64::from(*pixels)).sum::<u64>();
    let fragments = kept(u64::MAX) + beyond;
    let percent = values.value("HIT_PERCENT", 0)?;
    let most = greatest_k(values)?.min(1024);
    let fitting = within_budget(values, most, &|k| vec![("k", k), ("kept", kept(k)), ("fragments", fragments)])?;
    let wanted = fragments.saturating_mul(percent);
    least(1, fitting, &|k| Ok(kept(k).saturating_mul(100) >= wanted))
}

/// Returns the greatest k whose buffers fit into the budget, where a pixel of importance i keeps ⌈i · k / 255⌉
/// fragments and one at least; of several with the same image the least. Word `capacity · i + f - 1` is the number of
/// pixels of importance i with f fragments.
fn share_k(words: &[u32], values: &Values) -> Result<u64, Error> {
    let capacity = values.value("capacity", 0)?.max(1);
    let kept = |k: u64| {
        let of_word = |(at, pixels): (u64, &u32)| {
            let (importance, fragments) = (at / capacity, at % capacity + 1);
            u64::from(*pixels) * fragments.min(importance.saturating_mul(k).div_ceil(255).max(1))
        };
        (0..).zip(words).map(of_word).sum::<u64>()
    };
    let fitting = within_budget(values, greatest_k(values)?, &|k| vec![("k", k), ("kept", kept(k))])?;
    least(1, fitting, &|k| Ok(kept(k) == kept(fitting)))
}

fn greatest_k(values: &Values) -> Result<u64, Error> {
    Ok(values.value("keep", 0)?.min(values.value("capacity", 0)?))
}

/// Returns the greatest k from 1 to `most` whose buffers fit into the budget of the description.
fn within_budget(values: &Values, most: u64, assumed: &dyn Fn(u64) -> Vec<(&'static str, u64)>) -> Result<u64, Error> {
    let budget = values.value("BUDGET_MIB", 0)?.saturating_mul(1 << 20);
    // Memory grows with k.
    let exceeds = |k: u64| Ok(values.all_bytes_with(&assumed(k))? > budget);
    let k = least(1, most.saturating_add(1), &exceeds)? - 1;
    if k == 0 {
        return Err(Error(format!(
            "one fragment per pixel does not fit into the budget of `allocation`, {budget} bytes: raise it in the \
             description, or draw a smaller frame or slices of it"
        )));
    }
    Ok(k)
}

/// Returns the least number from `first` on for which `holds`, or `end` if it holds for none before. It holds for all numbers above one
/// for which it does.
fn least(first: u64, end: u64, holds: &dyn Fn(u64) -> Result<bool, Error>) -> Result<u64, Error> {
    let (mut low, mut high) = (first, end.max(first));
    while low < high {
        let middle = low + (high - low) / 2;
        if holds(middle)? { high = middle } else { low = middle + 1 }
    }
    Ok(low)
}

#[cfg(test)]
mod tests {
    use super::least;

    #[test]
    fn the_least_number_is_found() {
        for first in 0..4 {
            for end in 0..12 {
                for wanted in 0..12 {
                    let expected = (first..end).find(|number| *number >= wanted).unwrap_or(end.max(first));
                    assert_eq!(least(first, end, &|number| Ok(number >= wanted)).ok(), Some(expected));
                }
            }
        }
        assert_eq!(least(1, u64::MAX, &|_| Ok(false)).ok(), Some(u64::MAX));
    }
}
