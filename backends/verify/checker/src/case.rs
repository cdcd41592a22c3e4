//! The cases of a check: what a pixel holds before, and which fragments then come at once.
//!
//! In: how many fragments, entries and passes there are. Out: every legal prior state (empty, one short of full, full, both
//! orders of arrival) with fragments between, before, behind and equal to what is there; too little room; a pass that did
//! not see a fragment. Which of the new fragments comes first is the search's affair.

use fragbuf_templates::vocabulary::Kind;

use crate::fragments::{Candidates, Fragment};
use crate::room::{Asking, Room, rooms};
use crate::subject::Subject;

/// One case.
#[derive(Clone, Debug)]
pub(crate) struct Case {
    pub(crate) k: Option<u32>,
    /// In the order of arrival.
    pub(crate) prior: Vec<Fragment>,
    pub(crate) new: Vec<Fragment>,
    /// The pass whose fragments come at once, by its number among those that compute or draw.
    pub(crate) pass: usize,
    pub(crate) room: Room,
    /// The pixel under test, of two.
    pub(crate) pixel: u32,
    /// Whether the last new fragment is a helper invocation.
    pub(crate) has_helper: bool,
    /// In words.
    pub(crate) what: String,
}

/// The fragments of a case, before it is said which pass they come to and what room there is.
struct Comers {
    k: Option<u32>,
    prior: Vec<Fragment>,
    new: Vec<Fragment>,
    what: String,
    may_give_up: bool,
}

/// How the keys of new fragments lie to those that are there.
const PATTERNS: [(&str, [Pick; 4]); 6] = [
    ("keys between those kept", [Pick::Rank(4), Pick::Rank(2), Pick::Rank(6), Pick::Rank(1)]),
    ("keys better than all kept", [Pick::Rank(0), Pick::Rank(1), Pick::Rank(2), Pick::Rank(0)]),
    ("keys worse than all kept", [Pick::Rank(20), Pick::Rank(21), Pick::Rank(22), Pick::Rank(23)]),
    ("one key, two payloads", [Pick::Rank(5), Pick::Twin(5), Pick::Rank(5), Pick::Twin(5)]),
    (TWO_ALIKE, [Pick::Rank(4), Pick::Rank(4), Pick::Rank(6), Pick::Rank(2)]),
    ("all alike", [Pick::Rank(5), Pick::Rank(5), Pick::Rank(5), Pick::Rank(5)]),
];

/// Of two fragments it says no more than that all are alike.
const TWO_ALIKE: &str = "two alike and others";

#[derive(Clone, Copy)]
enum Pick {
    Rank(usize),
    Twin(usize),
}

/// What a pixel may hold before.
const PRIOR: [usize; 8] = [3, 5, 7, 9, 13, 15, 17, 19];

/// Every case for `count` new fragments and `k` entries; `k` is `None` where all are kept. `may_give_up`: tries are bounded
/// so low that fragments may be.
pub(crate) fn cases(
    subject: &Subject,
    candidates: &Candidates,
    (count, k): (u32, Option<u32>),
    may_give_up: bool,
) -> Result<Vec<Case>, String> {
    let mut cases = Vec::new();
    for (prior, arrival) in priors(k) {
        for (pattern, picks) in &PATTERNS {
            let alone = prior.is_empty();
            let is_told_elsewhere = alone && (pattern.contains("better") || pattern.contains("worse"));
            if is_told_elsewhere || *pattern == TWO_ALIKE && count < 3 {
                continue;
            }
            let picked = picks.iter().cycle().take(count as usize).map(|pick| match pick {
                Pick::Rank(rank) => candidates.ranked[*rank].clone(),
                Pick::Twin(rank) => candidates.twins[*rank].clone(),
            });
            let new: Vec<Fragment> = picked.collect();
            let prior: Vec<Fragment> = prior.iter().map(|rank| candidates.ranked[*rank].clone()).collect();
            let what = format!("{arrival}, {count} at once, {pattern}");
            placed(subject, &Comers { k, prior, new, what, may_give_up }, &mut cases)?;
        }
    }
    Ok(cases)
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

/// The same fragments for every pass that draws, with enough room, too little, and one that was not seen before; at the last
/// pixel of the frame too; and one that is a helper invocation.
fn placed(subject: &Subject, comers: &Comers, cases: &mut Vec<Case>) -> Result<(), String> {
    let Comers { k, prior, new, may_give_up, .. } = comers;
    let drawn = subject.passes.iter().enumerate().filter(|(_, pass)| pass.pass.kind == Kind::Geometry);
    // Of several passes over the scene the last stores what those before have counted.
    let last = drawn.clone().count() - 1;
    for (number, (pass, runnable)) in drawn.enumerate() {
        let case = |room: Room, pixel: u32, has_helper: bool| {
            let place = if pixel > 0 { "the last pixel" } else { "" };
            let notes = [place, room.what, if has_helper { "the last a helper invocation" } else { "" }];
            let notes: String = notes.iter().filter(|note| !note.is_empty()).map(|note| format!(", {note}")).collect();
            let what = format!("pass {}, {}{notes}", runnable.pass.anchor, comers.what);
            Case { k: *k, prior: prior.clone(), new: new.clone(), pass, room, pixel, has_helper, what }
        };
        let asking = |new, pixel| Asking { prior, new, k: *k, may_give_up: *may_give_up, pixel };
        for room in rooms(subject, &asking(new, 0), number > 0 && number == last)? {
            cases.push(case(room, 0, false));
        }
        if !comers.what.contains("between") {
            continue;
        }
        for room in rooms(subject, &asking(new, 1), number > 0 && number == last)? {
            cases.push(case(room, 1, false));
        }
        // A helper invocation takes no room.
        if subject.has_fences {
            let enough = rooms(subject, &asking(&new[..new.len() - 1], 0), false)?.into_iter().next();
            cases.extend(enough.map(|room| case(room, 0, true)));
        }
    }
    Ok(())
}

impl Subject {
    /// Whether what the storage holds depends on k; else it holds all.
    pub(crate) fn keeps_best(&self) -> bool {
        !self.keeps_all() || self.is_handed_the_best()
    }

    /// Whether the storage keeps whatever it is handed.
    pub(crate) fn keeps_all(&self) -> bool {
        self.plan.selection.kept().is_some_and(|kept| kept.most.is_none())
    }
}
