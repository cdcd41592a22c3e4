//! Every combination of rows: what the rules accept goes through naga and every printer, what they refuse says why. A
//! covering set goes through glslang and spirv-val too. naga refusing what the rules accept is our defect by definition.

use std::collections::BTreeSet;

use fragbuf::{File, Registry, check};
use fragbuf_codegen::verify;
use fragbuf_model::{Alternative, Attribute, Choice, Draft, Format, Keep, KeepCount, Origin, Spanned};

use crate::cases::{CUSTOM, DEPTH_ONLY, RESERVED, Random, checked, generated, named, text};
use crate::validators::validate;

/// Payloads, constraints and closures that every combination of rows is tried with.
fn descriptions() -> Vec<Draft> {
    let parsed = |source: &str| fragbuf::parse(source, "case.fragbuf").draft.unwrap();
    vec![Draft::from_technique("kb", &Origin::new("case", 1, 1)), parsed(CUSTOM), parsed(DEPTH_ONLY), parsed(RESERVED)]
}

/// Every choice of one row per axis.
fn combinations(registry: &Registry) -> Vec<Vec<(String, String)>> {
    let mut all: Vec<Vec<(String, String)>> = vec![Vec::new()];
    for axis in registry.axes().iter().filter(|axis| axis.chosen && axis.key != Registry::CLOSURE_AXIS) {
        let values: Vec<String> = registry.rows_of(axis.key).map(|row| row.key.clone()).collect();
        all = all
            .into_iter()
            .flat_map(|choices| {
                values.iter().map(move |value| [choices.clone(), vec![(axis.key.to_owned(), value.clone())]].concat())
            })
            .collect();
    }
    all
}

fn chosen(draft: &Draft, choices: &[(String, String)], keep: KeepCount) -> Draft {
    let spanned = |text: &str| Spanned::new(text.to_owned(), Origin::new("case", 1, 1));
    let mut draft = draft.clone();
    draft.preset = None;
    let criterion = draft.keep.take().and_then(|keep| keep.criterion).filter(|_| keep != KeepCount::All);
    draft.keep = Some(Keep { count: Spanned::new(keep, Origin::new("case", 1, 1)), criterion });
    draft.choices = choices
        .iter()
        .map(|(axis, value)| Choice {
            axis: spanned(axis),
            alternatives: vec![Alternative { value: spanned(value), options: Vec::new() }],
        })
        .collect();
    draft
}

#[test]
fn every_combination_generates_or_is_refused_with_a_way_out() {
    let registry = Registry::builtin();
    let combinations = combinations(&registry);
    let descriptions = descriptions();
    let parts: Vec<Part> = std::thread::scope(|scope| {
        let (combinations, registry) = (&combinations, &registry);
        let tried = |description| scope.spawn(move || Part::of(description, combinations, registry));
        let running: Vec<_> = descriptions.iter().map(tried).collect();
        running.into_iter().map(|part| part.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic))).collect()
    });
    let accepted: usize = parts.iter().map(|part| part.accepted).sum();
    let refused: usize = parts.iter().map(|part| part.refused).sum();
    let texts: BTreeSet<&Vec<u8>> = parts.iter().flat_map(|part| &part.texts).collect();
    assert!(accepted > 100 && refused > accepted, "{accepted} accepted, {refused} refused");
    let external = validate(parts.iter().flat_map(|part| &part.covering));
    assert!(external > 100);
    println!(
        "product: {} combinations, {accepted} accepted, {refused} refused; {} distinct files through naga and the \
         printers; {external} of a covering set through glslang and spirv-val",
        accepted + refused,
        texts.len()
    );
}

/// What came of one description with every combination of rows.
#[derive(Default)]
struct Part {
    accepted: usize,
    refused: usize,
    texts: BTreeSet<Vec<u8>>,
    covering: Vec<File>,
}

impl Part {
    fn of(description: &Draft, combinations: &[Vec<(String, String)>], registry: &Registry) -> Self {
        let mut part = Part::default();
        let mut covered: BTreeSet<Vec<String>> = BTreeSet::new();
        for choices in combinations {
            for keep in [KeepCount::AtMost(8), KeepCount::All] {
                match check(&chosen(description, choices, keep), registry) {
                    Err(faults) => {
                        part.refused += 1;
                        assert!(faults.iter().all(|fault| !fault.hint.is_empty() && fault.code.name != "internal"));
                    }
                    Ok(variant) => {
                        part.accepted += 1;
                        let generation = generated(&variant);
                        assert!(!generation.plans.is_empty(), "some target can express whatever is accepted");
                        let files = generation.files;
                        if covers_more(choices, &mut covered) {
                            part.covering.extend(files.iter().cloned());
                        }
                        part.texts.extend(files.into_iter().map(|file| file.bytes));
                    }
                }
            }
        }
        part
    }
}

