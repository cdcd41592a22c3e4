//! Room for fragments whose number no one knows when the frame is allocated, and rows of a slice that fit.

use fragbuf_codegen::Plan;

use crate::action::Action;
use crate::memory::{bytes, checked_sizes};
use crate::symbols::{Symbols, counted_symbols};
use crate::{Error, Room, Settings, Sizing};

/// The symbols of the first frame, and whether host steps will count.
pub(crate) fn symbols(plan: &Plan, actions: &[Action], settings: &Settings) -> Result<(Symbols, bool), Error> {
    let k = plan.frame.iter().any(|field| field == "k").then_some(plan.variant.keep).flatten();
    let (width, height) = (settings.width, settings.height);
    let mut symbols = Symbols { width, height, rows: height, k, counted: Vec::new() };
    let names = counted_symbols(plan);
    let decided = |name: &String| actions.iter().any(|action| matches!(action, Action::Host(host) if host.sets(name)));
    let exact = match settings.sizing {
        Sizing::Auto => names.iter().all(decided),
        Sizing::Exact => true,
        Sizing::Reserve(_) => false,
    };
    if let Some(name) = names.iter().find(|name| exact && !decided(name)) {
        return Err(Error::Unsupported {
            what: format!("exact sizing of `{name}`, which no step of this plan counts"),
            hint: "reserve: `Sizing::Reserve(Room::Bytes(…))`".to_owned(),
        });
    }
    symbols.counted = names.into_iter().map(|name| (name, exact.then_some(0))).collect();
    if let Sizing::Reserve(room) = settings.sizing {
        reserve(plan, &mut symbols, room)?;
    }
    Ok((symbols, exact))
}

/// Sets what is counted to the room that the caller makes.
pub(crate) fn reserve(plan: &Plan, symbols: &mut Symbols, room: Room) -> Result<(), Error> {
    let fragments = match room {
        Room::Fragments(fragments) => fragments,
        Room::Bytes(bytes) => fragments_in(plan, symbols, bytes)?,
    };
    fill(symbols, fragments);
    Ok(())
}

fn fill(symbols: &mut Symbols, fragments: u32) {
    symbols.counted.iter_mut().for_each(|(_, value)| *value = Some(fragments.into()));
}

/// The most fragments for which the buffers grow by no more than `room` bytes.
fn fragments_in(plan: &Plan, symbols: &Symbols, room: u64) -> Result<u32, Error> {
    let total = |fragments: u32| -> Result<u64, Error> {
        let mut symbols = symbols.clone();
        fill(&mut symbols, fragments);
        Ok(bytes(plan, &symbols)?.iter().map(|(_, bytes)| bytes).sum())
    };
    let empty = total(0)?;
    greatest(u32::MAX, |fragments| Ok(total(fragments)? - empty <= room))
}

/// The rows of a slice: as the caller wants, or as many as every buffer is within the limits at.
pub(crate) fn rows(plan: &Plan, symbols: &Symbols, slice: Option<u32>, limits: &wgpu::Limits) -> Result<u32, Error> {
    if let Some(rows) = slice {
        return Ok(rows.clamp(1, symbols.height.max(1)));
    }
    let attempt = |rows: u32| checked_sizes(plan, &Symbols { rows, ..symbols.clone() }, limits);
    // Not even one row: the error says what is too large.
    attempt(1)?;
    greatest(symbols.height, |rows| Ok(rows == 0 || attempt(rows).is_ok()))
}

/// The greatest number up to `end` that holds, where 0 holds and none does after one that does not.
fn greatest(end: u32, holds: impl Fn(u32) -> Result<bool, Error>) -> Result<u32, Error> {
    if holds(end)? {
        return Ok(end);
    }
    let (mut yes, mut no) = (0, end);
    while no - yes > 1 {
        let middle = yes + (no - yes) / 2;
        if holds(middle)? { yes = middle } else { no = middle }
    }
    Ok(yes)
}
