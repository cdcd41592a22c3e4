//! Interleaves the fragments of a pixel as a GPU may: each stops before every shared access, and a seed selects the next one.
//!
//! The same seed gives the same schedule. The schedule is fair: every fragment that can continue is equally likely. A fragment
//! that failed to take a lock waits until the word changes, or until no other fragment can continue. Between the beginning and
//! the end of an interlock no other fragment of the pixel enters it.

use fragbuf_interpreter::{Access, Atomic, Event, Exit, Machine, Operation, Reply, SharedMemory, WordAddress};

use crate::fragment_stage::{FragmentPosition, FragmentStage};
use crate::triangle::Triangle;
use crate::view::View;

/// A fragment of a pixel: its triangle and position.
pub(crate) type PixelFragment<'a> = (&'a Triangle, FragmentPosition);

/// The most fragments of a pixel in flight, as on a GPU.
const IN_FLIGHT: usize = 8;

/// Runs all fragments; calls `ended` with the number, the machine and the exit of each. Without a window they begin in random order. With
/// a window they begin in the order of submission, and those in flight are of at most so many consecutive triangles.
pub(crate) fn interleave<'a>(
    stage: &FragmentStage<'a>,
    fragments: &[PixelFragment<'a>],
    view: &View<'_>,
    (seed, window): (u64, Option<u32>),
    mut ended: impl FnMut(usize, &mut Machine<'a>, Exit),
) {
    let mut rng = Rng::seeded(seed);
    // The next fragment of a window is the last one here.
    let numbers = 0..fragments.len();
    let mut waiting: Vec<usize> = if window.is_some() { numbers.rev().collect() } else { numbers.collect() };
    let mut flight: Vec<Invocation<'a>> = Vec::with_capacity(IN_FLIGHT);
    let mut spare: Vec<Machine<'a>> = Vec::new();
    loop {
        while flight.len() < IN_FLIGHT && !waiting.is_empty() {
            let number = match window {
                None => waiting.swap_remove(rng.below(waiting.len())),
                Some(triangles) => match waiting.pop_if(|next| is_within(*next, triangles, &flight, fragments)) {
                    Some(next) => next,
                    None => break,
                },
            };
            let (triangle, position) = &fragments[number];
            let mut machine = spare.pop().unwrap_or_else(|| stage.machine());
            stage.begin(&mut machine, triangle, position);
            flight.push(Invocation { number, machine, pending: None, awaited: None, holds_interlock: false });
        }
        let Some(next) = choose(&mut flight, &mut rng) else { return };
        let mut step = SingleStepMemory { view, may_access: flight[next].pending.is_some(), done: None };
        let exit = flight[next].machine.run(&mut step);
        let done = step.done;
        if let Some((event, old)) = done {
            apply_event(&mut flight, next, event, old);
        }
        match exit {
            Exit::Stopped(event) => flight[next].pending = Some(event),
            exit => {
                let mut last = flight.swap_remove(next);
                ended(last.number, &mut last.machine, exit);
                spare.push(last.machine);
            }
        }
    }
}

/// Returns whether the triangle of a fragment is within the window that the oldest triangle in flight begins.
fn is_within(next: usize, triangles: u32, flight: &[Invocation<'_>], fragments: &[PixelFragment<'_>]) -> bool {
    let primitive = |number: usize| fragments.get(number).map_or(0, |(triangle, _)| triangle.primitive);
    let oldest = flight.iter().map(|invocation| primitive(invocation.number)).min();
    oldest.is_none_or(|oldest| primitive(next).saturating_sub(oldest) < triangles.max(1))
}

/// The invocation of a fragment in flight.
struct Invocation<'a> {
    /// The number of its fragment.
    number: usize,
    machine: Machine<'a>,
    /// The event before which it stopped; `None` before its first access.
    pending: Option<Event>,
    /// The word whose change it waits for.
    awaited: Option<WordAddress>,
    /// Whether it is inside the interlock.
    holds_interlock: bool,
}

/// Selects the invocation that continues. `None`: all have ended.
fn choose(flight: &mut [Invocation<'_>], rng: &mut Rng) -> Option<usize> {
    let is_interlocked = flight.iter().any(|invocation| invocation.holds_interlock);
    let is_blocked = |invocation: &Invocation<'_>| is_interlocked && invocation.pending == Some(Event::CriticalBegin);
    let mut ready: Vec<usize> =
        (0..flight.len()).filter(|at| flight[*at].awaited.is_none() && !is_blocked(&flight[*at])).collect();
    if ready.is_empty() {
        // All wait for each other: they retry, as on a GPU.
        flight.iter_mut().for_each(|invocation| invocation.awaited = None);
        ready = (0..flight.len()).filter(|at| !is_blocked(&flight[*at])).collect();
    }
    (!ready.is_empty()).then(|| ready[rng.below(ready.len())])
}

/// Updates the waiting invocations after an event.
fn apply_event(flight: &mut [Invocation<'_>], of: usize, event: Event, old: u64) {
    match event {
        Event::CriticalBegin => flight[of].holds_interlock = true,
        Event::CriticalEnd => flight[of].holds_interlock = false,
        Event::Access(access) if access.writes() => {
            // The old value of a plain store is unknown.
            if access.operation == Operation::Store || access.new_value(old) != old {
                flight
                    .iter_mut()
                    .filter(|other| other.awaited == Some(access.address))
                    .for_each(|other| other.awaited = None);
            } else if is_failed_attempt(&access) {
                flight[of].awaited = Some(access.address);
            }
        }
        _ => {}
    }
}

/// Returns whether an access without effect was a failed attempt, such as at a lock.
fn is_failed_attempt(access: &Access) -> bool {
    matches!(access.operation, Operation::Atomic(Atomic::Exchange | Atomic::CompareExchange))
}

/// Memory for a single step: performs at most one event, then stops the machine.
struct SingleStepMemory<'v, 'a> {
    view: &'v View<'a>,
    may_access: bool,
    done: Option<(Event, u64)>,
}

impl SharedMemory for SingleStepMemory<'_, '_> {
    fn length(&self, buffer: u16) -> u32 {
        self.view.length(buffer)
    }

    fn constant(&self, address: WordAddress) -> u32 {
        self.view.constant(address)
    }

    fn texel(&self, texture: u16, coordinates: [u32; 3]) -> Option<[u32; 4]> {
        self.view.texel(texture, coordinates)
    }

    fn extent(&self, texture: u16) -> [u32; 3] {
        self.view.extent(texture)
    }

    fn event(&mut self, event: &Event) -> Reply {
        if *event == Event::Fence {
            return Reply::Done(0);
        }
        if !self.may_access {
            return Reply::Stop;
        }
        self.may_access = false;
        let old = match event {
            Event::Access(access) => self.view.access(access),
            _ => 0,
        };
        self.done = Some((*event, old));
        Reply::Done(old)
    }
}

/// A seeded generator of random numbers: xorshift (Marsaglia 2003).
struct Rng(u64);

impl Rng {
    fn seeded(seed: u64) -> Self {
        Rng((seed ^ 0x2545_f491_4f6c_dd1d).wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1)
    }

    fn below(&mut self, end: usize) -> usize {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        ((self.0 >> 32) as usize) % end
    }
}
