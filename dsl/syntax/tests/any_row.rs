//! Any file gives a row or errors with spans inside the file, and never a panic; a valid row gives the right values.

#![allow(clippy::expect_used, reason = "a test fails by panicking")]

use fragbuf_syntax::row;
use fragbuf_templates::vocabulary::{
    Access, BlendedEntries, Capability, Element, Feature, Host, Init, KeptFragments, Loads, Permits, SYMBOLS,
    Soundness, Step,
};

const GOOD: &str = "// What it is.\n\
    //: storage -- all of it\n\
    //: paper Author 2026, sec. 3\n\
    //: buffer heads[pixel < pixels]: word, clear 7 -- the first\n\
    //: buffer rest[slot < k * 2][pixel < ceil_div(width, 8) * height]: value, persistent -- the rest\n\
    //: pass reset: heads plain\n\
    //: pass store as again: heads atomic rechecked, rest coherent\n\
    //: host allocate: reads heads[pixels]; sets fragments; lags\n\
    //: provides keeps-best, conservative-bound\n\
    //: requires mutual-exclusion, fragment-atomics\n\
    //: when keep <= 64 && color -- write `keep 64;`\n\
    //: implies sorted when depth_key\n\
    //: suits sync spin_lock, cull early\n\
    //: parameter limit LIMIT = 2 * capacity, from 1 to 99 -- tries\n\
    //: keeps best 1 of each min(k - 1, key / LIMIT) at most k\n\
    //: hazard torn unless mutual-exclusion -- two in one\n\
    //: hazard mixed permits stale, lost-update -- more of it\n\
    //: hazard merged-farthest -- the last is a mixture\n\
    //: soundness lock\n\
    \n\
    fn storage_insert(pixel: u32, entry: Packed) {}\n";

#[test]
fn a_row_has_the_values_of_its_lines() {
    let user_row = row(GOOD, "mine.wgsl", "wgsl:mine.wgsl", "there/mine.wgsl").expect("it is a row");
    let row = user_row.row;
    assert_eq!((row.axis.as_str(), row.key.as_str(), &*row.summary), ("storage", "wgsl:mine.wgsl", "all of it"));
    assert_eq!(row.paper, "Author 2026, sec. 3");
    let [heads, rest] = row.resources.as_slice() else { unreachable!("two buffers: {:?}", row.resources) };
    assert_eq!((heads.element, heads.init, &*heads.summary), (Element::Word, Init::Clear(7), "the first"));
    let extents: Vec<_> = rest.extents.iter().map(|extent| (extent.name.as_str(), extent.length.to_string())).collect();
    assert_eq!(extents, [("slot", "k * 2".to_owned()), ("pixel", "ceil_div(width, 8) * height".to_owned())]);
    let [Step::Pass(reset), Step::Pass(store), Step::Host(host)] = row.steps.as_slice() else {
        unreachable!("three steps: {:?}", row.steps)
    };
    assert_eq!((reset.name.as_str(), reset.skeleton.as_str()), ("reset", "reset"));
    assert_eq!((store.name.as_str(), store.skeleton.as_str()), ("again", "store"));
    let uses: Vec<_> = store.uses.iter().map(|usage| (usage.resource.as_str(), usage.access, usage.loads)).collect();
    assert_eq!(uses, [("heads", Access::Atomic, Loads::Rechecked), ("rest", Access::Coherent, Loads::Exact)]);
    assert_eq!(*host, Host::new("allocate").reads_word("heads", "pixels").sets("fragments").lags());
    assert_eq!(row.provides, [Capability::KeepsBest, Capability::ConservativeBound]);
    assert_eq!(
        (row.requires.as_slice(), row.implies.as_slice()),
        (&[Capability::MutualExclusion][..], &[("depth_key".into(), Capability::Sorted)][..])
    );
    let [condition] = row.conditions.as_slice() else { unreachable!("one condition: {:?}", row.conditions) };
    assert_eq!((&*condition.formula.0, &*condition.help), ("keep <= 64 && color", "write `keep 64;`"));
    assert_eq!(row.needs, [Feature::FragmentAtomics]);
    assert_eq!(row.defaults, [("sync".into(), "spin_lock".into()), ("cull".into(), "early".into())]);
    let limit = &row.parameters[0];
    assert_eq!((&*limit.name, &*limit.constant, limit.range), ("limit", "LIMIT", (1, 99)));
    assert_eq!((row.hazards[0].unless, row.soundness), (Some(Capability::MutualExclusion), Soundness::Lock));
    let both = Permits::STALE.and(&Permits::LOST).expect("both take a race");
    let permits: Vec<_> = row.hazards.iter().map(|hazard| hazard.permits.clone()).collect();
    assert_eq!(permits, [Permits::TORN, both, Permits::NOTHING]);
    assert_eq!(row.kept(), Some(KeptFragments::best_of_each_of_k("min(k - 1, key / LIMIT)")));
    assert_eq!(row.merges.as_ref().map(|merges| merges.blended), Some(BlendedEntries::Worst));
    let template = row.template.expect("a template");
    assert_eq!((&*template.path, template.user_file.as_deref()), ("mine.wgsl", Some("there/mine.wgsl")));
    assert!(!template.source.contains("//:") && template.source.lines().count() == GOOD.lines().count());
}

