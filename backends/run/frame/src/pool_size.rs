//! Capacities for fragments whose number is unknown when a frame is allocated.

use fragbuf_codegen::{Plan, SymbolId};
use fragbuf_templates::vocabulary::BindingTime;

use crate::memory::resource_bytes;
use crate::{Error, Values};

/// How memory is sized for fragments whose number is unknown in advance. Plans without such resources ignore it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sizing {
    /// [`Sizing::Exact`] if a host step of the plan counts the fragments, otherwise [`Sizing::Capacity`] for eight fragments per
    /// pixel.
    Auto,
    /// Exactly the fragments of the frame. The frame is suspended where the host reads the count back and allocates, and after
    /// each iteration of a loop whose end condition is evaluated on the device.
    Exact,
    /// The capacity that the caller gives. Fragments beyond it count as lost. The frame is suspended after each iteration of a loop
    /// whose end condition is evaluated on the device, and nowhere else.
    Capacity(PoolSize),
    /// As [`Sizing::Capacity`], but the frame is never suspended: loops run to their limits.
    Reserve(PoolSize),
}

/// The capacity for the fragments of a frame, or of each slice of a frame with several slices.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PoolSize {
    /// This many fragments.
    Fragments(u32),
    /// As many fragments as fit into this many bytes, over all buffers whose size depends on the number of fragments.
    Bytes(u64),
}

impl Sizing {
    /// The fragments per pixel that [`Sizing::Auto`] allocates for where no host step counts them.
    pub const AUTO_PER_PIXEL: u32 = 8;
}

/// Whether the host reads words back within a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Readbacks {
    /// Host steps run, loops end on their conditions, and queries drop objects.
    Enabled,
    /// The same, except that host steps which may lag do not run in the frame: the device reads their words for a later frame.
    Lagged,
    /// The caller has reserved what host steps would set. Host steps are skipped; loops end on their conditions, and queries drop
    /// objects.
    LoopsOnly,
    /// As `LoopsOnly`, but loops run to their limits, and no object is dropped.
    Disabled,
}

/// Returns the values of the first frame, and whether its host steps run.
pub fn initial_values(plan: &Plan, size: (u32, u32), sizing: Sizing) -> Result<(Values, Readbacks), Error> {
    let mut values = Values::new(plan, size);
    if let Some(k) = plan.variant.keep {
        values.set(SymbolId::K, k.into());
    }
    let counted = counted_symbols(plan);
    let undecided = counted.iter().find(|id| !is_set_by_host(plan, **id));
    let readbacks = match (sizing, undecided) {
        (Sizing::Auto, None) | (Sizing::Exact, None) => Readbacks::Enabled,
        (Sizing::Exact, Some(id)) => {
            return Err(Error::Unsupported {
                what: format!("exact sizing of `{}`, which no step of this plan counts", plan.symbols.get(*id).name),
                help: "give a capacity with `Sizing::Capacity(PoolSize::Bytes(…))`".to_owned(),
            });
        }
        (Sizing::Auto, Some(_)) | (Sizing::Capacity(_), _) => Readbacks::LoopsOnly,
        (Sizing::Reserve(_), _) => Readbacks::Disabled,
    };
    for id in counted {
        match readbacks {
            Readbacks::Enabled | Readbacks::Lagged => values.set(id, 0),
            Readbacks::LoopsOnly | Readbacks::Disabled => values.set_per_pixel(id, Sizing::AUTO_PER_PIXEL),
        }
    }
    if let Sizing::Capacity(size) | Sizing::Reserve(size) = sizing {
        reserve(plan, &mut values, size)?;
    }
    // Memory for more is allocated once a host step has decided.
    if readbacks == Readbacks::Enabled && host_sets_k(plan) {
        values.set(SymbolId::K, 1);
    }
    Ok((values, readbacks))
}

/// Returns the symbols whose values are known only after fragments are counted: frame fields that depend neither on its size
/// nor on the caller. A number of slots per pixel becomes the fragments of the frame, unless a host step sets it.
fn counted_symbols(plan: &Plan) -> Vec<SymbolId> {
    let fields = plan.fields.iter().copied().filter(|id| plan.symbols.get(*id).when == BindingTime::Readback);
    let mut counted: Vec<SymbolId> = Vec::new();
    for id in fields {
        let id = if id == SymbolId::N && !is_set_by_host(plan, id) { SymbolId::FRAGMENTS } else { id };
        if !counted.contains(&id) {
            counted.push(id);
        }
    }
    counted
}

/// Whether a host step sets k.
pub fn host_sets_k(plan: &Plan) -> bool {
    is_set_by_host(plan, SymbolId::K)
}

/// Whether a host step sets the symbol.
pub(crate) fn is_set_by_host(plan: &Plan, id: SymbolId) -> bool {
    plan.frame.decisions().any(|decision| decision.sets.contains(&id))
}

/// Sets the counted symbols to the capacity that the caller reserves.
pub fn reserve(plan: &Plan, values: &mut Values, size: PoolSize) -> Result<(), Error> {
    let fragments = match size {
        PoolSize::Fragments(fragments) => fragments,
        PoolSize::Bytes(bytes) => fragments_in(plan, values, bytes)?,
    };
    set_fragments(plan, values, fragments);
    if let Some(k) = plan.variant.keep.filter(|_| host_sets_k(plan)) {
        values.set(SymbolId::K, k.into());
    }
    Ok(())
}

/// Returns the capacity to reserve, in fragments, after a frame that lost `short` fragments to overflow. For a pool that is
/// exactly enough. Where every pixel has its own slots it is twice the capacity, because only the deepest pixels overflowed.
pub fn pool_size_after(plan: &Plan, values: &Values, short: u32) -> u64 {
    let now = values.get(SymbolId::FRAGMENTS).unwrap_or(0);
    if plan.has_field(SymbolId::N) { (2 * now).max(values.pixels()) } else { now + u64::from(short) }
}

/// Replaces counted symbols in `decided`, as a host step has set them, by the allocated values of `now` where these are large
/// enough and at most twice as large. A small surplus is kept, and more is released.
pub fn reuse_pool_sizes(plan: &Plan, now: &Values, decided: &mut Values) {
    for id in counted_symbols(plan) {
        let (Some(allocated), Some(needed)) = (now.get(id), decided.get(id)) else { continue };
        if needed <= allocated && allocated <= 2 * needed {
            decided.set(id, allocated);
        }
    }
}

fn set_fragments(plan: &Plan, values: &mut Values, fragments: u32) {
    counted_symbols(plan).into_iter().for_each(|id| values.set(id, fragments.into()));
}

/// Returns the greatest number of fragments for which the buffers grow by at most `limit` bytes.
fn fragments_in(plan: &Plan, values: &Values, limit: u64) -> Result<u32, Error> {
    let total = |fragments: u32| -> Result<u64, Error> {
        let mut values = values.clone();
        set_fragments(plan, &mut values, fragments);
        Ok(resource_bytes(plan, &values)?.iter().fold(0, |sum: u64, (_, bytes)| sum.saturating_add(*bytes)))
    };
    let empty = total(0)?;
    let fits = |fragments: u32| Ok(total(fragments)? - empty <= limit);
    if fits(u32::MAX)? {
        return Ok(u32::MAX);
    }
    let (mut yes, mut no) = (0, u32::MAX);
    while no - yes > 1 {
        let middle = yes + (no - yes) / 2;
        if fits(middle)? { yes = middle } else { no = middle }
    }
    Ok(yes)
}
