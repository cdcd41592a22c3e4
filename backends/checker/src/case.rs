//! The cases of a check: what a pixel holds before, and which fragments then come at once.
//!
//! In: how many fragments, entries and passes there are. Out: every legal prior state (empty, one short of full, full, both
//! orders of arrival) with fragments between, before, behind and equal to what is there; too little room; a pass that did
//! not see a fragment. Which of the new fragments comes first is the search's affair.

use fragbuf_templates::vocabulary::{Fact, Kind, Step};

use crate::fragments::{Candidates, Fragment};
use crate::frame::{Symbols, WIDTH};
use crate::subject::Subject;

/// One case.
#[derive(Clone, Debug)]
pub(crate) struct Case {
    pub(crate) symbols: Symbols,
    /// In the order of arrival.
    pub(crate) prior: Vec<Fragment>,
    pub(crate) new: Vec<Fragment>,
    /// The pass whose fragments come at once, by its number among those that compute or draw.
    pub(crate) pass: usize,
    /// Whether earlier geometry passes did not see the last new fragment.
    pub(crate) has_unseen: bool,
    /// Fragments that a pool has no room for.
    pub(crate) too_many: u32,
    /// The room that was reserved in place of what the host would allocate: too little, and the neighbour's is gone too.
    pub(crate) reserved: Option<u32>,
    /// Whether the last new fragment is a helper invocation.
    pub(crate) has_helper: bool,
    /// In words.
    pub(crate) what: String,
}

/// How the keys of new fragments lie to those that are there.
const PATTERNS: [(&str, [Pick; 4]); 5] = [
    ("keys between those kept", [Pick::Rank(4), Pick::Rank(2), Pick::Rank(6), Pick::Rank(1)]),
    ("keys better than all kept", [Pick::Rank(0), Pick::Rank(1), Pick::Rank(2), Pick::Rank(0)]),
    ("keys worse than all kept", [Pick::Rank(20), Pick::Rank(21), Pick::Rank(22), Pick::Rank(23)]),
    ("one key, two payloads", [Pick::Rank(5), Pick::Twin(5), Pick::Rank(5), Pick::Twin(5)]),
    ("all alike", [Pick::Rank(5), Pick::Rank(5), Pick::Rank(5), Pick::Rank(5)]),
];

#[derive(Clone, Copy)]
enum Pick {
    Rank(usize),
    Twin(usize),
}

/// What a pixel may hold before.
const PRIOR: [usize; 8] = [3, 5, 7, 9, 13, 15, 17, 19];

/// Every case for `count` new fragments and `k` entries; `k` is `None` where all are kept.
pub(crate) fn cases(subject: &Subject, candidates: &Candidates, count: u32, k: Option<u32>) -> Vec<Case> {
    let mut cases = Vec::new();
    for (prior, arrival) in priors(k) {
        for (pattern, picks) in &PATTERNS {
            let alone = prior.is_empty();
            if alone && (pattern.contains("better") || pattern.contains("worse")) {
                continue;
            }
            let picked = picks.iter().cycle().take(count as usize).map(|pick| match pick {
                Pick::Rank(rank) => candidates.ranked[*rank].clone(),
                Pick::Twin(rank) => candidates.twins[*rank].clone(),
            });
            let new: Vec<Fragment> = picked.collect();
            let prior: Vec<Fragment> = prior.iter().map(|rank| candidates.ranked[*rank].clone()).collect();
            let what = format!("{arrival}, {count} at once, {pattern}");
            let base = Case {
                symbols: Symbols { k, fragments: None, kept: None },
                prior,
                new,
                pass: 0,
                has_unseen: false,
                too_many: 0,
                reserved: None,
                has_helper: false,
                what,
            };
            placed(subject, &base, &mut cases);
        }
    }
    cases
}

