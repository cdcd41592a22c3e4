//! What checksums and second looks are worth: fragments lost by `kb` and by `kb_mha`.
//!
//! Every order of the accesses of two fragments at two entries, and of three at one; of three at two, where there are too
//! many, the same number of orders by chance. Each order counts once, so a mean is one over all interleavings of single
//! accesses, not over what a GPU does. Memory behaves. What is lost is looked for in the slots, past the checksum.

use std::collections::HashMap;
use std::hash::{Hash, Hasher};

use fragbuf_targets::check;
use fragbuf_codegen::{Form, Linking, SymbolId, link, plan};
use fragbuf_interpreter::{Event, Exit, Machine, Options, Place, Program, Reply, Shared};
use fragbuf_model::Origin;
use fragbuf_templates::Registry;

use crate::subjects::{target, variant};

const EMPTY: u32 = u32::MAX;

/// Depth and colour of a fragment.
type Fragment = (f32, u32);

/// The store pass of a technique on one pixel.
struct Pixel {
    /// Entries.
    k: usize,
    program: Program,
    /// The words of each buffer of the program when nothing has been stored.
    empty: Vec<Vec<u32>>,
    keys: usize,
    entries: usize,
}

/// Memory, and where each fragment stands; nothing where it has ended.
#[derive(Clone, Hash)]
struct State {
    /// Keys, then entries.
    words: Vec<u32>,
    fragments: Vec<Option<Vec<u32>>>,
}

/// Over all orders from a state to the ends.
#[derive(Clone, Copy, Default, Debug)]
struct Tally {
    orders: f64,
    /// The sum of fragments that are lost.
    lost: f64,
    /// Orders that lose any.
    lossy: f64,
}

impl Tally {
    fn and(self, other: Tally) -> Tally {
        Tally { orders: self.orders + other.orders, lost: self.lost + other.lost, lossy: self.lossy + other.lossy }
    }
}

impl Pixel {
    fn of(key: &str, k: usize) -> Self {
        let (registry, wgsl) = (Registry::builtin(), target("wgsl"));
        let variant = variant(key, &[("k", &k.to_string()), ("counters", "none")], &registry).unwrap();
        let plan = plan(&variant, &variant.select(wgsl.offers).unwrap(), &registry).unwrap();
        let linking = Linking { profile: wgsl.profile, form: Form::Program, prefix: String::new(), group: 0 };
        let passes = link(&plan, &linking, &registry).unwrap().passes;
        let store = passes.into_iter().find(|pass| pass.anchor == "store").unwrap();
        let checked = check(store, wgsl.profile, &Origin::new("test", 1, 1)).unwrap();
        let program = Program::entry_point(checked.module(), checked.info(), "store", &Options::default()).unwrap();
        let words = |name: &str| match name {
            "frame" => plan.fields.iter().map(|field| if *field == SymbolId::K { k as u32 } else { 1 }).collect(),
            "keys" => vec![EMPTY; k],
            "entries" => vec![0; k],
            other => panic!("the store pass touches `{other}`"),
        };
        // `frame.first_row` is the row of the only pixel.
        let mut empty: Vec<Vec<u32>> = program.buffers.iter().map(|buffer| words(&buffer.name)).collect();
        let number = |name: &str| program.buffers.iter().position(|buffer| buffer.name == name).unwrap();
        let (keys, entries, frame) = (number("keys"), number("entries"), number("frame"));
        empty[frame][plan.fields.iter().position(|field| *field == SymbolId::FIRST_ROW).unwrap()] = 0;
        Pixel { k, empty, keys, entries, program }
    }

