//! `fragbuf site`: its files, its links, and its pages in headless Chromium. `tests/playground/` has the scenarios, in `site.mjs` and
//! `player.mjs`; a web server of their own sends the files under a path of their own.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::sync::LazyLock;

use serde_json::Value;

use crate::playground::{listed_in, run_at, scenarios_of};

/// One with k and a lock, one that keeps every fragment, and one that browsers cannot run.
const TECHNIQUES: [&str; 3] = ["kplus_array", "ab_ll", "kb_mdt64"];

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn folder(name: &str) -> PathBuf {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join("site").join(name);
    let _ = std::fs::remove_dir_all(&path);
    std::fs::create_dir_all(path.parent().unwrap()).unwrap();
    path
}

fn generate(out: &Path, techniques: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_fragbuf"));
    command.arg("site").arg("--out").arg(out);
    if !techniques.is_empty() {
        command.arg("--technique").args(techniques);
    }
    command.output().unwrap()
}

fn succeeds(out: &Path, techniques: &[&str]) {
    let output = generate(out, techniques);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
}

fn fails(out: &Path, techniques: &[&str], code: i32) -> String {
    let output = generate(out, techniques);
    assert_eq!(output.status.code(), Some(code));
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// The site of these tests.
static SITE: LazyLock<PathBuf> = LazyLock::new(|| {
    let site = folder("whole");
    succeeds(&site, &TECHNIQUES);
    site
});

/// Returns the files below a folder, relative to it, in order.
fn files(folder: &Path) -> BTreeSet<PathBuf> {
    let (mut found, mut waiting) = (BTreeSet::new(), vec![folder.to_owned()]);
    while let Some(path) = waiting.pop() {
        for entry in std::fs::read_dir(&path).unwrap() {
            let path = entry.unwrap().path();
            match path.is_dir() {
                true => waiting.push(path),
                false => drop(found.insert(path.strip_prefix(folder).unwrap().to_owned())),
            }
        }
    }
    found
}

fn read(path: &Path) -> String {
    std::fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// Returns what follows each `before` up to `after`.
fn between<'t>(text: &'t str, before: &str, after: &str) -> Vec<&'t str> {
    text.split(before).skip(1).filter_map(|rest| rest.split(after).next()).collect()
}

/// Every link, picture, style, script and import is a file of the site, and nothing is from elsewhere.
#[test]
fn every_link_leads_to_a_file_of_the_site() {
    let mut links = 0;
    for file in files(&SITE) {
        let path = SITE.join(&file);
        let extension = file.extension().and_then(|extension| extension.to_str()).unwrap_or_default();
        if !["html", "css", "js"].contains(&extension) || file.starts_with("play/vendor") {
            continue;
        }
        let text = read(&path).replace("http://www.w3.org/2000/svg", "");
        assert!(!text.contains("http://") && !text.contains("https://"), "{}", file.display());
        let addresses: Vec<&str> = match extension {
            "html" => [between(&text, " href=\"", "\""), between(&text, " src=\"", "\"")].concat(),
            "js" => between(&text, " from \"", "\""),
            _ => between(&text, "url(", ")"),
        };
        for address in addresses.into_iter().filter(|address| *address != "data:,") {
            let (target, fragment) = address.split_once('#').unwrap_or((address, ""));
            assert!(!target.starts_with('/'), "{}: {address} is not relative", file.display());
            let target = if target.is_empty() { path.clone() } else { path.parent().unwrap().join(target) };
            assert!(target.is_file(), "{}: {address} leads nowhere", file.display());
            match fragment.strip_prefix("technique=") {
                Some(key) => assert!(TECHNIQUES.contains(&key), "{}: {address}", file.display()),
                None if fragment.is_empty() => {}
                None => assert!(read(&target).contains(&format!("id=\"{fragment}\"")), "{}: {address}", file.display()),
            }
            links += 1;
        }
    }
    assert!(links > 100, "{links} links");
}

