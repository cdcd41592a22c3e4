//! Checks that rows are compatible: `requires ⊆ provides`, and the conditions on the description hold, for every
//! combination of one alternative per axis. The help is computed: the single changes that make the description legal.

use fragbuf_templates::Registry;
use fragbuf_templates::vocabulary::{Capability, Condition, DescriptionValues, Formula, Row};

use super::causes::{Cause, Items, SUGGESTED_K};
use crate::user_row::value_source;
use crate::variant::{AxisChoice, with_extra_words};
use crate::{Diagnostic, Diagnostics, Draft, SourceSpan, codes};

/// Checks every combination; `given` does not include the extra words of rows.
pub(super) fn check(
    draft: &Draft,
    choices: &[AxisChoice],
    given: DescriptionValues,
    registry: &Registry,
    diagnostics: &mut Diagnostics,
) {
    let context = Context { draft, choices, given, registry };
    for combination in combinations(choices) {
        let violations = Rules::new(&combination, given).violations();
        let found = violations.iter().map(|violation| context.diagnostic(violation, &combination));
        match violations.as_slice() {
            // One other choice resolves all of them: they have one cause.
            [first, _, ..] if context.fixes(first.index(), &combination).is_some() => {
                diagnostics.push(context.merged(found.collect(), &violations, &combination));
            }
            _ => found.for_each(|diagnostic| diagnostics.push(diagnostic)),
        }
    }
}

/// A rule that a row of a combination breaks; the number is the index of the row.
pub(super) enum Violation<'r> {
    /// The row does not keep what the description keeps.
    Keep(usize),
    /// No row provides a capability.
    Missing(usize, Capability),
    /// The description does not meet a condition.
    Unmet(usize, &'r Condition),
}

impl Violation<'_> {
    pub(super) fn index(&self) -> usize {
        match self {
            Violation::Keep(index) | Violation::Missing(index, _) | Violation::Unmet(index, _) => *index,
        }
    }
}

/// One row per axis, in the order of the choices.
pub(super) type Combination<'a> = Vec<&'a Row>;

/// Returns every combination of one alternative per axis.
fn combinations(choices: &[AxisChoice]) -> Vec<Combination<'_>> {
    let mut combinations: Vec<Combination<'_>> = vec![Vec::new()];
    for chosen in choices {
        combinations = combinations
            .iter()
            .flat_map(|combination| {
                chosen.alternatives.iter().map(|selected| [combination.as_slice(), &[&*selected.row]].concat())
            })
            .collect();
    }
    combinations
}

/// The rules, applied to one combination.
pub(super) struct Rules<'p> {
    combination: &'p [&'p Row],
    given: DescriptionValues,
}

impl<'p> Rules<'p> {
    pub(super) fn new(combination: &'p [&'p Row], given: DescriptionValues) -> Self {
        Rules { combination, given: with_extra_words(given, combination.iter().copied()) }
    }

    /// Returns the capabilities that `row` requires and no row of the combination provides.
    fn missing(&self, row: &Row) -> impl Iterator<Item = Capability> {
        let is_provided =
            |capability: &Capability| self.combination.iter().any(|other| other.provides_to(&self.given, *capability));
        row.requires.iter().copied().filter(move |capability| !is_provided(capability))
    }

    /// Returns the conditions of `row` that the description does not meet.
    fn unmet<'r>(&self, row: &'r Row) -> impl Iterator<Item = &'r Condition> {
        row.conditions.iter().filter(|condition| !self.given.meets(&condition.formula))
    }

    /// Whether `row` can keep the fragments that the description keeps. A storage that keeps the k best requires k. A
    /// storage that keeps all fragments requires `keep all`, unless another row selects the k best afterwards. A row with
    /// a buffer whose size depends on k requires k, too.
    fn matches_keep(&self, row: &Row) -> bool {
        let is_limited = self.given.keep.is_some();
        let keeps = |capability: Capability| row.provides.contains(&capability);
        match (keeps(Capability::KeepsBest), keeps(Capability::KeepsAll)) {
            (true, false) => is_limited,
            (false, true) => {
                !is_limited || self.combination.iter().any(|other| other.provides.contains(&Capability::SelectsBest))
            }
            _ => is_limited || !has_size_in_k(row),
        }
    }

    /// Returns every rule that is broken, in the order of the rows.
    pub(super) fn violations(&self) -> Vec<Violation<'p>> {
        let mut violations = Vec::new();
        for (index, row) in self.combination.iter().enumerate() {
            violations.extend((!self.matches_keep(row)).then_some(Violation::Keep(index)));
            violations.extend(self.missing(row).map(|capability| Violation::Missing(index, capability)));
            violations.extend(self.unmet(row).map(|condition| Violation::Unmet(index, condition)));
        }
        violations
    }

    fn is_satisfied(&self, row: &Row) -> bool {
        self.missing(row).next().is_none() && self.unmet(row).next().is_none()
    }

    fn is_legal(&self) -> bool {
        self.combination.iter().all(|row| self.matches_keep(row) && self.is_satisfied(row))
    }
}

