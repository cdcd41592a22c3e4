//! Hints for words that are not known: the nearest that is, and all of them.

/// "did you mean …" if a known word is near, then the list.
pub(super) fn suggestion(word: &str, known: &[&str], list: &str) -> String {
    let near = known
        .iter()
        .map(|candidate| (distance(word, candidate), candidate))
        .filter(|(distance, candidate)| *distance <= candidate.len().max(3) / 3)
        .min();
    let all = format!("{list} {}", listed(known));
    match near {
        Some((_, candidate)) => format!("did you mean `{candidate}`? {all}"),
        None => all,
    }
}

/// `a, b, c`.
pub(super) fn listed(words: &[&str]) -> String {
    words.join(", ")
}

/// The number of single-letter changes between two words (Levenshtein 1966).
fn distance(a: &str, b: &str) -> usize {
    let b: Vec<char> = b.chars().collect();
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (i, from) in a.chars().enumerate() {
        let mut diagonal = row[0];
        row[0] = i + 1;
        for (j, to) in b.iter().enumerate() {
            let changed = diagonal + usize::from(from != *to);
            diagonal = row[j + 1];
            row[j + 1] = changed.min(row[j] + 1).min(diagonal + 1);
        }
    }
    row[b.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn near_words_are_suggested_far_ones_are_not() {
        let known = ["insertion", "none"];
        assert!(suggestion("insertoin", &known, "x").starts_with("did you mean `insertion`?"));
        assert_eq!(suggestion("bitonic", &known, "the sorts are"), "the sorts are insertion, none");
        assert_eq!(distance("kitten", "sitting"), 3);
    }
}
