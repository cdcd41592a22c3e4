//! User files in place of registry rows. An accepted file passes every target and validator; an error is reported at the user's
//! line and column.

use std::collections::BTreeSet;
use std::fmt::Write;
use std::path::{Path, PathBuf};

use fragbuf::load::{Description, load};
use fragbuf::report::render;
use fragbuf::vocabulary::{BindingTime, SYMBOLS, Symbol};
use fragbuf::{Diagnostics, Form, Registry, Request, TARGETS, Target, generate, target};
use fragbuf_codegen::{PlanValue, SymbolId};
use fragbuf_model::codes;

use crate::validators::validate;

fn example(name: &str) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/user_storage").join(name);
    std::fs::read_to_string(path).unwrap()
}

fn folder(name: &str) -> PathBuf {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join("own").join(name);
    let _ = std::fs::remove_dir_all(&path);
    std::fs::create_dir_all(&path).unwrap();
    path
}

/// Returns all diagnostics of generating every target, with the sources that were read.
fn diagnostics(folder: &Path) -> Result<(), (Diagnostics, Vec<(String, String)>)> {
    let description = Description::read(&folder.join("own.fragbuf")).unwrap();
    let registry = Registry::builtin();
    let loaded = load(&description, &[], &[], &registry);
    let targets: Vec<&'static Target> = TARGETS.iter().collect();
    let request = Request { targets: &targets, form: Form::Program, prefix: "", group: 0 };
    match loaded.variant.and_then(|variant| generate(&variant, &request, &registry)) {
        Ok(generation) => {
            assert!(generation.unsupported.is_empty());
            validate(generation.files.iter());
            Ok(())
        }
        Err(diagnostics) => Err((diagnostics, loaded.sources)),
    }
}

fn with(name: &str, description: &str, file: &str) -> PathBuf {
    let folder = folder(name);
    std::fs::write(folder.join("own.fragbuf"), description).unwrap();
    std::fs::write(folder.join("mine.wgsl"), file).unwrap();
    folder
}

const DESCRIPTION: &str = "buffer Own {\n    storage: wgsl(\"mine.wgsl\");\n    keep 8;\n}\n";

/// An error: a change of the example, the expected code, the text at the expected span, and a part of the expected help.
struct Bad {
    from: &'static str,
    to: &'static str,
    code: &'static str,
    at: &'static str,
    help: &'static str,
}

const fn bad(from: &'static str, to: &'static str, code: &'static str, at: &'static str, help: &'static str) -> Bad {
    Bad { from, to, code, at, help }
}

