//! Occupancy culling by its functions, key by key: the range ends where an oracle in plain Rust says, the k best are
//! inside it, and changes to the template that turn fewer away are seen here.

use std::collections::BTreeSet;

use fragbuf_targets::{Checked, check, target};
use fragbuf_checker::Model;
use fragbuf_codegen::{Form, Linking, link, plan};
use fragbuf_interpreter::{Exit, Machine, Options, Program, Sequential};
use fragbuf_model::Origin;
use fragbuf_templates::Registry;
use fragbuf_templates::vocabulary::{Capability, Row, Template};

use crate::mutants::mutants;
use crate::mutation::{Check, Outcome, judge};
use crate::subjects::{limits, report, variant};

/// The functions of one variant. Linking leaves out those that do nothing.
pub(crate) struct Cull {
    measure: Option<Program>,
    occupy: Option<Program>,
    narrow: Option<Program>,
    turns_away: Program,
    words: u32,
}

/// Key of a slot without a fragment, which no fragment has.
const EMPTY: u32 = u32::MAX;

impl Cull {
    pub(crate) fn new(words: u32, registry: &Registry) -> Option<Self> {
        let set = [("cull", "occupancy"), ("cull.words", &*words.to_string())];
        let variant = variant("kplus_array", &set, registry).ok()?;
        let target = target("wgsl").unwrap();
        let selection = variant.select(&[target.offers, &[Capability::OwnEntryPoints]].concat()).unwrap();
        let plan = plan(&variant, &selection, registry).unwrap();
        let linking = Linking { profile: target.profile, form: Form::Program, prefix: String::new(), group: 0 };
        let passes = link(&plan, &linking, registry).ok()?.passes;
        let checked = |anchor: &str| {
            let text = passes.iter().find(|pass| pass.anchor == anchor).unwrap().clone();
            check(text, target.profile, &Origin::new("test", 1, 1)).ok()
        };
        let function = |checked: &Checked, name: &str| {
            Program::function(checked.module(), checked.info(), name, &Options::default()).ok()
        };
        Some(Cull {
            measure: function(&checked("measure")?, "cull_measure"),
            occupy: function(&checked("occupy")?, "cull_occupy"),
            narrow: function(&checked("narrow")?, "cull_narrow"),
            turns_away: function(&checked("store")?, "cull_fragment")?,
            words,
        })
    }

    /// Which of a pixel's fragments are turned away. `None`: some pass does not end, or leaves memory.
    pub(crate) fn turned_away(&self, keys: &[u32], k: u32) -> Option<Vec<bool>> {
        // Two pixels, of which the other stays empty: width, height, first row, k.
        let frame = vec![2, 1, 0, k];
        let mut occupancy = vec![0; 2 * (self.words as usize + 2)];
        for program in [&self.measure, &self.occupy].into_iter().flatten() {
            for key in keys {
                run(program, &[1, *key], &frame, &mut occupancy)?;
            }
        }
        for pixel in [0, 1] {
            if let Some(program) = &self.narrow {
                run(program, &[pixel], &frame, &mut occupancy)?;
            }
        }
        let other = occupancy.iter().step_by(2).all(|word| *word == 0);
        let away = |key: &u32| run(&self.turns_away, &[1, *key], &frame, &mut occupancy).map(|result| result == [1]);
        let away: Option<Vec<bool>> = keys.iter().map(away).collect();
        away.filter(|_| other)
    }
}

/// Runs a function of a pixel, and of an entry whose key is given where it has one.
fn run(program: &Program, arguments: &[u32], frame: &[u32], occupancy: &mut Vec<u32>) -> Option<Vec<u32>> {
    let mut buffers: Vec<Vec<u32>> = program
        .buffers
        .iter()
        .map(|buffer| if buffer.name == "frame" { frame.to_vec() } else { occupancy.clone() })
        .collect();
    let mut machine = Machine::new(program);
    arguments.iter().enumerate().for_each(|(number, word)| machine.set_input(number, &[*word]));
    let exit = machine.run(&mut Sequential { buffers: &mut buffers });
    if exit != Exit::Ended || machine.fault.is_some() {
        return None;
    }
    if let Some(place) = program.buffers.iter().position(|buffer| buffer.name == "occupancy") {
        occupancy.clone_from(&buffers[place]);
    }
    Some(machine.result().to_vec())
}

/// The bucket of a key, in numbers that cannot overflow.
fn bucket(key: u32, near: u32, far: u32, words: u32) -> u64 {
    let (offset, span) = (u64::from(key - near), u64::from(far - near));
    let cut = 1u64 << (64 - span.leading_zeros()).saturating_sub(19);
    offset / cut * u64::from(32 * words) / (span / cut + 1)
}

