//! Measures what checksums and repairs save: fragments lost by `kb` and by `kb_mha`.
//!
//! Explored are all interleavings of the accesses of two fragments with two entries, and of three with one. Three fragments
//! with two entries have too many interleavings, so random ones are sampled. Each interleaving counts once: a mean is over
//! all interleavings of single accesses, not over those that a GPU produces. Memory is sequential. A fragment is lost if no
//! slot holds its words, whatever the checksum is.

use std::collections::HashMap;
use std::hash::{Hash, Hasher};

use fragbuf_codegen::{Form, Linking, SymbolId, link, plan};
use fragbuf_interpreter::{Bytecode, Event, Exit, Machine, Options, Reply, SharedMemory, WordAddress};
use fragbuf_model::SourceSpan;
use fragbuf_targets::check;
use fragbuf_templates::Registry;

use crate::subjects::{target, variant};

const EMPTY: u32 = u32::MAX;

/// Depth and colour of a fragment.
type Fragment = (f32, u32);

/// The store pass of a technique on one pixel.
struct Pixel {
    /// Entries.
    k: usize,
    program: Bytecode,
    /// The words of each buffer of the program when nothing has been stored.
    empty: Vec<Vec<u32>>,
    keys: usize,
    entries: usize,
}

/// Memory, and the saved words of each fragment; `None` where it has ended.
#[derive(Clone, Hash)]
struct State {
    /// Keys, then entries.
    words: Vec<u32>,
    fragments: Vec<Option<Vec<u32>>>,
}

/// Losses over all interleavings from a state to the final states.
#[derive(Clone, Copy, Default, Debug)]
struct Losses {
    interleavings: f64,
    /// The sum of lost fragments.
    lost: f64,
    /// Interleavings that lose a fragment.
    lossy: f64,
}

impl Losses {
    fn and(self, other: Losses) -> Losses {
        Losses {
            interleavings: self.interleavings + other.interleavings,
            lost: self.lost + other.lost,
            lossy: self.lossy + other.lossy,
        }
    }
}

impl Pixel {
    fn of(key: &str, k: usize) -> Self {
        let (registry, wgsl) = (Registry::builtin(), target("wgsl"));
        let variant = variant(key, &[("k", &k.to_string()), ("counters", "none")], &registry).unwrap();
        let plan = plan(&variant, &variant.select(wgsl.provides).unwrap(), &registry).unwrap();
        let linking = Linking { profile: wgsl.profile, form: Form::Program, prefix: String::new(), group: 0 };
        let passes = link(&plan, &linking, &registry).unwrap().passes;
        let store = passes.into_iter().find(|pass| pass.name == "store").unwrap();
        let checked = check(store, wgsl.profile, &SourceSpan::new("test", 1, 1)).unwrap();
        let program = Bytecode::entry_point(checked.module(), checked.info(), "store", &Options::default()).unwrap();
        let words = |name: &str| match name {
            "frame" => plan.fields.iter().map(|field| if *field == SymbolId::K { k as u32 } else { 1 }).collect(),
            "keys" => vec![EMPTY; k],
            "entries" => vec![0; k],
            other => panic!("the store pass accesses `{other}`"),
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

    /// Stores one fragment while no other runs.
    fn store_alone(&self, memory: &mut Vec<Vec<u32>>, fragment: Fragment) {
        let exit = self.machine(fragment).run(&mut fragbuf_interpreter::Sequential { buffers: memory });
        assert_eq!(exit, Exit::Ended);
    }

    /// Returns the state with each of `new` before its first access, after `prior`; and the fragments that should be kept.
    fn start(&self, prior: &[Fragment], new: &[Fragment]) -> (State, Vec<Fragment>) {
        let mut memory = self.empty.clone();
        prior.iter().for_each(|fragment| self.store_alone(&mut memory, *fragment));
        let mut expected: Vec<Fragment> = [prior, new].concat();
        expected.sort_by(|a, b| a.0.total_cmp(&b.0));
        expected.truncate(self.k);
        let mut words = [memory[self.keys].clone(), memory[self.entries].clone()].concat();
        let fragments = new.iter().map(|fragment| self.run(&mut self.machine(*fragment), None, &mut words)).collect();
        (State { words, fragments }, expected)
    }

    /// Explores every interleaving.
    fn interleavings(&self, prior: &[Fragment], new: &[Fragment]) -> Losses {
        let (start, expected) = self.start(prior, new);
        self.losses(&mut Machine::new(&self.program), &start, &expected, &mut HashMap::new())
    }

    /// Samples random interleavings: at every step any fragment that still runs.
    fn random_interleavings(&self, prior: &[Fragment], new: &[Fragment], count: u32) -> Losses {
        let (start, expected) = self.start(prior, new);
        let mut machine = Machine::new(&self.program);
        let (mut sum, mut random) = (Losses::default(), 0x9e37_79b9_7f4a_7c15_u64);
        for _ in 0..count {
            let mut state = start.clone();
            loop {
                let running: Vec<usize> = (0..new.len()).filter(|at| state.fragments[*at].is_some()).collect();
                if running.is_empty() {
                    break;
                }
                random ^= random << 13;
                random ^= random >> 7;
                random ^= random << 17;
                let at = running[((random >> 33) % running.len() as u64) as usize];
                machine.load(state.fragments[at].as_ref().unwrap());
                state.fragments[at] = self.run(&mut machine, Some(()), &mut state.words);
            }
            sum = sum.and(self.end(&state, &expected));
        }
        sum
    }

    /// Returns the losses of one interleaving, from its final state.
    fn end(&self, state: &State, expected: &[Fragment]) -> Losses {
        let lost = expected.iter().filter(|fragment| !holds(&state.words, **fragment)).count();
        Losses { interleavings: 1.0, lost: lost as f64, lossy: f64::from(u8::from(lost > 0)) }
    }

    /// Runs a machine to its next access; `first`: performs the access at which it has stopped.
    fn run(&self, machine: &mut Machine<'_>, first: Option<()>, words: &mut [u32]) -> Option<Vec<u32>> {
        match machine.run(&mut OneAccess { pixel: self, words, allowed: first }) {
            Exit::Ended => None,
            Exit::Stopped(Event::Access(_)) => {
                let mut saved = Vec::new();
                machine.save(&mut saved);
                Some(saved)
            }
            other => panic!("a fragment stops at {other:?}"),
        }
    }

    fn losses<'p>(
        &'p self,
        machine: &mut Machine<'p>,
        state: &State,
        expected: &[Fragment],
        known: &mut HashMap<u128, Losses>,
    ) -> Losses {
        let print = fingerprint(state);
        if let Some(losses) = known.get(&print) {
            return *losses;
        }
        let mut sum = Losses::default();
        for (at, saved) in state.fragments.iter().enumerate() {
            let Some(saved) = saved else { continue };
            let mut next = state.clone();
            machine.load(saved);
            next.fragments[at] = self.run(machine, Some(()), &mut next.words);
            sum = sum.and(self.losses(machine, &next, expected, known));
        }
        if sum.interleavings == 0.0 {
            sum = self.end(state, expected);
        }
        known.insert(print, sum);
        sum
    }
}

/// Returns whether a slot holds both words of a fragment. No depth uses the two highest bits, which may hold a checksum.
fn holds(words: &[u32], (depth, color): Fragment) -> bool {
    let (keys, entries) = words.split_at(words.len() / 2);
    keys.iter().zip(entries).any(|(key, entry)| (key & 0x3fff_ffff, *entry) == (depth.to_bits(), color))
}

/// Returns two hashes of a state, with different seeds.
fn fingerprint(state: &State) -> u128 {
    let half = |seed: u64| {
        let mut hasher = std::hash::DefaultHasher::new();
        (seed, state).hash(&mut hasher);
        u128::from(hasher.finish())
    };
    half(1) << 64 | half(2)
}

/// Memory that performs one access at most, and stops before the next.
struct OneAccess<'a> {
    pixel: &'a Pixel,
    words: &'a mut [u32],
    allowed: Option<()>,
}

