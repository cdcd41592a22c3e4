//! Several broken rules with one cause, as one error.
//!
//! Input: the diagnostics of a combination of rows that one other choice makes legal. Output: the first of them, with the others as labels,
//! and help that is sufficient for all.

use fragbuf_templates::Registry;
use fragbuf_templates::vocabulary::DescriptionValues;

use super::capabilities::{Combination, Context, Rules, Violation, name};
use crate::{Diagnostic, SourceSpan};

/// The greatest number of changes that a help suggests together.
const MOST_CHANGES: usize = 4;

impl Context<'_> {
    /// Returns the first diagnostic, with the rules that the others report as labels.
    pub(super) fn merged(
        &self,
        found: Vec<Diagnostic>,
        violations: &[Violation<'_>],
        combination: &Combination<'_>,
    ) -> Diagnostic {
        let mut found = found.into_iter();
        let Some(mut first) = found.next() else { return self.diagnostic(&violations[0], combination) };
        // A row that the first diagnostic is about already has its label.
        let labelled: Vec<SourceSpan> =
            first.labels.iter().map(|label| &label.span).chain([&first.span]).cloned().collect();
        for (other, violation) in found.zip(violations.iter().skip(1)) {
            let span = &self.choices[violation.index()].span;
            if labelled.contains(span) {
                continue;
            }
            // What the row lacks, without the help that is said once.
            let text = other.message.replace(", but no choice provides it", "");
            first = first.label(span, text.replace(", but the description does not have it", ""));
        }
        let single = self.fixes(violations[0].index(), combination).map(|fixes| format!("choose {fixes}"));
        let several = self.changes(combination, self.given).filter(|changes| changes.len() > 1);
        let several = several.map(|changes| format!("choose {}", changes.join(" and ")));
        // The help about `keep` has the changes that it needs.
        let of_keep = matches!(violations[0], Violation::Keep(_)).then(|| first.help.clone());
        let ways: Vec<String> = of_keep.or(single).into_iter().chain(several).collect();
        first.help = ways.join(", or ");
        first
    }

    /// Returns other values on axes that the description does not choose on, which together make a combination legal. `None`: none of
    /// at most [`MOST_CHANGES`] were found, one after the other.
    pub(super) fn changes(&self, combination: &Combination<'_>, given: DescriptionValues) -> Option<Vec<String>> {
        let count = |rows: &Combination<'_>| Rules::new(rows, given).violations().len();
        let mut indices: Vec<usize> =
            (0..self.choices.len()).filter(|index| !self.is_given(&self.choices[*index].span)).collect();
        indices.sort_by_key(|index| self.extent_of_change(&self.choices[*index].axis));
        let (mut rows, mut changed): (Combination<'_>, Vec<usize>) = (combination.clone(), Vec::new());
        let mut left = count(&rows);
        while left > 0 && changed.len() < MOST_CHANGES {
            let others = indices.iter().filter(|index| !changed.contains(index)).flat_map(|index| {
                let others = self.registry.rows_of(&self.choices[*index].axis);
                others.filter(|row| !Registry::is_of_closures(row)).map(move |row| (*index, row))
            });
            let tried = others.map(|(index, row)| {
                let mut other = rows.clone();
                other[index] = row;
                (count(&other), index, other)
            });
            let (fewer, index, other) = tried.min_by_key(|(count, ..)| *count).filter(|(count, ..)| *count < left)?;
            (left, rows) = (fewer, other);
            changed.push(index);
        }
        let names: Vec<String> = changed.iter().map(|index| name(rows[*index])).collect();
        (left == 0 && !names.is_empty()).then_some(names)
    }
}