    fn machine(&self, (depth, color): Fragment) -> Machine<'_> {
        let mut machine = Machine::new(&self.program);
        for (number, input) in self.program.inputs.iter().enumerate() {
            let values = match input.location() {
                None => [0.5, 0.5, depth, 1.0],
                Some(_) => color.to_le_bytes().map(|channel| f32::from(channel) / 255.0),
            };
            machine.set_input(number, &values.map(f32::to_bits));
        }
        machine
    }

    /// Stores one fragment with nobody else there.
    fn alone(&self, memory: &mut Vec<Vec<u32>>, fragment: Fragment) {
        let exit = self.machine(fragment).run(&mut fragbuf_interpreter::Sequential { buffers: memory });
        assert_eq!(exit, Exit::Ended);
    }

    /// `new`, each before its first access, after `prior`; and which of all should be kept.
    fn start(&self, prior: &[Fragment], new: &[Fragment]) -> (State, Vec<Fragment>) {
        let mut memory = self.empty.clone();
        prior.iter().for_each(|fragment| self.alone(&mut memory, *fragment));
        let mut wanted: Vec<Fragment> = [prior, new].concat();
        wanted.sort_by(|a, b| a.0.total_cmp(&b.0));
        wanted.truncate(self.k);
        let mut words = [memory[self.keys].clone(), memory[self.entries].clone()].concat();
        let fragments = new.iter().map(|fragment| self.run(&mut self.machine(*fragment), None, &mut words)).collect();
        (State { words, fragments }, wanted)
    }

    /// Every order.
    fn orders(&self, prior: &[Fragment], new: &[Fragment]) -> Tally {
        let (start, wanted) = self.start(prior, new);
        self.tally(&mut Machine::new(&self.program), &start, &wanted, &mut HashMap::new())
    }

    /// Orders by chance: at every step any fragment that still runs.
    fn some_orders(&self, prior: &[Fragment], new: &[Fragment], count: u32) -> Tally {
        let (start, wanted) = self.start(prior, new);
        let mut machine = Machine::new(&self.program);
        let (mut sum, mut chance) = (Tally::default(), 0x9e37_79b9_7f4a_7c15_u64);
        for _ in 0..count {
            let mut state = start.clone();
            loop {
                let running: Vec<usize> = (0..new.len()).filter(|at| state.fragments[*at].is_some()).collect();
                if running.is_empty() {
                    break;
                }
                chance ^= chance << 13;
                chance ^= chance >> 7;
                chance ^= chance << 17;
                let at = running[((chance >> 33) % running.len() as u64) as usize];
                machine.load(state.fragments[at].as_ref().unwrap());
                state.fragments[at] = self.run(&mut machine, Some(()), &mut state.words);
            }
            sum = sum.and(self.end(&state, &wanted));
        }
        sum
    }

    /// One order, at its end.
    fn end(&self, state: &State, wanted: &[Fragment]) -> Tally {
        let lost = wanted.iter().filter(|fragment| !holds(&state.words, **fragment)).count();
        Tally { orders: 1.0, lost: lost as f64, lossy: f64::from(u8::from(lost > 0)) }
    }

    /// Up to the next access: `first` is let through.
    fn run(&self, machine: &mut Machine<'_>, first: Option<()>, words: &mut [u32]) -> Option<Vec<u32>> {
        match machine.run(&mut OneAccess { pixel: self, words, left: first }) {
            Exit::Ended => None,
            Exit::Stopped(Event::Access(_)) => {
                let mut saved = Vec::new();
                machine.save(&mut saved);
                Some(saved)
            }
            other => panic!("a fragment comes to {other:?}"),
        }
    }

    fn tally<'p>(
        &'p self,
        machine: &mut Machine<'p>,
        state: &State,
        wanted: &[Fragment],
        known: &mut HashMap<u128, Tally>,
    ) -> Tally {
        let print = fingerprint(state);
        if let Some(tally) = known.get(&print) {
            return *tally;
        }
        let mut sum = Tally::default();
        for (at, saved) in state.fragments.iter().enumerate() {
            let Some(saved) = saved else { continue };
            let mut next = state.clone();
            machine.load(saved);
            next.fragments[at] = self.run(machine, Some(()), &mut next.words);
            sum = sum.and(self.tally(machine, &next, wanted, known));
        }
        if sum.orders == 0.0 {
            sum = self.end(state, wanted);
        }
        known.insert(print, sum);
        sum
    }
}