impl SharedMemory for OneAccess<'_> {
    fn length(&self, buffer: u16) -> u32 {
        self.pixel.empty[usize::from(buffer)].len() as u32
    }

    fn constant(&self, address: WordAddress) -> u32 {
        self.pixel.empty[usize::from(address.buffer)][address.word as usize]
    }

    fn event(&mut self, event: &Event) -> Reply {
        let (Some(()), Event::Access(access)) = (self.allowed.take(), event) else { return Reply::Stop };
        let first = if usize::from(access.address.buffer) == self.pixel.keys { 0 } else { self.pixel.k };
        let word = &mut self.words[first + access.address.word as usize];
        let old = u64::from(*word);
        *word = access.new_value(old) as u32;
        Reply::Done(old)
    }
}

const NEW: [Fragment; 3] = [(0.5, 0x8012_ff40), (0.25, 0xff03_2190), (0.375, 0x4099_0177)];
const FARTHER: [Fragment; 2] = [(0.75, 0xc0ff_0011), (0.875, 0x2000_ffee)];

/// Prints the losses of both techniques. The second must lose less.
fn compare(k: usize, what: &str, losses: impl Fn(&Pixel) -> Losses) {
    let [plain, repaired] = ["kb", "kb_mha"].map(|key| {
        let losses = losses(&Pixel::of(key, k));
        println!(
            "{key}, k = {k}, {what}: {:.3e} interleavings, mean loss {:.4}, {:.2} % lose a fragment",
            losses.interleavings,
            losses.lost / losses.interleavings,
            100.0 * losses.lossy / losses.interleavings
        );
        losses
    });
    assert!(plain.lossy > 0.0, "k = {k}, {what}: nothing races");
    assert!(repaired.lost / repaired.interleavings < plain.lost / plain.interleavings, "k = {k}, {what}");
}

#[test]
fn repairs_lose_fewer_fragments() {
    for (prior, what) in [(&FARTHER[..0], "initially empty"), (&FARTHER[..], "initially full")] {
        compare(2, &format!("{what}, every interleaving of 2"), |pixel| pixel.interleavings(prior, &NEW[..2]));
        compare(2, &format!("{what}, random interleavings of 3"), |pixel| {
            pixel.random_interleavings(prior, &NEW, 20_000)
        });
    }
    compare(1, "initially empty, every interleaving of 2", |pixel| pixel.interleavings(&[], &NEW[..2]));
    compare(1, "initially empty, every interleaving of 3", |pixel| pixel.interleavings(&[], &NEW));
}

#[test]
fn sequential_fragments_are_not_lost() {
    for key in ["kb", "kb_mha"] {
        let pixel = Pixel::of(key, 2);
        let mut memory = pixel.empty.clone();
        NEW.iter().for_each(|fragment| pixel.store_alone(&mut memory, *fragment));
        let words = [memory[pixel.keys].clone(), memory[pixel.entries].clone()].concat();
        assert_eq!(NEW.map(|fragment| holds(&words, fragment)), [false, true, true], "{key}");
    }
}
