//! Which rows go together: `requires ⊆ offers`, and conditions on the description that hold, for every way to pick one
//! alternative per axis. The hint of a refusal is computed: the single changes that make the whole description legal.

use fragbuf_templates::Registry;
use fragbuf_templates::vocabulary::{Condition, Fact, Given, Row};

use crate::variant::{Chosen, with_carried};
use crate::{Diagnostic, Diagnostics, Draft, Origin, codes, written};

/// Checks every combination; `given` is what the description gives, without the words that rows carry.
pub(super) fn check(
    draft: &Draft,
    choices: &[Chosen],
    given: Given,
    registry: &Registry,
    diagnostics: &mut Diagnostics,
) {
    let situation = Situation { draft, choices, given, registry };
    for pick in picks(choices) {
        let rules = Rules::new(&pick, given);
        for (index, row) in pick.iter().enumerate() {
            if !rules.keeps_what_is_said(row) {
                diagnostics.push(situation.keep_mismatch(index, &pick));
            }
            for fact in rules.missing(row) {
                diagnostics.push(situation.missing(index, fact, &pick));
            }
            for condition in rules.unmet(row) {
                diagnostics.push(situation.unmet(index, condition, &pick));
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

/// The rules over one pick.
struct Rules<'p> {
    pick: &'p [&'p Row],
    given: Given,
}

impl<'p> Rules<'p> {
    fn new(pick: &'p [&'p Row], given: Given) -> Self {
        Rules { pick, given: with_carried(given, pick.iter().copied()) }
    }

    /// Facts that `row` requires and no row of the pick offers.
    fn missing(&self, row: &Row) -> impl Iterator<Item = Fact> {
        let is_offered = |fact: &Fact| self.pick.iter().any(|other| other.offers_to(&self.given, *fact));
        row.requires.iter().copied().filter(move |fact| !is_offered(fact))
    }

    /// Conditions of `row` that the description does not meet.
    fn unmet<'r>(&self, row: &'r Row) -> impl Iterator<Item = &'r Condition> {
        row.conditions.iter().filter(|condition| !self.given.meets(&condition.formula))
    }

    /// A storage that keeps the k best needs a k; one that keeps all must have none, unless the k best are chosen
    /// afterwards. One whose memory is measured in k needs a k too.
    fn keeps_what_is_said(&self, row: &Row) -> bool {
        let is_limited = self.given.keep.is_some();
        let keeps = |fact: Fact| row.offers.contains(&fact);
        match (keeps(Fact::KeepsBest), keeps(Fact::KeepsAll)) {
            (true, false) => is_limited,
            (false, true) => !is_limited || self.pick.iter().any(|other| other.offers.contains(&Fact::SelectsBest)),
            _ => is_limited || !is_measured_in_k(row),
        }
    }

    fn is_fit(&self, row: &Row) -> bool {
        self.missing(row).next().is_none() && self.unmet(row).next().is_none()
    }

    fn is_legal(&self) -> bool {
        self.pick.iter().all(|row| self.keeps_what_is_said(row) && self.is_fit(row))
    }
}

fn is_measured_in_k(row: &Row) -> bool {
    row.resources.iter().any(|resource| resource.mentions("k"))
}

/// Limits that a hint may name, the one that suits most first.
const LIMITS: [u32; 4] = [8, 4, 2, 1];

struct Situation<'a> {
    draft: &'a Draft,
    choices: &'a [Chosen],
    given: Given,
    registry: &'a Registry,
}

impl Situation<'_> {
    fn keep_mismatch(&self, index: usize, pick: &Pick<'_>) -> Diagnostic {
        let chosen = &self.choices[index];
        let keep = self.keep_line().unwrap_or(&chosen.origin);
        let with = |keep| Rules::new(pick, Given { keep, ..self.given });
        let suits = |limit: &u32| pick.iter().all(|row| with(Some(*limit)).is_fit(row));
        let (words, way, other) = match self.given.keep {
            Some(_) => ("the k best", "keep all".to_owned(), None),
            None => {
                let limit = LIMITS.into_iter().find(suits).unwrap_or(LIMITS[0]);
                ("every fragment", format!("keep {limit}"), Some(limit))
            }
        };
        // What the other `keep` line would run into next is part of the way out.
        let rules = with(other);
        let also = pick.iter().find(|row| !rules.is_fit(row));
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

    fn keep_line(&self) -> Option<&Origin> {
        self.draft.keep.as_ref().map(|keep| &keep.count.origin)
    }

    /// A fact that `pick[index]` requires, and that no row offers.
    fn missing(&self, index: usize, fact: Fact, pick: &Pick<'_>) -> Diagnostic {
        let chosen = &self.choices[index];
        let hint = match self.ways_out(pick) {
            Some(ways) => format!("choose {ways}"),
            None => {
                let offering: Vec<String> = self.registry.offering(fact).map(name).collect();
                format!("more than one change is needed; {} is offered by {}", fact.meaning(), joined(&offering))
            }
        };
        let message = format!("{} requires {}, and nothing here offers it", name(pick[index]), fact.meaning());
        let mut diagnostic = Diagnostic::new(codes::UNMET, &chosen.origin, message, hint);
        for (other, row) in self.choices.iter().zip(pick) {
            let could = self.registry.rows_of(&other.axis).any(|row| row.offers.contains(&fact));
            if could && other.origin != chosen.origin {
                diagnostic = diagnostic.label(&other.origin, format!("{} does not offer it", name(row)));
            }
        }
        diagnostic
    }

    /// A condition of `pick[index]` that the description does not meet.
    fn unmet(&self, index: usize, condition: &Condition, pick: &Pick<'_>) -> Diagnostic {
        let row = name(pick[index]);
        let or_else = self.ways_out(pick).map_or(String::new(), |ways| format!(", or choose {ways}"));
        Diagnostic::new(
            codes::UNMET,
            &self.choices[index].origin,
            format!("{row} requires {}, and the description does not give it", condition.meaning),
            format!("{}{or_else}", condition.hint),
        )
    }

    /// The changes of one axis that make everything legal.
    fn ways_out(&self, pick: &Pick<'_>) -> Option<String> {
        let mut ways = Vec::new();
        for (index, chosen) in self.choices.iter().enumerate() {
            for row in self.registry.rows_of(&chosen.axis).filter(|row| row.key != Registry::CLOSURE) {
                let mut other = pick.clone();
                other[index] = row;
                if Rules::new(&other, self.given).is_legal() {
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
