//! Options that must be so great at least for what is kept.

use fragbuf_templates::vocabulary::Formula;

use crate::variant::{Chosen, Selected};
use crate::{Diagnostic, Diagnostics, Draft, Origin, codes};

/// Checks every option that was set, where a description keeps `k`.
pub(super) fn check(draft: &Draft, choices: &[Chosen], k: u32, diagnostics: &mut Diagnostics) {
    for chosen in choices {
        for selected in &chosen.alternatives {
            for (option, least) in &selected.row.least {
                if let Some(needed) = missed(selected, option, least, k) {
                    let origin = place(draft, &chosen.axis, option).unwrap_or(&chosen.origin);
                    let row = &selected.row;
                    diagnostics.push(Diagnostic::new(
                        codes::BAD_OPTION,
                        origin,
                        format!("`{}: {}` needs `{option}` to be at least {needed} to keep {k}", row.axis, row.key),
                        format!("write `{option}: {needed}` or more, drop it for what suits, or keep fewer"),
                    ));
                }
            }
        }
    }
}

/// The least that the option must be, if it was set to less.
fn missed(selected: &Selected, option: &str, least: &Formula, k: u32) -> Option<u64> {
    let (_, set) = selected.options.iter().find(|(name, _)| name == option)?;
    let needed = least.evaluate(&|symbol| (symbol == "k").then_some(u64::from(k))).ok()?;
    (u64::from(*set) < needed).then_some(needed)
}

/// Where the option was set.
fn place<'a>(draft: &'a Draft, axis: &str, option: &str) -> Option<&'a Origin> {
    let choices = draft.choices.iter().filter(|choice| choice.axis.value == axis);
    let options = choices.flat_map(|choice| &choice.alternatives).flat_map(|alternative| &alternative.options);
    options.map(|(name, value)| (name, &value.origin)).find(|(name, _)| name.value == option).map(|(_, origin)| origin)
}