/// Whether a slot has both words of a fragment. No depth has the two highest bits, where a checksum may stand.
fn holds(words: &[u32], (depth, color): Fragment) -> bool {
    let (keys, entries) = words.split_at(words.len() / 2);
    keys.iter().zip(entries).any(|(key, entry)| (key & 0x3fff_ffff, *entry) == (depth.to_bits(), color))
}

/// Two hashes of a state, with different seeds.
fn fingerprint(state: &State) -> u128 {
    let half = |seed: u64| {
        let mut hasher = std::hash::DefaultHasher::new();
        (seed, state).hash(&mut hasher);
        u128::from(hasher.finish())
    };
    half(1) << 64 | half(2)
}

/// Memory that lets one access happen, if any, and stops before the next.
struct OneAccess<'a> {
    pixel: &'a Pixel,
    words: &'a mut [u32],
    left: Option<()>,
}

impl Shared for OneAccess<'_> {
    fn length(&self, buffer: u16) -> u32 {
        self.pixel.empty[usize::from(buffer)].len() as u32
    }

    fn constant(&self, place: Place) -> u32 {
        self.pixel.empty[usize::from(place.buffer)][place.word as usize]
    }

    fn event(&mut self, event: &Event) -> Reply {
        let (Some(()), Event::Access(access)) = (self.left.take(), event) else { return Reply::Stop };
        let first = if usize::from(access.place.buffer) == self.pixel.keys { 0 } else { self.pixel.k };
        let word = &mut self.words[first + access.place.word as usize];
        let old = u64::from(*word);
        *word = access.new_value(old) as u32;
        Reply::Done(old)
    }
}

const NEW: [Fragment; 3] = [(0.5, 0x8012_ff40), (0.25, 0xff03_2190), (0.375, 0x4099_0177)];
const FARTHER: [Fragment; 2] = [(0.75, 0xc0ff_0011), (0.875, 0x2000_ffee)];

/// Prints what both techniques lose; the second must lose less.
fn compare(k: usize, what: &str, losses: impl Fn(&Pixel) -> Tally) {
    let [plain, mended] = ["kb", "kb_mha"].map(|key| {
        let tally = losses(&Pixel::of(key, k));
        println!(
            "{key}, k = {k}, {what}: {:.3e} orders, {:.4} lost in the mean, {:.2} % lose any",
            tally.orders,
            tally.lost / tally.orders,
            100.0 * tally.lossy / tally.orders
        );
        tally
    });
    assert!(plain.lossy > 0.0, "k = {k}, {what}: nothing races");
    assert!(mended.lost / mended.orders < plain.lost / plain.orders, "k = {k}, {what}");
}

#[test]
fn looking_twice_loses_fewer_fragments() {
    for (prior, what) in [(&FARTHER[..0], "empty before"), (&FARTHER[..], "full before")] {
        compare(2, &format!("{what}, every order of 2"), |pixel| pixel.orders(prior, &NEW[..2]));
        compare(2, &format!("{what}, some orders of 3"), |pixel| pixel.some_orders(prior, &NEW, 20_000));
    }
    compare(1, "empty before, every order of 2", |pixel| pixel.orders(&[], &NEW[..2]));
    compare(1, "empty before, every order of 3", |pixel| pixel.orders(&[], &NEW));
}

#[test]
fn one_after_the_other_nothing_is_lost() {
    for key in ["kb", "kb_mha"] {
        let pixel = Pixel::of(key, 2);
        let mut memory = pixel.empty.clone();
        NEW.iter().for_each(|fragment| pixel.alone(&mut memory, *fragment));
        let words = [memory[pixel.keys].clone(), memory[pixel.entries].clone()].concat();
        assert_eq!(NEW.map(|fragment| holds(&words, fragment)), [false, true, true], "{key}");
    }
}
