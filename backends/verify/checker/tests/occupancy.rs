//! Tests the functions of occupancy culling key by key: the bound equals that of an oracle in plain Rust, and the k best
//! are within it. Mutants of the template that cull fewer fragments are killed here.

use std::collections::BTreeSet;

use fragbuf_checker::Model;
use fragbuf_codegen::{Form, Linking, link, plan};
use fragbuf_interpreter::{Bytecode, Exit, Machine, Options, Sequential};
use fragbuf_model::SourceSpan;
use fragbuf_targets::{Checked, check, target};
use fragbuf_templates::Registry;
use fragbuf_templates::vocabulary::{Feature, Row, Template};

use crate::mutants::mutants;
use crate::mutation::{Check, Outcome, outcome};
use crate::subjects::{limits, report, variant};

/// The functions of one variant. The linker drops those that do nothing.
pub(crate) struct Cull {
    key_range: Option<Bytecode>,
    occupancy_map: Option<Bytecode>,
    occupancy_bound: Option<Bytecode>,
    is_culled: Bytecode,
    words: u32,
}

/// The key of an empty slot, which no fragment has.
const EMPTY: u32 = u32::MAX;

impl Cull {
    pub(crate) fn new(words: u32, registry: &Registry) -> Option<Self> {
        let set = [("cull", "occupancy"), ("cull.words", &*words.to_string())];
        let variant = variant("kplus_array", &set, registry).ok()?;
        let target = target("wgsl").unwrap();
        let selection = variant.select(&[target.provides, &[Feature::OwnEntryPoints]].concat()).unwrap();
        let plan = plan(&variant, &selection, registry).unwrap();
        let linking = Linking { profile: target.profile, form: Form::Program, prefix: String::new(), group: 0 };
        let passes = link(&plan, &linking, registry).ok()?.passes;
        let checked = |name: &str| {
            let text = passes.iter().find(|pass| pass.name == name).unwrap().clone();
            check(text, target.profile, &SourceSpan::new("test", 1, 1)).ok()
        };
        let function = |checked: &Checked, name: &str| {
            Bytecode::function(checked.module(), checked.info(), name, &Options::default()).ok()
        };
        Some(Cull {
            key_range: function(&checked("key_range")?, "cull_key_range"),
            occupancy_map: function(&checked("occupancy_map")?, "cull_occupancy_map"),
            occupancy_bound: function(&checked("occupancy_bound")?, "cull_occupancy_bound"),
            is_culled: function(&checked("store")?, "cull_fragment")?,
            words,
        })
    }

    /// Returns which of a pixel's fragments are culled. `None`: a pass does not end, or an index is out of bounds.
    pub(crate) fn culled(&self, keys: &[u32], k: u32) -> Option<Vec<bool>> {
        // Two pixels, of which the first stays empty: width, height, first row, k.
        let frame = vec![2, 1, 0, k];
        let mut occupancy = vec![0; 2 * (self.words as usize + 2)];
        for program in [&self.key_range, &self.occupancy_map].into_iter().flatten() {
            for key in keys {
                run(program, &[1, *key], &frame, &mut occupancy)?;
            }
        }
        for pixel in [0, 1] {
            if let Some(program) = &self.occupancy_bound {
                run(program, &[pixel], &frame, &mut occupancy)?;
            }
        }
        let is_first_empty = occupancy.iter().step_by(2).all(|word| *word == 0);
        let culled = |key: &u32| run(&self.is_culled, &[1, *key], &frame, &mut occupancy).map(|result| result == [1]);
        let culled: Option<Vec<bool>> = keys.iter().map(culled).collect();
        culled.filter(|_| is_first_empty)
    }
}

/// Runs a function of a pixel, and of an entry's key where it has one.
fn run(program: &Bytecode, arguments: &[u32], frame: &[u32], occupancy: &mut Vec<u32>) -> Option<Vec<u32>> {
    let mut buffers: Vec<Vec<u32>> = program
        .buffers
        .iter()
        .map(|buffer| if buffer.name == "frame" { frame.to_vec() } else { occupancy.clone() })
        .collect();
    let mut machine = Machine::new(program);
    arguments.iter().enumerate().for_each(|(number, word)| machine.set_input(number, &[*word]));
    let exit = machine.run(&mut Sequential { buffers: &mut buffers });
    if exit != Exit::Ended || machine.out_of_bounds.is_some() {
        return None;
    }
    if let Some(number) = program.buffers.iter().position(|buffer| buffer.name == "occupancy") {
        occupancy.clone_from(&buffers[number]);
    }
    Some(machine.result().to_vec())
}

