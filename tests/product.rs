//! Every combination of rows: what the rules accept goes through naga and every printer, what they refuse says why. Rows of an
//! axis that state the same facts and conditions are interchangeable to the rules, so one combination of each kind is decided, and of
//! some kinds another, drawn by chance. A covering set goes through glslang and spirv-val too. naga refusing what the rules accept is our defect by
//! definition.

use std::collections::BTreeSet;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use fragbuf::vocabulary::{Capability, Fact, Row, Template};
use fragbuf::{File, Form, Registry, Request, TARGETS, Target, Variant, check, generate};
use fragbuf_codegen::{Linking, Profile, link, plan, verify};
use fragbuf_model::{Alternative, Attribute, Choice, Draft, Format, Keep, KeepCount, Origin, Selection, Spanned};

use crate::cases::{CUSTOM, DEPTH_ONLY, RESERVED, Random, checked, generated, named, text};
use crate::validators::validate;

/// Payloads, constraints and closures that every combination of rows is tried with.
fn descriptions() -> Vec<Draft> {
    let parsed = |source: &str| fragbuf::parse(source, "case.fragbuf").draft.unwrap();
    vec![Draft::from_technique("kb", &Origin::new("case", 1, 1)), parsed(CUSTOM), parsed(DEPTH_ONLY), parsed(RESERVED)]
}

/// What callers are told of a technique. No row requires it.
const TOLD: [Fact; 2] = [Fact::CountsEvents, Fact::LeavesDepth];

/// The rows of an axis, those together that state the same facts and conditions: the rules see nothing else of a row.
fn classes<'r>(registry: &'r Registry, axis: &'r str) -> Vec<Vec<&'r Row>> {
    let facts = |row: &Row| {
        let conditions = row.conditions.iter().map(|condition| condition.formula.clone()).collect::<Vec<_>>();
        let requires = (row.requires.clone(), row.needs.clone(), row.least.clone());
        let offers: Vec<Fact> = row.offers.iter().copied().filter(|fact| !TOLD.contains(fact)).collect();
        (offers, row.implies.clone(), requires, conditions, row.carries.len())
    };
    let mut classes: Vec<Vec<&Row>> = Vec::new();
    for row in registry.rows_of(axis).filter(|row| row.key != Registry::CLOSURE) {
        match classes.iter_mut().find(|class| facts(class[0]) == facts(row)) {
            Some(class) => class.push(row),
            None => classes.push(vec![row]),
        }
    }
    classes
}

/// A class per axis.
struct Combination {
    /// The first row of each.
    choices: Vec<(String, String)>,
    /// For some, one of each drawn by chance: so that every two rows meet that may.
    drawn: Option<Vec<(String, String)>>,
    /// Every combination of the same classes: the rules decide on all of them alike.
    alike: usize,
    outlook: Outlook,
}

/// What is known of a combination before the rules are asked.
#[derive(Clone, Copy, PartialEq)]
enum Outlook {
    Open,
    /// Some row requires what no row of a later axis offers: whatever is chosen there, it is refused.
    Hopeless,
}

/// One combination in so many is tried with rows drawn by chance too.
const DRAWN_OF: usize = 12;

/// Choices of one class per axis: all, but for those that begin with what nothing later can make legal. Of them there is one.
fn combinations(registry: &Registry) -> Vec<Combination> {
    let axes = registry.axes().iter().filter(|axis| axis.chosen && axis.key != Registry::CLOSURE_AXIS);
    let axes: Vec<(&str, Vec<Vec<&Row>>)> = axes.map(|axis| (axis.key, classes(registry, axis.key))).collect();
    let mut found = Vec::new();
    complete(&axes, &mut Vec::new(), &mut Random(5), &mut found);
    found
}

type Classes<'r> = (&'r str, Vec<Vec<&'r Row>>);