const BAD: &[Bad] = &[
    bad("//: storage --", "// storage --", "invalid-row", "buffer taken", "//: storage -- "),
    bad("//: storage -- the first", "//: storage the first", "invalid-row", "storage the first", "//: storage -- "),
    bad("//: provides", "//: providse", "invalid-row", "providse", "did you mean `provides`?"),
    bad("lock-free,", "lock-fre,", "unknown-capability", "lock-fre,", "did you mean `lock-free`?"),
    bad("[slot < k]", "[slot k]", "invalid-row", "k]", "[pixel < pixels]"),
    bad("[slot < k]", "[slot < k *]", "invalid-row", "k *]", "ceil_div"),
    bad("[slot < k]", "[slot < kk]", "invalid-row", "kk]", "pixels, k"),
    bad("]: entry", "]: entries", "invalid-row", "entries --", "`entry`"),
    bad("clear 0", "clear zero", "invalid-row", "zero --", "digits"),
    bad("clear 0", "cleared 0", "invalid-row", "cleared", "`clear`"),
    bad("slots plain", "slots plainly", "invalid-row", "plainly", "`plain`"),
    bad("slots plain", "slots plain read", "invalid-row", "read\n", "on a separate line"),
    bad("taken read", "takn read", "unknown-resource", "takn read", "did you mean `taken`?"),
    bad("//: buffer slots", "//: buffer slots: word\n//: buffer slots", "duplicate", "slots[slot", "remove one"),
    bad("//: pass resolve:", "//: pass reslove:", "unknown-value", "reslove", "resolve"),
    bad("//: pass store", "// pass store", "invalid-row", "//: storage", "//: pass store"),
    bad("sync slot_counter", "sink slot_counter", "unknown-axis", "slot_counter\n", "sync"),
    bad("sync slot_counter", "sync slot_count", "unknown-value", "slot_count\n", "slot_counter"),
    bad(
        "fn storage_read(",
        "fn other_read(",
        "contract-mismatch",
        "resolve:",
        "fn storage_read(pixel: u32, cursor: u32) -> Packed",
    ),
    bad(
        "fn storage_insert(",
        "fn other_insert(",
        "contract-mismatch",
        "//: storage",
        "fn storage_insert(pixel: u32, entry: Packed)",
    ),
    // A storage that declares `can-replace` must have the functions that rows of other axes call.
    bad(
        "lock-free, indexed\n//: requires fragment-atomics\n//: suits sync slot_counter\n\n",
        "lock-free, reports-whole-fragments, displaces-under-lock, can-replace\n//: requires fragment-atomics\n\
         //: suits sync slot_counter\n\nfn storage_worst(pixel: u32) -> u32 {\n    return 0u;\n}\n\n",
        "contract-mismatch",
        "//: storage",
        "fn storage_replace(pixel: u32, cursor: u32, entry: Packed)",
    ),
    bad(
        "storage_first(pixel: u32) -> u32",
        "storage_first(pixel: u32) -> i32",
        "contract-mismatch",
        "storage_first(pixel: u32) -> i32",
        "write `fn storage_first(pixel: u32) -> u32`",
    ),
    bad(
        "storage_insert(pixel: u32, ",
        "storage_insert(",
        "contract-mismatch",
        "storage_insert(entry",
        "pixel: u32, entry: Packed",
    ),
    bad("fn first_k_cursor(", "fn sync_store(", "contract-mismatch", "sync_store(pixel: u32, slot", "another name"),
    bad(
        "fn first_k_cursor",
        "@compute @workgroup_size(1)\nfn main() {}\n\nfn first_k_cursor",
        "contract-mismatch",
        "fn main",
        "function",
    ),
    bad(
        "fn first_k_cursor",
        "@group(1) @binding(0)\nvar<storage> x: array<u32>;\n\nfn first_k_cursor",
        "contract-mismatch",
        "var<storage> x",
        "//: buffer",
    ),
    bad(
        "//: buffer taken",
        "//: buffer counters: word\n//: buffer taken",
        "contract-mismatch",
        "counters: word",
        "own_counters",
    ),
    bad("//: buffer slots", "//: buffer my-slots: word\n//: buffer slots", "invalid-row", "my-slots", "letters"),
    bad("[slot < k]", "[value < k]", "invalid-row", "value <", "slot"),
    bad("[slot < k]", "[pixel < k]", "invalid-row", "pixel < pixels]: entry", "slot"),
    bad("[slot < k]", "[fn < k]", "invalid-row", "fn <", "letters"),
    bad("//: pass resolve", "//: pass store: slots plain\n//: pass resolve", "duplicate", "store: slots", "as"),
    bad(
        "//: provides",
        "//: parameter limit CAPACITY = 3, from 1 to 9\n//: provides",
        "invalid-row",
        "CAPACITY",
        "letters",
    ),
    bad(
        "//: provides",
        "//: parameter limit LAYERS = 3, from 1 to 9\n//: provides",
        "contract-mismatch",
        "LAYERS",
        "OWN_LAYERS",
    ),
    bad(
        "//: pass resolve",
        "//: host allocate: reads taken[0]\n//: pass resolve",
        "invalid-row",
        "allocate: reads",
        "sets fragments",
    ),
    bad(
        "//: provides",
        "//: when 1 < keep < 9 -- write `keep 4;`\n//: provides",
        "invalid-row",
        "1 < keep",
        "combine two comparisons with `&&`",
    ),
    bad(
        "//: provides",
        "//: parameter limit LIMIT = 3, from 9 to 1\n//: provides",
        "invalid-row",
        "1\n//: provides",
        "9",
    ),
    bad(
        "//: requires fragment",
        "//: requires lock-free when keep == 4\n//: requires fragment",
        "invalid-row",
        "lock-free when",
        "`when`",
    ),
    bad(
        "//: requires fragment",
        "//: requires u64-atomics when k == 4\n//: requires fragment",
        "invalid-row",
        "k == 4",
        "keep, limited",
    ),
    bad("//: provides", "//: requires u64-atomics\n//: provides", "duplicate", "requires fragment", "merge"),
    bad("//: provides", "//: defines k = 4\n//: provides", "invalid-row", "k = 4", "pixels"),
    bad(
        "//: provides",
        "//: defines pixels = fragments\n//: provides",
        "invalid-row",
        "fragments\n//: provides",
        "width",
    ),
    bad("//: provides", "//: defines n = kept\n//: defines kept = n\n//: provides", "invalid-row", "kept\n", "alone"),
    bad(
        "//: provides",
        "//: adds mask of sample_mask\n//: provides",
        "invalid-row",
        "of sample_mask",
        "from sample_mask",
    ),
    bad(
        "//: provides",
        "//: adds mask from sample_mask\n//: adds more from sample_mask\n//: provides",
        "duplicate",
        "sample_mask\n//: provides",
        "read the word",
    ),
    bad("//: provides", "//: adds mask from position\n//: provides", "invalid-row", "position", "sample_mask"),
    bad(
        "//: provides",
        "//: parameter a A = 3, from 1 to 9, power of two\n//: provides",
        "invalid-row",
        "3, from",
        "set it",
    ),
    bad(
        "//: provides",
        "//: parameter a A = 3, from 1 to 9, at least k\n//: provides",
        "invalid-row",
        "3, from",
        "set it",
    ),
    bad("//: provides", "//: parameter a A = 3, from 1 to 9, odd\n//: provides", "invalid-row", "odd", "power of two"),
    bad("//: provides", "//: parameter a A = 7, attribute\n//: provides", "invalid-row", "7, attribute", "color"),
    bad("cursor + 1u);", "cursor + 1u & 7u);", "invalid-wgsl", "& 7u", "parentheses"),
    bad("fn first_k_cursor", "//: paper none\nfn first_k_cursor", "invalid-row", "//: paper", "the file header"),
    bad("fn first_k_cursor", "}\nfn first_k_cursor", "invalid-wgsl", "}\nfn first", "every brace closed"),
    bad("atomic_add(pixel, 1u)", "atomic_add(pixel, 1.5)", "invalid-wgsl", "1.5)", "accessors"),
    bad(
        "    return slots_load(",
        "    return slots_lode(",
        "invalid-wgsl",
        "slots_lode(",
        "did you mean `slots_load`? It is `fn slots_load(slot: u32, pixel: u32) -> Packed`",
    ),
    bad(
        "taken_load(pixel), frame.k",
        "taken_atomic_add(pixel, 0u), frame.k",
        "invalid-wgsl",
        "taken_atomic_add(pixel, 0u)",
        "write `taken atomic` in the line of the pass, `//: pass resolve: …`; it has `taken_load(pixel: u32) -> u32`",
    ),
    bad(
        "taken read, slots read",
        "taken read",
        "invalid-wgsl",
        "slots_load",
        "write `slots read` in the line of the pass, `//: pass resolve: …`",
    ),
    bad(
        "= taken_atomic_add(pixel, 1u);",
        "= keys_laod(pixel);",
        "invalid-wgsl",
        "keys_laod",
        "`taken_load(pixel: u32) -> u32`",
    ),
    bad(
        "on_lost(pixel,",
        "on_lots(pixel,",
        "invalid-wgsl",
        "on_lots",
        "`fn on_lost(pixel: u32, lost: Packed, reason: u32)`",
    ),
    bad(
        "storage_read(pixel: u32, cursor: u32)",
        "storage_read(cursor: u32, pixel: u32)",
        "contract-mismatch",
        "storage_read(cursor",
        "write `fn storage_read(pixel: u32, cursor: u32) -> Packed`: the argument for `cursor` is the second",
    ),
    bad(
        "pixel, 1u);\n    if slot",
        "pixel, 1u) // one per fragment\n    if slot",
        "invalid-wgsl",
        ") // one",
        "end the statement with `;`",
    ),
    bad("taken_load(pixel), frame.k", "taken_load(pixel), frame.cut", "invalid-wgsl", "cut)", "accessors"),
    bad("fn first_k_cursor", "const EMPTY = 1u;\n\nfn first_k_cursor", "invalid-wgsl", "const EMPTY", "private names"),
];

