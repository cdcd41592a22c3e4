//! `fragbuf predict`: its numbers follow from its own histogram by trying every k, and the histogram is that of the scene.

use crate::render::{fragbuf, read, stderr};

fn predicted(description: &str, options: &[&str]) -> serde_json::Value {
    let scene = ["--scene", "builtin:marbles,n=60", "--size", "64x48", "--device", "cpu", "--json"];
    let output = fragbuf(&[&["predict", description], scene.as_slice(), options].concat());
    assert!(output.status.success(), "{}", stderr(&output));
    serde_json::from_slice(&output.stdout).unwrap()
}

fn bins(found: &serde_json::Value) -> Vec<u64> {
    let bins: Vec<u64> = found["histogram"].as_array().unwrap().iter().map(|bin| bin.as_u64().unwrap()).collect();
    assert_eq!(bins.len(), 1024);
    bins
}

fn kept(bins: &[u64], k: u64) -> u64 {
    (1..).zip(bins).map(|(count, pixels)| k.min(count) * pixels).sum()
}

/// Compares with trying every k. `bytes` is over k and the kept fragments.
fn compare(description: &str, budget: u64, per_mille: u64, bytes: impl Fn(u64, u64) -> u64) {
    let (budget_text, ratio) = (budget.to_string(), format!("0.{per_mille:03}"));
    let found = predicted(description, &["--budget", &budget_text, "--hit-ratio", &ratio]);
    let bins = bins(&found);
    let all = kept(&bins, 1024);
    let fitting: Vec<u64> = (1..=1024).filter(|k| bytes(*k, kept(&bins, *k)) <= budget).collect();
    let goal = fitting.iter().copied().find(|k| kept(&bins, *k) * 1000 >= all * per_mille);
    let k = goal.unwrap_or(*fitting.last().unwrap());
    assert_eq!(found["k"], k, "{description}, {budget}, {per_mille}");
    assert_eq!(found["k_budget"], *fitting.last().unwrap());
    assert_eq!(found["goal_met"], goal.is_some());
    assert_eq!(found["bytes"], bytes(k, kept(&bins, k)));
    assert_eq!((&found["fragments"], &found["kept"]), (&all.into(), &kept(&bins, k).into()));
}

const PIXELS: u64 = 64 * 48;
const COUNTERS: u64 = 14 * 4;

#[test]
fn k_slots_per_pixel() {
    for budget in [PIXELS * 16 + COUNTERS, 100_000, 10 << 20] {
        for per_mille in [200, 700, 999] {
            compare("kplus_array", budget, per_mille, |k, _| PIXELS * (8 * k + 8) + COUNTERS);
        }
    }
}

#[test]
fn exact_regions() {
    let constant = PIXELS * 12 + 4 + 4 * PIXELS.div_ceil(1024) + COUNTERS;
    for budget in [60_000, 10 << 20] {
        for per_mille in [200, 700, 999] {
            compare("kplus_ab_sb", budget, per_mille, |_, kept| 8 * kept + constant);
        }
    }
}

/// The fragments of an A-buffer, which counts each.
#[test]
fn the_histogram_has_the_fragments_of_the_scene() {
    let found = predicted("mdt32_coplanar", &[]);
    let out = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join("predict.png");
    let scene = ["--scene", "builtin:marbles,n=60", "--size", "64x48", "--device", "cpu", "--json"];
    let rendered = fragbuf(&[&["render", "ab_ll", "--out", out.to_str().unwrap()], scene.as_slice()].concat());
    let rendered: serde_json::Value = serde_json::from_slice(&rendered.stdout).unwrap();
    assert_eq!(found["fragments"], rendered["fragments"]["generated"]);
    assert!(found["fragments"].as_u64() > Some(100));
}