/// What may be there before, by rank in the order of arrival, and what it is called: every order of up to three, five
/// of more.
fn priors(k: Option<u32>) -> Vec<(Vec<usize>, String)> {
    let mut counts: Vec<usize> = match k {
        Some(k) => vec![0, k as usize - 1, k as usize, k as usize + 1],
        None => vec![0, 2],
    };
    counts.dedup();
    let mut priors = Vec::new();
    for count in counts {
        let full = match k.map(|k| count.cmp(&(k as usize))) {
            Some(std::cmp::Ordering::Equal) => ", full",
            Some(std::cmp::Ordering::Greater) => ", one displaced",
            _ => "",
        };
        for order in orders(count.min(PRIOR.len())) {
            let ranks = order.iter().map(|at| PRIOR[*at]).collect();
            let arrival: Vec<String> = order.iter().map(|at| (at + 1).to_string()).collect();
            priors.push((
                ranks,
                match count {
                    0 => "empty before".to_owned(),
                    1 => format!("1 before{full}"),
                    _ => format!("{count} before{full}, best {} in order of arrival", arrival.join(" ")),
                },
            ));
        }
    }
    priors
}

/// The orders of `count` things.
fn orders(count: usize) -> Vec<Vec<usize>> {
    if count > 3 {
        let riffled = |first: usize| (first..count).step_by(2).chain((1 - first..count).step_by(2)).collect();
        // Neither sorted nor nearly so: what a tree of slots makes of it has its second level the wrong way round.
        let crossed = (0..count).map(|at| [0, 3, 2, 1].get(at).copied().unwrap_or(at)).collect();
        return vec![(0..count).collect(), (0..count).rev().collect(), riffled(0), riffled(1), crossed];
    }
    let mut orders = vec![Vec::new()];
    for next in 0..count {
        orders = orders
            .into_iter()
            .flat_map(|order: Vec<usize>| {
                (0..=order.len()).map(move |at| {
                    let mut longer = order.clone();
                    longer.insert(at, next);
                    longer
                })
            })
            .collect();
    }
    orders
}

/// The same case for every pass that draws, with enough room, too little, and a fragment that was not seen before.
fn placed(subject: &Subject, base: &Case, cases: &mut Vec<Case>) {
    let frame = &subject.plan.frame;
    let is_set = subject.plan.steps.iter().any(|step| matches!(step, Step::Host(_)));
    let needs_room = frame.iter().any(|field| field == "fragments" || field == "n") && !is_set;
    let total = (base.prior.len() + base.new.len()) as u32 + WIDTH - 1;
    let mut drawn_before = false;
    for (pass, runnable) in subject.passes.iter().enumerate().filter(|(_, pass)| pass.pass.kind == Kind::Geometry) {
        let name = format!("pass {}, {}", runnable.pass.anchor, base.what);
        let case = Case { pass, what: name, ..base.clone() };
        // A helper invocation takes no room.
        let with_room = |too_many: u32| {
            let symbols = Symbols { fragments: needs_room.then_some(total - too_many), ..base.symbols.clone() };
            Case { symbols, too_many, ..case.clone() }
        };
        cases.push(with_room(0));
        // How many find no room where fragments can be turned away first depends on the order.
        if needs_room && !subject.keeps_best() {
            let short = with_room(1);
            cases.push(Case { what: format!("{}, room for one less", short.what), ..short });
        }
        if drawn_before && is_set && !subject.keeps_best() {
            let what = format!("{}, room reserved for one less", case.what);
            let room = total - WIDTH;
            cases.push(Case { too_many: 1, reserved: Some(room), what, ..with_room(0) });
        }
        if drawn_before && is_set && !subject.keeps_best() {
            let what = format!("{}, one not seen by the pass before", case.what);
            cases.push(Case { has_unseen: true, what, ..with_room(0) });
        }
        if subject.has_fences && base.what.contains("between") {
            let what = format!("{}, the last a helper invocation", case.what);
            cases.push(Case { has_helper: true, what, too_many: 0, ..with_room(u32::from(needs_room)) });
        }
        drawn_before = true;
    }
}

impl Subject {
    /// Whether what the storage holds depends on k; else it holds all.
    pub(crate) fn keeps_best(&self) -> bool {
        !self.keeps_all() || self.is_handed_the_best()
    }

    /// Whether the storage keeps whatever it is handed.
    pub(crate) fn keeps_all(&self) -> bool {
        self.plan.selection.offers().contains(&Fact::KeepsAll)
    }

    /// Whether what must be kept is known: all, or the k best. Of any other storage only that is known which holds for all.
    pub(crate) fn is_known(&self) -> bool {
        let offers = self.plan.selection.offers();
        offers.contains(&Fact::KeepsAll) || offers.contains(&Fact::KeepsBest)
    }
}
