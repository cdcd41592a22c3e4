//! Room for fragments whose number no one knows when the frame is allocated.

use fragbuf_codegen::Plan;
use fragbuf_templates::vocabulary::Step;

use crate::symbols::counted_symbols;
use crate::{Error, Symbols};

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

/// The symbols of the first frame, and whether host steps will count.
pub fn symbols(plan: &Plan, (width, height): (u32, u32), sizing: Sizing) -> Result<(Symbols, Counting), Error> {
    let k = plan.frame.iter().any(|field| field == "k").then_some(plan.variant.keep).flatten();
    let mut symbols = Symbols { width, height, rows: height, k, counted: Vec::new() };
    let names = counted_symbols(plan);
    let exact = match sizing {
        Sizing::Auto => names.iter().all(|name| decided(&plan.steps, name)),
        Sizing::Exact => true,
        Sizing::Reserve(_) => false,
    };
    if let Some(name) = names.iter().find(|name| exact && !decided(&plan.steps, name)) {
        return Err(Error::Unsupported {
            what: format!("exact sizing of `{name}`, which no step of this plan counts"),
            hint: "reserve: `Sizing::Reserve(Room::Bytes(…))`".to_owned(),
        });
    }
    symbols.counted = names.into_iter().map(|name| (name, exact.then_some(0))).collect();
    if let Sizing::Reserve(room) = sizing {
        reserve(plan, &mut symbols, room)?;
    }
    Ok((symbols, if exact { Counting::Exact } else { Counting::Reserved }))
}

/// Whether a host step sets the symbol.
fn decided(steps: &[Step], symbol: &str) -> bool {
    steps.iter().any(|step| match step {
        Step::Host(host) => host.sets.iter().any(|set| set == symbol),
        Step::Repeat(repeat) => decided(&repeat.body, symbol),
        _ => false,
    })
}

/// Sets what is counted to the room that the caller makes.
pub fn reserve(plan: &Plan, symbols: &mut Symbols, room: Room) -> Result<(), Error> {
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

/// Name and bytes of every resource. What is counted later has no room yet.
pub fn bytes<'a>(plan: &'a Plan, symbols: &Symbols) -> Result<Vec<(&'a str, u64)>, Error> {
    let sizes = plan.resources.iter().map(|planned| {
        let name = &planned.resource.name;
        Ok((name.as_str(), symbols.evaluate(plan, &planned.words, &format!("`{name}`"))?.saturating_mul(4)))
    });
    sizes.collect()
}
