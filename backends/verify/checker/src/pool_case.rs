//! The pool sizes that a case is checked with, and how many of its fragments may overflow each.
//!
//! Input: a subject, and the fragments of a case. Output: pool cases, each with the range of correct losses. The range is a
//! single number wherever the order of arrival does not matter. It matters where fragments can be culled before they
//! allocate. Then a fragment with fewer than k fragments ahead of it in any order always allocates. Once one has
//! overflowed, fragments behind it may allocate too.

use std::ops::RangeInclusive;

use fragbuf_codegen::SymbolId;
use fragbuf_frame::{PoolSize, Sizing, Values, initial_values};
use fragbuf_templates::vocabulary::Capability;

use crate::fragments::Fragment;
use crate::memory::WIDTH;
use crate::subject::Subject;

/// A size of the pools for the fragments of a case.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct PoolCase {
    pub(crate) values: Values,
    /// The most that host steps allocate.
    pub(crate) allocation_limit: Option<u32>,
    /// How many fragments of the pixel may overflow.
    pub(crate) overflows: RangeInclusive<u32>,
    /// How many fragments of the neighbour overflow.
    pub(crate) neighbours_lost: u32,
    /// Whether earlier geometry passes did not draw the last new fragment.
    pub(crate) has_uncounted: bool,
    /// A note for people; empty where every fragment fits.
    pub(crate) note: &'static str,
}

/// The fragments that may allocate.
pub(crate) struct AllocationDemand<'a> {
    pub(crate) prior: &'a [Fragment],
    pub(crate) new: &'a [Fragment],
    pub(crate) k: Option<u32>,
    /// Whether fragments may time out, so that those behind them allocate.
    pub(crate) may_time_out: bool,
    /// The pixel of the fragments.
    pub(crate) pixel: u32,
}

impl AllocationDemand<'_> {
    fn total(&self) -> u32 {
        (self.prior.len() + self.new.len()) as u32
    }

    /// Returns how many fragments allocate at most, if only those behind k others are culled; and how many allocate in
    /// every order. Prior fragments arrive one after the other, so each allocates or does not. Of the new ones, those that
    /// never have k ahead of them allocate in every order, and at least as many as are kept.
    fn allocating(&self) -> (u32, u32) {
        let k = self.k.unwrap_or(u32::MAX) as usize;
        let ahead = |of: &Fragment, others: &[Fragment]| others.iter().filter(|other| other.words <= of.words).count();
        let prior = (0..self.prior.len()).filter(|at| ahead(&self.prior[*at], &self.prior[..*at]) < k).count();
        let new = |least: usize| {
            let allocates = |of: &&Fragment| ahead(of, self.prior) + least * (ahead(of, self.new) - 1) < k;
            self.new.iter().filter(allocates).count()
        };
        let kept = k.min(self.prior.len() + self.new.len());
        ((prior + new(0)) as u32, kept.max(prior + new(1)) as u32)
    }
}

/// Returns every pool size that a case is checked with. `is_recounted`: a geometry pass before the one under test counts
/// the fragments.
pub(crate) fn pool_cases(
    subject: &Subject,
    demand: &AllocationDemand<'_>,
    is_recounted: bool,
) -> Result<Vec<PoolCase>, String> {
    let plan = &subject.plan;
    let is_counted = plan.frame.decisions().flat_map(|decision| &decision.sets).any(|id| *id != SymbolId::K);
    let has_slots = plan.has_field(SymbolId::N);
    let is_pooled = plan.has_field(SymbolId::FRAGMENTS) && !is_counted;
    let mut pools = match (is_counted, has_slots, is_pooled) {
        (true, _, _) => counted(subject, demand, is_recounted),
        (_, true, _) => slots(subject, demand),
        (_, _, true) => pool(subject, demand),
        _ => Ok(vec![sized(subject, demand.k, Sizing::Exact)?]),
    }?;
    if subject.accepts_k_best_only() {
        // Fragments beyond the k best may be culled before they allocate.
        let beyond = demand.total().saturating_sub(demand.k.unwrap_or(u32::MAX));
        for pool in &mut pools {
            pool.overflows = pool.overflows.start().saturating_sub(beyond)..=*pool.overflows.end();
        }
    }
    Ok(pools)
}

/// Returns the values of a frame whose pools are large enough for the functions that compute the words of candidates.
pub(crate) fn ample_values(subject: &Subject) -> Result<Values, String> {
    Ok(sized(subject, Some(1), Sizing::Reserve(PoolSize::Fragments(16)))?.values)
}

/// Returns a pool of this size, which nothing overflows.
fn sized(subject: &Subject, k: Option<u32>, sizing: Sizing) -> Result<PoolCase, String> {
    let (mut values, _) = initial_values(&subject.plan, (WIDTH, 1), sizing).map_err(|error| error.to_string())?;
    if let Some(k) = k {
        values.set(SymbolId::K, k.into());
    }
    let overflows = 0..=0;
    Ok(PoolCase { values, allocation_limit: None, overflows, neighbours_lost: 0, has_uncounted: false, note: "" })
}

