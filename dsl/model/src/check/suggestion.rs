//! Help for unknown names: the nearest known name, then the list of all.

use crate::nearest_name;

/// Returns "did you mean …?" if a known name is near, then the list.
pub(super) fn suggestion(name: &str, known: &[&str], list: &str) -> String {
    let all = format!("{list} {}", listed(known));
    match nearest_name(name, known) {
        Some(candidate) => format!("did you mean `{candidate}`? {all}"),
        None => all,
    }
}

/// Returns `a, b, c`.
pub(super) fn listed(names: &[&str]) -> String {
    names.join(", ")
}