/// Returns line and column of `part` in `text`, from 1.
fn position(text: &str, part: &str) -> (u32, u32) {
    let at = text.find(part).unwrap_or_else(|| panic!("no `{part}` in {text}"));
    let line = text[..at].matches('\n').count() as u32 + 1;
    (line, (at - text[..at].rfind('\n').map_or(0, |newline| newline + 1)) as u32 + 1)
}

#[test]
fn every_error_in_a_file_is_reported_at_its_line_and_column() {
    let good = example("first_k.wgsl");
    let mut wrong = Vec::new();
    for (index, case) in BAD.iter().enumerate() {
        assert_eq!(good.matches(case.from).count().min(1), 1, "{}", case.from);
        assert!(!case.help.is_empty(), "no help for {}", case.to);
        let text = good.replacen(case.from, case.to, 1);
        let folder = with(&format!("bad-{index}"), DESCRIPTION, &text);
        let (diagnostics, sources) = diagnostics(&folder).err().unwrap_or_else(|| panic!("accepted: {}", case.to));
        let file = folder.join("mine.wgsl").display().to_string();
        let (line, column) = position(&text, case.at);
        let found = diagnostics.iter().any(|diagnostic| {
            let at = (diagnostic.code.name, &*diagnostic.span.file, diagnostic.span.line, diagnostic.span.column);
            at == (case.code, &file, line, column) && diagnostic.help.contains(case.help)
        });
        if !found || diagnostics.iter().count() > 1 {
            wrong.push(format!("{} should be {} {line}:{column} alone:\n{diagnostics}", case.to, case.code));
        }
        let drawn = render(&diagnostics, &sources);
        assert!(drawn.contains(&format!("mine.wgsl:{line}:{column}")) || !found, "{drawn}");
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n\n"));
}

#[test]
fn every_code_of_user_files_is_covered() {
    let covered: BTreeSet<&str> = BAD.iter().map(|case| case.code).collect();
    let index = |code| codes::ALL.iter().position(|other| *other == code).unwrap();
    for code in &codes::ALL[index(codes::MISSING_FILE)..index(codes::UNKNOWN_TECHNIQUE)] {
        // `messages` has a file that is not UTF-8.
        let is_elsewhere = [codes::MISSING_FILE, codes::INVALID_ENCODING].contains(code);
        assert!(covered.contains(code.name) || is_elsewhere, "no case for {}", code.name);
    }
}

#[test]
fn a_missing_file_is_reported_where_it_is_named() {
    let folder = with("missing", &DESCRIPTION.replace("mine", "yours"), "");
    let (diagnostics, _) = diagnostics(&folder).unwrap_err();
    let found: Vec<_> = diagnostics
        .iter()
        .map(|diagnostic| (diagnostic.code.name, diagnostic.span.line, diagnostic.span.column))
        .collect();
    assert_eq!(found, [("missing-file", 2, 19)], "{diagnostics}");
    assert!(diagnostics.to_string().contains("yours.wgsl"), "{diagnostics}");
}

#[test]
fn a_file_without_a_row_and_one_of_another_axis_are_rejected() {
    let none = with("rowless", DESCRIPTION, "fn storage_insert(pixel: u32, entry: Packed) {}\n");
    let (none, _) = diagnostics(&none).unwrap_err();
    assert!(
        none.iter()
            .all(|diagnostic| diagnostic.code == codes::INVALID_ROW && diagnostic.help.contains("//: storage -- ")),
        "{none}"
    );
    let other = DESCRIPTION.replace("storage:", "storage: linked_list; sort:").replace("keep 8", "keep all");
    let (other, _) = diagnostics(&with("axis", &other, &example("first_k.wgsl"))).unwrap_err();
    let found: Vec<_> = other.iter().map(|diagnostic| (diagnostic.code.name, diagnostic.span.line)).collect();
    assert_eq!(found, [("unknown-value", 2)], "{other}");
}

#[test]
fn errors_of_the_description_and_of_the_file_are_reported_together() {
    let description = DESCRIPTION.replace("keep 8", "where |f| f.deph > 0.0; keep 8");
    let file = example("first_k.wgsl").replace("lock-free", "atomics-of-mine");
    let (diagnostics, _) = diagnostics(&with("both", &description, &file)).unwrap_err();
    let found: BTreeSet<&str> = diagnostics.iter().map(|diagnostic| diagnostic.code.name).collect();
    assert_eq!(found, BTreeSet::from(["unknown-capability", "unknown-field"]), "{diagnostics}");
}

/// Paths of user files are relative to the description, and generated sources do not contain them.
#[test]
fn a_good_file_goes_through_every_target_and_validator() {
    // Comments and summaries of user files may have any letters.
    let file = example("first_k.wgsl").replace("//: pass store", "//: paper Große 2026 §3\n//: pass store");
    let folder = with("good", DESCRIPTION, &file.replace("fragments that asked", "fragments, déjà là, that asked"));
    assert_eq!(diagnostics(&folder).map_err(|(diagnostics, _)| diagnostics.to_string()), Ok(()));
    let texts = ["good", "good/elsewhere"].map(|name| {
        let folder = with(name, DESCRIPTION, &example("first_k.wgsl"));
        let loaded = load(&Description::read(&folder.join("own.fragbuf")).unwrap(), &[], &[], &Registry::builtin());
        let targets: Vec<&'static Target> = TARGETS.iter().collect();
        let request = Request { targets: &targets, form: Form::Program, prefix: "own", group: 3 };
        generate(&loaded.variant.unwrap(), &request, &Registry::builtin()).unwrap().files
    });
    assert!(texts[0] == texts[1]);
    assert!(texts[0].iter().any(|file| String::from_utf8_lossy(&file.bytes).contains("// ---- mine.wgsl\n")));
}

/// A buffer with k elements requires a k.
#[test]
fn a_storage_of_k_slots_does_not_keep_all() {
    let folder = with("keep-all", &DESCRIPTION.replace("keep 8", "keep all"), &example("first_k.wgsl"));
    let (diagnostics, _) = diagnostics(&folder).unwrap_err();
    let found: Vec<_> = diagnostics
        .iter()
        .map(|diagnostic| (diagnostic.code.name, diagnostic.span.line, diagnostic.span.column))
        .collect();
    assert_eq!(found, [("keep-mismatch", 3, 10)], "{diagnostics}");
    assert!(diagnostics.to_string().contains("write `keep 8;`"), "{diagnostics}");
}

/// The statements of user files are untested, so naga writes bounds checks.
#[test]
fn programs_with_a_file_are_guarded_at_run_time() {
    let of = |description: &Description| {
        let loaded = load(description, &[], &[], &Registry::builtin());
        let request = Request { targets: &[target("msl").unwrap()], form: Form::Program, prefix: "", group: 0 };
        let files = generate(&loaded.variant.unwrap(), &request, &Registry::builtin()).unwrap().files;
        files.iter().map(|file| String::from_utf8_lossy(&file.bytes).into_owned()).collect::<String>()
    };
    let folder = with("guarded", DESCRIPTION, &example("first_k.wgsl"));
    let guarded = of(&Description::read(&folder.join("own.fragbuf")).unwrap());
    let trusted = of(&Description::Technique("ab_ll".to_owned()));
    // Indices are clamped to the buffer's size, loops to 2^32 iterations.
    for word in ["metal::min(unsigned(", "loop_bound"] {
        assert!(guarded.contains(word) && !trusted.contains(word), "{word}");
    }
}

/// Every axis accepts a file. A sort has no buffers or passes, and its capabilities count like those of any other row.
#[test]
fn a_sort_in_a_user_file() {
    let sort = std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("templates/sort/insertion.wgsl"));
    let head = "//: sort -- each into its place\n//: provides sorted\n\
                //: parameter layers LAYERS = capacity, from 1 to 4096 -- fragments that a resolve pass holds\n\n";
    let file = format!("{head}{}", sort.unwrap());
    let description = "buffer Own from ab_ll {\n    sort: wgsl(\"mine.wgsl\") { layers: 9 };\n}\n";
    assert_eq!(
        diagnostics(&with("sort", description, &file)).map_err(|(diagnostics, _)| diagnostics.to_string()),
        Ok(())
    );
    let unsorted = file.replace("//: provides sorted\n", "");
    let (diagnostics, _) = diagnostics(&with("unsorted", description, &unsorted)).unwrap_err();
    assert!(
        diagnostics.iter().all(|diagnostic| diagnostic.code == codes::MISSING_CAPABILITY && diagnostic.help.contains("`sort: shell`")),
        "{diagnostics}"
    );
}

