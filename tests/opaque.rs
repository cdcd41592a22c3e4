//! Tests `fragbuf render --opaque` on both devices against an oracle of quads that cover whole pixels.

use std::path::{Path, PathBuf};

use serde_json::Value;

use crate::oracle::over;
use crate::quads::{Colors, Quad, SIZE, quads, write};
use crate::render::{folder, fragbuf, read, stderr};

const DEVICES: [&str; 2] = ["cpu", "llvmpipe"];

const BACKGROUND: [f64; 3] = [0.2, 0.9, 0.5];

fn covers(quad: &Quad, x: usize, y: usize) -> bool {
    (quad.x0..quad.x1).contains(&x) && (quad.y0..quad.y1).contains(&y)
}

/// Returns the nearest opaque quad of a pixel.
fn nearest(opaque: &[Quad], x: usize, y: usize) -> Option<&Quad> {
    let here = opaque.iter().filter(|quad| covers(quad, x, y));
    here.min_by(|a, b| a.depth.total_cmp(&b.depth))
}

/// Returns the layers of a pixel that no opaque quad hides, nearest first.
fn seen<'q>(quads: &'q [Quad], opaque: &[Quad], x: usize, y: usize) -> Vec<&'q Quad> {
    let limit = nearest(opaque, x, y).map_or(1.0, |quad| quad.depth);
    let mut seen: Vec<&Quad> = quads.iter().filter(|quad| covers(quad, x, y) && quad.depth <= limit).collect();
    seen.sort_by(|a, b| a.depth.total_cmp(&b.depth));
    seen
}

fn expected(quads: &[Quad], opaque: &[Quad], k: usize, (x, y): (usize, usize)) -> [f64; 3] {
    let layers = seen(quads, opaque, x, y).into_iter().take(k);
    let layers: Vec<(f32, [f32; 4])> =
        layers.map(|quad| (quad.depth as f32, quad.color.map(|channel| channel as f32))).collect();
    let front = over(&layers);
    let color = |quad: &Quad| -> [f64; 3] { std::array::from_fn(|channel| quad.color[channel]) };
    let behind = nearest(opaque, x, y).map_or(BACKGROUND, color);
    std::array::from_fn(|channel| front[channel] + (1.0 - front[3]) * behind[channel])
}

fn arguments<'a>(key: &'a str, scene: &'a Path, opaque: &'a Path, out: &'a Path, device: &'a str) -> Vec<&'a str> {
    let path = |path: &'a Path| path.to_str().unwrap();
    let common = "--size 32x32 --camera clip --shading flat --linear --background 0.2,0.9,0.5,1 --json";
    let mut all = vec!["render", key, "--scene", path(scene), "--opaque", path(opaque), "--out", path(out)];
    all.extend(["--device", device]);
    all.extend(common.split(' '));
    all
}

fn scenes(name: &str) -> (PathBuf, Vec<Quad>, Vec<Quad>) {
    // Depths are multiples of 1/31 and 1/6, so none are equal. The alphas of opaque quads are ignored.
    (folder(name), quads(30, 6, Colors::Bytes), quads(5, 21, Colors::Bytes))
}

#[test]
fn fragments_in_front_of_opaque_surfaces_are_visible_and_those_behind_are_not() {
    let (folder, transparent, opaque) = scenes("opaque");
    let (behind, between) = (folder.join("behind"), folder.join("between"));
    [&behind, &between].into_iter().for_each(|folder| std::fs::create_dir_all(folder).unwrap());
    let (scene, surfaces, out) = (write(&between, &transparent), write(&behind, &opaque), folder.join("o.png"));
    let covered: usize = transparent.iter().map(|quad| (quad.x1 - quad.x0) * (quad.y1 - quad.y0)).sum();
    let pixels = || (0..SIZE * SIZE).map(|pixel| (pixel % SIZE, pixel / SIZE));
    let in_front: usize = pixels().map(|(x, y)| seen(&transparent, &opaque, x, y).len()).sum();
    for device in DEVICES {
        for (key, k, how) in [
            ("kplus_array", 4, &[][..]),
            ("ab_sb", usize::MAX, &[]),
            ("z_buffer", 1, &[]),
            ("kplus_array", 4, &["--set", "opaque=early_depth"]),
        ] {
            let keep = format!("k={k}");
            let keep = if k > 1 && k < 100 { vec!["--set", &keep] } else { vec![] };
            let all = [arguments(key, &scene, &surfaces, &out, device), keep, how.to_vec()].concat();
            let output = fragbuf(&all);
            assert_eq!(output.status.code(), Some(0), "{key} on {device}: {}", stderr(&output));
            let (_, _, seen) = read(&out);
            for (pixel, place) in seen.iter().zip(pixels()) {
                let expected = expected(&transparent, &opaque, k, place);
                for (seen, expected) in pixel.iter().zip(expected) {
                    let apart = (f64::from(*seen) - 255.0 * expected).abs();
                    assert!(apart <= 1.0, "{key} {how:?} on {device}: {place:?} is {seen}, not {}", 255.0 * expected);
                }
            }
            let figures: Value = serde_json::from_slice(&output.stdout).unwrap();
            let count = |name: &str| figures["fragments"][name].as_u64();
            if key != "z_buffer" {
                assert_eq!(count("generated"), Some(in_front as u64), "{key} {how:?} on {device}");
                let hidden = if how.is_empty() { covered - in_front } else { 0 };
                assert_eq!(count("occluded"), Some(hidden as u64), "{key} {how:?} on {device}");
            }
        }
    }
}