fn complete<'a>(
    axes: &'a [Classes<'a>],
    begin: &mut Vec<&'a Vec<&'a Row>>,
    random: &mut Random,
    found: &mut Vec<Combination>,
) {
    let later = &axes[begin.len()..];
    let outlook = outlook(begin, later);
    if outlook == Outlook::Open && !later.is_empty() {
        for class in &later[0].1 {
            begin.push(class);
            complete(axes, begin, random, found);
            begin.pop();
        }
        return;
    }
    let all: Vec<&Vec<&Row>> = begin.iter().copied().chain(later.iter().map(|(_, classes)| &classes[0])).collect();
    let named = |rows: Vec<&Row>| -> Vec<(String, String)> {
        axes.iter().zip(rows).map(|((axis, _), row)| ((*axis).to_owned(), row.key.clone())).collect()
    };
    let is_drawn = outlook == Outlook::Open && random.below(DRAWN_OF) == 0;
    let rows_of = |(_, classes): &Classes<'_>| classes.iter().map(Vec::len).sum::<usize>();
    found.push(Combination {
        choices: named(all.iter().map(|class| class[0]).collect()),
        drawn: is_drawn.then(|| named(all.iter().map(|class| *random.pick(class)).collect())),
        alike: begin.iter().map(|class| class.len()).chain(later.iter().map(rows_of)).product(),
        outlook,
    });
}

