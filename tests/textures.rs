//! Tests `--texture`: images, slices of an image, tables of a transfer function, and pictures of another description, on both devices; and what is
//! said of those that do not fit.

use std::path::{Path, PathBuf};

use crate::render::{folder, fragbuf, read, stderr};

/// Writes an image of 16-bit channels.
fn write(path: &Path, (width, height): (u32, u32), color: png::ColorType, value: impl Fn(u32, u32, usize) -> u16) {
    let mut encoder = png::Encoder::new(std::fs::File::create(path).unwrap(), width, height);
    encoder.set_color(color);
    encoder.set_depth(png::BitDepth::Sixteen);
    let mut writer = encoder.write_header().unwrap();
    let pixels = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
    let bytes: Vec<u8> = pixels
        .flat_map(|(x, y)| (0..color.samples()).map(move |channel| (x, y, channel)))
        .flat_map(|(x, y, channel)| value(x, y, channel).to_be_bytes())
        .collect();
    writer.write_image_data(&bytes).unwrap();
}

/// A description over the whole frame: one quad, whose colour is the value of a closure.
fn describe(folder: &Path, name: &str, items: &str) -> PathBuf {
    let path = folder.join(format!("{name}.fragbuf"));
    std::fs::write(&path, format!("buffer Shown from kplus_array {{ keep 2; {items}; }}")).unwrap();
    path
}

const SCENE: [&str; 7] = ["--scene", "builtin:cubes", "--size", "24x16", "--linear", "--background", "0,0,0,1"];

fn render(folder: &Path, description: &Path, options: &[&str]) -> std::process::Output {
    let out = folder.join("out.png");
    let paths = ["render", description.to_str().unwrap(), "--out", out.to_str().unwrap()];
    fragbuf(&[&paths, SCENE.as_slice(), options].concat())
}

/// Returns the distinct colours of an image beside the background.
fn colors(folder: &Path, description: &Path, options: &[&str]) -> Vec<[u8; 4]> {
    let output = render(folder, description, options);
    assert!(output.status.success(), "{}", stderr(&output));
    let mut colors: Vec<[u8; 4]> =
        read(&folder.join("out.png")).2.into_iter().filter(|pixel| *pixel != [0, 0, 0, 255]).collect();
    colors.sort_unstable();
    colors.dedup();
    colors
}

fn is_near(seen: &[[u8; 4]], expected: [f64; 3]) -> bool {
    let near = |(seen, expected): (&u8, f64)| (f64::from(*seen) - 255.0 * expected).abs() <= 1.0;
    matches!(seen, [one] if one.iter().zip(expected).all(near))
}

#[test]
fn textures_have_the_channels_of_images() {
    let folder = folder("textures");
    let (grey, colored) = (folder.join("grey.png"), folder.join("colored.png"));
    // 16 bits, so that a value that is no multiple of 1/255 arrives.
    write(&grey, (4, 6), png::ColorType::Grayscale, |x, y, _| (1000 * (x + 10 * y)) as u16);
    write(&colored, (2, 1), png::ColorType::Rgba, |x, _, channel| {
        [[65_535, 0], [0, 20_000], [0, 0], [65_535, 30_000]][channel][x as usize]
    });
    let flat = describe(
        &folder,
        "flat",
        "texture { a: 2d, b: 2d } resolve |fragments, u| (u.a.load(3, 5) + u.b.load(1, 0) * 0.5).truncate().extend(1.0)",
    );
    let solid = describe(
        &folder,
        "solid",
        "texture { a: 3d } resolve |fragments, u| vec4(u.a.load(1, 1, 2).x, u.a.depth() as f32 * 0.1, u.a.height() as f32 * 0.1, 1.0)",
    );
    for device in ["cpu", "llvmpipe"] {
        let (a, b) = (format!("a={}", grey.display()), format!("b={}", colored.display()));
        let seen = colors(&folder, &flat, &["--device", device, "--texture", &a, "--texture", &b]);
        let value = 53_000.0 / 65_535.0;
        assert!(is_near(&seen, [value, value + 10_000.0 / 65_535.0, value]), "{device}: {seen:?}");
        // Three slices of two rows.
        let a = format!("a={},slices=3", grey.display());
        let seen = colors(&folder, &solid, &["--device", device, "--texture", &a]);
        assert!(is_near(&seen, [51_000.0 / 65_535.0, 0.3, 0.2]), "{device}: {seen:?}");
    }
}