#[test]
fn a_missing_opaque_depth_buffer_is_reported() {
    let (folder, transparent, _) = scenes("opaque-asked");
    let (scene, out) = (write(&folder, &transparent), folder.join("o.png"));
    for device in DEVICES {
        let all = arguments("kplus_array", &scene, &scene, &out, device);
        let without = [&all[..4], &all[6..], &["--set", "opaque=in_shader"]].concat();
        let output = fragbuf(&without);
        assert_eq!(output.status.code(), Some(2), "{}", stderr(&output));
        assert!(stderr(&output).contains("--opaque SCENE"), "{}", stderr(&output));
    }
    let missing =
        ["render", "kplus_array", "--scene", "builtin:marbles", "--opaque", "builtin:nothing", "--out", "x.png"];
    let output = fragbuf(&missing);
    assert_eq!(output.status.code(), Some(2), "{}", stderr(&output));
    assert!(stderr(&output).contains("nothing"), "{}", stderr(&output));
}

#[test]
fn images_with_opaque_surfaces_are_compared() {
    let (folder, transparent, opaque) = scenes("opaque-compared");
    let behind = folder.join("behind");
    std::fs::create_dir_all(&behind).unwrap();
    let (scene, surfaces, out) = (write(&folder, &transparent), write(&behind, &opaque), folder.join("o.png"));
    let arguments = arguments("kplus_array", &scene, &surfaces, &out, "cpu");
    let compared = |second: &[&str]| {
        let both = [&["compare", "ab_ll"], &arguments[1..], second].concat();
        let output = fragbuf(&both);
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        let figures: Value = serde_json::from_slice(&output.stdout).unwrap();
        figures["different_pixels"].as_u64().unwrap()
    };
    assert_eq!(compared(&[]), 0);
    assert!(compared(&["--set-second", "opaque=none"]) > 0);
}

/// A description with `opaque: none` is drawn over all opaque surfaces.
#[test]
fn without_the_axis_opaque_all_fragments_are_visible() {
    let (folder, transparent, opaque) = scenes("opaque-none");
    let behind = folder.join("behind");
    std::fs::create_dir_all(&behind).unwrap();
    let (scene, surfaces, out) = (write(&folder, &transparent), write(&behind, &opaque), folder.join("o.png"));
    let all = [arguments("ab_ll", &scene, &surfaces, &out, "cpu"), vec!["--set", "opaque=none"]].concat();
    let output = fragbuf(&all);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert!(stderr(&output).contains("fragments behind opaque surfaces are visible"), "{}", stderr(&output));
    for (index, pixel) in read(&out).2.iter().enumerate() {
        let (x, y) = (index % SIZE, index / SIZE);
        let front = expected(&transparent, &[], usize::MAX, (x, y));
        let color = |quad: &Quad| -> [f64; 3] { std::array::from_fn(|channel| quad.color[channel]) };
        let behind = nearest(&opaque, x, y).map_or(BACKGROUND, color);
        let shine = seen(&transparent, &[], x, y).iter().fold(1.0, |left, quad| left * (1.0 - quad.color[3]));
        for channel in 0..3 {
            let expected = front[channel] + shine * (behind[channel] - BACKGROUND[channel]);
            let apart = (f64::from(pixel[channel]) - 255.0 * expected).abs();
            assert!(apart <= 1.0, "{x}, {y}: {} and not {}", pixel[channel], 255.0 * expected);
        }
    }
}
