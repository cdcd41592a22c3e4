//! The cases of a check: the initial content of a pixel, and the fragments that then run concurrently.
//!
//! Input: the number of fragments, entries and passes. Output: every legal initial state (empty, one short of full, full,
//! over-full; several arrival orders), with new fragments between, ahead of, behind and equal to the initial ones; too
//! small a pool; a pass that did not count a fragment. The search explores the order of the new fragments.

use std::cmp::Ordering;

use fragbuf_templates::vocabulary::Kind;

use crate::fragments::{Candidates, Fragment};
use crate::pool_case::{AllocationDemand, PoolCase, pool_cases};
use crate::subject::Subject;

/// One case.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Case {
    pub(crate) k: Option<u32>,
    /// In order of arrival.
    pub(crate) prior: Vec<Fragment>,
    pub(crate) new: Vec<Fragment>,
    /// The pass whose fragments run concurrently, by its number among those that compute or draw.
    pub(crate) pass: usize,
    pub(crate) pool: PoolCase,
    /// The pixel under test, of two.
    pub(crate) pixel: u32,
    /// Whether the last new fragment is a helper invocation.
    pub(crate) has_helper: bool,
    /// For people.
    pub(crate) description: String,
}

/// The fragments of a case, before pass and pool size are chosen.
struct NewFragments<'a> {
    k: Option<u32>,
    prior: Vec<Fragment>,
    new: Vec<Fragment>,
    pattern: &'a str,
    description: String,
    may_time_out: bool,
}

/// How the keys of new fragments compare with the initial ones.
const PATTERNS: [(&str, [Pick; 4]); 7] = [
    (BETWEEN, [Pick::Rank(4), Pick::Rank(2), Pick::Rank(6), Pick::Rank(1)]),
    (BETTER, [Pick::Rank(0), Pick::Rank(1), Pick::Rank(2), Pick::Rank(0)]),
    (WORSE, [Pick::Rank(20), Pick::Rank(21), Pick::Rank(22), Pick::Rank(23)]),
    ("one key, two payloads", [Pick::Rank(5), Pick::Twin(5), Pick::Rank(5), Pick::Twin(5)]),
    (THREE_PAYLOADS, [Pick::Rank(5), Pick::Twin(5), Pick::SecondTwin(5), Pick::Rank(6)]),
    (TWO_EQUAL, [Pick::Rank(4), Pick::Rank(4), Pick::Rank(6), Pick::Rank(2)]),
    ("all equal", [Pick::Rank(5), Pick::Rank(5), Pick::Rank(5), Pick::Rank(5)]),
];

/// Checked at the last pixel and with a helper invocation too.
const BETWEEN: &str = "keys between those kept";

/// In an empty pixel these equal [`BETWEEN`].
const BETTER: &str = "keys better than all kept";
const WORSE: &str = "keys worse than all kept";

/// Of two fragments this is the same as all equal.
const TWO_EQUAL: &str = "two equal and others";

/// Checked where ids tell fragments of equal keys apart. Of two fragments this is the same as two payloads.
const THREE_PAYLOADS: &str = "one key, three payloads";

#[derive(Clone, Copy)]
enum Pick {
    Rank(usize),
    Twin(usize),
    SecondTwin(usize),
}

/// The ranks of the initial fragments.
const PRIOR: [usize; 8] = [3, 5, 7, 9, 13, 15, 17, 19];

/// Returns every case for `count` new fragments and `k` entries; `k` is `None` where all are kept. `may_time_out`: the retry
/// limit is so low that fragments may time out.
pub(crate) fn cases(
    subject: &Subject,
    candidates: &Candidates,
    (count, k): (u32, Option<u32>),
    may_time_out: bool,
) -> Result<Vec<Case>, String> {
    let mut cases = Vec::new();
    for (prior, arrival) in priors(k) {
        for (pattern, picks) in &PATTERNS {
            let is_repeated = prior.is_empty() && [BETTER, WORSE].contains(pattern);
            let needs_three = [TWO_EQUAL, THREE_PAYLOADS].contains(pattern) && count < 3;
            let needs_ids = *pattern == THREE_PAYLOADS && !subject.tells_ids_apart();
            if is_repeated || needs_three || needs_ids {
                continue;
            }
            let picked = picks.iter().cycle().take(count as usize).map(|pick| match pick {
                Pick::Rank(rank) => candidates.ranked[*rank].clone(),
                Pick::Twin(rank) => candidates.twins[*rank].clone(),
                Pick::SecondTwin(rank) => candidates.second_twins[*rank].clone(),
            });
            let new: Vec<Fragment> = picked.collect();
            let prior: Vec<Fragment> = prior.iter().map(|rank| candidates.ranked[*rank].clone()).collect();
            let description = format!("{arrival}, {count} concurrent, {pattern}");
            let fragments = NewFragments { k, prior, new, pattern, description, may_time_out };
            push_cases(subject, &fragments, &mut cases)?;
        }
    }
    Ok(cases)
}

