//! Suggests a known name in place of an unknown one.

/// Returns the known name with the fewest edits from `name`, if at most a third of the letters differ, else the first that begins with
/// it. Case is ignored.
pub fn nearest_name<'a, S: AsRef<str>>(name: &str, known: &'a [S]) -> Option<&'a str> {
    let limit = (name.chars().count() / 3).max(1);
    let near = known
        .iter()
        .map(|candidate| (distance(name, candidate.as_ref()), candidate.as_ref()))
        .filter(|(edits, candidate)| *edits <= limit && candidate.chars().count() > *edits)
        .min_by_key(|(edits, _)| *edits)
        .map(|(_, candidate)| candidate);
    near.or_else(|| completed(name, known))
}

/// Returns the first known name that begins with these letters, of which there must be at least three.
fn completed<'a, S: AsRef<str>>(name: &str, known: &'a [S]) -> Option<&'a str> {
    let begins = |candidate: &&str| {
        let start = candidate.get(..name.len()).is_some_and(|start| start.eq_ignore_ascii_case(name));
        start && name.chars().count() >= 3
    };
    known.iter().map(AsRef::as_ref).find(begins)
}

/// Returns the number of insertions, deletions, replacements and swaps of neighbouring letters between two names
/// (Damerau 1964, optimal string alignment). Case is ignored.
fn distance(a: &str, b: &str) -> usize {
    // Names are short; of longer text only the beginning is compared.
    let a: Vec<char> = a.to_lowercase().chars().take(40).collect();
    let b: Vec<char> = b.to_lowercase().chars().take(40).collect();
    let mut rows = vec![(0..=b.len()).collect::<Vec<usize>>()];
    for (i, x) in a.iter().enumerate() {
        let mut row = vec![i + 1];
        for (j, y) in b.iter().enumerate() {
            let mut best = (rows[i][j] + usize::from(x != y)).min(rows[i][j + 1] + 1).min(row[j] + 1);
            if i > 0 && j > 0 && *x == b[j - 1] && a[i - 1] == *y {
                best = best.min(rows[i - 1][j - 1] + 1);
            }
            row.push(best);
        }
        rows.push(row);
    }
    rows[a.len()][b.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn suggests_near_names_only() {
        let known = ["insertion", "none"];
        assert_eq!(nearest_name("insertoin", &known), Some("insertion"));
        assert_eq!(nearest_name("bitonic", &known), None);
        assert_eq!((nearest_name("Ins", &known), nearest_name("in", &known)), (Some("insertion"), None));
        assert_eq!((distance("kitten", "sitting"), distance("ab", "Ba")), (3, 1));
    }
}