/// Which fragments the paper turns away: those beyond the bucket of the k-th bit.
fn expected(keys: &[u32], k: u32, words: u32) -> Vec<bool> {
    let (near, far) = (keys.iter().min().copied().unwrap_or(0), keys.iter().max().copied().unwrap_or(0));
    let bits: BTreeSet<u64> = keys.iter().map(|key| bucket(*key, near, far, words)).collect();
    let last = bits.iter().nth(k as usize - 1).copied().unwrap_or(u64::MAX);
    keys.iter().map(|key| bucket(*key, near, far, words) > last).collect()
}

/// Numbers by chance (SplitMix64), the same on every run.
struct Chance(u64);

impl Chance {
    fn below(&mut self, end: u32) -> u32 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut word = self.0;
        word = (word ^ (word >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        word = (word ^ (word >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((word >> 32) % u64::from(end.max(1))) as u32
    }

    /// A key between these, both of them included.
    fn key(&mut self, near: u32, far: u32) -> u32 {
        near + ((u64::from(self.below(u32::MAX)) * (u64::from(far - near) + 1)) >> 32) as u32
    }
}

/// Ranges of keys: one layer, few keys, depths within a binade and over all of them, criteria of either sign, all there is.
fn ranges() -> Vec<(u32, u32)> {
    let bits = f32::to_bits;
    vec![
        (bits(0.5), bits(0.5)),
        (0, 0),
        (bits(1.0), bits(1.0)),
        (bits(0.5), bits(0.5) + 1),
        (bits(0.25) - 3, bits(0.25) + 4),
        (1_000_000, 1_000_000 + (1 << 19) - 1),
        (1_000_000, 1_000_000 + (1 << 19)),
        (bits(0.9), bits(0.97)),
        (0, bits(1.0)),
        (bits(0.001), bits(0.999)),
        (!bits(2.0), bits(3.0) | 1 << 31),
        (0, EMPTY - 1),
        (5, EMPTY - 1),
    ]
}

/// Keys of a pixel by chance, the ends of their range among them, and many on both sides of the borders of buckets.
fn pixel(chance: &mut Chance, (near, far): (u32, u32), count: u32, words: u32) -> Vec<u32> {
    let mut keys: Vec<u32> = (0..count).map(|_| chance.key(near, far)).collect();
    if let [first, second, ..] = &mut keys[..] {
        (*first, *second) = (near, far);
    }
    for index in (2..keys.len()).step_by(3) {
        let wanted = bucket(keys[index], near, far, words);
        let border = border(wanted, near, far, words);
        keys[index] = border;
        if let Some(next) = keys.get_mut(index + 1) {
            *next = border.saturating_sub(1).max(near);
        }
    }
    keys
}

/// The first key of a bucket that holds one.
fn border(wanted: u64, near: u32, far: u32, words: u32) -> u32 {
    let (mut low, mut high) = (near, far);
    while low < high {
        let middle = low + (high - low) / 2;
        if bucket(middle, near, far, words) < wanted { low = middle + 1 } else { high = middle }
    }
    low
}

/// Whether the functions turn away what they should in every pixel; and how many that were.
pub(crate) fn agrees(cull: &Cull, seed: u64) -> Result<usize, String> {
    let mut chance = Chance(seed);
    let mut away = 0;
    for range in ranges() {
        for k in [1, 2, 3, 8, 31, 32, 33] {
            for count in [1, 2, k - 1, k, k + 1, 2 * k, 5 * k + 20] {
                let keys = pixel(&mut chance, range, count, cull.words);
                let seen = cull.turned_away(&keys, k);
                if seen.as_ref() != Some(&expected(&keys, k, cull.words)) {
                    return Err(format!("k = {k}: {keys:x?} gave {seen:?}"));
                }
                away += seen.into_iter().flatten().filter(|away| *away).count();
            }
        }
    }
    Ok(away)
}

#[test]
fn what_lies_beyond_the_kth_bucket_is_turned_away_and_nothing_else() {
    for words in [1, 2, 4, 33, 128] {
        let cull = Cull::new(words, &Registry::builtin()).unwrap();
        let away = (0..3).map(|seed| agrees(&cull, seed).unwrap()).sum::<usize>();
        println!("{words} words: {away} fragments turned away");
        assert!(away > 1000, "{words} words turn away {away}");
    }
}

/// The invariant, apart from what a bucket is: who is turned away has at least k fragments of less and different keys.
#[test]
fn the_k_best_are_never_turned_away() {
    let mut chance = Chance(99);
    for words in [1, 3, 128] {
        let cull = Cull::new(words, &Registry::builtin()).unwrap();
        for range in ranges() {
            for (k, count) in [(1, 2), (2, 3), (4, 4), (4, 5), (8, 100), (32, 200)] {
                let keys = pixel(&mut chance, range, count, words);
                for (key, away) in keys.iter().zip(cull.turned_away(&keys, k).unwrap()) {
                    let better: BTreeSet<&u32> = keys.iter().filter(|other| *other < key).collect();
                    assert!(!away || better.len() >= k as usize, "{key:x} of {keys:x?} for k = {k}");
                }
            }
        }
    }
}

/// Technique, value of the axis, target, model. The passes before the store pass are explored too.
const HOLDS: [(&str, &str, &str, Model); 8] = [
    ("kplus_array", "occupancy", "wgsl", Model::Sequential),
    ("kplus_array", "occupancy", "spirv", Model::Late),
    ("kplus_ab_sb", "occupancy", "wgsl", Model::Sequential),
    ("mdt32_coplanar", "occupancy", "wgsl", Model::Late),
    ("kb_ll", "occupancy", "spirv", Model::Late),
    ("kb_ab_ll", "occupancy", "wgsl", Model::Late),
    ("kplus_array", "occupancy_early", "spirv", Model::Late),
    ("mdt32_coplanar", "occupancy_early", "spirv", Model::Late),
];

#[test]
fn no_order_of_fragments_changes_what_stays() {
    let registry = Registry::builtin();
    for (key, cull, target, model) in HOLDS {
        for words in ["1", "4"] {
            let set = [("cull", cull), ("cull.words", words)];
            let report = report(key, &set, target, &limits(2, model), &registry).unwrap();
            println!("{key} {set:?} {target} {model:?}: {} cases, {} states", report.cases, report.states);
            assert_eq!(report.failure, None, "{key} {set:?} {target} {model:?}");
            assert!(report.is_whole && report.cases >= 100, "{key} {set:?} {target} {model:?}: {}", report.cases);
        }
    }
}

/// Changes that nothing notices: the changed line, what it became, and why.
const SURVIVORS: &[(&str, &str, &str)] = &[
    (
        "occupancy_atomic_max(NEAREST, pixel, ~entry.key);",
        "plainly(NEAREST, pixel, ~entry.key);",
        "a nearest key that is lost makes the range begin too late: what lies before it counts as its first bucket's",
    ),
    (
        "occupancy_atomic_max(NEAREST, pixel, ~entry.key); occupancy_atomic_max(FARTHEST, pixel, entry.key);",
        "occupancy_atomic_max(FARTHEST, pixel, entry.key); occupancy_atomic_max(NEAREST, pixel, ~entry.key);",
        "nobody reads the range before the pass has ended",
    ),
    (
        "occupancy_atomic_or(BITS + bucket / 32u, pixel, 1u << (bucket % 32u));",
        "plainly(BITS + bucket / 32u, pixel, 1u << (bucket % 32u));",
        "where a bit is lost the range ends later: fewer are turned away, and none that may stay",
    ),
];

const ONE_WORD: &[(&str, &str)] = &[("cull", "occupancy"), ("cull.words", "1")];
const CHECKS: &[Check] =
    &[("kplus_array", ONE_WORD, "wgsl", Model::Sequential), ("kplus_array", ONE_WORD, "spirv", Model::Late)];

/// What turns fewer away loses nothing, so that the checker cannot see it: here both see the same changes.
#[test]
fn every_small_change_to_the_template_is_noticed() {
    let builtin = Registry::builtin();
    let row = builtin.row("cull", "occupancy").unwrap();
    let template = row.template.clone().unwrap();
    let (mut noticed, mut survivors) = (0, Vec::new());
    for mutant in mutants(&template.text) {
        let changed = Template::new(template.path.clone(), mutant.text.clone());
        let registry = builtin.clone().with(Row { template: Some(changed), ..row.clone() });
        let is_wrong = |words| match Cull::new(words, &registry) {
            Some(cull) => agrees(&cull, 7).is_err(),
            None => false,
        };
        let outcome = match [1, 4, 128].into_iter().any(is_wrong) {
            true => Outcome::Noticed,
            false => judge("cull", "occupancy", CHECKS, &mutant),
        };
        match outcome {
            Outcome::Noticed => noticed += 1,
            Outcome::Illegal => {}
            Outcome::Survived => survivors.push((mutant.before, mutant.after)),
        }
    }
    println!("{noticed} changes noticed, {} survive", survivors.len());
    let excused: Vec<(String, String)> =
        SURVIVORS.iter().map(|(before, after, _)| ((*before).to_owned(), (*after).to_owned())).collect();
    assert_eq!(survivors, excused, "with the reasons {SURVIVORS:#?}");
    assert!(noticed > 40, "only {noticed} changes");
}