/// Returns the initial states, each as the ranks of its fragments in order of arrival and a description. Up to three
/// fragments arrive in every order, more in five orders.
fn priors(k: Option<u32>) -> Vec<(Vec<usize>, String)> {
    let mut counts: Vec<usize> = match k {
        Some(k) => vec![0, k as usize - 1, k as usize, k as usize + 1],
        None => vec![0, 2],
    };
    counts.dedup();
    let mut priors = Vec::new();
    for count in counts {
        let full = match k.map(|k| count.cmp(&(k as usize))) {
            Some(Ordering::Equal) => ", full",
            Some(Ordering::Greater) => ", one displaced",
            _ => "",
        };
        for order in orders(count.min(PRIOR.len())) {
            let ranks = order.iter().map(|at| PRIOR[*at]).collect();
            let arrival: Vec<String> = order.iter().map(|at| (at + 1).to_string()).collect();
            priors.push((
                ranks,
                match count {
                    0 => "initially empty".to_owned(),
                    1 => format!("initially 1{full}"),
                    _ => format!("initially {count}{full}, arrival order by rank {}", arrival.join(" ")),
                },
            ));
        }
    }
    priors
}

/// Returns orders of `count` things: all of up to three, five of more.
fn orders(count: usize) -> Vec<Vec<usize>> {
    if count > 3 {
        let riffled = |first: usize| (first..count).step_by(2).chain((1 - first..count).step_by(2)).collect();
        // Neither sorted nor nearly so: a heap built from it has its second level in the wrong order.
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

/// Appends a case for every pass that draws and every pool size. Some are repeated at the last pixel of the frame, and with
/// a helper invocation.
fn push_cases(subject: &Subject, fragments: &NewFragments<'_>, cases: &mut Vec<Case>) -> Result<(), String> {
    let NewFragments { k, prior, new, may_time_out, .. } = fragments;
    let drawn = subject.passes.iter().enumerate().filter(|(_, pass)| pass.pass.kind == Kind::Geometry);
    // Of several passes over the scene, the last stores the fragments that the others have counted.
    let last = drawn.clone().count() - 1;
    for (number, (pass, runnable)) in drawn.enumerate() {
        let case = |pool: PoolCase, pixel: u32, has_helper: bool| {
            let at = if pixel > 0 { "at the last pixel" } else { "" };
            let notes = [at, pool.note, if has_helper { "the last a helper invocation" } else { "" }];
            let notes: String = notes.iter().filter(|note| !note.is_empty()).map(|note| format!(", {note}")).collect();
            let description = format!("pass {}, {}{notes}", runnable.pass.name, fragments.description);
            Case { k: *k, prior: prior.clone(), new: new.clone(), pass, pool, pixel, has_helper, description }
        };
        let demand = |new, pixel| AllocationDemand { prior, new, k: *k, may_time_out: *may_time_out, pixel };
        let is_recounted = number > 0 && number == last;
        for pool in pool_cases(subject, &demand(new, 0), is_recounted)? {
            cases.push(case(pool, 0, false));
        }
        if fragments.pattern != BETWEEN {
            continue;
        }
        for pool in pool_cases(subject, &demand(new, 1), is_recounted)? {
            cases.push(case(pool, 1, false));
        }
        // A helper invocation does not allocate.
        if subject.has_fences {
            let enough = pool_cases(subject, &demand(&new[..new.len() - 1], 0), false)?.into_iter().next();
            cases.extend(enough.map(|pool| case(pool, 0, true)));
        }
    }
    Ok(())
}