/// A row declares conditions on the description with a suggested fix.
#[test]
fn a_condition_of_the_users_own() {
    let file = example("first_k.wgsl");
    let with_condition = |line: &str| file.replace("//: suits", &format!("{line}\n//: suits"));
    let four = with_condition("//: when keep == 4 && payload_words <= 2 -- write `keep 4;`, and leave the payload out");
    let (unmet, _) = diagnostics(&with("condition", DESCRIPTION, &four)).unwrap_err();
    let said = unmet.to_string();
    assert!(
        unmet.iter().all(|diagnostic| diagnostic.code == codes::MISSING_CAPABILITY)
            && said.contains("requires `keep == 4"),
        "{said}"
    );
    assert!(said.contains("= help: write `keep 4;`, and leave the payload out"), "{said}");
    // The help is the author's, at the line that violates the condition.
    let six = with_condition("//: when keep <= 6 -- write `keep 6;` or less");
    let (unmet, _) = diagnostics(&with("condition_of_keep", DESCRIPTION, &six)).unwrap_err();
    let unmet = unmet.iter().next().unwrap();
    assert_eq!((unmet.span.line, unmet.span.column), (3, 10), "{unmet}");
    assert!(unmet.help.starts_with("write `keep 6;` or less"), "{unmet}");
    let met = DESCRIPTION.replace("keep 8", "keep 4");
    assert_eq!(
        diagnostics(&with("condition_met", &met, &four)).map_err(|(diagnostics, _)| diagnostics.to_string()),
        Ok(())
    );
    for (line, code, help) in [
        ("//: when k == 4 -- write `keep 4;`", codes::INVALID_ROW, "the formula may use keep, limited"),
        ("//: requires keep-best", codes::UNKNOWN_CAPABILITY, "`keeps-best`"),
        ("//: provides fragment-atomics", codes::UNKNOWN_CAPABILITY, "`//: requires fragment-atomics`"),
        ("//: implies sorted when depth-key", codes::INVALID_ROW, "depth_key"),
    ] {
        let (diagnostics, _) = diagnostics(&with("condition_unread", DESCRIPTION, &with_condition(line))).unwrap_err();
        let is_it = |diagnostic: &&fragbuf::Diagnostic| diagnostic.code == code && diagnostic.help.contains(help);
        assert!(diagnostics.iter().find(is_it).is_some(), "{line}: {diagnostics}");
    }
}