fn has_size_in_k(row: &Row) -> bool {
    row.resources.iter().any(|resource| resource.mentions("k"))
}

/// An effect that every payload has.
const CLOSURE: &str = "resolve |fragments| { vec4(fragments[0].depth, 0.0, 0.0, 1.0) }";

/// The context of the diagnostics.
pub(super) struct Context<'a> {
    pub(super) draft: &'a Draft,
    pub(super) choices: &'a [AxisChoice],
    pub(super) given: DescriptionValues,
    pub(super) registry: &'a Registry,
}

impl Context<'_> {
    pub(super) fn diagnostic(&self, violation: &Violation<'_>, combination: &Combination<'_>) -> Diagnostic {
        match violation {
            Violation::Keep(index) => self.keep_mismatch(*index, combination),
            Violation::Missing(index, capability) => self.missing(*index, *capability, combination),
            Violation::Unmet(index, condition) => self.unmet(*index, condition, combination),
        }
    }

    fn keep_mismatch(&self, index: usize, combination: &Combination<'_>) -> Diagnostic {
        let chosen = &self.choices[index];
        let keep = self.keep_line().unwrap_or(&chosen.span);
        let with = |keep| Rules::new(combination, DescriptionValues { keep, ..self.given });
        let is_legal = |k: &u32| combination.iter().all(|row| with(Some(*k)).is_satisfied(row));
        let (kept, fix, other) = match self.given.keep {
            Some(_) => ("the k best fragments", "keep all".to_owned(), None),
            None => {
                let k = SUGGESTED_K.into_iter().find(is_legal).unwrap_or(SUGGESTED_K[0]);
                ("every fragment", format!("keep {k}"), Some(k))
            }
        };
        // If the other `keep` line causes further errors, the help includes the changes that avoid them.
        let rules = with(other);
        let unsatisfied = combination.iter().find(|row| !rules.is_satisfied(row));
        let also = unsatisfied.map_or(String::new(), |row| {
            match self.changes(combination, DescriptionValues { keep: other, ..self.given }) {
                Some(changes) => changes.iter().map(|change| format!(" and {change}")).collect(),
                None => format!(" and another choice than {}", name(row)),
            }
        });
        let storage = name(combination[index]);
        let others = self.fixes(index, combination).map_or(String::new(), |fixes| format!(", or choose {fixes}"));
        Diagnostic::new(
            codes::KEEP_MISMATCH,
            keep,
            format!("the description keeps {kept}, but {storage} does not"),
            format!("write `{fix};`{also}{others}"),
        )
        .label(&chosen.span, format!("{storage} is chosen here"))
    }

    fn keep_line(&self) -> Option<&SourceSpan> {
        self.draft.keep.as_ref().map(|keep| &keep.count.span)
    }

    /// Reports a capability that `combination[index]` requires and no row provides.
    fn missing(&self, index: usize, capability: Capability, combination: &Combination<'_>) -> Diagnostic {
        if let Some(diagnostic) = self.uninterruptible(index, capability, combination) {
            return diagnostic;
        }
        let chosen = &self.choices[index];
        // Rows that would provide it if the description met a condition, and other choices on axes with rows that provide it.
        let implied = combination.iter().flat_map(|row| row.implies.iter().map(move |implied| (row, implied)));
        let cause = implied
            .filter(|(_, (_, implied))| *implied == capability)
            .find_map(|(row, (when, _))| Some((row, when, self.cause(when, combination)?)));
        let change = cause.as_ref().and_then(|(_, _, cause)| cause.help.as_ref());
        let help = match (change, self.fixes(index, combination)) {
            (Some(change), Some(fixes)) => format!("{change}, or choose {fixes}"),
            (Some(change), None) => change.clone(),
            (None, Some(fixes)) => format!("choose {fixes}"),
            (None, None) => self.more_changes(index, capability, combination),
        };
        let message =
            format!("{} requires {}, but no choice provides it", name(combination[index]), capability.meaning());
        let could = |axis: &str| self.registry.rows_of(axis).any(|row| row.provides.contains(&capability));
        let others: Vec<(&AxisChoice, &&Row)> = self
            .choices
            .iter()
            .zip(combination)
            .filter(|(other, _)| could(&other.axis) && other.span != chosen.span)
            .collect();
        let others_given = || others.iter().map(|(other, _)| &other.span).find(|span| self.is_given(span));
        let is_given = self.is_given(&chosen.span);
        let span = match &cause {
            Some((_, _, cause)) if !is_given => &cause.span,
            None if !is_given => others_given().unwrap_or(&chosen.span),
            _ => &chosen.span,
        };
        let mut diagnostic = Diagnostic::new(codes::MISSING_CAPABILITY, span, message, help);
        if span != &chosen.span {
            diagnostic = diagnostic.label(&chosen.span, format!("{} is chosen here", name(combination[index])));
        }
        if let Some((row, when, cause)) = &cause {
            let text = format!("{} provides it only if {}", name(row), when.in_words());
            diagnostic = diagnostic.label(&cause.span, text);
        }
        for (other, row) in others {
            diagnostic = diagnostic.label(&other.span, format!("{} does not provide it", name(row)));
        }
        diagnostic
    }

    /// Reports a closure that needs all fragments at once, where `combination[index]` passes them on in parts.
    fn uninterruptible(
        &self,
        index: usize,
        capability: Capability,
        combination: &Combination<'_>,
    ) -> Option<Diagnostic> {
        let obstacle = self.draft.resolve.as_ref()?.resumable.as_ref()?.as_ref().err()?;
        if capability != Capability::Resumes {
            return None;
        }
        let row = name(combination[index]);
        let message = format!(
            "{row} passes the fragments of a pixel on in several parts, but the closure needs all of them at once: {}",
            obstacle.reason
        );
        let help = format!("{}, or keep every fragment in an A-buffer, without peeling", obstacle.help);
        let chosen = &self.choices[index].span;
        let diagnostic = Diagnostic::new(codes::MISSING_CAPABILITY, &obstacle.span, message, help);
        Some(diagnostic.label(chosen, format!("{row} is chosen here")))
    }

    /// Returns whether a span is of an item that the description gives, not of its preset or name.
    pub(super) fn is_given(&self, span: &SourceSpan) -> bool {
        *span != self.draft.name.span && self.draft.preset.as_ref().is_none_or(|preset| preset.span != *span)
    }

    /// Returns the item of the description that does not meet a formula.
    fn cause(&self, formula: &Formula, combination: &Combination<'_>) -> Option<Cause> {
        let items = Items { draft: self.draft, choices: self.choices, given: self.given };
        let cause = items.cause(formula, &|given| Rules::new(combination, given).is_legal());
        let is_payload = ["payload_words", "entry_words", "value_words"].iter().any(|words| formula.mentions(words));
        if cause.as_ref().is_some_and(|cause| cause.help.is_some()) || !is_payload || !self.given.meets(formula) {
            return cause;
        }
        // Without the words that rows add, the payload fits.
        let adding = self.choices.iter().zip(combination).find(|(_, row)| !row.extra_words.is_empty());
        adding.map(|(chosen, _)| Cause { span: chosen.span.clone(), help: None }).or(cause)
    }

    /// Returns the help if no single change makes the combination legal: the rows that provide the capability.
    fn more_changes(&self, index: usize, capability: Capability, combination: &Combination<'_>) -> String {
        let is_chosen = |row: &&Row| self.registry.axis(&row.axis).is_some_and(|axis| axis.chosen);
        let rows = self.registry.rows().iter().filter(is_chosen).filter(|row| row.may_provide(capability));
        let mut rows: Vec<&Row> = rows.collect();
        rows.sort_by_key(|row| (self.extent_of_change(&row.axis), !row.provides.contains(&capability)));
        let rows = rows.into_iter();
        let providers: Vec<String> = rows.map(|row| provider(row, capability)).collect();
        let meaning = capability.meaning();
        match providers.is_empty() {
            true => format!(
                "no choice of any axis provides {meaning}: choose another value than {}",
                name(combination[index])
            ),
            false => format!("more than one change is needed; {meaning} is provided by {}", joined(&providers)),
        }
    }

    /// Returns how much of a description another value on an axis changes: 0 a detail of the implementation, 1 the technique, because the
    /// axis has no default, 2 the effect, and thus the image.
    pub(super) fn extent_of_change(&self, axis: &str) -> u32 {
        let has_default = self.registry.axis(axis).is_some_and(|axis| axis.default.is_some());
        match axis == Registry::CLOSURE_AXIS {
            true => 2,
            false => u32::from(!has_default),
        }
    }

    /// Reports a condition of `combination[index]` that the description does not meet.
    fn unmet(&self, index: usize, condition: &Condition, combination: &Combination<'_>) -> Diagnostic {
        let row = name(combination[index]);
        let chosen = &self.choices[index].span;
        let cause = self.cause(&condition.formula, combination);
        // A change that is printed whole is first. The author of a user file knows more about a condition than its symbols say.
        let is_of_user = combination[index].template.as_ref().is_some_and(|template| template.user_file.is_some());
        let change = cause.as_ref().filter(|_| !is_of_user).and_then(|cause| cause.help.as_ref());
        let help = match (change, self.fixes(index, combination)) {
            (Some(fix), Some(fixes)) => format!("{fix}, or choose {fixes}"),
            (Some(fix), None) => fix.clone(),
            (None, Some(fixes)) if cause.is_some() && !is_of_user => format!("choose {fixes}, or {}", condition.help),
            (None, Some(fixes)) => format!("{}, or choose {fixes}", condition.help),
            (None, None) => condition.help.to_string(),
        };
        let span = cause.as_ref().map_or(chosen, |cause| &cause.span);
        let diagnostic = Diagnostic::new(
            codes::MISSING_CAPABILITY,
            span,
            format!("{row} requires {}, but the description does not have it", condition.meaning),
            help,
        );
        match span == chosen {
            true => diagnostic,
            false => diagnostic.label(chosen, format!("{row} is chosen here")),
        }
    }

    /// Returns the rows that make the combination legal if one of them replaces the row of its axis, those that change the least first.
    /// The error is about the row `at_fault`.
    pub(super) fn fixes(&self, at_fault: usize, combination: &Combination<'_>) -> Option<String> {
        let mut fixes = Vec::new();
        let mut indices: Vec<usize> = (0..self.choices.len()).collect();
        indices.sort_by_key(|index| (self.extent_of_change(&self.choices[*index].axis), *index != at_fault));
        for index in indices {
            let axis = &self.choices[index].axis;
            let has_closure =
                axis == Registry::CLOSURE_AXIS && (self.draft.resolve.is_some() || self.draft.between.is_some());
            for row in self.registry.rows_of(axis) {
                let mut other = combination.clone();
                other[index] = row;
                if !Rules::new(&other, self.given).is_legal() {
                    continue;
                }
                match (Registry::is_of_closures(row), has_closure) {
                    (false, false) => fixes.push(name(row)),
                    (false, true) => fixes.push(format!("{} in place of the closure", name(row))),
                    (true, false) => fixes.push(format!("a closure as the effect, `{CLOSURE}`")),
                    (true, true) => {}
                }
            }
        }
        (!fixes.is_empty()).then(|| joined(&fixes))
    }
}

pub(super) fn name(row: &Row) -> String {
    format!("`{}: {}`", row.axis, value_source(&row.key))
}

/// Returns the name of a row that provides a capability, and the condition under which it does.
fn provider(row: &Row, capability: Capability) -> String {
    let condition = row.implies.iter().find(|(_, implied)| *implied == capability);
    match condition {
        Some((when, _)) if !row.provides.contains(&capability) => format!("{} if `{when}`", name(row)),
        _ => name(row),
    }
}

fn joined(names: &[String]) -> String {
    names.join(" or ")
}