/// Returns the bucket of a key, in arithmetic that cannot overflow.
fn bucket(key: u32, near: u32, far: u32, words: u32) -> u64 {
    let (offset, span) = (u64::from(key - near), u64::from(far - near));
    let scale = 1u64 << (64 - span.leading_zeros()).saturating_sub(19);
    offset / scale * u64::from(32 * words) / (span / scale + 1)
}

/// Returns which fragments the paper culls: those beyond the bucket of the k-th bit.
fn expected(keys: &[u32], k: u32, words: u32) -> Vec<bool> {
    let (near, far) = (keys.iter().min().copied().unwrap_or(0), keys.iter().max().copied().unwrap_or(0));
    let bits: BTreeSet<u64> = keys.iter().map(|key| bucket(*key, near, far, words)).collect();
    let last = bits.iter().nth(k as usize - 1).copied().unwrap_or(u64::MAX);
    keys.iter().map(|key| bucket(*key, near, far, words) > last).collect()
}

/// A random number generator (SplitMix64): equal seeds give equal numbers.
struct Rng(u64);

impl Rng {
    fn below(&mut self, end: u32) -> u32 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut word = self.0;
        word = (word ^ (word >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        word = (word ^ (word >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((word >> 32) % u64::from(end.max(1))) as u32
    }

    /// Returns a key from `near` to `far`, both included.
    fn key(&mut self, near: u32, far: u32) -> u32 {
        near + ((u64::from(self.below(u32::MAX)) * (u64::from(far - near) + 1)) >> 32) as u32
    }
}

/// Returns ranges of keys: one layer, few keys, depths within a binade and over all binades, criteria of either sign, all keys.
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

/// Returns random keys of a pixel: both ends of their range, and many on both sides of the edges of buckets.
fn pixel(rng: &mut Rng, (near, far): (u32, u32), count: u32, words: u32) -> Vec<u32> {
    let mut keys: Vec<u32> = (0..count).map(|_| rng.key(near, far)).collect();
    if let [first, second, ..] = &mut keys[..] {
        (*first, *second) = (near, far);
    }
    for index in (2..keys.len()).step_by(3) {
        let wanted = bucket(keys[index], near, far, words);
        let edge = edge(wanted, near, far, words);
        keys[index] = edge;
        if let Some(next) = keys.get_mut(index + 1) {
            *next = edge.saturating_sub(1).max(near);
        }
    }
    keys
}

/// Returns the first key of a bucket that holds one.
fn edge(wanted: u64, near: u32, far: u32, words: u32) -> u32 {
    let (mut low, mut high) = (near, far);
    while low < high {
        let centre = low + (high - low) / 2;
        if bucket(centre, near, far, words) < wanted { low = centre + 1 } else { high = centre }
    }
    low
}

/// Returns how many fragments the functions cull. `Err`: they differ from the oracle in a pixel.
pub(crate) fn agrees(cull: &Cull, seed: u64) -> Result<usize, String> {
    let mut rng = Rng(seed);
    let mut count_culled = 0;
    for range in ranges() {
        for k in [1, 2, 3, 8, 31, 32, 33] {
            for count in [1, 2, k - 1, k, k + 1, 2 * k, 5 * k + 20] {
                let keys = pixel(&mut rng, range, count, cull.words);
                let culled = cull.culled(&keys, k);
                if culled.as_ref() != Some(&expected(&keys, k, cull.words)) {
                    return Err(format!("k = {k}: {keys:x?} gave {culled:?}"));
                }
                count_culled += culled.into_iter().flatten().filter(|is_culled| *is_culled).count();
            }
        }
    }
    Ok(count_culled)
}

#[test]
fn exactly_the_fragments_beyond_the_kth_bucket_are_culled() {
    for words in [1, 2, 4, 33, 128] {
        let cull = Cull::new(words, &Registry::builtin()).unwrap();
        let culled = (0..3).map(|seed| agrees(&cull, seed).unwrap()).sum::<usize>();
        println!("{words} words: {culled} fragments culled");
        assert!(culled > 1000, "{words} words cull {culled}");
    }
}

/// The invariant, independent of buckets: at least k fragments with lesser, different keys are ahead of a culled fragment.
#[test]
fn the_k_best_are_never_culled() {
    let mut rng = Rng(99);
    for words in [1, 3, 128] {
        let cull = Cull::new(words, &Registry::builtin()).unwrap();
        for range in ranges() {
            for (k, count) in [(1, 2), (2, 3), (4, 4), (4, 5), (8, 100), (32, 200)] {
                let keys = pixel(&mut rng, range, count, words);
                for (key, is_culled) in keys.iter().zip(cull.culled(&keys, k).unwrap()) {
                    let better: BTreeSet<&u32> = keys.iter().filter(|other| *other < key).collect();
                    assert!(!is_culled || better.len() >= k as usize, "{key:x} of {keys:x?} for k = {k}");
                }
            }
        }
    }
}

/// Technique, value of the axis, target, model. The passes before the store pass are explored too.
const HOLDS: [(&str, &str, &str, Model); 8] = [
    ("kplus_array", "occupancy", "wgsl", Model::Sequential),
    ("kplus_array", "occupancy", "spirv", Model::Relaxed),
    ("kplus_ab_sb", "occupancy", "wgsl", Model::Sequential),
    ("mdt32_coplanar", "occupancy", "wgsl", Model::Relaxed),
    ("kb_ll", "occupancy", "spirv", Model::Relaxed),
    ("kb_ab_ll", "occupancy", "wgsl", Model::Relaxed),
    ("kplus_array", "occupancy_early", "spirv", Model::Relaxed),
    ("mdt32_coplanar", "occupancy_early", "spirv", Model::Relaxed),
];

#[test]
fn no_order_of_fragments_changes_the_kept_set() {
    let registry = Registry::builtin();
    for (key, cull, target, model) in HOLDS {
        for words in ["1", "4"] {
            let set = [("cull", cull), ("cull.words", words)];
            let report = report(key, &set, target, &limits(2, model), &registry).unwrap();
            println!("{key} {set:?} {target} {model:?}: {} cases, {} states", report.cases, report.states);
            assert_eq!(report.failure, None, "{key} {set:?} {target} {model:?}");
            assert!(report.is_exhaustive && report.cases >= 100, "{key} {set:?} {target} {model:?}: {}", report.cases);
        }
    }
}

/// Mutants that survive: the line, the mutated line, and the reason.
const SURVIVORS: &[(&str, &str, &str)] = &[
    (
        "occupancy_atomic_max(NEAREST, pixel, ~entry.key);",
        "plainly(NEAREST, pixel, ~entry.key);",
        "a lost nearest key makes the range begin too late: keys before it count as in its first bucket",
    ),
    (
        "occupancy_atomic_max(NEAREST, pixel, ~entry.key); occupancy_atomic_max(FARTHEST, pixel, entry.key);",
        "occupancy_atomic_max(FARTHEST, pixel, entry.key); occupancy_atomic_max(NEAREST, pixel, ~entry.key);",
        "no fragment reads the range before the end of the pass",
    ),
    (
        "occupancy_atomic_or(BITS + bucket / 32u, pixel, 1u << (bucket % 32u));",
        "plainly(BITS + bucket / 32u, pixel, 1u << (bucket % 32u));",
        "a lost bit makes the range end later: fewer fragments are culled, and none of the k best",
    ),
];

const ONE_WORD: &[(&str, &str)] = &[("cull", "occupancy"), ("cull.words", "1")];
const CHECKS: &[Check] =
    &[("kplus_array", ONE_WORD, "wgsl", Model::Sequential), ("kplus_array", ONE_WORD, "spirv", Model::Relaxed)];

/// A mutant that culls fewer fragments loses none, so the checker cannot kill it. Here the oracle and the checker are combined.
#[test]
fn every_mutant_of_the_template_is_killed() {
    let builtin = Registry::builtin();
    let row = builtin.row("cull", "occupancy").unwrap();
    let template = row.template.clone().unwrap();
    let (mut killed, mut survivors) = (0, Vec::new());
    for mutant in mutants(&template.source) {
        let changed = Template::new(template.path.clone(), mutant.text.clone());
        let registry = builtin.clone().with(Row { template: Some(changed), ..row.clone() });
        let is_wrong = |words| match Cull::new(words, &registry) {
            Some(cull) => agrees(&cull, 7).is_err(),
            None => false,
        };
        let found = match [1, 4, 128].into_iter().any(is_wrong) {
            true => Outcome::Killed,
            false => outcome("cull", "occupancy", CHECKS, &mutant),
        };
        match found {
            Outcome::Killed => killed += 1,
            Outcome::Illegal => {}
            Outcome::Survived => survivors.push((mutant.before, mutant.after)),
        }
    }
    println!("{killed} mutants killed, {} survive", survivors.len());
    let explained: Vec<(String, String)> =
        SURVIVORS.iter().map(|(before, after, _)| ((*before).to_owned(), (*after).to_owned())).collect();
    assert_eq!(survivors, explained, "with the reasons {SURVIVORS:#?}");
    assert!(killed > 40, "only {killed} mutants");
}
