//! Random drafts and descriptions: checking never panics, and accepted ones generate.

use fragbuf::{Registry, check};
use fragbuf_model::{
    Alternative, Attribute, Choice, Draft, Format, Keep, KeepCount, OptionValue, SourceSpan, Spanned, Uniform,
    UniformType,
};

use crate::cases::{CUSTOM, Random, generated, has_empty_list};

const WORDS: [&str; 14] =
    ["color", "depth", "id", "key", "sample", "position", "x", "while", "vec3", "_a", "a_", "limit", "layers", "übel"];

fn spanned<T>(value: T) -> Spanned<T> {
    Spanned::new(value, SourceSpan::new("fuzz", 1, 1))
}

fn word(random: &mut Random) -> Spanned<String> {
    spanned((*random.pick(&WORDS)).to_owned())
}

/// Returns a draft whose names mostly exist. Front ends check attribute and uniform names, so those are valid.
fn draft(random: &mut Random, registry: &Registry) -> Draft {
    let techniques: Vec<&str> = registry.techniques().iter().map(|technique| technique.key.as_str()).collect();
    let mut draft = Draft::from_technique(techniques[random.below(techniques.len())], &SourceSpan::new("fuzz", 1, 1));
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
fn accepted_drafts_generate() {
    let registry = Registry::builtin();
    let mut random = Random(2015);
    let (mut accepted, mut rejected) = (0, 0);
    for _ in 0..3000 {
        let draft = draft(&mut random, &registry);
        match check(&draft, &registry) {
            Ok(variant) => {
                accepted += 1;
                generated(&variant);
            }
            Err(diagnostics) => {
                rejected += 1;
                let helps =
                    |diagnostic: &fragbuf::Diagnostic| !diagnostic.help.is_empty() && !has_empty_list(diagnostic);
                assert!(diagnostics.iter().all(helps), "{diagnostics}");
            }
        }
    }
    println!("fuzz: {accepted} drafts accepted, {rejected} rejected");
    assert!(accepted > 100 && rejected > 100);
}

/// Mutates a description by moving tokens: naga accepts whatever the parser and the rules accept.
#[test]
fn mangled_texts_are_rejected_or_generate() {
    let registry = Registry::builtin();
    let mut random = Random(2013);
    let pieces: Vec<&str> = CUSTOM.split_inclusive([' ', ';', '(', ')', '.', ',']).collect();
    let (mut accepted, mut rejected) = (0, 0);
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
            _ => rejected += 1,
        }
    }
    println!("fuzz: {accepted} texts accepted, {rejected} rejected");
    assert!(accepted > 20 && rejected > 100);
}
