//! Random drafts and random texts: checking never panics, and what it accepts generates.

use fragbuf::{Registry, check};
use fragbuf_model::{
    Alternative, Attribute, Choice, Draft, Format, Keep, KeepCount, OptionValue, Origin, Spanned, Uniform, UniformType,
};

use crate::cases::{CUSTOM, Random, generated};

const WORDS: [&str; 14] =
    ["color", "depth", "id", "key", "sample", "position", "x", "while", "vec3", "_a", "a_", "limit", "layers", "übel"];

fn spanned<T>(value: T) -> Spanned<T> {
    Spanned::new(value, Origin::new("fuzz", 1, 1))
}

fn word(random: &mut Random) -> Spanned<String> {
    spanned((*random.pick(&WORDS)).to_owned())
}

/// A draft whose words are mostly real ones. Names are a door's to check, so attributes and uniforms have good ones.
fn draft(random: &mut Random, registry: &Registry) -> Draft {
    let techniques: Vec<&str> = registry.techniques().iter().map(|technique| technique.key.as_str()).collect();
    let mut draft = Draft::from_technique(techniques[random.below(techniques.len())], &Origin::new("fuzz", 1, 1));
    if random.below(4) == 0 {
        draft.preset = None;
    }
    for name in ["color", "depth", "id", "key", "sample", "velocity", "velocity_x"] {
        if random.below(3) > 0 {
            let format = if name == "depth" && random.below(8) > 0 { Format::F32 } else { *random.pick(&Format::ALL) };
            draft.attributes.push(Attribute { name: spanned(name.to_owned()), format: spanned(format) });
        }
    }
    if random.below(3) == 0 {
        draft.attributes.clear();
    }
    for name in ["cut", "eye", "discard"] {
        if random.below(2) == 0 {
            let kind = spanned(*random.pick(&UniformType::ALL));
            draft.uniforms.push(Uniform { name: spanned(name.to_owned()), kind });
        }
    }
    if random.below(2) == 0 {
        let count = match random.below(5) {
            0 => KeepCount::All,
            1 => KeepCount::AtMost(random.next() as u32),
            _ => KeepCount::AtMost(1 + random.below(64) as u32),
        };
        draft.keep = Some(Keep { count: spanned(count), criterion: None });
    }
    for _ in 0..random.below(4) {
        draft.choices.push(choice(random, registry));
    }
    draft
}

fn choice(random: &mut Random, registry: &Registry) -> Choice {
    let axis = if random.below(12) == 0 { word(random) } else { spanned(random.pick(registry.axes()).key.to_owned()) };
    let values: Vec<String> = registry.rows_of(&axis.value).map(|row| row.key.clone()).collect();
    let alternatives = (0..1 + random.below(2))
        .map(|_| {
            let value = if values.is_empty() || random.below(12) == 0 {
                word(random)
            } else {
                spanned(random.pick(&values).clone())
            };
            let number = OptionValue::Number(random.below(10_000) as u32);
            let options = (0..random.below(2)).map(|_| (word(random), spanned(number.clone()))).collect();
            Alternative { value, options }
        })
        .collect();
    Choice { axis, alternatives }
}

#[test]
fn what_is_accepted_generates() {
    let registry = Registry::builtin();
    let mut random = Random(2015);
    let (mut accepted, mut refused) = (0, 0);
    for _ in 0..3000 {
        let draft = draft(&mut random, &registry);
        match check(&draft, &registry) {
            Ok(variant) => {
                accepted += 1;
                generated(&variant);
            }
            Err(faults) => {
                refused += 1;
                assert!(faults.iter().all(|fault| !fault.hint.is_empty()));
            }
        }
    }
    println!("fuzz: {accepted} drafts accepted, {refused} refused");
    assert!(accepted > 100 && refused > 100);
}

/// Whole descriptions with words and signs moved about: whatever the parser and the rules let through, naga takes.
#[test]
fn mangled_texts_are_refused_or_generate() {
    let registry = Registry::builtin();
    let mut random = Random(2013);
    let pieces: Vec<&str> = CUSTOM.split_inclusive([' ', ';', '(', ')', '.', ',']).collect();
    let (mut accepted, mut refused) = (0, 0);
    for _ in 0..3000 {
        let mut pieces = pieces.clone();
        for _ in 0..1 + random.below(3) {
            let (at, other) = (random.below(pieces.len()), random.below(pieces.len()));
            match random.below(3) {
                0 => drop(pieces.remove(at)),
                1 => pieces.swap(at, other),
                _ => pieces.insert(at, pieces[other]),
            }
        }
        let parsed = fragbuf::parse(&pieces.concat(), "fuzz.fragbuf");
        let checked = parsed.draft.filter(|_| parsed.diagnostics.is_empty()).map(|draft| check(&draft, &registry));
        match checked {
            Some(Ok(variant)) => {
                accepted += 1;
                generated(&variant);
            }
            _ => refused += 1,
        }
    }
    println!("fuzz: {accepted} texts accepted, {refused} refused");
    assert!(accepted > 20 && refused > 100);
}
