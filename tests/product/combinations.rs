//! The combinations of rows that `product` checks.
//!
//! Input: a registry. Output: one combination per class of equivalent rows of each axis, for some with random rows of the classes. The rules
//! are applied elsewhere.

use std::sync::LazyLock;

use fragbuf::Registry;
use fragbuf::vocabulary::{Capability, Row};

use crate::cases::Random;

/// Capabilities that inform callers. No row requires them.
pub const INFORMATIVE: [Capability; 1] = [Capability::CountsEvents];

/// Returns the rows of an axis in equivalence classes of equal capabilities and conditions: the rules depend on nothing else.
fn classes<'r>(registry: &'r Registry, axis: &'r str) -> Vec<Vec<&'r Row>> {
    let capabilities = |row: &Row| {
        let conditions = row.conditions.iter().map(|condition| condition.formula.clone()).collect::<Vec<_>>();
        let requires = (row.requires.clone(), row.needs.clone(), row.needs_if.clone(), row.least.clone());
        let provides: Vec<Capability> =
            row.provides.iter().copied().filter(|capability| !INFORMATIVE.contains(capability)).collect();
        (provides, row.implies.clone(), requires, conditions, row.extra_words.len())
    };
    let mut classes: Vec<Vec<&Row>> = Vec::new();
    for row in registry.rows_of(axis).filter(|row| !Registry::is_of_closures(row)) {
        match classes.iter_mut().find(|class| capabilities(class[0]) == capabilities(row)) {
            Some(class) => class.push(row),
            None => classes.push(vec![row]),
        }
    }
    classes
}

/// A class per axis.
pub struct Combination {
    /// The first row of each class.
    pub choices: Vec<(String, String)>,
    /// For some combinations, a random row of each class, so that every two compatible rows are combined.
    pub random_choices: Option<Vec<(String, String)>>,
    /// The number of combinations of the same classes, on which the rules decide equally.
    pub equivalent: usize,
    pub outlook: Outlook,
}

/// Whether a combination can be legal, before the rules are applied.
#[derive(Clone, Copy, PartialEq)]
pub enum Outlook {
    Open,
    /// A row requires a capability that no row of a later axis provides.
    Illegal,
}

/// One combination in this many is also checked with random rows.
const RANDOM_ONE_IN: usize = 12;

/// Returns the choices of one class per axis. A prefix that no later choice can make legal is completed once.
pub fn combinations(registry: &Registry) -> Vec<Combination> {
    let axes = registry.axes().iter().filter(|axis| axis.chosen && axis.key != Registry::CLOSURE_AXIS);
    let axes: Vec<(&str, Vec<Vec<&Row>>)> = axes.map(|axis| (axis.key, classes(registry, axis.key))).collect();
    let mut found = Vec::new();
    complete(&axes, &mut Vec::new(), &mut Random(5), &mut found);
    found
}

type Classes<'r> = (&'r str, Vec<Vec<&'r Row>>);

fn complete<'a>(
    axes: &'a [Classes<'a>],
    begin: &mut Vec<&'a Vec<&'a Row>>,
    random: &mut Random,
    found: &mut Vec<Combination>,
) {
    let later = &axes[begin.len()..];
    let outlook = outlook(begin, later);
    if outlook == Outlook::Open && !later.is_empty() {
        for class in &later[0].1 {
            begin.push(class);
            complete(axes, begin, random, found);
            begin.pop();
        }
        return;
    }
    let all: Vec<&Vec<&Row>> = begin.iter().copied().chain(later.iter().map(|(_, classes)| &classes[0])).collect();
    let named = |rows: Vec<&Row>| -> Vec<(String, String)> {
        axes.iter().zip(rows).map(|((axis, _), row)| ((*axis).to_owned(), row.key.clone())).collect()
    };
    let is_random = outlook == Outlook::Open && random.below(RANDOM_ONE_IN) == 0;
    let rows_of = |(_, classes): &Classes<'_>| classes.iter().map(Vec::len).sum::<usize>();
    found.push(Combination {
        choices: named(all.iter().map(|class| class[0]).collect()),
        random_choices: is_random.then(|| named(all.iter().map(|class| *random.pick(class)).collect())),
        equivalent: begin.iter().map(|class| class.len()).chain(later.iter().map(rows_of)).product(),
        outlook,
    });
}

/// Tests whether the rows chosen so far can become legal.
fn outlook(begin: &[&Vec<&Row>], later: &[Classes<'_>]) -> Outlook {
    let rows = || begin.iter().map(|class| class[0]);
    let may_be = |capability: Capability| {
        // The effect is none of the axes here: a description without a closure has the default.
        static EFFECTS: LazyLock<Vec<Capability>> = LazyLock::new(|| {
            Registry::builtin().rows_of(Registry::CLOSURE_AXIS).flat_map(|row| row.provides.clone()).collect()
        });
        if EFFECTS.contains(&capability) {
            return true;
        }
        let later = || later.iter().flat_map(|(_, classes)| classes.iter().map(|class| class[0]));
        rows().chain(later()).any(|row| row.may_provide(capability))
    };
    let all = rows().all(|row| row.requires.iter().all(|capability| may_be(*capability)));
    if all { Outlook::Open } else { Outlook::Illegal }
}
