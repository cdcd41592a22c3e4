//! Tests `fragbuf check` as scripts and readers use it: exit codes, JSON, and every block of the guide.

use std::process::{Command, Output};

use serde_json::Value;

fn fragbuf(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_fragbuf"))
        .args(arguments)
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .output()
        .unwrap()
}

fn text(output: &[u8]) -> String {
    String::from_utf8(output.to_vec()).unwrap()
}

/// Every command in the guide is followed by its output, except the one that prints a page of JSON.
#[test]
fn the_guide_shows_the_output_of_its_commands() {
    let guide = std::fs::read_to_string("src/guide/check.md").unwrap();
    let (mut shown, mut real) = (0, guide.split("```sh\n").next().unwrap().to_owned());
    for part in guide.split("```sh\n").skip(1) {
        let (command, rest) = part.split_once("\n```\n\n").unwrap();
        real += &format!("```sh\n{command}\n```\n\n");
        let Some(expected) = rest.strip_prefix("```text\n") else {
            real += rest;
            continue;
        };
        let arguments: Vec<&str> = command.split(' ').skip(1).collect();
        let (_, after) = expected.split_once("```").unwrap();
        real += &format!("```text\n{}```{after}", text(&fragbuf(&arguments).stdout));
        shown += 1;
    }
    assert_eq!(shown, 7);
    if std::env::var("INSTA_UPDATE").is_ok_and(|update| update == "always") {
        std::fs::write("src/guide/check.md", &real).unwrap();
    }
    assert_eq!(guide, real, "the guide is out of date: INSTA_UPDATE=always updates it");
    let shader = std::fs::read_to_string("examples/checked/slots.wgsl").unwrap();
    assert!(guide.contains(&format!("```wgsl\n{shader}```")));
}

#[test]
fn the_exit_code_is_the_verdict() {
    for (arguments, code) in [
        (&["check", "ab_ll", "--fragments", "2"][..], 0),
        (&["check", "z_buffer"], 0),
        (&["check", "kb", "--fragments", "2"], 1),
        (&["check", "ab_ll", "--fragments", "2", "--states", "3"], 4),
        (&["check", "no_such_thing"], 1),
        (&["check", "kplus_array", "--set", "sync=interlock", "--target", "wgsl"], 1),
        (&["check", "--wgsl", "examples/checked/slots.wgsl", "--entry", "no_such_entry"], 1),
        (&["check", "--wgsl", "examples/checked/slots.wgsl"], 2),
        (&["check", "kb", "--target", "no_such_target"], 2),
        (&["check"], 2),
        (&["check", "--wgsl", "no/such/file.wgsl", "--entry", "main"], 3),
    ] {
        let output = fragbuf(arguments);
        assert_eq!(output.status.code(), Some(code), "{arguments:?}: {}", text(&output.stderr));
        assert_eq!(output.stderr.is_empty(), matches!(code, 0 | 4) || !output.stdout.is_empty(), "{arguments:?}");
    }
}

#[test]
fn the_verdict_is_printed_as_json() {
    let holds: Value = serde_json::from_slice(&fragbuf(&["check", "ab_sb", "--json"]).stdout).unwrap();
    assert_eq!((&holds["holds"], &holds["exhaustive"]), (&Value::Bool(true), &Value::Bool(true)));
    let fails: Value = serde_json::from_slice(&fragbuf(&["check", "kb", "--json"]).stdout).unwrap();
    assert_eq!((&fails["holds"], &fails["declared_hazard"]), (&Value::Bool(false), &Value::Bool(true)));
    let failure = &fails["failure"];
    assert!(failure["violation"].is_string() && failure["initial_fragments"].is_array(), "{failure}");
    let step = &failure["steps"][0];
    assert!(step["location"].as_str().unwrap().starts_with("storage/sorted_array.wgsl:"), "{step}");
}

/// The programs that the checker runs include the closures of the description.
#[test]
fn a_description_with_closures_is_checked() {
    let output = fragbuf(&["check", "examples/most_visible.fragbuf", "--fragments", "2"]);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    assert!(text(&output.stdout).contains("no failure in any interleaving"));
}