#[test]
fn tables_of_transfer_functions_absorb_by_beer_and_lambert() {
    let folder = folder("textures-tables");
    let transfer = folder.join("transfer.png");
    write(&transfer, (1, 1), png::ColorType::Rgba, |_, _, channel| [65_535, 32_768, 0, 32_768][channel]);
    // Half of the length, with the first and the last texel at the ends.
    let shown = describe(
        &folder,
        "table",
        "texture { t: 3d } resolve |fragments, u| {
            let n = u.t.depth() as f32;
            u.t.sample(vec3(0.5, 0.5, (0.5 * (n - 1.0) + 0.5) / n)).truncate().extend(1.0)
        }",
    );
    let table = format!("t=preintegrated:{},length=2,extinction=3,scalars=4,lengths=33", transfer.display());
    let opacity = 1.0 - (-0.5_f64 * 3.0 * 1.0).exp();
    let seen = colors(&folder, &shown, &["--texture", &table]);
    assert!(is_near(&seen, [opacity, 0.5 * opacity, 0.0]), "{seen:?}");
}

/// The picture of another description from another camera, and the rows of the matrix of that camera.
#[test]
fn another_description_draws_a_texture() {
    let folder = folder("textures-rendered");
    let map = describe(
        &folder,
        "map",
        "uniform { scale: f32 } resolve |fragments, u| vec4(u.scale * fragments[0].depth, 0.0, 0.0, 1.0)",
    );
    // From the camera of the map, every visible point has the depth of the map: five texels of the map are a pixel, and the third has its centre.
    let shown = folder.join("shown.fragbuf");
    let text = "buffer Shown from kplus_array {
        fragment { depth: f32, position: vec3 }
        texture { map: 2d }
        uniform { x: vec4, y: vec4, z: vec4, w: vec4, eye: vec3 }
        keep 1;
        resolve |fragments, u| {
            let p = fragments[0].position.extend(1.0);
            let far = u.w.dot(p);
            let at = vec2(0.5 + 0.5 * u.x.dot(p) / far, 0.5 - 0.5 * u.y.dot(p) / far);
            let map = u.map.sample_nearest(at);
            let differs = (u.z.dot(p) / far - 0.5 * map.x).abs();
            let is_ahead = u.w.dot(u.eye.extend(1.0)).abs() < 0.001;
            vec4(if map.w == 1.0 && differs < 0.002 { 1.0 } else { 0.25 }, if is_ahead { 1.0 } else { 0.0 }, 0.0, 1.0)
        }
    }";
    std::fs::write(&shown, text).unwrap();
    let camera = "orbit:20,30";
    let texture = format!("map=rendered:{},camera={camera},size=120x80,scale=2", map.display());
    let uniforms = ["x=map.x", "y=map.y", "z=map.z", "w=map.w", "eye=map.camera"].map(|uniform| ["--uniform", uniform]);
    let uniforms = uniforms.concat();
    let same = [["--texture", &texture, "--camera", camera].as_slice(), &uniforms].concat();
    for device in ["cpu", "llvmpipe"] {
        let output = render(&folder, &shown, &[same.as_slice(), &["--device", device]].concat());
        assert!(output.status.success(), "{}", stderr(&output));
        let pixels = read(&folder.join("out.png")).2;
        let (lit, all) = (
            pixels.iter().filter(|pixel| pixel[0] > 250).count(),
            pixels.iter().filter(|pixel| pixel[1] > 250).count(),
        );
        // Only along edges, a point falls on a texel of the neighbouring face.
        assert!(all > 60 && lit * 10 > all * 9, "{device}: {lit} of {all}");
    }
    // From another side, points that the map does not see are farther than its depth.
    let other = [["--texture", &texture, "--camera", "orbit:200,30"].as_slice(), &uniforms].concat();
    let output = render(&folder, &shown, &other);
    assert!(output.status.success(), "{}", stderr(&output));
    let pixels = read(&folder.join("out.png")).2;
    assert!(pixels.iter().filter(|pixel| (50..100).contains(&pixel[0])).count() > 30);
}