/// Returns a file of the site as JSON.
fn json(path: &str) -> Value {
    serde_json::from_str(&read(&SITE.join(path))).unwrap()
}

/// What the player reads is there, and every variant is drawn or has a reason.
#[test]
fn every_variant_has_its_files_or_a_reason() {
    let site = json("data/site.json");
    let scenes = site["scenes"].as_array().unwrap();
    let mut legal = 0;
    for row in site["techniques"].as_array().unwrap() {
        let technique = json(row["data"].as_str().unwrap());
        for field in ["picture", "page"] {
            assert!(SITE.join(technique[field].as_str().unwrap()).is_file(), "{}: {field}", row["key"]);
        }
        let variants = technique["variants"].as_array().unwrap();
        assert_eq!(variants.is_empty(), technique["unsupported"].is_string());
        for variant in variants {
            let Some(text) = variant["text"].as_str() else {
                let reason = &technique["reasons"][variant["reason"].as_u64().unwrap() as usize];
                assert!(reason.as_str().is_some_and(|reason| reason.contains(';')), "{reason}");
                continue;
            };
            assert!(variant["files"].as_object().unwrap().len() > 1, "{text}");
            let layout = variant["layout"].as_str().unwrap();
            let has_file = |scene: &Value| SITE.join(scene["triangles"][layout].as_str().unwrap()).is_file();
            assert!(scenes.iter().all(has_file), "{text}");
            legal += 1;
        }
    }
    assert!(legal > 20, "{legal} variants");
}

/// The pieces of a variant are the files that `generate` writes.
#[test]
fn variants_are_what_generate_writes() {
    let technique = json("data/kplus_array.json");
    let piece = |number: &Value| &technique["pieces"][number.as_u64().unwrap() as usize];
    let variants = technique["variants"].as_array().unwrap().iter().filter(|variant| variant["text"].is_string());
    let mut compared = 0;
    for variant in variants.step_by(17) {
        compared += 1;
        let folder = folder("generated");
        std::fs::create_dir_all(&folder).unwrap();
        let text = variant["text"].as_str().unwrap();
        std::fs::write(folder.join("description.fragbuf"), text).unwrap();
        let mut command = Command::new(env!("CARGO_BIN_EXE_fragbuf"));
        command.args(["generate", "description.fragbuf", "--target", "wgsl", "--out", "passes"]).current_dir(&folder);
        assert!(command.output().unwrap().status.success(), "{text}");
        let passes = folder.join("passes");
        let mut written = files(&passes);
        assert!(written.remove(Path::new("manifest.json")));
        for (path, pieces) in variant["files"].as_object().unwrap() {
            let joined: String =
                pieces.as_array().unwrap().iter().map(|number| piece(number).as_str().unwrap()).collect();
            assert!(written.remove(Path::new(path)) && joined == read(&passes.join(path)), "{text}: {path}");
        }
        assert!(written.is_empty(), "{text}: {written:?}");
        let fields = variant["manifest"].as_object().unwrap().iter();
        let manifest: Value = fields.map(|(name, number)| (name.clone(), piece(number).clone())).collect();
        let expected: Value = serde_json::from_str(&read(&passes.join("manifest.json"))).unwrap();
        assert_eq!(manifest, expected, "{text}");
    }
    assert!(compared >= 5, "{compared} variants");
}

/// The technique's page has what `show --page` prints, and its command draws its picture.
#[test]
fn pages_have_their_text_and_pictures_their_commands() {
    let page = read(&SITE.join("techniques/kplus_array.html"));
    for heading in ["Axes", "Memory", "A frame", "Targets"] {
        assert!(page.contains(&format!("<h2>{heading}</h2>")), "{heading}");
    }
    let out = folder("picture.png");
    let command = "render kplus_array --scene builtin:marbles --size 320x240 --device cpu --out";
    let output = Command::new(env!("CARGO_BIN_EXE_fragbuf")).args(command.split(' ')).arg(&out).output().unwrap();
    assert!(output.status.success());
    let [drawn, shown] = [out, SITE.join("pictures/kplus_array.png")].map(|path| std::fs::read(path).unwrap());
    assert!(drawn == shown, "the picture is not that of its command");
}