/// Attributes and uniforms are chosen so that constraints admit fragments: of one object, between two limits, of great values.
#[test]
fn constraints_of_every_kind_can_be_checked() {
    let folder = crate::render::folder("check-constraints");
    let descriptions = [
        ("object", "id: u32", "uniform { object: u32 }", "where |f, u| f.id == u.object;"),
        ("between", "heat: f32", "uniform { low: f32, high: f32 }", "where |f, u| f.heat > u.low && f.heat < u.high;"),
        ("great", "heat: f32", "", "where |f| f.heat > 100.0;"),
        ("steps", "heat: f32", "", "keep 4 least |f| f.heat.floor();"),
    ];
    for (name, attribute, uniform, choice) in descriptions {
        let text = format!(
            "buffer B from kplus_array {{ fragment {{ color: rgba8, depth: f32, {attribute} }} {uniform} {choice} sort: insertion; }}"
        );
        let path = folder.join(format!("{name}.fragbuf"));
        std::fs::write(&path, text).unwrap();
        let output = fragbuf(&["check", path.to_str().unwrap(), "--fragments", "2"]);
        assert_eq!(output.status.code(), Some(0), "{name}: {}", text_of_both(&output));
    }
    let none = folder.join("none.fragbuf");
    std::fs::write(&none, "buffer B from kplus_array { where |f| f.depth > 2.0; }").unwrap();
    let output = fragbuf(&["check", none.to_str().unwrap()]);
    assert_eq!(output.status.code(), Some(1));
    assert!(text(&output.stderr).contains("the constraints admit at most 0 of 96"), "{}", text(&output.stderr));
}

fn text_of_both(output: &Output) -> String {
    format!("{}{}", text(&output.stdout), text(&output.stderr))
}

/// A search that was cut decides nothing.
#[test]
fn a_search_that_was_cut_is_no_verdict() {
    let arguments = ["check", "kplus_array", "--fragments", "2", "--states", "20"];
    let output = fragbuf(&arguments);
    assert!(text(&output.stdout).contains("NOT DECIDED: no failure found, but not every state was visited"));
    let json = fragbuf(&[&arguments[..], &["--json"]].concat());
    let json: Value = serde_json::from_slice(&json.stdout).unwrap();
    assert_eq!((&json["holds"], &json["exhaustive"]), (&Value::Null, &Value::Bool(false)));
}

/// What `--wgsl` is told about a file that does not have it.
#[test]
fn unknown_names_are_errors() {
    let shader = ["check", "--wgsl", "examples/checked/slots.wgsl", "--entry", "main"];
    let source = std::fs::read_to_string("examples/checked/slots.wgsl").unwrap();
    let entry = source.split("fn ").find(|part| source.contains(&format!("@fragment\nfn {part}"))).unwrap();
    let entry = entry.split('(').next().unwrap();
    for (more, expected) in [
        (&["--fill", "slot=1"][..], "accesses no buffer or texture `slot`: it accesses"),
        (&["--override", "size=1"], "has no override `size`"),
        (&["--fill", "slots=one"], "`one` is neither an integer of 32 bits nor a finite float"),
    ] {
        let arguments = [&["check", "--wgsl", shader[2], "--entry", entry][..], more].concat();
        let output = fragbuf(&arguments);
        assert_ne!(output.status.code(), Some(0), "{arguments:?}");
        assert!(text(&output.stderr).contains(expected), "{}", text(&output.stderr));
    }
    let other = fragbuf(&shader);
    assert!(text(&other.stderr).contains("has no compute or fragment entry point `main`"), "{}", text(&other.stderr));
}