#[test]
fn bad_input_has_its_numbers() {
    let failed = |arguments: &[&str]| {
        let scene = ["--scene", "builtin:marbles,n=2", "--size", "64x48", "--device", "cpu"];
        let output = fragbuf(&[&["predict"], arguments, scene.as_slice()].concat());
        assert!(!output.status.success(), "{arguments:?}");
        stderr(&output)
    };
    let needed = PIXELS * 16 + COUNTERS;
    let below = failed(&["kplus_array", "--budget", &(needed - 1).to_string()]);
    assert!(
        below.contains(&format!("one fragment per pixel needs {needed} bytes, and `--budget` is {}", needed - 1)),
        "{below}"
    );
    for ratio in ["0", "1.5", "-1", "nan"] {
        let message = failed(&["kplus_array", &format!("--hit-ratio={ratio}")]);
        assert!(message.contains("at most 1"), "{message}");
    }
    // Storages that have neither slots per pixel nor regions limited to k.
    let ranges = "what `storage: depth_ranges` keeps and its memory do not follow from k and the numbers of fragments";
    for (key, reason) in [
        ("ab_ll", "ab_ll: it keeps every fragment, so it has no k. "),
        ("f2b", "f2b: what `storage: depth_tested` keeps"),
        ("f2b_ll", "f2b_ll: it keeps every fragment, so it has no k. "),
        ("kb_ab_ll", "what `storage: linked_list` keeps"),
        ("z_buffer", "what `storage: depth_tested` keeps"),
        ("kb_sr", "what `storage: stencil_routed` keeps"),
        ("bad", "what `storage: adaptive_ranges` keeps"),
        ("kb_stream", "what `storage: stream_array` keeps"),
        ("depth_partition", ranges),
    ] {
        let message = failed(&[key]);
        assert!(message.contains(reason), "{message}");
        assert!(message.contains("k slots per pixel") && message.contains("kplus_array,"), "{message}");
    }
    let message = failed(&["kplus_array", "--coplanarity="]);
    assert!(message.contains("the path is empty: give a file, such as image.png"), "{message}");
    for set in ["k=4", "allocation=described", "allocation.hit_ratio=50"] {
        let message = failed(&["kplus_array", "--set", set]);
        assert!(message.contains("`predict` chooses k itself"), "{message}");
    }
}

#[test]
fn the_plot_marks_k() {
    let plot = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join("predict.svg");
    let found = predicted("kplus_array", &["--plot", plot.to_str().unwrap()]);
    let svg = std::fs::read_to_string(plot).unwrap();
    assert!(svg.starts_with("<svg") && svg.contains(&format!("k = {};", found["k"])));
}

#[test]
fn the_guide_shows_the_output_of_its_command() {
    let guide = std::fs::read_to_string("src/guide/memory.md").unwrap();
    let command = guide.split("```sh\nfragbuf ").nth(1).unwrap().lines().next().unwrap();
    let output = fragbuf(&command.split(' ').collect::<Vec<_>>());
    let printed = String::from_utf8(output.stdout).unwrap();
    assert!(guide.contains(&format!("```text\n{printed}```")), "{printed}");
}

/// Every frame of an animation has an image, and k, bytes and hit ratio of its own.
#[test]
fn an_animation_has_an_image_and_a_line_per_frame() {
    let folder = empty_folder("animation");
    let out = folder.join("view.png");
    let scene = ["--scene", "builtin:hairball,strands=40", "--size", "40x30", "--device", "cpu"];
    let run = |options: &[&str]| {
        let render = ["render", "unified", "--frames", "3", "--orbit", "90", "--out", out.to_str().unwrap()];
        fragbuf(&[render.as_slice(), scene.as_slice(), options].concat())
    };
    let output = run(&[]);
    assert!(output.status.success(), "{}", stderr(&output));
    let printed = String::from_utf8(output.stdout).unwrap();
    assert_eq!(printed.lines().count(), 3);
    let images: Vec<Vec<u8>> = (0..3).map(|n| std::fs::read(folder.join(format!("view-00{n}.png"))).unwrap()).collect();
    assert!(images[0] != images[1] && images[1] != images[2] && !out.exists());
    let frames: serde_json::Value = serde_json::from_slice(&run(&["--json"]).stdout).unwrap();
    for (line, frame) in printed.lines().zip(frames.as_array().unwrap()) {
        let (k, bytes, ratio) = (&frame["k"], &frame["bytes"], &frame["hit_ratio"]);
        assert!(line.ends_with(&format!(": k = {k}, {bytes} bytes, hit ratio 1.0000")), "{line}");
        assert_eq!(ratio, 1.0);
    }
    let fails = run(&["--camera", "clip"]);
    assert!(stderr(&fails).contains("--camera orbit"), "{}", stderr(&fails));
}