/// The same program writes the same bytes, also over an earlier site. Files that are no longer written are removed, those of a user stay.
#[test]
fn a_site_is_written_again_with_the_same_bytes() {
    let (first, second) = (folder("first"), folder("second"));
    succeeds(&first, &["kb_mdt64"]);
    succeeds(&second, &["z_buffer"]);
    std::fs::write(second.join("techniques/mine.txt"), "kept").unwrap();
    succeeds(&second, &["kb_mdt64"]);
    let (one, mut two) = (files(&first), files(&second));
    assert!(two.remove(Path::new("techniques/mine.txt")), "a file of the user is gone");
    assert_eq!(one, two);
    for file in one {
        let [one, two] = [&first, &second].map(|folder| std::fs::read(folder.join(&file)).unwrap());
        assert!(one == two, "{} differs", file.display());
    }
}

#[test]
fn mistakes_are_errors_with_what_to_do() {
    let errors = fails(&folder("unknown"), &["kplus_aray"], 2);
    assert!(errors.contains("no technique `kplus_aray`: did you mean `kplus_array`?"), "{errors}");
    let file = folder("file");
    std::fs::write(&file, "mine").unwrap();
    let errors = fails(&file, &["z_buffer"], 3);
    assert!(errors.contains("is a file: give a folder"), "{errors}");
    let full = folder("full");
    std::fs::create_dir_all(&full).unwrap();
    for list in ["index.html", "fragbuf-site.json"] {
        std::fs::write(full.join(list), "mine").unwrap();
        let errors = fails(&full, &["z_buffer"], 3);
        assert!(
            errors.contains("has files that `fragbuf site` did not write: give a new or an empty folder"),
            "{errors}"
        );
        assert_eq!(read(&full.join("index.html")), "mine");
    }
}

fn run(scenarios: &[&str]) {
    run_at(&*SITE, scenarios);
}

#[test]
fn pages_are_read_in_a_browser_without_webgpu() {
    run(&[
        "without_webgpu_the_player_says_so",
        "a_technique_for_other_targets_has_its_picture",
        "the_gallery_leads_to_pages_and_player",
        "every_page_fits_every_window",
        "every_page_is_light_and_dark",
        "a_link_of_another_site_is_reported",
    ]);
}

#[test]
fn the_player_draws_by_webgpu() {
    run(&[
        "the_player_draws_what_the_cpu_device_draws",
        "choices_change_the_picture_or_keep_it",
        "an_illegal_choice_has_its_reason",
        "a_technique_that_cannot_be_read_is_reported",
        "passes_are_shown_and_copied",
        "the_player_works_by_keyboard_alone",
        "a_link_restores_the_player",
    ]);
}

/// Every scenario of the modules is listed above, and every file of the page is in the binary.
#[test]
fn every_scenario_runs_and_every_file_is_in_the_site() {
    assert_eq!(scenarios_of(&["site", "player"]), listed_in(include_str!("site.rs")));
    let player = read(&root().join("src/cli/site/player.rs"));
    let mut names = 0;
    for entry in std::fs::read_dir(root().join("src/cli/site/page")).unwrap() {
        names += 1;
        let name = entry.unwrap().file_name().into_string().unwrap();
        assert!(name == "README.md" || player.contains(&format!("\"page/{name}\"")), "{name}");
    }
    assert!(names > 10, "{names} files");
}

/// No text becomes markup in the player.
#[test]
fn the_player_creates_elements_and_parses_none() {
    for entry in std::fs::read_dir(root().join("src/cli/site/page")).unwrap() {
        let path = entry.unwrap().path();
        let text = read(&path);
        for forbidden in ["innerHTML", "outerHTML", "insertAdjacentHTML", "eval(", "new Function"] {
            assert!(!text.contains(forbidden), "{}: {forbidden}", path.display());
        }
    }
}