/// A function that a browser does not have is named in the verdict.
#[test]
fn functions_that_stand_for_fences_are_noted() {
    let folder = std::env::temp_dir().join(format!("fragbuf-check-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let file = folder.join("fence.wgsl");
    let source = "@group(0) @binding(0) var<storage, read_write> n: atomic<u32>;
fn memory_fence() {}
@compute @workgroup_size(1) fn main() { atomicAdd(&n, 1u); memory_fence(); }";
    std::fs::write(&file, source).unwrap();
    let output = fragbuf(&["check", "--wgsl", file.to_str().unwrap(), "--entry", "main"]);
    assert!(text(&output.stdout).contains("note: `memory_fence` stands for an operation that WGSL does not have"));
}

/// The storages of the guide and of the examples hold.
#[test]
fn every_storage_of_the_examples_holds() {
    let mut checked = 0;
    for folder in std::fs::read_dir("examples").unwrap().map(|entry| entry.unwrap().path()).filter(|path| path.is_dir())
    {
        for file in std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()) {
            if file.extension().is_none_or(|extension| extension != "fragbuf")
                || !std::fs::read_to_string(&file).unwrap().contains("storage: wgsl(")
            {
                continue;
            }
            for k in ["1", "2", "3"] {
                let output = fragbuf(&["check", file.to_str().unwrap(), "--k", k]);
                assert_eq!(output.status.code(), Some(0), "{} k = {k}: {}", file.display(), text(&output.stdout));
                checked += 1;
            }
        }
    }
    assert!(checked >= 3);
}

/// A race that is planted in the storage of the guide is found from the report: the word, and both places in the user's file.
#[test]
fn a_race_in_a_users_storage_is_found_from_the_report() {
    let folder = std::env::temp_dir().join(format!("fragbuf-race-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let right = std::fs::read_to_string("examples/user_storage/first_k.wgsl").unwrap();
    let wrong = right.replace("slots_store(slot, pixel, entry);", "slots_store(slot / 2u, pixel, entry);");
    let line = 1 + wrong.lines().position(|line| line.contains("slot / 2u")).unwrap();
    std::fs::write(folder.join("first_k.wgsl"), wrong).unwrap();
    std::fs::copy("examples/user_storage/first_k.fragbuf", folder.join("first_k.fragbuf")).unwrap();
    let description = folder.join("first_k.fragbuf");
    let output = fragbuf(&["check", description.to_str().unwrap(), "--json"]);
    let report: Value = serde_json::from_slice(&output.stdout).unwrap();
    let race = &report["failure"]["race"];
    assert!(race["word"].as_str().unwrap().starts_with("slots[slot 0, pixel "), "{race}");
    for access in ["first", "second"] {
        let location = race[access]["location"].as_str().unwrap();
        assert!(location.ends_with(&format!("first_k.wgsl:{line}")), "{race}");
    }
}

/// A storage that provides neither keeps-best nor keeps-all, and says that it is sorted, is read in the order of depth.
#[test]
fn an_order_that_a_users_storage_promises_is_checked() {
    let folder = std::env::temp_dir().join(format!("fragbuf-sorted-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let right = std::fs::read_to_string("examples/user_storage/first_k.wgsl").unwrap();
    let wrong = right.replace("provides lock-free, indexed", "provides lock-free, indexed, sorted");
    assert_ne!(right, wrong);
    std::fs::write(folder.join("first_k.wgsl"), wrong).unwrap();
    std::fs::copy("examples/user_storage/first_k.fragbuf", folder.join("first_k.fragbuf")).unwrap();
    let description = folder.join("first_k.fragbuf");
    let output = fragbuf(&["check", description.to_str().unwrap(), "--k", "2", "--fragments", "2"]);
    assert_eq!(output.status.code(), Some(1), "{}", text(&output.stdout));
    assert!(text(&output.stdout).contains("the entries are not in order"), "{}", text(&output.stdout));
}

/// A shader whose uniform block is zero may store nothing: the verdict says so, and how to give it words.
#[test]
fn a_shader_that_changes_nothing_is_noted() {
    let folder = std::env::temp_dir().join(format!("fragbuf-nothing-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let file = folder.join("material.wgsl");
    let source = "struct Frame { width: u32, height: u32 }
@group(0) @binding(0) var<uniform> frame: Frame;
@group(0) @binding(1) var<storage, read_write> n: array<atomic<u32>, 4>;
@compute @workgroup_size(1) fn main() {
    if frame.width == 0u { return; }
    atomicAdd(&n[0], 1u);
}";
    std::fs::write(&file, source).unwrap();
    let check = |more: &[&str]| {
        let arguments = ["check", "--wgsl", file.to_str().unwrap(), "--entry", "main"];
        text(&fragbuf(&[&arguments[..], more].concat()).stdout)
    };
    let nothing = check(&[]);
    assert!(nothing.contains("no invocation changes a word of `n`"), "{nothing}");
    assert!(nothing.contains("`frame` hold only 0 here") && nothing.contains("`--fill frame=1,1`"), "{nothing}");
    assert!(!check(&["--fill", "frame=1,1"]).contains("no invocation changes"));
    assert!(check(&["--random-schedules", "4"]).contains("no invocation changes"));
}

/// The note about a loop that waits has the line of the loop, not that of a function that it calls.
#[test]
fn a_loop_that_waits_is_named_by_its_line() {
    let folder = std::env::temp_dir().join(format!("fragbuf-loop-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let file = folder.join("loop.wgsl");
    for (head, first) in [
        ("for (var i = 0u; i < 100u; i++) {", ""),
        ("var i = 0u; loop {", "i++; if i > 100u { break; }"),
        ("var i = 0u; while i < 100u {", "i++;"),
    ] {
        let source = format!(
            "@group(0) @binding(0) var<storage, read_write> n: array<atomic<u32>, 4>;
fn load() -> u32 {{
    return atomicLoad(&n[0]);
}}
@compute @workgroup_size(1) fn main() {{
    atomicAdd(&n[0], 1u);
    {head}
        if load() >= 2u {{ break; }}
        {first}
    }}
}}"
        );
        std::fs::write(&file, source).unwrap();
        let output = text(&fragbuf(&["check", "--wgsl", file.to_str().unwrap(), "--entry", "main"]).stdout);
        assert!(output.contains("loop.wgsl:7 is taken to wait"), "{head}: {output}");
    }
}