/// Whether a combination has two values of two axes together that none before had with this description: three, with it.
fn covers_more(choices: &[(String, String)], covered: &mut BTreeSet<Vec<String>>) -> bool {
    let values: Vec<&String> = choices.iter().map(|(_, value)| value).collect();
    let mut more = false;
    for first in 0..values.len() {
        for second in first + 1..values.len() {
            let names =
                [choices[first].0.clone(), values[first].clone(), choices[second].0.clone(), values[second].clone()];
            more |= covered.insert(names.to_vec());
        }
    }
    more
}

#[test]
fn every_named_case_passes_every_validator() {
    let mut files = Vec::new();
    for (name, description, set) in named() {
        let variant = checked(&description, &set).unwrap_or_else(|faults| panic!("{name}: {faults}"));
        files.extend(generated(&variant).files);
    }
    println!("cases: {} files through glslang and spirv-val", validate(files.iter()));
}

#[test]
fn every_capacity_generates() {
    let mut random = Random(7);
    let ks: Vec<u32> = (0..=10).map(|power| 1 << power).chain((0..5).map(|_| 1 + random.below(1024) as u32)).collect();
    for k in ks {
        let source = format!("buffer B from kplus_array {{ keep {k}; }}");
        let variant = checked(&text(&source), &[]).unwrap_or_else(|faults| panic!("{faults}"));
        let capacity = generated(&variant).plans[0].plan.bound.value("capacity");
        assert!(capacity.is_some_and(|capacity| capacity >= u64::from(k) && capacity.is_power_of_two()));
    }
}

fn attribute(name: &str, format: Format) -> Attribute {
    let origin = Origin::new("case", 1, 1);
    Attribute { name: Spanned::new(name.to_owned(), origin.clone()), format: Spanned::new(format, origin) }
}

/// Every construct and method of the closure language, as `dsl/syntax` lowers it, through naga and the printers.
#[test]
fn every_construct_of_the_language_generates() {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("dsl/syntax/tests/good");
    let mut files = Vec::new();
    let mut count = 0;
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_some_and(|extension| extension == "fragbuf") {
            let source = std::fs::read_to_string(&path).unwrap();
            let parsed = fragbuf::parse(&source, "good.fragbuf");
            assert!(parsed.diagnostics.is_empty(), "{}: {}", path.display(), parsed.diagnostics);
            let mut draft = parsed.draft.unwrap();
            // These descriptions are about closures: whatever else they say, a storage that exists runs them.
            draft.choices.clear();
            if let Some(keep) = draft.keep.as_mut().filter(|keep| keep.criterion.is_some()) {
                keep.count.value = KeepCount::AtMost(8);
            }
            let all = draft.keep.as_ref().is_some_and(|keep| keep.count.value == KeepCount::All);
            let preset = if all { "ab_ll" } else { "kplus_array" };
            draft.preset = Some(Spanned::new(preset.to_owned(), draft.name.origin.clone()));
            let has = |name: &str| draft.attributes.iter().any(|attribute| attribute.name.value == name);
            let (no_color, no_depth) = (!has("color"), !has("depth"));
            if !draft.attributes.is_empty() && draft.resolve.is_none() && no_color {
                draft.attributes.push(attribute("color", Format::Rgba8));
            }
            if !draft.attributes.is_empty() && no_depth {
                draft.attributes.push(attribute("depth", Format::F32));
            }
            match check(&draft, &Registry::builtin()) {
                Ok(variant) => files.extend(generated(&variant).files),
                Err(faults) => panic!("{}: {faults}", path.display()),
            }
            count += 1;
        }
    }
    assert!(count >= 25, "{count}");
    println!("language: {count} descriptions, {} files through glslang and spirv-val", validate(files.iter()));
}

#[test]
fn templates_keep_their_contracts() {
    let faults = verify(&Registry::builtin());
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}