#[test]
fn textures_that_do_not_fit_are_errors() {
    let folder = folder("textures-errors");
    let image = folder.join("image.png");
    write(&image, (2, 3), png::ColorType::Rgb, |_, _, _| 0);
    let image = image.to_str().unwrap();
    let lut = describe(&folder, "lut", "texture { lut: 2d } resolve |fragments, u| u.lut.sample(vec2(0.5, 0.5))");
    let solid = describe(&folder, "volume", "texture { volume: 3d } resolve |fragments, u| u.volume.load(0, 0, 0)");
    let none = describe(&folder, "none", "");
    let rendered = format!("lut=rendered:{},camera=auto", lut.display());
    let cases: [(&Path, &[String], &str); 17] = [
        (&lut, &[], "add `--texture lut=FILE.png`"),
        (&solid, &[], "add `--texture volume=FILE.png,slices=N`"),
        (&lut, &[format!("lot={image}")], "did you mean `lut`?"),
        (&none, &[format!("lut={image}")], "it declares none"),
        (&lut, &["lut=nothing.png".to_owned()], "nothing.png"),
        (&lut, &[format!("lut={}", lut.display())], "PNG"),
        (&lut, &[format!("lut={image},slices=3")], "has two"),
        (&solid, &[format!("volume={image}")], "add `,slices=N`"),
        (&solid, &[format!("volume={image},slices=2")], "which 2 slices do not divide"),
        (&solid, &[format!("volume={image},layers=3")], "no option `layers`"),
        (&lut, &[format!("lut=preintegrated:{image}")], "declare `lut: 3d`"),
        (&solid, &[format!("volume=preintegrated:{image},length=-1")], "`length` takes a number above 0"),
        (&lut, &["lut=rendered:kplus_array".to_owned()], "`camera` is missing"),
        (&lut, &["lut=rendered:effect:midpoints,camera=auto".to_owned()], "did you mean `midpoint`?"),
        (&solid, &["volume=preintegrated:builtin:sheels".to_owned()], "it is `builtin:shells`"),
        (&lut, &[rendered], "cannot be given"),
        (&lut, &["lut".to_owned()], "name=FILE"),
    ];
    for (description, textures, expected) in cases {
        let options: Vec<&str> = textures.iter().flat_map(|texture| ["--texture", texture.as_str()]).collect();
        let output = render(&folder, description, &options);
        let errors = stderr(&output);
        assert!(
            !output.status.success() && errors.to_lowercase().contains(&expected.to_lowercase()),
            "{textures:?}: {errors}"
        );
    }
    // The camera of a texture has a type, and only a rendered texture has one.
    let uniform = describe(
        &folder,
        "row",
        "texture { lut: 2d } uniform { x: f32, y: vec4 } resolve |fragments, u| u.lut.load(0, 0) * u.x * u.y",
    );
    let texture = format!("lut={image}");
    for (value, expected) in [("x=lut.x", "declare `x: vec4`"), ("y=lut.y", "--texture lut=rendered:")] {
        let output = render(&folder, &uniform, &["--texture", &texture, "--uniform", value]);
        assert!(!output.status.success() && stderr(&output).contains(expected), "{value}: {}", stderr(&output));
    }
}