/// A row in a file has what rows of the registry have: conditional features, restricted options, definitions and extra words.
#[test]
fn a_row_declares_features_options_symbols_and_words() {
    let lines = "//: parameter page PAGE = 8, from 1 to 64, power of two, at least k / 8 -- entries of a page\n\
                 //: parameter by BY = 0, attribute -- an attribute\n\
                 //: requires u64-atomics when PAGE > 8\n\
                 //: defines n = ceil_div(fragments, pixels) + keep\n\
                 //: adds mask from sample_mask\n//: provides";
    let file = example("first_k.wgsl").replace("//: provides", lines);
    let registry = Registry::builtin();
    let checked = |name: &str, options: &str| {
        let description = DESCRIPTION.replace("wgsl\")", &format!("wgsl\") {{ {options} }}"));
        let read = Description::read(&with(name, &description, &file).join("own.fragbuf")).unwrap();
        load(&read, &[], &[], &registry).variant
    };
    let generated = |name: &str, options: &str| {
        let targets = [target("wgsl").unwrap(), target("spirv").unwrap(), target("glsl-es").unwrap()];
        let request = Request { targets: &targets, form: Form::Program, prefix: "", group: 0 };
        let variant = checked(name, options).unwrap_or_else(|errors| panic!("{errors}"));
        generate(&variant, &request, &registry).unwrap_or_else(|errors| panic!("{errors}"))
    };
    let unsupported = |generation: &fragbuf::Generation| {
        generation.unsupported.iter().map(|(target, missing)| (target.name, missing.feature.name())).collect::<Vec<_>>()
    };
    let small = generated("row-small", "page: 4, by: depth");
    let plan = &small.plans[0].plan;
    assert_eq!(unsupported(&small), [("glsl-es", "coverage".to_owned())]);
    assert_eq!((plan.symbols.number_of("PAGE"), plan.symbols.number_of("BY")), (Some(4), Some(1)));
    let n = plan.symbols.find("n").unwrap();
    let frame = |id| match plan.symbols.get(id).name.as_ref() {
        "width" | "height" => Some(4),
        "fragments" => Some(40),
        _ => None,
    };
    assert_eq!(plan.symbols.value(n, &frame), Ok(11));
    let store = small.files.iter().find(|file| file.pass == "store" && file.target == "wgsl").unwrap();
    assert!(String::from_utf8_lossy(&store.bytes).contains("@builtin(sample_mask) mask: u32"));
    let large = generated("row-large", "page: 16");
    assert_eq!(unsupported(&large)[0], ("wgsl", "u64-atomics".to_owned()));
    for options in ["page: 3", "page: 0"] {
        let errors = checked("row-wrong", options).unwrap_err();
        assert!(errors.iter().all(|error| error.code == codes::INVALID_OPTION), "{errors}");
    }
}

/// Returns code, line, column and help of each diagnostic, all in the user's file.
fn placed(name: &str, description: &str, file: &str) -> Vec<(&'static str, u32, u32, String)> {
    let folder = with(name, description, file);
    let Err((diagnostics, _)) = diagnostics(&folder) else { return Vec::new() };
    let own = folder.join("mine.wgsl").display().to_string();
    assert!(diagnostics.iter().all(|diagnostic| *diagnostic.span.file == *own), "{diagnostics}");
    diagnostics
        .iter()
        .map(|diagnostic| (diagnostic.code.name, diagnostic.span.line, diagnostic.span.column, diagnostic.help.clone()))
        .collect()
}

/// The default of a parameter depends on the description and must be in range.
#[test]
fn a_default_outside_of_its_range_is_said_where_it_stands() {
    let file = example("first_k.wgsl");
    for (index, (default, is_right)) in [
        ("capacity - 3", true),
        ("capacity * 2", false),
        ("capacity - 9", false),
        ("pow2(32) + 4", false),
        ("pow2(capacity * 8)", false),
        ("7 / (capacity - 8)", false),
        ("keep + limited", true),
    ]
    .into_iter()
    .enumerate()
    {
        let line = format!("//: parameter limit LIMIT = {default}, from 2 to 9");
        let file = file.replace("//: provides", &format!("{line}\n//: provides"));
        let found = placed(&format!("default-{index}"), DESCRIPTION, &file);
        let (line, column) = position(&file, &format!("{default}, from"));
        assert_eq!(found.is_empty(), is_right, "{default}: {found:?}");
        let is_it = |(code, at, from, help): &(&str, u32, u32, String)| {
            (*code, *at, *from) == ("invalid-row", line, column) && !help.is_empty()
        };
        assert!(found.len() <= 1 && found.iter().all(is_it), "{default} at {line}:{column}: {found:?}");
    }
}

/// The help for an invalid default is a value that the description may set, if there is one.
#[test]
fn the_help_for_an_invalid_default_is_valid() {
    for (index, (restricted, proposed)) in [
        ("3, from 3 to 64, power of two", Some("{ size: 4 }")),
        ("1, from 0 to 64, at least k", Some("{ size: 8 }")),
        ("9, from 0 to 20, power of two, at least k + 1", Some("{ size: 16 }")),
        ("7, attribute", Some("{ size: color }")),
        ("1, from 0 to 4, at least k", None),
        ("3, from 3 to 3, power of two", None),
    ]
    .into_iter()
    .enumerate()
    {
        let line = format!("//: parameter size SIZE = {restricted}\n//: provides");
        let file = example("first_k.wgsl").replace("//: provides", &line);
        let found = placed(&format!("help-{index}"), DESCRIPTION, &file);
        let [(_, _, _, help)] = found.as_slice() else { panic!("{restricted}: {found:?}") };
        match proposed {
            Some(options) => {
                assert!(help.contains(options), "{restricted}: {help}");
                let description = DESCRIPTION.replace("wgsl\")", &format!("wgsl\") {options}"));
                assert_eq!(placed(&format!("helped-{index}"), &description, &file), [], "{restricted}");
            }
            None => assert!(help.contains("no value of `size` is valid"), "{restricted}: {help}"),
        }
    }
}