/// An animated PNG has the pixels of the numbered images, and the delay of the command.
#[test]
fn an_animated_png_has_every_frame() {
    let folder = empty_folder("animated");
    let scene = ["--scene", "builtin:hairball,strands=40", "--size", "40x30", "--device", "cpu", "--frames", "3"];
    let run = |name: &str, options: &[&str]| {
        let out = folder.join(name);
        let output =
            fragbuf(&[&["render", "unified", "--out", out.to_str().unwrap()], scene.as_slice(), options].concat());
        assert_eq!(String::from_utf8_lossy(&output.stdout).lines().count(), 3, "{}", stderr(&output));
        out
    };
    run("one.png", &[]);
    let animated = run("all.png", &["--animated", "--delay", "40"]);
    let decoder = png::Decoder::new(std::io::BufReader::new(std::fs::File::open(animated).unwrap()));
    let mut reader = decoder.read_info().unwrap();
    let control = reader.info().animation_control().unwrap();
    assert_eq!((control.num_frames, control.num_plays), (3, 0));
    for number in 0..3 {
        let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
        reader.next_frame(&mut bytes).unwrap();
        let frame = reader.info().frame_control().unwrap();
        assert_eq!((frame.width, frame.height, frame.delay_num, frame.delay_den), (40, 30, 40, 1000));
        let (_, _, pixels) = read(&folder.join(format!("one-00{number}.png")));
        assert!(bytes == pixels.concat(), "frame {number}");
    }
    let mut files: Vec<_> = std::fs::read_dir(&folder).unwrap().map(|entry| entry.unwrap().file_name()).collect();
    files.sort();
    assert_eq!(files, ["all.png", "one-000.png", "one-001.png", "one-002.png"]);
}

/// An animation that fails leaves the former file as it was.
#[test]
fn an_animation_that_fails_leaves_no_file() {
    let folder = empty_folder("failed-animation");
    let out = folder.join("all.png");
    std::fs::write(&out, "former").unwrap();
    let render = ["render", "unified", "--scene", "builtin:cubes", "--size", "8x8", "--device", "cpu", "--frames", "2"];
    let options = ["--animated", "--out", out.to_str().unwrap(), "--memory", "4KiB"];
    assert!(!fragbuf(&[render.as_slice(), &options].concat()).status.success());
    assert_eq!(std::fs::read(&out).unwrap(), b"former");
    assert_eq!(std::fs::read_dir(&folder).unwrap().count(), 1);
    let output = fragbuf(&[render.as_slice(), &["--delay", "40", "--out", out.to_str().unwrap()]].concat());
    assert!(stderr(&output).contains("--animated"), "{}", stderr(&output));
}

