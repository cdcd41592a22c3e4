//! Any file gives a row or mistakes, each inside the file, and never a panic; a good row gives what it says.

#![allow(clippy::expect_used, reason = "a test may stop where it cannot go on")]

use fragbuf_syntax::row;
use fragbuf_templates::vocabulary::{
    Access, Blended, Capability, Element, Fact, Host, Init, Kept, Loads, Permits, SYMBOLS, Soundness, Step,
};

const GOOD: &str = "// What it is.\n\
    //: storage -- all of it\n\
    //: paper Nobody 2026, sec. 3\n\
    //: buffer heads[pixel < pixels]: word, clear 7 -- the first\n\
    //: buffer rest[slot < k * 2][pixel < ceil_div(width, 8) * height]: beside, persistent -- the rest\n\
    //: pass reset: heads plain\n\
    //: pass store as again: heads atomic rechecked, rest coherent\n\
    //: host allocate: reads heads[pixels]; sets fragments\n\
    //: offers keeps-best, bound-any-instant\n\
    //: requires critical, fragment-atomics\n\
    //: when keep <= 64 && color -- write `keep 64;`\n\
    //: implies sorted when depth_key\n\
    //: suits sync spin_lock, cull early\n\
    //: parameter limit LIMIT = 2 * capacity, from 1 to 99 -- tries\n\
    //: keeps best 1 of each min(k - 1, key / LIMIT)\n\
    //: hazard torn unless critical -- two in one\n\
    //: hazard mixed permits stale, lost-update -- more of it\n\
    //: hazard merged-farthest -- the last is a mixture\n\
    //: soundness lock\n\
    \n\
    fn storage_insert(pixel: u32, entry: Packed) {}\n";

#[test]
fn a_row_says_what_its_lines_say() {
    let own = row(GOOD, "mine.wgsl", "wgsl:mine.wgsl", "there/mine.wgsl").expect("it is a row");
    let row = own.row;
    assert_eq!((row.axis.as_str(), row.key.as_str(), &*row.summary), ("storage", "wgsl:mine.wgsl", "all of it"));
    assert_eq!(row.paper, "Nobody 2026, sec. 3");
    let [heads, rest] = row.resources.as_slice() else { unreachable!("two buffers: {:?}", row.resources) };
    assert_eq!((heads.element, heads.init, &*heads.summary), (Element::Word, Init::Clear(7), "the first"));
    let extents: Vec<_> = rest.extents.iter().map(|extent| (extent.name.as_str(), extent.length.to_string())).collect();
    assert_eq!(extents, [("slot", "k * 2".to_owned()), ("pixel", "ceil_div(width, 8) * height".to_owned())]);
    let [Step::Pass(reset), Step::Pass(store), Step::Host(host)] = row.steps.as_slice() else {
        unreachable!("three steps: {:?}", row.steps)
    };
    assert_eq!((reset.anchor.as_str(), reset.skeleton.as_str()), ("reset", "reset"));
    assert_eq!((store.anchor.as_str(), store.skeleton.as_str()), ("again", "store"));
    let uses: Vec<_> = store.uses.iter().map(|usage| (usage.resource.as_str(), usage.access, usage.loads)).collect();
    assert_eq!(uses, [("heads", Access::Atomic, Loads::Rechecked), ("rest", Access::Coherent, Loads::Exact)]);
    assert_eq!(*host, Host::new("allocate").reads_word("heads", "pixels").sets("fragments"));
    assert_eq!(row.offers, [Fact::KeepsBest, Fact::BoundAnyInstant]);
    assert_eq!(
        (row.requires.as_slice(), row.implies.as_slice()),
        (&[Fact::Critical][..], &[("depth_key".into(), Fact::Sorted)][..])
    );
    let [condition] = row.conditions.as_slice() else { unreachable!("one condition: {:?}", row.conditions) };
    assert_eq!((&*condition.formula.0, &*condition.hint), ("keep <= 64 && color", "write `keep 64;`"));
    assert_eq!(row.needs, [Capability::FragmentAtomics]);
    assert_eq!(row.defaults, [("sync".into(), "spin_lock".into()), ("cull".into(), "early".into())]);
    let limit = &row.parameters[0];
    assert_eq!((&*limit.name, &*limit.constant, limit.range), ("limit", "LIMIT", (1, 99)));
    assert_eq!((row.hazards[0].unless, row.soundness), (Some(Fact::Critical), Soundness::Lock));
    let both = Permits::STALE.and(&Permits::LOST).expect("both take a race");
    let permits: Vec<_> = row.hazards.iter().map(|hazard| hazard.permits.clone()).collect();
    assert_eq!(permits, [Permits::TORN, both, Permits::NOTHING]);
    assert_eq!(row.kept(), Some(Kept::best_of_each("min(k - 1, key / LIMIT)")));
    assert_eq!(row.merges.as_ref().map(|merges| merges.blended), Some(Blended::Worst));
    let template = row.template.expect("the text");
    assert_eq!((&*template.path, template.own.as_deref()), ("mine.wgsl", Some("there/mine.wgsl")));
    assert!(!template.text.contains("//:") && template.text.lines().count() == GOOD.lines().count());
}

