//! Room for fragments whose number no one knows when the frame is allocated.

use fragbuf_codegen::{Plan, SymbolId};
use fragbuf_templates::vocabulary::When;

use crate::{Error, Values};

/// How much room is made for fragments whose number no one knows beforehand. Plans without such resources ignore it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sizing {
    /// [`Sizing::Exact`] where a host step of the plan finds the number out, else room for eight fragments per pixel.
    Auto,
    /// Exactly what the frame has: it is cut where the host reads the number back and makes room, and after each round of a
    /// loop whose end is found out on the device.
    Exact,
    /// What the caller says. The frame is never cut; fragments beyond are counted as lost, and such loops go on to their bound.
    Reserve(Room),
}

/// Room for the fragments of a frame, or of each slice of a frame that has several.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Room {
    /// For this many fragments.
    Fragments(u32),
    /// For as many as this many bytes hold, over all buffers whose size follows the number of fragments.
    Bytes(u64),
}

impl Sizing {
    /// Fragments per pixel that [`Sizing::Auto`] makes room for where nobody counts them.
    pub const AUTO_PER_PIXEL: u32 = 8;
}

/// Who says how many fragments there are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Counting {
    /// Host steps, which are carried out.
    Exact,
    /// The caller: what host steps would set has been reserved.
    Reserved,
}

/// The values of the first frame, and whether host steps will count.
pub fn values(plan: &Plan, size: (u32, u32), sizing: Sizing) -> Result<(Values, Counting), Error> {
    let mut values = Values::new(plan, size);
    if let Some(k) = plan.variant.keep {
        values.set(SymbolId::K, k.into());
    }
    let counted = counted(plan);
    let undecided = counted.iter().find(|id| !is_decided(plan, **id));
    let counting = match (sizing, undecided) {
        (Sizing::Auto, None) | (Sizing::Exact, None) => Counting::Exact,
        (Sizing::Exact, Some(id)) => {
            return Err(Error::Unsupported {
                what: format!("exact sizing of `{}`, which no step of this plan counts", plan.symbols.get(*id).name),
                hint: "reserve: `Sizing::Reserve(Room::Bytes(…))`".to_owned(),
            });
        }
        (Sizing::Auto, Some(_)) | (Sizing::Reserve(_), _) => Counting::Reserved,
    };
    for id in counted {
        match counting {
            Counting::Exact => values.set(id, 0),
            Counting::Reserved => values.set_per_pixel(id, Sizing::AUTO_PER_PIXEL),
        }
    }
    if let Sizing::Reserve(room) = sizing {
        reserve(plan, &mut values, room)?;
    }
    Ok((values, counting))
}

/// The symbols whose values are known only once fragments have been counted: fields of the frame that neither its size nor
/// the caller decides. Slots per pixel stand for the fragments of the frame, unless a host step sets them.
fn counted(plan: &Plan) -> Vec<SymbolId> {
    let fields = plan.fields.iter().copied().filter(|id| plan.symbols.get(*id).when == When::Readback);
    let mut counted: Vec<SymbolId> = Vec::new();
    for id in fields {
        let id = if id == SymbolId::N && !is_decided(plan, id) { SymbolId::FRAGMENTS } else { id };
        if !counted.contains(&id) {
            counted.push(id);
        }
    }
    counted
}

/// Whether a host step sets the symbol.
fn is_decided(plan: &Plan, id: SymbolId) -> bool {
    plan.frame.decisions().any(|decision| decision.sets.contains(&id))
}

/// Sets what is counted to the memory that the caller reserves.
pub fn reserve(plan: &Plan, values: &mut Values, room: Room) -> Result<(), Error> {
    let fragments = match room {
        Room::Fragments(fragments) => fragments,
        Room::Bytes(bytes) => fragments_in(plan, values, bytes)?,
    };
    fill(plan, values, fragments);
    Ok(())
}

/// Fragments that there is to be memory for after a frame that lost `short` of them for want of it: exactly enough where a
/// pool was too small, twice as much where every pixel has slots of its own and only the deepest ran out.
pub fn room_after(plan: &Plan, values: &Values, short: u32) -> u64 {
    let now = values.get(SymbolId::FRAGMENTS).unwrap_or(0);
    if plan.has_field(SymbolId::N) { (2 * now).max(values.pixels()) } else { now + u64::from(short) }
}

/// The counted symbols that a host step has just decided and their values, those apart that keep the memory there is: a
/// little more than is needed is kept, more than twice as much is given back.
pub fn decided(plan: &Plan, now: &Values, decided: &mut Values) {
    for id in counted(plan) {
        let (Some(room), Some(needed)) = (now.get(id), decided.get(id)) else { continue };
        if needed <= room && room <= 2 * needed {
            decided.set(id, room);
        }
    }
}

fn fill(plan: &Plan, values: &mut Values, fragments: u32) {
    counted(plan).into_iter().for_each(|id| values.set(id, fragments.into()));
}

/// The most fragments for which the buffers grow by no more than `room` bytes.
fn fragments_in(plan: &Plan, values: &Values, room: u64) -> Result<u32, Error> {
    let total = |fragments: u32| -> Result<u64, Error> {
        let mut values = values.clone();
        fill(plan, &mut values, fragments);
        Ok(bytes(plan, &values)?.iter().map(|(_, bytes)| bytes).sum())
    };
    let empty = total(0)?;
    let fits = |fragments: u32| Ok(total(fragments)? - empty <= room);
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

/// Name and bytes of every resource. What is counted later has no memory yet. Where a host step sets k there is memory for any:
/// what was written before it decides stays where it is.
pub fn bytes<'a>(plan: &'a Plan, values: &Values) -> Result<Vec<(&'a str, u64)>, Error> {
    let for_any_k = is_decided(plan, SymbolId::K).then(|| values.with(SymbolId::K, plan.capacity().into()));
    let values = for_any_k.as_ref().unwrap_or(values);
    let sizes = plan.resources.iter().map(|planned| {
        let name = &planned.resource.name;
        Ok((name.as_str(), values.evaluate(&planned.words, &format!("`{name}`"))?.saturating_mul(4)))
    });
    sizes.collect()
}
