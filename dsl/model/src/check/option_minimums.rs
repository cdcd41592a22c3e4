//! Checks options that have a minimum, which depends on k.

use fragbuf_templates::vocabulary::Formula;

use crate::variant::{AxisChoice, SelectedRow};
use crate::{Diagnostic, Diagnostics, Draft, SourceSpan, codes, counted};

/// Checks every option that the description sets; `k` is the number of fragments that it keeps.
pub(super) fn check(draft: &Draft, choices: &[AxisChoice], k: u32, diagnostics: &mut Diagnostics) {
    for chosen in choices {
        for selected in &chosen.alternatives {
            for (option, least) in &selected.row.least {
                if let Some(needed) = violated_minimum(selected, option, least, k) {
                    let span = option_span(draft, &chosen.axis, option).unwrap_or(&chosen.span);
                    let (row, kept) = (&selected.row, counted(k, "fragment"));
                    diagnostics.push(Diagnostic::new(
                        codes::INVALID_OPTION,
                        span,
                        format!("`{}: {}` requires `{option}` to be at least {needed} to keep {kept}", row.axis, row.key),
                        format!("write `{option}: {needed}` or more, remove the option to use its default, or keep fewer fragments"),
                    ));
                }
            }
        }
    }
}

/// Returns the minimum of the option if the description sets it to less.
fn violated_minimum(selected: &SelectedRow, option: &str, least: &Formula, k: u32) -> Option<u64> {
    let (_, set) = selected.options.iter().find(|(name, _)| name == option)?;
    let needed = least.evaluate(&|symbol| (symbol == "k").then_some(u64::from(k))).ok()?;
    (u64::from(*set) < needed).then_some(needed)
}

/// Returns the span of the option's value.
fn option_span<'a>(draft: &'a Draft, axis: &str, option: &str) -> Option<&'a SourceSpan> {
    let choices = draft.choices.iter().filter(|choice| choice.axis.value == axis);
    let options = choices.flat_map(|choice| &choice.alternatives).flat_map(|alternative| &alternative.options);
    options.map(|(name, value)| (name, &value.span)).find(|(name, _)| name.value == option).map(|(_, span)| span)
}