/// Returns pools that the host allocates for the fragments that a pass has counted: exact, too small, and with one fragment
/// that was not counted.
fn counted(subject: &Subject, demand: &AllocationDemand<'_>, is_recounted: bool) -> Result<Vec<PoolCase>, String> {
    let exact = sized(subject, demand.k, Sizing::Exact)?;
    let mut pools = vec![exact.clone()];
    // Where the host decides k too, the number of kept fragments is not known here, so no pool is known to be too small.
    let sets_k = subject.plan.frame.decisions().any(|decision| decision.sets.contains(&SymbolId::K));
    // Nor is it where every iteration stores one layer of them.
    let is_by_layer = subject.keeps_later() && !subject.keeps_best();
    if !is_recounted || sets_k || is_by_layer {
        return Ok(pools);
    }
    let (total, k) = (demand.total(), demand.k.unwrap_or(u32::MAX));
    let stored = total.min(k);
    // Fragments that exclude each other may need the whole pool, so that a smaller one keeps none.
    let overflows = 1..=if total <= k { 1 } else { total };
    let note = "pool reserved for one fragment fewer";
    if demand.pixel == 0 {
        // The neighbour's slots are the last of the pool.
        let neighbours_lost = 1;
        pools.push(PoolCase {
            allocation_limit: Some(stored),
            neighbours_lost,
            note: "no pool capacity for the neighbour",
            ..exact.clone()
        });
        let allocation_limit = Some(stored - 1);
        pools.push(PoolCase { allocation_limit, overflows, neighbours_lost, note, ..exact.clone() });
    } else {
        pools.push(PoolCase { allocation_limit: Some(stored), overflows, note, ..exact.clone() });
        let note = "pool capacity for the neighbour only";
        pools.push(PoolCase { allocation_limit: Some(1), overflows: total..=total, note, ..exact.clone() });
    }
    // With more than k fragments it does not matter which of them was counted.
    let lost = u32::from(total - 1 <= k);
    let note = "one fragment not counted by the previous pass";
    pools.push(PoolCase { has_uncounted: true, overflows: lost..=lost, note, ..exact });
    Ok(pools)
}

/// Returns slots of each pixel. The neighbour has as many, which is enough.
fn slots(subject: &Subject, demand: &AllocationDemand<'_>) -> Result<Vec<PoolCase>, String> {
    let pool = |slots: u32| sized(subject, demand.k, Sizing::Reserve(PoolSize::Fragments(WIDTH * slots)));
    let total = demand.total();
    let note = "slots for one fragment fewer";
    Ok(vec![pool(total)?, PoolCase { overflows: 1..=1, note, ..pool(total - 1)? }])
}

/// Returns one pool for all pixels: for all fragments, for those that allocate, and for one fewer than allocate in every order.
fn pool(subject: &Subject, demand: &AllocationDemand<'_>) -> Result<Vec<PoolCase>, String> {
    let pool = |nodes: u32| sized(subject, demand.k, Sizing::Reserve(PoolSize::Fragments(nodes + WIDTH - 1)));
    let total = demand.total();
    let allocates_k_best = subject.plan.selection.provides().contains(&Capability::AllocatesKBestOnly);
    let (most, least) = match (subject.keeps_best(), allocates_k_best) {
        (false, _) => (total, total),
        (true, true) => demand.allocating(),
        (true, false) => (total, total.min(demand.k.unwrap_or(u32::MAX))),
    };
    let mut pools = vec![pool(total)?];
    if let Some(page) = page(subject, &pools[0])? {
        // A fragment leaks its page if another has linked one meanwhile.
        let ample = pool(total + page * demand.new.len() as u32)?;
        let lost = total.saturating_sub(page);
        let note = "each pixel's first page only";
        let none = sized(subject, demand.k, Sizing::Reserve(PoolSize::Fragments(0)))?;
        return Ok(vec![ample, PoolCase { overflows: lost..=lost, note, ..none }]);
    }
    if most < total && !demand.may_time_out {
        pools.push(PoolCase { note: "pool capacity for the allocating fragments", ..pool(most)? });
    }
    let nodes = least - 1;
    let overflows = least - nodes..=total - nodes;
    pools.push(PoolCase { overflows, note: "pool capacity for one fragment fewer", ..pool(nodes)? });
    Ok(pools)
}

/// Returns the number of fragments of a page, where every pixel has a first page even if the pool is empty.
fn page(subject: &Subject, pool: &PoolCase) -> Result<Option<u32>, String> {
    let words = |fragments: u32| {
        let values = pool.values.with(SymbolId::FRAGMENTS, fragments.into());
        let mut pooled = subject.plan.resources.iter().filter(|planned| planned.words.mentions(SymbolId::FRAGMENTS));
        let words = pooled.by_ref().map(|planned| values.evaluate(&planned.words, &planned.resource.name));
        words.sum::<Result<u64, _>>().map_err(|error| error.to_string())
    };
    let least = words(0)?;
    if least == 0 {
        return Ok(None);
    }
    for fragments in 1..=LARGEST_PAGE {
        if words(fragments)? > least {
            return Ok(Some(fragments));
        }
    }
    Err(format!("the storage allocates pages of more than {LARGEST_PAGE} fragments"))
}

const LARGEST_PAGE: u32 = 1 << 10;