/// A word of a file must not be another of the fragment: neither by its name nor by its built-in value.
#[test]
fn words_of_fragments_are_different() {
    let file = |word: &str| {
        example("first_k.wgsl").replace("//: provides", &format!("//: adds {word} from sample_mask\n//: provides"))
    };
    let with_line = |line: &str| DESCRIPTION.replace("    keep", &format!("    {line}\n    keep"));
    let attribute = with_line("fragment { mask: u32, depth: f32 }");
    for (name, description, file, line, help) in [
        ("value", with_line("samples: coverage;"), file("mask"), 3, "remove the word"),
        ("attribute", attribute, file("mask"), 3, "rename one of the two"),
    ] {
        let (diagnostics, _) = diagnostics(&with(&format!("words-{name}"), &description, &file)).unwrap_err();
        let found: Vec<_> = diagnostics.iter().map(|found| (found.code, found.span.line)).collect();
        assert_eq!(found, [(codes::DUPLICATE, line)], "{diagnostics}");
        assert!(diagnostics.to_string().contains(help), "{diagnostics}");
    }
    // Generated inputs have the position of the pixel.
    let folder = with("words-position", DESCRIPTION, &file("position"));
    let read = Description::read(&folder.join("own.fragbuf")).unwrap();
    let registry = Registry::builtin();
    let variant = load(&read, &[], &[], &registry).variant.unwrap_or_else(|errors| panic!("{errors}"));
    let request = Request { targets: &[target("wgsl").unwrap()], form: Form::Program, prefix: "", group: 0 };
    generate(&variant, &request, &registry).unwrap_or_else(|errors| panic!("{errors}"));
}

/// A default may use the constants of earlier parameters, as in a row of the registry, but not those of later ones.
#[test]
fn a_default_depends_on_earlier_constants() {
    let lines = |first: &str, second: &str| {
        let parameters = format!("{first}\n{second}\n//: provides");
        example("first_k.wgsl").replace("//: provides", &parameters)
    };
    let (spare, more) =
        ("//: parameter spare SPARE = 2, from 0 to 9", "//: parameter more MORE = SPARE * 3 + capacity, from 0 to 99");
    let folder = with("earlier-constants", DESCRIPTION, &lines(spare, more));
    let read = Description::read(&folder.join("own.fragbuf")).unwrap();
    let registry = Registry::builtin();
    let variant = load(&read, &[], &[], &registry).variant.unwrap_or_else(|errors| panic!("{errors}"));
    let request = Request { targets: &[target("wgsl").unwrap()], form: Form::Program, prefix: "", group: 0 };
    let generation = generate(&variant, &request, &registry).unwrap();
    assert_eq!(generation.plans[0].plan.symbols.number_of("MORE"), Some(14));

    let file = lines(more, spare);
    let found = placed("later-constants", DESCRIPTION, &file);
    let (line, column) = position(&file, "SPARE * 3");
    let places: Vec<_> = found.iter().map(|(code, at, from, _)| (*code, *at, *from)).collect();
    assert_eq!(places, [("invalid-row", line, column)], "{found:?}");
}

/// Returns lengths with every operator, also deep and long ones, and whether shaders and devices can compute them for `keep 8`.
fn lengths() -> Vec<(String, bool)> {
    let right = [
        "log2_ceil(k) + log2_ceil(capacity + 1)",
        "1 + (k < n) + (k <= n) + (k > n) + (k >= n) + (k == n) + (k != n)",
        "k < 3 && n < 4",
        "k < 3 && n || fragments == 1 && (keep > 7)",
        "(k && n) * (k || 0)",
        "pow2(k + log2_ceil(n)) / ceil_div(k, n) - ceil_div(max(k, 2), min(n, capacity))",
        "pixels * (pow2(32) / pow2(32))",
        "n / LIMIT",
        "pow2(40) / pow2(20)",
        "4294967295",
    ];
    let wrong = [
        "4294967296",
        "k + 18446744073709551615",
        "99999999999999999999",
        "pow2(32)",
        "k * pow2(capacity * 4)",
        "k / 0",
        "n / (capacity - 8)",
        "ceil_div(n, limited - 1)",
        "k + 1 / 0",
        "3 - capacity",
        "k / (LIMIT - 3)",
        "pow2(64)",
        "1 < k < 9",
        "4294967295 * 4294967295 * k * 4294967295",
    ];
    let chain = |sign: &str| format!("k{}", format!(" {sign} n").repeat(98));
    let nested = |open: &str, close: &str| format!("{}k{}", open.repeat(39), close.repeat(39));
    let deep = ["+", "*", "&&", "||"].map(chain).into_iter().chain([
        nested("pow2(", ")"),
        nested("log2_ceil(", ")"),
        nested("min(n, ", ")"),
        nested("max(", ", n)"),
        nested("ceil_div(", ", n)"),
        nested("(n == ", ")"),
        nested("(n || ", ")"),
        nested("(1 + n * ", ")"),
    ]);
    let right = right.map(str::to_owned).into_iter().chain(deep);
    // Every symbol that a row of the registry may use in a size.
    let symbols = SYMBOLS.iter().filter(|symbol| symbol.when != BindingTime::Iteration);
    let right = right.chain(symbols.map(|symbol| format!("{} + 1", symbol.name)));
    right.map(|text| (text, true)).chain(wrong.map(|text| (text.to_owned(), false))).collect()
}

