//! Tests `fragbuf render --importance` on both devices: white pixels keep every fragment, black ones the nearest.

use std::path::{Path, PathBuf};

use crate::render::{folder, fragbuf, read, stderr};

const SIZE: (u32, u32) = (40, 30);

/// Writes an image whose left half is white and whose right half is black.
fn halves(path: &Path, color: png::ColorType) {
    let mut encoder = png::Encoder::new(std::fs::File::create(path).unwrap(), SIZE.0, SIZE.1);
    encoder.set_color(color);
    encoder.set_depth(png::BitDepth::Eight);
    let mut writer = encoder.write_header().unwrap();
    let value = |index: u32| if index % SIZE.0 < SIZE.0 / 2 { 255 } else { 0 };
    let bytes: Vec<u8> = (0..SIZE.0 * SIZE.1).flat_map(|index| vec![value(index); color.samples()]).collect();
    writer.write_image_data(&bytes).unwrap();
}

fn render(folder: &Path, size: &str, key: &str, options: &[&str]) -> std::process::Output {
    let out: PathBuf = folder.join(format!("{key}.png"));
    let scene = ["--scene", "builtin:hairball,strands=90", "--size", size, "--shading", "unlit", "--linear"];
    fragbuf(&[&["render", key, "--out", out.to_str().unwrap()], scene.as_slice(), options].concat())
}

#[test]
fn important_pixels_keep_more() {
    let folder = folder("importance");
    let map = folder.join("halves.png");
    for (device, color) in [("cpu", png::ColorType::Grayscale), ("llvmpipe", png::ColorType::Rgba)] {
        halves(&map, color);
        let image = |key: &str, options: &[&str]| {
            let output = render(&folder, "40x30", key, &[&["--device", device], options].concat());
            assert!(output.status.success(), "{}", stderr(&output));
            read(&folder.join(format!("{key}.png"))).2
        };
        let by_importance =
            ["--set", "allocation=by_importance", "--set", "k=64", "--importance", map.to_str().unwrap()];
        let seen = image("kplus_ab_sb", &by_importance);
        let (all, nearest) = (image("ab_sb", &[]), image("kplus_array", &["--set", "k=1"]));
        assert!(all != nearest && seen != all);
        for (index, pixel) in seen.iter().enumerate() {
            let expected = if index as u32 % SIZE.0 < SIZE.0 / 2 { all[index] } else { nearest[index] };
            let near = pixel.iter().zip(expected).all(|(seen, expected)| seen.abs_diff(expected) <= 1);
            assert!(near, "{device}, pixel {index}: {pixel:?}, not {expected:?}");
        }
    }
}

/// Peeling keeps what a pixel has no slots for in a later iteration, whatever its k.
#[test]
fn peeling_shows_every_fragment_of_every_pixel() {
    let folder = folder("importance-peeled");
    let map = folder.join("halves.png");
    halves(&map, png::ColorType::Grayscale);
    for device in ["cpu", "llvmpipe"] {
        let image = |key: &str, options: &[&str]| {
            let output = render(&folder, "40x30", key, &[&["--device", device], options].concat());
            assert!(output.status.success(), "{}", stderr(&output));
            read(&folder.join(format!("{key}.png"))).2
        };
        let set = ["--set", "storage=bounded_regions", "--set", "allocation=by_importance", "--set", "k=4"];
        let peeled = image("k_peeling", &[&set, ["--importance", map.to_str().unwrap()].as_slice()].concat());
        let (all, nearest) = (image("ab_sb", &[]), image("kplus_array", &["--set", "k=4"]));
        assert!(all != nearest, "no pixel has more than four fragments");
        let near = |(one, other): (&[u8; 4], &[u8; 4])| one.iter().zip(other).all(|(a, b)| a.abs_diff(*b) <= 1);
        assert!(peeled.iter().zip(&all).all(near), "{device}");
    }
}

#[test]
fn bad_importance_is_an_error() {
    let folder = folder("bad-importance");
    let fails_at = |size: &str, options: &[&str]| {
        let set = ["--device", "cpu", "--set", "allocation=by_importance"];
        let output = render(&folder, size, "kplus_ab_sb", &[set.as_slice(), options].concat());
        assert!(!output.status.success(), "{options:?}");
        stderr(&output)
    };
    let fails = |options: &[&str]| fails_at("40x30", options);
    assert!(
        fails(&[]).contains("reads the external texture `importance`, which an image gives: add `--importance PNG`")
    );
    let map = folder.join("map.png");
    let path = ["--importance", map.to_str().unwrap()];
    assert!(fails(&path).contains("map.png"));
    std::fs::write(&map, "no image").unwrap();
    assert!(fails(&path).contains("map.png: "));
    halves(&map, png::ColorType::Rgb);
    let message = fails_at("20x30", &path);
    assert!(message.contains("has 40 x 30 pixels, and the image 20 x 30"), "{message}");
}
