//! The page of `fragbuf playground`, used as a person would, in headless Chromium: `tests/playground/` has the scenarios. No scenario compares
//! screenshots.

use std::collections::BTreeSet;
use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::playground_requests::Server;

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn page() -> PathBuf {
    root().join("src/cli/playground/page")
}

fn run(scenarios: &[&str]) {
    let server = Server::start(&[]);
    run_at(format!("http://{}/", server.address), scenarios);
}

/// Runs scenarios of a server, or of the folder of a site, in one browser; each has a page of its own.
pub fn run_at(place: impl AsRef<OsStr>, scenarios: &[&str]) {
    let folder = root().join("tests/playground");
    let is_installed = folder.join("node_modules/playwright-core").exists();
    assert!(is_installed, "Playwright must be installed: run `npm ci` in tests/playground (see README)");
    let mut command = Command::new("node");
    command.arg("drive.mjs").arg(place).args(scenarios).current_dir(folder);
    // Other tests use the machine at the same time.
    command.env("PATIENCE", "180000").env("FRAGBUF", env!("CARGO_BIN_EXE_fragbuf"));
    let output = command.output();
    let output = output.unwrap_or_else(|error| panic!("Node must be installed, Debian's package is `nodejs`: {error}"));
    let [printed, errors] = [output.stdout, output.stderr].map(|bytes| String::from_utf8_lossy(&bytes).into_owned());
    assert!(output.status.success(), "{}\n{printed}\n{errors}", output.status);
    print!("{printed}");
    let ran = printed.lines().filter_map(|line| line.strip_prefix("ok")?.split_whitespace().next()).collect();
    assert_eq!(BTreeSet::from_iter(scenarios.iter().copied()), ran, "{printed}");
}

#[test]
fn the_editor_answers_as_text_is_typed() {
    run(&[
        "a_mistake_shows_its_message_and_its_way_out_repairs_it",
        "the_place_of_a_problem_leads_to_it",
        "an_answer_that_comes_too_late_is_dropped",
        "fixes_of_an_earlier_text_are_not_applied",
        "nothing_moves_while_text_is_typed",
        "a_name_is_explained_by_pointer_and_keyboard",
        "completion_greys_what_is_illegal_with_its_reason",
    ]);
}

#[test]
fn controls_change_the_picture() {
    run(&[
        "sliders_change_the_picture",
        "scene_and_size_change_the_picture",
        "a_model_is_opened_and_dropped",
        "a_preset_replaces_the_description",
    ]);
}

#[test]
fn panels_show_costs_axes_verdicts_and_differences() {
    run(&[
        "costs_are_those_of_the_frame",
        "a_histogram_of_an_earlier_picture_is_not_shown",
        "depth_complexity_is_explained_without_k",
        "an_axis_is_chosen_in_the_table",
        "an_axis_of_an_earlier_text_is_not_chosen",
        "the_checker_shows_a_failing_schedule",
        "a_check_can_be_cancelled",
        "the_newest_check_counts",
        "a_verdict_about_another_text_is_marked",
        "a_check_from_the_table_keeps_the_focus",
        "two_descriptions_are_compared",
    ]);
}

#[test]
fn links_restore_a_page_as_far_as_it_has_what_they_name() {
    run(&[
        "a_link_restores_the_page",
        "a_link_in_an_open_page_replaces_its_values",
        "a_link_that_names_what_is_missing_is_reported",
        "a_damaged_link_is_reported",
        "a_list_of_devices_that_fails_is_reported",
    ]);
}

#[test]
fn the_whole_page_works_by_keyboard_in_every_window() {
    run(&[
        "everything_works_by_keyboard_alone",
        "the_focus_is_visible",
        "every_control_has_a_name",
        "every_window_has_a_layout",
        "light_and_dark_have_contrast",
        "text_is_shown_copied_and_downloaded",
        "a_generated_line_leads_to_its_origin",
        "an_error_of_a_request_is_shown",
        "two_pages_work_at_once",
    ]);
}