/// A length is valid in every shader language and in Rust, or is reported at its span.
#[test]
fn every_length_is_valid_or_a_mistake() {
    let (good, all) = (example("first_k.wgsl"), folder("lengths"));
    let mut rust = String::new();
    for (index, (length, is_right)) in lengths().into_iter().enumerate() {
        let file = good
            .replace("[pixel < pixels]: entry", &format!("[pixel < {length}]: entry"))
            .replace("//: buffer taken", "//: parameter limit LIMIT = 3, from 1 to 9\n//: buffer taken");
        let name = format!("length-{index}");
        if !is_right {
            let found = placed(&name, DESCRIPTION, &file);
            let (line, column) = position(&file, &format!("{length}]: entry"));
            let places: Vec<_> = found.iter().map(|(code, at, from, _)| (*code, *at, *from)).collect();
            assert_eq!(places, [("invalid-row", line, column)], "{length}: {found:?}");
            assert!(found.iter().all(|(.., help)| !help.is_empty()));
            continue;
        }
        let description = Description::read(&with(&name, DESCRIPTION, &file).join("own.fragbuf")).unwrap();
        let variant = load(&description, &[], &[], &Registry::builtin()).variant.unwrap_or_else(|e| panic!("{e}"));
        let targets: Vec<&'static Target> = ["wgsl", "glsl", "spirv", "msl"].map(|name| target(name).unwrap()).into();
        let request = Request { targets: &targets, form: Form::Program, prefix: "", group: 0 };
        let made = generate(&variant, &request, &Registry::builtin()).unwrap_or_else(|e| panic!("{length}: {e}"));
        validate(made.files.iter());
        for file in made.files.iter() {
            std::fs::create_dir_all(all.join(&name).join(&file.path).parent().unwrap()).unwrap();
            std::fs::write(all.join(&name).join(&file.path), &file.bytes).unwrap();
        }
        let module = format!("length_{index}");
        rust.push_str(&fragbuf::build::bindings(&module, &length, &made, 0, &name));
        let _ = writeln!(rust, "pub use {module}::plan::buffers::slots::bytes as bytes_{index};");
    }
    std::fs::write(all.join("lib.rs"), rust).unwrap();
    let rustc = std::process::Command::new("rustc")
        .args(["--edition", "2024", "--crate-type", "lib", "--emit", "metadata", "-D", "warnings", "lib.rs"])
        .current_dir(&all)
        .output()
        .unwrap();
    assert!(rustc.status.success(), "{}", String::from_utf8_lossy(&rustc.stderr));
}

/// `keep` exceeds 32 bits for `keep all` only.
#[test]
fn a_length_depends_on_what_is_kept() {
    let list = |length: &str| {
        example("first_k.wgsl")
            .replace("[slot < k]", "[slot < 9]")
            .replace("[pixel < pixels]: entry", &format!("[pixel < {length}]: entry"))
    };
    let all = DESCRIPTION.replace("keep 8", "keep all");
    let capabilities = |file: String| file.replace("//: provides lock-free,", "//: provides lock-free, keeps-all,");
    for (index, (length, is_right)) in
        [("keep", false), ("limited * keep + 3", true), ("min(keep, 9)", true)].into_iter().enumerate()
    {
        let file = capabilities(list(length)).replace("frame.k", "9u");
        let found = placed(&format!("all-{index}"), &all, &file);
        let (line, column) = position(&file, &format!("{length}]: entry"));
        assert_eq!(found.is_empty(), is_right, "{length}: {found:?}");
        assert!(
            found.iter().all(|(code, at, from, _)| (*code, *at, *from) == ("invalid-row", line, column)),
            "{found:?}"
        );
    }
}

/// The size of a buffer is the product of its lengths, for all operators.
#[test]
fn sizes_are_products_of_whole_lengths() {
    for (index, (length, size)) in [
        ("k+1", "k * (k+1) * entry_words"),
        ("(n + 1) / 2", "k * ((n + 1) / 2) * entry_words"),
        ("n / 2 * 2", "k * (n / 2 * 2) * entry_words"),
        ("2 * (n + 1)", "k * 2 * (n + 1) * entry_words"),
        ("k == n", "k * (k == n) * entry_words"),
        ("ceil_div(n, 2) + 1", "k * (ceil_div(n, 2) + 1) * entry_words"),
    ]
    .into_iter()
    .enumerate()
    {
        let file = example("first_k.wgsl").replace("[pixel < pixels]: entry", &format!("[pixel < {length}]: entry"));
        let folder = with(&format!("size-{index}"), DESCRIPTION, &file);
        let description = Description::read(&folder.join("own.fragbuf")).unwrap();
        let variant = load(&description, &[], &[], &Registry::builtin()).variant.unwrap();
        let request = Request { targets: &[target("wgsl").unwrap()], form: Form::Program, prefix: "", group: 0 };
        let made = generate(&variant, &request, &Registry::builtin()).unwrap();
        let slots = made.plans[0].plan.resource("slots").unwrap();
        assert_eq!(slots.words.to_string(), size);
    }
}

/// The guide's table of symbols equals the vocabulary's.
#[test]
fn the_guide_names_every_symbol_of_conditions() {
    let guide = include_str!("../src/guide/extend.md");
    for Symbol { name: symbol, meaning, .. } in fragbuf::vocabulary::DescriptionValues::symbols() {
        assert!(guide.contains(&format!("| `{symbol}` | {meaning} |")), "`{symbol}` | {meaning}");
    }
}

/// A help text names the file as a description would.
#[test]
fn hints_name_the_file_as_a_description_does() {
    let file =
        example("first_k.wgsl").replace("suits sync slot_counter", "suits sync spin_lock").replace("lock-free, ", "");
    let description = DESCRIPTION.replace("keep 8", "sync: slot_counter; keep 8");
    let (diagnostics, _) = diagnostics(&with("help", &description, &file)).unwrap_err();
    assert!(diagnostics.to_string().contains("`storage: wgsl(\"mine.wgsl\")` does not provide it"), "{diagnostics}");
}

/// A name that a template of the program also declares is reported.
#[test]
fn a_private_name_of_a_template_is_taken() {
    let file = example("first_k.wgsl").replace("fn first_k_cursor", "const FREE = 1u;\n\nfn first_k_cursor");
    let description = DESCRIPTION.replace("keep 8", "sync: spin_lock; keep 8");
    let (diagnostics, _) = diagnostics(&with("private", &description, &file)).unwrap_err();
    let found: Vec<_> =
        diagnostics.iter().map(|diagnostic| (diagnostic.code.name, diagnostic.message.as_str())).collect();
    assert_eq!(found, [("invalid-wgsl", "`FREE` is also declared in sync/spin_lock.wgsl")], "{diagnostics}");
}

const PADDED: &str = "// Rows of whole fours.

//: addressing -- row after row, each padded to four pixels
//: defines pixels = ceil_div(width, 4) * 4 * height

fn pixel_index(position: vec2<f32>) -> u32 {
    let at = vec2<u32>(position);
    return (at.y - frame.first_row) * padded_width() + at.x;
}

