//! The help for an unknown name: the nearest known name, or all of them.

use fragbuf_model::nearest_name;

/// Returns "did you mean …?" if a known name is near, else the list of known names.
pub(crate) fn help<S: AsRef<str>>(name: &str, known: &[S]) -> String {
    match nearest_name(name, known) {
        Some(nearest) => format!("did you mean `{nearest}`?"),
        None => {
            let list: Vec<String> = known.iter().map(|known| format!("`{}`", known.as_ref())).collect();
            format!("expected one of: {}", list.join(", "))
        }
    }
}
