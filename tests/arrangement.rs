//! `--presort`, `--batch` and `--subdivide`: the disorder that they print, and images that stay the same.

use crate::render::{folder, fragbuf, read, stderr};

const SCENE: [&str; 6] = ["--scene", "builtin:slivers,n=8,rows=8,long=30", "--camera", "orbit:0,0", "--size", "48x40"];

/// Renders, and returns the statistics.
fn rendered(description: &str, out: &str, options: &[&str]) -> serde_json::Value {
    let command = ["render", description, "--device", "cpu", "--json", "--out", out];
    let output = fragbuf(&[command.as_slice(), &SCENE, options].concat());
    assert!(output.status.success(), "{options:?}: {}", stderr(&output));
    serde_json::from_slice(&output.stdout).unwrap()
}

/// The image of an A-buffer does not depend on the order of triangles, and hardly on their division.
#[test]
fn the_image_does_not_depend_on_the_arrangement() {
    let out = folder("arrangement");
    let path = |name: &str| out.join(name).to_str().unwrap().to_owned();
    let modelled = rendered("ab_sb", &path("modelled.png"), &[]);
    assert!(modelled["disorder"].is_null());
    let image = |name: &str| read(&out.join(name)).2;
    for (name, options) in [
        ("nearest.png", vec!["--presort"]),
        ("farthest.png", vec!["--presort=farthest"]),
        ("batches.png", vec!["--presort", "--batch", "5"]),
    ] {
        let found = rendered("ab_sb", &path(name), &options);
        assert_eq!(found["triangles"], modelled["triangles"]);
        assert!(found["disorder"]["before"].is_u64() && found["disorder"]["after"].is_u64(), "{found}");
        assert_eq!(image(name), image("modelled.png"), "{options:?}");
    }
    let found = rendered("ab_sb", &path("divided.png"), &["--subdivide", "3"]);
    let triangles = |found: &serde_json::Value| found["triangles"].as_u64().unwrap();
    assert!((3 * triangles(&modelled) - 1..=3 * triangles(&modelled)).contains(&triangles(&found)));
    let (one, other) = (image("divided.png"), image("modelled.png"));
    let differ = one.iter().zip(&other).filter(|(a, b)| a.iter().zip(*b).any(|(a, b)| a.abs_diff(*b) > 2)).count();
    assert!(differ <= one.len() / 100, "{differ} pixels");
}

/// On an adapter every batch is a draw: together they draw every triangle once. Colours are equal up to the rounding of the driver.
#[test]
fn batches_draw_every_triangle_once() {
    let out = folder("arrangement-batches");
    let render = |name: &str, options: &[&str]| {
        let path = out.join(name);
        let command = ["render", "ab_sb", "--device", "llvmpipe", "--json", "--out", path.to_str().unwrap()];
        let output = fragbuf(&[command.as_slice(), &SCENE, options].concat());
        assert!(output.status.success(), "{options:?}: {}", stderr(&output));
        let found: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
        (found["fragments"]["generated"].clone(), read(&path).2)
    };
    let modelled = render("modelled.png", &[]);
    assert!(modelled.0.as_u64() > Some(1000), "{}", modelled.0);
    for batch in ["1", "7", "4294967295"] {
        assert_eq!(render("batches.png", &["--presort", "--batch", batch]), modelled, "{batch}");
    }
}

/// Layers over the whole frame that do not intersect: sorting leaves nothing to move, and the reverse of it everything.
#[test]
fn the_disorder_is_that_of_the_scene() {
    let out = folder("disorder");
    let path = out.join("image.png").to_str().unwrap().to_owned();
    let disorder = |options: &[&str]| {
        let found = rendered("ab_sb", &path, options);
        (found["disorder"]["before"].as_u64().unwrap(), found["disorder"]["after"].as_u64().unwrap())
    };
    // Layers are modelled from back to front, and a pixel has all eight: the nearest comes last.
    assert_eq!(disorder(&["--presort"]).0, 7);
    assert_eq!(disorder(&["--presort=farthest"]).0, 0);
    let (_, sorted) = disorder(&["--presort"]);
    let (before, divided) = disorder(&["--presort", "--subdivide", "4"]);
    assert!(before == 7 && divided < sorted && sorted < 8, "{before}, {sorted}, {divided}");
    // Divided triangles without an order of their own stay in their objects.
    assert_eq!(disorder(&["--subdivide", "4"]), (7, 7));
    // A k-buffer of more fragments than the disorder completes the order: nothing arrives after a farther one was composited.
    let stream = |k: u64| {
        let set = format!("k={k}");
        let command = ["render", "kb_stream", "--device", "cpu", "--out", &path, "--presort", "--set", &set];
        let output = fragbuf(&[command.as_slice(), &SCENE].concat());
        assert!(output.status.success(), "{}", stderr(&output));
        stderr(&output).contains("arrived after farther ones")
    };
    assert!(!stream(sorted + 1));
    assert!(stream(1) || sorted == 0);
}

