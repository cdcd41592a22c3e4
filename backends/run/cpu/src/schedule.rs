//! Fragments of one pixel, interleaved as a GPU may: each stops before every shared access, and a seed decides who goes on.
//!
//! In: fragments, memory, a seed. Out: memory as that schedule leaves it; the same seed gives the same schedule. It is fair: of those that can
//! go on each is as likely as any other, and one that tried a lock in vain waits until the word changes, or until nobody else can
//! go on. An interlock is kept: between its begin and its end no other fragment of the pixel begins.

use fragbuf_interpreter::{Access, Atomic, Event, Exit, Machine, Operation, Place as Word, Reply, Shared};

use crate::stages::{FragmentStage, Place};
use crate::triangle::Triangle;
use crate::view::View;

/// A fragment that has not begun.
pub(crate) type Waiting<'a> = (&'a Triangle, Place);

/// Fragments of a pixel that have begun and not ended, at most: what a GPU has in flight.
const IN_FLIGHT: usize = 8;

/// Runs all fragments; `ended` hears how each ended, by its number.
pub(crate) fn interleave<'a>(
    stage: &FragmentStage<'a>,
    fragments: &[Waiting<'a>],
    view: &View<'_>,
    seed: u64,
    mut ended: impl FnMut(usize, &mut Machine<'a>, Exit),
) {
    let mut numbers = Numbers::seeded(seed);
    let mut waiting: Vec<usize> = (0..fragments.len()).collect();
    let mut flight: Vec<Running<'a>> = Vec::with_capacity(IN_FLIGHT);
    let mut spare: Vec<Machine<'a>> = Vec::new();
    loop {
        while flight.len() < IN_FLIGHT && !waiting.is_empty() {
            let number = waiting.swap_remove(numbers.below(waiting.len()));
            let (triangle, place) = &fragments[number];
            let mut machine = spare.pop().unwrap_or_else(|| stage.machine());
            stage.begin(&mut machine, triangle, place);
            flight.push(Running { number, machine, standing: None, parked: None, is_inside: false });
        }
        let Some(next) = choose(&mut flight, &mut numbers) else { return };
        let mut step = Step { view, may_go: flight[next].standing.is_some(), done: None };
        let exit = flight[next].machine.run(&mut step);
        let done = step.done;
        if let Some((event, old)) = done {
            settle(&mut flight, next, event, old);
        }
        match exit {
            Exit::Stopped(event) => flight[next].standing = Some(event),
            exit => {
                let mut over = flight.swap_remove(next);
                ended(over.number, &mut over.machine, exit);
                spare.push(over.machine);
            }
        }
    }
}

/// A fragment that has begun.
struct Running<'a> {
    /// Which of the fragments it is.
    number: usize,
    machine: Machine<'a>,
    /// What it stands before; nothing, before its first access.
    standing: Option<Event>,
    /// The word that it waits for.
    parked: Option<Word>,
    /// Whether it is inside of the interlock.
    is_inside: bool,
}

/// Who goes on. `None`: nobody is left.
fn choose(flight: &mut [Running<'_>], numbers: &mut Numbers) -> Option<usize> {
    let is_taken = flight.iter().any(|running| running.is_inside);
    let is_shut_out = |running: &Running<'_>| is_taken && running.standing == Some(Event::CriticalBegin);
    let mut able: Vec<usize> =
        (0..flight.len()).filter(|at| flight[*at].parked.is_none() && !is_shut_out(&flight[*at])).collect();
    if able.is_empty() {
        // All wait for each other: they try again, as they would on a GPU.
        flight.iter_mut().for_each(|running| running.parked = None);
        able = (0..flight.len()).filter(|at| !is_shut_out(&flight[*at])).collect();
    }
    (!able.is_empty()).then(|| able[numbers.below(able.len())])
}

/// What an event that has happened means for the others.
fn settle(flight: &mut [Running<'_>], of: usize, event: Event, old: u64) {
    match event {
        Event::CriticalBegin => flight[of].is_inside = true,
        Event::CriticalEnd => flight[of].is_inside = false,
        Event::Access(access) if access.writes() => {
            // A plain store does not say what stood there.
            if access.operation == Operation::Store || access.new_value(old) != old {
                flight
                    .iter_mut()
                    .filter(|other| other.parked == Some(access.place))
                    .for_each(|other| other.parked = None);
            } else if is_try(&access) {
                flight[of].parked = Some(access.place);
            }
        }
        _ => {}
    }
}

/// Whether an access that changed nothing was an attempt at something.
fn is_try(access: &Access) -> bool {
    matches!(access.operation, Operation::Atomic(Atomic::Exchange | Atomic::CompareExchange))
}

/// Memory up to the next access: one event happens if it may, then it stops.
struct Step<'v, 'a> {
    view: &'v View<'a>,
    may_go: bool,
    done: Option<(Event, u64)>,
}

impl Shared for Step<'_, '_> {
    fn length(&self, buffer: u16) -> u32 {
        self.view.length(buffer)
    }

    fn constant(&self, place: Word) -> u32 {
        self.view.constant(place)
    }

    fn texel(&self, texture: u16, place: [u32; 3]) -> Option<[u32; 4]> {
        self.view.texel(texture, place)
    }

    fn extent(&self, texture: u16) -> [u32; 3] {
        self.view.extent(texture)
    }

    fn event(&mut self, event: &Event) -> Reply {
        if *event == Event::Fence {
            return Reply::Done(0);
        }
        if !self.may_go {
            return Reply::Stop;
        }
        self.may_go = false;
        let old = match event {
            Event::Access(access) => self.view.access(access),
            _ => 0,
        };
        self.done = Some((*event, old));
        Reply::Done(old)
    }
}

/// Numbers from a seed: xorshift (Marsaglia 2003).
struct Numbers(u64);

impl Numbers {
    fn seeded(seed: u64) -> Self {
        Numbers((seed ^ 0x2545_f491_4f6c_dd1d).wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1)
    }

    fn below(&mut self, end: usize) -> usize {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        ((self.0 >> 32) as usize) % end
    }
}
