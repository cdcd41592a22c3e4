//! "Did you mean": the nearest of the names that exist.

/// The hint for a name that does not exist among those that do.
pub(crate) fn hint<S: AsRef<str>>(name: &str, existing: &[S]) -> String {
    let list = || existing.iter().map(|word| format!("`{}`", word.as_ref())).collect::<Vec<_>>().join(", ");
    match nearest(name, existing) {
        Some(word) => format!("did you mean `{word}`?"),
        None => format!("there are: {}", list()),
    }
}

/// The nearest name, if one is near: at most a third of the letters differ.
pub(crate) fn nearest<'a, S: AsRef<str>>(name: &str, existing: &'a [S]) -> Option<&'a str> {
    let limit = (name.chars().count() / 3).max(1);
    existing
        .iter()
        .map(|word| (distance(name, word.as_ref()), word.as_ref()))
        .filter(|(steps, word)| *steps <= limit && word.chars().count() > *steps)
        .min_by_key(|(steps, _)| *steps)
        .map(|(_, word)| word)
}

/// Letters to insert, delete, replace or swap with a neighbour to get from one to the other, case apart.
fn distance(a: &str, b: &str) -> usize {
    // Names are short; text that is not a name is not compared in full.
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
