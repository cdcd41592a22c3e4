//! The warnings about a draft, in the order of the source: names that nothing uses, and suspicious calls. Those of user files are last.

use super::unused;
use crate::variant::AxisChoice;
use crate::{Diagnostic, Diagnostics, Draft, codes};

/// Returns the warnings.
pub(super) fn warnings(draft: &Draft, choices: &[AxisChoice]) -> Diagnostics {
    let suspicious = draft.suspicious.iter().map(|call| {
        let (message, help) = (call.value.message.as_str(), call.value.help.as_str());
        Diagnostic::new(codes::SWAPPED_ARGUMENTS, &call.span, message, help)
    });
    let mut all: Vec<Diagnostic> = unused::warnings(draft, choices).iter().cloned().chain(suspicious).collect();
    all.sort_by_key(|warning| (warning.span.line, warning.span.column));
    let mut warnings: Diagnostics = all.into_iter().collect();
    warnings.extend(draft.file_warnings.clone());
    warnings
}