/// With `--lagged` a frame has the k that the frame before wants for itself, or a greater one for eight frames, and the same k on every device.
#[test]
fn a_lagged_k_is_that_of_the_frame_before_on_every_device() {
    let folder = empty_folder("lagged");
    let run = |device: &str, options: &[&str]| {
        let out = folder.join(format!("{device}.png"));
        let scene = ["--scene", "builtin:slabs", "--size", "40x30", "--device", device, "--json"];
        let set = ["--set", "allocation=predicted", "--set", "allocation.hit_ratio=90", "--set", "k=64"];
        let render = ["render", "kplus_array", "--frames", "24", "--orbit", "360", "--out", out.to_str().unwrap()];
        let output = fragbuf(&[render.as_slice(), &scene, &set, options].concat());
        assert!(output.status.success(), "{}", stderr(&output));
        let frames: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
        let of = |frame: &serde_json::Value| (frame["k"].as_u64().unwrap(), frame["k_lagged"].as_bool().unwrap());
        frames.as_array().unwrap().iter().map(of).collect::<Vec<_>>()
    };
    let wanted = run("cpu", &[]);
    assert!(wanted.iter().all(|(_, lags)| !lags));
    let (mut k, mut smaller, mut expected) = (wanted[0].0, Vec::new(), vec![(wanted[0].0, false)]);
    for (wanted, _) in &wanted[..wanted.len() - 1] {
        match *wanted < k {
            true => smaller.push(*wanted),
            false => (k, smaller) = (*wanted, Vec::new()),
        }
        if smaller.len() == 8 {
            (k, smaller) = (*smaller.iter().max().unwrap(), Vec::new());
        }
        expected.push((k, true));
    }
    let shrinks = |pair: &[(u64, bool)]| pair[0].0 > pair[1].0;
    assert!(expected.windows(2).any(shrinks) && expected.iter().any(|(k, _)| *k > wanted[0].0), "{expected:?}");
    assert_eq!(run("cpu", &["--lagged"]), expected);
    assert_eq!(run("llvmpipe", &["--lagged"]), expected);
}

fn empty_folder(name: &str) -> std::path::PathBuf {
    let folder = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).unwrap();
    folder
}

/// Bytes, limits and slices of a frame follow from the words per pixel.
#[test]
fn show_computes_what_a_frame_needs() {
    let show = |arguments: &[&str]| {
        let output = fragbuf(&[&["show"], arguments, &["--json"]].concat());
        assert!(output.status.success(), "{}", stderr(&output));
        let found: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
        found[0].clone()
    };
    let limit = |found: &serde_json::Value, name: &str| {
        let limits = found["limits"].as_array().unwrap();
        limits.iter().find(|limit| limit["webgpu"] == name).unwrap()["needed"].as_u64().unwrap()
    };
    let found = show(&["kplus_array", "--size", "1920x1080"]);
    let pixels = 1920 * 1080;
    assert_eq!(found["bytes"], pixels * (8 * 8 + 8) + COUNTERS);
    assert_eq!(limit(&found, "maxStorageBufferBindingSize"), 8 * 4 * pixels);
    assert_eq!((&found["slices"], &found["slice_rows"]), (&1.into(), &1080.into()));
    // 128 MiB hold the keys of 1024 rows.
    let found = show(&["kplus_array", "--size", "4096x4096"]);
    assert_eq!((&found["slices"], &found["slice_rows"]), (&4.into(), &1024.into()));
    // A pool of 12 bytes per fragment and a word per pixel: 5 rows of 16384 pixels have 5 * 16384 * 200 nodes.
    let found = show(&["ab_ll", "--size", "16384x100", "--fragments", "200"]);
    // The cursor of the pool is a word.
    assert_eq!(found["bytes"], 16384 * 100 * (200 * 12 + 4) + COUNTERS + 4);
    let nodes = found["resources"]
        .as_array()
        .unwrap()
        .iter()
        .map(|resource| resource["bytes"].as_u64().unwrap())
        .max()
        .unwrap();
    let rows = (134_217_728 * 100) / nodes;
    assert_eq!((&found["slice_rows"], &found["slices"]), (&rows.into(), &100_u64.div_ceil(rows).into()));
}

/// A user's row that provides a capability without what it stands for.
#[test]
fn a_capability_without_its_pass_is_an_error_of_the_row() {
    let folder = empty_folder("capability");
    let row = std::fs::read_to_string("examples/user_storage/first_k.wgsl").unwrap();
    let row = row.replace("//: provides ", "//: provides counted, ");
    let row = format!("{row}\nfn storage_fragments(pixel: u32) -> u32 {{\n    return 0u;\n}}\n");
    assert!(row.contains("counted"));
    std::fs::write(folder.join("u.wgsl"), row).unwrap();
    let file = folder.join("u.fragbuf");
    std::fs::write(
        &file,
        "buffer U {\n    storage: wgsl(\"u.wgsl\");\n    keep 8;\n    allocation: predicted_exact;\n}\n",
    )
    .unwrap();
    let message = stderr(&fragbuf(&["show", file.to_str().unwrap()]));
    assert!(message.contains("error[invalid-row]") && message.contains("the pass `count`"), "{message}");
}