/// The same row with pieces of it removed, doubled, swapped and replaced by signs that need care.
#[test]
fn any_text_is_a_row_or_mistakes_inside_it() {
    let mut state = 1u64;
    let mut below = |end: usize| {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 16) as usize % end.max(1)
    };
    const SIGNS: [&str; 12] = ["[", "]", "<", ":", ",", " -- ", "//:", "\n", "ä", "\u{a0}", "99999999999", "("];
    let mut refused = 0;
    for _ in 0..4000 {
        let mut letters: Vec<String> = GOOD.chars().map(String::from).collect();
        for _ in 0..1 + below(4) {
            let at = below(letters.len());
            match below(3) {
                0 => drop(letters.drain(at..(at + 1 + below(12)).min(letters.len()))),
                1 => letters[at] = SIGNS[below(SIGNS.len())].to_owned(),
                _ => {
                    let other = below(letters.len());
                    letters.swap(at, other);
                }
            }
        }
        let text = letters.concat();
        let Err(faults) = row(&text, "any.wgsl", "wgsl:any.wgsl", "any.wgsl") else { continue };
        refused += 1;
        for fault in &faults {
            let line = text.lines().nth(fault.origin.line as usize - 1).unwrap_or("");
            let end = (fault.origin.column + fault.origin.length) as usize;
            assert!(end <= line.chars().count() + 2, "beyond the line: {fault}\n{text}");
            assert!(!fault.hint.is_empty() && !fault.message.is_empty(), "{fault}");
        }
    }
    assert!(refused > 1000, "{refused}");
}

/// A formula that would be read, multiplied out or written without end is a mistake at its place, wherever it stands.
#[test]
fn formulas_are_bounded() {
    let nested = |count: usize| format!("{}k{}", "(".repeat(count), ")".repeat(count));
    let sums = ["(width + height + pixels + k + n + fragments + kept)"; 5].join(" * ");
    let of_conditions = |text: &str| text.replace(['k', 'n'], "keep").replace("pixels", "color");
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
            let faults = row(&text, "mine.wgsl", "wgsl:mine.wgsl", "mine.wgsl").expect_err("too much");
            assert!(faults.iter().all(|fault| fault.origin.line == 2 && !fault.hint.is_empty()), "{line:.60}");
        }
    }
    for (formula, hint) in [(&deep[3], "fewer parentheses"), (&long, "shorter"), (&sums, "fewer sums")] {
        let text = format!("//: storage -- it\n//: buffer b[a < width][slot < {formula}]: word\n");
        let faults = row(&text, "mine.wgsl", "wgsl:mine.wgsl", "mine.wgsl").expect_err("too much");
        let found: Vec<_> =
            faults.iter().map(|fault| (fault.code.name, fault.origin.line, fault.origin.column)).collect();
        assert_eq!(found, [("row", 2, 32)], "{hint}");
        assert!(faults.iter().all(|fault| fault.hint.contains(hint)), "{faults}");
    }
}

/// A constant of the name of a symbol would change what the formulas of the row mean.
#[test]
fn no_constant_takes_a_word_of_formulas() {
    let words = SYMBOLS.iter().map(|symbol| symbol.name);
    for word in words.chain(["key", "depth_millionths", "ceil_div", "pow2", "log2_ceil"]) {
        let text = format!("//: storage -- it\n//: parameter limit {word} = 3, from 1 to 9\n");
        let faults = row(&text, "mine.wgsl", "wgsl:mine.wgsl", "mine.wgsl").expect_err(word);
        let found: Vec<_> =
            faults.iter().map(|fault| (fault.code.name, fault.origin.line, fault.origin.column)).collect();
        assert_eq!(found, [("row", 2, 21)], "{faults}");
        let way_out = format!("`OWN_{}`", word.to_ascii_uppercase());
        assert!(faults.iter().all(|fault| fault.hint.contains(&way_out)), "{faults}");
    }
}

/// What a hazard permits under several conditions is a hazard for each.
#[test]
fn permits_keep_their_conditions() {
    let text = "//: storage -- it\n//: hazard mixed permits torn, unsettled, stale, equal-keys -- a mixture\n";
    let own = row(text, "mine.wgsl", "wgsl:mine.wgsl", "mine.wgsl").expect("it is a row");
    let found: Vec<_> = own.row.hazards.iter().map(|hazard| (&*hazard.what, hazard.permits.clone())).collect();
    let torn_and_stale = Permits::TORN.and(&Permits::STALE).expect("both take a race");
    let wanted = [
        ("a mixture, in a race", torn_and_stale),
        ("a mixture, where `unsettled` is counted", Permits::UNSETTLED),
        ("a mixture, whatever the order", Permits::ONE_OF_EQUAL_KEYS),
    ];
    assert_eq!(found, wanted);
}

/// What a row says once is a mistake where it says it again: the second does not silently take the place of the first.
#[test]
fn what_is_said_twice_is_reported_at_the_second() {
    for (first, second, column) in [
        ("keeps best k", "keeps worst k", 5),
        ("keeps best k", "hazard one-per-range -- ranges", 12),
        ("hazard one-per-range -- ranges", "keeps best k", 5),
        ("hazard merged-farthest -- mixed", "hazard merged-neighbours -- mixed", 12),
        ("paper A", "paper B", 5),
        ("offers indexed", "offers sorted", 5),
        ("requires critical", "requires fragment-atomics", 5),
        ("uses b read", "uses b plain", 5),
        ("soundness lock", "soundness racy", 5),
        ("suits cull early", "suits sync none, cull none", 22),
        ("defines pixels = width", "defines pixels = height", 13),
        ("parameter limit A = 1, from 1 to 2", "parameter limit B = 2, from 1 to 2", 15),
    ] {
        let text = format!("//: storage -- it\n//: buffer b: word\n//: {first}\n//: {second}\n");
        let faults = row(&text, "mine.wgsl", "wgsl:mine.wgsl", "mine.wgsl").expect_err(second);
        let found: Vec<_> =
            faults.iter().map(|fault| (fault.code.name, fault.origin.line, fault.origin.column)).collect();
        assert_eq!(found, [("duplicate", 4, column)], "{faults}");
        let labels = faults.iter().flat_map(|fault| &fault.labels).map(|label| label.origin.line);
        assert_eq!(labels.collect::<Vec<_>>(), [3], "{faults}");
    }
}