/// Removes, duplicates, swaps and replaces parts of the row.
#[test]
fn any_source_is_a_row_or_errors_inside_it() {
    let mut state = 1u64;
    let mut below = |end: usize| {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 16) as usize % end.max(1)
    };
    const TOKENS: [&str; 12] = ["[", "]", "<", ":", ",", " -- ", "//:", "\n", "ä", "\u{a0}", "99999999999", "("];
    let mut rejected = 0;
    for _ in 0..4000 {
        let mut letters: Vec<String> = GOOD.chars().map(String::from).collect();
        for _ in 0..1 + below(4) {
            let at = below(letters.len());
            match below(3) {
                0 => drop(letters.drain(at..(at + 1 + below(12)).min(letters.len()))),
                1 => letters[at] = TOKENS[below(TOKENS.len())].to_owned(),
                _ => {
                    let other = below(letters.len());
                    letters.swap(at, other);
                }
            }
        }
        let text = letters.concat();
        let Err(diagnostics) = row(&text, "any.wgsl", "wgsl:any.wgsl", "any.wgsl") else { continue };
        rejected += 1;
        for diagnostic in &diagnostics {
            let line = text.lines().nth(diagnostic.span.line as usize - 1).unwrap_or("");
            let end = (diagnostic.span.column + diagnostic.span.length) as usize;
            assert!(end <= line.chars().count() + 2, "beyond the line: {diagnostic}\n{text}");
            assert!(!diagnostic.help.is_empty() && !diagnostic.message.is_empty(), "{diagnostic}");
        }
    }
    assert!(rejected > 1000, "{rejected}");
}

/// A formula that is too long or too deep is an error at its span in every statement.
#[test]
fn formulas_are_bounded() {
    let nested = |count: usize| format!("{}k{}", "(".repeat(count), ")".repeat(count));
    let sums = ["(width + height + pixels + k + n + fragments + kept)"; 5].join(" * ");
    let of_conditions = |formula: &str| formula.replace(['k', 'n'], "keep").replace("pixels", "color");
    let long = format!("1{}", " + k".repeat(200_000));
    let deep = [nested(200_000), "!".repeat(200_000), "-".repeat(200_000), nested(41)];
    for formula in deep.iter().chain([&long]) {
        let condition = of_conditions(formula);
        for line in [
            format!("//: buffer b[slot < {formula}]: word"),
            format!("//: host allocate: reads b[{formula}]; sets k\n//: buffer b: word"),
            format!("//: parameter limit LIMIT = {}, from 1 to 2", formula.replace(['k', 'n'], "capacity")),
            format!("//: keeps best {}", formula.replace('n', "k")),
            format!("//: keeps best 1 of each {}", formula.replace('n', "k")),
            format!("//: when {condition}"),
            format!("//: implies sorted when {condition}"),
            format!("//: defines pixels = {}", formula.replace(['k', 'n'], "width")),
        ] {
            let text = format!("//: storage -- it\n{line}\n");
            let diagnostics = row(&text, "mine.wgsl", "wgsl:mine.wgsl", "mine.wgsl").expect_err("too much");
            assert!(
                diagnostics.iter().all(|diagnostic| diagnostic.span.line == 2 && !diagnostic.help.is_empty()),
                "{line:.60}"
            );
        }
    }
    for (formula, help) in [(&deep[3], "fewer parentheses"), (&long, "shorten"), (&sums, "fewer sums")] {
        let text = format!("//: storage -- it\n//: buffer b[a < width][slot < {formula}]: word\n");
        let diagnostics = row(&text, "mine.wgsl", "wgsl:mine.wgsl", "mine.wgsl").expect_err("too much");
        let found: Vec<_> = diagnostics
            .iter()
            .map(|diagnostic| (diagnostic.code.name, diagnostic.span.line, diagnostic.span.column))
            .collect();
        assert_eq!(found, [("invalid-row", 2, 32)], "{help}");
        assert!(diagnostics.iter().all(|diagnostic| diagnostic.help.contains(help)), "{diagnostics}");
    }
}

