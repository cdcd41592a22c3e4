//! `requires ⊆ offers`, for every way to pick one alternative per axis. The hint of a refusal is computed: the single
//! changes that make the whole description legal.

use fragbuf_templates::Registry;
use fragbuf_templates::vocabulary::{Fact, Row};

use crate::variant::Chosen;
use crate::{Diagnostic, Diagnostics, Draft, codes, written};

/// Checks every combination; `given` is what the payload and the `keep` line offer.
pub(super) fn check(
    draft: &Draft,
    choices: &[Chosen],
    given: &[Fact],
    registry: &Registry,
    diagnostics: &mut Diagnostics,
) {
    for pick in picks(choices) {
        let situation = Situation { draft, choices, given, registry };
        for (index, row) in pick.iter().enumerate() {
            if !keeps_what_is_said(row, &pick, given) {
                diagnostics.push(situation.keep_mismatch(index, &pick));
            }
            for fact in missing(row, &pick, given) {
                diagnostics.push(situation.unmet(index, fact, &pick));
            }
        }
    }
}

/// One row per axis, in the order of the choices.
type Pick<'a> = Vec<&'a Row>;

/// Every way to pick one alternative per axis.
fn picks(choices: &[Chosen]) -> Vec<Pick<'_>> {
    let mut picks: Vec<Pick<'_>> = vec![Vec::new()];
    for chosen in choices {
        picks = picks
            .iter()
            .flat_map(|pick| chosen.alternatives.iter().map(|selected| [pick.as_slice(), &[&*selected.row]].concat()))
            .collect();
    }
    picks
}

/// What `row` requires and neither the others of the pick nor the description offer. Targets are asked later.
fn missing(row: &Row, pick: &Pick<'_>, given: &[Fact]) -> Vec<Fact> {
    let offered = |fact: &Fact| given.contains(fact) || pick.iter().any(|other| offers(other, *fact, given));
    row.requires.iter().copied().filter(|fact| !offered(fact)).collect()
}

fn offers(row: &Row, fact: Fact, given: &[Fact]) -> bool {
    row.offers.contains(&fact) || row.implies.iter().any(|(if_given, then)| *then == fact && given.contains(if_given))
}

/// A storage that keeps the k best needs a k; one that keeps all must have none, unless the k best are chosen
/// afterwards. One whose memory is measured in k needs a k too.
fn keeps_what_is_said(row: &Row, pick: &Pick<'_>, given: &[Fact]) -> bool {
    let keeps = |fact: Fact| row.offers.contains(&fact);
    match (keeps(Fact::KeepsBest), keeps(Fact::KeepsAll)) {
        (true, false) => given.contains(&Fact::KeepsBest),
        (false, true) => {
            given.contains(&Fact::KeepsAll) || pick.iter().any(|other| other.offers.contains(&Fact::SelectsBest))
        }
        _ => !given.contains(&Fact::KeepsAll) || !is_measured_in_k(row),
    }
}

fn is_measured_in_k(row: &Row) -> bool {
    row.resources.iter().flat_map(|resource| &resource.extents).any(|extent| extent.length.mentions("k"))
}

fn is_legal(pick: &Pick<'_>, given: &[Fact]) -> bool {
    pick.iter().all(|row| keeps_what_is_said(row, pick, given) && missing(row, pick, given).is_empty())
}

struct Situation<'a> {
    draft: &'a Draft,
    choices: &'a [Chosen],
    given: &'a [Fact],
    registry: &'a Registry,
}

impl Situation<'_> {
    fn keep_mismatch(&self, index: usize, pick: &Pick<'_>) -> Diagnostic {
        let chosen = &self.choices[index];
        let keep = self.draft.keep.as_ref().map_or(&chosen.origin, |keep| &keep.count.origin);
        let (words, way, said, other) = if self.given.contains(&Fact::KeepsBest) {
            ("the k best", "keep all", Fact::KeepsBest, Fact::KeepsAll)
        } else {
            ("every fragment", "keep 8", Fact::KeepsAll, Fact::KeepsBest)
        };
        // What the other `keep` line would run into next is part of the way out.
        let given: Vec<Fact> = self.given.iter().map(|fact| if *fact == said { other } else { *fact }).collect();
        let also = pick.iter().find(|row| !missing(row, pick, &given).is_empty());
        let also = also.map_or(String::new(), |row| format!(" and another choice than {}", name(row)));
        let storage = name(pick[index]);
        let others = self.ways_out(pick).map_or(String::new(), |ways| format!(", or choose {ways}"));
        Diagnostic::new(
            codes::KEEP_MISMATCH,
            keep,
            format!("the description keeps {words}, {storage} does not"),
            format!("write `{way};`{also}{others}"),
        )
        .label(&chosen.origin, format!("{storage} is chosen here"))
    }

    fn unmet(&self, index: usize, fact: Fact, pick: &Pick<'_>) -> Diagnostic {
        let chosen = &self.choices[index];
        let row = pick[index];
        let mut diagnostic = Diagnostic::new(
            codes::UNMET,
            &chosen.origin,
            format!("`{}: {}` requires {}, and nothing here offers it", row.axis, written(&row.key), fact.meaning()),
            self.hint(fact, pick),
        );
        for (other, row) in self.choices.iter().zip(pick) {
            let could = self.registry.rows_of(&other.axis).any(|row| row.offers.contains(&fact));
            if could && other.origin != chosen.origin {
                diagnostic = diagnostic.label(&other.origin, format!("{} does not offer it", name(row)));
            }
        }
        diagnostic
    }

    fn hint(&self, fact: Fact, pick: &Pick<'_>) -> String {
        if fact == Fact::Color {
            return "add `color: rgba8` to the fragment, or write `resolve |fragments, u| { … }`".to_owned();
        }
        let ways = self.ways_out(pick);
        let or_else = ways.as_ref().map_or(String::new(), |ways| format!(", or choose {ways}"));
        match fact {
            Fact::LimitedToOne => return format!("write `keep 1;`{or_else}"),
            Fact::SampleCount => return format!("write `keep 4;`{or_else}"),
            _ => {}
        }
        if let Some(ways) = ways {
            return format!("choose {ways}");
        }
        let offering: Vec<String> = self.registry.offering(fact).map(name).collect();
        format!("more than one change is needed; {} is offered by {}", fact.meaning(), joined(&offering))
    }

    /// The changes of one axis that make everything legal.
    fn ways_out(&self, pick: &Pick<'_>) -> Option<String> {
        let mut ways = Vec::new();
        for (index, chosen) in self.choices.iter().enumerate() {
            for row in self.registry.rows_of(&chosen.axis).filter(|row| row.key != Registry::CLOSURE) {
                let mut other = pick.clone();
                other[index] = row;
                if is_legal(&other, self.given) {
                    ways.push(name(row));
                }
            }
        }
        (!ways.is_empty()).then(|| joined(&ways))
    }
}

fn name(row: &Row) -> String {
    format!("`{}: {}`", row.axis, written(&row.key))
}

fn joined(words: &[String]) -> String {
    words.join(" or ")
}