/// Fragments of equal depths are those of the scene: every layer is drawn `coplanar` times over the whole frame.
#[test]
fn coplanarity_is_that_of_the_scene() {
    let measured = |scene: &str, options: &[&str]| -> serde_json::Value {
        let common = ["predict", "kplus_array", "--size", "32x24", "--device", "cpu", "--json", "--scene", scene];
        let output = fragbuf(&[common.as_slice(), &["--camera", "clip"], options].concat());
        assert!(output.status.success(), "{scene}: {}", stderr(&output));
        serde_json::from_slice(&output.stdout).unwrap()
    };
    for (layers, coplanar) in [(1, 1), (3, 1), (1, 2), (2, 5), (3, 9), (2, 200)] {
        let found = measured(&format!("builtin:layers,n={layers},coplanar={coplanar}"), &["--coplanarity"]);
        // Every pixel has the same: all of its fragments, unless each has a depth of its own.
        let bin = if coplanar > 1 { layers * coplanar } else { 0 };
        let mut expected = vec![0; bin + 1];
        expected[bin] = 32 * 24;
        assert_eq!(found["coplanar_histogram"], serde_json::json!(expected), "{layers}, {coplanar}");
        assert_eq!(found["coplanarity"], if coplanar > 1 { 1.0 } else { 0.0 }, "{layers}, {coplanar}");
    }
    // Pixels with fewer fragments, and without any: the counts are over covered pixels alone.
    let found = measured("builtin:layers,n=1,coplanar=3,pixels=50,fragments=30", &["--coplanarity"]);
    let of =
        |name: &str| -> Vec<u64> { found[name].as_array().unwrap().iter().map(|bin| bin.as_u64().unwrap()).collect() };
    let (by_fragments, by_shared) = (of("histogram"), of("coplanar_histogram"));
    assert_eq!(by_shared, [by_fragments[0], 0, by_fragments[1], by_fragments[2]]);
    let (covered, coplanar) = (by_shared.iter().sum::<u64>() as f64, (by_shared[2] + by_shared[3]) as f64);
    assert!(by_shared[0] > 0 && coplanar > 0.0 && covered < 32.0 * 24.0, "{by_shared:?}");
    assert!((found["coplanarity"].as_f64().unwrap() - coplanar / covered).abs() < 1.0e-12, "{found}");
    let without = measured("builtin:layers,n=1,coplanar=3", &[]);
    assert!(without["coplanarity"].is_null() && without["coplanar_histogram"].is_null());
}

/// The heat map has the paper's colours; a path that cannot be written is an error before anything is counted.
#[test]
fn the_coplanarity_has_a_heat_map() {
    let folder = empty_folder("coplanarity");
    let run = |map: &str| {
        let scene = "builtin:layers,n=1,coplanar=3";
        let size = ["--size", "8x8", "--camera", "clip", "--device", "cpu"];
        fragbuf(
            &[&["predict", "kplus_array", "--scene", scene, &format!("--coplanarity={map}")], size.as_slice()].concat(),
        )
    };
    let map = folder.join("map.png");
    let output = run(map.to_str().unwrap());
    assert!(output.status.success(), "{}", stderr(&output));
    let printed = String::from_utf8(output.stdout).unwrap();
    assert!(printed.ends_with("coplanarity: C_p = 1.0000, 64 of 64 covered pixels have fragments of equal depths\n"));
    assert_eq!(read(&map), (8, 8, vec![[0, 0, 255, 255]; 64]));
    for (wrong, help) in
        [("-", "give a file"), ("map.jpg", "map.png"), ("none/map.png", "its folder none does not exist")]
    {
        let output = run(wrong);
        assert!(!output.status.success() && output.stdout.is_empty(), "{wrong}");
        assert!(stderr(&output).contains(help), "{wrong}: {}", stderr(&output));
    }
}
