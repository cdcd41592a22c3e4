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
        assert_eq!(output.stderr.is_empty(), code == 0 || !output.stdout.is_empty(), "{arguments:?}");
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