/// Direct volume rendering of a tetrahedral mesh (B06 §4.3): sorted by centroids, a few fragments complete the order of all.
#[test]
fn sorted_tetrahedra_need_a_small_k() {
    let path = folder("disorder-tets").join("image.png").to_str().unwrap().to_owned();
    let scene = ["--scene", "builtin:tets,n=4", "--size", "64x48", "--device", "cpu", "--out", &path, "--json"];
    let compared = |options: &[&str]| -> serde_json::Value {
        let output = fragbuf(&[&["compare", "kb_stream", "ab_ll"], &scene[..], options].concat());
        assert!(output.status.success(), "{options:?}: {}", stderr(&output));
        serde_json::from_slice(&output.stdout).unwrap()
    };
    let sorted = compared(&["--set-first", "k=16", "--presort"]);
    let disorder = |name: &str| sorted["first"]["disorder"][name].as_u64().unwrap();
    assert!(disorder("before") > 16 && disorder("after") < 16, "{}", sorted["first"]["disorder"]);
    assert_eq!(sorted["different_pixels"], 0);
    let modelled = compared(&["--set-first", "k=16"]);
    assert!(modelled["different_pixels"].as_u64() > Some(100), "{modelled}");
}

/// Every command with a scene prints the disorder, as a note or in JSON.
#[test]
fn every_command_prints_the_disorder() {
    let out = folder("disorder-commands");
    let path = out.join("image.png").to_str().unwrap().to_owned();
    let run = |command: &[&str], options: &[&str]| {
        let output = fragbuf(&[command, &["--device", "cpu"], &SCENE, options].concat());
        assert!(output.status.success(), "{command:?}: {}", stderr(&output));
        (String::from_utf8(output.stdout.clone()).unwrap(), stderr(&output))
    };
    let note = "note: disorder: 7 in the order of the model, ";
    let arranged = ["--presort", "--batch", "4"];
    for command in [&["render", "kplus_array", "--out", &path][..], &["compare", "ab_sb", "ab_ll", "--out", &path]] {
        let (_, notes) = run(command, &arranged);
        assert_eq!(notes.matches(note).count(), 1, "{command:?}: {notes}");
        let meaning =
            " as arranged; it is the greatest number of places between where a fragment of a pixel arrives and where";
        assert!(notes.contains(meaning), "{notes}");
        assert!(notes.contains("`--batch` changes nothing"), "{notes}");
    }
    let (_, notes) = run(&["predict", "kplus_array"], &arranged);
    assert_eq!(notes.matches(note).count(), 1, "{notes}");
    let json = |command: &[&str]| -> serde_json::Value {
        serde_json::from_str(&run(command, &["--presort", "--json"]).0).unwrap()
    };
    assert_eq!(json(&["predict", "kplus_array"])["disorder"]["before"], 7);
    let compared = json(&["compare", "ab_sb", "ab_ll", "--out", &path]);
    assert_eq!((&compared["first"]["disorder"]["before"], compared["different_pixels"].as_u64()), (&7.into(), Some(0)));
}

#[test]
fn invalid_values_have_a_way_out() {
    let out = folder("arrangement-errors");
    let path = out.join("image.png").to_str().unwrap().to_owned();
    for (options, help) in [
        (&["--subdivide", "0.5"][..], "from 1 to 1000, such as 1.5"),
        (&["--subdivide", "many"], "from 1 to 1000, such as 1.5"),
        (&["--presort=depth"], "--presort=farthest"),
        (&["--presort", "--batch", "0"], "such as 32"),
        (&["--batch", "8"], "--presort"),
    ] {
        let output = fragbuf(&[&["render", "ab_sb", "--out", &path], SCENE.as_slice(), options].concat());
        assert_eq!(output.status.code(), Some(2), "{options:?}");
        assert!(stderr(&output).contains(help), "{options:?}: {}", stderr(&output));
    }
    // What the subdivision needs is compared with the budget before it is allocated.
    let output = fragbuf(
        &[
            &["render", "ab_sb", "--device", "cpu", "--out", &path, "--memory", "24MiB", "--subdivide", "1000"],
            SCENE.as_slice(),
        ]
        .concat(),
    );
    assert!(!output.status.success() && stderr(&output).contains("the subdivision"), "{}", stderr(&output));
}

/// Ids and attributes follow their triangles: a description that reads them renders the same image.
#[test]
fn objects_keep_their_ids() {
    let out = folder("arrangement-ids");
    let render = |name: &str, options: &[&str]| {
        let path = out.join(name);
        let command = ["render", "examples/csg.fragbuf", "--uniform", "a=0", "--uniform", "b=1", "--device", "cpu"];
        let scene = ["--scene", "builtin:cubes", "--size", "64x48", "--out", path.to_str().unwrap()];
        let output = fragbuf(&[command.as_slice(), &scene, options].concat());
        assert!(output.status.success(), "{}", stderr(&output));
        read(&path).2
    };
    let modelled = render("modelled.png", &[]);
    assert!(modelled.iter().any(|pixel| *pixel != modelled[0]));
    assert_eq!(render("sorted.png", &["--presort=farthest"]), modelled);
}