/// A constant with the name of a symbol would change the meaning of the row's formulas.
#[test]
fn no_constant_has_a_name_of_formulas() {
    let names = SYMBOLS.iter().map(|symbol| symbol.name);
    for name in names.chain(["key", "depth_millionths", "ceil_div", "pow2", "log2_ceil"]) {
        let text = format!("//: storage -- it\n//: parameter limit {name} = 3, from 1 to 9\n");
        let diagnostics = row(&text, "mine.wgsl", "wgsl:mine.wgsl", "mine.wgsl").expect_err(name);
        let found: Vec<_> = diagnostics
            .iter()
            .map(|diagnostic| (diagnostic.code.name, diagnostic.span.line, diagnostic.span.column))
            .collect();
        assert_eq!(found, [("invalid-row", 2, 21)], "{diagnostics}");
        let help = format!("`OWN_{}`", name.to_ascii_uppercase());
        assert!(diagnostics.iter().all(|diagnostic| diagnostic.help.contains(&help)), "{diagnostics}");
    }
}

/// A hazard that permits effects under several conditions becomes one hazard per condition.
#[test]
fn permits_keep_their_conditions() {
    let text = "//: storage -- it\n//: hazard mixed permits torn, not-converged, stale, equal-keys -- a mixture\n";
    let user_row = row(text, "mine.wgsl", "wgsl:mine.wgsl", "mine.wgsl").expect("it is a row");
    let found: Vec<_> =
        user_row.row.hazards.iter().map(|hazard| (&*hazard.description, hazard.permits.clone())).collect();
    let torn_and_stale = Permits::TORN.and(&Permits::STALE).expect("both need a race");
    let expected = [
        ("a mixture, in a race", torn_and_stale),
        ("a mixture, where `not_converged` is counted", Permits::NOT_CONVERGED),
        ("a mixture, in any order", Permits::ONE_OF_EQUAL_KEYS),
    ];
    assert_eq!(found, expected);
}

/// A second statement of a kind that a row has once is an error: it does not replace the first.
#[test]
fn reports_duplicate_statements_at_the_second() {
    for (first, second, column) in [
        ("keeps best k", "keeps worst k", 5),
        ("keeps best k", "hazard one-per-range -- ranges", 12),
        ("hazard one-per-range -- ranges", "keeps best k", 5),
        ("hazard merged-farthest -- mixed", "hazard merged-neighbours -- mixed", 12),
        ("paper A", "paper B", 5),
        ("provides indexed", "provides sorted", 5),
        ("requires mutual-exclusion", "requires fragment-atomics", 5),
        ("uses b read", "uses b plain", 5),
        ("soundness lock", "soundness racy", 5),
        ("suits cull early", "suits sync none, cull none", 22),
        ("defines pixels = width", "defines pixels = height", 13),
        ("parameter limit A = 1, from 1 to 2", "parameter limit B = 2, from 1 to 2", 15),
    ] {
        let text = format!("//: storage -- it\n//: buffer b: word\n//: {first}\n//: {second}\n");
        let diagnostics = row(&text, "mine.wgsl", "wgsl:mine.wgsl", "mine.wgsl").expect_err(second);
        let found: Vec<_> = diagnostics
            .iter()
            .map(|diagnostic| (diagnostic.code.name, diagnostic.span.line, diagnostic.span.column))
            .collect();
        assert_eq!(found, [("duplicate", 4, column)], "{diagnostics}");
        let labels = diagnostics.iter().flat_map(|diagnostic| &diagnostic.labels).map(|label| label.span.line);
        assert_eq!(labels.collect::<Vec<_>>(), [3], "{diagnostics}");
    }
}
