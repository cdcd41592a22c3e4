//! Fixes of what the command line gives: `keep 8;` is `--set k=8` there, and `sync: spin_lock` is `--set sync=spin_lock`.
//!
//! Input: the diagnostics of a draft. Output: the same, with each fix as it is given. A change of the file has no effect on what `--set`
//! overrides, and a technique has no file.

use fragbuf_templates::Registry;

use crate::{Diagnostic, Diagnostics, Draft, SET};

/// Replaces the fixes of items that the command line gives.
pub(super) fn fixes(draft: &Draft, registry: &Registry, diagnostics: Diagnostics) -> Diagnostics {
    let has_file = draft.preset.as_ref().is_none_or(|preset| preset.span != draft.name.span);
    let is_set = |axis: &str| {
        let chosen = draft.choices.iter().find(|choice| choice.axis.value == axis);
        !has_file || chosen.is_some_and(|choice| &*choice.axis.span.file == SET)
    };
    let is_k_set = !has_file || draft.keep.as_ref().is_some_and(|keep| &*keep.count.span.file == SET);
    let option = |code: &str| match code.strip_prefix("keep ") {
        Some(k) if is_k_set => {
            let k = k.strip_suffix(';').unwrap_or(k);
            (!k.contains(' ')).then(|| format!("{SET} k={k}"))
        }
        Some(_) => None,
        None => {
            let (axis, value) = code.split_once(": ")?;
            let value = value.strip_suffix(';').unwrap_or(value);
            let is_choice = registry.axis(axis).is_some_and(|known| known.chosen) && is_set(axis);
            is_choice.then(|| given(axis, value))?
        }
    };
    diagnostics
        .iter()
        .map(|diagnostic| Diagnostic { help: replaced(&diagnostic.help, &option), ..diagnostic.clone() })
        .collect()
}

/// Returns the option that chooses a value. `None`: a shell would need quotes.
fn given(axis: &str, value: &str) -> Option<String> {
    let file = value.strip_prefix("wgsl(\"").and_then(|rest| rest.strip_suffix("\")"));
    let value = file.unwrap_or(value);
    let is_word = value.chars().all(|letter| letter.is_ascii_alphanumeric() || "_./".contains(letter));
    is_word.then(|| format!("{SET} {axis}={value}"))
}

/// Replaces parts in backquotes.
fn replaced(help: &str, option: &dyn Fn(&str) -> Option<String>) -> String {
    let parts = help.split('`').enumerate();
    let parts = parts.map(|(number, part)| match number % 2 {
        1 => option(part).unwrap_or_else(|| part.to_owned()),
        _ => part.to_owned(),
    });
    parts.collect::<Vec<_>>().join("`")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_in_backquotes_are_replaced() {
        let option = |code: &str| (code == "keep 8;").then(|| "--set k=8".to_owned());
        assert_eq!(replaced("write `keep 8;`, or choose `a: b`", &option), "write `--set k=8`, or choose `a: b`");
        assert_eq!(replaced("keep 8;", &option), "keep 8;");
        assert_eq!(given("storage", "wgsl(\"a/b.wgsl\")"), Some("--set storage=a/b.wgsl".to_owned()));
        assert_eq!(given("sync", "spin_lock { limit: 4 }"), None);
    }
}