fn pixel_count() -> u32 {
    return padded_width() * frame.height;
}

fn padded_width() -> u32 {
    return (frame.width + 3u) / 4u * 4u;
}
";

/// An addressing defines the padding of the frame, and every size includes it.
#[test]
fn an_addressing_of_the_users_own() {
    let description = "buffer Own from ab_sb {\n    addressing: wgsl(\"mine.wgsl\");\n}\n";
    let folder = with("addressing", description, PADDED);
    assert_eq!(diagnostics(&folder).map_err(|(diagnostics, _)| diagnostics.to_string()), Ok(()));
    let read = Description::read(&folder.join("own.fragbuf")).unwrap();
    let registry = Registry::builtin();
    let request = Request { targets: &[target("wgsl").unwrap()], form: Form::Program, prefix: "", group: 0 };
    let variant = load(&read, &[], &[], &registry).variant.unwrap();
    let generation = generate(&variant, &request, &registry).unwrap();
    let symbols = &generation.plans[0].plan.symbols;
    let PlanValue::Default(pixels) = &symbols.get(SymbolId::PIXELS).value else { panic!("pixels are defined") };
    assert_eq!(pixels.to_string(), "ceil_div(width, 4) * 4 * height");
    let manifest = fragbuf::manifest(&generation, 0);
    let symbols = manifest["symbols"].as_array().unwrap();
    let pixels = symbols.iter().find(|symbol| symbol["name"] == "pixels").unwrap();
    assert_eq!(pixels["default"], "ceil_div(width, 4) * 4 * height");
    for (from, to, at) in [("pixels =", "width =", "`width`"), ("* height", "* depth", "depth")] {
        let (diagnostics, _) = diagnostics(&with("padded", description, &PADDED.replace(from, to))).unwrap_err();
        assert!(
            diagnostics.iter().any(|diagnostic| diagnostic.message.contains(at) || diagnostic.help.contains("pixels")),
            "{diagnostics}"
        );
    }
}

/// A row without a pass that computes the effect, and a buffer whose words nothing sets, are warnings at the row and at the buffer. The fix
/// that the help prints removes them.
#[test]
fn what_a_row_leaves_out_is_a_warning() {
    let file = example("first_k.wgsl");
    let resolve = "//: pass resolve: taken read, slots read\n";
    let clear = ", clear 0 -- fragments";
    for (changed, code, at, fix) in [
        (file.replace(resolve, ""), "unused-effect", "//: storage", resolve.trim_end()),
        (file.replace(clear, " -- fragments"), "missing-clear", "//: buffer taken", "clear 0"),
    ] {
        assert_ne!(changed, file);
        let folder = with(&format!("left-out-{code}"), DESCRIPTION, &changed);
        let description = Description::read(&folder.join("own.fragbuf")).unwrap();
        let warnings = load(&description, &[], &[], &Registry::builtin()).variant.unwrap().warnings.clone();
        let all: Vec<_> = warnings.iter().collect();
        let [warning] = all.as_slice() else { panic!("{warnings}") };
        let line = 1 + changed.lines().position(|line| line.starts_with(at)).unwrap() as u32;
        assert_eq!((warning.code.name, warning.span.line), (code, line), "{warning}");
        assert!(warning.span.file.ends_with("mine.wgsl") && warning.help.contains(&format!("`{fix}`")), "{warning}");
    }
    for persistent in [file.replace(clear, ", persistent -- fragments"), file.replace("clear 0", "clear 7"), file] {
        let folder = with("left-out-nothing", DESCRIPTION, &persistent);
        let description = Description::read(&folder.join("own.fragbuf")).unwrap();
        let variant = load(&description, &[], &[], &Registry::builtin()).variant.unwrap();
        assert_eq!(variant.warnings.iter().count(), 0, "{}", variant.warnings);
    }
}

/// `--set` chooses a user file by its path from the current folder, and options of a value; errors are inside the argument.
#[test]
fn a_file_and_options_are_chosen_from_outside() {
    let folder = with("outside", "buffer Own from kplus_array { keep 8; }", &example("first_k.wgsl"));
    let run = |set: &[&str]| {
        let mut command = std::process::Command::new(env!("CARGO_BIN_EXE_fragbuf"));
        command.args(["show", "own.fragbuf"]).current_dir(&folder);
        for set in set {
            command.args(["--set", set]);
        }
        let output = command.output().unwrap();
        (output.status.success(), String::from_utf8(output.stderr).unwrap())
    };
    for file in ["storage=mine.wgsl", "storage=wgsl(mine.wgsl)", "storage=wgsl(\"mine.wgsl\")", "storage=./mine.wgsl"] {
        let (is_right, text) = run(&[file, "sync=slot_counter", "cull=none"]);
        assert!(is_right, "{file}: {text}");
    }
    for right in ["sync=spin_lock { limit: 4 }", "sync=interlock else spin_lock { limit: 4 }"] {
        let (is_right, text) = run(&[right]);
        assert!(is_right, "{right}: {text}");
    }
    for (wrong, code, column, help) in [
        ("sync=spin_lock { limt: 4 }", "unknown-option", 18, "did you mean `limit`?"),
        ("sync=spin_lock { limit 4 }", "unexpected-token", 24, "write `limit: 4`"),
        ("sync=spin_lock(limit: 4)", "unexpected-token", 15, "sync=spin_lock { limit: 4096 }"),
        ("storage=yours.wgsl", "missing-file", 9, "relative to the current folder"),
        ("storage=max_array else yours.wgsl", "missing-file", 24, "relative to the current folder"),
        ("storage=/no/mine.wgsl", "missing-file", 9, "relative to the current folder"),
        ("sync=spin_lock { limit: 4", "invalid-token", 16, "add the `}`"),
    ] {
        let (is_right, text) = run(&[wrong]);
        assert!(!is_right, "{wrong}");
        assert!(text.contains(&format!("error[{code}]")) && text.contains(help), "{wrong}: {text}");
        assert!(text.contains(&format!("--set:1:{column}")), "{wrong}: {text}");
    }
}