#[test]
fn webgpu_in_the_page_draws_the_picture() {
    run(&[
        "webgpu_draws_what_the_cpu_device_draws",
        "a_device_of_the_server_is_chosen",
        "a_frame_of_an_earlier_scene_is_not_shown",
        "fragments_are_those_that_the_cpu_device_counts",
        "lost_fragments_are_shown",
        "webgpu_times_are_shown_by_pass",
        "webgpu_without_timestamps_shows_the_time_of_the_frame",
    ]);
}

/// Every scenario of these modules is listed above, and none twice.
#[test]
fn every_scenario_runs() {
    let modules = ["links", "panels", "picture", "typing", "webgpu", "whole"];
    assert_eq!(scenarios_of(&modules), listed_in(include_str!("playground.rs")));
}

/// Returns the scenarios that modules of `tests/playground` export, in order.
pub fn scenarios_of(modules: &[&str]) -> Vec<String> {
    let mut names = Vec::new();
    for module in modules {
        let text = std::fs::read_to_string(root().join(format!("tests/playground/{module}.mjs"))).unwrap();
        let before = names.len();
        let exported = text.lines().filter_map(|line| line.strip_prefix("export async function ")?.split('(').next());
        names.extend(exported.map(str::to_owned));
        assert!(names.len() > before, "{module}.mjs has no scenario");
    }
    names.sort();
    names
}

/// Returns the scenarios that a file of tests runs, in order: a line each.
pub fn listed_in(tests: &str) -> Vec<String> {
    let name = |line: &str| Some(line.trim().strip_prefix('"')?.strip_suffix("\",")?.to_owned());
    let mut names: Vec<String> = tests.lines().filter_map(name).collect();
    names.sort();
    names
}

/// The bundle of CodeMirror was built from the lock file, and has the licences of what it contains.
#[test]
fn the_bundle_is_that_of_the_lock_file() {
    let read = |name: &str| std::fs::read_to_string(page().join("vendor").join(name)).unwrap();
    let [bundle, licences] = ["codemirror.mjs", "LICENSES.txt"].map(read);
    let lock: serde_json::Value = serde_json::from_str(&read("package-lock.json")).unwrap();
    let head = bundle.split("*/").next().unwrap();
    let packages: Vec<(&str, &str)> = head
        .lines()
        .filter_map(|line| line.strip_prefix(" * ")?.split_once(' '))
        .filter(|(name, _)| *name != "CodeMirror")
        .collect();
    assert!(packages.len() >= 9, "{head}");
    assert_eq!(licences.matches("Permission is hereby granted").count(), packages.len(), "a licence is missing");
    for (name, version) in packages {
        let package = &lock["packages"][format!("node_modules/{name}")];
        assert_eq!(package["version"], version, "{name}: run vendor/bundle.sh");
        assert_eq!(package["license"], "MIT", "{name}");
        assert!(licences.contains(&format!("{name} {version}\n\n")), "{name}: run vendor/bundle.sh");
    }
}

/// A file of the page that the binary does not have would be a part of the page that never loads.
#[test]
fn every_file_of_the_page_is_in_the_binary() {
    let assets = std::fs::read_to_string(root().join("src/cli/playground/assets.rs")).unwrap();
    let names = std::fs::read_dir(page()).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap());
    let is_sent = |name: &String| [".mjs", ".css", ".html"].iter().any(|end| name.ends_with(end));
    let names: Vec<String> = names.filter(is_sent).collect();
    assert!(names.len() > 30, "{names:?}");
    for name in names {
        assert!(assets.contains(&format!("\"{name}\"")), "{name}");
    }
    assert!(assets.contains("\"vendor/codemirror.mjs\""));
}

/// The page loads nothing from elsewhere, and no text becomes markup or code.
#[test]
fn the_page_names_no_other_server() {
    for entry in std::fs::read_dir(page()).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_some_and(|extension| ["mjs", "html", "css"].iter().any(|other| extension == *other)) {
            let text = std::fs::read_to_string(&path).unwrap().replace("http://www.w3.org/2000/svg", "");
            for forbidden in
                ["http://", "https://", "innerHTML", "outerHTML", "insertAdjacentHTML", "eval(", "new Function"]
            {
                assert!(!text.contains(forbidden), "{}: {forbidden}", path.display());
            }
        }
    }
}
