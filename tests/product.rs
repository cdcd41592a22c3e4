//! Tests every combination of rows. An accepted combination passes naga and every emitter; a rejected one has a diagnostic with help.
//! Rows of an axis with equal capabilities and conditions are equivalent under the rules, so one combination per equivalence class is
//! checked, and for some classes a random one in addition. A covering set also passes glslang, spirv-val and Tint. If naga rejects what
//! the rules accept, fragbuf has a defect.

mod combinations;

use std::collections::{BTreeMap, BTreeSet};
use std::hash::{DefaultHasher, Hash, Hasher};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use combinations::{Combination, INFORMATIVE, Outlook, combinations};
use fragbuf::vocabulary::{Feature, Row, Template};
use fragbuf::{File, Form, Registry, Request, TARGETS, Target, Variant, check, generate};
use fragbuf_codegen::{Linking, Profile, link, plan, verify};
use fragbuf_model::{Alternative, Attribute, Choice, Draft, Format, Keep, KeepCount, Selection, SourceSpan, Spanned};

use crate::cases::{CUSTOM, DEPTH_ONLY, RESERVED, Random, checked, generated, has_empty_list, named, text};
use crate::validators::validate;

/// Returns the payloads, constraints and closures that every combination is checked with.
fn descriptions() -> Vec<Draft> {
    let parsed = |source: &str| fragbuf::parse(source, "case.fragbuf").draft.unwrap();
    vec![
        Draft::from_technique("kb", &SourceSpan::new("case", 1, 1)),
        parsed(CUSTOM),
        parsed(DEPTH_ONLY),
        parsed(RESERVED),
    ]
}

