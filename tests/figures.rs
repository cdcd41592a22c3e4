//! `fragbuf figure`: every experiment runs, its files are what they state, and a second run resumes.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::Output;

use crate::render::{folder, fragbuf, stderr};

/// Returns the names that `--list` prints.
fn names() -> Vec<String> {
    let output = fragbuf(&["figure", "--list"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let text = String::from_utf8(output.stdout).unwrap();
    text.lines().map(|line| line.split_whitespace().next().unwrap().to_owned()).collect()
}

/// Runs an experiment with few values.
fn quick(name: &str, device: &str, out: &Path, more: &[&str]) -> Output {
    let common = ["figure", name, "--quick", "--device", device, "--out", out.to_str().unwrap()];
    let output = fragbuf(&[&common, more].concat());
    assert_eq!(output.status.code(), Some(0), "{name}: {}", stderr(&output));
    output
}

fn read(path: PathBuf) -> String {
    std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// Returns the cells of a line without quoted commas.
fn cells(line: &str) -> Vec<String> {
    let mut is_quoted = false;
    let shown = line.chars().map(|letter| {
        is_quoted ^= letter == '"';
        if letter == ',' && !is_quoted { '\n' } else { letter }
    });
    shown.collect::<String>().split('\n').map(str::to_owned).collect()
}

/// Returns the column names and the lines below them.
fn table(csv: &str) -> (Vec<String>, Vec<Vec<String>>) {
    let mut lines = csv.lines().skip_while(|line| line.starts_with("# "));
    let columns = cells(lines.next().unwrap());
    (columns, lines.map(cells).collect())
}

/// Asserts that tags are balanced and no text has a stray bracket.
fn is_well_formed(svg: &str) {
    let mut open: Vec<&str> = Vec::new();
    for tag in svg.split('<').skip(1).map(|rest| rest.split_once('>').expect("a closed tag").0) {
        let name = tag.split([' ', '\n', '/']).find(|word| !word.is_empty()).unwrap_or("");
        match (tag.starts_with('/'), tag.ends_with('/') || tag.starts_with(['?', '!'])) {
            (true, _) => assert_eq!(open.pop(), Some(name)),
            (false, false) => open.push(name),
            (false, true) => {}
        }
    }
    assert!(open.is_empty() && svg.starts_with("<svg "), "{open:?}");
}

#[test]
fn every_experiment_runs_and_writes_what_it_states() {
    let out = folder("figures");
    let names = names();
    assert!(names.len() >= 5 && names.iter().collect::<BTreeSet<_>>().len() == names.len(), "{names:?}");
    std::thread::scope(|scope| {
        for name in &names {
            let out = &out;
            scope.spawn(move || {
                // A folder without the files of a project: each technique has a line with the reason.
                let peer = ["--peer", out.to_str().unwrap()];
                let output = quick(name, "cpu", out, if name == "peers" { &peer } else { &[] });
                let sentence = String::from_utf8(output.stdout).unwrap();
                let csv = read(out.join(format!("{name}.csv")));
                let paper = csv.lines().nth(1).unwrap().trim_start_matches("# ").split(": ").next().unwrap().to_owned();
                assert!(sentence.starts_with(&paper) && sentence.trim_end().ends_with('.'), "{name}: {sentence}");
                assert_eq!(sentence.lines().count(), 1, "{name}: {sentence}");
                assert!(csv.starts_with(&format!("# fragbuf {}, figure {name}\n", env!("CARGO_PKG_VERSION"))), "{csv}");
                let (columns, rows) = table(&csv);
                assert!(!rows.is_empty(), "{name} has no rows");
                for row in &rows {
                    assert_eq!(row.len(), columns.len(), "{name}: {row:?}");
                }
                is_well_formed(&read(out.join(format!("{name}.svg"))));
            });
        }
    });
}

/// The median of a frame is at least that of each of its passes, the first series has the ratio 1, and nothing is missing on the CPU device.
#[test]
fn a_sweep_has_every_point() {
    let out = folder("figure-points");
    quick("k15-fig-7", "cpu", &out, &["--repeats", "3"]);
    let (columns, rows) = table(&read(out.join("k15-fig-7.csv")));
    let column = |name: &str| columns.iter().position(|column| column == name).unwrap();
    let number = |row: &[String], name: &str| row[column(name)].parse::<f64>().unwrap();
    let frames: Vec<&Vec<String>> = rows.iter().filter(|row| row[column("pass")] == "frame").collect();
    assert_eq!(frames.len(), 2 * 6);
    for frame in frames {
        let passes = rows.iter().filter(|row| row[..4] == frame[..4]);
        assert!(passes.clone().count() >= 4, "{frame:?}");
        for pass in passes {
            assert!(number(pass, "median_ms") <= number(frame, "median_ms"), "{pass:?}");
            assert!(number(pass, "q1_ms") <= number(pass, "q3_ms"), "{pass:?}");
            assert_eq!(pass[column("samples_ms")].split(' ').count(), 3, "{pass:?}");
        }
        assert_eq!([frame[column("lost")].as_str(), &frame[column("unavailable")]], ["0", ""], "{frame:?}");
        if frame[column("series")] == "K⁺B-Array" {
            assert_eq!(frame[column("ratio")], "1.000");
        }
    }
}

#[test]
fn a_second_run_measures_only_what_is_missing() {
    let out = folder("figure-resume");
    let path = out.join("k15-fig-9-left.csv");
    let run = |more: &[&str]| stderr(&quick("k15-fig-9-left", "cpu", &out, more));
    run(&[]);
    let first = read(path.clone());
    let again = run(&[]);
    assert!(again.contains("has 12 points of an earlier run"), "{again}");
    assert_eq!(read(path.clone()), first);
    // Without the last lines one series of the last value is missing, so all series of this value are measured again.
    let kept: Vec<&str> = first.lines().take(first.lines().count() - 3).collect();
    std::fs::write(&path, format!("{}\n", kept.join("\n"))).unwrap();
    run(&[]);
    let resumed = read(path.clone());
    assert_eq!(resumed.lines().count(), first.lines().count());
    let of =
        |csv: &str, x: &str| csv.lines().filter(|line| cells(line)[2..3] == [x]).map(str::to_owned).collect::<Vec<_>>();
    let shown = |csv: &str, x: &str| of(csv.split_once("panel,").unwrap().1, x);
    assert_eq!(shown(&resumed, "8"), shown(&first, "8"));
    assert_ne!(shown(&resumed, "16"), shown(&first, "16"));
    let other = run(&["--repeats", "1"]);
    assert!(other.contains("is of another run and is replaced"), "{other}");
}

/// What a device lacks is a row with the reason, and a part of the sentence.
#[test]
fn a_missing_feature_is_reported_and_no_failure() {
    let out = folder("figure-missing");
    let output = quick("k15-fig-9-left", "llvmpipe", &out, &["--repeats", "1"]);
    let sentence = String::from_utf8(output.stdout).unwrap();
    let missing =
        "it is not measured whether K⁺B-Array is faster with the interlock than with the spin lock, and whether ";
    assert!(sentence.contains(missing), "{sentence}");
    let (columns, rows) = table(&read(out.join("k15-fig-9-left.csv")));
    let reason = columns.iter().position(|column| column == "unavailable").unwrap();
    let unavailable: Vec<&Vec<String>> = rows.iter().filter(|row| !row[reason].is_empty()).collect();
    assert_eq!(unavailable.len(), 4, "two series with two values: {unavailable:?}");
    assert!(unavailable.iter().all(|row| row[1].contains("interlock") && row[5].is_empty()), "{unavailable:?}");
}

/// A budget that is too small is a row with the reason, or more slices, and no failure.
#[test]
fn a_point_beyond_the_budget_is_reported_and_no_failure() {
    let out = folder("figure-memory");
    let frames = |memory: &str| {
        quick("k15-fig-7", "cpu", &out, &["--repeats", "1", "--memory", memory]);
        let (columns, rows) = table(&read(out.join("k15-fig-7.csv")));
        let column = |name: &str| columns.iter().position(|column| column == name).unwrap();
        let [pass, slices, reason] = ["pass", "slices", "unavailable"].map(column);
        let frames = rows.into_iter().filter(|row| row[pass] == "frame");
        frames.map(|row| (row[slices].clone(), row[reason].clone())).collect::<Vec<_>>()
    };
    assert!(frames("2GiB").iter().all(|(slices, reason)| slices == "1" && reason.is_empty()));
    let sliced = frames("256KiB");
    assert!(sliced.iter().all(|(slices, _)| slices.parse::<u32>().unwrap() > 1), "{sliced:?}");
    let missing = frames("16KiB");
    assert!(missing.len() == 12 && missing.iter().all(|(_, reason)| reason.contains("memory")), "{missing:?}");
}

/// F2B keeps one of n equal fragments, and every pixel of these scenes has n of them: the numbers follow from the scenes.
#[test]
fn d13_fig_13_has_the_numbers_of_its_scenes() {
    let out = folder("figure-coplanarity");
    quick("d13-fig-13", "cpu", &out, &[]);
    let (columns, rows) = table(&read(out.join("d13-fig-13.csv")));
    let column = |name: &str| columns.iter().position(|column| column == name).unwrap();
    let of = |label: &str, name: &str| -> f64 {
        rows.iter().find(|row| row[0] == label).unwrap()[column(name)].parse().unwrap()
    };
    let pixels = f64::from(SIDE * SIDE);
    for count in [2, 5, 9] {
        let label = format!("{count} coplanar");
        let n = f64::from(count);
        assert_eq!(["covered", "coplanar", "c_p"].map(|name| of(&label, name)), [pixels, pixels, 1.0], "{label}");
        assert_eq!(of(&label, "fragments"), n * pixels, "{label}");
        assert!((of(&label, "r_h") - 1.0 / n).abs() < 0.5e-4, "{label}");
    }
    let mixed = ["few", "more", "many"].map(|name| format!("\"mixed, {name}\""));
    assert!(mixed.iter().all(|label| (0.01..0.99).contains(&of(label, "c_p"))), "{rows:?}");
}

#[test]
fn an_unknown_name_suggests_the_nearest() {
    let output = fragbuf(&["figure", "k15-fig7"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("did you mean `k15-fig-7`?"), "{}", stderr(&output));
    assert_eq!(fragbuf(&["figure"]).status.code(), Some(2));
}

/// Every experiment has its files among the examples, and those that are computed or rendered by a seed are up to date.
#[test]
fn the_examples_have_every_figure() {
    let examples = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/figures");
    let readme = read(examples.join("README.md"));
    let out = folder("figure-examples");
    for name in names() {
        let csv = read(examples.join(format!("{name}.csv")));
        is_well_formed(&read(examples.join(format!("{name}.svg"))));
        assert!(csv.starts_with(&format!("# fragbuf {}, figure {name}\n", env!("CARGO_PKG_VERSION"))), "{name}");
        let command = format!("fragbuf figure {name} ");
        assert!(readme.contains(&command) && readme.contains(&format!("({name}.csv)")), "README.md has no {name}");
        assert!(readme.contains(&format!("src=\"{name}.svg\"")), "README.md does not show {name}");
    }
    for name in ["k15-table-1", "d13-table-1", "k15-fig-1"] {
        let output = fragbuf(&["figure", name, "--out", out.to_str().unwrap()]);
        let sentence = String::from_utf8(output.stdout).unwrap();
        assert!(readme.contains(sentence.trim_end()), "README.md should have: {sentence}");
        for extension in ["csv", "svg"] {
            let file = format!("{name}.{extension}");
            assert!(read(examples.join(&file)) == read(out.join(&file)), "examples/figures/{file} is out of date");
        }
    }
}

/// Where a plan has another value than D13, the table has a reason, and nowhere else.
#[test]
fn every_difference_from_d13_table_1_has_a_reason() {
    let out = folder("figure-reasons");
    quick("d13-table-1", "cpu", &out, &[]);
    let (columns, rows) = table(&read(out.join("d13-table-1.csv")));
    let column = |name: &str| columns.iter().position(|column| column == name).unwrap();
    let of = |verdict: &str| rows.iter().filter(|row| row[column("agrees")] == verdict).count();
    assert!(of("yes") > 0 && of("no") > 0, "{rows:?}");
    for row in &rows {
        assert_eq!(row[column("agrees")] == "no", !row[column("reason")].is_empty(), "{row:?}");
    }
}

/// In scenes of nine depths, each of c fragments, iterations follow from depths and ids. D13's robust techniques keep
/// every fragment, and the others one of each depth.
#[test]
fn d13_table_1_measures_the_iterations_and_hit_ratios_of_its_scenes() {
    let out = folder("figure-peeling");
    quick("d13-table-1", "cpu", &out, &[]);
    let (columns, rows) = table(&read(out.join("d13-table-1.csv")));
    let column = |name: &str| columns.iter().position(|column| column == name).unwrap();
    let of = |key: &str, property: &str, coplanar: usize| -> f64 {
        let property = format!("\"{property}, c = {coplanar}\"");
        let row = rows.iter().find(|row| row[column("key")] == key && row[column("property")] == property);
        row.unwrap_or_else(|| panic!("{key}, {property}"))[column("fragbuf")].parse().unwrap()
    };
    for coplanar in [1_usize, 2, 5, 9] {
        let halves = coplanar.div_ceil(2);
        let iterations = [
            // An iteration that keeps nothing, or that finds nothing, ends these three.
            ("f2b", 10),
            ("f2b2", 10),
            ("f2b_3p", 9 * halves + 1),
            ("f2b_2p", 9 * halves),
            ("f2b_ll", 9),
            ("f2b_kb", 9),
            ("f2b_fab", 9),
            ("dual", 5),
            ("dual_2p", 5 * halves),
            ("dual_ll", 5),
            ("dual_kb", 5),
            ("dual_fab", 5),
        ];
        for (key, iterations) in iterations {
            assert_eq!(of(key, "iterations", coplanar), iterations as f64, "{key}, {coplanar}");
        }
        let draws =
            [("f2b2", 20), ("f2b_2p", 18 * halves + 1), ("f2b_3p", 27 * halves + 3), ("dual_2p", 10 * halves + 1)];
        let draws = draws.into_iter().chain([("f2b_ll", 10), ("dual_ll", 6), ("bad", 4), ("ab_ll_bun", 2)]);
        for (key, draws) in draws {
            assert_eq!(of(key, "draws", coplanar), draws as f64, "{key}, {coplanar}");
        }
        let robust = ["f2b_2p", "f2b_3p", "f2b_ll", "f2b_kb", "f2b_fab"];
        let robust = robust.iter().chain(&["dual_2p", "dual_ll", "dual_kb", "dual_fab", "ab_ll_bun"]);
        robust.for_each(|key| assert_eq!(of(key, "R_h", coplanar), 1.0, "{key}, {coplanar}"));
        for key in ["f2b", "f2b2", "dual", "bun"] {
            assert!((of(key, "R_h", coplanar) - 1.0 / coplanar as f64).abs() < 0.5e-4, "{key}, {coplanar}");
        }
        // Depths that share a part of the range lose more than those that do not.
        assert!(of("bad", "R_h", coplanar) <= 1.0 / coplanar as f64 + 0.5e-4);
        // Four buckets: at least three depths are in the fullest, at most all nine.
        assert!((3.0..=6.0).contains(&of("bun", "iterations", coplanar)));
    }
}

/// The bytes that are measured are those of the papers' formulas for the histogram of the scene.
#[test]
fn the_memory_of_k15_fig_8_is_that_of_the_formulas() {
    let out = folder("figure-memory");
    quick("k15-fig-8", "cpu", &out, &["--repeats", "1"]);
    let (columns, rows) = table(&read(out.join("k15-fig-8.csv")));
    let column = |name: &str| columns.iter().position(|column| column == name).unwrap();
    for percent in [25, 50, 75] {
        for k in [2, 4] {
            let scene = format!("builtin:layers,n={k}0,pixels={percent},fragments={percent}");
            let histogram = histogram(&scene, SIDE);
            let fragments = |most: u64| -> u64 { (1..).zip(&histogram).map(|(f, pixels)| most.min(f) * pixels).sum() };
            let pixels = u64::from(SIDE * SIDE);
            let covered: u64 = histogram.iter().sum();
            assert_eq!(covered * 100 / pixels, percent, "{scene}");
            let part = fragments(u64::MAX) as f64 / (covered * 10 * k) as f64;
            assert!((part - percent as f64 / 100.0).abs() < 0.1, "{scene}: {part}");
            let computed = [
                ("K⁺B-Array", pixels * (2 * k + 2)),
                ("K⁺B-Heap", pixels * (2 * k + 2)),
                ("K⁺B-AB_SB", 2 * fragments(k) + 3 * pixels),
                // The CPU device has an interlock.
                ("KB-PS", pixels * 2 * k),
                ("KB-MDT₃₂", pixels * 2 * k),
                ("KB-AB_SB", 2 * fragments(u64::MAX) + 2 * pixels),
            ];
            let measured = |series: &str| -> u64 {
                let is_point = |row: &&Vec<String>| {
                    row[column("panel")] == format!("{percent} %")
                        && row[column("series")] == series
                        && row[column("x")] == k.to_string()
                };
                rows.iter().find(is_point).unwrap()[column("bytes")].parse().unwrap()
            };
            for (series, words) in computed {
                // Counters, and the sums of blocks.
                let rest = measured(series) - 4 * words;
                assert!(rest <= 256, "{series}, {scene}: {words} words, and {rest} bytes");
            }
        }
    }
}

/// The side of the images of `--quick`.
const SIDE: u32 = 24;

/// Returns the pixels with one, two, … fragments.
fn histogram(scene: &str, side: u32) -> Vec<u64> {
    let size = format!("{side}x{side}");
    let output = fragbuf(&[
        "predict",
        "kplus_ab_sb",
        "--scene",
        scene,
        "--camera",
        "clip",
        "--size",
        &size,
        "--device",
        "cpu",
        "--json",
    ]);
    assert!(output.status.success(), "{}", stderr(&output));
    let found: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    found["histogram"].as_array().unwrap().iter().map(|bin| bin.as_u64().unwrap()).collect()
}