/// Whether the rows chosen so far may become legal, whatever the description gives.
fn outlook(begin: &[&Vec<&Row>], later: &[Classes<'_>]) -> Outlook {
    let rows = || begin.iter().map(|class| class[0]);
    let may_be = |fact: Fact| {
        let later = || later.iter().flat_map(|(_, classes)| classes.iter().map(|class| class[0]));
        rows().chain(later()).any(|row| row.may_offer(fact))
    };
    let all = rows().all(|row| row.requires.iter().all(|fact| may_be(*fact)));
    if all { Outlook::Open } else { Outlook::Hopeless }
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
    assert!(registry.rows().iter().all(|row| row.requires.iter().all(|fact| !TOLD.contains(fact))));
    let combinations = combinations(&registry);
    let descriptions = descriptions();
    let decided = decided(&registry, &descriptions, &combinations);
    let number = |decided: &[(usize, Option<Accepted<'_>>)]| decided.iter().map(|(alike, _)| alike).sum::<usize>();
    let (accepted, refused): (Vec<_>, Vec<_>) = decided.into_iter().partition(|(_, variant)| variant.is_some());
    let counts = (number(&accepted), number(&refused));
    let accepted: Vec<Accepted<'_>> = accepted.into_iter().filter_map(|(_, variant)| variant).collect();
    assert!(accepted.len() > 1000 && counts.1 > counts.0, "{counts:?} combinations accepted and refused");
    let (seen, planned) = (Mutex::new(BTreeSet::new()), Mutex::new(BTreeSet::new()));
    let made = AtomicUsize::new(0);
    // All of the papers' payload; of the others enough that every two rows meet.
    let (papers, others): (Vec<_>, Vec<_>) = accepted.iter().partition(|one| one.payload == 0);
    let others = covering(&others);
    let queue = Mutex::new(papers.iter().chain(&others));
    let work = || {
        while let Some(one) = { queue.lock().unwrap().next() } {
            let texts = texts(one, &registry, &planned);
            if texts.into_iter().fold(false, |new, text| seen.lock().unwrap().insert(text) | new) {
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
    assert!(external > 100);
    println!(
        "product: {} combinations, {} accepted, {} refused, in {} and {} kinds; {} distinct passes in {} files through \
         naga and the printers; {external} of a covering set through glslang and spirv-val",
        counts.0 + counts.1,
        counts.0,
        counts.1,
        accepted.len(),
        refused.len(),
        seen.into_inner().unwrap().len(),
        made.into_inner(),
    );
}

/// What the rules say of every combination with every description: how many are alike, and the variant if it is accepted.
fn decided<'a>(
    registry: &Registry,
    descriptions: &[Draft],
    combinations: &'a [Combination],
) -> Vec<(usize, Option<Accepted<'a>>)> {
    let decide = |combination: &'a Combination| {
        let mut decided = Vec::new();
        let drawn = combination.drawn.iter().map(|choices| (0, choices));
        let tried: Vec<_> = std::iter::once((combination.alike, &combination.choices)).chain(drawn).collect();
        let keeps = [KeepCount::AtMost(8), KeepCount::All];
        for (payload, description) in descriptions.iter().enumerate() {
            for ((alike, choices), keep) in tried.iter().flat_map(|tried| keeps.map(|keep| (*tried, keep))) {
                let with = |keep: KeepCount| check(&chosen(description, choices, keep), registry);
                // What keeps one alone says so, and is tried with one.
                let checked = match with(keep) {
                    Err(faults) if faults.to_string().contains("`keep 1`") => with(KeepCount::AtMost(1)),
                    checked => checked,
                };
                if let Err(faults) = &checked {
                    assert!(faults.iter().all(|fault| !fault.hint.is_empty() && fault.code.name != "internal"));
                }
                let variant = checked.ok();
                assert!(variant.is_none() || combination.outlook == Outlook::Open, "{choices:?} is legal after all");
                let accepted = variant.map(|variant| Accepted { payload, choices, variant });
                decided.push((alike, accepted));
            }
        }
        decided
    };
    let (first, second) = combinations.split_at(combinations.len() / 2);
    std::thread::scope(|scope| {
        let other = scope.spawn(|| second.iter().flat_map(decide).collect::<Vec<_>>());
        let mut all: Vec<_> = first.iter().flat_map(decide).collect();
        all.extend(other.join().unwrap());
        all
    })
}

/// What tells each pass of a variant from every other, on each profile: its text but for comments, and what printers are told
/// of its uses. A pass that was printed before is printed alike; a plan of passes that were all planned before, with the
/// same rows in their roles and the same memory, is not linked again.
fn texts(accepted: &Accepted<'_>, registry: &Registry, planned: &Mutex<BTreeSet<u64>>) -> Vec<u64> {
    let variant = &accepted.variant;
    let mut known: Vec<(Profile, Selection)> = Vec::new();
    let mut texts = Vec::new();
    for target in TARGETS {
        let offers = [target.offers, &[Capability::OwnEntryPoints]].concat();
        let Ok(selection) = variant.select(&offers) else { continue };
        let one = (target.profile, selection);
        if known.contains(&one) {
            continue;
        }
        let plan = plan(variant, &one.1, registry).unwrap_or_else(|faults| panic!("{faults}"));
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
        let program = link(&plan, &linking, registry).unwrap_or_else(|faults| panic!("{faults}"));
        texts.extend(program.passes.iter().zip(&plan.passes).map(|(linked, pass)| {
            let mut hasher = DefaultHasher::new();
            let code = linked.text.lines().filter(|line| !line.trim_start().starts_with("//"));
            code.for_each(|line| line.hash(&mut hasher));
            (target.profile, &pass.anchor, &plan.requires, format!("{:?}", pass.uses)).hash(&mut hasher);
            hasher.finish()
        }));
        known.push(one);
    }
    assert!(!known.is_empty(), "some target can express whatever is accepted");
    texts
}

/// A combination that the rules accept.
struct Accepted<'a> {
    payload: usize,
    choices: &'a [(String, String)],
    variant: Variant,
}

/// Few of them, in which every two values of two axes stand together with every payload that they are accepted with. They
/// are gone through in a shuffled order: neighbours have almost everything in common.
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
        let capacity = Some(u64::from(generated(&variant).plans[0].plan.capacity()));
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

/// Whoever checks interleavings must refuse it; everything else takes it.
#[test]
fn an_algorithm_as_printed_passes_every_validator() {
    let text = include_str!("templates/revised_array_as_printed.wgsl");
    let builtin = Registry::builtin();
    let row = builtin.row("storage", "revised_array").unwrap().clone();
    let registry = builtin.with(Row { template: Some(Template::new("revised_array_as_printed.wgsl", text)), ..row });
    assert_eq!(verify(&registry), Vec::<String>::new());
    let variant = check(&Draft::from_technique("kplus_array_revised", &Origin::new("case", 1, 1)), &registry).unwrap();
    let targets: Vec<&'static Target> = TARGETS.iter().collect();
    let request = Request { targets: &targets, form: Form::Program, prefix: "", group: 0 };
    let generation = generate(&variant, &request, &registry).unwrap_or_else(|faults| panic!("{faults}"));
    assert!(validate(generation.files.iter()) > 0);
}

#[test]
fn templates_keep_their_contracts() {
    let faults = verify(&Registry::builtin());
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}