fn chosen(draft: &Draft, choices: &[(String, String)], keep: KeepCount) -> Draft {
    let spanned = |text: &str| Spanned::new(text.to_owned(), SourceSpan::new("case", 1, 1));
    let mut draft = draft.clone();
    draft.preset = None;
    let criterion = draft.keep.take().and_then(|keep| keep.criterion).filter(|_| keep != KeepCount::All);
    draft.keep = Some(Keep { count: Spanned::new(keep, SourceSpan::new("case", 1, 1)), criterion });
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
fn every_combination_generates_or_is_rejected_with_help() {
    let registry = Registry::builtin();
    assert!(registry.rows().iter().all(|row| row.requires.iter().all(|capability| !INFORMATIVE.contains(capability))));
    let combinations = combinations(&registry);
    let descriptions = descriptions();
    let decided = decided(&registry, &descriptions, &combinations);
    let number =
        |decided: &[(usize, Option<Accepted<'_>>)]| decided.iter().map(|(equivalent, _)| equivalent).sum::<usize>();
    let (accepted, rejected): (Vec<_>, Vec<_>) = decided.into_iter().partition(|(_, variant)| variant.is_some());
    let counts = (number(&accepted), number(&rejected));
    let accepted: Vec<Accepted<'_>> = accepted.into_iter().filter_map(|(_, variant)| variant).collect();
    assert!(accepted.len() > 1000 && counts.1 > counts.0, "{counts:?} combinations accepted and rejected");
    let (seen, planned) = (Mutex::new(BTreeSet::new()), Mutex::new(BTreeSet::new()));
    let made = AtomicUsize::new(0);
    // All combinations of the papers' payload, and a covering set of the others.
    let (papers, others): (Vec<_>, Vec<_>) = accepted.iter().partition(|one| one.payload == 0);
    let others = covering(&others);
    let queue = Mutex::new(papers.iter().chain(&others));
    let work = || {
        while let Some(one) = { queue.lock().unwrap().next() } {
            let hashes = pass_hashes(one, &registry, &planned);
            if hashes.into_iter().fold(false, |new, hash| seen.lock().unwrap().insert(hash) | new) {
                made.fetch_add(generated(&one.variant).files.len(), Ordering::Relaxed);
            }
        }
    };
    std::thread::scope(|scope| {
        scope.spawn(work);
        scope.spawn(work);
    });
    let covering: Vec<File> =
        covering(&papers).into_iter().flat_map(|accepted| generated(&accepted.variant).files).collect();
    let external = validate(covering.iter());
    assert!(external > 1000, "{external}");
    println!(
        "product: {} combinations, {} accepted, {} rejected, in {} and {} kinds; {} distinct passes in {} files through \
         naga and the printers; {external} of a covering set through glslang, spirv-val and Tint",
        counts.0 + counts.1,
        counts.0,
        counts.1,
        accepted.len(),
        rejected.len(),
        seen.into_inner().unwrap().len(),
        made.into_inner(),
    );
}

/// The `keep` lines that every combination is checked with.
const KEEPS: [KeepCount; 2] = [KeepCount::AtMost(8), KeepCount::All];

/// Applies the rules to every combination with every description and every `keep`. A combination that no description can make legal is
/// checked with one of them, which a seeded generator chooses: its rejection is certain, its messages are a sample. Returns the number of
/// equivalent combinations, and the variant if it is accepted.
fn decided<'a>(
    registry: &Registry,
    descriptions: &[Draft],
    combinations: &'a [Combination],
) -> Vec<(usize, Option<Accepted<'a>>)> {
    let every: Vec<(usize, KeepCount)> =
        (0..descriptions.len()).flat_map(|payload| KEEPS.map(|keep| (payload, keep))).collect();
    let mut random = Random(7);
    let choose = |combination: &Combination| match combination.outlook {
        Outlook::Open => every.clone(),
        Outlook::Illegal => vec![*random.pick(&every)],
    };
    let with: Vec<Vec<(usize, KeepCount)>> = combinations.iter().map(choose).collect();
    assert_sample(combinations, &with, every.len());
    let decide = |(combination, with): (&'a Combination, &Vec<(usize, KeepCount)>)| {
        let random = combination.random_choices.iter().map(|choices| (0, choices));
        let equivalent = combination.equivalent * every.len() / with.len();
        let tried: Vec<_> = std::iter::once((equivalent, &combination.choices)).chain(random).collect();
        let decided = with.iter().flat_map(|(payload, keep)| tried.iter().map(move |tried| (*payload, *keep, *tried)));
        let decided = decided.map(|(payload, keep, (equivalent, choices))| {
            let variant = checked_with_help(&descriptions[payload], choices, keep, registry);
            assert!(variant.is_none() || combination.outlook == Outlook::Open, "{choices:?} is legal after all");
            (equivalent, variant.map(|variant| Accepted { payload, choices, variant }))
        });
        decided.collect::<Vec<_>>()
    };
    let jobs: Vec<_> = combinations.iter().zip(&with).collect();
    let (first, second) = jobs.split_at(jobs.len() / 2);
    std::thread::scope(|scope| {
        let other = scope.spawn(|| second.iter().copied().flat_map(decide).collect::<Vec<_>>());
        let mut all: Vec<_> = first.iter().copied().flat_map(decide).collect();
        all.extend(other.join().unwrap());
        all
    })
}

/// The sample has every row of enough illegal combinations with every description and `keep`.
fn assert_sample(combinations: &[Combination], with: &[Vec<(usize, KeepCount)>], every: usize) {
    let mut of_row: BTreeMap<&(String, String), (usize, BTreeSet<String>)> = BTreeMap::new();
    for (combination, with) in combinations.iter().zip(with).filter(|(one, _)| one.outlook == Outlook::Illegal) {
        for choice in &combination.choices {
            let (count, seen) = of_row.entry(choice).or_default();
            *count += 1;
            seen.extend(with.iter().map(|with| format!("{with:?}")));
        }
    }
    let covered = of_row.values().filter(|(_, seen)| seen.len() == every).count();
    println!("sample: {covered} of {} rows of illegal combinations with every description", of_row.len());
    let missed = of_row.iter().filter(|(_, (count, seen))| *count > 100 && seen.len() < every);
    assert!(missed.clone().count() == 0 && covered > 50, "{covered} rows, without {:?}", missed.collect::<Vec<_>>());
}

/// Applies the rules to a description with these rows. A rejection has help.
fn checked_with_help(
    description: &Draft,
    choices: &[(String, String)],
    keep: KeepCount,
    registry: &Registry,
) -> Option<Variant> {
    let with = |keep: KeepCount| check(&chosen(description, choices, keep), registry);
    // A row that requires `keep 1` is checked with it.
    let checked = match with(keep) {
        Err(diagnostics) if diagnostics.to_string().contains("`keep 1`") => with(KeepCount::AtMost(1)),
        checked => checked,
    };
    if let Err(diagnostics) = &checked {
        assert!(diagnostics.iter().all(|diagnostic| {
            !diagnostic.help.is_empty() && !has_empty_list(diagnostic) && diagnostic.code.name != "internal"
        }));
    }
    checked.ok()
}

/// Returns a hash per pass and profile: its source without comments, and the uses that emitters depend on. Passes of equal hash are emitted
/// equally. A plan whose passes were all planned before, with the same rows and memory, is not linked again.
fn pass_hashes(accepted: &Accepted<'_>, registry: &Registry, planned: &Mutex<BTreeSet<u64>>) -> Vec<u64> {
    let variant = &accepted.variant;
    let mut known: Vec<(Profile, Selection)> = Vec::new();
    let mut texts = Vec::new();
    for target in TARGETS {
        let provides = [target.provides, &[Feature::OwnEntryPoints]].concat();
        let Ok(selection) = variant.select(&provides) else { continue };
        let one = (target.profile, selection);
        if known.contains(&one) {
            continue;
        }
        let plan = plan(variant, &one.1, registry).unwrap_or_else(|diagnostics| panic!("{diagnostics}"));
        let order = one.1.rows.iter().find_map(|selected| selected.row.order);
        let around = format!("{:?}", (&plan.resources, &plan.fields, &plan.constants, order, variant.keep));
        let mut is_new = false;
        for pass in &plan.passes {
            let mut hasher = DefaultHasher::new();
            (accepted.payload, target.profile, format!("{pass:?}"), &around).hash(&mut hasher);
            is_new |= planned.lock().unwrap().insert(hasher.finish());
        }
        if !is_new {
            known.push(one);
            continue;
        }
        let linking = Linking { profile: one.0, form: Form::Program, prefix: String::new(), group: 0 };
        let program = link(&plan, &linking, registry).unwrap_or_else(|diagnostics| panic!("{diagnostics}"));
        texts.extend(program.passes.iter().zip(&plan.passes).map(|(linked, pass)| {
            let mut hasher = DefaultHasher::new();
            let code = linked.text.lines().filter(|line| !line.trim_start().starts_with("//"));
            code.for_each(|line| line.hash(&mut hasher));
            (target.profile, &pass.name, &plan.requires, format!("{:?}", pass.uses)).hash(&mut hasher);
            hasher.finish()
        }));
        known.push(one);
    }
    assert!(!known.is_empty(), "no target supports an accepted variant");
    texts
}

/// An accepted combination.
struct Accepted<'a> {
    payload: usize,
    choices: &'a [(String, String)],
    variant: Variant,
}

/// Returns a covering set: every pair of values of two axes with every payload that they are accepted with. The order is shuffled, because
/// neighbouring combinations are almost equal.
fn covering<'a, 'b>(accepted: &[&'b Accepted<'a>]) -> Vec<&'b Accepted<'a>> {
    let mut order = accepted.to_vec();
    let mut random = Random(11);
    for index in (1..order.len()).rev() {
        order.swap(index, random.below(index + 1));
    }
    let mut covered: BTreeSet<(usize, [&String; 4])> = BTreeSet::new();
    order.retain(|accepted| {
        let mut more = false;
        for (first, (axis, value)) in accepted.choices.iter().enumerate() {
            for (other_axis, other) in &accepted.choices[first + 1..] {
                more |= covered.insert((accepted.payload, [axis, value, other_axis, other]));
            }
        }
        more
    });
    order
}

#[test]
fn every_named_case_passes_every_validator() {
    let mut files = Vec::new();
    for (name, description, set) in named() {
        let variant = checked(&description, &set).unwrap_or_else(|diagnostics| panic!("{name}: {diagnostics}"));
        files.extend(generated(&variant).files);
    }
    println!("cases: {} files through glslang, spirv-val and Tint", validate(files.iter()));
}

#[test]
fn every_capacity_generates() {
    let mut random = Random(7);
    let ks: Vec<u32> = (0..=10).map(|power| 1 << power).chain((0..5).map(|_| 1 + random.below(1024) as u32)).collect();
    for k in ks {
        let source = format!("buffer B from kplus_array {{ keep {k}; }}");
        let variant = checked(&text(&source), &[]).unwrap_or_else(|diagnostics| panic!("{diagnostics}"));
        let capacity = Some(u64::from(generated(&variant).plans[0].plan.capacity()));
        assert!(capacity.is_some_and(|capacity| capacity >= u64::from(k) && capacity.is_power_of_two()));
    }
}

fn attribute(name: &str, format: Format) -> Attribute {
    let span = SourceSpan::new("case", 1, 1);
    Attribute { name: Spanned::new(name.to_owned(), span.clone()), format: Spanned::new(format, span) }
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
            draft.preset = Some(Spanned::new(preset.to_owned(), draft.name.span.clone()));
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
                Err(diagnostics) => panic!("{}: {diagnostics}", path.display()),
            }
            count += 1;
        }
    }
    assert!(count >= 25, "{count}");
    println!("language: {count} descriptions, {} files through glslang, spirv-val and Tint", validate(files.iter()));
}

/// A checker of interleavings must reject it; all other validators accept it.
#[test]
fn an_algorithm_as_printed_passes_every_validator() {
    let text = include_str!("templates/revised_array_as_printed.wgsl");
    let builtin = Registry::builtin();
    let row = builtin.row("storage", "revised_array").unwrap().clone();
    let registry = builtin.with(Row { template: Some(Template::new("revised_array_as_printed.wgsl", text)), ..row });
    assert_eq!(verify(&registry), Vec::<String>::new());
    let variant =
        check(&Draft::from_technique("kplus_array_revised", &SourceSpan::new("case", 1, 1)), &registry).unwrap();
    let targets: Vec<&'static Target> = TARGETS.iter().collect();
    let request = Request { targets: &targets, form: Form::Program, prefix: "", group: 0 };
    let generation = generate(&variant, &request, &registry).unwrap_or_else(|diagnostics| panic!("{diagnostics}"));
    assert!(validate(generation.files.iter()) > 0);
}

#[test]
fn templates_keep_their_contracts() {
    let diagnostics = verify(&Registry::builtin());
    assert!(diagnostics.is_empty(), "{}", diagnostics.join("\n"));
}
